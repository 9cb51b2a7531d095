/* Coming to rest: what is smaller than STF_AT_REST becomes 0 at every multiple of STF_SETTLE_TICKS ticks, and nothing else. */
#define _POSIX_C_SOURCE 200112L /* setenv */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/problem.h"
#include "support/saved.h"

#ifdef STF_DOUBLE
#define EXPONENT (-504)
#define DIGITS_OF_RANGE 324
static stf_real below(stf_real x) { return nextafter(x, 0); }
#else
#define EXPONENT (-56)
#define DIGITS_OF_RANGE 46
static stf_real below(stf_real x) { return nextafterf(x, 0); }
#endif

static stf_real negative_zero(void) { return -(stf_real)0; }

static bool is_bitwise(stf_real a, stf_real b) { return memcmp(&a, &b, sizeof a) == 0; }

/* Leaves all as it is, and keeps of each position what it was when the history was made. */
static void stand_still(stf_system *system, stf_real dt)
{
    (void)dt;
    for (size_t i = 0; i < system->length; i++)
        if (system->history_stale && system->history[0][i] != system->history[0][i])
            system->history[0][i] = system->position[i];
}

static void lose_history(stf_system *system, stf_real dt)
{
    (void)dt;
    for (size_t i = 0; i < system->length; i++)
        system->history[0][i] = (stf_real)NAN;
}

static const stf_integrator still = {.name = "still", .step = stand_still, .history_arrays = 1};
static const stf_integrator loser = {.name = "loser", .step = lose_history, .history_arrays = 1};

static stf_real last_history(const stf_world *world)
{
    saved s = save_of(world);
    const stf_real last = saved_from_end(s, 0);

    saved_free(&s);
    return last;
}

static void the_threshold_is_a_power_of_two_whose_square_is_normal(void **state)
{
    (void)state;
    assert_true(STF_AT_REST == (stf_real)ldexp(1, EXPONENT));
    assert_true(STF_AT_REST * STF_AT_REST * (stf_real)ldexp(1, -14) == REAL_LEAST);
}

/* One dimension, one particle: what it is after so many ticks in which nothing moves it. */
static stf_particle after(unsigned ticks, stf_real position, stf_real velocity)
{
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .integrator = &still});
    const stf_particle start = {.position = {position, 0, 0}, .velocity = {velocity, 0, 0}, .inverse_mass = 1};

    assert_ok(stf_world_add(world, &start, NULL));
    assert_ok(stf_world_step(world, ticks));
    const stf_particle end = particle_of(world, 0);
    stf_world_destroy(world);
    return end;
}

static void what_is_below_the_threshold_becomes_zero_and_keeps_its_sign(void **state)
{
    (void)state;
    const stf_real rest = STF_AT_REST, least = REAL_LEAST;
    const stf_real given[] = {rest, below(rest), least, below(least), 0, 1, REAL_MAX};
    const bool settles[] = {false, true, true, true, true, false, false};

    for (size_t i = 0; i < COUNT_OF(given); i++) {
        const stf_real plus = settles[i] ? 0 : given[i], minus = settles[i] ? negative_zero() : -given[i];
        const stf_particle early = after(STF_SETTLE_TICKS - 1, given[i], -given[i]);
        const stf_particle late = after(STF_SETTLE_TICKS, given[i], -given[i]);
        const stf_particle other = after(STF_SETTLE_TICKS, -given[i], given[i]);

        assert_true(is_bitwise(early.position.x, given[i]) && is_bitwise(early.velocity.x, -given[i]));
        assert_true(is_bitwise(late.position.x, plus) && is_bitwise(late.velocity.x, minus));
        assert_true(is_bitwise(other.position.x, minus) && is_bitwise(other.velocity.x, plus));
    }
}

