#include <string.h>

#include "world.h"

/* Blocks in flight that are stepped together: enough that a call costs nothing, few enough to stay in cache between ticks. */
#define FLIGHT_BLOCKS 8

/* A part of fewer blocks is not worth a thread. */
#define PART_BLOCKS_MIN 4

/* One call of stf_world_step, as its parts see it. */
typedef struct plan {
    const stf_world *world;
    size_t blocks;
    unsigned ticks, parts;
    stf_real dt;
} plan;

static double time_of(const plan *p, unsigned tick, unsigned substep)
{
    const stf_world *world = p->world;
    const uint64_t ticks = world->ticks - world->step_start_tick + tick;

    return world->step_start_time + (double)ticks * world->step + substep * (world->step / world->substeps);
}

static void keep_previous(const plan *p, unsigned tick, size_t at, size_t length)
{
    const stf_storage *storage = &p->world->storage;

    if (storage->previous && tick + 1 == p->ticks)
        memcpy(storage->previous + at, storage->position + at, length * sizeof(stf_real));
}

static bool settles(const plan *p, unsigned tick) { return (p->world->ticks + tick + 1) % STF_SETTLE_TICKS == 0; }

static stf_flight flight_of(const stf_world *world, size_t first_block, size_t blocks)
{
    const stf_storage *storage = &world->storage;
    const size_t at = first_block * stf_world_block_length(world);
    stf_flight flight;

    stf_flight_start(&flight, world);
    flight.blocks = blocks;
    flight.inverse_mass = storage->inverse_mass + first_block * storage->stride;
    flight.position = storage->position + at;
    flight.velocity = storage->velocity + at;
    flight.position_rest = stf_world_at(storage->position_rest, at);
    flight.velocity_rest = stf_world_at(storage->velocity_rest, at);
    for (int k = 0; k < storage->history_arrays; k++)
        flight.history[k] = storage->history[k] + at;
    return flight;
}

static void settle_part(void *context, unsigned part)
{
    const stf_range *range = context;
    const size_t begin = range->blocks * part / range->parts, end = range->blocks * (part + 1) / range->parts;
    const stf_flight blocks = flight_of(range->world, range->first_block + begin, end - begin);

    range->world->kernels->settle(&blocks);
}

/* All ticks of one range, so that a block is read from memory once for all of them. */
static void step_range(const plan *p, stf_range *range)
{
    const stf_world *world = p->world;
    const size_t at = range->first_block * stf_world_block_length(world);

    range->system.history_stale = world->history_stale;
    for (unsigned tick = 0; tick < p->ticks; tick++) {
        keep_previous(p, tick, at, range->system.length);
        for (unsigned s = 0; s < world->substeps; s++) {
            range->system.time = time_of(p, tick, s);
            world->stepper->step(&range->system, p->dt);
            range->system.history_stale = false;
        }
        if (settles(p, tick))
            stf_world_run(world, range->parts, settle_part, range);
    }
}

/* As step_range, for blocks on which nothing acts but gravity and linear drag. */
static void step_flight(const plan *p, size_t first_block, size_t blocks)
{
    const stf_world *world = p->world;
    const size_t at = first_block * stf_world_block_length(world);
    stf_flight flight = flight_of(world, first_block, blocks);

    flight.history_stale = world->history_stale;
    for (unsigned tick = 0; tick < p->ticks; tick++) {
        keep_previous(p, tick, at, blocks * stf_world_block_length(world));
        for (unsigned s = 0; s < world->substeps; s++) {
            world->stepper->step_flight(&flight, p->dt);
            flight.history_stale = false;
        }
        if (settles(p, tick))
            world->kernels->settle(&flight);
    }
}

static void step_flight_part(void *context, unsigned part)
{
    const plan *p = context;
    const size_t end = p->blocks * (part + 1) / p->parts;

    for (size_t first = p->blocks * part / p->parts; first < end; first += FLIGHT_BLOCKS)
        step_flight(p, first, end - first < FLIGHT_BLOCKS ? end - first : FLIGHT_BLOCKS);
}

static void step_blocks_part(void *context, unsigned part)
{
    const plan *p = context;
    const size_t end = p->blocks * (part + 1) / p->parts;
    stf_range range;

    stf_range_start(&range, p->world, p->blocks * part / p->parts, 1, part);
    for (; range.first_block < end; stf_range_next(&range))
        step_range(p, &range);
}

static void step_tied(const plan *p)
{
    stf_range range;

    stf_range_start(&range, p->world, 0, p->blocks, 0);
    step_range(p, &range);
}

void stf_world_advance(stf_world *world, unsigned ticks)
{
    plan p = {.world = world, .blocks = stf_world_blocks(world), .ticks = ticks};

    p.dt = (stf_real)(world->step / world->substeps);
    p.parts = stf_world_parts(world, p.blocks / PART_BLOCKS_MIN);
    if (stf_world_is_tied(world) && p.blocks > 0)
        step_tied(&p);
    else if (world->stepper->step_flight && stf_world_is_free(world))
        stf_world_run(world, p.parts, step_flight_part, &p);
    else
        stf_world_run(world, p.parts, step_blocks_part, &p);
    world->history_stale = world->history_stale && ticks == 0;
    world->ticks += ticks;
}

stf_result stf_world_step(stf_world *world, unsigned ticks)
{
    if (!world)
        return STF_ERROR_NULL;
    if (world->guard.mode != STF_GUARD_OFF)
        return stf_guard_step(world, ticks);

    stf_world_advance(world, ticks);
    return STF_OK;
}
