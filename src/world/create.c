#include "world.h"

stf_result stf_world_check_step(double step, unsigned substeps)
{
    if (substeps == 0 || substeps > STF_SUBSTEPS_MAX)
        return STF_ERROR_SUBSTEPS;

    const double integrator_step = step / substeps;

    return integrator_step >= (double)STF_REAL_MIN && integrator_step <= (double)STF_REAL_MAX ? STF_OK : STF_ERROR_STEP;
}

static bool is_integrator(const stf_integrator *integrator, bool compensated)
{
    return integrator->name && integrator->step && (!compensated || (integrator->flags & STF_COMPENSATES) != 0) &&
           integrator->work_arrays >= 0 && integrator->work_arrays <= STF_WORK_ARRAYS_MAX && integrator->history_arrays >= 0 &&
           integrator->history_arrays <= STF_HISTORY_ARRAYS_MAX;
}

stf_result stf_world_check_gravity(stf_vector gravity, unsigned dimensions)
{
    if (!stf_vector_is_finite(gravity))
        return STF_ERROR_NOT_FINITE;
    return stf_vector_fits(gravity, dimensions) ? STF_OK : STF_ERROR_DIMENSIONS;
}

void stf_world_put_gravity(stf_world *world, stf_vector gravity)
{
    world->gravity[0] = gravity.x + 0; /* -0 becomes 0: then it does not matter which loop adds it */
    world->gravity[1] = gravity.y + 0;
    world->gravity[2] = gravity.z + 0;
}

/* The def with its zeros replaced by what they stand for. */
static stf_world_def with_defaults(const stf_world_def *given)
{
    stf_world_def def = *given;

    if (def.dimensions == 0)
        def.dimensions = STF_DIMENSIONS_MAX;
    if (!def.integrator)
        def.integrator = &stf_semi_implicit_euler;
    if (def.step == 0)
        def.step = STF_DEFAULT_STEP;
    if (def.substeps == 0)
        def.substeps = 1;
    return def;
}

static stf_result check_def(const stf_world_def *def)
{
    if (def->dimensions > STF_DIMENSIONS_MAX)
        return STF_ERROR_DIMENSIONS;

    const stf_result bad = stf_world_check_step(def->step, def->substeps);
    if (bad)
        return bad;
    if (!is_integrator(def->integrator, def->compensated))
        return STF_ERROR_DESCRIPTOR;
    return stf_world_check_gravity(def->gravity, def->dimensions);
}

stf_result stf_world_create(const stf_world_def *given, stf_world **world)
{
    if (!given || !world)
        return STF_ERROR_NULL;

    stf_world_def def = with_defaults(given);
    stf_result bad = check_def(&def);
    stf_allocator allocator;

    if (!bad)
        bad = stf_guard_complete(&def.guard);
    if (bad)
        return bad;
    if (def.parallel.tasks > 1 && !def.parallel.run)
        return STF_ERROR_DESCRIPTOR;
    if (!stf_allocator_complete(def.allocator, &allocator))
        return STF_ERROR_DESCRIPTOR;

    stf_world *made = stf_allocator_allocate(&allocator, sizeof *made);
    if (!made)
        return STF_ERROR_MEMORY;
    *made = (stf_world){
        .allocator = allocator,
        .parallel = def.parallel,
        .kernels = stf_kernels_choose(),
        .integrator = def.integrator,
        .dimensions = def.dimensions,
        .substeps = def.substeps,
        .keep_previous = def.keep_previous,
        .keep_radius = def.keep_radius,
        .compensated = def.compensated,
        .step = def.step,
        .guard = def.guard,
        .history_stale = true,
    };
    made->stepper = stf_kernels_integrator(made->kernels, def.integrator);
    stf_world_put_gravity(made, def.gravity);

    const stf_result no_room = stf_storage_require(made, def.capacity, def.integrator, false);
    if (no_room) {
        stf_world_destroy(made);
        return no_room;
    }
    *world = made;
    return STF_OK;
}

void stf_world_destroy(stf_world *world)
{
    if (!world)
        return;

    const stf_allocator allocator = world->allocator;

    stf_world_release_forces(world);
    stf_allocator_release(&allocator, world->storage.memory, world->storage.bytes);
    stf_allocator_release(&allocator, world, sizeof *world);
}

stf_result stf_world_set_integrator(stf_world *world, const stf_integrator *integrator)
{
    if (!world || !integrator)
        return STF_ERROR_NULL;
    if (!is_integrator(integrator, world->compensated))
        return STF_ERROR_DESCRIPTOR;

    const stf_result no_room = stf_storage_require(world, world->count, integrator, false);
    if (no_room)
        return no_room;

    if (integrator != world->integrator)
        stf_world_renew_history(world);
    world->integrator = integrator;
    world->stepper = stf_kernels_integrator(world->kernels, integrator);
    return STF_OK;
}

stf_result stf_world_set_gravity(stf_world *world, stf_vector gravity)
{
    if (!world)
        return STF_ERROR_NULL;

    const stf_result bad = stf_world_check_gravity(gravity, world->dimensions);
    if (bad)
        return bad;

    if (gravity.x == world->gravity[0] && gravity.y == world->gravity[1] && gravity.z == world->gravity[2])
        return STF_OK;

    stf_world_put_gravity(world, gravity);
    world->history_stale = true;
    return STF_OK;
}

stf_result stf_world_set_step(stf_world *world, double step)
{
    if (!world)
        return STF_ERROR_NULL;

    const stf_result bad = stf_world_check_step(step, world->substeps);
    if (bad)
        return bad;
    if (step == world->step)
        return STF_OK;

    world->step_start_time = stf_world_time(world);
    world->step_start_tick = world->ticks;
    world->step = step;
    stf_world_forget_history(world, 0, world->count);
    return STF_OK;
}

stf_result stf_world_set_substeps(stf_world *world, unsigned substeps)
{
    if (!world)
        return STF_ERROR_NULL;

    const stf_result bad = stf_world_check_step(world->step, substeps);
    if (bad)
        return bad;

    if (substeps != world->substeps)
        stf_world_forget_history(world, 0, world->count);
    world->substeps = substeps;
    return STF_OK;
}

const char *stf_world_isa(const stf_world *world) { return world ? world->kernels->name : NULL; }
const stf_integrator *stf_world_integrator(const stf_world *world) { return world ? world->integrator : NULL; }
unsigned stf_world_dimensions(const stf_world *world) { return world ? world->dimensions : 0; }
unsigned stf_world_substeps(const stf_world *world) { return world ? world->substeps : 0; }
double stf_world_step_size(const stf_world *world) { return world ? world->step : 0; }
uint64_t stf_world_ticks(const stf_world *world) { return world ? world->ticks : 0; }

double stf_world_time(const stf_world *world)
{
    return world ? world->step_start_time + (double)(world->ticks - world->step_start_tick) * world->step : 0;
}

stf_vector stf_world_gravity(const stf_world *world)
{
    return world ? (stf_vector){world->gravity[0], world->gravity[1], world->gravity[2]} : (stf_vector){0, 0, 0};
}
