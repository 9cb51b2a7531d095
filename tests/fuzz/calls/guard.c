/* The guard: that of the two worlds, which may only report, and that of a third, which freezes. */
#include <math.h>
#include <stdio.h>

#include "game.h"

static stf_guard take_guard(program *p)
{
    const unsigned byte = take(p);
    stf_guard guard = {.mode = (stf_guard_mode)(byte & 3), .interval = byte >> 2 & 7};

    if (byte & 32)
        guard.position_bound = fabs((double)take_real(p));
    if (byte & 64)
        guard.velocity_bound = take_double(p);
    return guard;
}

static bool is_bound(double x) { return x >= 0 && isfinite(x); }

static unsigned guard_faults(stf_guard guard)
{
    const bool is_good = guard.mode <= STF_GUARD_FREEZE && is_bound(guard.position_bound) && is_bound(guard.velocity_bound);

    return is_good ? 0 : 1U << STF_ERROR_PARAMETERS;
}

static bool is_same_guard(stf_guard a, stf_guard b)
{
    return a.mode == b.mode && (a.interval == b.interval || a.interval == 1 || b.interval == 1) &&
           a.position_bound == b.position_bound && a.velocity_bound == b.velocity_bound;
}

/* No guard is part of the state: what the worlds save is what it was. */
void set_guard(game *g)
{
    const bool clears = (take(&g->program) & 1) != 0;
    stf_guard guard = take_guard(&g->program);

    if (guard.mode == STF_GUARD_FREEZE) /* one world would stand, and the other go on */
        guard.mode = STF_GUARD_REPORT;
    begin(g, clears ? "clear_fault" : "set_guard", clears ? 0 : guard_faults(guard));
    for (stf_world *world; (world = turn(g)) != NULL;) {
        const stf_guard before = stf_world_guard(world);

        g->result = clears ? stf_world_clear_fault(world) : stf_world_set_guard(world, guard);
        claim(is_same_guard(stf_world_guard(world), clears || g->result ? before : guard));
        claim(g->result || !stf_world_fault(world, NULL));
    }
}

/* ---- a world that freezes ------------------------------------------------------------------------------------------------ */

static bool is_within(stf_vector v, double bound)
{
    const stf_real most = (stf_real)fmin(bound, (double)REAL_MAX);

    return bound == 0 || (v.x <= most && v.x >= -most && v.y <= most && v.y >= -most && v.z <= most && v.z >= -most);
}

static stf_fault_kind kind_of(const stf_particle *p, stf_guard guard)
{
    if (vector_faults(p->velocity, 3))
        return STF_FAULT_VELOCITY_NOT_FINITE;
    if (vector_faults(p->position, 3))
        return STF_FAULT_POSITION_NOT_FINITE;
    if (!is_within(p->velocity, guard.velocity_bound))
        return STF_FAULT_VELOCITY_BOUND;
    return is_within(p->position, guard.position_bound) ? STF_FAULT_NONE : STF_FAULT_POSITION_BOUND;
}

/* What the guard should say of a world as it stands. */
static stf_fault fault_of(const stf_world *world, stf_guard guard)
{
    stf_fault fault = {.tick = stf_world_ticks(world)};

    for (size_t i = 0; i < stf_world_count(world) && fault.kind == STF_FAULT_NONE; i++) {
        stf_particle p;

        claim(stf_world_get(world, i, &p) == STF_OK);
        fault.kind = kind_of(&p, guard);
        fault.particle = i;
    }
    return fault;
}

static void claim_same_state(const stf_world *a, const stf_world *b)
{
    claim(stf_world_ticks(a) == stf_world_ticks(b));
    for (size_t i = 0; i < stf_world_count(a); i++) {
        stf_particle p, q;

        claim(stf_world_get(a, i, &p) == STF_OK && stf_world_get(b, i, &q) == STF_OK);
        claim(is_same_vector(p.position, q.position) && is_same_vector(p.velocity, q.velocity));
    }
}

/* To this tick, one by one; `is_good`: none of them is bad. */
static void follow(stf_world *shadow, uint64_t tick, stf_guard guard, bool is_good)
{
    while (stf_world_ticks(shadow) < tick) {
        claim(!is_good || fault_of(shadow, guard).kind == STF_FAULT_NONE);
        claim(stf_world_step(shadow, 1) == STF_OK);
    }
}

static void claim_frozen(stf_world *world, stf_world *shadow, stf_guard guard)
{
    stf_fault found;

    claim(stf_world_fault(world, &found) && found.tick >= stf_world_ticks(shadow));
    if (found.tick > stf_world_ticks(shadow))
        follow(shadow, found.tick - 1, guard, true);
    claim_same_state(world, shadow);
    follow(shadow, found.tick, guard, true);

    const stf_fault expected = fault_of(shadow, guard);
    claim(found.kind == expected.kind && found.tick == expected.tick && found.particle == expected.particle);
    claim(stf_world_step(world, 1) == STF_ERROR_DIVERGED && stf_world_clear_fault(world) == STF_OK);
    claim(!stf_world_fault(world, NULL));
}

/*
 * The worlds as they stand, in a third that may freeze and a fourth without a guard, which is its shadow. What the guard says
 * is so, and as long as it says nothing it changes nothing.
 */
void freeze(game *g)
{
    const unsigned ticks = 1 + take(&g->program) % 6;
    const double cost = 2 * (double)g->model.count + 2 * ticks * model_tick_cost(&g->model);
    stf_guard guard = take_guard(&g->program);
    ration rations[2] = {{.garbage = 0x5a}, {.garbage = 0xff}};

    if (!can_be_copied(g) || cost > g->work)
        return;

    stf_world *world = copy_of_both(g, &rations[0]), *shadow = copy_of_both(g, &rations[1]);
    guard.mode = STF_GUARD_FREEZE;
    claim(stf_world_set_guard(world, guard) == (guard_faults(guard) ? STF_ERROR_PARAMETERS : STF_OK));
    guard = stf_world_guard(world); /* none, where it was refused */
    rations[0].closed = true;
    const stf_result result = stf_world_step(world, ticks);
    rations[0].closed = false;
    if (fuzz_verbose)
        printf("%-20s%s\n", "freeze", stf_result_text(result));
    if (result)
        claim(result == STF_ERROR_DIVERGED && (claim_frozen(world, shadow, guard), true));
    else {
        follow(shadow, stf_world_ticks(world), guard, guard.mode == STF_GUARD_FREEZE && guard.interval == 1);
        claim_same_state(world, shadow);
    }
    stf_world_destroy(world);
    stf_world_destroy(shadow);
    claim(rations[0].blocks == 0 && rations[1].blocks == 0);
    g->work -= cost;
}
