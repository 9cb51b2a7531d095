/*
 * Compensated positions and velocities: the error of a sum does not grow with the number of its terms. Each step adds a term d
 * of a few roundings, so that after a path of sum |d| the state is off by ROUNDINGS eps of that path, in however many steps.
 * Two of them are the sum's (D. Goldberg, ACM Computing Surveys 23, 5 (1991), theorem 8), up to seven those of d itself
 * (RK4's), one is that of the bound's own terms of n eps^2.
 */
#define _POSIX_C_SOURCE 200112L /* setenv */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"
#include "support/saved.h"

#define ROUNDINGS 10

/* One particle of 1 kg in one dimension. */
static stf_world *line_world(const stf_integrator *integrator, bool compensated, double step, double position,
                             double velocity)
{
    stf_world *world =
        make_world((stf_world_def){.dimensions = 1, .integrator = integrator, .step = step, .compensated = compensated});
    const stf_particle p = {.position = {(stf_real)position, 0, 0}, .velocity = {(stf_real)velocity, 0, 0}, .inverse_mass = 1};

    assert_ok(stf_world_add(world, &p, NULL));
    return world;
}

static stf_particle run(stf_world *world, unsigned ticks)
{
    assert_ok(stf_world_step(world, ticks));
    const stf_particle p = particle_of(world, 0);
    stf_world_destroy(world);
    return p;
}

/* ---- accuracy ------------------------------------------------------------------------------------------------------------ */

#define TICKS 1000000U
#define TICK (1.0 / 60)
#define MUCH_WORSE 20 /* what a plain sum is after so many ticks */

static void show(const char *motion, const stf_integrator *integrator, double plain, double compensated, double exact)
{
    print_message("%-14s  %-19s  relative error after %u ticks: plain %.1e, compensated %.1e\n", motion,
                  integrator->name, TICKS, fabs(plain / exact - 1), fabs(compensated / exact - 1));
}

static void uniform_motion_is_off_by_as_much_after_a_million_ticks_as_after_one(void **state)
{
    (void)state;
    const double h = (double)(stf_real)TICK, speed = (double)(stf_real)0.7;

    for (int k = 0; stf_integrators[k]; k++) {
        const double path = TICKS * h * speed;
        const stf_particle p = run(line_world(stf_integrators[k], true, TICK, 0, speed), TICKS);
        const stf_particle plain = run(line_world(stf_integrators[k], false, TICK, 0, speed), TICKS);

        show("uniform motion", stf_integrators[k], (double)plain.position.x, (double)p.position.x, path);
        assert_close(p.position.x, path, ROUNDINGS * REAL_EPSILON * path);
        assert_above(fabs((double)plain.position.x - path), MUCH_WORSE * ROUNDINGS * REAL_EPSILON * path);
    }
}

/* x(n) = g h^2 times n (n - 1) / 2 for explicit Euler, n (n + 1) / 2 for semi-implicit Euler, n^2 / 2 for all others. */
static void a_fall_is_off_by_as_much_after_a_million_ticks_as_after_one(void **state)
{
    (void)state;
    const double h = (double)(stf_real)TICK, g = (double)(stf_real)-9.81, n = TICKS;

    for (int k = 0; stf_integrators[k]; k++) {
        const stf_integrator *integrator = stf_integrators[k];
        const double lag = integrator == &stf_explicit_euler ? -1 : integrator == &stf_semi_implicit_euler ? 1 : 0;
        const double v = n * h * g, x = n * (n + lag) / 2 * h * h * g;
        stf_world *world = line_world(integrator, true, TICK, 0, 0), *plain = line_world(integrator, false, TICK, 0, 0);

        assert_ok(stf_world_set_gravity(world, (stf_vector){(stf_real)g, 0, 0}));
        assert_ok(stf_world_set_gravity(plain, (stf_vector){(stf_real)g, 0, 0}));
        const stf_particle p = run(world, TICKS), q = run(plain, TICKS);
        show("fall", integrator, (double)q.position.x, (double)p.position.x, x);
        assert_close(p.velocity.x, v, ROUNDINGS * REAL_EPSILON * fabs(v));
        assert_close(p.position.x, x, ROUNDINGS * REAL_EPSILON * fabs(x));
        assert_above(fabs((double)q.position.x - x), MUCH_WORSE * ROUNDINGS * REAL_EPSILON * fabs(x));
    }
}

