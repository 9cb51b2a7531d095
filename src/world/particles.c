#include <string.h>

#include "world.h"

/* A world that outgrows its room takes this many times as much. */
#define GROWTH 2

static stf_result check_particle(const stf_world *world, const stf_particle *particle)
{
    if (!stf_vector_is_finite(particle->position) || !stf_vector_is_finite(particle->velocity))
        return STF_ERROR_NOT_FINITE;
    if (!stf_vector_fits(particle->position, world->dimensions) || !stf_vector_fits(particle->velocity, world->dimensions))
        return STF_ERROR_DIMENSIONS;
    if (!stf_is_inverse_mass(particle->inverse_mass))
        return STF_ERROR_MASS;
    if (!stf_is_coefficient(particle->radius) || (particle->radius > 0 && !world->keep_radius))
        return STF_ERROR_RADIUS;
    return STF_OK;
}

static void put_vector(const stf_world *world, stf_real *array, size_t index, stf_vector vector)
{
    const stf_real components[STF_DIMENSIONS_MAX] = {vector.x, vector.y, vector.z};
    stf_real *at = array + stf_world_offset(world, index);

    for (unsigned d = 0; d < world->dimensions; d++) /* 3 at most; NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Assign) */
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

static void clear_rests(const stf_world *world, size_t index)
{
    if (!world->storage.position_rest)
        return;
    put_vector(world, world->storage.position_rest, index, (stf_vector){0, 0, 0});
    put_vector(world, world->storage.velocity_rest, index, (stf_vector){0, 0, 0});
}

/* All but the previous position and the history. */
static void put_particle(stf_world *world, size_t index, const stf_particle *particle)
{
    stf_storage *storage = &world->storage;

    put_vector(world, storage->position, index, particle->position);
    put_vector(world, storage->velocity, index, particle->velocity);
    clear_rests(world, index);
    storage->inverse_mass[index] = particle->inverse_mass;
    if (storage->radius)
        storage->radius[index] = particle->radius;
}

static void put_previous(stf_world *world, size_t index, stf_vector position)
{
    if (world->storage.previous)
        put_vector(world, world->storage.previous, index, position);
}

/* New particles, all in one block: row by row, as a particle at a time is several times slower. */
static void put_lanes(stf_world *world, size_t first, size_t n, const stf_particle *particles)
{
    const stf_storage *storage = &world->storage;
    const size_t stride = storage->stride, at = stf_world_offset(world, first);
    const unsigned dimensions = world->dimensions;

    if ((first & (stride - 1)) == 0 && n < stride) /* a block that is filled whole needs no zeros */
        stf_storage_open_block(world, first >> storage->shift);
    for (size_t i = 0; i < n; i++) {
        const stf_vector x = particles[i].position, v = particles[i].velocity;

        storage->position[at + i] = x.x;
        storage->velocity[at + i] = v.x;
        if (dimensions > 1) {
            storage->position[at + stride + i] = x.y;
            storage->velocity[at + stride + i] = v.y;
        }
        if (dimensions > 2) {
            storage->position[at + 2 * stride + i] = x.z;
            storage->velocity[at + 2 * stride + i] = v.z;
        }
        storage->inverse_mass[first + i] = particles[i].inverse_mass;
    }
    for (size_t i = 0; i < n && storage->position_rest; i++)
        clear_rests(world, first + i);
    for (size_t i = 0; i < n && storage->radius; i++)
        storage->radius[first + i] = particles[i].radius;
    for (unsigned d = 0; d < dimensions && storage->previous; d++)
        memcpy(storage->previous + at + d * stride, storage->position + at + d * stride, n * sizeof(stf_real));
}

/*
 * Whether check_particle passes all of them. A particle is nothing but reals, so one plain loop finds what is not finite; which
 * one is bad, and why, is looked for only then.
 */
static bool are_sound(const stf_world *world, size_t n, const stf_particle *particles)
{
    const stf_real *reals = (const stf_real *)(const void *)particles;
    const stf_real radius_max = world->keep_radius ? STF_REAL_MAX : 0;
    int bad = 0;

    for (size_t i = 0; i < n * (sizeof *particles / sizeof *reals); i++)
        bad |= reals[i] - reals[i] != 0;
    for (size_t i = 0; i < n; i++) {
        const stf_real w = particles[i].inverse_mass, radius = particles[i].radius;
        bad |= (w != 0) & (w < STF_REAL_MIN);
        bad |= !((radius >= 0) & (radius <= radius_max));
    }
    for (size_t i = 0; i < n && world->dimensions < STF_DIMENSIONS_MAX; i++) {
        bad |= !stf_vector_fits(particles[i].position, world->dimensions);
        bad |= !stf_vector_fits(particles[i].velocity, world->dimensions);
    }
    return !bad;
}

static stf_result check_lanes(const stf_world *world, size_t n, const stf_particle *particles)
{
    stf_result bad = STF_OK;

    if (!are_sound(world, n, particles))
        for (size_t i = 0; i < n && !bad; i++)
            bad = check_particle(world, &particles[i]);
    return bad;
}

/* What put_lanes wrote is taken back in the block that stays in use. */
static void clear_lanes_from(stf_world *world, size_t first)
{
    const stf_particle none = {.inverse_mass = 0};

    for (size_t i = first; (i & (world->storage.stride - 1)) != 0; i++) {
        put_particle(world, i, &none);
        put_previous(world, i, none.position);
    }
}

static bool same_place(stf_vector a, stf_vector b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* Room for a first lot is exact; a world that outgrows it takes much more, so that many small lots do not each move it. */
static stf_result grow(stf_world *world, size_t needed)
{
    const size_t capacity = world->storage.capacity;
    const bool outgrown = needed > capacity && world->count > 0;

    return stf_storage_require(world, outgrown && needed < GROWTH * capacity ? GROWTH * capacity : needed, world->integrator,
                               false);
}

size_t stf_world_count(const stf_world *world) { return world ? world->count : 0; }

stf_result stf_world_add_many(stf_world *world, const stf_particle *particles, size_t count, size_t *first)
{
    if (!world || (!particles && count > 0))
        return STF_ERROR_NULL;
    if (count > SIZE_MAX - world->count)
        return STF_ERROR_MEMORY;

    const stf_result no_room = grow(world, world->count + count);
    if (no_room)
        return no_room;

    for (size_t done = 0, n; done < count; done += n) {
        n = stf_world_lanes(world, world->count + done, count - done);
        const stf_result bad = check_lanes(world, n, particles + done);
        if (bad) {
            clear_lanes_from(world, world->count);
            return bad;
        }
        put_lanes(world, world->count + done, n, particles + done);
    }
    if (count > 0)
        stf_world_forget_history(world, world->count, count);
    if (first)
        *first = world->count;
    world->count += count;
    return STF_OK;
}

stf_result stf_world_add(stf_world *world, const stf_particle *particle, size_t *index)
{
    if (!world || !particle)
        return STF_ERROR_NULL;

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

    if (!same_place(particle->position, get_vector(world, world->storage.position, index)))
        put_previous(world, index, particle->position);
    put_particle(world, index, particle);
    stf_world_forget_history(world, index, 1);
    return STF_OK;
}

/* All that is kept of the last particle; its lane gets 0, as it holds none then. */
static void move_last(const stf_world *world, size_t index)
{
    const stf_storage *storage = &world->storage;
    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_storage_kept(storage, world->dimensions, kept);

    for (size_t k = 0; k < arrays; k++)
        for (size_t d = 0; d < kept[k].rows; d++) {
            stf_real *from = stf_kept_at(storage, &kept[k], world->count - 1, d);

            *stf_kept_at(storage, &kept[k], index, d) = *from;
            *from = 0;
        }
}

stf_result stf_world_remove(stf_world *world, size_t index, size_t *moved)
{
    if (!world)
        return STF_ERROR_NULL;
    if (index >= world->count)
        return STF_ERROR_PARTICLE;

    const size_t last = world->count - 1;

    move_last(world, index);
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

    stf_world_drop_particle_records(world);
    world->count = 0; /* blocks are set to 0 when they get particles again */
    return STF_OK;
}
