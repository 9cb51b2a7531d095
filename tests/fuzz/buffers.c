/*
 * The bytes are a saved world: the first says how it comes about, the next three what kind of world loads it.
 *
 * Of a load that is refused nothing may remain. One that is accepted has to save again, and so that a second load and save give
 * the same bytes; and what was loaded has to be a world, on which each kind of call works.
 */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"

/* bits of the first byte */
enum {
    OWN = 1 << 0,     /* the buffer is what this world saves, the other bytes are changes to it; else they are the buffer */
    MENDED = 1 << 1,  /* length and checksum are set right, so that what is behind them is reached */
    CROWDED = 1 << 2, /* the world that loads has particles and records */
    FORCES = 1 << 3   /* it has forces */
};

#define LENGTH_AT ((size_t)12) /* where a save has its length, 8 bytes; the checksum is the last 4 */
#define START ((size_t)20)
#define SUBSTEPS_MAX 8
#define COUNT_MAX 500

typedef struct buffer {
    unsigned char *bytes;
    size_t size;
} buffer;

static void put(unsigned char *to, uint64_t number, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        to[i] = (unsigned char)(number >> (8 * i));
}

/* CRC-32C, bit by bit: RFC 3720, appendix B.4, shows its values. */
static uint32_t checksum(const unsigned char *bytes, size_t count)
{
    uint32_t crc = UINT32_MAX;

    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? UINT32_C(0x82f63b78) : 0);
    }
    return ~crc;
}

static buffer make_buffer(size_t size)
{
    buffer b = {.bytes = malloc(size ? size : 1), .size = size};

    claim(b.bytes);
    return b;
}

static buffer save_of(const stf_world *world)
{
    const buffer b = make_buffer(stf_world_save_size(world));

    claim(stf_world_save(world, b.bytes, b.size) == STF_OK);
    return b;
}

/* ---- the world ----------------------------------------------------------------------------------------------------------- */

/* Three bytes: shape, integrator, and how it is made beside that. `fail_in` counts from when it is made. */
static stf_world *make_world(const uint8_t kind[3], ration *r, bool has_forces)
{
    const unsigned how = kind[2];
    const bool compensated = (kind[0] & 32) != 0 && !is_refused(kind[1] % GOOD_INTEGRATORS, true);
    const stf_world_def def = {.dimensions = 1 + kind[0] % 3, .keep_previous = (kind[0] & 64) != 0, .compensated = compensated,
                               .keep_radius = (kind[0] & 128) != 0, .integrator = integrators[kind[1] % GOOD_INTEGRATORS],
                               .capacity = how & 15, .allocator = ration_allocator(r),
                               .parallel = {.run = run_backwards, .tasks = how >> 4 & 3}};
    static const unsigned forces[] = {4, 0, 3, 6, 8, 2}; /* of subjects: springs, drag, anchors, gusts, tethers, attractor */
    stf_world *world = NULL;

    choose_instructions(how >> 6);
    claim(stf_world_create(&def, &world) == STF_OK);
    for (size_t f = 0; has_forces && f < COUNT_OF(forces); f++)
        claim(stf_world_add_force(world, subjects[forces[f]].force, NULL, 0, NULL) == STF_OK);
    return world;
}

static void populate(stf_world *world, bool has_forces)
{
    const stf_spring springs[] = {{0, 1, 8, 1, 1}, {1, 2, 8, 0, 1}, {4, 3, 2, 0, 0}};
    const stf_anchored_spring anchor = {.particle = 2, .stiffness = 1};
    const stf_linear_drag drag = {.coefficient = 1};
    const uint32_t tether[3] = {1, 2, 0}; /* 0 is 0.0f */

    for (unsigned i = 0; i < 5; i++)
        claim(stf_world_add(world, &(stf_particle){.position.x = (stf_real)i, .inverse_mass = (stf_real)i}, NULL) == STF_OK);
    if (has_forces) {
        claim(stf_world_set_force(world, 1, springs, COUNT_OF(springs)) == STF_OK);
        claim(stf_world_set_force(world, 2, &drag, 1) == STF_OK);
        claim(stf_world_set_force(world, 3, &anchor, 1) == STF_OK);
        claim(sizeof tether != subjects[8].force->record_size || stf_world_set_force(world, 5, tether, 1) == STF_OK);
    }
    claim(stf_world_step(world, 3) == STF_OK);
}

/* ---- the buffer ---------------------------------------------------------------------------------------------------------- */

/* Each change is a place, how many bytes there are replaced (1 to 8; else the buffer ends or grows there), and those. */
static void change(buffer *b, program *p)
{
    while (p->left > 0 && b->size > 0) {
        const size_t at = (size_t)take_integer(p, 2) % b->size, how = take(p), bytes = how % 8 + 1;

        if (how == 255) {
            b->size = at;
        } else if (how == 254) {
            b->bytes = realloc(b->bytes, b->size + at);
            claim(b->bytes);
            memset(b->bytes + b->size, 0, at);
            b->size += at;
        } else if (bytes <= b->size - at)
            put(b->bytes + at, take_integer(p, bytes), bytes);
    }
}

/* In memory of exactly its size. */
static buffer take_buffer(program p, unsigned how, const stf_world *world)
{
    buffer b;

    if (how & OWN) {
        b = save_of(world);
        change(&b, &p);
    } else {
        b = make_buffer(p.left);
        if (p.left > 0)
            memcpy(b.bytes, p.at, p.left);
    }
    if ((how & MENDED) && b.size >= START + 4) {
        put(b.bytes + LENGTH_AT, b.size, 8);
        put(b.bytes + b.size - 4, checksum(b.bytes, b.size - 4), 4);
    }
    b.bytes = realloc(b.bytes, b.size ? b.size : 1);
    claim(b.bytes);
    return b;
}

