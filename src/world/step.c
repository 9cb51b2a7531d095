#include <string.h>

#include "world.h"

/* What one step of the integrator advances: one block where nothing ties particles together, else all of them. */
typedef struct range {
    stf_system system; /* first, so that accelerate finds the range that its system is part of */
    const stf_world *world;
    size_t first_block, blocks;
} range;

/* a = g + F / m; a particle of no inverse mass feels neither. `a` holds F and gets a. */
static void forces_to_accelerations(size_t n, stf_real *restrict a, const stf_real *restrict inverse_mass, stf_real g)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real pushed = g + a[i] * inverse_mass[i]; /* by itself: clang then makes a vector loop */
        a[i] = inverse_mass[i] > 0 ? pushed : 0;
    }
}

static void apply_forces(const stf_world *world, stf_force_kind kind, const stf_particles *particles, double time)
{
    for (size_t i = 0; i < world->force_count; i++) {
        const stf_added_force *added = &world->forces[i];
        if (added->force->kind == kind && stf_force_acts(added))
            added->force->apply(added->records, added->record_count, particles, time);
    }
}

static void accelerate(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                       stf_real *acceleration)
{
    const range *r = (const range *)system;
    const stf_world *world = r->world;
    const size_t stride = world->storage.stride, block_length = stf_world_block_length(world);

    memset(acceleration, 0, system->length * sizeof(stf_real));
    for (size_t b = 0; b < r->blocks; b++) {
        const size_t at = b * block_length;
        const stf_particles block =
            stf_world_particles(world, r->first_block + b, 1, position + at, velocity + at, acceleration + at);
        apply_forces(world, STF_FIELD, &block, time);
    }
    /* Where a link acts the range is all of the world; where none does this calls nothing. */
    const stf_particles all = stf_world_particles(world, r->first_block, r->blocks, position, velocity, acceleration);
    apply_forces(world, STF_LINK, &all, time);
    for (size_t b = 0; b < r->blocks; b++) {
        const stf_real *inverse_mass = world->storage.inverse_mass + (r->first_block + b) * stride;
        for (unsigned d = 0; d < world->dimensions; d++)
            forces_to_accelerations(stride, acceleration + b * block_length + d * stride, inverse_mass, world->gravity[d]);
    }
}

static range make_range(const stf_world *world, size_t first_block, size_t blocks)
{
    const stf_storage *storage = &world->storage;
    const size_t at = first_block * stf_world_block_length(world);
    range r = {
        .system = {.length = blocks * stf_world_block_length(world),
                   .position = storage->position + at,
                   .velocity = storage->velocity + at,
                   .accelerate = accelerate},
        .world = world,
        .first_block = first_block,
        .blocks = blocks,
    };

    for (int k = 0; k < storage->work_arrays; k++)
        r.system.work[k] = storage->work[k];
    for (int k = 0; k < storage->history_arrays; k++)
        r.system.history[k] = storage->history[k] + at;
    return r;
}

/* All ticks of one range, so that a block is read from memory once for all of them. */
static void step_range(const stf_world *world, size_t first_block, size_t blocks, unsigned ticks)
{
    range r = make_range(world, first_block, blocks);
    const double substep = world->step / world->substeps;
    const uint64_t start = world->ticks - world->step_start_tick;
    const stf_real dt = (stf_real)substep;

    r.system.history_stale = world->history_stale;
    for (unsigned tick = 0; tick < ticks; tick++) {
        if (world->keep_previous && tick + 1 == ticks)
            memcpy(world->storage.previous + first_block * stf_world_block_length(world), r.system.position,
                   r.system.length * sizeof(stf_real));
        for (unsigned s = 0; s < world->substeps; s++) {
            r.system.time = world->step_start_time + (double)(start + tick) * world->step + s * substep;
            world->integrator->step(&r.system, dt);
            r.system.history_stale = false;
        }
    }
}

stf_result stf_world_step(stf_world *world, unsigned ticks)
{
    if (!world)
        return STF_ERROR_NULL;

    const size_t blocks = stf_world_blocks(world);
    const size_t range_blocks = stf_world_is_tied(world) ? blocks : 1;

    for (size_t first = 0; first < blocks; first += range_blocks)
        step_range(world, first, range_blocks, ticks);
    world->history_stale = world->history_stale && ticks == 0;
    world->ticks += ticks;
    return STF_OK;
}

stf_result stf_world_accelerations(const stf_world *world, double time, const stf_real *position, const stf_real *velocity,
                                   stf_real *acceleration)
{
    if (!world || !position || !velocity || !acceleration)
        return STF_ERROR_NULL;

    range r = make_range(world, 0, stf_world_blocks(world));

    accelerate(&r.system, time, position, velocity, acceleration);
    return STF_OK;
}
