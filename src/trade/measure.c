/*
 * What needs the scene in its precision. Errors, energies and accelerations come from one run of each row, in which a force
 * that pushes nothing counts how often it is asked; costs come from runs without it.
 */
#include <float.h>
#include <math.h>
#include <time.h>

#include "../allocator.h"
#include "trade.h"

#ifdef STF_DOUBLE
#define IN_DOUBLE true
#else
#define IN_DOUBLE false
#endif

/* Many and short: a system that shares the core out takes it away for milliseconds at a time, which then hits few of them. */
#define DEFAULT_REPEATS 25
#define DEFAULT_REPEAT_SECONDS 0.00025
#define RUNS_MAX 100000 /* that one repeat of one row takes, however short they are */
#define REPEATS_MAX 100 /* as long as so many may one last that comes out longer than its estimate */
#define TIMER_LOTS 10
#define TIMER_CALLS 100

/* What a run works with: the def with its defaults, and what was found out on the way. */
typedef struct job {
    stf_trade_run run; /* first, so that time_row finds the job that its run is part of */
    stf_trade_def def;
    double timer_overhead; /* s that two readings of the timer are apart */
} job;

static const stf_integrator *integrator_of(const job *j, size_t row) { return j->def.integrators[row / j->def.steps_count]; }
static unsigned steps_of(const job *j, size_t row) { return j->def.steps[row % j->def.steps_count]; }

/* ---- time ------------------------------------------------------------------------------------------------------------ */

static double processor_seconds(void *user)
{
    (void)user;
    return (double)clock() / CLOCKS_PER_SEC;
}

static double now(const job *j) { return j->def.seconds(j->def.user); }

/* The least of several: one interruption in all of them would be taken for the timer's own, and no run would last as long. */
static double measure_timer(const job *j)
{
    double least = HUGE_VAL;

    for (int lot = 0; lot < TIMER_LOTS; lot++) {
        const double start = now(j);

        for (int i = 1; i < TIMER_CALLS; i++)
            now(j);
        least = fmin(least, (now(j) - start) / TIMER_CALLS);
    }
    return least;
}

/* s that `ticks` take; what the timer itself takes is taken off. */
static double time_ticks(const job *j, stf_world *world, unsigned ticks)
{
    const double start = now(j);

    stf_world_step(world, ticks);
    return now(j) - start - j->timer_overhead;
}

/* ---- a world of one row ---------------------------------------------------------------------------------------------- */

static stf_result make_world(const job *j, size_t row, stf_world **world)
{
    const stf_trade_reference *r = j->def.reference;
    stf_world *made;
    stf_result result = j->def.build(j->def.user, &made);
    if (result)
        return result;

    if (stf_world_count(made) != r->particles)
        result = STF_ERROR_PARTICLE;
    else if (stf_world_dimensions(made) != r->dimensions)
        result = STF_ERROR_DIMENSIONS;
    else
        result = stf_world_set_integrator(made, integrator_of(j, row));
    if (!result)
        result = stf_world_set_guard(made, (stf_guard){.mode = STF_GUARD_OFF});
    if (!result)
        result = stf_world_set_substeps(made, 1);
    if (!result)
        result = stf_world_set_step(made, r->duration / steps_of(j, row));
    if (result)
        stf_world_destroy(made);
    else
        *world = made;
    return result;
}

/* Its record is the address of a count. Blocks are asked one by one: the first of them counts. */
static void count_accelerations(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    uint64_t *const *counts = (uint64_t *const *)records;
    (void)time;

    for (size_t i = 0; i < record_count; i++)
        *counts[i] += particles->first == 0;
}

static const stf_force counter = {.name = "count of accelerations",
                                  .kind = STF_FIELD,
                                  .record_size = sizeof(uint64_t *),
                                  .apply = count_accelerations};

/* ---- errors ---------------------------------------------------------------------------------------------------------- */

