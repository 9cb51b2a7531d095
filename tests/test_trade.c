/* The instrument measures what it says, knows what it does not know, and its picks hold. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "support/check.h"
#include "support/trade_scene.h"

#define INTEGRATORS 7
#define SAMPLES 64
#define STEPS_MAX 12
#define ROWS_MAX (INTEGRATORS * STEPS_MAX)

static bool in_double(void) { return sizeof(stf_real) == sizeof(double); }

static stf_trade_reference *make_reference(trade_scene *scene, bool exact)
{
    const stf_trade_reference_def def = {.build = trade_scene_build_f64,
                                         .exact = exact ? trade_scene_exact_fall : NULL,
                                         .user = scene,
                                         .duration = trade_scene_durations[*scene],
                                         .samples = SAMPLES,
                                         .accelerations = *scene == TRADE_CHAOS ? 50000 : 300000};
    stf_trade_reference *reference;

    assert_ok(stf_trade_reference_create(&def, &reference));
    return reference;
}

/* Rows of every integrator; timed only once, and briefly. */
static void measure(trade_scene *scene, const stf_trade_reference *reference, const unsigned *steps, size_t count,
                    stf_trade_row *rows)
{
    const stf_trade_def def = {.build = trade_scene_build,
                               .user = scene,
                               .reference = reference,
                               .integrators = stf_integrators,
                               .integrator_count = INTEGRATORS,
                               .steps = steps,
                               .steps_count = count,
                               .repeats = 1,
                               .repeat_seconds = 1e-6};
    assert_ok(stf_trade(&def, rows));
}

static stf_world *run_world(trade_scene *scene, const char *integrator, unsigned steps)
{
    stf_world *world;

    assert_ok(trade_scene_build(scene, &world));
    assert_ok(stf_world_set_integrator(world, stf_integrator_find(integrator)));
    assert_ok(stf_world_set_step(world, trade_scene_durations[*scene] / steps));
    return world;
}

/* ---- what a row says ------------------------------------------------------------------------------------------------- */

static void errors_are_distances_from_the_exact_solution_at_the_samples(void **state)
{
    (void)state;
    trade_scene scene = TRADE_FALL;
    const unsigned steps[] = {SAMPLES / 4, SAMPLES, 4 * SAMPLES};
    stf_trade_reference *reference = make_reference(&scene, true);
    stf_trade_row rows[ROWS_MAX];

    measure(&scene, reference, steps, COUNT_OF(steps), rows);
    for (size_t i = 0; i < INTEGRATORS * COUNT_OF(steps); i++) {
        const unsigned looks = rows[i].steps < SAMPLES ? rows[i].steps : SAMPLES;
        stf_world *world = run_world(&scene, rows[i].integrator, rows[i].steps);
        double largest = 0, end = 0, x[3], v[3];

        assert_string_equal(rows[i].integrator, stf_integrators[i / COUNT_OF(steps)]->name);
        assert_int_equal(rows[i].steps, steps[i % COUNT_OF(steps)]);
        assert_close(rows[i].step, 2.0 / rows[i].steps, 0);
        for (unsigned look = 1; look <= looks; look++) {
            assert_ok(stf_world_step(world, rows[i].steps / looks));
            trade_scene_exact_fall(NULL, 0, 2.0 * look / looks, x, v);
            end = fabs((double)particle_of(world, 0).position.y - x[1]); /* the immovable one does not count */
            largest = fmax(largest, end);
        }
        assert_close(rows[i].end_error, end, 1e-12 * end);
        assert_close(rows[i].largest_error, largest, 1e-12 * largest);
        assert_true(rows[i].finite && rows[i].bounded && rows[i].in_double == in_double());
        stf_world_destroy(world);
    }
    stf_trade_reference_destroy(reference);
}

static void accelerations_are_counted(void **state)
{
    (void)state;
    trade_scene scenes[] = {TRADE_PENDULUM, TRADE_CROWD, TRADE_BINARY}; /* a block; many; all in one, tied by a link force */

    for (size_t s = 0; s < COUNT_OF(scenes); s++) {
        trade_scene scene = scenes[s];
        const unsigned steps[] = {SAMPLES};
        stf_trade_reference *reference = make_reference(&scene, false);
        stf_trade_row rows[INTEGRATORS];

        measure(&scene, reference, steps, 1, rows);
        for (size_t i = 0; i < INTEGRATORS; i++) {
            const int once = stf_integrators[i] == &stf_velocity_verlet; /* its history's first */
            assert_close(rows[i].accelerations, stf_integrators[i]->evaluations * SAMPLES + once, 0);
        }
        stf_trade_reference_destroy(reference);
    }
}

