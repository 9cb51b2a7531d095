/*
 * The guard, against a shadow: a world without one that is stepped tick by tick and looked at here. The shadow says which
 * particle is bad first, after which tick and how; another is stepped to the tick before, for the state to freeze at.
 */
#include <fenv.h>
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"
#include "support/saved.h"

#define PARTICLES 700 /* some blocks in both precisions, the last of them not full */
#define TICKS 90      /* all that is stiff here has overflowed by then, in double too */
#define STEP (1.0 / 64)

/* A force that goes off at a time: pushes one particle along x with push / divisor. */
typedef struct bomb {
    double from, until; /* s */
    uint64_t particle;
    stf_real push; /* N */
    stf_real divisor;
} bomb;

static void explode(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const bomb *b = records;

    for (size_t r = 0; r < record_count; r++) {
        const size_t i = (size_t)b[r].particle - particles->first;

        if (time >= b[r].from && time < b[r].until && i < particles->count)
            particles->force[stf_particles_offset(particles, i)] += b[r].push / b[r].divisor;
    }
}

static const stf_force bomb_force = {.name = "bomb", .apply = explode, .depends_on = STF_ON_TIME,
                                     .record_size = sizeof(bomb), .fields = "888rr"};

/* v(n+1) = v(n) + a(n-1) dt: what overflows in one tick reaches the state in the next, and raises no flag then. */
static void late_step(stf_system *system, stf_real dt)
{
    stf_real *x = system->position, *v = system->velocity, *a = system->work[0], *before = system->history[0];

    system->accelerate(system, system->time, x, v, a);
    for (size_t i = 0; i < system->length; i++) {
        v[i] += (before[i] == before[i] ? before[i] : a[i]) * dt;
        x[i] += v[i] * dt;
        before[i] = a[i];
    }
}

static const stf_integrator late = {.name = "late", .step = late_step, .work_arrays = 1, .history_arrays = 1};

typedef struct scenario {
    const char *name;
    stf_real drag;      /* kg/s */
    stf_real stiffness; /* N/m, of a chain of springs; 0: none */
    bool is_tied, is_seen_at_once;
    bool explodes; /* in the middle of the run: push / divisor, N */
    bool goes_out; /* and pushes no longer than a tick */
    bool is_compensated;
    stf_real push, divisor;
    double position_bound, velocity_bound;
} scenario;

/* The masses are about 1 kg, so that a coefficient times the step is how far beyond stability it is. */
static const scenario scenarios[] = {
    {.name = "drag in flight", .drag = 1000000, .is_seen_at_once = true},
    {.name = "springs", .stiffness = (stf_real)1e10, .is_tied = true, .is_seen_at_once = true},
    {.name = "a field overflows", .explodes = true, .push = REAL_MAX, .divisor = 1, .is_seen_at_once = true},
    {.name = "a field overflows among links", .explodes = true, .push = REAL_MAX, .divisor = 1, .is_tied = true,
     .is_seen_at_once = true},
    {.name = "a field divides by 0", .explodes = true, .push = 1, .divisor = 0, .is_seen_at_once = true},
    {.name = "a field divides 0 by 0", .explodes = true, .push = 0, .divisor = 0, .is_seen_at_once = true},
    {.name = "a field gives a NaN", .explodes = true, .push = (stf_real)NAN, .divisor = 1},
    {.name = "a field gives an infinity, linked", .explodes = true, .push = (stf_real)INFINITY, .divisor = 1, .is_tied = true},
    {.name = "too far", .explodes = true, .push = 10000, .divisor = 1, .position_bound = 100},
    {.name = "too far among links", .explodes = true, .push = 10000, .divisor = 1, .is_tied = true, .position_bound = 100},
    {.name = "drag in flight, compensated", .drag = 1000000, .is_seen_at_once = true, .is_compensated = true},
    {.name = "too far, compensated", .explodes = true, .push = 10000, .divisor = 1, .position_bound = 100,
     .is_compensated = true},
    {.name = "too fast", .explodes = true, .push = 10000, .divisor = 1, .velocity_bound = 1000},
};

static stf_world *world_of(const scenario *s, const stf_integrator *integrator, stf_guard guard, stf_world_def def)
{
    uint64_t seed = 5;

    def.integrator = integrator;
    def.step = STEP;
    def.gravity = (stf_vector){0, -1, 0};
    def.guard = guard;
    def.compensated = s->is_compensated && (integrator->flags & STF_COMPENSATES);
    stf_world *world = make_world(def);
    for (size_t i = 0; i < PARTICLES; i++) {
        const stf_real x = (stf_real)next_random(&seed), v = (stf_real)next_random(&seed);
        assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)(i % 30), x, 0}, .velocity = {v, x, 1},
                                                       .inverse_mass = i % 10 ? (stf_real)1 + x : 0}, NULL));
    }
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){s->drag});
    if (s->explodes)
        add_force(world, &bomb_force,
                  &(bomb){.from = TICKS / 3 * STEP, .until = (TICKS / 3 + (s->goes_out ? 1 : TICKS)) * STEP, .particle = 431,
                          .push = s->push, .divisor = s->divisor});
    if (s->is_tied)
        add_force(world, &idle_link, NULL);
    for (uint32_t i = 0; s->stiffness > 0 && i < 8; i++)
        add_force(world, &stf_force_springs, &(stf_spring){.a = 600 + i, .b = 601 + i, .stiffness = s->stiffness});
    return world;
}

