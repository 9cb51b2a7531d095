#include "rows.h"

#include "../scenes/scene.h"
#include "terminal.h"

#ifdef STF_DOUBLE
#define rows_measure rows_measure_f64
#else
#define rows_measure rows_measure_f32
#endif

#define INTEGRATORS_MAX 64

typedef struct job {
    const scene *scene;
    const rows_def *def;
} job;

static stf_result build(void *user, stf_world **world)
{
    const job *j = user;

    return scene_create(j->scene, NULL, world);
}

static void progress(void *user, size_t done, size_t total)
{
    const job *j = user;

    j->def->progress(j->def->user, done, total);
}

stf_result rows_measure(const rows_def *def, stf_trade_row *rows)
{
    const stf_integrator *integrators[INTEGRATORS_MAX];
    job j = {.scene = scene_find(def->scene_name), .def = def};

    for (size_t i = 0; i < def->integrator_count; i++)
        integrators[i] = stf_integrators[def->integrators[i]];
    return stf_trade(&(stf_trade_def){.build = build,
                                      .user = &j,
                                      .reference = def->reference,
                                      .integrators = integrators,
                                      .integrator_count = def->integrator_count,
                                      .steps = def->steps,
                                      .steps_count = def->steps_count,
                                      .repeats = def->repeats,
                                      .seconds = monotonic_seconds,
                                      .progress = progress},
                     rows);
}

#ifdef STF_DOUBLE

static bool exact(void *user, size_t particle, double time, double position[3], double velocity[3])
{
    const job *j = user;

    return j->scene->exact && j->scene->exact(particle, time, position, velocity);
}

stf_result rows_make_reference(const char *scene_name, stf_trade_reference_def def, stf_trade_reference **reference)
{
    job j = {.scene = scene_find(scene_name)};

    def.build = build;
    def.exact = exact;
    def.user = &j;
    return stf_trade_reference_create(&def, reference);
}

#endif