/* ---- claims -------------------------------------------------------------------------------------------------------------- */

static bool may_be_returned(stf_result result)
{
    const unsigned results = 1U << STF_OK | 1U << STF_ERROR_FOREIGN | 1U << STF_ERROR_VERSION | 1U << STF_ERROR_TRUNCATED |
                             1U << STF_ERROR_ALTERED | 1U << STF_ERROR_PRECISION | 1U << STF_ERROR_MISMATCH |
                             1U << STF_ERROR_MEMORY | 1U << STF_ERROR_NOT_FINITE | 1U << STF_ERROR_MASS |
                             1U << STF_ERROR_RADIUS | 1U << STF_ERROR_STEP | 1U << STF_ERROR_SUBSTEPS |
                             1U << STF_ERROR_DIMENSIONS | 1U << STF_ERROR_PARTICLE | 1U << STF_ERROR_PARAMETERS;

    return (results >> result & 1) != 0;
}

static void claim_saves_as(const stf_world *world, buffer expected)
{
    const buffer b = save_of(world);

    claim(b.size == expected.size && memcmp(b.bytes, expected.bytes, b.size) == 0);
    free(b.bytes);
}

/* Steps a few ticks, if the substeps that were saved do not make that take for ever. */
static void step(stf_world *world, unsigned calls, unsigned ticks)
{
    if (stf_world_substeps(world) > SUBSTEPS_MAX && stf_world_set_substeps(world, 1) != STF_OK)
        return;
    for (unsigned n = 0; n < calls; n++)
        claim(stf_world_step(world, ticks) == STF_OK);
}

/* Two worlds that were loaded from the same bytes and are made differently stay the same. */
static void claim_steps_alike(stf_world *world, stf_world *other)
{
    step(world, 1, 3);
    step(other, 3, 1);

    const size_t size = stf_world_save_size(world);
    const buffer a = make_buffer(size), b = make_buffer(size);

    claim(stf_world_save_size(other) == size);
    const stf_result result = stf_world_save(world, a.bytes, size);
    claim(stf_world_save(other, b.bytes, size) == result);
    claim(result || memcmp(a.bytes, b.bytes, size) == 0);
    free(a.bytes);
    free(b.bytes);
}

/* What was loaded is as good as what was made by calls. */
static void claim_is_alive(stf_world *world)
{
    const size_t count = stf_world_count(world);
    const stf_particle particle = {.inverse_mass = 1};
    stf_force_id id = 0;
    char text[256];

    claim(stf_world_describe(world, text, sizeof text) > 0);
    claim(stf_world_add(world, &particle, NULL) == STF_OK && stf_world_count(world) == count + 1);
    const stf_result result = stf_world_add_force(world, &stf_force_linear_drag, &(stf_linear_drag){1}, 1, &id);
    claim(result == STF_OK ? id > 0 : result == STF_ERROR_MEMORY); /* there may be no id left */
    for (size_t n = 0; stf_world_force_at(world, n) != id; n++)
        claim(stf_world_force_at(world, n) != 0 && (result || stf_world_force_at(world, n) < id));
    step(world, 1, 1);
    claim(stf_world_remove(world, 0, NULL) == STF_OK && stf_world_count(world) == count);
    step(world, 1, 1);
    claim(stf_world_clear(world) == STF_OK && stf_world_count(world) == 0);
}

static void claim_accepted(stf_world *world, buffer given, const uint8_t kind[3], bool has_forces)
{
    const uint8_t other_kind[3] = {kind[0], kind[1], (uint8_t)~kind[2]};
    ration r = {.garbage = 0xff};
    stf_world *other = make_world(other_kind, &r, has_forces);
    const buffer saved = save_of(world);

    claim(saved.size == given.size);
    claim(stf_world_load(other, saved.bytes, saved.size, NULL) == STF_OK);
    claim_saves_as(other, saved);
    if (stf_world_count(world) <= COUNT_MAX && !stf_world_force_records(world, 5, NULL))
        claim_steps_alike(world, other);
    claim_is_alive(world);
    stf_world_destroy(other);
    free(saved.bytes);
    claim(r.blocks == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (size < 4)
        return 0;

    const unsigned how = bytes[0];
    const bool has_forces = (how & FORCES) != 0;
    ration r = {.garbage = 0x41};
    stf_world *world = make_world(bytes + 1, &r, has_forces);
    stf_mismatch mismatch;

    if (how & CROWDED)
        populate(world, has_forces);

    const buffer before = save_of(world), b = take_buffer((program){.at = bytes + 4, .left = size - 4}, how, world);
    claim(stf_world_restore(world, b.bytes, b.size < START ? b.size : START) == STF_ERROR_SNAPSHOT);
    r.fail_in = how >> 6; /* 0: none */
    const stf_result result = stf_world_load(world, b.bytes, b.size, &mismatch);
    r.fail_in = 0;
    claim(may_be_returned(result) && (result == STF_ERROR_MISMATCH) == (mismatch.what != NULL));
    claim(result != STF_OK || !r.refused);
    if (result)
        claim_saves_as(world, before);
    else
        claim_accepted(world, b, bytes + 1, has_forces);
    stf_world_destroy(world);
    claim(r.blocks == 0);
    free(before.bytes);
    free(b.bytes);
    return 0;
}
