/*
 * The sun (with the inner planets' mass), Jupiter to Neptune, and Pluto, from 5 September 1994 0h on, in astronomical units,
 * days and solar masses. Source of the figures: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration
 * (2006), table I.2.2. Taken to the frame in which the centre of mass rests at the origin.
 */
#include "scene.h"

#define GRAVITATIONAL_CONSTANT 2.95912208286e-4 /* au^3 / (solar mass day^2) */

typedef struct body {
    double mass, position[3], velocity[3]; /* solar masses, au, au/day */
} body;

static const body bodies[] = {
    {1.00000597682, {0, 0, 0}, {0, 0, 0}},
    {0.000954786104043, {-3.5023653, -3.8169847, -1.5507963}, {0.00565429, -0.00412490, -0.00190589}},
    {0.000285583733151, {9.0755314, -3.0458353, -1.6483708}, {0.00168318, 0.00483525, 0.00192462}},
    {0.0000437273164546, {8.3101420, -16.2901086, -7.2521278}, {0.00354178, 0.00137102, 0.00055029}},
    {0.0000517759138449, {11.4707666, -25.7294829, -10.8169456}, {0.00288930, 0.00114527, 0.00039677}},
    {1 / 1.3e8, {-15.5387357, -25.2225594, -3.1902382}, {0.00276725, -0.00170702, -0.00136504}},
};

#define BODIES (sizeof bodies / sizeof *bodies)

static body centre_of_mass(void)
{
    body centre = {0};

    for (size_t i = 0; i < BODIES; i++)
        centre.mass += bodies[i].mass;
    for (size_t i = 0; i < BODIES; i++)
        for (int d = 0; d < 3; d++) {
            centre.position[d] += bodies[i].mass * bodies[i].position[d] / centre.mass;
            centre.velocity[d] += bodies[i].mass * bodies[i].velocity[d] / centre.mass;
        }
    return centre;
}

static stf_vector difference(const double a[3], const double b[3])
{
    return (stf_vector){(stf_real)(a[0] - b[0]), (stf_real)(a[1] - b[1]), (stf_real)(a[2] - b[2])};
}

static stf_result populate(stf_world *world)
{
    const stf_all_pairs_gravity gravity = {.gravitational_constant = (stf_real)GRAVITATIONAL_CONSTANT};
    const body centre = centre_of_mass();
    stf_particle particles[BODIES];

    for (size_t i = 0; i < BODIES; i++)
        particles[i] = (stf_particle){.position = difference(bodies[i].position, centre.position),
                                      .velocity = difference(bodies[i].velocity, centre.velocity),
                                      .inverse_mass = (stf_real)(1 / bodies[i].mass)};

    const stf_result result = stf_world_add_many(world, particles, BODIES, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_all_pairs_gravity, &gravity, 1, NULL);
}

const scene scene_solar_system = {
    .name = "solar_system",
    .title = "The outer solar system",
    .length_unit = "au",
    .time_unit = "days",
    .dimensions = 3,
    .integrator = &stf_velocity_verlet,
    .step = 20,
    .duration = 60190, /* a year of Neptune */
    .size = 30,
    .time_scale = 3000,
    .view_half_height = 42,
    .conserves_energy = true,
    .populate = populate,
};