static stf_guard guard_of(const scenario *s, stf_guard_mode mode, unsigned interval)
{
    return (stf_guard){.mode = mode, .interval = interval, .position_bound = s->position_bound,
                       .velocity_bound = s->velocity_bound};
}

static bool any_not_finite(stf_vector v) { return !isfinite(v.x) || !isfinite(v.y) || !isfinite(v.z); }

static bool any_over(stf_vector v, double bound)
{
    return bound > 0 && (fabs((double)v.x) > bound || fabs((double)v.y) > bound || fabs((double)v.z) > bound);
}

static stf_fault look_at(const scenario *s, const stf_world *world)
{
    for (size_t i = 0; i < stf_world_count(world); i++) {
        const stf_particle p = particle_of(world, i);
        const stf_fault_kind kind = any_not_finite(p.velocity)                ? STF_FAULT_VELOCITY_NOT_FINITE
                                    : any_not_finite(p.position)              ? STF_FAULT_POSITION_NOT_FINITE
                                    : any_over(p.velocity, s->velocity_bound) ? STF_FAULT_VELOCITY_BOUND
                                    : any_over(p.position, s->position_bound) ? STF_FAULT_POSITION_BOUND
                                                                              : STF_FAULT_NONE;
        if (kind != STF_FAULT_NONE)
            return (stf_fault){.particle = i, .tick = stf_world_ticks(world), .kind = kind};
    }
    return (stf_fault){.kind = STF_FAULT_NONE};
}

static stf_fault first_fault(const scenario *s, const stf_integrator *integrator, unsigned substeps)
{
    stf_world *shadow = world_of(s, integrator, (stf_guard){.mode = STF_GUARD_OFF}, (stf_world_def){.substeps = substeps});
    stf_fault fault = {.kind = STF_FAULT_NONE};

    for (int tick = 0; tick < TICKS && fault.kind == STF_FAULT_NONE; tick++) {
        assert_ok(stf_world_step(shadow, 1));
        fault = look_at(s, shadow);
    }
    if (fault.kind == STF_FAULT_NONE)
        fail_msg("%s under %s never diverges", s->name, integrator->name);
    stf_world_destroy(shadow);
    return fault;
}

static void assert_fault(const stf_world *world, stf_fault expected)
{
    stf_fault fault;

    assert_true(stf_world_fault(world, &fault));
    assert_int_equal(fault.tick, expected.tick);
    assert_int_equal(fault.particle, expected.particle);
    assert_int_equal(fault.kind, expected.kind);
}

/* Every bit of what can be read, of a state that need not be finite: particles, and what blending sees. */
static void assert_same_state(const stf_world *a, const stf_world *b)
{
    enum { FLOATS = 3 * (PARTICLES + 8) };
    static float before[FLOATS], other[FLOATS];

    assert_true(stf_world_count(a) <= PARTICLES + 8);
    assert_true(hash_of(a) == hash_of(b));
    assert_ok(stf_world_copy_positions(a, 0, before, 0));
    assert_ok(stf_world_copy_positions(b, 0, other, 0));
    assert_memory_equal(before, other, stf_world_count(a) * 3 * sizeof(float));
}

/* How many ticks the n-th call asks for. */
static const unsigned patterns[][4] = {{1, 1, 1, 1}, {3, 1, 0, 5}, {TICKS, TICKS, TICKS, TICKS}};
static const unsigned intervals[] = {0, 1, 7};

/* Not under valgrind, say: the guard then looks at every tick. */
static bool raises_flags(void)
{
    volatile stf_real large = REAL_MAX;

    feclearexcept(FE_OVERFLOW);
    large *= 2;
    return large > REAL_MAX && fetestexcept(FE_OVERFLOW);
}

/*
 * An engine's threads, as far as flags go, on this one: parts in reverse order, each with flags of its own, of which some are
 * raised when it starts and have to be when it ends, and none of which the caller sees.
 */
static void run_elsewhere(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    fenv_t here;
    (void)user;

    fegetenv(&here);
    for (unsigned part = tasks; part-- > 0;) {
        feclearexcept(FE_ALL_EXCEPT);
        if (part % 2)
            feraiseexcept(FE_INVALID);
        task(context, part);
        assert_true(part % 2 == 0 || fetestexcept(FE_INVALID) || !raises_flags());
    }
    fesetenv(&here);
}

static const stf_parallel parallels[] = {{.tasks = 0}, {.run = run_elsewhere, .tasks = 3}};

