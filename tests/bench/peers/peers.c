/* What other libraries pay for the same work: free flight and cloth here, the work-precision race in race.c. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../measure.h"
#include "table.h"

#define ENTRIES_MAX 64
#define SIZES_MAX 3
#define STEPS_CHECKED 60
#define BODIES_CHECKED 1000
#define SIDE_CHECKED 16 /* of the cloth; its springs have to be seen at work, and so it swings longer, in finer steps */
#define CLOTH_STEPS_CHECKED 960
#define CLOTH_STEP_CHECKED (1.0 / 9600) /* s */
#define FLIGHT_PLAN {.total = 6, .rounds = 9, .sample = 2e-3}
#define CLOTH_PLAN {.total = 12, .rounds = 15}

static const char *row; /* asked for; NULL: all */
static FILE *csv;
static bool all_checked = true;

bool is_ours(const peer *p) { return strcmp(p->name, peers[0]->name) == 0; }

bool asked(const char *section, const peer *p, const method *m)
{
    char name[160];

    snprintf(name, sizeof name, "%s/%s/%s", section, p->name, m->name);
    return !row || strstr(name, row);
}

bool asked_section(const char *section)
{
    const workload_kind kinds[] = {FLIGHT, CLOTH, KEPLER, OSCILLATORS};
    const char *const names[] = {"flight", "cloth", "kepler", "oscillators"};

    for (size_t k = 0; k < WORKLOAD_KINDS; k++)
        for (size_t p = 0; peers[p] && strcmp(names[k], section) == 0; p++)
            for (const method *m = peers[p]->methods(); m->name; m++)
                if ((m->workloads >> kinds[k] & 1) && asked(section, peers[p], m))
                    return true;
    return false;
}

void write_csv(const char *section, size_t count, const entry *e, const char *setting, double value, const char *unit,
               double ratio)
{
    if (csv)
        fprintf(csv, "%s,%zu,%s,\"%s\",%s,%s,%.9g,%.9g,%.9g,%s,%.9g\n", section, count, e->peer->name, e->method->name,
                e->peer->reals, setting, e->error, e->tolerance, value, unit, ratio);
}

/* ---- the same motion? ---------------------------------------------------------------------------------------------------- */

/* Positions after so many steps of `step`, [3 count]. */
static double *positions_after(const peer *p, const method *m, const workload *w, double step, unsigned steps)
{
    double *position = need(6 * w->count * sizeof *position);
    void *self = p->create(w, m, step);

    memcpy(position, w->position, 3 * w->count * sizeof *position);
    for (unsigned i = 0; i < steps; i++)
        p->advance(self, step);
    p->read(self, position, position + 3 * w->count);
    p->destroy(self);
    return position;
}

static double largest_difference(const double *a, const double *b, size_t length)
{
    double largest = 0;

    for (size_t i = 0; i < length; i++)
        if (!(fabs(a[i] - b[i]) <= largest))
            largest = fabs(a[i] - b[i]);
    return largest;
}

/* What semi-implicit Euler gives but for rounding: v' = v (1 - k dt) + g dt, x' = x + v' dt. */
static void semi_implicit(const workload *w, double *position, double *velocity)
{
    for (size_t i = 0; i < 3 * w->count; i++) {
        double x = w->position[i], v = w->velocity[i];
        for (unsigned n = 0; n < STEPS_CHECKED; n++) {
            v += (-w->drag * v - (i % 3 == 1 ? w->gravity : 0)) * w->step;
            x += v * w->step;
        }
        position[i] = x;
        velocity[i] = v;
    }
}

/*
 * Free flight. A first-order peer has to match semi-implicit Euler, a fourth-order one the exact motion to (k dt)^4 of the way
 * covered; both but for rounding: half an ulp of the largest coordinate a step and addition, and where velocities are
 * differences of positions, the same again in each velocity, which then moves the body for the steps to come.
 */
static void check_flight(entry *e)
{
    const workload *w = e->workload;
    const size_t length = 3 * w->count;
    double *position = positions_after(e->peer, e->method, w, w->step, STEPS_CHECKED);
    double *expected = need(2 * length * sizeof *expected);
    double largest = 0, way = 0;

    memset(expected, 0, 2 * length * sizeof *expected);
    if (e->method->order == 1)
        semi_implicit(w, expected, expected + length);
    else
        workload_exact(w, STEPS_CHECKED * w->step, expected, expected + length);
    for (size_t i = 0; i < length; i++) {
        largest = fmax(largest, fabs(expected[i]));
        way = fmax(way, fabs(expected[i] - w->position[i]));
    }
    const double ulp = largest * (strncmp(e->peer->reals, "float", 5) == 0 ? (double)FLT_EPSILON : DBL_EPSILON);
    const double rounding = ulp * STEPS_CHECKED * (e->peer->from_positions ? STEPS_CHECKED : 1);
    e->error = largest_difference(position, expected, length);
    e->tolerance = rounding + (e->method->order == 1 ? 0 : pow(w->drag * w->step, e->method->order) * way);
    free(position);
    free(expected);
}

