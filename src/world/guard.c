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
    if (guard->mode != STF_GUARD_OFF && !has_flags())
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
    if (!stf_guard_find_fault(world, is_look, &world->fault)) {
        if (is_look)
            stf_guard_keep_checkpoint(world);
        return false;
    }
    if (world->guard.mode == STF_GUARD_FREEZE)
        stf_guard_go_back(world, &world->fault);
    else if (checkpoint->is_valid)
        stf_guard_find_first_fault(world, &world->fault);
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

    if (checkpoint->is_valid)
        return false;
    if (world->guard.mode == STF_GUARD_FREEZE || ticks > 1)
        return true;
    return checkpoint->next <= world->ticks || checkpoint->next - world->ticks > stf_guard_interval(world);
}

stf_result stf_guard_step(stf_world *world, unsigned ticks)
{
    if (world->fault.kind != STF_FAULT_NONE) {
        if (world->guard.mode == STF_GUARD_FREEZE)
            return STF_ERROR_DIVERGED;
        stf_world_advance(world, ticks);
        return STF_OK;
    }
    if (world->count == 0) { /* nothing to look at, however many ticks */
        stf_world_advance(world, ticks);
        return STF_OK;
    }
    world->checkpoint.is_valid &= !world->history_stale;
    if (needs_checkpoint(world, ticks)) {
        if (stf_guard_find_fault(world, true, &world->fault))
            return diverged(world, ticks);
        stf_guard_keep_checkpoint(world);
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