/* Whether the step that finds a fault comes when it should; flags need arithmetic that raises them. */
static void assert_found_in_time(const scenario *s, const stf_world *world, stf_fault fault, uint64_t start, uint64_t end)
{
    const unsigned interval = stf_world_guard(world).interval ? stf_world_guard(world).interval : s->is_tied ? 16 : 512;

    assert_true(fault.tick <= end);
    if (s->is_seen_at_once)
        assert_true(fault.tick > start);
    else
        assert_true(fault.tick > start || start / interval == (fault.tick - 1) / interval);
}

static void check_freeze(const scenario *s, const stf_integrator *integrator, unsigned interval, const unsigned *pattern,
                         stf_parallel parallel, unsigned substeps)
{
    const stf_fault expected = first_fault(s, integrator, substeps);
    const stf_world_def def = {.substeps = substeps, .parallel = parallel};
    stf_world *world = world_of(s, integrator, guard_of(s, STF_GUARD_FREEZE, interval), def);
    stf_world *shadow = world_of(s, integrator, (stf_guard){.mode = STF_GUARD_OFF}, def);
    uint64_t start = 0, end = 0;
    stf_result result = STF_OK;

    for (int call = 0; !result && call < 6 * TICKS; call++) {
        assert_int_equal(stf_world_ticks(world), end);
        start = end, end += pattern[call % 4];
        result = stf_world_step(world, pattern[call % 4]);
    }
    assert_refused(result, STF_ERROR_DIVERGED);
    assert_found_in_time(s, world, expected, start, end);
    assert_fault(world, expected);
    assert_int_equal(stf_world_ticks(world), expected.tick - 1);

    assert_ok(stf_world_step(shadow, (unsigned)expected.tick - 1));
    saved good = save_of(shadow);
    assert_true(saved_is(good, world));
    assert_refused(stf_world_step(world, 5), STF_ERROR_DIVERGED);
    assert_true(saved_is(good, world));
    saved_free(&good);

    /* the game goes on, without what made it diverge */
    for (int n = 0; n < 2; n++) {
        stf_world *w = n ? shadow : world;
        while (stf_world_force_at(w, 0))
            assert_ok(stf_world_remove_force(w, stf_world_force_at(w, 0)));
        for (size_t i = 0; i < PARTICLES; i++)
            assert_ok(stf_world_set(w, i, &(stf_particle){.position = {1, 2, 3}, .inverse_mass = 1}));
    }
    assert_refused(stf_world_step(world, 1), STF_ERROR_DIVERGED);
    assert_ok(stf_world_clear_fault(world));
    assert_false(stf_world_fault(world, NULL));
    assert_ok(stf_world_step(world, 20));
    assert_ok(stf_world_step(shadow, 20));
    assert_true(hash_of(world) == hash_of(shadow));
    stf_world_destroy(world);
    stf_world_destroy(shadow);
}

static void check_report(const scenario *s, const stf_integrator *integrator, unsigned interval, const unsigned *pattern,
                         stf_parallel parallel, unsigned substeps)
{
    const stf_fault expected = first_fault(s, integrator, substeps);
    const stf_world_def def = {.substeps = substeps, .parallel = parallel, .keep_previous = true};
    stf_world *world = world_of(s, integrator, guard_of(s, STF_GUARD_REPORT, interval), def);
    stf_world *shadow = world_of(s, integrator, (stf_guard){.mode = STF_GUARD_OFF}, def);
    unsigned reports = 0;

    for (int call = 0; stf_world_ticks(world) < TICKS; call++) {
        const uint64_t start = stf_world_ticks(world);
        const stf_result result = stf_world_step(world, pattern[call % 4]);

        assert_ok(stf_world_step(shadow, pattern[call % 4]));
        assert_same_state(world, shadow);
        if (result) {
            assert_refused(result, STF_ERROR_DIVERGED);
            assert_found_in_time(s, world, expected, start, stf_world_ticks(world));
            reports++;
        }
    }
    if (reports == 0) { /* the look comes later */
        assert_refused(stf_world_step(world, 512), STF_ERROR_DIVERGED);
        reports++;
    }
    assert_int_equal(reports, 1);
    assert_fault(world, expected);
    stf_world_destroy(world);
    stf_world_destroy(shadow);
}

static void for_all(void (*check)(const scenario *s, const stf_integrator *integrator, unsigned interval,
                                  const unsigned *pattern, stf_parallel parallel, unsigned substeps))
{
    unsigned n = 0;

    for (size_t k = 0; k < COUNT_OF(scenarios); k++)
        for (int i = 0; saved_integrators[i]; i++)
            for (size_t p = 0; p < COUNT_OF(patterns); p++, n++)
                check(&scenarios[k], saved_integrators[i], intervals[n / 2 % COUNT_OF(intervals)], patterns[p],
                      parallels[n % 2], 1 + n % 3 / 2);
}

static void a_world_freezes_at_the_last_good_tick_and_goes_on(void **state)
{
    (void)state;
    for_all(check_freeze);
}