/* x'' = -x in exact arithmetic, or near: v -= x kick; x += v h; v -= x rest of the kick. */
static void oscillate(unsigned steps, long double h, long double kick, long double *x, long double *v)
{
    for (unsigned n = 0; n < steps; n++) {
        *v -= *x * kick;
        *x += *v * h;
        *v -= *x * (h - kick);
    }
}

/* The spring's own force has some six roundings more, at every step alike. An error of a neutral oscillator stays as it is. */
static void an_oscillator_is_as_far_off_with_small_steps_as_with_large_ones(void **state)
{
    (void)state;
    const double duration = 64, bound = (ROUNDINGS + 6) * REAL_EPSILON * duration;
    const unsigned steps[] = {1U << 12, 1U << 16, 1U << 20};
    const stf_integrator *const neutral[] = {&stf_semi_implicit_euler, &stf_position_verlet, &stf_velocity_verlet};

    for (size_t k = 0; k < COUNT_OF(neutral); k++)
        for (size_t i = 0; i < COUNT_OF(steps); i++) {
            const double h = duration / steps[i]; /* exact */
            /* position Verlet takes the acceleration at the start for that at the end, off by h^2 / 2 */
            const double lag = neutral[k] == &stf_position_verlet ? h * h / 2 : 0;
            stf_world *world = line_world(neutral[k], true, h, 1, 0);
            long double x = 1, v = 0;

            add_force(world, &stf_force_anchored_springs, &(stf_anchored_spring){.stiffness = 1});
            oscillate(steps[i], (long double)h, (long double)(neutral[k] == &stf_semi_implicit_euler ? h : h / 2), &x, &v);
            const stf_particle p = run(world, steps[i]);
            assert_close(p.position.x, x, bound);
            assert_close(p.velocity.x, v, bound + lag);
        }
}

/* A unit in the last place of 2^23 (in double 2^52) is 1 m, and a step is 1/64 m. */
static void what_freezes_far_from_the_origin_moves_at_its_speed(void **state)
{
    (void)state;
    const double far = 1 / REAL_EPSILON, seconds = 100;
    const unsigned ticks = 64 * 100;

    for (int k = 0; stf_integrators[k]; k++) {
        assert_true((double)run(line_world(stf_integrators[k], false, 1.0 / 64, far, 1), ticks).position.x == far);
        assert_close(run(line_world(stf_integrators[k], true, 1.0 / 64, far, 1), ticks).position.x, far + seconds, 0.5);
    }
}

/* ---- the same bits however it is run ------------------------------------------------------------------------------------- */

#define PARTICLES (8 * STF_BLOCK_MAX + 3) /* a part has at least 4 blocks */
#define RUN_TICKS 100

static void push_nothing(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)particles, (void)time;
}

static const stf_force idle_field = {.name = "idle field", .kind = STF_FIELD, .apply = push_nothing};

static void run_backwards(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    for (unsigned i = tasks; i-- > 0;)
        task(context, i);
}

/* In free flight, or with a force that does nothing but choose another path through the library. */
static stf_world *crowd(const stf_integrator *integrator, const stf_force *idle, unsigned tasks)
{
    const stf_parallel parallel = {.run = run_backwards, .tasks = tasks};
    stf_world *world = make_world((stf_world_def){.integrator = integrator, .compensated = true, .parallel = parallel,
                                                  .gravity = {0, (stf_real)-9.81, 1}});
    uint64_t seed = 5;

    for (size_t i = 0; i < PARTICLES; i++) {
        stf_particle p = {.inverse_mass = i % 7 == 6 ? 0 : (stf_real)(1 + next_random(&seed))};
        stf_real *reals[] = {&p.position.x, &p.position.y, &p.position.z, &p.velocity.x, &p.velocity.y, &p.velocity.z};
        for (size_t c = 0; c < COUNT_OF(reals); c++)
            *reals[c] = (stf_real)(100 * next_random(&seed) - 50);
        assert_ok(stf_world_add(world, &p, NULL));
    }
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){.coefficient = (stf_real)0.1});
    if (idle)
        add_force(world, idle, NULL);
    return world;
}

static bool same_particles(const stf_world *a, const stf_world *b)
{
    bool same = stf_world_count(a) == stf_world_count(b);

    for (size_t i = 0; same && i < stf_world_count(a); i++) {
        const stf_particle p = particle_of(a, i), q = particle_of(b, i);
        same = memcmp(&p, &q, sizeof p) == 0; /* reals alone: no padding */
    }
    return same;
}

