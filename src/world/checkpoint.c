/*
 * The looks of the guard: whether a particle is bad, the copy of a state in which none is, and the way back there: ticks that
 * are run again one by one give the first that was bad.
 */
#include <string.h>

#include "world.h"

/*
 * Measured: a look costs two steps of semi-implicit Euler in flight where all stays in the second-level cache and eight where
 * it does not, and a fifth of a step of a cloth: less than 2 % of the ticks between them.
 */
#define INTERVAL 512
#define INTERVAL_TIED 16

/* Fewer blocks are looked at sooner than a thread is woken. */
#define PART_BLOCKS_MIN 16

/* The largest magnitude that is good. */
static stf_real limit(double bound) { return bound > 0 && bound < (double)STF_REAL_MAX ? (stf_real)bound : STF_REAL_MAX; }

static bool exceeds(stf_real x, stf_real most) { return stf_magnitude_of(x) > stf_magnitude_of(most); }

static stf_fault_kind kind_of(const stf_world *world, size_t particle)
{
    const size_t at = stf_world_offset(world, particle), stride = world->storage.stride;
    const stf_real *x = world->storage.position + at, *v = world->storage.velocity + at;
    const stf_real most_x = limit(world->guard.position_bound), most_v = limit(world->guard.velocity_bound);
    bool bad[STF_FAULT_POSITION_BOUND + 1] = {false};
    stf_fault_kind kind = STF_FAULT_VELOCITY_NOT_FINITE;

    for (unsigned d = 0; d < world->dimensions; d++) {
        bad[STF_FAULT_VELOCITY_NOT_FINITE] |= exceeds(v[d * stride], STF_REAL_MAX);
        bad[STF_FAULT_POSITION_NOT_FINITE] |= exceeds(x[d * stride], STF_REAL_MAX);
        bad[STF_FAULT_VELOCITY_BOUND] |= exceeds(v[d * stride], most_v);
        bad[STF_FAULT_POSITION_BOUND] |= exceeds(x[d * stride], most_x);
    }
    while (kind <= STF_FAULT_POSITION_BOUND && !bad[kind])
        kind++;
    return kind <= STF_FAULT_POSITION_BOUND ? kind : STF_FAULT_NONE;
}

/* A pass over the world, as its parts see it. */
typedef struct look {
    const stf_world *world;
    stf_real most_x, most_v; /* m, m/s */
    size_t blocks;
    unsigned parts;
    bool is_bad[STF_PARTS_MAX];
} look;

static void look_part(void *context, unsigned part)
{
    look *l = context;
    const stf_world *world = l->world;
    const size_t length = stf_world_block_length(world), begin = l->blocks * part / l->parts * length;
    const size_t reals = l->blocks * (part + 1) / l->parts * length - begin;

    l->is_bad[part] =
        world->kernels->exceeds(world->storage.velocity + begin, reals, l->most_v) ||
        world->kernels->exceeds(world->storage.position + begin, reals, l->most_x);
}

static void copy_part(void *context, unsigned part)
{
    const look *l = context;
    const stf_storage *storage = &l->world->storage;
    const size_t length = stf_world_block_length(l->world), begin = l->blocks * part / l->parts * length;
    const size_t reals = l->blocks * (part + 1) / l->parts * length - begin;
    stf_real *arrays[STF_CHANGING_MAX];
    const size_t count = stf_storage_changing(storage, arrays);

    for (size_t k = 0; k < count; k++)
        memcpy(stf_storage_checkpoint(l->world, k) + begin, arrays[k] + begin, reals * sizeof(stf_real));
}

static void look_start(look *l, const stf_world *world)
{
    l->world = world;
    l->blocks = stf_world_blocks(world);
    l->parts = stf_world_parts(world, l->blocks / PART_BLOCKS_MIN);
}

bool stf_guard_find_fault(const stf_world *world, bool is_bounded, stf_fault *fault)
{
    look l; /* not set to 0: it is large */
    bool is_bad = false;

    look_start(&l, world);
    l.most_x = is_bounded ? limit(world->guard.position_bound) : STF_REAL_MAX;
    l.most_v = is_bounded ? limit(world->guard.velocity_bound) : STF_REAL_MAX;
    stf_world_run(world, l.parts, look_part, &l);
    for (unsigned part = 0; part < l.parts; part++)
        is_bad |= l.is_bad[part];
    for (size_t i = 0; i < world->count && is_bad; i++) { /* what stands in lanes of no particle is nobody's fault */
        const stf_fault_kind kind = kind_of(world, i);
        if (kind != STF_FAULT_NONE) {
            *fault = (stf_fault){.particle = i, .tick = world->ticks, .kind = kind};
            return true;
        }
    }
    return false;
}

unsigned stf_guard_interval(const stf_world *world)
{
    return world->guard.interval ? world->guard.interval : stf_world_is_tied(world) ? INTERVAL_TIED : INTERVAL;
}

void stf_guard_keep_checkpoint(stf_world *world)
{
    const uint64_t interval = stf_guard_interval(world);
    look l;

    look_start(&l, world);
    stf_world_run(world, l.parts, copy_part, &l);
    world->checkpoint = (stf_checkpoint){.is_valid = true, .history_stale = world->history_stale, .tick = world->ticks,
                                         .next = (world->ticks / interval + 1) * interval};
}

/* Exchanges the world's state and the checkpoint's, or only gets the checkpoint's. */
static void go_to_checkpoint(stf_world *world, bool keeps_state)
{
    const size_t length = stf_world_blocks(world) * stf_world_block_length(world);
    stf_real *arrays[STF_CHANGING_MAX];
    const size_t count = stf_storage_changing(&world->storage, arrays);

    for (size_t k = 0; k < count; k++) {
        stf_real *then = stf_storage_checkpoint(world, k), *now = arrays[k];

        for (size_t i = 0; i < length; i++) {
            const stf_real x = now[i];
            now[i] = then[i];
            if (keeps_state)
                then[i] = x;
        }
    }
    world->ticks = world->checkpoint.tick;
    world->history_stale = world->checkpoint.history_stale;
}

/* From the checkpoint, tick by tick: to the first that is bad, or to the last before the one that is known to be. */
static void replay(stf_world *world, stf_fault *fault)
{
    const uint64_t last = fault->tick - 1;

    while (world->ticks < last) {
        stf_world_advance(world, 1);
        if (stf_guard_find_fault(world, true, fault))
            return;
    }
}

/* The state takes the checkpoint's place for the while. */
void stf_guard_find_first_fault(stf_world *world, stf_fault *fault)
{
    stf_real *previous = world->storage.previous;
    const uint64_t ticks = world->ticks;

    go_to_checkpoint(world, true);
    world->storage.previous = NULL; /* that of the present is kept */
    replay(world, fault);
    world->storage.previous = previous;
    go_to_checkpoint(world, false);
    world->ticks = ticks;
    world->history_stale = false;
}

void stf_guard_go_back(stf_world *world, stf_fault *fault)
{
    go_to_checkpoint(world, false);
    replay(world, fault);
    if (world->ticks < fault->tick)
        return;
    go_to_checkpoint(world, false);
    stf_world_advance(world, (unsigned)(fault->tick - 1 - world->checkpoint.tick));
}