/* The binary conserves both: drift is the largest distance from the start. Its reference is good to 1e-10 (asserted). */
static void energy_and_momentum_errors_are_drifts_where_they_are_conserved(void **state)
{
    (void)state;
    trade_scene scene = TRADE_BINARY;
    const unsigned steps[] = {4 * SAMPLES};
    stf_trade_reference *reference = make_reference(&scene, false);
    const stf_trade_accuracy accuracy = stf_trade_reference_accuracy(reference);
    stf_trade_row rows[INTEGRATORS];

    assert_below(accuracy.energy, 1e-10);
    assert_below(accuracy.momentum, 1e-10);
    measure(&scene, reference, steps, 1, rows);
    for (size_t i = 0; i < INTEGRATORS; i++) {
        stf_world *world = run_world(&scene, rows[i].integrator, rows[i].steps);
        stf_energy start, now;
        double largest = 0, start_momentum[3], momentum[3], largest_momentum = 0;

        assert_ok(stf_world_energy(world, &start));
        assert_ok(stf_world_momentum(world, start_momentum));
        for (unsigned k = 1; k <= SAMPLES; k++) {
            assert_ok(stf_world_step(world, 4));
            assert_ok(stf_world_energy(world, &now));
            assert_ok(stf_world_momentum(world, momentum));
            largest = fmax(largest, fabs(now.kinetic + now.potential - start.kinetic - start.potential));
            largest_momentum = fmax(largest_momentum, hypot(momentum[0] - start_momentum[0], momentum[1] - start_momentum[1]));
        }
        /* The start itself is rounded in float: numbers of up to 5, of which the masses take little. */
        assert_close(rows[i].energy_error, largest, 1e-10 + 8 * REAL_EPSILON);
        assert_close(rows[i].momentum_error, largest_momentum, 1e-10 + 8 * REAL_EPSILON);
        stf_world_destroy(world);
    }
    stf_trade_reference_destroy(reference);
}

/*
 * log2 of the gain from half the step is p + O(dt). Steps as in test_order.c: in float before round-off, in double where O(dt)
 * is small. The pendulum's spring has omega = 20 and forces that mix dimensions.
 */
static void orders_are_those_of_the_methods(void **state)
{
    (void)state;
    trade_scene scene = TRADE_PENDULUM;
    const unsigned coarse[] = {0, in_double() ? 65536 : 4096, in_double() ? 4096 : 512, 0, in_double() ? 512 : 64};
    const double tolerance[] = {0, in_double() ? 0.02 : 0.25, in_double() ? 0.02 : 0.25, 0, in_double() ? 0.1 : 0.45};
    stf_trade_reference *reference = make_reference(&scene, false);

    for (size_t i = 0; i < INTEGRATORS; i++) {
        const int p = stf_integrators[i]->order;
        const unsigned steps[] = {coarse[p], 2 * coarse[p]};
        stf_trade_row rows[2];

        assert_ok(stf_trade(&(stf_trade_def){.build = trade_scene_build,
                                             .user = &scene,
                                             .reference = reference,
                                             .integrators = &stf_integrators[i],
                                             .integrator_count = 1,
                                             .steps = steps,
                                             .steps_count = 2,
                                             .repeats = 1},
                            rows));
        assert_true(stf_trade_error_is_known(&rows[1]));
        assert_close(log2(rows[0].largest_error / rows[1].largest_error), p, tolerance[p]);
    }
    stf_trade_reference_destroy(reference);
}

/* omega dt = 20 x 2 / 8 = 5 is past every limit. */
static void a_run_that_explodes_is_neither_bounded_nor_picked(void **state)
{
    (void)state;
    trade_scene scene = TRADE_PENDULUM;
    const unsigned steps[] = {8};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row rows[INTEGRATORS];

    measure(&scene, reference, steps, 1, rows);
    for (size_t i = 0; i < INTEGRATORS; i++) {
        assert_false(rows[i].bounded);
        assert_above(stf_trade_error_bound(&rows[i]), DBL_MAX);
    }
    assert_null(stf_trade_cheapest(rows, INTEGRATORS, HUGE_VAL));
    stf_trade_reference_destroy(reference);
}

/* A force that turns infinite: from then on nothing is finite. */
static void explode(const void *records, size_t count, const stf_particles *particles, double time)
{
    (void)records, (void)count;
    for (size_t i = 0; i < particles->count && time > 0.5; i++)
        particles->force[i] += (stf_real)INFINITY;
}

static const stf_force bomb = {.name = "bomb", .kind = STF_FIELD, .apply = explode};

static stf_result build_bomb(void *user, stf_world **world)
{
    stf_result result = trade_scene_build(user, world);

    return result ? result : stf_world_add_force(*world, &bomb, NULL, 0, NULL);
}

