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

/* Copies an array of `rows` components a block. Strides differ only while there is one block. */
static void copy_array(stf_real *to, const stf_storage *to_storage, const stf_real *from, const stf_storage *from_storage,
                       size_t rows, size_t count)
{
    if (!to || !from)
        return;
    if (to_storage->stride == from_storage->stride) {
        const size_t blocks = (count + from_storage->stride - 1) >> from_storage->shift;
        memcpy(to, from, blocks * from_storage->stride * rows * sizeof(stf_real));
        return;
    }
    for (size_t row = 0; row < rows; row++)
        memcpy(to + row * to_storage->stride, from + row * from_storage->stride, count * sizeof(stf_real));
}

static void copy_storage(stf_storage *to, const stf_storage *from, size_t dimensions, size_t count)
{
    copy_array(to->position, to, from->position, from, dimensions, count);
    copy_array(to->velocity, to, from->velocity, from, dimensions, count);
    copy_array(to->position_rest, to, from->position_rest, from, dimensions, count);
    copy_array(to->velocity_rest, to, from->velocity_rest, from, dimensions, count);
    copy_array(to->previous, to, from->previous, from, dimensions, count);
    copy_array(to->inverse_mass, to, from->inverse_mass, from, 1, count);
    copy_array(to->radius, to, from->radius, from, 1, count);
    for (int k = 0; k < to->history_arrays; k++)
        copy_array(to->history[k], to, from->history[k], from, dimensions, count);
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

/* All blocks that have particles, in an array of `rows` components a block. */
static void clear_array(stf_real *array, const stf_storage *storage, size_t rows, size_t count)
{
    const size_t blocks = (count + storage->stride - 1) >> storage->shift;

    memset(array, 0, blocks * storage->stride * rows * sizeof(stf_real));
}

static void open_block(const stf_storage *storage, size_t dimensions, size_t block)
{
    const size_t row = storage->stride, vectors = row * dimensions, bytes = sizeof(stf_real);

    memset(storage->position + block * vectors, 0, vectors * bytes);
    memset(storage->velocity + block * vectors, 0, vectors * bytes);
    memset(storage->inverse_mass + block * row, 0, row * bytes);
    if (storage->position_rest) {
        memset(storage->position_rest + block * vectors, 0, vectors * bytes);
        memset(storage->velocity_rest + block * vectors, 0, vectors * bytes);
    }
    if (storage->previous)
        memset(storage->previous + block * vectors, 0, vectors * bytes);
    if (storage->radius)
        memset(storage->radius + block * row, 0, row * bytes);
    for (int k = 0; k < storage->history_arrays; k++)
        memset(storage->history[k] + block * vectors, 0, vectors * bytes);
}

void stf_storage_open_block(const stf_world *world, size_t block) { open_block(&world->storage, world->dimensions, block); }

static int larger(int a, int b) { return a > b ? a : b; }

stf_result stf_storage_require(stf_world *world, size_t capacity, const stf_integrator *integrator, bool whole)
{
    const stf_storage *old = &world->storage;
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
    for (size_t b = 0; b << new.shift < world->count && new.stride != old->stride; b++)
        open_block(&new, world->dimensions, b);
    copy_storage(&new, old, world->dimensions, world->count);
    for (int k = old->history_arrays; k < new.history_arrays; k++)
        clear_array(new.history[k], &new, world->dimensions, world->count);
    stf_storage_release(world);
    world->storage = new;
    world->checkpoint.is_valid = false;
    return STF_OK;
}

size_t stf_storage_kept(const stf_world *world, stf_kept kept[STF_KEPT_MAX])
{
    const stf_storage *storage = &world->storage;
    const size_t dimensions = world->dimensions;
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
    for (int k = 0; k < world->integrator->history_arrays; k++)
        kept[n++] = (stf_kept){storage->history[k], dimensions, STF_KEPT_ANYTHING};
    return n;
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

void stf_storage_release(stf_world *world)
{
    stf_allocator_release(&world->allocator, world->storage.memory, world->storage.bytes);
    world->storage = (stf_storage){0};
}

void stf_world_clear_history(stf_world *world)
{
    const stf_storage *storage = &world->storage;

    for (int k = 0; k < storage->history_arrays; k++)
        clear_array(storage->history[k], storage, world->dimensions, world->count);
}

void stf_world_clear_velocity_rest(stf_world *world)
{
    if (world->storage.velocity_rest)
        clear_array(world->storage.velocity_rest, &world->storage, world->dimensions, world->count);
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
