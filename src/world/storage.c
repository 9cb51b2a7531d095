#include <string.h>

#include "world.h"

/* More rows than any lane has: 3 dimensions x (state, its rests, previous, history and work arrays, checkpoint), inverse mass,
   radius. */
#define ARRAYS_BOUND (5 + STF_HISTORY_ARRAYS_MAX + STF_WORK_ARRAYS_MAX + STF_CHANGING_MAX)
#define ROWS_BOUND (STF_DIMENSIONS_MAX * ARRAYS_BOUND + 2)

/*
 * A load that follows a store to the same place of another page waits for it (the "4K aliasing" of x86 manuals), and blocks are
 * whole quarters of pages: arrays of several blocks each start at another place of a page. Measured: 0.36 ns a particle and
 * step, 0.47 where all start at the same place.
 */
#define PAGE ((size_t)4096)
#define STAGGER ((size_t)(11 * STF_ALIGNMENT))

/* Gives `reals` of the memory to an array; counts only, where there is no memory yet. */
static stf_real *take(stf_storage *storage, size_t reals)
{
    const size_t bytes = reals * sizeof(stf_real), place = storage->taken++ * STAGGER % PAGE;
    const size_t at = bytes < PAGE ? storage->bytes : (storage->bytes + PAGE - 1 - place) / PAGE * PAGE + place;

    storage->bytes = at + bytes;
    return storage->memory ? (stf_real *)(void *)((char *)storage->memory + at) : NULL;
}

static void lay_out(stf_storage *storage, const stf_world *world)
{
    const size_t vectors = storage->capacity * world->dimensions;
    const size_t parts = stf_world_parts(world, storage->capacity / storage->stride);
    const size_t work = storage->whole ? vectors : parts * storage->stride * world->dimensions;
    const size_t changing = (world->compensated ? 4 : 2) + (size_t)storage->history_arrays; /* as stf_storage_changing */

    storage->bytes = storage->taken = 0;
    storage->position = take(storage, vectors);
    storage->velocity = take(storage, vectors);
    storage->inverse_mass = take(storage, storage->capacity);
    storage->previous = world->keep_previous ? take(storage, vectors) : NULL;
    storage->radius = world->keep_radius ? take(storage, storage->capacity) : NULL;
    storage->position_rest = world->compensated ? take(storage, vectors) : NULL;
    storage->velocity_rest = world->compensated ? take(storage, vectors) : NULL;
    for (int k = 0; k < storage->history_arrays; k++)
        storage->history[k] = take(storage, vectors);
    for (int k = 0; k < storage->work_arrays; k++)
        storage->work[k] = take(storage, work);
    storage->checkpoint = storage->guarded ? take(storage, vectors * changing) : NULL;
}

void stf_storage_copy_rows(void *to, size_t to_stride, const void *from, size_t from_stride, size_t rows, size_t count)
{
    const size_t to_bytes = to_stride * sizeof(stf_real), from_bytes = from_stride * sizeof(stf_real);

    if (to_stride == from_stride)
        memcpy(to, from, (count + from_stride - 1) / from_stride * rows * from_bytes);
    for (size_t row = 0; to_stride != from_stride && row < rows; row++)
        memcpy((char *)to + row * to_bytes, (const char *)from + row * from_bytes, count * sizeof(stf_real));
}

/* All that is kept in `from`, to the same arrays of `to`: of two storages of this world, which has particles. */
static void copy_storage(const stf_world *world, const stf_storage *to, const stf_storage *from)
{
    stf_kept old[STF_KEPT_MAX], new[STF_KEPT_MAX];
    const size_t arrays = stf_storage_kept(from, world->dimensions, old);

    stf_storage_kept(to, world->dimensions, new);
    for (size_t k = 0; k < arrays; k++)
        stf_storage_copy_rows(new[k].array, to->stride, old[k].array, from->stride, old[k].rows, world->count);
}

/* A small world has one small block, so that it does not step hundreds of empty lanes; a large one has whole blocks. */
static void choose_blocks(stf_storage *storage, size_t capacity)
{
    storage->stride = STF_ROW_MULTIPLE;
    while (storage->stride < capacity && storage->stride < STF_BLOCK_MAX)
        storage->stride *= 2;
    storage->shift = 0;
    while ((size_t)1 << storage->shift < storage->stride)
        storage->shift++;
    storage->capacity = (capacity + storage->stride - 1) / storage->stride * storage->stride;
    if (storage->capacity == 0)
        storage->capacity = storage->stride;
}

void stf_storage_open_block(const stf_world *world, size_t block)
{
    const stf_storage *storage = &world->storage;
    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_storage_kept(storage, world->dimensions, kept);

    for (size_t k = 0; k < arrays; k++)
        memset(stf_kept_at(storage, &kept[k], block << storage->shift, 0), 0,
               kept[k].rows * storage->stride * sizeof(stf_real));
}

/* All blocks that have particles, of an array of vectors. */
static void clear_vectors(const stf_world *world, stf_real *array)
{
    memset(array, 0, stf_world_blocks(world) * stf_world_block_length(world) * sizeof(stf_real));
}

static int larger(int a, int b) { return a > b ? a : b; }