static void a_run_that_is_not_finite_says_so(void **state)
{
    (void)state;
    trade_scene scene = TRADE_REST;
    const unsigned steps[] = {SAMPLES};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row row;

    assert_ok(stf_trade(&(stf_trade_def){.build = build_bomb,
                                         .user = &scene,
                                         .reference = reference,
                                         .integrators = stf_integrators,
                                         .integrator_count = 1,
                                         .steps = steps,
                                         .steps_count = 1,
                                         .repeats = 1},
                        &row));
    assert_false(row.finite || row.bounded || stf_trade_error_is_known(&row));
    assert_above(row.largest_error, DBL_MAX);
    assert_above(row.end_error, DBL_MAX);
    assert_above(row.energy_error, DBL_MAX);
    assert_null(stf_trade_cheapest(&row, 1, HUGE_VAL));
    stf_trade_reference_destroy(reference);
}

static void against_a_reference_that_is_not_finite_errors_are_infinite(void **state)
{
    (void)state;
    trade_scene lost = TRADE_LOST, rest = TRADE_REST;
    const unsigned steps[] = {SAMPLES};
    stf_trade_reference *reference = make_reference(&lost, false);
    stf_trade_row rows[INTEGRATORS];

    measure(&rest, reference, steps, 1, rows);
    for (size_t i = 0; i < INTEGRATORS; i++) {
        assert_true(rows[i].finite);
        assert_false(stf_trade_error_is_known(&rows[i]));
        assert_above(rows[i].end_error, DBL_MAX);
        assert_above(rows[i].largest_error, DBL_MAX);
    }
    stf_trade_reference_destroy(reference);
}

/* ---- the reference --------------------------------------------------------------------------------------------------- */

/* Against the exact solution: what a row's error changes by, if the reference is a run, is within what that says of itself. */
static void a_run_is_as_good_a_reference_as_it_says(void **state)
{
    (void)state;
    trade_scene scene = TRADE_FALL;
    const unsigned steps[] = {SAMPLES, 16 * SAMPLES};
    stf_trade_reference *run = make_reference(&scene, false), *exact = make_reference(&scene, true);
    const stf_trade_accuracy of_run = stf_trade_reference_accuracy(run), of_exact = stf_trade_reference_accuracy(exact);
    stf_trade_row by_run[ROWS_MAX], by_exact[ROWS_MAX];

    assert_true(of_exact.exact && !of_run.exact && of_exact.steps == 0 && of_run.steps >= 2 * SAMPLES);
    assert_below(of_run.error, 1e-11);
    double x[3], v[3];
    trade_scene_exact_fall(NULL, 0, 2, x, v);
    assert_close(of_exact.reach, hypot(1, x[1]) / 2, 1e-12);
    assert_close(of_run.reach, of_exact.reach, 1e-9);
    measure(&scene, run, steps, 2, by_run);
    measure(&scene, exact, steps, 2, by_exact);
    for (size_t i = 0; i < 2 * INTEGRATORS; i++) {
        assert_close(by_run[i].largest_error, by_exact[i].largest_error, of_run.error + of_exact.error);
        assert_close(by_run[i].energy_error, by_exact[i].energy_error, of_run.energy + of_exact.energy);
        assert_close(by_run[i].momentum_error, by_exact[i].momentum_error, of_run.momentum + of_exact.momentum);
    }
    stf_trade_reference_destroy(run);
    stf_trade_reference_destroy(exact);
}

/* A guard is no part of what is modelled: neither reference nor rows stop where it would. The fall is some 8 m deep. */
static void a_guard_of_the_scene_is_off(void **state)
{
    (void)state;
    trade_scene scene = TRADE_FALL;
    const unsigned steps[] = {SAMPLES};

    for (unsigned exact = 0; exact < 2; exact++) {
        stf_trade_row rows[2][INTEGRATORS];
        stf_trade_accuracy accuracies[2];

        for (unsigned guarded = 0; guarded < 2; guarded++) {
            trade_scene_guard = (stf_guard){.mode = guarded ? STF_GUARD_FREEZE : STF_GUARD_OFF, .position_bound = 1};
            stf_trade_reference *reference = make_reference(&scene, exact);
            measure(&scene, reference, steps, 1, rows[guarded]);
            accuracies[guarded] = stf_trade_reference_accuracy(reference);
            stf_trade_reference_destroy(reference);
        }
        trade_scene_guard = (stf_guard){.mode = STF_GUARD_OFF};
        assert_close(accuracies[1].reach, accuracies[0].reach, 0);
        assert_close(accuracies[1].error, accuracies[0].error, 0);
        for (size_t i = 0; i < INTEGRATORS; i++) {
            assert_close(rows[1][i].largest_error, rows[0][i].largest_error, 0);
            assert_close(rows[1][i].accelerations, rows[0][i].accelerations, 0);
        }
    }
}

static bool exact_for_the_first(void *user, size_t particle, double time, double position[3], double velocity[3])
{
    return particle == 0 && trade_scene_exact_fall(user, particle, time, position, velocity);
}

