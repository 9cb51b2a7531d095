/* The lecture's example: a particle slowed by F = -k v. Exactly v = exp(-k t), since its mass and first speed are 1. */
#include <math.h>

#include "scene.h"

#define DRAG 0.8 /* kg/s */

static stf_result populate(stf_world *world)
{
    const stf_particle particle = {.velocity = {1, 0, 0}, .inverse_mass = 1};
    const stf_linear_drag drag = {.coefficient = (stf_real)DRAG};
    const stf_result result = stf_world_add(world, &particle, NULL);

    return result ? result : stf_world_add_force(world, &stf_force_linear_drag, &drag, 1, NULL);
}

static bool exact(size_t particle, double time, double position[3], double velocity[3])
{
    (void)particle;
    position[0] = (1 - exp(-DRAG * time)) / DRAG;
    velocity[0] = exp(-DRAG * time);
    position[1] = position[2] = velocity[1] = velocity[2] = 0;
    return true;
}

const scene scene_drag = {
    .name = "drag",
    .title = "Linear drag, k = 0.8 kg/s",
    .length_unit = "m",
    .time_unit = "s",
    .dimensions = 1,
    .integrator = &stf_explicit_euler,
    .step = 0.2,
    .duration = 9.6,
    .size = 1,
    .time_scale = 1,
    .view_x = 0.625,
    .view_half_height = 0.5,
    .populate = populate,
    .exact = exact,
};
