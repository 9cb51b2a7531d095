/*
 * Four equal masses on springs of equal stiffness, damped by 0, 5, 25 and 100 % of the critical damping. Exactly, with
 * y(0) = A at rest: y = A exp(-zeta w t) (cos(q t) + (zeta w / q) sin(q t)), q = w sqrt(1 - zeta^2), and
 * y = A exp(-w t) (1 + w t) where zeta = 1. Source: L. D. Landau, E. M. Lifshitz, Mechanics (1976), sec. 25.
 */
#include <math.h>

#include "scene.h"

#define MASSES 4
#define FREQUENCY 2.0   /* w, rad/s */
#define AMPLITUDE 1.0   /* A, m */
#define REST_LENGTH 2.0 /* m */
#define SPACING 1.5     /* m */

static const double zeta[MASSES] = {0, 0.05, 0.25, 1};

static double column(size_t i) { return SPACING * ((double)i - (MASSES - 1) / 2.0); }

static stf_result populate(stf_world *world)
{
    stf_particle masses[MASSES];
    stf_anchored_spring springs[MASSES];

    for (size_t i = 0; i < MASSES; i++) {
        const stf_real x = (stf_real)column(i);
        masses[i] = (stf_particle){.position = {x, (stf_real)AMPLITUDE, 0}, .inverse_mass = 1};
        springs[i] = (stf_anchored_spring){.particle = (uint32_t)i,
                                           .anchor = {x, (stf_real)REST_LENGTH, 0},
                                           .stiffness = (stf_real)(FREQUENCY * FREQUENCY),
                                           .damping = (stf_real)(2 * zeta[i] * FREQUENCY),
                                           .rest_length = (stf_real)REST_LENGTH};
    }
    const stf_result result = stf_world_add_many(world, masses, MASSES, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_anchored_springs, springs, MASSES, NULL);
}

static bool exact(size_t particle, double time, double position[3], double velocity[3])
{
    if (particle >= MASSES)
        return false;

    const double w = FREQUENCY, decay = zeta[particle] * w, envelope = AMPLITUDE * exp(-decay * time);

    position[0] = column(particle);
    position[2] = velocity[0] = velocity[2] = 0;
    if (zeta[particle] < 1) {
        const double q = w * sqrt(1 - zeta[particle] * zeta[particle]);
        position[1] = envelope * (cos(q * time) + decay / q * sin(q * time));
        velocity[1] = -envelope * w * w / q * sin(q * time);
    } else {
        position[1] = envelope * (1 + w * time);
        velocity[1] = -envelope * w * w * time;
    }
    return true;
}

const scene scene_oscillator = {
    .name = "oscillator",
    .title = "Springs, damped by 0, 5, 25 and 100 %",
    .length_unit = "m",
    .time_unit = "s",
    .dimensions = 2,
    .integrator = &stf_velocity_verlet,
    .step = 1.0 / 60,
    .duration = 10,
    .size = AMPLITUDE,
    .time_scale = 1,
    .view_y = 0.4,
    .view_half_height = 2.2,
    .populate = populate,
    .exact = exact,
};
