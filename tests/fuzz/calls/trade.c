/* The instrument that compares integrators, on a small scene of its own. */
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "game.h"
#include "scene.h"

#define TRADE_WORK 4000 /* of a program's: half */

enum { LISTED_MAX = 3, ROWS_MAX = LISTED_MAX * LISTED_MAX };

/* What `user` points at: a scene, an exact solution of some of its particles, and a timer. */
typedef struct trial {
    scene scene; /* first, so that scene_build finds it */
    unsigned known;          /* bits: particles */
    double start, speed;     /* m, m/s: where all of those are */
    double seconds;          /* s */
    unsigned readings;
} trial;

static bool place(void *user, size_t particle, double time, double position[3], double velocity[3])
{
    const trial *t = user;

    position[0] = t->start + time * t->speed;
    velocity[0] = t->speed;
    position[1] = position[2] = velocity[1] = velocity[2] = 0;
    return (t->known >> particle & 1) != 0;
}

static bool is_all_known(const trial *t)
{
    const unsigned all = (1U << t->scene.particles) - 1;

    return (t->known & all) == all;
}

/* Never twice the same, and uneven. */
static double seconds(void *user)
{
    trial *t = user;

    t->seconds += 1e-6 * (1 + (t->readings++ & 3));
    return t->seconds;
}

static void progress(void *user, size_t done, size_t total)
{
    (void)user;
    claim(done > 0 && done <= total);
}

/* `faults` are the results, as bits, one of which it has to be; `doubts` are those that it may be. */
static void claim_result(const trial *t, stf_result result, unsigned faults, unsigned doubts)
{
    const unsigned bit = 1U << result;

    if (fuzz_verbose)
        printf("%s\n", stf_result_text(result));
    faults |= t->scene.result ? 1U << t->scene.result : 0;
    if (t->scene.ration->refused)
        claim(result == STF_ERROR_MEMORY || (faults & bit));
    else
        claim((faults ? faults | doubts : doubts | 1U << STF_OK) & bit);
}

/* ---- the reference ----------------------------------------------------------------------------------------------------- */

static bool is_size(double x) { return x >= 0; } /* infinity is one, a NaN is not */

static void claim_accuracy(const stf_trade_reference *reference, const stf_trade_reference_def *def, bool is_known)
{
    const stf_trade_accuracy found = stf_trade_reference_accuracy(reference);
    const unsigned per_step = 17; /* accelerations of the method, as its source says */

    claim(is_size(found.error) && is_size(found.energy) && is_size(found.momentum) && is_size(found.reach));
    claim(found.exact == is_known);
    if (found.exact)
        claim(found.steps == 0);
    else
        claim(found.steps == def->samples || (found.steps % (2 * def->samples) == 0 &&
                                              per_step * (2 * found.steps - def->samples) <= def->accelerations));
}

/* NULL: there is none, as had to be. */
static stf_trade_reference *refer(trial *t, program *p, stf_trade_reference_def *def)
{
    const unsigned known = take(p), duration = take(p), samples = take(p), most = take(p);
    stf_trade_reference *reference = NULL;
    unsigned faults = 0, doubts = 0;

    *def = (stf_trade_reference_def){.build = scene_build_f64,
                                     .exact = known >= 128 ? place : NULL,
                                     .user = t,
                                     .duration = duration < 200 ? (1 + duration % 8) / 8.0 : take_double(p),
                                     .samples = samples < 255 ? 1 + samples % 5 : UINT_MAX,
                                     .error = most < 128 ? 0 : take_double(p),
                                     .accelerations = 1 + 4 * (uint64_t)most,
                                     .allocator = ration_allocator(t->scene.ration)};
    if (known == 255)
        def->allocator.release = NULL, faults |= 1U << STF_ERROR_DESCRIPTOR;
    t->known = known;
    t->start = take_double(p);
    t->speed = take_double(p);
    if (!(def->duration > 0 && isfinite(def->duration)) || !(def->error >= 0))
        faults |= 1U << STF_ERROR_STEP;
    if (def->duration / def->samples < 1024 * DBL_MIN)
        doubts |= 1U << STF_ERROR_STEP;
    if (def->exact && !(isfinite(t->speed) && fabs(t->start) + fabs(t->speed) * def->duration <= DBL_MAX / 4))
        doubts |= 1U << STF_ERROR_NOT_FINITE;

    const stf_result result = stf_trade_reference_create(def, &reference);
    claim_result(t, result, faults, doubts);
    claim((result == STF_OK) == (reference != NULL));
    return reference;
}

