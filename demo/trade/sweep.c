#include "sweep.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "terminal.h"

#define LONGEST 8 /* steps of the scene's own: the longest that is tried */
#define LEAST_SAMPLES 256
#define LEVELS 10
#define QUICK_LEVELS 8

/* Work is counted in accelerations x (particles + records + OVERHEAD), some 5 ns each. A count and no time decides what is left
   out, so that every shard on every machine decides alike. */
#define OVERHEAD 8
#define WORK_MAX 2.5e9
#define QUICK_WORK_MAX 3e8
#define REFERENCE_WORK_MAX 1e9
#define QUICK_REFERENCE_WORK_MAX 2.5e8
#define REFERENCE_MARGIN 1e-4 /* of the tolerance: what a reference of this quality leaves open does not matter */

typedef struct progress {
    const char *scene, *precision;
} progress;

static size_t count_integrators(void)
{
    size_t count = 0;

    while (stf_integrators[count])
        count++;
    return count;
}

static size_t place_of(const scene *of)
{
    size_t place = 0;

    while (scenes[place] && scenes[place] != of)
        place++;
    return place;
}

/* The job of a scene and an integrator goes to the shards in turn. */
static void choose_integrators(sweep *s, const sweep_settings *settings)
{
    const size_t all = count_integrators(), first = place_of(s->scene) * all;

    for (size_t i = 0; i < all; i++) {
        const bool wanted = !settings->integrator || settings->integrator == stf_integrators[i];
        if (wanted && (first + i) % settings->shards == settings->shard - 1)
            s->integrators[s->integrator_count++] = i;
    }
}

/* What one acceleration of the scene's world takes. */
static stf_result measure_work(sweep *s, double *work)
{
    stf_world *world;
    const stf_result result = scene_create(s->scene, NULL, &world);
    if (result)
        return result;

    s->particles = stf_world_count(world);
    *work = (double)s->particles + OVERHEAD;
    for (size_t i = 0; stf_world_force_at(world, i) != 0; i++) {
        size_t records = 0;

        stf_world_force_records(world, stf_world_force_at(world, i), &records);
        *work += (double)records;
    }
    stf_world_destroy(world);
    return STF_OK;
}

/* From LONGEST of the scene's steps on, halved and halved again as long as the sum of all runs stays below the most. */
static void choose_steps(sweep *s, const sweep_settings *settings, double work)
{
    const double most = settings->quick ? QUICK_WORK_MAX : WORK_MAX, longest = LONGEST * s->scene->step;
    const unsigned levels = settings->levels > 0 ? settings->levels : settings->quick ? QUICK_LEVELS : LEVELS;
    unsigned steps = (unsigned)ceil(s->scene->duration / longest);
    double evaluations = 0, spent = 0;

    for (const stf_integrator *const *each = stf_integrators; *each; each++)
        evaluations += 2 * (*each)->evaluations; /* both precisions */
    s->duration = steps * longest;
    for (s->samples = steps; s->samples < LEAST_SAMPLES;)
        s->samples *= 2;
    for (; s->levels < levels; steps *= 2) {
        spent += evaluations * steps * work;
        if (spent > most && settings->levels == 0)
            break;
        s->steps[s->levels++] = steps;
    }
}

static void report(void *user, size_t done, size_t total)
{
    const progress *p = user;

    show_progress(p->scene, p->precision, (double)done / (double)total);
}

/* Both precisions are timed in turn, so that their costs can be compared. */
static stf_result measure_rows(sweep *s, const sweep_settings *settings, const stf_trade_reference *reference)
{
    const size_t each = s->integrator_count * s->levels;
    const bool in_float = settings->precision != PRECISION_DOUBLE, in_double = settings->precision != PRECISION_FLOAT;
    progress p = {.scene = s->scene->name, .precision = "float"};
    rows_def def = {.scene_name = s->scene->name,
                    .reference = reference,
                    .integrators = s->integrators,
                    .integrator_count = s->integrator_count,
                    .steps = s->steps,
                    .steps_count = s->levels,
                    .repeats = settings->repeats,
                    .progress = report,
                    .user = &p};
    stf_trade_run *runs[2] = {NULL};
    size_t begun = 0;
    stf_result result = STF_OK;

    s->count = ((size_t)in_float + in_double) * each;
    s->rows = calloc(s->count, sizeof *s->rows);
    if (!s->rows)
        return STF_ERROR_MEMORY;
    if (in_float)
        result = rows_begin_f32(&def, s->rows, &runs[begun++]);
    p.precision = "double";
    if (in_double && !result)
        result = rows_begin_f64(&def, s->rows + in_float * each, &runs[begun++]);
    p.precision = "costs";
    if (!result)
        result = stf_trade_time(runs, begun);
    for (size_t i = 0; i < begun; i++)
        stf_trade_end(runs[i]);
    stf_trade_front(s->rows, s->count);
    return result;
}

stf_result sweep_run(sweep *s, const scene *of, const sweep_settings *settings)
{
    stf_trade_reference *reference;
    double work;

    *s = (sweep){.scene = of};
    choose_integrators(s, settings);
    stf_result result = measure_work(s, &work);
    if (result || s->integrator_count == 0)
        return result;

    choose_steps(s, settings, work);
    show_progress(of->name, "reference", 0);
    const double most = settings->quick ? QUICK_REFERENCE_WORK_MAX : REFERENCE_WORK_MAX;
    result = rows_make_reference(of->name,
                                 (stf_trade_reference_def){.duration = s->duration,
                                                           .samples = s->samples,
                                                           .error = REFERENCE_MARGIN * settings->tolerance * of->size,
                                                           .accelerations = (uint64_t)(most / work)},
                                 &reference);
    if (result)
        return result;
    s->reference = stf_trade_reference_accuracy(reference);
    result = measure_rows(s, settings, reference);
    stf_trade_reference_destroy(reference);
    show_progress(NULL, NULL, 0);
    return result;
}

void sweep_free(sweep *s)
{
    free(s->rows);
    s->rows = NULL;
    s->count = 0;
}

const stf_trade_row *sweep_row(const sweep *s, size_t integrator, bool in_double, unsigned steps)
{
    for (size_t i = 0; i < s->count; i++) {
        const stf_trade_row *row = &s->rows[i];
        if (row->in_double == in_double && row->steps == steps &&
            strcmp(row->integrator, stf_integrators[integrator]->name) == 0)
            return row;
    }
    return NULL;
}