static void flight_blocks_ties_and_parts_give_the_same_bits(void **state)
{
    (void)state;
    const stf_force *const idle[] = {NULL, &idle_field, &idle_link};

    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *alone = crowd(stf_integrators[k], NULL, 1);

        assert_ok(stf_world_step(alone, RUN_TICKS));
        for (size_t f = 0; f < COUNT_OF(idle); f++)
            for (unsigned tasks = 1; tasks <= 3; tasks += 2) {
                stf_world *world = crowd(stf_integrators[k], idle[f], tasks);
                for (unsigned n = 0; n < RUN_TICKS; n += 25)
                    assert_ok(stf_world_step(world, 25));
                assert_true(same_particles(world, alone));
                stf_world_destroy(world);
            }
        stf_world_destroy(alone);
    }
}

/* What the machine lacks is the next one below. */
static void every_instruction_set_gives_the_same_bits(void **state)
{
    (void)state;
    static const char *const isas[] = {"avx512", "avx2", "baseline"};
    const stf_force *const idle[] = {NULL, &idle_field};
    const char *given = getenv("STEADFAST_ISA");
    char *before = given ? strcpy(malloc(strlen(given) + 1), given) : NULL;

    for (int k = 0; stf_integrators[k]; k++)
        for (size_t f = 0; f < COUNT_OF(idle); f++) {
            saved first = {.bytes = NULL};
            for (size_t i = 0; i < COUNT_OF(isas); i++) {
                assert_int_equal(setenv("STEADFAST_ISA", isas[i], 1), 0);
                stf_world *world = crowd(stf_integrators[k], idle[f], 1);
                assert_ok(stf_world_step(world, RUN_TICKS));
                if (i == 0)
                    first = save_of(world);
                assert_true(saved_is(first, world));
                stf_world_destroy(world);
            }
            saved_free(&first);
        }
    assert_int_equal(before ? setenv("STEADFAST_ISA", before, 1) : unsetenv("STEADFAST_ISA"), 0);
    free(before);
}

/* ---- what is kept -------------------------------------------------------------------------------------------------------- */

static void a_loaded_and_a_restored_world_step_on_with_the_same_bits(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *world = crowd(stf_integrators[k], NULL, 1), *loaded = crowd(stf_integrators[k], NULL, 1);

        assert_ok(stf_world_step(world, 33));
        saved then = save_of(world);
        const size_t size = stf_world_snapshot_size(world);
        void *snapshot = malloc(size);
        assert_ok(stf_world_snapshot(world, snapshot, size));
        assert_ok(stf_world_step(world, RUN_TICKS));
        saved end = save_of(world);

        assert_ok(stf_world_load(loaded, then.bytes, then.size, NULL));
        assert_true(saved_is(then, loaded));
        assert_ok(stf_world_step(loaded, RUN_TICKS));
        assert_true(saved_is(end, loaded));
        assert_ok(stf_world_restore(world, snapshot, size));
        assert_true(saved_is(then, world));
        assert_ok(stf_world_step(world, RUN_TICKS));
        assert_true(saved_is(end, world));
        free(snapshot);
        saved_free(&then);
        saved_free(&end);
        stf_world_destroy(world);
        stf_world_destroy(loaded);
    }
}

static void a_world_that_does_not_compensate_refuses_what_one_that_does_saved(void **state)
{
    (void)state;
    stf_world *with = line_world(&stf_rk4, true, 1, 0, 1), *without = line_world(&stf_rk4, false, 1, 0, 1);
    stf_world *worlds[] = {with, without};

    for (size_t i = 0; i < COUNT_OF(worlds); i++) {
        saved s = save_of(worlds[i]);
        const size_t size = stf_world_snapshot_size(worlds[i]);
        void *snapshot = malloc(size);
        stf_mismatch mismatch;

        assert_ok(stf_world_snapshot(worlds[i], snapshot, size));
        assert_refused(stf_world_load(worlds[1 - i], s.bytes, s.size, &mismatch), STF_ERROR_MISMATCH);
        assert_string_equal(mismatch.what, "compensated");
        assert_refused(stf_world_restore(worlds[1 - i], snapshot, size), STF_ERROR_SNAPSHOT);
        free(snapshot);
        saved_free(&s);
    }
    stf_world_destroy(with);
    stf_world_destroy(without);
}

