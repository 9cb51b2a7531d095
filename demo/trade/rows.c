#include "rows.h"

#include "../scenes/scene.h"
#include "terminal.h"

#ifdef STF_DOUBLE
#define rows_begin rows_begin_f64
#else
#define rows_begin rows_begin_f32
#endif

static stf_result build(void *user, stf_world **world)
{
    const rows_def *def = user;

    return scene_create(scene_find(def->scene_name), NULL, world);
}

static void progress(void *user, size_t done, size_t total)
{
    const rows_def *def = user;

    def->progress(def->user, done, total);
}

stf_result rows_begin(rows_def *def, stf_trade_row *rows, stf_trade_run **run)
{
    const stf_integrator *integrators[ROWS_INTEGRATORS_MAX];
    const stf_trade_def trade = {.build = build,
                                 .user = def,
                                 .reference = def->reference,
                                 .integrators = integrators,
                                 .integrator_count = def->integrator_count,
                                 .steps = def->steps,
                                 .steps_count = def->steps_count,
                                 .repeats = def->repeats,
                                 .seconds = monotonic_seconds,
                                 .progress = progress};

    for (size_t i = 0; i < def->integrator_count; i++)
        integrators[i] = stf_integrators[def->integrators[i]];
    return stf_trade_begin(&trade, rows, run);
}

#ifdef STF_DOUBLE

static bool exact(void *user, size_t particle, double time, double position[3], double velocity[3])
{
    const rows_def *def = user;
    const scene *s = scene_find(def->scene_name);

    return s->exact && s->exact(particle, time, position, velocity);
}

stf_result rows_make_reference(const char *scene_name, stf_trade_reference_def def, stf_trade_reference **reference)
{
    rows_def of = {.scene_name = scene_name};

    def.build = build;
    def.exact = exact;
    def.user = &of;
    return stf_trade_reference_create(&def, reference);
}

#endif