static void a_report_names_particle_and_tick_and_changes_no_bit(void **state)
{
    (void)state;
    for_all(check_report);
}

static void what_overflows_before_it_reaches_the_state_is_found_when_it_does(void **state)
{
    (void)state;
    const scenario once = {.name = "a field overflows in one tick", .explodes = true, .goes_out = true, .push = REAL_MAX,
                           .divisor = 1, .is_seen_at_once = true};

    for (size_t p = 0; p < COUNT_OF(patterns) - 1; p++) {
        check_freeze(&once, &late, 0, patterns[p], parallels[0], 1);
        check_report(&once, &late, 50, patterns[p], parallels[1], 1);
    }
}

static void a_frozen_world_stands_still_for_every_alpha(void **state)
{
    (void)state;
    const scenario *s = &scenarios[0];
    stf_world *world = world_of(s, &stf_rk4, guard_of(s, STF_GUARD_FREEZE, 0), (stf_world_def){.keep_previous = true});
    static float before[PARTICLES][3], now[PARTICLES][3];

    assert_refused(stf_world_step(world, TICKS), STF_ERROR_DIVERGED);
    assert_ok(stf_world_copy_positions(world, 0, before, 0));
    assert_ok(stf_world_copy_positions(world, 1, now, 0));
    assert_memory_equal(before, now, sizeof now);
    stf_world_destroy(world);
}

/* Nothing that happens to a good world disturbs it, and a fault among all that has its exact tick. */
static void worlds_that_change_at_every_tick_are_watched(void **state)
{
    (void)state;
    for (int mode = STF_GUARD_REPORT; mode <= STF_GUARD_FREEZE; mode++)
        for (int k = 0; saved_integrators[k]; k++) {
            stf_world *world = busy_world(saved_integrators[k], 0, (stf_allocator){0});
            stf_world *shadow = busy_world(saved_integrators[k], 0, (stf_allocator){0});

            assert_ok(stf_world_set_guard(world, (stf_guard){.mode = (stf_guard_mode)mode, .interval = 5}));
            for (unsigned n = 0; n < 40; n++) {
                busy_event(world, n), busy_event(shadow, n);
                assert_ok(stf_world_step(world, 1 + n % 2));
                assert_ok(stf_world_step(shadow, 1 + n % 2));
                saved s = save_of(shadow);
                assert_true(saved_is(s, world));
                saved_free(&s);
            }
            add_force(world, &bomb_force, &(bomb){.until = 99, .particle = 1, .push = REAL_MAX, .divisor = 1});
            assert_refused(stf_world_step(world, 3), STF_ERROR_DIVERGED);
            stf_fault fault;
            assert_true(stf_world_fault(world, &fault));
            assert_true(fault.tick > stf_world_ticks(shadow) && fault.tick <= stf_world_ticks(shadow) + 3);
            assert_int_equal(stf_world_ticks(world), mode == STF_GUARD_FREEZE ? fault.tick - 1 : stf_world_ticks(shadow) + 3);
            stf_world_destroy(world);
            stf_world_destroy(shadow);
        }
}

/* Records set before every tick: the guard has no ticks to run again, and still names the one that overflowed. */
static void a_report_of_a_world_that_always_changes_has_its_tick(void **state)
{
    (void)state;
    for (int mode = STF_GUARD_REPORT; mode <= STF_GUARD_FREEZE; mode++) {
        const scenario *s = &scenarios[2];
        stf_world *world = world_of(s, &stf_semi_implicit_euler, guard_of(s, (stf_guard_mode)mode, 0), (stf_world_def){0});
        stf_result result = STF_OK;
        unsigned tick = 0;

        for (; tick < 40 && !result; tick++) {
            assert_ok(stf_world_set_gravity(world, (stf_vector){(stf_real)tick, 0, 0}));
            result = stf_world_step(world, 1);
        }
        assert_int_equal(tick, TICKS / 3 + 1);
        assert_refused(result, STF_ERROR_DIVERGED);
        assert_fault(world, (stf_fault){.particle = 431, .tick = tick, .kind = STF_FAULT_VELOCITY_NOT_FINITE});
        if (mode == STF_GUARD_FREEZE) {
            stf_world *shadow = world_of(s, &stf_semi_implicit_euler, (stf_guard){.mode = STF_GUARD_OFF}, (stf_world_def){0});
            for (unsigned n = 0; n < tick; n++) {
                assert_ok(stf_world_set_gravity(shadow, (stf_vector){(stf_real)n, 0, 0}));
                assert_ok(stf_world_step(shadow, n + 1 < tick));
            }
            assert_true(hash_of(world) == hash_of(shadow));
            stf_world_destroy(shadow);
        }
        stf_world_destroy(world);
    }
}

