/*
 * Drag and springs, where theory gives every number: what one step multiplies, the limits of the descriptors, and energy.
 * Source of the amplification factors: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.2.
 */
#include <math.h>

#include "scenes/scene.h"
#include "support/check.h"
#include "support/theory.h"

/*
 * v(n) over v(0) under v' = -k v, z = k dt. Both Verlet methods, whose acceleration is one prediction old, obey
 * v(n+2) = (1 - 3 z / 2) v(n+1) + (z / 2) v(n), as Adams-Bashforth 2 does; they differ in v(1).
 */
static double drag_solution(const stf_integrator *integrator, double z, unsigned n)
{
    if (integrator == &stf_position_verlet || integrator == &stf_velocity_verlet) {
        const double sum = 1 - 1.5 * z, root = sqrt(sum * sum + 2 * z), p = (sum + root) / 2, q = (sum - root) / 2;
        const double first = integrator == &stf_position_verlet ? 1 - z : 1 - z + z * z / 2;
        const double of_p = (first - q) / (p - q);
        return of_p * pow(p, n) + (1 - of_p) * pow(q, n);
    }
    return pow(theory_drag_factor(integrator->name, z), n);
}

static void drag_of_the_lecture_is_powers_of_the_amplification_factor(void **state)
{
    (void)state;
    const double steps[] = {0.2, 0.8, 1.6, 2.4}, k = 0.8;
    const unsigned count = 12;

    for (int i = 0; stf_integrators[i]; i++)
        for (size_t s = 0; s < COUNT_OF(steps); s++) {
            const stf_world_def def = {.integrator = stf_integrators[i], .step = steps[s]};
            const double z = k * steps[s], growth = theory_drag_growth(stf_integrators[i]->name, z);
            stf_world *world;
            double roundings = 0, largest = 1;

            assert_ok(scene_create(&scene_drag, &def, &world));
            for (unsigned n = 1; n <= count; n++) {
                /* Each step adds some ten roundings of numbers as large as the largest so far, which then grow. */
                assert_ok(stf_world_step(world, 1));
                roundings = fmax(1, growth) * roundings + 10 * (1 + z) * largest * REAL_EPSILON;
                const double expected = drag_solution(stf_integrators[i], z, n);
                assert_close(particle_of(world, 0).velocity.x, expected, roundings);
                largest = fmax(largest, fabs(expected));
            }
            stf_world_destroy(world);
        }
}

/* At the lecture's dt = 2.4 explicit Euler changes sign and decays, and midpoint does not change sign. */
static void explicit_euler_decays_at_the_ugly_step_and_changes_sign(void **state)
{
    (void)state;
    const stf_integrator *const both[] = {&stf_explicit_euler, &stf_midpoint};

    for (size_t i = 0; i < COUNT_OF(both); i++) {
        const stf_world_def def = {.integrator = both[i], .step = 2.4};
        stf_world *world;
        double before = 1;

        assert_ok(scene_create(&scene_drag, &def, &world));
        for (int n = 0; n < 10; n++) {
            assert_ok(stf_world_step(world, 1));
            const double now = (double)particle_of(world, 0).velocity.x;
            assert_below(fabs(now), fabs(before));
            assert_int_equal(now < 0, i == 0 ? before > 0 : 0);
            before = now;
        }
        stf_world_destroy(world);
    }
}

static stf_world *drag_world(const stf_integrator *integrator, double z)
{
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .integrator = integrator, .step = 1});

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){.coefficient = (stf_real)z});
    return world;
}

static stf_world *spring_world(const stf_integrator *integrator, double z)
{
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .integrator = integrator, .step = 1});

    assert_ok(stf_world_add(world, &(stf_particle){.position = {1, 0, 0}, .inverse_mass = 1}, NULL));
    add_force(world, &stf_force_anchored_springs, &(stf_anchored_spring){.stiffness = (stf_real)(z * z)});
    return world;
}

/* The largest |x| and |v| / z (amplitudes both) of a spring, or |v| under drag, in the last tenth of a run of 10,000 steps. */
static double amplitude_late(stf_world *world, double z)
{
    double largest = 0;

    assert_ok(stf_world_step(world, 9000));
    for (int n = 0; n < 1000; n++) {
        assert_ok(stf_world_step(world, 1));
        const stf_particle particle = particle_of(world, 0);
        const double x = z > 0 ? fabs((double)particle.position.x) : 0, v = fabs((double)particle.velocity.x);
        const double amplitude = z > 0 ? fmax(x, v / z) : v;
        largest = largest >= amplitude ? largest : amplitude; /* a NaN stays */
    }
    stf_world_destroy(world);
    return largest;
}

