/* A snapshot is the world's own struct, its forces with their records, and its arrays as they lie in their blocks. */
#include <string.h>

#include "steadfast/save.h"
#include "world.h"

/* "snapshot" in ASCII, so that other memory is not taken for one. */
#define TAG UINT64_C(0x736e617073686f74)

/*
 * In memory from malloc the arrays of a snapshot should not start just behind the place in a page at which the world's arrays
 * do ("4K aliasing", see storage.c): measured, snapshot and restore then take 7 times memcpy and not 2.
 */
#define APART 1024

/* Of the world's pointers only the integrator is used again. */
typedef struct head {
    uint64_t tag;
    size_t bytes;
    stf_world world;
    char apart[APART];
} head;

typedef struct kept_force {
    const stf_force *force;
    stf_force_id id;
    size_t record_count;
} kept_force;

static size_t array_bytes(const stf_world *world, const stf_kept *kept)
{
    return stf_world_blocks(world) * world->storage.stride * kept->rows * sizeof(stf_real);
}

size_t stf_world_snapshot_size(const stf_world *world)
{
    if (!world)
        return 0;

    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_world_kept(world, kept);
    size_t bytes = sizeof(head) + world->force_count * sizeof(kept_force);

    for (size_t i = 0; i < world->force_count; i++)
        bytes += world->forces[i].record_count * world->forces[i].force->record_size;
    for (size_t k = 0; k < arrays; k++)
        bytes += array_bytes(world, &kept[k]);
    return bytes;
}

static char *put(char *at, const void *bytes, size_t count)
{
    if (count > 0)
        memcpy(at, bytes, count);
    return at + count;
}

stf_result stf_world_snapshot(const stf_world *world, void *memory, size_t size)
{
    if (!world || !memory)
        return STF_ERROR_NULL;

    const head start = {.tag = TAG, .bytes = stf_world_snapshot_size(world), .world = *world};
    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_world_kept(world, kept);
    char *at = memory;

    if (size < start.bytes)
        return STF_ERROR_BUFFER;
    at = put(at, &start, sizeof start);
    for (size_t i = 0; i < world->force_count; i++) {
        const stf_added_force *added = &world->forces[i];
        const kept_force force = {.force = added->force, .id = added->id, .record_count = added->record_count};

        at = put(at, &force, sizeof force);
        at = put(at, added->records, added->record_count * added->force->record_size);
    }
    for (size_t k = 0; k < arrays; k++)
        at = put(at, kept[k].array, array_bytes(world, &kept[k]));
    return STF_OK;
}

static bool has_room(const stf_world *world, const stf_world *then)
{
    return world->dimensions == then->dimensions && world->keep_previous == then->keep_previous &&
           world->keep_radius == then->keep_radius && world->compensated == then->compensated &&
           world->storage.capacity >= then->count &&
           world->storage.history_arrays >= then->integrator->history_arrays &&
           world->storage.work_arrays >= then->integrator->work_arrays;
}

static kept_force force_at(const char *at)
{
    kept_force force;

    memcpy(&force, at, sizeof force);
    return force;
}

static bool is_same(const stf_added_force *added, const kept_force *kept)
{
    return added->id == kept->id && added->force == kept->force;
}

/* Whether the world has all forces of the snapshot, in its order, with room for their records. */
static bool has_forces(const stf_world *world, const stf_world *then, const char *at)
{
    size_t found = 0;

    for (size_t i = 0; i < world->force_count && found < then->force_count; i++) {
        const kept_force kept = force_at(at);

        if (!is_same(&world->forces[i], &kept))
            continue;
        if (!stf_force_has_room(&world->forces[i], kept.record_count))
            return false;
        at += sizeof kept + kept.record_count * kept.force->record_size;
        found++;
    }
    return found == then->force_count;
}

/* Records that are as they were need not be arranged again. */
static void restore_records(stf_added_force *added, size_t record_count, const char *records)
{
    const size_t bytes = record_count * added->force->record_size;

    if (added->record_count == record_count && (bytes == 0 || memcmp(added->records, records, bytes) == 0))
        return;
    if (bytes > 0)
        memcpy(added->records, records, bytes);
    stf_force_arrange_records(added, record_count);
}

/* Forces that the snapshot has not are younger, and go. Returns where the arrays start. */
static const char *restore_forces(stf_world *world, const stf_world *then, const char *at)
{
    size_t found = 0;

    for (size_t i = 0; i < world->force_count; i++) {
        stf_added_force *added = &world->forces[i];
        const kept_force kept = found < then->force_count ? force_at(at) : (kept_force){.force = NULL};

        if (!is_same(added, &kept)) {
            stf_force_release_records(world, added);
            continue;
        }
        at += sizeof kept;
        restore_records(added, kept.record_count, at);
        at += kept.record_count * kept.force->record_size;
        world->forces[found++] = *added;
    }
    world->force_count = found;
    return at;
}

static void restore_settings(stf_world *world, const stf_world *then)
{
    stf_world now = *then;

    now.allocator = world->allocator;
    now.parallel = world->parallel;
    now.kernels = world->kernels;
    now.stepper = stf_kernels_integrator(world->kernels, then->integrator);
    now.storage = world->storage;
    now.guard = world->guard;
    now.forces = world->forces;
    now.force_count = world->force_count;
    now.force_capacity = world->force_capacity;
    *world = now;
    stf_guard_reset(world);
}

stf_result stf_world_restore(stf_world *world, const void *memory, size_t size)
{
    if (!world || !memory)
        return STF_ERROR_NULL;

    const char *at = (const char *)memory + sizeof(head);
    head start;

    if (size < sizeof start)
        return STF_ERROR_SNAPSHOT;
    memcpy(&start, memory, sizeof start);
    if (start.tag != TAG || start.bytes > size || !has_room(world, &start.world) || !has_forces(world, &start.world, at))
        return STF_ERROR_SNAPSHOT;

    stf_kept kept[STF_KEPT_MAX];
    const size_t stride = start.world.storage.stride;

    at = restore_forces(world, &start.world, at);
    restore_settings(world, &start.world);
    if (stride != world->storage.stride && world->count > 0)
        stf_storage_open_block(world, 0);
    const size_t arrays = stf_world_kept(world, kept);
    for (size_t k = 0; k < arrays; k++) {
        stf_storage_copy_rows(kept[k].array, world->storage.stride, at, stride, kept[k].rows, world->count);
        at += (world->count + stride - 1) / stride * stride * kept[k].rows * sizeof(stf_real);
    }
    return STF_OK;
}