/* A state that is bad to begin with has the tick from which the step started. */
static void a_particle_that_is_set_out_of_bounds_is_found_before_it_moves(void **state)
{
    (void)state;
    for (int mode = STF_GUARD_REPORT; mode <= STF_GUARD_FREEZE; mode++) {
        stf_world *world = make_world((stf_world_def){.guard = {(stf_guard_mode)mode, 0, 10, 0}});

        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
        assert_ok(stf_world_add(world, &(stf_particle){.velocity = {60, 0, 0}, .inverse_mass = 1}, NULL));
        assert_ok(stf_world_step(world, 1));
        assert_ok(stf_world_set(world, 1, &(stf_particle){.position = {0, -11, 0}}));
        assert_refused(stf_world_step(world, 3), STF_ERROR_DIVERGED);
        assert_fault(world, (stf_fault){.particle = 1, .tick = 1, .kind = STF_FAULT_POSITION_BOUND});
        assert_int_equal(stf_world_ticks(world), mode == STF_GUARD_FREEZE ? 1 : 4);
        assert_ok(stf_world_clear_fault(world)); /* and again, as long as nobody takes it back */
        assert_refused(stf_world_step(world, 1), STF_ERROR_DIVERGED);
        assert_ok(stf_world_clear_fault(world));
        assert_ok(stf_world_set(world, 1, &(stf_particle){.position = {0, -9, 0}}));
        assert_ok(stf_world_step(world, 3));
        stf_world_destroy(world);
    }
}

/* Whenever the world was changed. Where that was since the last look there is nothing to run again: the look's tick is told. */
static void looks_are_at_ticks_that_the_interval_divides(void **state)
{
    (void)state;
    for (unsigned change = 3; change < 8; change++) {
        stf_world *world = make_world((stf_world_def){.step = 1});

        assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
        assert_ok(stf_world_step(world, 3));
        assert_ok(stf_world_set_guard(world, (stf_guard){STF_GUARD_REPORT, 8, 10, 0}));
        for (unsigned tick = 3, last = raises_flags() ? 16 : 11; tick < last; tick++) {
            assert_ok(stf_world_set_gravity(world, (stf_vector){0, tick == change ? 1 : 0, 0}));
            assert_refused(stf_world_step(world, 1), tick + 1 < last ? STF_OK : STF_ERROR_DIVERGED);
        }
        assert_fault(world, (stf_fault){.tick = change + 1 < 8 || !raises_flags() ? 11 : 16, .kind = STF_FAULT_POSITION_BOUND});
        stf_world_destroy(world);
    }
}

/* Or when a world is frozen would depend on what the engine computed before. */
static void flags_do_not_bring_a_look_at_the_bounds_forward(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.guard = {STF_GUARD_FREEZE, 8, 5, 0}, .step = 1});

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
    feraiseexcept(FE_INVALID);
    for (unsigned tick = 0, last = raises_flags() ? 8 : 6; tick < last; tick++)
        assert_refused(stf_world_step(world, 1), tick + 1 < last ? STF_OK : STF_ERROR_DIVERGED);
    assert_fault(world, (stf_fault){.tick = 6, .kind = STF_FAULT_POSITION_BOUND});
    assert_int_equal(stf_world_ticks(world), 5);
    stf_world_destroy(world);
}

#define WATCHED_FLAGS (FE_OVERFLOW | FE_INVALID | FE_DIVBYZERO)

/* Flags that were raised before stay, and what the step alone raises is raised: as without a guard. */
static void flags_of_the_engine_are_as_without_a_guard(void **state)
{
    (void)state;
    static const int flags[] = {0, FE_OVERFLOW, FE_INVALID, FE_DIVBYZERO, FE_OVERFLOW | FE_INVALID, WATCHED_FLAGS};

    for (size_t k = 0; k < COUNT_OF(scenarios); k++)
        for (size_t f = 0; f < COUNT_OF(flags) && raises_flags(); f++) {
            const scenario *s = &scenarios[k];
            stf_world *worlds[3];
            int after[3];

            for (int mode = STF_GUARD_OFF; mode <= STF_GUARD_FREEZE; mode++) {
                worlds[mode] = world_of(s, &stf_rk4, guard_of(s, (stf_guard_mode)mode, 3), (stf_world_def){0});
                feclearexcept(FE_ALL_EXCEPT);
                feraiseexcept(flags[f]);
                stf_world_step(worlds[mode], TICKS / 4);
                after[mode] = fetestexcept(WATCHED_FLAGS);
                if (mode != STF_GUARD_OFF && s->explodes)
                    assert_int_equal(after[mode], flags[f]);
                stf_world_step(worlds[mode], TICKS);
                after[mode] = fetestexcept(WATCHED_FLAGS);
                stf_world_destroy(worlds[mode]);
            }
            assert_int_equal(after[STF_GUARD_REPORT], after[STF_GUARD_OFF]);
            assert_int_equal(after[STF_GUARD_FREEZE] & flags[f], flags[f]);
            assert_int_equal(after[STF_GUARD_FREEZE] & ~after[STF_GUARD_OFF], 0);
        }
    feclearexcept(FE_ALL_EXCEPT);
}