/*
 * Cloth: no exact motion is known. Both methods being of first order, each is off by twice the change that halving its step
 * makes, give or take terms of second order, for which a quarter is added; and so they differ by no more than the sum of
 * both, if both go to the same motion.
 */
static void check_cloth(entry *e, const peer *p, const method *m)
{
    const workload *w = e->workload;
    const size_t length = 3 * w->count;
    const unsigned steps = CLOTH_STEPS_CHECKED;
    const double dt = CLOTH_STEP_CHECKED;
    double *theirs = positions_after(e->peer, e->method, w, dt, steps), *ours = positions_after(p, m, w, dt, steps);
    double *theirs_finer = positions_after(e->peer, e->method, w, dt / 2, 2 * steps);
    double *ours_finer = positions_after(p, m, w, dt / 2, 2 * steps);

    e->error = largest_difference(theirs, ours, length);
    e->tolerance = 2.5 * (largest_difference(ours, ours_finer, length) + largest_difference(theirs, theirs_finer, length));
    free(theirs);
    free(theirs_finer);
    free(ours);
    free(ours_finer);
}

/* ---- the tables ---------------------------------------------------------------------------------------------------------- */

static void *setup(const void *argument)
{
    entry *e = (entry *)(uintptr_t)argument;

    e->self = e->peer->create(e->workload, e->method, e->workload->step);
    return e->self ? e : NULL;
}

static void step(void *context)
{
    const entry *e = context;

    e->peer->advance(e->self, e->workload->step);
}

/* Steps one a call, as a game does. */
static void run(void *context)
{
    const entry *e = context;

    for (unsigned i = 0; i < e->steps; i++)
        step(context);
}

static void teardown(void *context)
{
    const entry *e = context;

    e->peer->destroy(e->self);
}

/* All ways to do a workload, by order. Each peer is set beside ours of the same order, reals and dimensions. */
static size_t collect(const char *section, workload_kind kind, entry *entries)
{
    size_t count = 0;

    for (unsigned order = 1; order <= 4; order++)
        for (size_t p = 0; peers[p]; p++)
            for (const method *m = peers[p]->methods(); m->name; m++)
                if ((m->workloads >> kind & 1) && m->order == order && count < ENTRIES_MAX &&
                    (is_ours(peers[p]) || asked(section, peers[p], m)))
                    entries[count++] = (entry){.peer = peers[p], .method = m};
    return count;
}

static size_t reference_of(const entry *entries, size_t n)
{
    size_t i = 0;

    while (!is_ours(entries[i].peer) || entries[i].method->order != entries[n].method->order ||
           entries[i].method->dimensions != entries[n].method->dimensions ||
           strncmp(entries[i].peer->reals, entries[n].peer->reals, 5) != 0)
        i++;
    return i;
}

/* One column a size. `make` makes the workload. */
typedef struct table {
    const char *section, *title;
    workload_kind kind;
    size_t sizes[SIZES_MAX], size_count;
    unsigned steps[SIZES_MAX]; /* in a run */
    workload *(*make)(size_t size, unsigned dimensions);
    measure_plan plan;
} table;

/* A cloth is measured in the first 0.2 s of its fall, the same for all, since what it costs may depend on how it lies: one run
   a sample, after a step that fills the caches. */
static void measure_all(const table *t, size_t size, entry *entries, size_t count, workload *const of_dimensions[2],
                        measure_result *results)
{
    measure_case cases[ENTRIES_MAX];

    for (size_t i = 0; i < count; i++) {
        const workload *w = of_dimensions[entries[i].method->dimensions - 2];
        entries[i].workload = w;
        entries[i].steps = t->steps[size];
        cases[i] = (measure_case){.argument = &entries[i],
                                  .setup = setup,
                                  .prepare = t->kind == CLOTH ? step : NULL,
                                  .run = run,
                                  .teardown = teardown,
                                  .items = (double)(t->kind == CLOTH ? w->tie_count : w->count) * t->steps[size]};
    }
    measure(cases, count, &t->plan, results);
}

static void print_row(const table *t, const entry *e, const double *cost, const double *ratio)
{
    char check[64];
    const bool same = e->error <= e->tolerance;

    all_checked = all_checked && (same || (t->kind == CLOTH && e->method->other_cloth));
    snprintf(check, sizeof check, "%.1e <= %.1e", e->error, e->tolerance);
    printf("  %-10s %-30s %uD %-6.*s", e->peer->name, e->method->name, e->method->dimensions,
           (int)strcspn(e->peer->reals, ","), e->peer->reals);
    for (size_t s = 0; s < t->size_count; s++)
        printf(" %9.2f %7.2f", cost[s], ratio[s]);
    if (is_ours(e->peer) && t->kind == CLOTH)
        printf("\n");
    else if (t->kind == CLOTH && e->method->other_cloth)
        printf("   another motion, by %.1e\n", e->error);
    else
        printf("   %s%s\n", check, same ? "" : "  NOT THE SAME MOTION");
}