/* Holds the world against the reference's sample. */
static void judge(const stf_trade_reference *r, const stf_world *world, unsigned sample, stf_trade_row *row)
{
    const stf_particles all = stf_world_view(world);
    const double *expected = r->path.position + sample * r->particles * r->dimensions;
    const double origin[STF_DIMENSIONS_MAX] = {0}, away = stf_trade_distance(r->middle, origin);
    const double bound = STF_TRADE_BOUND * (r->accuracy.reach + (double)FLT_EPSILON * away); /* what rests may be rounded */
    double sum = 0, momentum[STF_DIMENSIONS_MAX];
    stf_energy energy = {0};

    for (size_t i = 0; i < r->particles; i++)
        for (unsigned d = 0; d < r->dimensions; d++) {
            const double x = (double)all.position[stf_particles_offset(&all, i) + d * all.stride], off = x - *expected++;
            sum += off * off;
            row->bounded = row->bounded && fabs(x - r->middle[d]) <= bound;
        }
    row->finite = row->finite && !stf_world_find_non_finite(world, NULL);
    row->end_error = row->finite ? stf_trade_larger(0, stf_trade_rms(r, sum)) : HUGE_VAL; /* the reference may be a NaN */
    row->largest_error = stf_trade_larger(row->largest_error, row->end_error);

    stf_world_energy(world, &energy);
    stf_world_momentum(world, momentum);
    row->energy_error =
        stf_trade_larger(row->energy_error, fabs(energy.kinetic + energy.potential - r->path.energy[sample]));
    row->momentum_error = stf_trade_larger(
        row->momentum_error, stf_trade_distance(momentum, r->path.momentum + (size_t)sample * STF_DIMENSIONS_MAX));
}

/* The run that is judged: at every sample, or where it takes fewer steps than there are samples, at each of its own. */
static stf_result judge_row(const job *j, size_t index, stf_trade_row *row)
{
    const stf_trade_reference *r = j->def.reference;
    const unsigned steps = steps_of(j, index), looks = steps < r->samples ? steps : r->samples;
    uint64_t count = 0;
    uint64_t *const record = &count;
    double *estimate = &j->run.seconds[index * j->run.repeats];
    stf_world *world;

    *row = (stf_trade_row){.integrator = integrator_of(j, index)->name,
                           .in_double = IN_DOUBLE,
                           .finite = true,
                           .bounded = true,
                           .steps = steps,
                           .step = r->duration / steps,
                           .reference_error = r->accuracy.error};
    stf_result result = make_world(j, index, &world);
    if (result)
        return result;

    result = stf_world_add_force(world, &counter, &record, 1, NULL);
    *estimate = 0;
    for (unsigned look = 0; look <= looks && !result; look++) {
        if (look > 0)
            *estimate += time_ticks(j, world, steps / looks);
        judge(r, world, look * (r->samples / looks), row);
    }
    stf_world_destroy(world);
    row->bounded = row->bounded && row->finite;
    row->accelerations = (double)count;
    return result;
}

/* ---- costs ----------------------------------------------------------------------------------------------------------- */

/*
 * s a whole run takes: whole runs as long as a repeat lasts, or of a run that takes longer its beginning. An estimate may be
 * nothing but the timer's noise, and far too short: then the time that has gone, worlds and all, ends the repeat.
 */
static stf_result time_row(const stf_trade_run *of, size_t index, double estimate, double *seconds)
{
    const job *j = (const job *)of;
    const unsigned steps = steps_of(j, index);
    const double share = estimate > 0 ? j->def.repeat_seconds / estimate : (double)RUNS_MAX;
    const unsigned ticks = share < 1 ? (unsigned)ceil(steps * share) : steps;
    const unsigned most = share > 1 ? (unsigned)fmin(ceil(share), RUNS_MAX) : 1;
    const double start = now(j);
    double sum = 0;
    unsigned runs = 0;

    do {
        stf_world *world;
        const stf_result result = make_world(j, index, &world);

        if (result)
            return result;
        sum += time_ticks(j, world, ticks);
        stf_world_destroy(world);
        runs++;
    } while (runs < most && now(j) - start < REPEATS_MAX * j->def.repeat_seconds);
    *seconds = fmax(sum, 0) / runs / ticks * steps;
    return STF_OK;
}

/* ---- all ------------------------------------------------------------------------------------------------------------ */