static void setting_a_guard_leaves_the_flags_alone(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){0});

    feclearexcept(FE_ALL_EXCEPT);
    feraiseexcept(FE_DIVBYZERO);
    assert_ok(stf_world_set_guard(world, (stf_guard){.mode = STF_GUARD_REPORT}));
    assert_true(fetestexcept(WATCHED_FLAGS) == FE_DIVBYZERO || !raises_flags());
    feclearexcept(FE_ALL_EXCEPT);
    stf_world_destroy(world);
}

/* The interval of 512 ticks that had begun is one of 16 from then on; no flag tells of a NaN that is read. */
static void a_link_brings_the_next_look_forward(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = STEP, .guard = {.mode = STF_GUARD_REPORT}});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    add_force(world, &bomb_force, &(bomb){.from = 5 * STEP, .until = 100, .push = (stf_real)NAN, .divisor = 1});
    assert_ok(stf_world_step(world, 2));
    add_force(world, &idle_link, NULL);
    while (!stf_world_step(world, 1))
        assert_true(stf_world_ticks(world) < 16);
    assert_fault(world, (stf_fault){.tick = 6, .kind = STF_FAULT_VELOCITY_NOT_FINITE});
    stf_world_destroy(world);
}

static void no_step_allocates_and_a_guard_without_memory_is_refused(void **state)
{
    (void)state;
    counting c = {0};
    stf_world *world = make_world((stf_world_def){.capacity = 300, .allocator = counting_allocator(&c)});
    const stf_guard freeze = {.mode = STF_GUARD_FREEZE, .interval = 2};

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 2, 3}, .inverse_mass = 1}, NULL));
    const uint64_t hash = hash_of(world);
    c.fail_at = c.calls + 1;
    assert_refused(stf_world_set_guard(world, freeze), STF_ERROR_MEMORY);
    assert_int_equal(stf_world_guard(world).mode, STF_GUARD_OFF);
    assert_true(hash_of(world) == hash);
    assert_ok(stf_world_set_guard(world, freeze));
    assert_int_equal(stf_world_guard(world).mode, STF_GUARD_FREEZE);
    assert_true(hash_of(world) == hash);

    const size_t calls = c.calls;
    assert_ok(stf_world_step(world, 1));
    assert_ok(stf_world_step(world, 9));
    assert_int_equal(c.calls, calls);
    c.fail_at = c.calls + 1;
    assert_refused(stf_world_reserve(world, 5000), STF_ERROR_MEMORY);
    assert_ok(stf_world_step(world, 9));
    assert_ok(stf_world_reserve(world, 5000)); /* the checkpoint was where the world was before */
    assert_ok(stf_world_set_guard(world, (stf_guard){STF_GUARD_FREEZE, 2, 0, 1}));
    assert_ok(stf_world_reserve(world, 50000));
    assert_refused(stf_world_step(world, 9), STF_ERROR_DIVERGED);
    stf_world_destroy(world);
    assert_int_equal(c.blocks, 0);

    for (size_t fail = 1; fail <= 2; fail++) {
        const stf_world_def def = {.guard = freeze, .allocator = counting_allocator(&c)};
        c.fail_at = c.calls + fail;
        assert_refused(stf_world_create(&def, &world), STF_ERROR_MEMORY);
        assert_int_equal(c.blocks, 0);
    }
}

/* Between two ticks, with a checkpoint that is good but for its place. */
static void a_world_that_moves_in_memory_freezes_where_it_would(void **state)
{
    (void)state;
    const scenario *s = &scenarios[6];
    const stf_fault expected = first_fault(s, &stf_velocity_verlet, 1);
    stf_world *world = world_of(s, &stf_velocity_verlet, guard_of(s, STF_GUARD_FREEZE, 64), (stf_world_def){0});
    stf_world *shadow = world_of(s, &stf_velocity_verlet, (stf_guard){.mode = STF_GUARD_OFF}, (stf_world_def){0});

    assert_ok(stf_world_step(world, 5));
    assert_ok(stf_world_reserve(world, 9 * PARTICLES));
    assert_refused(stf_world_step(world, TICKS), STF_ERROR_DIVERGED);
    assert_fault(world, expected);
    assert_ok(stf_world_step(shadow, (unsigned)expected.tick - 1));
    saved good = save_of(shadow);
    assert_true(saved_is(good, world));
    saved_free(&good);
    stf_world_destroy(world);
    stf_world_destroy(shadow);
}

