/* The global order of every integrator on every problem is its descriptor's, also across what makes a history stale. */
#include <math.h>

#include "support/check.h"
#include "support/problem.h"

/*
 * Observed order = log2(error(h) / error(h / 2)) = p + O(h). The steps are where that O(h), the next term of the error's
 * expansion, is below the tolerance in double (it was seen to halve with h), and where in float round-off is still far
 * below the error: for order 4 that leaves only coarse steps and a wide tolerance, still too narrow for order 3 or 5.
 */
typedef struct level {
    unsigned steps; /* of the coarser run */
    double tolerance;
} level;

static level level_of(int order)
{
#ifdef STF_DOUBLE
    const level levels[] = {{0, 0}, {8192, 0.02}, {1024, 0.02}, {0, 0}, {128, 0.08}};
#else
    const level levels[] = {{0, 0}, {512, 0.06}, {64, 0.1}, {0, 0}, {8, 0.45}};
#endif
    return levels[order];
}

static void check_order(const char *what, const stf_integrator *integrator, double coarse, double fine)
{
    const double order = log2(coarse / fine);

    if (is_close(order, integrator->order, level_of(integrator->order).tolerance))
        return;
    print_error("%s with %s: observed order %.3f (errors %.3g, %.3g)\n", what, integrator->name, order, coarse, fine);
    fail();
}

static void order_is_the_descriptors_on_every_problem(void **state)
{
    (void)state;
    for (int p = 0; problems[p]; p++)
        for (int i = 0; stf_integrators[i]; i++) {
            const unsigned steps = level_of(stf_integrators[i]->order).steps;
            check_order(problems[p]->name, stf_integrators[i],
                        problem_error_after(problems[p], stf_integrators[i], steps),
                        problem_error_after(problems[p], stf_integrators[i], 2 * steps));
        }
}

/* Substeps are steps: n ticks of 4 substeps end on the same bits as 4 n ticks of a quarter of the step. */
static void substeps_are_steps(void **state)
{
    (void)state;
    for (int p = 0; problems[p]; p++)
        for (int i = 0; stf_integrators[i]; i++) {
            stf_world *coarse = problem_world(problems[p], stf_integrators[i], 1.0 / 16);
            stf_world *fine = problem_world(problems[p], stf_integrators[i], 1.0 / 64);

            assert_ok(stf_world_set_substeps(coarse, 4));
            assert_ok(stf_world_step(coarse, 16));
            assert_ok(stf_world_step(fine, 64));
            assert_close(problem_error(problems[p], coarse), problem_error(problems[p], fine), 0);
            stf_world_destroy(coarse);
            stf_world_destroy(fine);
        }
}

/*
 * The README's floor: from steps of 4 / 2048 (order 2) and 4 / 128 (RK4) on, steps 16 times as small have an error that the order
 * would make 256 or 65,536 times as small. In double it does, to a factor of 2; in float round-off leaves it within a factor of 4.
 */
static void only_double_gains_from_steps_below_the_floor_of_float(void **state)
{
    (void)state;
    for (int i = 0; stf_integrators[i]; i++) {
        const int order = stf_integrators[i]->order;
        const unsigned steps = order == 4 ? 128 : 2048;

        if (order < 2)
            continue;
        const double gain = problem_error_after(&problem_oscillator, stf_integrators[i], steps) /
                            problem_error_after(&problem_oscillator, stf_integrators[i], 16 * steps);
        if (REAL_EPSILON < 1e-10)
            assert_above(gain, pow(16, order) / 2);
        else
            assert_below(gain, 4);
    }
}

/* Things that happen half way through a run. Each leaves the exact solution of particle 0 what it was. */
typedef void event(stf_world *world);

static void add_another(stf_world *world)
{
    const stf_particle far_away = {.position = {100, 0, 0}, .velocity = {1, 0, 0}, .inverse_mass = 1};
    assert_ok(stf_world_add(world, &far_away, NULL));
}

static void add_and_remove_another(stf_world *world)
{
    add_another(world);
    assert_ok(stf_world_step(world, 1));
    assert_ok(stf_world_remove(world, 1, NULL));
}

static void change_step(stf_world *world)
{
    const double step = stf_world_step_size(world);

    assert_ok(stf_world_set_step(world, step / 2));
    assert_ok(stf_world_step(world, 2));
    assert_ok(stf_world_set_step(world, step));
}

static void change_substeps(stf_world *world)
{
    assert_ok(stf_world_set_substeps(world, 3));
    assert_ok(stf_world_step(world, 1));
    assert_ok(stf_world_set_substeps(world, 1));
}

/* To the exact state: a particle that is told where to be. */
static void teleport(stf_world *world)
{
    double exact[4] = {0};
    stf_particle particle = particle_of(world, 0);

    problem_nonlinear_drag.exact(stf_world_time(world), exact);
    particle.position.x = (stf_real)exact[0];
    particle.velocity.x = (stf_real)exact[2];
    assert_ok(stf_world_set(world, 0, &particle));
}

/* Drag that is taken away and put back: a force that was left in the history would act for a step. */
static void swap_forces(stf_world *world)
{
    assert_ok(stf_world_remove_force(world, stf_world_force_at(world, 0)));
    problem_nonlinear_drag.add_forces(world);
}

static void swap_integrator(stf_world *world)
{
    const stf_integrator *integrator = stf_world_integrator(world);

    assert_ok(stf_world_set_integrator(world, &stf_rk4));
    assert_ok(stf_world_step(world, 1));
    assert_ok(stf_world_set_integrator(world, integrator));
}

static double error_with_event(const stf_integrator *integrator, unsigned steps, event *happen)
{
    const double step = problem_nonlinear_drag.duration / steps;
    stf_world *world = problem_world(&problem_nonlinear_drag, integrator, step);

    assert_ok(stf_world_step(world, steps / 2));
    happen(world);
    assert_ok(stf_world_step(world, (unsigned)((problem_nonlinear_drag.duration - stf_world_time(world)) / step)));
    assert_close(stf_world_time(world), problem_nonlinear_drag.duration, 0); /* all of it in powers of two */
    const double error = problem_error(&problem_nonlinear_drag, world);
    stf_world_destroy(world);
    return error;
}

static void order_survives_what_makes_history_stale(void **state)
{
    (void)state;
    event *const events[] = {add_another, add_and_remove_another, change_step, change_substeps, teleport, swap_forces,
                             swap_integrator};
    const char *const names[] = {"particle added", "particle removed", "step changed", "substeps changed", "teleport",
                                 "forces swapped", "integrator swapped"};

    for (size_t e = 0; e < COUNT_OF(events); e++)
        for (int i = 0; stf_integrators[i]; i++) {
            const stf_integrator *integrator = stf_integrators[i];
            if (integrator->history_arrays == 0)
                continue;
            const unsigned steps = level_of(integrator->order).steps;
            check_order(names[e], integrator, error_with_event(integrator, steps, events[e]),
                        error_with_event(integrator, 2 * steps, events[e]));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(order_is_the_descriptors_on_every_problem),
        cmocka_unit_test(substeps_are_steps),
        cmocka_unit_test(only_double_gains_from_steps_below_the_floor_of_float),
        cmocka_unit_test(order_survives_what_makes_history_stale),
    };

    return cmocka_run_group_tests_name("order, " REAL_NAME, tests, NULL, NULL);
}
