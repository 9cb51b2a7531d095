#include <string.h>

#include "world.h"

/* A world that outgrows its room by single adds takes this many times as much. */
#define GROWTH 2

static stf_result check_particle(const stf_world *world, const stf_particle *particle)
{
    if (!stf_vector_is_finite(particle->position) || !stf_vector_is_finite(particle->velocity))
        return STF_ERROR_NOT_FINITE;
    if (!stf_vector_fits(particle->position, world->dimensions) || !stf_vector_fits(particle->velocity, world->dimensions))
        return STF_ERROR_DIMENSIONS;
    if (!stf_is_coefficient(particle->inverse_mass) ||
        (particle->inverse_mass > 0 && particle->inverse_mass < STF_REAL_MIN))
        return STF_ERROR_MASS;
    if (!stf_is_coefficient(particle->radius) || (particle->radius > 0 && !world->keep_radius))
        return STF_ERROR_RADIUS;
    return STF_OK;
}

static void put_vector(const stf_world *world, stf_real *array, size_t index, stf_vector vector)
{
    const stf_real components[STF_DIMENSIONS_MAX] = {vector.x, vector.y, vector.z};
    stf_real *at = array + stf_world_offset(world, index);

    for (unsigned d = 0; d < world->dimensions; d++)
        at[d * world->storage.stride] = components[d];
}

static stf_vector get_vector(const stf_world *world, const stf_real *array, size_t index)
{
    stf_real components[STF_DIMENSIONS_MAX] = {0};
    const stf_real *at = array + stf_world_offset(world, index);

    for (unsigned d = 0; d < world->dimensions; d++)
        components[d] = at[d * world->storage.stride];
    return (stf_vector){components[0], components[1], components[2]};
}

static void put_particle(stf_world *world, size_t index, const stf_particle *particle)
{
    stf_storage *storage = &world->storage;

    put_vector(world, storage->position, index, particle->position);
    put_vector(world, storage->velocity, index, particle->velocity);
    if (storage->previous)
        put_vector(world, storage->previous, index, particle->position);
    storage->inverse_mass[index] = particle->inverse_mass;
    if (storage->radius)
        storage->radius[index] = particle->radius;
}

size_t stf_world_count(const stf_world *world) { return world ? world->count : 0; }

stf_result stf_world_add_many(stf_world *world, const stf_particle *particles, size_t count, size_t *first)
{
    if (!world || (!particles && count > 0))
        return STF_ERROR_NULL;
    for (size_t i = 0; i < count; i++) {
        const stf_result bad = check_particle(world, &particles[i]);
        if (bad)
            return bad;
    }
    if (count > SIZE_MAX - world->count)
        return STF_ERROR_MEMORY;

    const stf_result no_room = stf_storage_require(world, world->count + count, world->integrator, false);
    if (no_room)
        return no_room;

    if (first)
        *first = world->count;
    for (size_t i = 0; i < count; i++)
        put_particle(world, world->count + i, &particles[i]);
    world->count += count;
    world->history_stale = world->history_stale || count > 0;
    return STF_OK;
}

stf_result stf_world_add(stf_world *world, const stf_particle *particle, size_t *index)
{
    if (!world || !particle)
        return STF_ERROR_NULL;

    const stf_result bad = check_particle(world, particle);
    if (bad)
        return bad;
    if (world->count == world->storage.capacity && world->count <= SIZE_MAX / GROWTH) {
        const stf_result no_room = stf_world_reserve(world, world->count * GROWTH);
        if (no_room)
            return no_room;
    }
    return stf_world_add_many(world, particle, 1, index);
}

stf_result stf_world_get(const stf_world *world, size_t index, stf_particle *particle)
{
    if (!world || !particle)
        return STF_ERROR_NULL;
    if (index >= world->count)
        return STF_ERROR_PARTICLE;

    const stf_storage *storage = &world->storage;
    *particle = (stf_particle){
        .position = get_vector(world, storage->position, index),
        .velocity = get_vector(world, storage->velocity, index),
        .inverse_mass = storage->inverse_mass[index],
        .radius = storage->radius ? storage->radius[index] : 0,
    };
    return STF_OK;
}

stf_result stf_world_set(stf_world *world, size_t index, const stf_particle *particle)
{
    if (!world || !particle)
        return STF_ERROR_NULL;
    if (index >= world->count)
        return STF_ERROR_PARTICLE;

    const stf_result bad = check_particle(world, particle);
    if (bad)
        return bad;

    put_particle(world, index, particle);
    world->history_stale = true;
    return STF_OK;
}

stf_result stf_world_remove(stf_world *world, size_t index, size_t *moved)
{
    if (!world)
        return STF_ERROR_NULL;
    if (index >= world->count)
        return STF_ERROR_PARTICLE;

    const size_t last = world->count - 1;
    stf_real *previous = world->storage.previous;
    stf_particle particle;

    stf_world_get(world, last, &particle);
    const stf_vector last_previous = previous ? get_vector(world, previous, last) : particle.position;
    put_particle(world, index, &particle);
    if (previous)
        put_vector(world, previous, index, last_previous);
    put_particle(world, last, &(stf_particle){.inverse_mass = 0}); /* lanes without a particle are 0 */

    stf_world_renumber_forces(world, index, last);
    world->count = last;
    world->history_stale = true;
    if (moved)
        *moved = last;
    return STF_OK;
}

stf_result stf_world_clear(stf_world *world)
{
    if (!world)
        return STF_ERROR_NULL;

    const size_t lanes = stf_world_blocks(world) * world->storage.stride;
    const stf_storage *storage = &world->storage;

    memset(storage->position, 0, lanes * world->dimensions * sizeof(stf_real));
    memset(storage->velocity, 0, lanes * world->dimensions * sizeof(stf_real));
    memset(storage->inverse_mass, 0, lanes * sizeof(stf_real));
    stf_world_drop_particle_records(world);
    world->count = 0;
    return STF_OK;
}

stf_result stf_world_copy_positions(const stf_world *world, double alpha, void *positions, size_t stride_bytes)
{
    if (!world || (!positions && world->count > 0))
        return STF_ERROR_NULL;
    if (!(alpha >= 0 && alpha <= 1))
        return STF_ERROR_ALPHA;
    if (alpha < 1 && !world->keep_previous)
        return STF_ERROR_NO_PREVIOUS;
    if (stride_bytes > 0 && stride_bytes < world->dimensions * sizeof(float))
        return STF_ERROR_STRIDE;

    const stf_storage *storage = &world->storage;
    const size_t bytes = stride_bytes ? stride_bytes : world->dimensions * sizeof(float);
    const stf_real blend = (stf_real)alpha;

    for (size_t i = 0; i < world->count; i++) {
        const size_t at = stf_world_offset(world, i);
        float vertex[STF_DIMENSIONS_MAX];

        for (unsigned d = 0; d < world->dimensions; d++) {
            const stf_real now = storage->position[at + d * storage->stride];
            const stf_real before = storage->previous && alpha < 1 ? storage->previous[at + d * storage->stride] : now;
            vertex[d] = (float)(alpha < 1 ? before + blend * (now - before) : now);
        }
        memcpy((char *)positions + i * bytes, vertex, world->dimensions * sizeof(float));
    }
    return STF_OK;
}