/* ---- rows -------------------------------------------------------------------------------------------------------------- */

static void claim_row(const stf_trade_row *row, const stf_trade_reference_def *of, const stf_integrator *integrator,
                      unsigned steps, bool has_particles)
{
    const double asked = (double)integrator->evaluations * steps; /* and once more for a history's first */

    claim(row->integrator == integrator->name && row->in_double == (sizeof(stf_real) == sizeof(double)));
    claim(row->steps == steps && row->step == of->duration / steps);
    claim(is_size(row->end_error) && is_size(row->energy_error) && is_size(row->momentum_error));
    claim(row->largest_error >= row->end_error && (row->finite || (row->end_error > DBL_MAX && !row->bounded)));
    claim(row->accelerations >= (has_particles ? asked : 0));
    claim(!row->finite || integrator->evaluations == 0 || row->accelerations <= asked + 1);
    claim(row->nanoseconds_low >= 0 && row->nanoseconds_low <= row->nanoseconds);
    claim(row->nanoseconds <= row->nanoseconds_high);

    const double bound = stf_trade_error_bound(row);
    claim(bound >= row->largest_error && bound >= row->reference_error);
    claim(!stf_trade_error_is_known(row) || row->largest_error >= STF_TRADE_MARGIN * row->reference_error);
}

/* Two measurements of the same scene differ in nothing but time. */
static void claim_same_row(stf_trade_row a, const stf_trade_row *b)
{
    claim(a.finite == b->finite && a.bounded == b->bounded && a.end_error == b->end_error);
    claim(a.largest_error == b->largest_error && a.energy_error == b->energy_error);
    claim(a.momentum_error == b->momentum_error && a.accelerations == b->accelerations);
}

/* No row that may be picked is better than what was; and of two on the front none is in all better than the other. */
static void claim_picks(stf_trade_row *rows, size_t count, double error, double nanoseconds)
{
    const stf_trade_row *cheapest = stf_trade_cheapest(rows, count, error);
    const stf_trade_row *best = stf_trade_most_accurate(rows, count, nanoseconds);

    stf_trade_front(rows, count);
    claim(!cheapest || stf_trade_error_bound(cheapest) <= error);
    claim(!best || best->nanoseconds <= nanoseconds);
    for (size_t i = 0; i < count; i++) {
        const double bound = stf_trade_error_bound(&rows[i]), cost = rows[i].nanoseconds;

        claim(!(bound <= error && bound <= DBL_MAX) || (cheapest && cheapest->nanoseconds <= cost));
        claim(!(cost <= nanoseconds && bound <= DBL_MAX) || (best && stf_trade_error_bound(best) <= bound));
        for (size_t k = 0; k < count && rows[i].on_front; k++)
            claim(!(stf_trade_error_bound(&rows[k]) < bound && rows[k].nanoseconds < cost));
    }
}

/* Two runs, timed in turn. */
static stf_result trade_in_parts(const stf_trade_def *def, stf_trade_row *rows, stf_trade_row *again)
{
    stf_trade_run *runs[2];
    stf_result result = stf_trade_begin(def, rows, &runs[0]);

    if (result)
        return result;
    result = stf_trade_begin(def, again, &runs[1]);
    if (!result) {
        result = stf_trade_time(runs, 2);
        stf_trade_end(runs[1]);
    }
    stf_trade_end(runs[0]);
    return result;
}