static void an_exact_solution_of_some_particles_is_none(void **state)
{
    (void)state;
    trade_scene scene = TRADE_FALL;
    stf_trade_reference *reference;

    assert_ok(stf_trade_reference_create(&(stf_trade_reference_def){.build = trade_scene_build_f64,
                                                                    .exact = exact_for_the_first,
                                                                    .user = &scene,
                                                                    .duration = 2,
                                                                    .samples = SAMPLES},
                                         &reference));
    assert_false(stf_trade_reference_accuracy(reference).exact);
    assert_below(stf_trade_reference_accuracy(reference).error, 1e-11);
    stf_trade_reference_destroy(reference);
}

/* One that is asked for less is within what it says of one that is asked for all. */
static void a_reference_stops_where_it_is_good_enough(void **state)
{
    (void)state;
    trade_scene scene = TRADE_PENDULUM;
    const unsigned steps[] = {16 * SAMPLES};
    stf_trade_reference *best = make_reference(&scene, false), *rough;
    const stf_trade_reference_def def = {
        .build = trade_scene_build_f64, .user = &scene, .duration = 2, .samples = SAMPLES, .error = 1e-4};
    stf_trade_row by_best[INTEGRATORS], by_rough[INTEGRATORS];

    assert_ok(stf_trade_reference_create(&def, &rough));
    const stf_trade_accuracy of_best = stf_trade_reference_accuracy(best), of_rough = stf_trade_reference_accuracy(rough);
    assert_true(of_rough.steps < of_best.steps);
    assert_true(of_rough.error <= 1e-4 && of_rough.error > of_best.error);
    measure(&scene, best, steps, 1, by_best);
    measure(&scene, rough, steps, 1, by_rough);
    for (size_t i = 0; i < INTEGRATORS; i++) {
        assert_close(by_best[i].largest_error, by_rough[i].largest_error, of_rough.error + of_best.error);
        assert_close(by_rough[i].reference_error, of_rough.error, 0);
    }
    stf_trade_reference_destroy(best);
    stf_trade_reference_destroy(rough);
}

/* Steps double until the next run would not be paid: 17 accelerations a step, 64 + 128 + 256 + 512 = 960 steps in all. */
static void a_reference_spends_no_more_than_it_may(void **state)
{
    (void)state;
    trade_scene scene = TRADE_CHAOS;
    stf_trade_reference_def def = {
        .build = trade_scene_build_f64, .user = &scene, .duration = 8, .samples = SAMPLES, .accelerations = 17 * 960};

    for (unsigned short_of = 0; short_of < 2; short_of++) {
        stf_trade_reference *reference;

        def.accelerations -= short_of;
        assert_ok(stf_trade_reference_create(&def, &reference));
        assert_int_equal(stf_trade_reference_accuracy(reference).steps, short_of ? 256 : 512);
        stf_trade_reference_destroy(reference);
    }
}

static void in_chaos_no_error_is_known(void **state)
{
    (void)state;
    trade_scene scene = TRADE_CHAOS;
    const unsigned steps[] = {16 * SAMPLES, 64 * SAMPLES};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row rows[2 * INTEGRATORS];

    measure(&scene, reference, steps, 2, rows);
    for (size_t i = 0; i < 2 * INTEGRATORS; i++)
        assert_false(stf_trade_error_is_known(&rows[i]));
    assert_null(stf_trade_cheapest(rows, 2 * INTEGRATORS, 1));
    stf_trade_reference_destroy(reference);
}

/* RK4 at 1/8192 of the fall is some 1e-14 off, and so is the exact solution in double: a bound is all that can be said. */
static void at_the_floor_of_double_an_error_is_a_bound(void **state)
{
    (void)state;
    trade_scene scene = TRADE_FALL;
    const unsigned steps[] = {128 * SAMPLES};
    stf_trade_reference *reference = make_reference(&scene, true);
    stf_trade_row rows[INTEGRATORS];

    measure(&scene, reference, steps, 1, rows);
    for (size_t i = 0; i < INTEGRATORS; i++) {
        const bool floor = in_double() && stf_integrators[i] == &stf_rk4;
        assert_int_equal(stf_trade_error_is_known(&rows[i]), !floor);
        if (floor)
            assert_close(stf_trade_error_bound(&rows[i]), STF_TRADE_MARGIN * rows[i].reference_error, 0);
    }
    stf_trade_reference_destroy(reference);
}

static void what_rests_is_bounded_wherever_it_is(void **state)
{
    (void)state;
    trade_scene scene = TRADE_REST;
    const unsigned steps[] = {1, SAMPLES};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row rows[2 * INTEGRATORS];

    measure(&scene, reference, steps, 2, rows);
    for (size_t i = 0; i < 2 * INTEGRATORS; i++) {
        assert_true(rows[i].bounded && rows[i].finite);
        assert_below(rows[i].largest_error, 8 * REAL_EPSILON);
    }
    stf_trade_reference_destroy(reference);
}

