/* Long runs of a Kepler orbit: which integrator keeps energy, which runs back, and the README's table of figures. */
#include <math.h>

#include "support/check.h"
#include "support/problem.h"

#define ORBITS 100
#define EVALUATIONS_AN_ORBIT 400 /* the same cost for all */

typedef struct figures {
    double error_after_one_orbit; /* in position and velocity; the semi-major axis is 1, the mean speed about 1 */
    double energy_error_first_half, energy_error; /* largest |E / E0 - 1| in 50 and in 100 orbits */
} figures;

static double energy_of(const stf_world *world)
{
    stf_energy energy;

    assert_ok(stf_world_energy(world, &energy));
    return energy.kinetic + energy.potential;
}

static stf_world *orbit_world(const stf_integrator *integrator, unsigned *steps_an_orbit)
{
    *steps_an_orbit = EVALUATIONS_AN_ORBIT / (unsigned)integrator->evaluations;
    return problem_world(&problem_kepler, integrator, 2 * acos(-1.0) / *steps_an_orbit);
}

static figures measure(const stf_integrator *integrator)
{
    unsigned steps;
    stf_world *world = orbit_world(integrator, &steps);
    const double start = energy_of(world);
    figures measured = {0};

    for (unsigned n = 1; n <= ORBITS * steps; n++) {
        assert_ok(stf_world_step(world, 1));
        measured.energy_error = fmax(measured.energy_error, fabs(energy_of(world) / start - 1));
        if (n == steps)
            measured.error_after_one_orbit = problem_error(&problem_kepler, world);
        if (n == ORBITS / 2 * steps)
            measured.energy_error_first_half = measured.energy_error;
    }
    stf_world_destroy(world);
    return measured;
}

/* The table of the README, at 400 evaluations an orbit, rounded to two digits. */
static const struct {
    const stf_integrator *integrator;
    double error_after_one_orbit, energy_error;
} readme[] = {
    {&stf_explicit_euler, 3.0, 0.94},       {&stf_semi_implicit_euler, 0.069, 0.024}, {&stf_midpoint, 0.096, 0.084},
    {&stf_improved_euler, 0.33, 0.16},      {&stf_rk4, 0.0014, 0.0030},               {&stf_position_verlet, 0.029, 0.0059},
    {&stf_velocity_verlet, 0.028, 0.00067},
};

#define FIGURE_TOLERANCE 0.05 /* half a unit of the second digit */

static void figures_of_the_readme_hold(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT_OF(readme); i++) {
        const figures measured = measure(readme[i].integrator);
        assert_close(measured.error_after_one_orbit / readme[i].error_after_one_orbit, 1, FIGURE_TOLERANCE);
        assert_close(measured.energy_error / readme[i].energy_error, 1, FIGURE_TOLERANCE);
    }
}

/* A symplectic method's energy error is bounded and the second 50 orbits add nothing; every other's grows on. */
static void energy_error_is_bounded_exactly_for_symplectic_methods(void **state)
{
    (void)state;
    for (int i = 0; stf_integrators[i]; i++) {
        const figures measured = measure(stf_integrators[i]);
        const double growth = measured.energy_error / measured.energy_error_first_half;

        if (stf_integrators[i]->flags & STF_SYMPLECTIC)
            assert_below(growth, 1.01); /* round-off of float: 40,000 steps, as a random walk, of some 1e-7 */
        else if (measured.energy_error_first_half < 0.5) /* else it has left the orbit already */
            assert_above(growth, 1.5);
    }
}

static void energy_behaviour_ranks_as_theory_says(void **state)
{
    (void)state;
    const figures explicit_euler = measure(&stf_explicit_euler), semi_implicit = measure(&stf_semi_implicit_euler);
    const figures midpoint = measure(&stf_midpoint), improved_euler = measure(&stf_improved_euler), rk4 = measure(&stf_rk4);
    const figures position_verlet = measure(&stf_position_verlet), velocity_verlet = measure(&stf_velocity_verlet);

    /* In the long run a symplectic method beats every other of the same cost, even one of higher order. */
    assert_below(velocity_verlet.energy_error, rk4.energy_error);
    assert_below(semi_implicit.energy_error, midpoint.energy_error);
    assert_below(midpoint.energy_error, explicit_euler.energy_error);
    assert_below(improved_euler.energy_error, explicit_euler.energy_error);
    assert_below(velocity_verlet.energy_error, position_verlet.energy_error);
    assert_below(position_verlet.energy_error, semi_implicit.energy_error);
    /* In the short run order wins. */
    assert_below(rk4.error_after_one_orbit, velocity_verlet.error_after_one_orbit / 10);
    assert_below(velocity_verlet.error_after_one_orbit, semi_implicit.error_after_one_orbit / 2);
    assert_below(semi_implicit.error_after_one_orbit, explicit_euler.error_after_one_orbit / 10);
}

/* The distance from where it started, after a run there and, with its velocity turned round, back. */
static double error_there_and_back(const stf_integrator *integrator)
{
    unsigned steps;
    stf_world *world = orbit_world(integrator, &steps);
    const stf_particle start = particle_of(world, 0);

    assert_ok(stf_world_step(world, steps / 3));
    stf_particle turned = particle_of(world, 0);
    turned.velocity.x = -turned.velocity.x;
    turned.velocity.y = -turned.velocity.y;
    assert_ok(stf_world_set(world, 0, &turned));
    assert_ok(stf_world_step(world, steps / 3));
    const stf_particle end = particle_of(world, 0);
    stf_world_destroy(world);
    return hypot((double)(end.position.x - start.position.x), (double)(end.position.y - start.position.y));
}

/* Round-off: four roundings a step that add up as a random walk over 266 steps, and grow tenfold by the pericentre's shear. */
static void reversible_methods_run_back_and_others_do_not(void **state)
{
    (void)state;
    const double round_off = 10 * 4 * sqrt(2 * EVALUATIONS_AN_ORBIT / 3.0) * REAL_EPSILON;

    for (int i = 0; stf_integrators[i]; i++) {
        const double error = error_there_and_back(stf_integrators[i]);
        if (stf_integrators[i]->flags & STF_REVERSIBLE)
            assert_below(error, round_off);
        else if (stf_integrators[i]->order < 4 || round_off < 1e-6) /* RK4's own error, 1.6e-6, drowns in float's round-off */
            assert_above(error, 2 * round_off);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_of_the_readme_hold),
        cmocka_unit_test(energy_error_is_bounded_exactly_for_symplectic_methods),
        cmocka_unit_test(energy_behaviour_ranks_as_theory_says),
        cmocka_unit_test(reversible_methods_run_back_and_others_do_not),
    };

    return cmocka_run_group_tests_name("energy, " REAL_NAME, tests, NULL, NULL);
}
