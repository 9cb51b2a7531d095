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

stf_real stf_world_drag(const stf_world *world)
{
    stf_real sum = 0;

    for (size_t i = 0; i < world->force_count; i++) {
        const stf_added_force *added = &world->forces[i];
        if (added->acting->drag && stf_force_acts(added))
            sum += added->acting->drag(added->records, added->record_count);
    }
    return sum;
}

stf_flight stf_world_flight(const stf_world *world, size_t first_block, size_t blocks, stf_real drag)
{
    stf_flight flight = {
        .blocks = blocks,
        .stride = world->storage.stride,
        .dimensions = world->dimensions,
        .inverse_mass = world->storage.inverse_mass + first_block * world->storage.stride,
        .drag = drag,
    };

    memcpy(flight.gravity, world->gravity, sizeof flight.gravity);
    return flight;
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

/* Where a link acts the range is all of the world; where none does this calls nothing. */
static void apply_links(const request *q, size_t begin_block, size_t end_block)
{
    const stf_world *world = q->range->world;
    const size_t stride = world->storage.stride;
    stf_particles all = stf_world_particles(world, q->range->first_block, q->range->blocks, q->position, q->velocity,
                                            q->acceleration);

    all.begin = begin_block * stride;
    all.end = end_block * stride < all.count ? end_block * stride : all.count;
    apply(world, STF_LINK, &all, q->time);
}

static void forces_to_accelerations(const request *q, unsigned part)
{
    const stf_world *world = q->range->world;
    const size_t begin = part_begin(q, part), at = begin * stf_world_block_length(world);
    const stf_flight flight =
        stf_world_flight(world, q->range->first_block + begin, part_begin(q, part + 1) - begin, q->range->drag);

    world->kernels->accelerate(&flight, q->velocity + at, q->acceleration + at);
}

static void fields_part(void *context, unsigned part) { apply_fields(context, part); }

static void last_part(void *context, unsigned part) { forces_to_accelerations(context, part); }

static void whole_part(void *context, unsigned part)
{
    const request *q = context;

    apply_fields(q, part);
    apply_links(q, part_begin(q, part), part_begin(q, part + 1));
    forces_to_accelerations(q, part);
}

static void accelerate(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                       stf_real *acceleration)
{
    const stf_range *range = (const stf_range *)system;
    const stf_world *world = range->world;
    request q = {.range = range, .time = time, .position = position, .velocity = velocity, .acceleration = acceleration};

    q.parts = range->blocks > 1 ? stf_world_parts(world, range->blocks) : 1;
    if (q.parts == 1 || !any_pushes(world, STF_LINK, false)) {
        stf_world_run(world, q.parts, whole_part, &q);
        return;
    }
    stf_world_run(world, q.parts, fields_part, &q);
    apply_links(&q, 0, range->blocks);
    stf_world_run(world, q.parts, last_part, &q);
}

static void place_range(stf_range *range, size_t first_block)
{
    const stf_storage *storage = &range->world->storage;
    const size_t at = first_block * stf_world_block_length(range->world);

    range->first_block = first_block;
    range->system.position = storage->position + at;
    range->system.velocity = storage->velocity + at;
    for (int k = 0; k < storage->history_arrays; k++)
        range->system.history[k] = storage->history[k] + at;
}

stf_range stf_range_of(const stf_world *world, size_t first_block, size_t blocks, unsigned part, stf_real drag)
{
    const size_t length = stf_world_block_length(world);
    stf_range range = {.system = {.length = blocks * length, .accelerate = accelerate},
                       .world = world, .blocks = blocks, .drag = drag};

    for (int k = 0; k < world->storage.work_arrays; k++)
        range.system.work[k] = world->storage.work[k] + part * length;
    place_range(&range, first_block);
    return range;
}

void stf_range_next(stf_range *range) { place_range(range, range->first_block + range->blocks); }

stf_result stf_world_accelerations(const stf_world *world, double time, const stf_real *position, const stf_real *velocity,
                                   stf_real *acceleration)
{
    if (!world || !position || !velocity || !acceleration)
        return STF_ERROR_NULL;

    stf_range range = stf_range_of(world, 0, stf_world_blocks(world), 0, stf_world_drag(world));

    accelerate(&range.system, time, position, velocity, acceleration);
    return STF_OK;
}