/* Of a component in motion no small history is lost, since the acceleration may just be passing 0. */
static void history_goes_only_where_it_and_the_velocity_are_at_rest(void **state)
{
    (void)state;
    const stf_real rest = STF_AT_REST, values[] = {rest, below(rest), -rest, -below(rest)};

    for (size_t v = 0; v < COUNT_OF(values); v++)
        for (size_t h = 0; h < COUNT_OF(values); h++) {
            stf_world *world = make_world((stf_world_def){.dimensions = 1, .integrator = &still});
            const stf_particle start = {.position = {values[h], 0, 0}, .velocity = {values[v], 0, 0}, .inverse_mass = 1};
            const bool settles = v % 2 == 1 && h % 2 == 1;

            assert_ok(stf_world_add(world, &start, NULL));
            assert_ok(stf_world_step(world, STF_SETTLE_TICKS - 1));
            assert_true(is_bitwise(last_history(world), values[h]));
            assert_ok(stf_world_step(world, 1));
            assert_true(is_bitwise(last_history(world), settles ? 0 * values[h] : values[h]));
            stf_world_destroy(world);
        }
}

static void the_mark_of_no_history_stays(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .integrator = &loser});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_step(world, STF_SETTLE_TICKS));
    assert_true(isnan(last_history(world)));
    stf_world_destroy(world);
}

/* What a non-finite state is, it stays, so that it can be found. */
static void what_is_not_finite_is_left_alone(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .step = 1});
    const stf_particle fast = {.position = {REAL_MAX, 0, 0}, .velocity = {REAL_MAX, 0, 0}, .inverse_mass = 1};
    size_t index;

    assert_ok(stf_world_add(world, &fast, NULL));
    assert_ok(stf_world_step(world, STF_SETTLE_TICKS));
    assert_true(isinf(particle_of(world, 0).position.x));
    assert_true(stf_world_find_non_finite(world, &index));
    stf_world_destroy(world);
}

/* ---- scenes that come to rest -------------------------------------------------------------------------------------------- */

#define PARTICLES (8 * STF_BLOCK_MAX + 1) /* a part has at least 4 blocks */
#define STEP 0.5
#define DRAG 0.9 /* kg/s, of 1 kg */

typedef enum decay { LINEAR, QUADRATIC, ANCHORED, NET, DECAYS } decay;

/* Linear drag is everywhere: quadratic drag alone would take for ever. */
static stf_world *decaying_world(decay kind, const stf_integrator *integrator, double size, stf_parallel parallel)
{
    stf_world *world =
        make_world((stf_world_def){.integrator = integrator, .step = STEP, .keep_previous = true, .parallel = parallel});

    for (uint32_t i = 0; i < PARTICLES; i++) {
        const stf_real s = (stf_real)(size * (1 + 0.001 * i));
        const stf_particle p = {.position = {s, -s, 2 * s}, .velocity = {s, 2 * s, -s}, .inverse_mass = i % 97 == 96 ? 0 : 1};
        const stf_anchored_spring spring = {.particle = i, .stiffness = (stf_real)0.5, .damping = (stf_real)0.1};

        assert_ok(stf_world_add(world, &p, NULL));
        if (kind == ANCHORED && i % 100 == 0)
            add_force(world, &stf_force_anchored_springs, &spring);
    }
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){.coefficient = (stf_real)DRAG});
    if (kind == QUADRATIC)
        add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){.coefficient = (stf_real)0.01});
    if (kind == NET)
        add_force(world, &idle_link, NULL);
    return world;
}

/* How long it takes until what was so large is below the smallest real, and a tick more; a spring's swing has half the rate. */
static unsigned ticks_to_rest(double size)
{
    const double ticks = (log(size) + DIGITS_OF_RANGE * log(10)) / (DRAG / 2 * STEP);

    return ((unsigned)ticks / STF_SETTLE_TICKS + 2) * STF_SETTLE_TICKS + 1;
}

static bool is_subnormal(stf_real x) { return x != 0 && fabs((double)x) < (double)REAL_LEAST; }

static void what_slows_down_comes_to_rest_exactly_and_leaves_nothing_subnormal(void **state)
{
    (void)state;
    for (int d = 0; d < DECAYS; d++)
        for (int k = 0; stf_integrators[k]; k++) {
            stf_world *world = decaying_world((decay)d, stf_integrators[k], 1, (stf_parallel){.tasks = 0});
            const size_t arrays = 3 + (size_t)stf_integrators[k]->history_arrays;
            saved s;

            assert_ok(stf_world_step(world, ticks_to_rest(1)));
            for (size_t i = 0; i < PARTICLES; i++) {
                const stf_particle p = particle_of(world, i);
                assert_true(p.inverse_mass == 0 || (p.velocity.x == 0 && p.velocity.y == 0 && p.velocity.z == 0));
            }
            s = save_of(world);
            for (size_t i = 0; i < (arrays * 3 + 1) * PARTICLES; i++)
                assert_false(is_subnormal(saved_from_end(s, i)));
            saved_free(&s);
            stf_world_destroy(world);
        }
}

