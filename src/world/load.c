#include "../checksum.h"
#include "reader.h"
#include "steadfast/save.h"

/* What is known before any force is read. */
typedef struct saved {
    uint32_t dimensions, flags, substeps, history_arrays;
    double step, step_start_time;
    uint64_t ticks, step_start_tick;
    stf_vector gravity;
    stf_string integrator;
    stf_force_id last_force_id;
    uint64_t force_count;
    size_t count;
} saved;

/* Always STF_ERROR_MISMATCH; `mismatch`, which may be NULL, gets what it is. */
static stf_result differs(stf_mismatch *mismatch, const char *what, size_t force, stf_string name)
{
    if (mismatch) {
        const size_t most = sizeof mismatch->saved - 1, length = name.length < most ? name.length : most;

        *mismatch = (stf_mismatch){.what = what, .force = force};
        if (length > 0)
            memcpy(mismatch->saved, name.at, length);
    }
    return STF_ERROR_MISMATCH;
}

/* Whether it is a whole saved world as it was written; *r then has what is between start and checksum. */
static stf_result open_buffer(stf_reader *r, const void *buffer, size_t size)
{
    const size_t magic = size < STF_SAVE_MAGIC_BYTES ? size : STF_SAVE_MAGIC_BYTES;

    *r = (stf_reader){.at = buffer, .left = size};
    if (memcmp(buffer, STF_SAVE_MAGIC, magic) != 0)
        return STF_ERROR_FOREIGN;
    if (size < STF_SAVE_START_BYTES + STF_SAVE_CHECKSUM_BYTES)
        return STF_ERROR_TRUNCATED;
    stf_get_bytes(r, magic);
    if (stf_get_word(r) != STF_SAVE_VERSION)
        return STF_ERROR_VERSION;

    const uint64_t bytes = stf_get(r, 8);
    if (bytes > size)
        return STF_ERROR_TRUNCATED;
    r->left -= STF_SAVE_CHECKSUM_BYTES;
    if (bytes < size || stf_bytes_get(r->at + r->left, STF_SAVE_CHECKSUM_BYTES) !=
                            stf_checksum(buffer, size - STF_SAVE_CHECKSUM_BYTES))
        return STF_ERROR_ALTERED;
    return stf_get_word(r) == sizeof(stf_real) ? STF_OK : STF_ERROR_PRECISION;
}

static saved get_head(stf_reader *r)
{
    saved s = {.dimensions = stf_get_word(r)};

    s.flags = stf_get_word(r);
    s.substeps = stf_get_word(r);
    s.history_arrays = stf_get_word(r);
    s.step = stf_get_double(r);
    s.ticks = stf_get(r, 8);
    s.step_start_tick = stf_get(r, 8);
    s.step_start_time = stf_get_double(r);
    s.gravity.x = stf_get_real(r);
    s.gravity.y = stf_get_real(r);
    s.gravity.z = stf_get_real(r);
    s.integrator = stf_get_string(r);
    s.last_force_id = stf_get_word(r);
    s.force_count = stf_get(r, 8);
    const uint64_t count = stf_get(r, 8);
    s.count = (size_t)count;
    r->is_short = r->is_short || count > r->left; /* a particle has more than one byte */
    return s;
}

static stf_result match_head(const saved *s, const stf_world *world, stf_mismatch *mismatch)
{
    const stf_string none = {.length = 0};

    if (s->dimensions != world->dimensions)
        return differs(mismatch, "dimensions", 0, none);
    if (!(s->flags & STF_SAVE_PREVIOUS) == world->keep_previous)
        return differs(mismatch, "keep_previous", 0, none);
    if (!(s->flags & STF_SAVE_RADIUS) == world->keep_radius)
        return differs(mismatch, "keep_radius", 0, none);
    if (!(s->flags & STF_SAVE_COMPENSATED) == world->compensated)
        return differs(mismatch, "compensated", 0, none);
    if (!stf_is_text(s->integrator, world->integrator->name))
        return differs(mismatch, "integrator", 0, s->integrator);
    if (s->history_arrays != (uint32_t)world->integrator->history_arrays)
        return differs(mismatch, "history_arrays", 0, s->integrator);
    if (s->force_count != world->force_count)
        return differs(mismatch, "force count", 0, none);
    return STF_OK;
}

static stf_result check_head(const saved *s)
{
    const stf_result bad = stf_world_check_step(s->step, s->substeps);

    if (bad)
        return bad;
    if (!isfinite(s->step_start_time))
        return STF_ERROR_NOT_FINITE;
    if (s->step_start_tick > s->ticks || s->flags >= STF_SAVE_COMPENSATED << 1)
        return STF_ERROR_ALTERED;
    return stf_world_check_gravity(s->gravity, s->dimensions);
}

/* Records of `loaded` out of the buffer, in memory of their own. */
static stf_result get_records(stf_reader *r, const stf_world *world, const saved *s, stf_added_force *loaded,
                              uint64_t record_count)
{
    const stf_force *force = loaded->force;
    const char *fields = stf_saved_fields(force);
    const size_t size = stf_fields_packed_size(fields);

    if (record_count > (size > 0 ? r->left / size : 0))
        return STF_ERROR_ALTERED;

    const size_t count = (size_t)record_count;
    stf_result bad = stf_force_allocate_records(world, loaded, count);
    if (bad || count == 0)
        return bad;
    memset(loaded->records, 0, count * force->record_size);
    for (size_t i = 0; i < count; i++)
        stf_fields_unpack(fields, stf_get_bytes(r, size), (char *)loaded->records + i * force->record_size);
    bad = stf_force_check_records(world, force, loaded->records, count, s->count);
    if (!bad)
        stf_force_arrange_records(loaded, count);
    return bad;
}

