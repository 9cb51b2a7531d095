#include "table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define COLUMNS "%-2s %-19s %-6s %-13s %9s %10s %6s %10s %10s %6s %10s %10s  %s\n"
#define CELL 64
#define WHOLE 1e-9
#define SHORT_STEP 1.0   /* time units: below, a step may be a whole part of the unit */
#define CHAOS 1e-4       /* of the reach: a reference that is off by more has not converged */
#define ROUND_OFF_PART 0.1

const double table_tolerances[3] = {1e-2, 1e-3, 1e-4};

/* Four digits, and no power of ten before the number has ten. */
static const char *plain_number(double number, char text[CELL])
{
    snprintf(text, CELL, fabs(number) >= 1000 && fabs(number) < 1e9 ? "%.0f" : "%.4g", number);
    return text;
}

/* ns, or microseconds where they are many */
static const char *time_text(double nanoseconds, char text[CELL])
{
    snprintf(text, CELL, nanoseconds < 1000 ? "%.3g ns" : "%.3g µs", nanoseconds < 1000 ? nanoseconds : nanoseconds / 1000);
    return text;
}

static const char *precision_of(const stf_trade_row *row) { return row->in_double ? "double" : "float"; }

const char *table_step(const sweep *s, const stf_trade_row *row, char text[CELL])
{
    const double parts = 1 / row->step;

    if (row->step < SHORT_STEP && fabs(parts - round(parts)) < WHOLE * parts)
        snprintf(text, CELL, "1/%.0f %s", parts, s->scene->time_unit);
    else
        snprintf(text, CELL, "%.4g %s", row->step, s->scene->time_unit);
    return text;
}

/* A number, or why there is none. */
static const char *error_text(const sweep *s, const stf_trade_row *row, double error, char text[CELL])
{
    if (!row->finite)
        return "lost";
    if (error >= STF_TRADE_MARGIN * row->reference_error)
        snprintf(text, CELL, "%.3g", error);
    else
        return row->reference_error > CHAOS * s->reference.reach ? "chaos" : "floor";
    return text;
}

static const char *energy_text(const stf_trade_row *row, double error, double of_reference, char text[CELL])
{
    if (!row->finite)
        return "lost";
    if (error < STF_TRADE_MARGIN * of_reference)
        return "floor";
    snprintf(text, CELL, "%.2g", error);
    return text;
}

/* Whether float's round-off is a good part of the row's error: in double the error is another. */
static bool is_round_off(const stf_trade_row *row, const stf_trade_row *in_double)
{
    return !row->in_double && in_double && in_double->bounded &&
           fabs(row->largest_error - in_double->largest_error) > ROUND_OFF_PART * in_double->largest_error;
}

/* log2 of what half the step gained: the method's order, once the step is short. */
static const char *order_text(const stf_trade_row *row, const stf_trade_row *coarser, char text[CELL])
{
    const bool comparable = coarser && coarser->bounded && row->bounded && stf_trade_error_is_known(row) &&
                            stf_trade_error_is_known(coarser);

    if (!comparable)
        return "-";
    snprintf(text, CELL, "%.2f", log2(coarser->largest_error / row->largest_error));
    return text;
}

static const char *remark(const stf_trade_row *row, bool round_off)
{
    if (!row->finite)
        return "not finite";
    if (!row->bounded)
        return "unbounded";
    return round_off ? "float's round-off" : "";
}

static void print_row(const sweep *s, size_t integrator, const stf_trade_row *row)
{
    char step[CELL], accelerations[CELL], cost[CELL], spread[CELL], end[CELL], largest[CELL], order[CELL], energy[CELL],
        momentum[CELL];
    const bool round_off = is_round_off(row, sweep_row(s, integrator, true, row->steps));
    const stf_trade_row *coarser =
        row->steps % 2 == 0 && !round_off ? sweep_row(s, integrator, row->in_double, row->steps / 2) : NULL;
    const double half_spread = (row->nanoseconds_high - row->nanoseconds_low) / 2;

    plain_number(row->accelerations / s->duration, accelerations);
    plain_number(row->nanoseconds, cost);
    snprintf(spread, CELL, "%.1f", 100 * half_spread / row->nanoseconds);
    printf(COLUMNS, row->on_front ? "*" : "", row->integrator, precision_of(row), table_step(s, row, step), accelerations, cost,
           spread, error_text(s, row, row->end_error, end), error_text(s, row, row->largest_error, largest),
           order_text(row, coarser, order),
           energy_text(row, row->energy_error, s->reference.energy, energy),
           energy_text(row, row->momentum_error, s->reference.momentum, momentum),
           remark(row, round_off));
}

static void print_head(const sweep *s)
{
    const char *l = s->scene->length_unit, *t = s->scene->time_unit;
    const bool si = strcmp(l, "m") == 0 && strcmp(t, "s") == 0;
    char cost[CELL], length[CELL], rate[CELL], energy[CELL], momentum[CELL];

    printf("%s: %s; %lu particle%s, %g %s, size %g %s\n", s->scene->name, s->scene->title, (unsigned long)s->particles,
           s->particles == 1 ? "" : "s", s->duration, t, s->scene->size, l);
    if (s->reference.exact)
        printf("reference: the exact solution, right to %.1e %s\n", s->reference.error, l);
    else
        printf("reference: a run of order 8 in double, %u steps; halving its step changed it by %.1e %s\n", s->reference.steps,
               s->reference.error, l);
    printf("\n");
    snprintf(rate, CELL, "1/%s", t);
    snprintf(cost, CELL, "ns/%s", t);
    snprintf(length, CELL, "%s", l);
    snprintf(energy, CELL, "%s", si ? "J" : "m l2/t2");
    snprintf(momentum, CELL, "%s", si ? "kg m/s" : "m l/t");
    printf(COLUMNS, "", "integrator", "", "step", "accel.", "cost", "spread", "end error", "largest", "order", "energy",
           "momentum", "");
    printf(COLUMNS, "", "", "", "", rate, cost, "+- %", length, length, "", energy, momentum, "");
}

