/*
 * The scalar test problem of mechanics, x'' = -omega^2 x - k x'. Theory: for a Runge-Kutta method |R(lambda dt)| of both roots
 * of lambda^2 + k lambda + omega^2 = 0 (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), sec. IV.2);
 * for the others the Schur-Cohn conditions on the characteristic polynomial of one step.
 */
#define STF_DOUBLE
#include "growth.h"

#include <complex.h>
#include <math.h>

#include "steadfast/steadfast.h"

#define STARTS 2  /* at rest and away; at home and moving: no mode of the spring is missed */
#define CHUNK 16  /* steps between two looks */
#define CHUNKS 24
#define LEAST 1e-100 /* what decays or grows beyond these is judged by what was seen */
#define MOST 1e100

static stf_result make_springs(size_t integrator, double k, double omega, stf_world **world)
{
    const stf_particle starts[STARTS] = {{.position = {1, 0, 0}, .inverse_mass = 1},
                                           {.velocity = {1, 0, 0}, .inverse_mass = 1}};
    const stf_anchored_spring springs[STARTS] = {{.particle = 0, .stiffness = omega * omega},
                                                 {.particle = 1, .stiffness = omega * omega}};
    const stf_linear_drag drag = {.coefficient = k};
    const stf_world_def def = {.dimensions = 1, .integrator = stf_integrators[integrator], .step = 1};
    stf_result result = stf_world_create(&def, world);
    if (result)
        return result;

    result = stf_world_add_many(*world, starts, STARTS, NULL);
    if (!result)
        result = stf_world_add_force(*world, &stf_force_anchored_springs, springs, STARTS, NULL);
    if (!result)
        result = stf_world_add_force(*world, &stf_force_linear_drag, &drag, 1, NULL);
    if (result)
        stf_world_destroy(*world);
    return result;
}

static double size_of(const stf_world *world)
{
    const stf_particles all = stf_world_view(world);
    double sum = 0;

    for (size_t i = 0; i < all.count; i++)
        sum += all.position[i] * all.position[i] + all.velocity[i] * all.velocity[i];
    return sqrt(sum);
}

double growth_measured(size_t integrator, double k_dt, double omega_dt)
{
    double sizes[CHUNKS + 1];
    int last = 0;
    stf_world *world;

    if (make_springs(integrator, k_dt, omega_dt, &world))
        return (double)NAN;
    sizes[0] = size_of(world);
    do {
        stf_world_step(world, CHUNK);
        sizes[++last] = size_of(world);
    } while (last < CHUNKS && sizes[last] > LEAST && sizes[last] < MOST);
    stf_world_destroy(world);

    /* From the middle on: by then what decays faster is gone. */
    const int middle = last / 2;

    return sizes[last] > 0 ? pow(sizes[last] / sizes[middle], 1.0 / (CHUNK * (last - middle))) : 0;
}

/* |1 + z + z^2 / 2 + ... + z^p / p!| of the larger root, less 1 */
static double runge_kutta(int order, double k, double omega)
{
    const double complex root = csqrt(k * k / 4 - omega * omega);
    const double complex lambda[] = {-k / 2 + root, -k / 2 - root};
    double largest = 0;

    for (int i = 0; i < 2; i++) {
        double complex r = 1, term = 1;
        for (int p = 1; p <= order; p++) {
            term *= lambda[i] / p;
            r += term;
        }
        largest = fmax(largest, cabs(r));
    }
    return largest - 1;
}

/* z^2 - (2 - omega^2 - k) z + 1 - k: stable for omega^2 < 4 - 2 k */
static double semi_implicit_euler(double k, double omega) { return omega * omega - (4 - 2 * k); }

/* With a velocity predicted by the acceleration before: stable for omega^2 < 4 (1 - k) */
static double verlet(double k, double omega) { return omega * omega - 4 * (1 - k); }

double growth_theory(size_t integrator, double k_dt, double omega_dt)
{
    const stf_integrator *const i = stf_integrators[integrator];

    if (i == &stf_explicit_euler)
        return runge_kutta(1, k_dt, omega_dt);
    if (i == &stf_midpoint || i == &stf_improved_euler)
        return runge_kutta(2, k_dt, omega_dt);
    if (i == &stf_rk4)
        return runge_kutta(4, k_dt, omega_dt);
    if (i == &stf_semi_implicit_euler)
        return semi_implicit_euler(k_dt, omega_dt);
    if (i == &stf_position_verlet || i == &stf_velocity_verlet)
        return verlet(k_dt, omega_dt);
    return (double)NAN;
}