/* ---- picks ----------------------------------------------------------------------------------------------------------- */

/* x'' = -k (l - 1) x / l + g, and cos(3 t) along x, by RK4 of the test's own in double: s is x y vx vy. */
static void slope(double t, const double s[4], double f[4])
{
    const double l = hypot(s[0], s[1]), pull = -400 * (l - 1) / l;

    f[0] = s[2];
    f[1] = s[3];
    f[2] = pull * s[0] + cos(3 * t);
    f[3] = pull * s[1] - 9.81;
}

static void move_pendulum(double s[4], double t, double dt)
{
    double f[4][4], stage[4];

    slope(t, s, f[0]);
    for (int k = 1; k < 4; k++) {
        for (int i = 0; i < 4; i++)
            stage[i] = s[i] + (k < 3 ? dt / 2 : dt) * f[k - 1][i];
        slope(k < 3 ? t + dt / 2 : t + dt, stage, f[k]);
    }
    for (int i = 0; i < 4; i++)
        s[i] += dt * (f[0][i] + 2 * f[1][i] + 2 * f[2][i] + f[3][i]) / 6;
}

/* The largest distance of a fresh run, at every tick. RK4 at omega dt = 20 x 2 / 65536 is off by less than 1e-9. */
static double pendulum_error(trade_scene *scene, const stf_trade_row *pick)
{
    const unsigned fine = 65536 / pick->steps > 0 ? 65536 / pick->steps : 1;
    stf_world *world = run_world(scene, pick->integrator, pick->steps);
    double expected[4] = {1, 0, 0, 0}, largest = 0;

    for (unsigned tick = 0; tick < pick->steps; tick++) {
        for (unsigned k = 0; k < fine; k++)
            move_pendulum(expected, 2.0 / pick->steps * (tick + k / (double)fine), 2.0 / pick->steps / fine);
        assert_ok(stf_world_step(world, 1));
        const stf_particle p = particle_of(world, 0);
        largest = fmax(largest, hypot((double)p.position.x - expected[0], (double)p.position.y - expected[1]));
    }
    stf_world_destroy(world);
    return largest;
}

/* Also between samples, which see the stretch at omega = 20 some 10 times a period. */
static void picks_hold(void **state)
{
    (void)state;
    trade_scene scene = TRADE_PENDULUM;
    const unsigned steps[] = {32, 64, 128, 256, 512, 1024, 2048, 4096, 8192};
    const double tolerances[] = {0.3, 1e-1, 1e-2, 1e-3, 1e-4};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row rows[INTEGRATORS * COUNT_OF(steps)];

    measure(&scene, reference, steps, COUNT_OF(steps), rows);
    for (size_t i = 0; i < COUNT_OF(tolerances); i++) {
        const stf_trade_row *pick = stf_trade_cheapest(rows, COUNT_OF(rows), tolerances[i]);

        assert_non_null(pick);
        assert_below(pendulum_error(&scene, pick), tolerances[i]);
        const stf_trade_row *best = stf_trade_most_accurate(rows, COUNT_OF(rows), pick->nanoseconds);
        assert_non_null(best);
        assert_true(best->largest_error <= pick->largest_error && best->nanoseconds <= pick->nanoseconds);
    }
    stf_trade_reference_destroy(reference);
}

static stf_trade_row row_of(double error, double nanoseconds)
{
    return (stf_trade_row){.largest_error = error,
                           .nanoseconds = nanoseconds,
                           .finite = true,
                           .bounded = true,
                           .reference_error = 1e-5};
}

static void the_front_and_the_picks_are_those_of_the_rows(void **state)
{
    (void)state;
    stf_trade_row rows[] = {
        row_of(1, 10),    row_of(0.5, 20), row_of(0.5, 30),  /* dearer for the same */
        row_of(0.6, 25),                                     /* worse in both than the second */
        row_of(0.1, 40),  row_of(0.1, 40),                   /* twins: neither is better */
        row_of(1e-4, 80), row_of(1e-9, 90),                  /* below the floor, 1e-3, they are alike: the first is cheaper */
        row_of(1e-8, 1),                                     /* unbounded */
    };
    const bool on_front[] = {true, true, false, false, true, true, true, false, false};
    const size_t count = COUNT_OF(rows);

    rows[count - 1].bounded = false;
    stf_trade_front(rows, count);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(rows[i].on_front, on_front[i]);

    assert_ptr_equal(stf_trade_cheapest(rows, count, 2), &rows[0]);
    assert_ptr_equal(stf_trade_cheapest(rows, count, 0.525 + 1.1e-5), &rows[1]);
    assert_ptr_equal(stf_trade_cheapest(rows, count, 0.525), &rows[4]); /* the reference may be off by 1e-5 */
    assert_ptr_equal(stf_trade_cheapest(rows, count, 1e-3), &rows[6]);
    assert_null(stf_trade_cheapest(rows, count, 9e-4));
    assert_ptr_equal(stf_trade_most_accurate(rows, count, 39), &rows[1]);
    assert_ptr_equal(stf_trade_most_accurate(rows, count, 40), &rows[4]);
    assert_ptr_equal(stf_trade_most_accurate(rows, count, 1000), &rows[6]);
    assert_null(stf_trade_most_accurate(rows, count, 9));
    assert_null(stf_trade_cheapest(NULL, 0, 1));
    assert_false(stf_trade_error_is_known(&rows[6]));
    assert_true(stf_trade_error_is_known(&rows[4]));
}

