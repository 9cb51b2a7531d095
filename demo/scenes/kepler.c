/*
 * An orbit of eccentricity 0.5 around an attractor, with semi-major axis 1 and G M = 1: its period is 2 pi. Exactly,
 * by Kepler's equation E - e sin E = t: x = cos E - e, y = sqrt(1 - e^2) sin E.
 * Source: C. D. Murray, S. F. Dermott, Solar System Dynamics (1999), ch. 2.
 */
#include <math.h>

#include "scene.h"

#define ECCENTRICITY 0.5
#define MOST_ITERATIONS 50 /* Newton takes some five */
#define CONVERGED 1e-15    /* rad */

static stf_result populate(stf_world *world)
{
    const stf_attractor sun = {.strength = 1};
    const stf_particle planet = {
        .position = {(stf_real)(1 - ECCENTRICITY), 0, 0},
        .velocity = {0, (stf_real)sqrt((1 + ECCENTRICITY) / (1 - ECCENTRICITY)), 0},
        .inverse_mass = 1,
    };
    const stf_result result = stf_world_add(world, &planet, NULL);

    return result ? result : stf_world_add_force(world, &stf_force_attractor, &sun, 1, NULL);
}

static double eccentric_anomaly(double mean_anomaly)
{
    double anomaly = mean_anomaly;

    for (int i = 0; i < MOST_ITERATIONS; i++) {
        const double change = (anomaly - ECCENTRICITY * sin(anomaly) - mean_anomaly) / (1 - ECCENTRICITY * cos(anomaly));
        anomaly -= change;
        if (fabs(change) < CONVERGED)
            break;
    }
    return anomaly;
}

static bool exact(size_t particle, double time, double position[3], double velocity[3])
{
    const double period = 2 * acos(-1.0), anomaly = eccentric_anomaly(fmod(time, period));
    const double minor = sqrt(1 - ECCENTRICITY * ECCENTRICITY), rate = 1 / (1 - ECCENTRICITY * cos(anomaly));
    (void)particle;

    position[0] = cos(anomaly) - ECCENTRICITY;
    position[1] = minor * sin(anomaly);
    velocity[0] = -sin(anomaly) * rate;
    velocity[1] = minor * cos(anomaly) * rate;
    position[2] = velocity[2] = 0;
    return true;
}

const scene scene_kepler = {
    .name = "kepler",
    .title = "Kepler orbit, e = 0.5",
    .length_unit = "m",
    .time_unit = "s",
    .dimensions = 2,
    .integrator = &stf_velocity_verlet,
    .step = 1.0 / 60,
    .duration = 12.566370614359172, /* two periods */
    .size = 1,
    .time_scale = 1,
    .view_x = -0.5,
    .view_half_height = 1.3,
    .conserves_energy = true,
    .populate = populate,
    .exact = exact,
};
