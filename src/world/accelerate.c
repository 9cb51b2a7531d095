#include <string.h>

#include "world.h"

/* A force whose records are still to come, or all gone, is not called; a linear drag is no call but a number. */
static bool pushes(const stf_added_force *added) { return added->acting->apply && stf_force_acts(added); }

static bool any_pushes(const stf_world *world, stf_force_kind kind, bool even_if_it_splits)
{
    for (size_t i = 0; i < world->force_count; i++) {
        const stf_added_force *added = &world->forces[i];
        if (added->acting->kind == kind && pushes(added) && (even_if_it_splits || !added->acting->splits))
            return true;
    }
    return false;
}

bool stf_world_is_tied(const stf_world *world) { return any_pushes(world, STF_LINK, true); }

bool stf_world_is_free(const stf_world *world)
{
    return !any_pushes(world, STF_FIELD, true) && !any_pushes(world, STF_LINK, true);
}

/* The k of all linear drag. */
static stf_real drag_of(const stf_world *world)
{
    stf_real sum = 0;

    for (size_t i = 0; i < world->force_count; i++) {
        const stf_added_force *added = &world->forces[i];
        if (added->acting->drag && stf_force_acts(added))
            sum += added->acting->drag(added->records, added->record_count);
    }
    /* finite, so that 0 times it is 0, for what has no finite mass */
    return sum < -STF_REAL_MAX ? -STF_REAL_MAX : sum < STF_REAL_MAX ? sum : STF_REAL_MAX;
}

void stf_flight_start(stf_flight *flight, const stf_world *world)
{
    flight->stride = world->storage.stride;
    flight->dimensions = world->dimensions;
    flight->drag = drag_of(world);
    memcpy(flight->gravity, world->gravity, sizeof flight->gravity);
    for (int k = 0; k < STF_HISTORY_ARRAYS_MAX; k++)
        flight->history[k] = NULL;
}

/* One call of accelerate, as its parts see it. */
typedef struct request {
    const stf_range *range;
    double time;
    const stf_real *position, *velocity;
    stf_real *acceleration; /* newtons, until the last pass */
    unsigned parts;
} request;

/* A part has whole blocks, begin to end of those of the range. */
static size_t part_begin(const request *q, unsigned part) { return q->range->blocks * part / q->parts; }

static void apply(const stf_world *world, stf_force_kind kind, const stf_particles *particles, double time)
{
    for (size_t i = 0; i < world->force_count; i++) {
        const stf_added_force *added = &world->forces[i];
        if (added->acting->kind == kind && pushes(added))
            added->acting->apply(added->records, added->record_count, particles, time);
    }
}

static void apply_fields(const request *q, unsigned part)
{
    const stf_world *world = q->range->world;
    const size_t length = stf_world_block_length(world), end = part_begin(q, part + 1);

    for (size_t b = part_begin(q, part); b < end; b++) {
        const size_t at = b * length;
        const stf_particles block = stf_world_particles(world, q->range->first_block + b, 1, q->position + at,
                                                        q->velocity + at, q->acceleration + at);
        memset(q->acceleration + at, 0, length * sizeof(stf_real));
        apply(world, STF_FIELD, &block, q->time);
    }
}

/* One call of a link force, as its parts see it. Where a link acts the range is all of the world. */
typedef struct link_call {
    const request *request;
    const stf_added_force *added;
    size_t round;
    unsigned parts;
} link_call;

/* A link that splits gets the particles of this part of the request, another its part of the round. */
static void apply_link(const link_call *call, unsigned part)
{
    const request *q = call->request;
    const size_t stride = q->range->world->storage.stride, end = part_begin(q, part + 1) * stride;
    stf_particles all = stf_world_particles(q->range->world, q->range->first_block, q->range->blocks, q->position, q->velocity,
                                            q->acceleration);

    if (call->added->acting->splits) {
        all.begin = part_begin(q, part) * stride;
        all.end = end < all.count ? end : all.count;
    } else {
        all.round = call->round;
        all.part = part;
        all.parts = call->parts;
    }
    call->added->acting->apply(call->added->records, call->added->record_count, &all, q->time);
}

/* 0 where it is no link, or does not act. */
static size_t rounds_of(const request *q, const stf_added_force *added)
{
    const stf_particles all =
        stf_world_particles(q->range->world, q->range->first_block, q->range->blocks, q->position, q->velocity, NULL);

    if (added->acting->kind != STF_LINK || !pushes(added))
        return 0;
    return added->acting->rounds ? added->acting->rounds(added->record_count, &all) : 1;
}

static void link_part(void *context, unsigned part) { apply_link(context, part); }

/* All links on this thread, for one part of the request: the only one, or each link splits. */
static void apply_links(const request *q, unsigned part)
{
    for (size_t i = 0; i < q->range->world->force_count; i++) {
        link_call call = {.request = q, .added = &q->range->world->forces[i], .parts = 1};
        const size_t rounds = rounds_of(q, call.added);

        for (; call.round < rounds; call.round++)
            apply_link(&call, part);
    }
}