/* ---- costs ----------------------------------------------------------------------------------------------------------- */

/* A clock that goes by what the world does: a microsecond an acceleration; and READING each time that it is read. */
#define READING 2e-7

static uint64_t work, readings;

static void do_work(const void *records, size_t count, const stf_particles *particles, double time)
{
    (void)records, (void)count, (void)particles, (void)time;
    work++;
}

static const stf_force worker = {.name = "worker", .kind = STF_FIELD, .apply = do_work};

static stf_result build_work(void *user, stf_world **world)
{
    stf_result result = trade_scene_build(user, world);

    return result ? result : stf_world_add_force(*world, &worker, NULL, 0, NULL);
}

#define INTERRUPTED 300 /* readings: once something else runs for a second */

static double worked_seconds(void *user)
{
    (void)user;
    readings++;
    return 1e-6 * (double)work + READING * (double)readings + (readings > INTERRUPTED);
}

static size_t progress_done, progress_total;

static void follow(void *user, size_t done, size_t total)
{
    (void)user;
    assert_int_equal(done, ++progress_done);
    progress_total = total;
}

/* Whole runs (64 steps), and the start of a run (4096 steps are more than the 256 microseconds of a repeat). */
static void costs_are_what_the_timer_says_less_its_own(void **state)
{
    (void)state;
    trade_scene scene = TRADE_BINARY; /* 3 particles, 8 s */
    const unsigned steps[] = {64, 4096};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row rows[2 * INTEGRATORS];

    progress_done = 0;
    assert_ok(stf_trade(&(stf_trade_def){.build = build_work,
                                         .user = &scene,
                                         .reference = reference,
                                         .integrators = stf_integrators,
                                         .integrator_count = INTEGRATORS,
                                         .steps = steps,
                                         .steps_count = 2,
                                         .repeats = 3,
                                         .repeat_seconds = 256e-6,
                                         .seconds = worked_seconds,
                                         .progress = follow},
                        rows));
    assert_int_equal(progress_done, 2 * INTEGRATORS * 4);
    assert_int_equal(progress_done, progress_total);
    for (size_t i = 0; i < 2 * INTEGRATORS; i++) {
        const double expected = 1000 * rows[i].accelerations / (3 * 8);

        /* The start of a run of velocity Verlet has one acceleration more than its share. */
        assert_close(rows[i].nanoseconds, expected, expected * (rows[i].steps == 64 ? 1e-9 : 1.0 / 64));
        assert_close(rows[i].nanoseconds_low, rows[i].nanoseconds, 1e-9 * expected);
        assert_close(rows[i].nanoseconds_high, rows[i].nanoseconds, 1e-9 * expected);
    }
    stf_trade_reference_destroy(reference);
}

/* A timer that goes in steps of 4 ms: most runs seem to take no time. */
static size_t builds;

static double coarse_seconds(void *user) { return 4e-3 * floor(worked_seconds(user) / 4e-3); }

static stf_result count_builds(void *user, stf_world **world)
{
    builds++;
    return build_work(user, world);
}

static void runs_too_short_for_the_timer_are_not_repeated_for_long(void **state)
{
    (void)state;
    trade_scene scene = TRADE_BINARY;
    const unsigned steps[] = {64};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row row;

    work = readings = builds = 0;
    assert_ok(stf_trade(&(stf_trade_def){.build = count_builds,
                                         .user = &scene,
                                         .reference = reference,
                                         .integrators = stf_integrators,
                                         .integrator_count = 1,
                                         .steps = steps,
                                         .steps_count = 1,
                                         .repeats = 1,
                                         .repeat_seconds = 1e-5,
                                         .seconds = coarse_seconds},
                        &row));
    assert_in_range(builds, 2, 1 + 4000 / 64 + 1); /* until the next step of the timer: a run takes 64 us */
    stf_trade_reference_destroy(reference);
}

/* Repeats that last 1, 2, 3, 4 and 10: the median is 3, the quartiles 2 and 4, in whatever order they come. */
static double pace;

static double paced_seconds(void *user)
{
    (void)user;
    return pace * 1e-6 * (double)work;
}