/* Reals of the one particle of a world of one dimension, from the end of what is saved. */
static stf_real kept_from_end(const stf_world *world, size_t k)
{
    saved s = save_of(world);
    const stf_real x = saved_from_end(s, k);

    saved_free(&s);
    return x;
}

static stf_real velocity_rest_of(const stf_world *world)
{
    return kept_from_end(world, (size_t)stf_world_integrator(world)->history_arrays);
}

static stf_real position_rest_of(const stf_world *world)
{
    return kept_from_end(world, (size_t)stf_world_integrator(world)->history_arrays + 1);
}

/* No particle feels another: each has to go as if it were alone, wherever it is kept. */
static void rests_go_with_their_particle(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *alone = line_world(stf_integrators[k], true, TICK, 1000.3, 0.7);
        stf_world *world = line_world(stf_integrators[k], true, TICK, 1, 2);
        const stf_particle second = particle_of(alone, 0);
        const stf_vector g = {(stf_real)-9.81, 0, 0};
        size_t moved;

        assert_ok(stf_world_set_gravity(alone, g));
        assert_ok(stf_world_set_gravity(world, g));
        assert_ok(stf_world_add(world, &second, NULL));
        assert_ok(stf_world_step(alone, 50));
        assert_ok(stf_world_step(world, 50));
        for (size_t n = 0; n < 2 * STF_BLOCK_MAX; n++) /* into other memory */
            assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
        while (stf_world_count(world) > 2)
            assert_ok(stf_world_remove(world, stf_world_count(world) - 1, NULL));
        assert_ok(stf_world_remove(world, 0, &moved));
        assert_int_equal(moved, 1);
        assert_true(position_rest_of(world) == position_rest_of(alone) && position_rest_of(alone) != 0);
        assert_true(velocity_rest_of(world) == velocity_rest_of(alone) && velocity_rest_of(alone) != 0);
        stf_world_destroy(world);
        stf_world_destroy(alone);
    }
}

static void a_particle_that_is_set_or_added_has_no_rests(void **state)
{
    (void)state;
    stf_world *world = line_world(&stf_rk4, true, TICK, 1000.3, 0.7);
    const stf_particle p = particle_of(world, 0);

    assert_ok(stf_world_set_gravity(world, (stf_vector){(stf_real)-9.81, 0, 0}));
    assert_ok(stf_world_step(world, 50));
    assert_true(position_rest_of(world) != 0 && velocity_rest_of(world) != 0);
    assert_ok(stf_world_set(world, 0, &p));
    assert_true(position_rest_of(world) == 0 && velocity_rest_of(world) == 0);

    assert_ok(stf_world_step(world, 50));
    assert_ok(stf_world_remove(world, 0, NULL));
    assert_ok(stf_world_add(world, &p, NULL));
    assert_true(position_rest_of(world) == 0 && velocity_rest_of(world) == 0);

    /* a block that is filled whole, in memory full of something else */
    counting c = {.blocks = 0};
    stf_world *lot = make_world((stf_world_def){.compensated = true, .allocator = counting_allocator(&c)});
    stf_particle *particles = calloc(STF_BLOCK_MAX, sizeof *particles);
    assert_ok(stf_world_add_many(lot, particles, STF_BLOCK_MAX, NULL));
    saved s = save_of(lot); /* refused, were a rest not finite */
    assert_ok(stf_world_step(lot, 1));
    for (size_t i = 0; i < STF_BLOCK_MAX; i++)
        assert_true(particle_of(lot, i).position.z == 0 && particle_of(lot, i).velocity.x == 0);
    saved_free(&s);
    free(particles);
    stf_world_destroy(lot);
    stf_world_destroy(world);
}

