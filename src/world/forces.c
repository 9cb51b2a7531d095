#include <string.h>

#include "world.h"

#define FIRST_FORCE_CAPACITY 8

static bool is_force(const stf_force *force)
{
    const bool has_fields = force->fields && strcmp(force->fields, STF_NOT_SAVED) != 0;

    return force->name && !force->apply != !force->drag && !(force->splits && force->rounds) &&
           (force->kind == STF_FIELD || force->kind == STF_LINK) &&
           (!has_fields || stf_fields_size(force->fields) == force->record_size);
}

/* Bytes for so many records and what is arranged behind them; 0 if that is no size_t. */
static size_t bytes_of(const stf_force *force, size_t record_count)
{
    const size_t arranged = force->arranged_size ? force->arranged_size(record_count) : 0;
    const size_t most = SIZE_MAX / 2;

    if (record_count > (most - STF_ALIGNMENT) / force->record_size || arranged > most)
        return 0;
    return (record_count * force->record_size + STF_ALIGNMENT - 1) / STF_ALIGNMENT * STF_ALIGNMENT + arranged;
}

stf_result stf_force_check_records(const stf_world *world, const stf_force *force, const void *records, size_t record_count,
                                   size_t particle_count)
{
    if (!records && record_count > 0)
        return STF_ERROR_NULL;
    if (force->record_size == 0 && record_count > 0)
        return STF_ERROR_PARAMETERS;
    if (record_count > 0 && bytes_of(force, record_count) == 0)
        return STF_ERROR_MEMORY;
    for (size_t i = 0; force->check && i < record_count; i++) {
        const void *record = (const char *)records + i * force->record_size;
        const stf_result bad = force->check(record, world->dimensions, particle_count);
        if (bad)
            return bad;
    }
    return STF_OK;
}

void stf_force_arrange_records(stf_added_force *added, size_t record_count)
{
    added->record_count = record_count;
    if (added->force->arrange && record_count > 0)
        added->force->arrange(added->records, record_count);
}

bool stf_force_has_room(const stf_added_force *added, size_t record_count)
{
    const size_t bytes = record_count > 0 ? bytes_of(added->force, record_count) : 0;

    return bytes <= added->bytes;
}

stf_result stf_force_allocate_records(const stf_world *world, stf_added_force *added, size_t record_count)
{
    added->records = NULL;
    added->record_count = record_count;
    added->bytes = 0;
    if (record_count == 0)
        return STF_OK;

    added->bytes = bytes_of(added->force, record_count);
    added->records = added->bytes ? stf_allocator_allocate(&world->allocator, added->bytes) : NULL;
    return added->records ? STF_OK : STF_ERROR_MEMORY;
}

/* Fills in `added`'s own copy of the records, in the order that the force wants. */
static stf_result copy_records(const stf_world *world, stf_added_force *added, const void *records, size_t record_count)
{
    const stf_result no_memory = stf_force_allocate_records(world, added, record_count);

    if (no_memory)
        return no_memory;
    if (record_count > 0)
        memcpy(added->records, records, record_count * added->force->record_size);
    stf_force_arrange_records(added, record_count);
    return STF_OK;
}

void stf_force_release_records(const stf_world *world, stf_added_force *added)
{
    stf_allocator_release(&world->allocator, added->records, added->bytes);
}

static stf_result require_force_room(stf_world *world)
{
    if (world->force_count < world->force_capacity)
        return STF_OK;

    const size_t capacity = world->force_capacity ? 2 * world->force_capacity : FIRST_FORCE_CAPACITY;
    stf_added_force *forces = stf_allocator_allocate(&world->allocator, capacity * sizeof *forces);

    if (!forces)
        return STF_ERROR_MEMORY;
    if (world->forces)
        memcpy(forces, world->forces, world->force_count * sizeof *forces);
    stf_allocator_release(&world->allocator, world->forces, world->force_capacity * sizeof *forces);
    world->forces = forces;
    world->force_capacity = capacity;
    return STF_OK;
}

static stf_added_force *find(const stf_world *world, stf_force_id id)
{
    for (size_t i = 0; i < world->force_count; i++)
        if (world->forces[i].id == id)
            return &world->forces[i];
    return NULL;
}