stf_result stf_storage_require(stf_world *world, size_t capacity, const stf_integrator *integrator, bool whole)
{
    const stf_storage before = world->storage, *old = &before;
    const bool guarded = world->guard.mode != STF_GUARD_OFF;

    if (old->memory && capacity <= old->capacity && integrator->work_arrays <= old->work_arrays &&
        integrator->history_arrays <= old->history_arrays && whole <= old->whole && guarded <= old->guarded)
        return STF_OK;
    if (capacity > (SIZE_MAX - (ARRAYS_BOUND + 2) * PAGE) / sizeof(stf_real) / ROWS_BOUND - STF_BLOCK_MAX)
        return STF_ERROR_MEMORY;

    stf_storage new = {.whole = whole || old->whole,
                       .guarded = guarded || old->guarded,
                       .history_arrays = larger(integrator->history_arrays, old->history_arrays),
                       .work_arrays = larger(integrator->work_arrays, old->work_arrays)};
    choose_blocks(&new, capacity > old->capacity ? capacity : old->capacity);
    lay_out(&new, world);
    new.memory = stf_allocator_allocate(&world->allocator, new.bytes);
    if (!new.memory)
        return STF_ERROR_MEMORY;

    lay_out(&new, world);
    world->storage = new;
    world->checkpoint.is_valid = false;
    if (world->count > 0 && new.stride != old->stride)
        stf_storage_open_block(world, 0); /* there is no other */
    if (world->count > 0)
        copy_storage(world, &new, old);
    for (int k = old->history_arrays; k < new.history_arrays; k++)
        clear_vectors(world, new.history[k]);
    stf_allocator_release(&world->allocator, old->memory, old->bytes);
    return STF_OK;
}

size_t stf_storage_kept(const stf_storage *storage, size_t dimensions, stf_kept kept[STF_KEPT_MAX])
{
    size_t n = 0;

    kept[n++] = (stf_kept){storage->position, dimensions, STF_KEPT_FINITE};
    kept[n++] = (stf_kept){storage->velocity, dimensions, STF_KEPT_FINITE};
    kept[n++] = (stf_kept){storage->inverse_mass, 1, STF_KEPT_INVERSE_MASS};
    if (storage->previous)
        kept[n++] = (stf_kept){storage->previous, dimensions, STF_KEPT_FINITE};
    if (storage->radius)
        kept[n++] = (stf_kept){storage->radius, 1, STF_KEPT_RADIUS};
    if (storage->position_rest) {
        kept[n++] = (stf_kept){storage->position_rest, dimensions, STF_KEPT_FINITE};
        kept[n++] = (stf_kept){storage->velocity_rest, dimensions, STF_KEPT_FINITE};
    }
    for (int k = 0; k < storage->history_arrays; k++)
        kept[n++] = (stf_kept){storage->history[k], dimensions, STF_KEPT_ANYTHING};
    return n;
}

size_t stf_world_kept(const stf_world *world, stf_kept kept[STF_KEPT_MAX])
{
    const int unused = world->storage.history_arrays - world->integrator->history_arrays;

    return stf_storage_kept(&world->storage, world->dimensions, kept) - (size_t)unused;
}

size_t stf_storage_changing(const stf_storage *storage, stf_real *arrays[STF_CHANGING_MAX])
{
    size_t n = 0;

    arrays[n++] = storage->position;
    arrays[n++] = storage->velocity;
    if (storage->position_rest) {
        arrays[n++] = storage->position_rest;
        arrays[n++] = storage->velocity_rest;
    }
    for (int k = 0; k < storage->history_arrays; k++)
        arrays[n++] = storage->history[k];
    return n;
}

static void fill(stf_real *row, size_t n, stf_real value)
{
    for (size_t i = 0; i < n; i++)
        row[i] = value;
}

void stf_world_forget_history(stf_world *world, size_t first, size_t count)
{
    const stf_storage *storage = &world->storage;

    for (int k = 0; k < storage->history_arrays; k++)
        for (size_t i = first, n; i < first + count; i += n) {
            n = stf_world_lanes(world, i, first + count - i);
            for (unsigned d = 0; d < world->dimensions; d++)
                fill(storage->history[k] + stf_world_offset(world, i) + d * storage->stride, n, (stf_real)NAN);
        }
    world->history_stale = true;
}

void stf_world_renew_history(stf_world *world)
{
    const stf_storage *storage = &world->storage;

    for (int k = 0; k < storage->history_arrays; k++)
        clear_vectors(world, storage->history[k]);
    if (storage->velocity_rest)
        clear_vectors(world, storage->velocity_rest);
    stf_world_forget_history(world, 0, world->count);
}

stf_particles stf_world_particles(const stf_world *world, size_t first_block, size_t blocks, const stf_real *position,
                                  const stf_real *velocity, stf_real *force)
{
    const size_t stride = world->storage.stride, first = first_block * stride;
    const size_t left = world->count - first;

    return (stf_particles){
        .count = left < blocks * stride ? left : blocks * stride,
        .first = first,
        .stride = stride,
        .shift = world->storage.shift,
        .dimensions = world->dimensions,
        .position = position,
        .velocity = velocity,
        .end = left < blocks * stride ? left : blocks * stride,
        .parts = 1,
        .inverse_mass = world->storage.inverse_mass + first,
        .force = force,
    };
}

stf_particles stf_world_view(const stf_world *world)
{
    if (!world)
        return (stf_particles){0};

    return stf_world_particles(world, 0, stf_world_blocks(world), world->storage.position, world->storage.velocity, NULL);
}

stf_result stf_world_reserve(stf_world *world, size_t capacity)
{
    if (!world)
        return STF_ERROR_NULL;

    return stf_storage_require(world, capacity, world->integrator, false);
}