/* Position Verlet's rest of velocity is that of its difference, and no other's. */
static void another_integrator_or_step_does_not_take_the_rest_of_a_difference(void **state)
{
    (void)state;
    stf_world *world = line_world(&stf_position_verlet, true, TICK, 1000.3, 0.7);

    assert_ok(stf_world_set_gravity(world, (stf_vector){(stf_real)-9.81, 0, 0}));
    assert_ok(stf_world_step(world, 50));
    assert_true(velocity_rest_of(world) != 0);
    assert_ok(stf_world_set_integrator(world, &stf_position_verlet));
    assert_true(velocity_rest_of(world) != 0);
    assert_ok(stf_world_set_step(world, 2 * TICK));

    const stf_particle p = particle_of(world, 0);
    stf_world *fresh = line_world(&stf_position_verlet, true, 2 * TICK, (double)p.position.x, (double)p.velocity.x);
    assert_ok(stf_world_set_gravity(fresh, (stf_vector){(stf_real)-9.81, 0, 0}));
    assert_ok(stf_world_step(world, 1));
    assert_ok(stf_world_step(fresh, 1));
    assert_true(velocity_rest_of(world) == velocity_rest_of(fresh));
    stf_world_destroy(fresh);

    const stf_real kept = position_rest_of(world);
    assert_ok(stf_world_set_integrator(world, &stf_rk4));
    assert_true(velocity_rest_of(world) == 0 && position_rest_of(world) == kept && kept != 0);
    stf_world_destroy(world);
}

/* ---- who may ------------------------------------------------------------------------------------------------------------- */

#define TINY ((stf_real)(STF_AT_REST / 4))

/* Leaves rests of its own in every step. */
static void leave_rests(stf_system *system, stf_real dt)
{
    (void)dt;
    assert_true((system->position_rest != NULL) == (system->velocity_rest != NULL));
    for (size_t i = 0; system->position_rest && i < system->length; i++)
        system->position_rest[i] = system->velocity_rest[i] = TINY;
}

static const stf_integrator leaver = {.name = "leaver", .step = leave_rests, .flags = STF_COMPENSATES};
static const stf_integrator plain = {.name = "plain", .step = leave_rests};

static void an_integrator_that_does_not_compensate_is_refused_where_the_world_does(void **state)
{
    (void)state;
    stf_world *world = NULL;

    for (int k = 0; stf_integrators[k]; k++)
        assert_true((stf_integrators[k]->flags & STF_COMPENSATES) != 0);
    assert_refused(stf_world_create(&(stf_world_def){.integrator = &plain, .compensated = true}, &world), STF_ERROR_DESCRIPTOR);
    assert_null(world);
    assert_ok(stf_world_create(&(stf_world_def){.integrator = &plain}, &world));
    stf_world_destroy(world);

    world = line_world(&stf_rk4, true, TICK, 1000.3, 0.7);
    const uint64_t before = hash_of(world);
    assert_refused(stf_world_set_integrator(world, &plain), STF_ERROR_DESCRIPTOR);
    assert_true(hash_of(world) == before);
    assert_ok(stf_world_set_integrator(world, &leaver));
    stf_world_destroy(world);
}

static void a_rest_settles_with_what_it_is_of(void **state)
{
    (void)state;
    const stf_real values[] = {1, TINY};

    for (size_t x = 0; x < COUNT_OF(values); x++)
        for (size_t v = 0; v < COUNT_OF(values); v++) {
            stf_world *world = line_world(&leaver, true, TICK, (double)values[x], (double)values[v]);

            assert_ok(stf_world_step(world, STF_SETTLE_TICKS));
            assert_true(position_rest_of(world) == (x == 0 ? TINY : 0));
            assert_true(velocity_rest_of(world) == (v == 0 ? TINY : 0));
            stf_world_destroy(world);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_motion_is_off_by_as_much_after_a_million_ticks_as_after_one),
        cmocka_unit_test(a_fall_is_off_by_as_much_after_a_million_ticks_as_after_one),
        cmocka_unit_test(an_oscillator_is_as_far_off_with_small_steps_as_with_large_ones),
        cmocka_unit_test(what_freezes_far_from_the_origin_moves_at_its_speed),
        cmocka_unit_test(flight_blocks_ties_and_parts_give_the_same_bits),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits),
        cmocka_unit_test(a_loaded_and_a_restored_world_step_on_with_the_same_bits),
        cmocka_unit_test(a_world_that_does_not_compensate_refuses_what_one_that_does_saved),
        cmocka_unit_test(rests_go_with_their_particle),
        cmocka_unit_test(a_particle_that_is_set_or_added_has_no_rests),
        cmocka_unit_test(another_integrator_or_step_does_not_take_the_rest_of_a_difference),
        cmocka_unit_test(an_integrator_that_does_not_compensate_is_refused_where_the_world_does),
        cmocka_unit_test(a_rest_settles_with_what_it_is_of),
    };

    return cmocka_run_group_tests_name("compensated, " REAL_NAME, tests, NULL, NULL);
}