static void loading_and_restoring_keep_the_guard_and_clear_the_fault(void **state)
{
    (void)state;
    const scenario *s = &scenarios[0];
    stf_world *world = world_of(s, &stf_position_verlet, guard_of(s, STF_GUARD_FREEZE, 0), (stf_world_def){0});
    const size_t size = stf_world_snapshot_size(world);
    void *memory = malloc(size);

    assert_ok(stf_world_snapshot(world, memory, size));
    saved start = save_of(world);
    assert_refused(stf_world_step(world, TICKS), STF_ERROR_DIVERGED);
    const uint64_t ticks = stf_world_ticks(world);
    for (int way = 0; way < 2; way++) {
        assert_ok(way ? stf_world_load(world, start.bytes, start.size, NULL) : stf_world_restore(world, memory, size));
        assert_false(stf_world_fault(world, NULL));
        assert_int_equal(stf_world_guard(world).mode, STF_GUARD_FREEZE);
        assert_refused(stf_world_step(world, TICKS), STF_ERROR_DIVERGED);
        assert_int_equal(stf_world_ticks(world), ticks);
    }
    assert_ok(stf_world_set_guard(world, (stf_guard){.mode = STF_GUARD_OFF}));
    assert_ok(stf_world_restore(world, memory, size));
    assert_int_equal(stf_world_guard(world).mode, STF_GUARD_OFF);
    assert_ok(stf_world_step(world, TICKS));
    saved_free(&start);
    free(memory);
    stf_world_destroy(world);
}

/* Its checkpoint is the other world's. */
static void a_snapshot_of_another_world_freezes_as_that_one_would(void **state)
{
    (void)state;
    const scenario *s = &scenarios[2];
    const stf_fault expected = first_fault(s, &stf_velocity_verlet, 1);
    stf_world *worlds[2];

    for (int n = 0; n < 2; n++)
        worlds[n] = world_of(s, &stf_velocity_verlet, guard_of(s, STF_GUARD_FREEZE, 0), (stf_world_def){0});
    assert_ok(stf_world_step(worlds[0], 5));
    const size_t size = stf_world_snapshot_size(worlds[0]);
    void *memory = malloc(size);
    assert_ok(stf_world_snapshot(worlds[0], memory, size));
    assert_ok(stf_world_restore(worlds[1], memory, size));
    for (int n = 0; n < 2; n++) {
        assert_refused(stf_world_step(worlds[n], TICKS), STF_ERROR_DIVERGED);
        assert_fault(worlds[n], expected);
    }
    saved good = save_of(worlds[0]);
    assert_true(saved_is(good, worlds[1]));
    saved_free(&good);
    free(memory);
    stf_world_destroy(worlds[0]);
    stf_world_destroy(worlds[1]);
}

static void bad_guards_are_refused_and_change_nothing(void **state)
{
    (void)state;
    static const stf_guard bad[] = {{STF_GUARD_FREEZE, 0, -1, 0},
                                    {STF_GUARD_FREEZE, 0, 0, -1},
                                    {STF_GUARD_REPORT, 0, (double)NAN, 0},
                                    {STF_GUARD_REPORT, 0, 0, (double)INFINITY},
                                    {(stf_guard_mode)3, 0, 0, 0}};
    stf_world *world = make_world((stf_world_def){.guard = {STF_GUARD_REPORT, 9, 1, 2}}), *none = NULL;

    for (size_t i = 0; i < COUNT_OF(bad); i++) {
        const stf_world_def def = {.guard = bad[i]};
        assert_refused(stf_world_create(&def, &none), STF_ERROR_PARAMETERS);
        assert_null(none);
        assert_refused(stf_world_set_guard(world, bad[i]), STF_ERROR_PARAMETERS);
        const stf_guard guard = stf_world_guard(world);
        assert_true(guard.mode == STF_GUARD_REPORT && guard.position_bound == 1 && guard.velocity_bound == 2);
    }
    assert_refused(stf_world_set_guard(NULL, bad[0]), STF_ERROR_NULL);
    assert_refused(stf_world_clear_fault(NULL), STF_ERROR_NULL);
    assert_false(stf_world_fault(NULL, NULL));
    assert_int_equal(stf_world_guard(NULL).mode, STF_GUARD_OFF);
    assert_ok(stf_world_set_guard(world, (stf_guard){STF_GUARD_FREEZE, 0, 1e300, 1e300})); /* a float's largest is less */
    assert_ok(stf_world_step(world, 3));
    stf_world_destroy(world);
}

/* In one look after the other 2^32 ticks would take minutes. */
static void an_empty_world_ages_at_once(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 1, .guard = {.mode = STF_GUARD_FREEZE, .interval = 1}});

    assert_ok(stf_world_step(world, UINT_MAX));
    assert_true(stf_world_ticks(world) == UINT_MAX);
    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {REAL_MAX, 0, 0}, .inverse_mass = 1}, NULL));
    assert_refused(stf_world_step(world, 2), STF_ERROR_DIVERGED);
    assert_true(stf_world_ticks(world) == (uint64_t)UINT_MAX + 1);
    stf_world_destroy(world);
}