/* Grown: beyond any bound, to infinity or to NaN. */
static bool grew(double amplitude) { return !(amplitude < 1e4); }

#define JUST 0.01

static void drag_is_bounded_below_the_real_limit_and_grows_above(void **state)
{
    (void)state;
    for (int i = 0; stf_integrators[i]; i++) {
        const double limit = stf_integrators[i]->real_stability;

        assert_below(amplitude_late(drag_world(stf_integrators[i], limit * (1 - JUST)), 0), 1);
        assert_true(grew(amplitude_late(drag_world(stf_integrators[i], limit * (1 + JUST)), 0)));
    }
}

/* Below their limit the symplectic methods swing by up to 1 / sqrt(1 - (z / 2)^2) = 7.1 times too far at 1 % below it. */
static void spring_is_bounded_below_the_imaginary_limit_and_grows_above(void **state)
{
    (void)state;
    for (int i = 0; stf_integrators[i]; i++) {
        const double limit = stf_integrators[i]->imaginary_stability, z = limit * (1 - JUST);

        if (limit > 0)
            assert_below(amplitude_late(spring_world(stf_integrators[i], z), z), 1.01 / sqrt(1 - z * z / 4 * (z < 2)));
        /* Where there is no limit above 0: |R(i z)|^2 is at least 1 + z^4 / 4, so that z = 0.3 doubles in 690 steps. */
        const double above = limit > 0 ? limit * (1 + JUST) : 0.3;
        assert_true(grew(amplitude_late(spring_world(stf_integrators[i], above), above)));
    }
}

static stf_world *damped_world(const stf_integrator *integrator, double omega_dt, double k_dt)
{
    stf_world *world = spring_world(integrator, omega_dt);

    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){.coefficient = (stf_real)k_dt});
    return world;
}

/*
 * A spring with drag, z = omega dt and q = k dt: the root that leaves the unit circle does so at -1. There x(n) = (-1)^n,
 * so that the Verlet methods want z^2 + 4 q <= 4 and semi-implicit Euler z^2 + 2 q <= 4; the README gives both.
 */
static void spring_and_drag_together_lower_the_limit(void **state)
{
    (void)state;
    const stf_integrator *const methods[] = {&stf_position_verlet, &stf_velocity_verlet, &stf_semi_implicit_euler};
    const double drags[] = {0.0625, 0.25, 0.5, 0.75};

    for (size_t m = 0; m < COUNT_OF(methods); m++)
        for (size_t d = 0; d < COUNT_OF(drags); d++) {
            const double limit = sqrt(4 - (methods[m] == &stf_semi_implicit_euler ? 2 : 4) * drags[d]);
            const double below = limit * (1 - JUST), above = limit * (1 + JUST);

            assert_below(amplitude_late(damped_world(methods[m], below, drags[d]), below), 1);
            assert_true(grew(amplitude_late(damped_world(methods[m], above, drags[d]), above)));
        }
}

/* What a game may do at every tick, to the world around particle 0. */
typedef void event(stf_world *world, unsigned tick);

static void set_another(stf_world *world, unsigned tick)
{
    (void)tick;
    if (stf_world_count(world) == 1)
        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_set(world, 1, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}));
}

static void emit_another(stf_world *world, unsigned tick)
{
    (void)tick;
    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
}

static void emit_and_remove_another(stf_world *world, unsigned tick)
{
    emit_another(world, tick);
    if (tick % 3 == 2)
        assert_ok(stf_world_remove(world, 1, NULL));
}

static void set_equal_gravity(stf_world *world, unsigned tick)
{
    (void)tick;
    assert_ok(stf_world_set_gravity(world, stf_world_gravity(world)));
}

static void tilt_gravity(stf_world *world, unsigned tick)
{
    assert_ok(stf_world_set_gravity(world, (stf_vector){(stf_real)(1e-9 * (double)(tick % 2)), 0, 0}));
}

static void set_equal_records(stf_world *world, unsigned tick)
{
    size_t count;
    const void *records = stf_world_force_records(world, 1, &count);

    (void)tick;
    assert_ok(stf_world_set_force(world, 1, records, count));
}

/*
 * A restart of position Verlet multiplies a spring's energy by some 1 + z^2 / 2; done at every tick, by e^5 in 1,000 at z =
 * 0.1.
 */