/* The lists, and what may be said against them. */
static unsigned take_lists(program *p, const stf_trade_reference_def *of, bool compensated, stf_trade_def *def,
                           const stf_integrator **listed, unsigned *steps)
{
    const unsigned counts = take(p);
    unsigned faults = 0;

    def->integrators = listed, def->integrator_count = counts & LISTED_MAX;
    def->steps = steps, def->steps_count = counts >> 2 & LISTED_MAX;
    for (size_t i = 0; i < def->integrator_count; i++) {
        const unsigned which = take(p);

        listed[i] = which < 255 ? integrators[which % INTEGRATORS] : NULL;
        if (!listed[i])
            faults |= 1U << STF_ERROR_NULL;
        else if (def->steps_count > 0 && is_refused(which % INTEGRATORS, compensated))
            faults |= 1U << STF_ERROR_DESCRIPTOR;
    }
    for (size_t i = 0; i < def->steps_count; i++) {
        const unsigned byte = take(p);

        steps[i] = byte < 200 ? of->samples * (1 + byte % 4) : byte % 16;
        if (steps[i] == 0 || (steps[i] % of->samples != 0 && of->samples % steps[i] != 0) ||
            (def->integrator_count > 0 && !is_step(of->duration / steps[i], 1)))
            faults |= 1U << STF_ERROR_STEP;
    }
    return faults;
}

static void measure_rows(trial *t, program *p, const stf_trade_reference *reference, const stf_trade_reference_def *of)
{
    static const double lasting[] = {1e-6, 1e-9, -1, 1e-300};
    const unsigned how = take(p), repeat = take(p);
    const size_t particles = t->scene.particles;
    const stf_integrator *listed[LISTED_MAX];
    unsigned steps[LISTED_MAX];
    stf_trade_row rows[ROWS_MAX], again[ROWS_MAX];
    stf_trade_def def = {.build = scene_build, .user = t, .reference = reference, .repeats = 1 + how % 2,
                         .repeat_seconds = lasting[repeat < 224 ? repeat % 2 : repeat % COUNT_OF(lasting)],
                         .seconds = seconds, .progress = how & 2 ? progress : NULL,
                         .allocator = ration_allocator(t->scene.ration)};
    unsigned faults = take_lists(p, of, t->scene.is_compensated, &def, listed, steps);
    const size_t count = def.integrator_count * def.steps_count;

    if (def.repeat_seconds < 0)
        faults |= 1U << STF_ERROR_STEP;
    if (how >= 240 && count > 0) {
        t->scene.more_particles = how & 1, t->scene.more_dimensions = how >> 1 & 1;
        faults |= t->scene.more_particles ? 1U << STF_ERROR_PARTICLE : 0;
        faults |= t->scene.more_dimensions ? 1U << STF_ERROR_DIMENSIONS : 0;
    }
    const bool in_parts = (how & 4) != 0;
    const stf_result result = in_parts ? trade_in_parts(&def, rows, again) : stf_trade(&def, rows);
    claim_result(t, result, faults, 0);
    for (size_t i = 0; i < count && result == STF_OK; i++) {
        claim_row(&rows[i], of, listed[i / def.steps_count], steps[i % def.steps_count], particles > 0);
        claim(rows[i].reference_error == stf_trade_reference_accuracy(reference).error);
        if (in_parts)
            claim_same_row(rows[i], &again[i]);
    }
    if (result == STF_OK)
        claim_picks(rows, count, take_double(p), 1e6 * take_double(p));
}

static scene take_scene(program *p, ration *r)
{
    scene s = {.program = *p, .ration = r};

    if (s.program.left > SCENE_BYTES)
        s.program.left = SCENE_BYTES;
    p->at += s.program.left;
    p->left -= s.program.left;
    return s;
}

/* Once a program: it is dear. */
void trade(game *g)
{
    ration r = {.garbage = 0x41, .fail_in = take(&g->program) % 64};
    trial t = {.scene = take_scene(&g->program, &r)};
    stf_trade_reference_def def;

    if (g->had_trade)
        return;
    g->had_trade = true;
    g->work -= TRADE_WORK;
    if (fuzz_verbose)
        printf("%-20s", "trade");

    stf_trade_reference *reference = refer(&t, &g->program, &def);
    if (reference) {
        claim_accuracy(reference, &def, def.exact && is_all_known(&t));
        measure_rows(&t, &g->program, reference, &def);
    }
    stf_trade_reference_destroy(reference);
    claim(r.blocks == 0);
}