static void run_backwards(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    for (unsigned i = tasks; i-- > 0;)
        task(context, i);
}

/* From where it takes some 60 ticks to get below the threshold. */
#define NEARLY ((double)STF_AT_REST * 0x1p20)
#define TICKS (STF_SETTLE_TICKS + 1)

/* In calls of so many ticks at a time, saved and loaded into another world in between. */
static saved run_in_lots(decay kind, const stf_integrator *integrator, unsigned lot, stf_parallel parallel)
{
    stf_world *world = decaying_world(kind, integrator, NEARLY, parallel);

    for (unsigned done = 0, n; done < TICKS; done += n) {
        n = TICKS - done < lot ? TICKS - done : lot;
        assert_ok(stf_world_step(world, n));
        stf_world *other = decaying_world(kind, integrator, NEARLY, parallel);
        saved between = save_of(world);
        assert_ok(stf_world_load(other, between.bytes, between.size, NULL));
        saved_free(&between);
        stf_world_destroy(world);
        world = other;
    }
    saved s = save_of(world);
    stf_world_destroy(world);
    return s;
}

static void it_does_not_matter_how_the_ticks_are_run(void **state)
{
    (void)state;
    const stf_parallel parallel = {.run = run_backwards, .tasks = 3};
    const unsigned lots[] = {13, 64, 200};

    for (int d = 0; d < DECAYS; d++)
        for (int k = 0; stf_integrators[k]; k++) {
            stf_world *whole = decaying_world((decay)d, stf_integrators[k], NEARLY, (stf_parallel){.tasks = 0});

            assert_ok(stf_world_step(whole, TICKS));
            assert_true(particle_of(whole, 0).velocity.x == 0);
            for (size_t i = 0; i < COUNT_OF(lots); i++) {
                saved s = run_in_lots((decay)d, stf_integrators[k], lots[i], i > 0 ? parallel : (stf_parallel){.tasks = 0});
                assert_true(saved_is(s, whole));
                saved_free(&s);
            }
            stf_world_destroy(whole);
        }
}

/* 0 or not is decided at the same tick in the loops of every instruction set; what the machine lacks is the next one below. */
static void every_instruction_set_settles_the_same(void **state)
{
    (void)state;
    static const char *const isas[] = {"avx512", "avx2", "baseline"};
    const char *given = getenv("STEADFAST_ISA");
    char *before = given ? strcpy(malloc(strlen(given) + 1), given) : NULL;
    const stf_integrator *integrator = &stf_position_verlet;
    saved first = {.bytes = NULL};

    for (size_t i = 0; i < COUNT_OF(isas); i++) {
        assert_int_equal(setenv("STEADFAST_ISA", isas[i], 1), 0);
        stf_world *world = decaying_world(ANCHORED, integrator, NEARLY, (stf_parallel){.tasks = 0});
        assert_ok(stf_world_step(world, TICKS));
        if (i == 0)
            first = save_of(world);
        assert_true(saved_is(first, world));
        stf_world_destroy(world);
    }
    saved_free(&first);
    assert_int_equal(before ? setenv("STEADFAST_ISA", before, 1) : unsetenv("STEADFAST_ISA"), 0);
    free(before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_threshold_is_a_power_of_two_whose_square_is_normal),
        cmocka_unit_test(what_is_below_the_threshold_becomes_zero_and_keeps_its_sign),
        cmocka_unit_test(history_goes_only_where_it_and_the_velocity_are_at_rest),
        cmocka_unit_test(the_mark_of_no_history_stays),
        cmocka_unit_test(what_is_not_finite_is_left_alone),
        cmocka_unit_test(what_slows_down_comes_to_rest_exactly_and_leaves_nothing_subnormal),
        cmocka_unit_test(it_does_not_matter_how_the_ticks_are_run),
        cmocka_unit_test(every_instruction_set_settles_the_same),
    };

    return cmocka_run_group_tests_name("settle, " REAL_NAME, tests, NULL, NULL);
}