static void change_pace(void *user, size_t done, size_t total)
{
    const double paces[] = {4, 1, 10, 3, 2};
    (void)user, (void)total;

    pace = paces[done % COUNT_OF(paces)];
    work = 0;
}

static void costs_are_medians_with_quartiles(void **state)
{
    (void)state;
    trade_scene scene = TRADE_BINARY;
    const unsigned steps[] = {64};
    stf_trade_reference *reference = make_reference(&scene, false);
    stf_trade_row row;

    pace = 1;
    assert_ok(stf_trade(&(stf_trade_def){.build = build_work,
                                         .user = &scene,
                                         .reference = reference,
                                         .integrators = stf_integrators,
                                         .integrator_count = 1,
                                         .steps = steps,
                                         .steps_count = 1,
                                         .repeats = 5,
                                         .repeat_seconds = 1e-9,
                                         .seconds = paced_seconds,
                                         .progress = change_pace},
                        &row));
    const double unit = 1000 * 64 / (3.0 * 8);
    assert_close(row.nanoseconds, 3 * unit, 1e-9 * unit);
    assert_close(row.nanoseconds_low, 2 * unit, 1e-9 * unit);
    assert_close(row.nanoseconds_high, 4 * unit, 1e-9 * unit);
    stf_trade_reference_destroy(reference);
}

/* Two runs with one pace a repeat: each repeat of the first is followed by the same of the second. */
static size_t turns[8], turn;

static void note_turn(void *user, size_t done, size_t total)
{
    (void)done, (void)total;
    assert_true(turn < COUNT_OF(turns));
    turns[turn++] = *(const trade_scene *)user;
}

static void runs_are_timed_in_turn(void **state)
{
    (void)state;
    trade_scene scenes[] = {TRADE_BINARY, TRADE_FALL};
    unsigned steps[] = {SAMPLES};
    const stf_integrator *integrators[] = {&stf_rk4};
    const size_t expected[] = {TRADE_BINARY, TRADE_FALL, TRADE_BINARY, TRADE_BINARY, TRADE_FALL, TRADE_BINARY, TRADE_FALL};
    stf_trade_reference *references[2];
    stf_trade_run *runs[2];
    stf_trade_row rows[2];

    turn = 0;
    for (unsigned i = 0; i < 2; i++) {
        references[i] = make_reference(&scenes[i], false);
        assert_ok(stf_trade_begin(&(stf_trade_def){.build = build_work,
                                                   .user = &scenes[i],
                                                   .reference = references[i],
                                                   .integrators = integrators,
                                                   .integrator_count = 1,
                                                   .steps = steps,
                                                   .steps_count = 1,
                                                   .repeats = 3 - i, /* 3, and 2 */
                                                   .seconds = worked_seconds,
                                                   .progress = note_turn},
                                  &rows[i], &runs[i]));
    }
    steps[0] = 1; /* the lists are the run's own */
    integrators[0] = NULL;
    assert_ok(stf_trade_time(runs, 2));
    assert_int_equal(turn, COUNT_OF(expected));
    assert_memory_equal(turns, expected, sizeof expected);
    for (int i = 0; i < 2; i++) {
        assert_above(rows[i].nanoseconds, 0);
        stf_trade_end(runs[i]);
        stf_trade_reference_destroy(references[i]);
    }
    runs[1] = NULL;
    assert_refused(stf_trade_time(NULL, 1), STF_ERROR_NULL);
    assert_refused(stf_trade_time(&runs[1], 1), STF_ERROR_NULL);
    stf_trade_end(NULL);
}

/* ---- refusals -------------------------------------------------------------------------------------------------------- */

static void where_nothing_is_nothing_is_wrong(void **state)
{
    (void)state;
    trade_scene scene = TRADE_EMPTY;
    const unsigned steps[] = {SAMPLES};
    stf_trade_row rows[INTEGRATORS];

    for (int exact = 0; exact < 2; exact++) {
        stf_trade_reference *reference = make_reference(&scene, exact);
        const stf_trade_accuracy accuracy = stf_trade_reference_accuracy(reference);

        assert_true(accuracy.exact == (exact == 1) && accuracy.error == 0 && accuracy.reach == 0);
        measure(&scene, reference, steps, 1, rows);
        for (size_t i = 0; i < INTEGRATORS; i++)
            assert_true(rows[i].finite && rows[i].bounded && rows[i].largest_error == 0 && rows[i].momentum_error == 0);
        measure(&scene, reference, steps, 0, rows); /* and of no row nothing is written */
        stf_trade_reference_destroy(reference);
    }
}

static bool exactly_lost(void *user, size_t particle, double time, double position[3], double velocity[3])
{
    trade_scene_exact_fall(user, particle, time, position, velocity);
    position[0] = time > 1 ? (double)NAN : position[0];
    return true;
}