/* One force, which starts as the world's own. */
static stf_result get_force(stf_reader *r, const stf_world *world, const saved *s, size_t n, stf_added_force *loaded,
                            stf_mismatch *mismatch)
{
    const stf_force *force = world->forces[n].force;
    const stf_string name = stf_get_string(r);
    const uint32_t kind = stf_get_word(r);
    const stf_force_id id = stf_get_word(r), before = n > 0 ? loaded[-1].id : 0;
    const stf_string fields = stf_get_string(r);
    const uint64_t record_count = stf_get(r, 8);

    if (r->is_short || id <= before || id > s->last_force_id)
        return STF_ERROR_ALTERED;
    if (!stf_is_text(name, force->name))
        return differs(mismatch, "name", n, name);
    if (kind != (uint32_t)(force->kind == STF_LINK))
        return differs(mismatch, "kind", n, name);
    if (!stf_is_text(fields, stf_saved_fields(force)))
        return differs(mismatch, "fields", n, name);
    loaded->id = id;
    if (stf_saves_records(force))
        return get_records(r, world, s, loaded, record_count);
    return record_count > 0 ? STF_ERROR_ALTERED
                            : stf_force_check_records(world, force, loaded->records, loaded->record_count, s->count);
}

/* The rest of the buffer is these arrays, no more and no less, and holds what a world may hold. */
static stf_result check_arrays(stf_reader r, const saved *s, const stf_kept *kept, size_t arrays)
{
    size_t reals = kept[0].rows;

    for (size_t k = 1; k < arrays; k++)
        reals += kept[k].rows;
    if (s->count > r.left / (reals * sizeof(stf_real)) || s->count * reals * sizeof(stf_real) != r.left)
        return STF_ERROR_ALTERED;
    for (size_t k = 0; k < arrays; k++)
        for (size_t i = 0; i < s->count * kept[k].rows; i++) {
            const stf_result bad = stf_kept_check(&kept[k], stf_get_real(&r));
            if (bad)
                return bad;
        }
    return STF_OK;
}

static void put_arrays(stf_reader *r, stf_world *world)
{
    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_world_kept(world, kept), blocks = stf_world_blocks(world);

    for (size_t b = 0; b < blocks; b++)
        stf_storage_open_block(world, b);
    for (size_t k = 0; k < arrays; k++)
        for (size_t i = 0; i < world->count; i++)
            for (size_t d = 0; d < kept[k].rows; d++)
                *stf_kept_at(&world->storage, &kept[k], i, d) = stf_get_real(r);
}

static void put_head(stf_world *world, const saved *s)
{
    world->count = s->count;
    world->substeps = s->substeps;
    world->history_stale = (s->flags & STF_SAVE_STALE) != 0;
    world->step = s->step;
    world->ticks = s->ticks;
    world->step_start_tick = s->step_start_tick;
    world->step_start_time = s->step_start_time;
    stf_world_put_gravity(world, s->gravity);
    world->last_force_id = s->last_force_id;
    stf_guard_reset(world);
}

/* Of two lists of forces that differ in records, releases what only `from` has. */
static void release_others(const stf_world *world, stf_added_force *from, const stf_added_force *kept)
{
    for (size_t i = 0; i < world->force_count; i++)
        if (from[i].records != kept[i].records)
            stf_force_release_records(world, &from[i]);
}

/* All that is behind the head: nothing of the world is changed before all has been checked and all memory is there. */
static stf_result load_body(stf_reader *r, stf_world *world, const saved *s, stf_added_force *loaded,
                            stf_mismatch *mismatch)
{
    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_world_kept(world, kept);
    stf_result bad = STF_OK;

    for (size_t n = 0; n < world->force_count; n++)
        loaded[n] = world->forces[n];
    for (size_t n = 0; n < world->force_count && !bad; n++)
        bad = get_force(r, world, s, n, &loaded[n], mismatch);
    if (!bad)
        bad = check_arrays(*r, s, kept, arrays);
    if (!bad)
        bad = stf_storage_require(world, s->count, world->integrator, false);
    if (bad) {
        release_others(world, loaded, world->forces);
        return bad;
    }

    release_others(world, world->forces, loaded);
    for (size_t n = 0; n < world->force_count; n++)
        world->forces[n] = loaded[n];
    put_head(world, s);
    put_arrays(r, world);
    return STF_OK;
}

stf_result stf_world_load(stf_world *world, const void *buffer, size_t size, stf_mismatch *mismatch)
{
    if (!world || !buffer)
        return STF_ERROR_NULL;
    if (mismatch)
        *mismatch = (stf_mismatch){.what = NULL};

    stf_reader r;
    stf_result bad = open_buffer(&r, buffer, size);
    if (bad)
        return bad;

    const saved s = get_head(&r);
    bad = r.is_short ? STF_ERROR_ALTERED : match_head(&s, world, mismatch);
    if (!bad)
        bad = check_head(&s);
    if (bad)
        return bad;

    const size_t bytes = (world->force_count + 1) * sizeof(stf_added_force); /* of no force too: some, not none */
    stf_added_force *loaded = stf_allocator_allocate(&world->allocator, bytes);
    if (!loaded)
        return STF_ERROR_MEMORY;
    bad = load_body(&r, world, &s, loaded, mismatch);
    stf_allocator_release(&world->allocator, loaded, bytes);
    return bad;
}