/* So many that looks and copies are in three parts: whatever part the bad particle is in, the world freezes as its shadow. */
static void looks_in_parts_see_and_keep_every_particle(void **state)
{
    (void)state;
    enum { CROWD = 3 * 16 * STF_BLOCK_MAX + 5 };
    const scenario bounded = {.velocity_bound = 100};
    const stf_world_def def = {.dimensions = 2, .step = STEP, .integrator = &stf_velocity_verlet, .capacity = CROWD,
                               .gravity = {0, -1, 0}, .parallel = {.run = run_elsewhere, .tasks = 3}};
    const uint64_t bad[] = {3, CROWD / 2, CROWD - 1};

    for (size_t k = 0; k < 2 * COUNT_OF(bad); k++) {
        const bool overflows = k >= COUNT_OF(bad); /* which the flags of that part's thread tell, long before a look */
        stf_world *worlds[2] = {make_world(def), make_world(def)};
        stf_fault expected = {.kind = STF_FAULT_NONE};

        for (unsigned w = 0; w < 2; w++) {
            for (size_t i = 0; i < CROWD; i++)
                assert_ok(stf_world_add(worlds[w], &(stf_particle){.position.x = (stf_real)i, .velocity.x = (stf_real)(i % 7),
                                                                   .inverse_mass = 1}, NULL));
            add_force(worlds[w], &bomb_force,
                      &(bomb){.from = 6 * STEP, .until = 1, .particle = bad[k % COUNT_OF(bad)],
                              .push = overflows ? REAL_MAX : 10000, .divisor = (stf_real)0.5});
        }
        assert_ok(stf_world_set_guard(worlds[0], guard_of(&bounded, STF_GUARD_FREEZE, overflows && raises_flags() ? 1000 : 4)));
        assert_refused(stf_world_step(worlds[0], 12), STF_ERROR_DIVERGED);

        saved good = {.bytes = NULL};
        while (expected.kind == STF_FAULT_NONE) {
            saved_free(&good);
            good = save_of(worlds[1]);
            assert_ok(stf_world_step(worlds[1], 1));
            expected = look_at(&bounded, worlds[1]);
        }
        assert_fault(worlds[0], expected);
        assert_true(saved_is(good, worlds[0]));
        saved_free(&good);
        stf_world_destroy(worlds[0]);
        stf_world_destroy(worlds[1]);
    }
}

static void describe_tells_of_the_guard(void **state)
{
    (void)state;
    const scenario *s = &scenarios[0];
    stf_world *world = world_of(s, &stf_rk4, (stf_guard){STF_GUARD_FREEZE, 1, 1e4, 2e4}, (stf_world_def){0});
    char text[4096];

    stf_world_describe(world, text, sizeof text);
    assert_non_null(strstr(text, "guard: freezes; a look at every particle each 1 tick; within 10000 m; up to 20000 m/s\n"));
    assert_non_null(strstr(text, sizeof(stf_real) == sizeof(float) ? "24.0   two passes a look" : "48.0   two passes a look"));
    assert_refused(stf_world_step(world, TICKS), STF_ERROR_DIVERGED);
    stf_world_describe(world, text, sizeof text);
    assert_non_null(strstr(text, "m/s; found particle 1 at tick "));
    assert_ok(stf_world_set_guard(world, (stf_guard){.mode = STF_GUARD_REPORT, .interval = 1, .velocity_bound = 2e4}));
    stf_world_describe(world, text, sizeof text);
    assert_non_null(strstr(text, "guard: reports; a look at every particle each 1 tick; up to 20000 m/s"));
    stf_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_world_freezes_at_the_last_good_tick_and_goes_on),
        cmocka_unit_test(a_report_names_particle_and_tick_and_changes_no_bit),
        cmocka_unit_test(what_overflows_before_it_reaches_the_state_is_found_when_it_does),
        cmocka_unit_test(a_frozen_world_stands_still_for_every_alpha),
        cmocka_unit_test(worlds_that_change_at_every_tick_are_watched),
        cmocka_unit_test(a_report_of_a_world_that_always_changes_has_its_tick),
        cmocka_unit_test(a_particle_that_is_set_out_of_bounds_is_found_before_it_moves),
        cmocka_unit_test(looks_are_at_ticks_that_the_interval_divides),
        cmocka_unit_test(flags_do_not_bring_a_look_at_the_bounds_forward),
        cmocka_unit_test(flags_of_the_engine_are_as_without_a_guard),
        cmocka_unit_test(setting_a_guard_leaves_the_flags_alone),
        cmocka_unit_test(a_link_brings_the_next_look_forward),
        cmocka_unit_test(no_step_allocates_and_a_guard_without_memory_is_refused),
        cmocka_unit_test(a_world_that_moves_in_memory_freezes_where_it_would),
        cmocka_unit_test(loading_and_restoring_keep_the_guard_and_clear_the_fault),
        cmocka_unit_test(a_snapshot_of_another_world_freezes_as_that_one_would),
        cmocka_unit_test(bad_guards_are_refused_and_change_nothing),
        cmocka_unit_test(an_empty_world_ages_at_once),
        cmocka_unit_test(looks_in_parts_see_and_keep_every_particle),
        cmocka_unit_test(describe_tells_of_the_guard),
    };

    return cmocka_run_group_tests_name("guard, " REAL_NAME, tests, NULL, NULL);
}