static const stf_trade_row *at_equal_cost(const sweep *s, size_t integrator, bool in_double, unsigned accelerations)
{
    const unsigned evaluations = (unsigned)stf_integrators[integrator]->evaluations;

    return accelerations % evaluations == 0 ? sweep_row(s, integrator, in_double, accelerations / evaluations) : NULL;
}

/* RK4 at 4 dt beside Verlet at dt: one line has as many accelerations for every integrator. */
static void print_equal_cost(const sweep *s, bool in_double)
{
    printf("\nlargest error [%s] in %s at equal cost\n%12s", s->scene->length_unit, in_double ? "double" : "float", "accel.");
    for (size_t i = 0; i < s->integrator_count; i++)
        printf(" %19s", stf_integrators[s->integrators[i]]->name);
    printf("\n");
    for (size_t level = 0; level < s->levels; level++) {
        printf("%10.4g/%s", s->steps[level] / s->duration, s->scene->time_unit);
        for (size_t i = 0; i < s->integrator_count; i++) {
            char text[CELL];
            const stf_trade_row *row = at_equal_cost(s, s->integrators[i], in_double, s->steps[level]);

            printf(" %19s", row ? error_text(s, row, row->largest_error, text) : "-");
        }
        printf("\n");
    }
}

static void print_pick(const sweep *s, const stf_trade_row *pick)
{
    char step[CELL], error[CELL], cost[CELL];

    if (!pick) {
        printf("none of these\n");
        return;
    }
    const bool known = stf_trade_error_is_known(pick);

    snprintf(error, CELL, known ? "%.2g" : "below %.1g", known ? pick->largest_error : stf_trade_error_bound(pick));
    printf("%s in %s at %s: %s ns/%s, largest error %s %s\n", pick->integrator, precision_of(pick), table_step(s, pick, step),
           plain_number(pick->nanoseconds, cost), s->scene->time_unit, error, s->scene->length_unit);
}

static void print_for_tolerance(const sweep *s, double tolerance)
{
    const double error = tolerance * s->scene->size;
    char label[CELL];

    snprintf(label, CELL, "%g of the size, %g %s", tolerance, error, s->scene->length_unit);
    printf("cheapest for an error of %-26s ", label);
    print_pick(s, stf_trade_cheapest(s->rows, s->count, error));
}

static void print_for_budget(const sweep *s, double budget, const char *whose)
{
    char label[CELL], cost[CELL];

    snprintf(label, CELL, "%.31s ns/%s%s", plain_number(budget, cost), s->scene->time_unit, whose);
    printf("most accurate for %-33s ", label);
    print_pick(s, stf_trade_most_accurate(s->rows, s->count, budget));
}

void table_print_answers(const sweep *s, double tolerance, double budget)
{
    printf("%s: ", s->scene->name);
    if (tolerance > 0)
        print_for_tolerance(s, tolerance);
    if (tolerance > 0 && budget > 0)
        printf("%s: ", s->scene->name);
    if (budget > 0)
        print_for_budget(s, budget, "");
}

/* What the scene's own integrator and step cost, in float if that was measured; NULL: they were not. */
static const stf_trade_row *own_row(const sweep *s)
{
    const unsigned steps = (unsigned)floor(s->duration / s->scene->step + 0.5);

    for (size_t i = 0; i < s->integrator_count; i++)
        if (stf_integrators[s->integrators[i]] == s->scene->integrator) {
            const stf_trade_row *row = sweep_row(s, s->integrators[i], false, steps);
            return row ? row : sweep_row(s, s->integrators[i], true, steps);
        }
    return NULL;
}

void table_print(const sweep *s)
{
    print_head(s);
    for (size_t i = 0; i < s->count; i++)
        print_row(s, s->integrators[i / s->levels % s->integrator_count], &s->rows[i]);
    printf("\n*: no other is both cheaper and more accurate. Cost: ns a particle for each unit of simulated time, median and\n"
           "half the quartiles' distance. Errors: root mean square over particles. Order: of the largest error,\n"
           "from twice the step. floor, chaos: the reference's own error is not 100 times smaller.\n");
    for (int in_double = 0; in_double < 2; in_double++)
        if (sweep_row(s, s->integrators[0], in_double, s->steps[0]))
            print_equal_cost(s, in_double);
    printf("\n");
    for (size_t i = 0; i < sizeof table_tolerances / sizeof *table_tolerances; i++)
        print_for_tolerance(s, table_tolerances[i]);
    if (own_row(s))
        print_for_budget(s, own_row(s)->nanoseconds, ", as now");
    printf("\n\n");
}

void table_print_markdown_head(void)
{
    printf("| scene | 1e-2 of its size | 1e-3 | 1e-4 |\n|---|---|---|---|\n");
}

void table_print_markdown(const sweep *s)
{
    printf("| %s |", s->scene->title);
    for (size_t i = 0; i < sizeof table_tolerances / sizeof *table_tolerances; i++) {
        char step[CELL], cost[CELL];
        const stf_trade_row *pick = stf_trade_cheapest(s->rows, s->count, table_tolerances[i] * s->scene->size);

        if (pick)
            printf(" `%s`%s, %s: %s |", pick->integrator, pick->in_double ? " in double" : "", table_step(s, pick, step),
                   time_text(pick->nanoseconds, cost));
        else
            printf(" none |");
    }
    printf("\n");
}
