#include "../checksum.h"
#include "format.h"
#include "steadfast/save.h"

/* Where bytes go; NULL: they are only counted. */
typedef struct writer {
    unsigned char *bytes;
    size_t length;
} writer;

static void put(writer *w, uint64_t number, size_t bytes)
{
    if (w->bytes)
        stf_bytes_put(w->bytes + w->length, number, bytes);
    w->length += bytes;
}

static void put_double(writer *w, double x)
{
    uint64_t bits;

    memcpy(&bits, &x, sizeof bits);
    put(w, bits, sizeof bits);
}

static void put_characters(writer *w, const char *text, size_t length)
{
    if (w->bytes)
        memcpy(w->bytes + w->length, text, length);
    w->length += length;
}

static void put_string(writer *w, const char *text)
{
    put(w, strlen(text), 4);
    put_characters(w, text, strlen(text));
}

static void put_head(writer *w, const stf_world *world, size_t bytes)
{
    const unsigned flags = (world->keep_previous ? STF_SAVE_PREVIOUS : 0U) | (world->keep_radius ? STF_SAVE_RADIUS : 0U) |
                           (world->history_stale ? STF_SAVE_STALE : 0U) | (world->compensated ? STF_SAVE_COMPENSATED : 0U);

    put_characters(w, STF_SAVE_MAGIC, STF_SAVE_MAGIC_BYTES);
    put(w, STF_SAVE_VERSION, 4);
    put(w, bytes, 8);
    put(w, sizeof(stf_real), 4);
    put(w, world->dimensions, 4);
    put(w, flags, 4);
    put(w, world->substeps, 4);
    put(w, (unsigned)world->integrator->history_arrays, 4);
    put_double(w, world->step);
    put(w, world->ticks, 8);
    put(w, world->step_start_tick, 8);
    put_double(w, world->step_start_time);
    for (unsigned d = 0; d < STF_DIMENSIONS_MAX; d++)
        put(w, stf_bits_of_real(world->gravity[d]), sizeof(stf_real));
    put_string(w, world->integrator->name);
    put(w, world->last_force_id, 4);
    put(w, world->force_count, 8);
    put(w, world->count, 8);
}

static void put_force(writer *w, const stf_added_force *added)
{
    const char *fields = stf_saved_fields(added->force);
    const size_t size = stf_fields_packed_size(fields), count = stf_saves_records(added->force) ? added->record_count : 0;

    put_string(w, added->force->name);
    put(w, added->force->kind == STF_LINK, 4);
    put(w, added->id, 4);
    put_string(w, fields);
    put(w, count, 8);
    for (size_t i = 0; w->bytes && i < count; i++)
        stf_fields_pack(fields, (const char *)added->records + i * added->force->record_size, w->bytes + w->length + i * size);
    w->length += count * size;
}

static void put_array(writer *w, const stf_world *world, const stf_kept *kept)
{
    unsigned char *to = w->bytes ? w->bytes + w->length : NULL;

    for (size_t i = 0; to && i < world->count; i++)
        for (size_t d = 0; d < kept->rows; d++, to += sizeof(stf_real))
            stf_bytes_put(to, stf_bits_of_real(*stf_kept_at(&world->storage, kept, i, d)), sizeof(stf_real));
    w->length += world->count * kept->rows * sizeof(stf_real);
}

static void put_world(writer *w, const stf_world *world, size_t bytes)
{
    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_world_kept(world, kept);

    put_head(w, world, bytes);
    for (size_t i = 0; i < world->force_count; i++)
        put_force(w, &world->forces[i]);
    for (size_t k = 0; k < arrays; k++)
        put_array(w, world, &kept[k]);
    put(w, w->bytes ? stf_checksum(w->bytes, w->length) : 0, STF_SAVE_CHECKSUM_BYTES);
}

static stf_result check_array(const stf_world *world, const stf_kept *kept)
{
    stf_result bad = STF_OK;

    for (size_t i = 0; i < world->count && !bad; i++)
        for (size_t d = 0; d < kept->rows && !bad; d++)
            bad = stf_kept_check(kept, *stf_kept_at(&world->storage, kept, i, d));
    return bad;
}

/* Whether it will load again. */
static stf_result check_world(const stf_world *world)
{
    stf_kept kept[STF_KEPT_MAX];
    const size_t arrays = stf_world_kept(world, kept);
    stf_result bad = STF_OK;

    for (size_t i = 0; i < world->force_count; i++)
        if (world->forces[i].record_count > 0 && !world->forces[i].force->fields)
            return STF_ERROR_UNSAVABLE;
    if (!isfinite(world->step_start_time))
        return STF_ERROR_NOT_FINITE;
    for (size_t k = 0; k < arrays && !bad; k++)
        bad = check_array(world, &kept[k]);
    return bad;
}

size_t stf_world_save_size(const stf_world *world)
{
    writer counter = {.bytes = NULL};

    if (world)
        put_world(&counter, world, 0);
    return counter.length;
}

stf_result stf_world_save(const stf_world *world, void *buffer, size_t size)
{
    if (!world || !buffer)
        return STF_ERROR_NULL;

    const size_t bytes = stf_world_save_size(world);
    const stf_result bad = check_world(world);
    writer w = {.bytes = buffer};

    if (bad)
        return bad;
    if (size < bytes)
        return STF_ERROR_BUFFER;
    put_world(&w, world, bytes);
    return STF_OK;
}