static void run_table(const table *t)
{
    static measure_result results[SIZES_MAX][ENTRIES_MAX];
    entry entries[ENTRIES_MAX];
    workload *w[SIZES_MAX][2];
    workload *checked[2] = {t->make(t->kind == CLOTH ? SIDE_CHECKED : BODIES_CHECKED, 2),
                            t->make(t->kind == CLOTH ? SIDE_CHECKED : BODIES_CHECKED, 3)};
    const size_t count = collect(t->section, t->kind, entries);

    printf("\n%s: %s\n", t->section, t->title);
    for (size_t s = 0; s < t->size_count; s++) {
        w[s][0] = t->make(t->sizes[s], 2);
        w[s][1] = t->make(t->sizes[s], 3);
        measure_all(t, s, entries, count, w[s], results[s]);
    }
    printf("  %-10s %-30s %2s %-6s", "peer", "method", "", "reals");
    for (size_t s = 0; s < t->size_count; s++) {
        char size[32];
        snprintf(size, sizeof size, t->kind == CLOTH ? "%zu x %zu" : "%zu", t->sizes[s], t->sizes[s]);
        printf(" %9s %7s", size, "x ours");
    }
    printf("   off by <= tolerance, m\n");
    for (size_t i = 0; i < count; i++) {
        const size_t ours = reference_of(entries, i);
        double cost[SIZES_MAX], ratio[SIZES_MAX];
        entries[i].workload = checked[entries[i].method->dimensions - 2];
        if (t->kind == FLIGHT)
            check_flight(&entries[i]);
        else
            check_cloth(&entries[i], entries[ours].peer, entries[ours].method);
        for (size_t s = 0; s < t->size_count; s++) {
            cost[s] = results[s][i].median;
            ratio[s] = measure_ratio(&results[s][i], &results[s][ours]);
            write_csv(t->section, t->sizes[s], &entries[i], "", cost[s], "ns", ratio[s]);
        }
        print_row(t, &entries[i], cost, ratio);
    }
    for (size_t s = 0; s < t->size_count; s++)
        for (size_t d = 0; d < 2; d++)
            workload_free(w[s][d]);
    workload_free(checked[0]);
    workload_free(checked[1]);
}

static const table tables[] = {
    {.section = "flight", .kind = FLIGHT, .sizes = {1000, 100000, 1000000}, .steps = {1, 1, 1}, .size_count = 3,
     .make = workload_flight, .title = "gravity and linear drag, ns a particle a step", .plan = FLIGHT_PLAN},
    {.section = "cloth", .kind = CLOTH, .sizes = {64, 256}, .steps = {12, 2}, .size_count = 2,
     .make = workload_cloth, .title = "springs along rows, columns and diagonals, ns a spring a step", .plan = CLOTH_PLAN},
};

/* ---- the program --------------------------------------------------------------------------------------------------------- */

static void print_peers(void)
{
    printf("%s, %s, on one core%s\n\n", measure_processor(), measure_compiler(), measure_pin() ? ", pinned" : "");
    for (size_t p = 0; peers[p]; p++) {
        char version[64];
        if (p > 0 && is_ours(peers[p]))
            continue;
        peers[p]->version(version, sizeof version);
        printf("  %-10s %-8s ", peers[p]->name, version);
        for (const char *line = peers[p]->note; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL)
            printf("%s%.*s\n", line == peers[p]->note ? "" : "                      ", (int)strcspn(line, "\n"), line);
    }
}

static void usage(FILE *file)
{
    fprintf(file, "usage: peers [--csv FILE] [ROW]\n"
                  "ROW is a part of section/peer/method, e.g. flight, odeint, kepler/GSL; ours always runs beside.\n"
                  "Sections: flight, cloth, kepler, oscillators. All of it takes some five minutes and 4 GB.\n");
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], "--csv") == 0 && i + 1 < argc) {
            if (!(csv = fopen(argv[++i], "w"))) {
                fprintf(stderr, "peers: %s can't be written: give another file\n", argv[i]);
                return 1;
            }
            fprintf(csv, "section,size,peer,method,reals,setting,error,tolerance,value,unit,ratio\n");
        } else if (argv[i][0] == '-') {
            usage(strcmp(argv[i], "--help") == 0 ? stdout : stderr);
            return strcmp(argv[i], "--help") != 0;
        } else {
            row = argv[i];
        }
    if (!asked_section("flight") && !asked_section("cloth") && !asked_section("kepler") && !asked_section("oscillators")) {
        fprintf(stderr, "peers: no row has \"%s\" in its section/peer/method: see --help\n", row);
        return 1;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    print_peers();
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++)
        if (asked_section(tables[t].section))
            run_table(&tables[t]);
    race();
    if (csv)
        fclose(csv);
    if (!all_checked)
        fprintf(stderr, "peers: a peer did not compute the same motion: its row says which; don't compare its figures\n");
    return !all_checked;
}
