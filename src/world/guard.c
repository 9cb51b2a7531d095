/*
 * The guard. No arithmetic makes an infinity or a NaN out of finite numbers unseen: it raises a flag of the processor, and a
 * flag costs nearly nothing to read. What raises none (a NaN from elsewhere, a bound) is found at a look at all particles,
 * every so many ticks, which keeps a copy of what is good: the checkpoint. From there ticks can be run again, since nothing
 * but a step changes a world without making its history stale, and so the checkpoint.
 */
#include <fenv.h>
#include <string.h>

#include "../flags.h"
#include "world.h"

/*
 * Measured: a look costs some two steps of semi-implicit Euler in flight, and a fifth of a step of a cloth. What is run again
 * after a fault then takes as long for both.
 */
#define INTERVAL 256
#define INTERVAL_TIED 16

/* Fewer blocks are looked at sooner than a thread is woken. */
#define PART_BLOCKS_MIN 16

/* Whether this machine raises the flags: not all emulators and instrumented runs do. */
static bool has_flags(void)
{
    volatile stf_real large = STF_REAL_MAX;
    fenv_t environment;

    feholdexcept(&environment); /* an engine may have asked for a trap */
    const stf_flags before = stf_flags_take();
    large *= 2;
    const bool raised = stf_flags_put_back(before) && large > STF_REAL_MAX;
    fesetenv(&environment);
    return raised;
}

static bool is_bound(double bound) { return bound >= 0 && isfinite(bound); }

stf_result stf_guard_complete(stf_guard *guard)
{
    if (guard->mode != STF_GUARD_OFF && guard->mode != STF_GUARD_REPORT && guard->mode != STF_GUARD_FREEZE)
        return STF_ERROR_PARAMETERS;
    if (!is_bound(guard->position_bound) || !is_bound(guard->velocity_bound))
        return STF_ERROR_PARAMETERS;
    if (!has_flags())
        guard->interval = 1;
    return STF_OK;
}

stf_result stf_world_set_guard(stf_world *world, stf_guard guard)
{
    if (!world)
        return STF_ERROR_NULL;

    const stf_guard before = world->guard;
    stf_result bad = stf_guard_complete(&guard);

    if (bad)
        return bad;
    world->guard = guard;
    bad = stf_storage_require(world, world->count, world->integrator, false);
    if (bad) {
        world->guard = before;
        return bad;
    }
    stf_guard_reset(world);
    return STF_OK;
}

stf_guard stf_world_guard(const stf_world *world) { return world ? world->guard : (stf_guard){.mode = STF_GUARD_OFF}; }

bool stf_world_fault(const stf_world *world, stf_fault *fault)
{
    if (!world || world->fault.kind == STF_FAULT_NONE)
        return false;
    if (fault)
        *fault = world->fault;
    return true;
}

stf_result stf_world_clear_fault(stf_world *world)
{
    if (!world)
        return STF_ERROR_NULL;

    stf_guard_reset(world);
    return STF_OK;
}

void stf_guard_reset(stf_world *world)
{
    world->fault = (stf_fault){.kind = STF_FAULT_NONE};
    world->checkpoint = (stf_checkpoint){.is_valid = false};
}

/* ---- looks ---- */

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

/* Whether a particle is bad as the world stands, and which; or whether any is not finite. */
static bool find_fault(const stf_world *world, bool is_bounded, stf_fault *fault)
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

/* ---- the checkpoint ---- */

unsigned stf_guard_interval(const stf_world *world)
{
    return world->guard.interval ? world->guard.interval : stf_world_is_tied(world) ? INTERVAL_TIED : INTERVAL;
}

static void keep_checkpoint(stf_world *world)
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
        if (find_fault(world, true, fault))
            return;
    }
}

/* Finds the first fault, and leaves the world as it is: its state takes the checkpoint's place for the while. */
static void find_first_fault(stf_world *world, stf_fault *fault)
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

/* Takes the world to the last good tick. */
static void go_back(stf_world *world, stf_fault *fault)
{
    go_to_checkpoint(world, false);
    replay(world, fault);
    if (world->ticks < fault->tick)
        return;
    go_to_checkpoint(world, false);
    stf_world_advance(world, (unsigned)(fault->tick - 1 - world->checkpoint.tick));
}