static unsigned repeats_of(const stf_trade_def *def) { return def->repeats > 0 ? def->repeats : DEFAULT_REPEATS; }

/* Whether a size_t counts the bytes of both lists and of all repeats. */
static bool is_countable(const stf_trade_def *def)
{
    const size_t most = (SIZE_MAX / 4 - sizeof(job)) / sizeof(double) / repeats_of(def);

    return def->integrator_count <= most && def->steps_count <= most &&
           (def->steps_count == 0 || def->integrator_count <= most / def->steps_count);
}

static stf_result check(const stf_trade_def *def, const stf_trade_row *rows)
{
    if (!def || !rows || !def->build || !def->reference || !def->integrators || !def->steps)
        return STF_ERROR_NULL;
    if (!is_countable(def))
        return STF_ERROR_MEMORY;
    for (size_t i = 0; i < def->integrator_count; i++)
        if (!def->integrators[i])
            return STF_ERROR_NULL;
    for (size_t i = 0; i < def->steps_count; i++) {
        const unsigned steps = def->steps[i], samples = def->reference->samples;
        if (steps == 0 || (steps % samples != 0 && samples % steps != 0))
            return STF_ERROR_STEP;
    }
    return def->repeat_seconds >= 0 ? STF_OK : STF_ERROR_STEP;
}

/* Behind the times of the repeats: the lists need not outlive the call. */
static void copy_lists(job *j)
{
    const stf_integrator **integrators = (const stf_integrator **)(j->run.seconds + j->run.count * j->run.repeats);
    unsigned *steps = (unsigned *)(integrators + j->def.integrator_count);

    for (size_t i = 0; i < j->def.integrator_count; i++)
        integrators[i] = j->def.integrators[i];
    for (size_t i = 0; i < j->def.steps_count; i++)
        steps[i] = j->def.steps[i];
    j->def.integrators = integrators;
    j->def.steps = steps;
}

stf_result stf_trade_begin(const stf_trade_def *def, stf_trade_row *rows, stf_trade_run **run)
{
    stf_allocator allocator;
    stf_result result = run ? check(def, rows) : STF_ERROR_NULL;

    if (result)
        return result;
    if (!stf_allocator_complete(def->allocator, &allocator))
        return STF_ERROR_DESCRIPTOR;

    const size_t count = def->integrator_count * def->steps_count;
    const unsigned repeats = repeats_of(def);
    /* A list of pointers is kept as such; NOLINTNEXTLINE(bugprone-sizeof-expression) */
    const size_t bytes = sizeof(job) + count * repeats * sizeof(double) + def->integrator_count * sizeof *def->integrators +
                         def->steps_count * sizeof *def->steps;
    job *j = stf_allocator_allocate(&allocator, bytes);
    if (!j)
        return STF_ERROR_MEMORY;

    const stf_trade_reference *r = def->reference;
    *j = (job){.run = {.allocator = allocator,
                       .bytes = bytes,
                       .rows = rows,
                       .count = count,
                       .repeats = repeats,
                       .simulated = r->duration * (double)(r->particles > 0 ? r->particles : 1),
                       .seconds = (double *)(j + 1),
                       .progress = def->progress,
                       .user = def->user,
                       .total = count * ((size_t)repeats + 1),
                       .time_row = time_row},
               .def = *def};
    copy_lists(j);
    j->def.repeat_seconds = def->repeat_seconds > 0 ? def->repeat_seconds : DEFAULT_REPEAT_SECONDS;
    j->def.seconds = def->seconds ? def->seconds : processor_seconds;
    j->timer_overhead = measure_timer(j);
    for (size_t i = 0; i < count && !result; i++) {
        result = judge_row(j, i, &rows[i]);
        stf_trade_advance(&j->run);
    }
    if (result)
        stf_trade_end(&j->run);
    else
        *run = &j->run;
    return result;
}

stf_result stf_trade(const stf_trade_def *def, stf_trade_row *rows)
{
    stf_trade_run *run;
    stf_result result = stf_trade_begin(def, rows, &run);

    if (result)
        return result;
    result = stf_trade_time(&run, 1);
    stf_trade_end(run);
    return result;
}