static void springs_stay_bounded_whatever_happens_around_them_at_every_tick(void **state)
{
    (void)state;
    event *const events[] = {set_another, emit_another, emit_and_remove_another, set_equal_gravity, tilt_gravity,
                             set_equal_records};
    const double z = 0.1;

    for (int i = 0; stf_integrators[i]; i++) {
        if (!(stf_integrators[i]->flags & STF_SYMPLECTIC))
            continue;
        for (size_t e = 0; e < COUNT_OF(events); e++) {
            stf_world *world = spring_world(stf_integrators[i], z);
            for (unsigned tick = 0; tick < 1000; tick++) {
                const stf_particle particle = particle_of(world, 0);
                const double x = (double)particle.position.x, u = (double)particle.velocity.x / z;
                /* The energy of semi-implicit Euler swings by z / 2, of the Verlet methods by up to z^2. */
                assert_close(x * x + u * u, 1, 1.1 * z / 2);
                events[e](world, tick);
                assert_ok(stf_world_step(world, 1));
            }
            stf_world_destroy(world);
        }
    }
}

static double energy_of(const stf_world *world)
{
    stf_energy energy;

    assert_ok(stf_world_energy(world, &energy));
    return energy.kinetic + energy.potential;
}

static void runge_kutta_methods_gain_or_lose_the_energy_that_theory_says(void **state)
{
    (void)state;
    const stf_integrator *const methods[] = {&stf_explicit_euler, &stf_midpoint, &stf_improved_euler, &stf_rk4};
    const double z = 0.25;
    const unsigned steps = 400;

    for (size_t i = 0; i < COUNT_OF(methods); i++) {
        stf_world *world = spring_world(methods[i], z);
        const double start = energy_of(world);

        assert_ok(stf_world_step(world, steps));
        const double expected = pow(theory_spring_growth(methods[i]->name, z), 2 * steps);
        /* A few roundings a step of each of x and v, which add up at worst, and count twice in the energy. */
        assert_close(energy_of(world) / start / expected, 1, steps * 2 * 2 * REAL_EPSILON);
        stf_world_destroy(world);
    }
}

/*
 * Both symplectic methods keep an ellipse exactly: semi-implicit Euler x^2 + v^2/w^2 - (z) x v/w, velocity Verlet (1 - z^2
 * / 4) x^2 + v^2 / w^2. Energy swings around it, by z / 2 and z^2 / 4, and never leaves. Source: Hairer, Lubich, Wanner
 * (2006), ex. I.1 and sec. I.5.
 */
static void symplectic_methods_keep_their_own_invariant(void **state)
{
    (void)state;
    const double z = 0.25;
    const unsigned steps = 100000;

    for (int verlet = 0; verlet < 2; verlet++) {
        stf_world *world = spring_world(verlet ? &stf_velocity_verlet : &stf_semi_implicit_euler, z);
        double invariant_start = 0;

        for (unsigned n = 0; n <= steps; n += steps / 100) {
            const stf_particle particle = particle_of(world, 0);
            const double x = (double)particle.position.x, u = (double)particle.velocity.x / z;
            const double invariant = verlet ? (1 - z * z / 4) * x * x + u * u : x * x + u * u - z * x * u;

            if (n == 0)
                invariant_start = invariant;
            /* Round-off is a random walk of some roundings a step: sqrt(steps) of them, with six standard deviations. */
            assert_close(invariant, invariant_start, 6 * sqrt(steps) * 4 * REAL_EPSILON);
            assert_ok(stf_world_step(world, steps / 100));
        }
        stf_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(drag_of_the_lecture_is_powers_of_the_amplification_factor),
        cmocka_unit_test(explicit_euler_decays_at_the_ugly_step_and_changes_sign),
        cmocka_unit_test(drag_is_bounded_below_the_real_limit_and_grows_above),
        cmocka_unit_test(spring_is_bounded_below_the_imaginary_limit_and_grows_above),
        cmocka_unit_test(spring_and_drag_together_lower_the_limit),
        cmocka_unit_test(springs_stay_bounded_whatever_happens_around_them_at_every_tick),
        cmocka_unit_test(runge_kutta_methods_gain_or_lose_the_energy_that_theory_says),
        cmocka_unit_test(symplectic_methods_keep_their_own_invariant),
    };

    return cmocka_run_group_tests_name("linear problems, " REAL_NAME, tests, NULL, NULL);
}