/* One link after another, each in as many parts as it allows. */
static void apply_links_in_parts(const request *q)
{
    for (size_t i = 0; i < q->range->world->force_count; i++) {
        link_call call = {.request = q, .added = &q->range->world->forces[i], .parts = 1};
        const size_t rounds = rounds_of(q, call.added);

        if (call.added->acting->splits || call.added->acting->rounds)
            call.parts = q->parts;
        for (; call.round < rounds; call.round++)
            stf_world_run(q->range->world, call.parts, link_part, &call);
    }
}

static void forces_to_accelerations(const request *q, unsigned part)
{
    const stf_world *world = q->range->world;
    const size_t begin = part_begin(q, part), at = begin * stf_world_block_length(world);
    const stf_real *inverse_mass = world->storage.inverse_mass + (q->range->first_block + begin) * world->storage.stride;

    world->kernels->accelerate(&q->range->flight, part_begin(q, part + 1) - begin, inverse_mass, q->velocity + at,
                               q->acceleration + at);
}

static void fields_part(void *context, unsigned part) { apply_fields(context, part); }

static void last_part(void *context, unsigned part) { forces_to_accelerations(context, part); }

static void whole_part(void *context, unsigned part)
{
    const request *q = context;

    apply_fields(q, part);
    if (q->range->is_tied)
        apply_links(q, part);
    forces_to_accelerations(q, part);
}

static void accelerate(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                       stf_real *acceleration) /* what q keeps is written to; NOLINT(readability-non-const-parameter) */
{
    const stf_range *range = (const stf_range *)system;
    const stf_world *world = range->world;
    request q = {.range = range, .time = time, .position = position, .velocity = velocity, .acceleration = acceleration};

    q.parts = range->parts;
    if (q.parts == 1 || !any_pushes(world, STF_LINK, false)) { /* only what links tie is in parts */
        stf_world_run(world, q.parts, whole_part, &q);
        return;
    }
    stf_world_run(world, q.parts, fields_part, &q);
    apply_links_in_parts(&q);
    stf_world_run(world, q.parts, last_part, &q);
}

/* One call of each, as its parts see it. */
typedef struct loop_call {
    const stf_range *range;
    void (*loop)(stf_system *part, stf_real dt);
    stf_real dt;
    unsigned parts;
} loop_call;

static void loop_part(void *context, unsigned index)
{
    const loop_call *call = context;
    const size_t length = stf_world_block_length(call->range->world), blocks = call->range->blocks;
    const size_t begin = blocks * index / call->parts * length, end = blocks * (index + 1) / call->parts * length;
    stf_system part = call->range->system;

    part.length = end - begin;
    part.position += begin;
    part.velocity += begin;
    part.position_rest = stf_world_at(part.position_rest, begin);
    part.velocity_rest = stf_world_at(part.velocity_rest, begin);
    for (int k = 0; k < call->range->world->storage.work_arrays; k++)
        part.work[k] += begin;
    for (int k = 0; k < call->range->world->storage.history_arrays; k++)
        part.history[k] += begin;
    call->loop(&part, call->dt);
}

static void each(stf_system *system, void (*loop)(stf_system *part, stf_real dt), stf_real dt)
{
    const stf_range *range = (const stf_range *)system;
    loop_call call = {.range = range, .loop = loop, .dt = dt};

    call.parts = range->parts;
    if (call.parts == 1)
        loop(system, dt);
    else
        stf_world_run(range->world, call.parts, loop_part, &call);
}

static void place_range(stf_range *range, size_t first_block)
{
    const stf_storage *storage = &range->world->storage;
    const size_t at = first_block * stf_world_block_length(range->world);

    range->first_block = first_block;
    range->system.position = storage->position + at;
    range->system.velocity = storage->velocity + at;
    range->system.position_rest = stf_world_at(storage->position_rest, at);
    range->system.velocity_rest = stf_world_at(storage->velocity_rest, at);
    for (int k = 0; k < storage->history_arrays; k++)
        range->system.history[k] = storage->history[k] + at;
}

void stf_range_start(stf_range *range, const stf_world *world, size_t first_block, size_t blocks, unsigned part)
{
    const size_t length = stf_world_block_length(world);

    range->system.length = blocks * length;
    range->system.accelerate = accelerate;
    range->system.each = each;
    range->world = world;
    range->blocks = blocks;
    range->is_tied = stf_world_is_tied(world);
    range->parts = stf_world_parts(world, blocks);
    stf_flight_start(&range->flight, world);
    for (int k = 0; k < world->storage.work_arrays; k++)
        range->system.work[k] = world->storage.work[k] + part * length;
    place_range(range, first_block);
}

void stf_range_next(stf_range *range) { place_range(range, range->first_block + range->blocks); }

stf_result stf_world_accelerations(const stf_world *world, double time, const stf_real *position, const stf_real *velocity,
                                   stf_real *acceleration)
{
    if (!world || !position || !velocity || !acceleration)
        return STF_ERROR_NULL;
    if (!isfinite(time))
        return STF_ERROR_NOT_FINITE;

    stf_range range;

    stf_range_start(&range, world, 0, stf_world_blocks(world), 0);
    range.parts = 1; /* several threads may read a world: only the one that changes it may use its threads */
    accelerate(&range.system, time, position, velocity, acceleration);
    return STF_OK;
}