static void an_exact_solution_that_is_not_finite_is_refused(void **state)
{
    (void)state;
    trade_scene scene = TRADE_FALL;
    stf_trade_reference *reference = NULL;
    const stf_trade_reference_def def = {
        .build = trade_scene_build_f64, .exact = exactly_lost, .user = &scene, .duration = 2, .samples = SAMPLES};

    assert_refused(stf_trade_reference_create(&def, &reference), STF_ERROR_NOT_FINITE);
    assert_null(reference);
}

/* Where it is at each time: what `user` points at. */
typedef struct latest {
    trade_scene scene; /* first, so that the scene is found */
    double time;
} latest;

static bool exactly_at_rest(void *user, size_t particle, double time, double position[3], double velocity[3])
{
    latest *seen = user;
    (void)particle;

    seen->time = time > seen->time ? time : seen->time;
    for (int d = 0; d < 3; d++)
        position[d] = velocity[d] = 0;
    return true;
}

static void times_of_the_longest_duration_are_finite(void **state)
{
    (void)state;
    latest seen = {.scene = TRADE_FALL};
    stf_trade_reference *reference;

    assert_ok(stf_trade_reference_create(&(stf_trade_reference_def){.build = trade_scene_build_f64,
                                                                    .exact = exactly_at_rest,
                                                                    .user = &seen,
                                                                    .duration = DBL_MAX,
                                                                    .samples = 4},
                                         &reference));
    assert_true(seen.time == DBL_MAX);
    stf_trade_reference_destroy(reference);
}

static unsigned looks; /* at the timer */

/* By this one all that is measured takes longer than a look at it. */
static double seconds_that_grow(void *user)
{
    static double now;
    (void)user;
    return now += ++looks;
}

static void zeros_of_a_def_are_the_documented_numbers(void **state)
{
    (void)state;
    trade_scene scene = TRADE_FALL;
    const unsigned steps[] = {256};
    stf_trade_reference *reference;
    stf_trade_row row;

    assert_ok(stf_trade_reference_create(&(stf_trade_reference_def){.build = trade_scene_build_f64, .user = &scene,
                                                                    .exact = trade_scene_exact_fall, .duration = 2},
                                         &reference));
    stf_trade_def def = {.build = trade_scene_build, .user = &scene, .reference = reference, .integrators = stf_integrators,
                         .integrator_count = 1, .steps = steps, .steps_count = 1, .repeat_seconds = 1e-300,
                         .seconds = seconds_that_grow};
    looks = 0;
    assert_ok(stf_trade(&def, &row)); /* 256 steps are no STF_ERROR_STEP: so many samples there are */
    const unsigned by_default = looks;
    def.repeats = 25;
    looks = 0;
    assert_ok(stf_trade(&def, &row));
    assert_int_equal(looks, by_default);
    stf_trade_reference_destroy(reference);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_are_distances_from_the_exact_solution_at_the_samples),
        cmocka_unit_test(accelerations_are_counted),
        cmocka_unit_test(energy_and_momentum_errors_are_drifts_where_they_are_conserved),
        cmocka_unit_test(orders_are_those_of_the_methods),
        cmocka_unit_test(a_run_that_explodes_is_neither_bounded_nor_picked),
        cmocka_unit_test(a_run_that_is_not_finite_says_so),
        cmocka_unit_test(against_a_reference_that_is_not_finite_errors_are_infinite),
        cmocka_unit_test(a_run_is_as_good_a_reference_as_it_says),
        cmocka_unit_test(a_guard_of_the_scene_is_off),
        cmocka_unit_test(an_exact_solution_of_some_particles_is_none),
        cmocka_unit_test(a_reference_stops_where_it_is_good_enough),
        cmocka_unit_test(a_reference_spends_no_more_than_it_may),
        cmocka_unit_test(in_chaos_no_error_is_known),
        cmocka_unit_test(at_the_floor_of_double_an_error_is_a_bound),
        cmocka_unit_test(what_rests_is_bounded_wherever_it_is),
        cmocka_unit_test(picks_hold),
        cmocka_unit_test(the_front_and_the_picks_are_those_of_the_rows),
        cmocka_unit_test(costs_are_what_the_timer_says_less_its_own),
        cmocka_unit_test(runs_too_short_for_the_timer_are_not_repeated_for_long),
        cmocka_unit_test(costs_are_medians_with_quartiles),
        cmocka_unit_test(runs_are_timed_in_turn),
        cmocka_unit_test(where_nothing_is_nothing_is_wrong),
        cmocka_unit_test(an_exact_solution_that_is_not_finite_is_refused),
        cmocka_unit_test(times_of_the_longest_duration_are_finite),
        cmocka_unit_test(zeros_of_a_def_are_the_documented_numbers),
    };

    return cmocka_run_group_tests_name("trade, " REAL_NAME, tests, NULL, NULL);
}