/* ---- steps ---- */

/* A task of a step, with the flags of the thread that it runs on. */
typedef struct watched {
    void (*task)(void *context, unsigned part);
    void *context;
    bool clears_flags, raised[STF_PARTS_MAX];
} watched;

/* Flags that the engine had raised count as the step's, until that has happened once: two reads of the register in place of one
   cost as much as a fifth of a step of one particle. */
static stf_flags start_watch(bool clears_flags)
{
    const stf_flags none = {0};

    return clears_flags ? stf_flags_take() : none;
}


static void run_watched(void *context, unsigned part)
{
    watched *w = context;
    const stf_flags before = start_watch(w->clears_flags);

    w->task(w->context, part);
    w->raised[part] = stf_flags_put_back(before);
}

void stf_guard_run(const stf_world *world, unsigned parts, void (*task)(void *, unsigned), void *context)
{
    watched w; /* not set to 0: it is large */

    w.task = task;
    w.context = context;
    w.clears_flags = world->clears_flags;
    world->parallel.run(world->parallel.user, parts, run_watched, &w);
    for (unsigned part = 0; part < parts; part++)
        *world->raised |= w.raised[part];
}

/* Whether any arithmetic of these ticks, on whatever thread, was out of the ordinary. */
static bool advance_watched(stf_world *world, unsigned ticks)
{
    bool raised = false;
    const stf_flags before = start_watch(world->clears_flags);

    world->raised = &raised;
    stf_world_advance(world, ticks);
    world->raised = NULL;
    raised |= stf_flags_put_back(before);
    world->clears_flags |= raised;
    return raised;
}

/* Up to `ticks` ticks, not beyond the next look. Whether a fault was found, which is in world->fault then. */
static bool step_to_look(stf_world *world, unsigned ticks)
{
    stf_checkpoint *checkpoint = &world->checkpoint;

    checkpoint->is_suspect |= advance_watched(world, ticks);

    const bool is_look = world->ticks == checkpoint->next;
    if (!is_look && !checkpoint->is_suspect)
        return false;
    if (!find_fault(world, is_look, &world->fault)) {
        if (is_look)
            keep_checkpoint(world);
        return false;
    }
    if (world->guard.mode == STF_GUARD_FREEZE)
        go_back(world, &world->fault);
    else if (checkpoint->is_valid)
        find_first_fault(world, &world->fault);
    return true;
}

static stf_result diverged(stf_world *world, unsigned ticks_left)
{
    const stf_storage *storage = &world->storage;

    if (world->guard.mode == STF_GUARD_REPORT)
        stf_world_advance(world, ticks_left);
    else if (storage->previous)
        memcpy(storage->previous, storage->position,
               stf_world_blocks(world) * stf_world_block_length(world) * sizeof(stf_real));
    return STF_ERROR_DIVERGED;
}

/*
 * Whether the steps to come need a checkpoint from here. A world that changes before every step has one made each time only
 * if it may have to go back: what flags tell of a single tick is of that tick.
 */
static bool needs_checkpoint(const stf_world *world, unsigned ticks)
{
    const stf_checkpoint *checkpoint = &world->checkpoint;
    const bool is_late = checkpoint->next <= world->ticks || checkpoint->next - world->ticks > stf_guard_interval(world);

    return !checkpoint->is_valid && (world->guard.mode == STF_GUARD_FREEZE || ticks > 1 || is_late);
}

stf_result stf_guard_step(stf_world *world, unsigned ticks)
{
    if (world->fault.kind != STF_FAULT_NONE) {
        if (world->guard.mode == STF_GUARD_FREEZE)
            return STF_ERROR_DIVERGED;
        stf_world_advance(world, ticks);
        return STF_OK;
    }
    world->checkpoint.is_valid &= !world->history_stale;
    if (needs_checkpoint(world, ticks)) {
        if (find_fault(world, true, &world->fault))
            return diverged(world, ticks);
        keep_checkpoint(world);
    }
    while (ticks > 0) {
        const uint64_t to_look = world->checkpoint.next - world->ticks;
        const unsigned now = ticks < to_look ? ticks : (unsigned)to_look;

        ticks -= now;
        if (step_to_look(world, now))
            return diverged(world, ticks);
    }
    return STF_OK;
}