stf_result stf_world_add_force(stf_world *world, const stf_force *force, const void *records, size_t record_count,
                               stf_force_id *id)
{
    if (!world || !force)
        return STF_ERROR_NULL;
    if (!is_force(force))
        return STF_ERROR_DESCRIPTOR;
    if (world->last_force_id == UINT32_MAX)
        return STF_ERROR_MEMORY;

    stf_added_force added = {.force = force, .acting = stf_kernels_force(world->kernels, force)};
    stf_result bad = stf_force_check_records(world, force, records, record_count, world->count);

    if (!bad)
        bad = require_force_room(world);
    if (!bad)
        bad = copy_records(world, &added, records, record_count);
    if (bad)
        return bad;
    if (force->kind == STF_LINK) {
        bad = stf_storage_require(world, world->count, world->integrator, true);
        if (bad) {
            stf_force_release_records(world, &added);
            return bad;
        }
    }

    added.id = ++world->last_force_id;
    world->forces[world->force_count++] = added;
    stf_world_forget_history(world, 0, world->count);
    if (id)
        *id = added.id;
    return STF_OK;
}

stf_result stf_world_set_force(stf_world *world, stf_force_id id, const void *records, size_t record_count)
{
    if (!world)
        return STF_ERROR_NULL;

    stf_added_force *added = find(world, id);
    if (!added)
        return STF_ERROR_FORCE;

    stf_added_force changed = *added;
    stf_result bad = stf_force_check_records(world, added->force, records, record_count, world->count);
    if (bad)
        return bad;
    if (stf_force_has_room(added, record_count)) {
        if (record_count > 0)
            memmove(added->records, records, record_count * added->force->record_size); /* they may be the world's own */
        stf_force_arrange_records(added, record_count);
    } else {
        bad = copy_records(world, &changed, records, record_count);
        if (bad)
            return bad;
        stf_force_release_records(world, added);
        *added = changed;
    }
    world->history_stale = true;
    return STF_OK;
}

const void *stf_world_force_records(const stf_world *world, stf_force_id id, size_t *record_count)
{
    const stf_added_force *added = world ? find(world, id) : NULL;

    if (record_count)
        *record_count = added ? added->record_count : 0;
    return added && added->record_count > 0 ? added->records : NULL;
}

stf_result stf_world_remove_force(stf_world *world, stf_force_id id)
{
    if (!world)
        return STF_ERROR_NULL;

    stf_added_force *added = find(world, id);
    if (!added)
        return STF_ERROR_FORCE;

    stf_force_release_records(world, added);
    world->force_count--;
    memmove(added, added + 1, (size_t)(world->forces + world->force_count - added) * sizeof *added);
    stf_world_forget_history(world, 0, world->count);
    return STF_OK;
}

stf_force_id stf_world_force_at(const stf_world *world, size_t n)
{
    return world && n < world->force_count ? world->forces[n].id : 0;
}

const stf_force *stf_world_force(const stf_world *world, stf_force_id id)
{
    const stf_added_force *added = world ? find(world, id) : NULL;

    return added ? added->force : NULL;
}

static void renumber_records(stf_added_force *added, size_t removed, size_t last)
{
    const size_t size = added->force->record_size;
    char *records = added->records;
    size_t kept = 0;

    for (size_t i = 0; i < added->record_count; i++) {
        if (!added->force->renumber(records + i * size, removed, last))
            continue;
        if (kept != i)
            memcpy(records + kept * size, records + i * size, size);
        kept++;
    }
    stf_force_arrange_records(added, kept);
}

void stf_world_renumber_forces(stf_world *world, size_t removed, size_t last)
{
    for (size_t i = 0; i < world->force_count; i++)
        if (world->forces[i].force->renumber)
            renumber_records(&world->forces[i], removed, last);
}

void stf_world_drop_particle_records(stf_world *world)
{
    for (size_t i = 0; i < world->force_count; i++)
        if (world->forces[i].force->renumber)
            world->forces[i].record_count = 0;
}

void stf_world_release_forces(stf_world *world)
{
    for (size_t i = 0; i < world->force_count; i++)
        stf_force_release_records(world, &world->forces[i]);
    stf_allocator_release(&world->allocator, world->forces, world->force_capacity * sizeof *world->forces);
}
