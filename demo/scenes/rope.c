/* A rope of masses and springs, held at one end and let go from the horizontal. */
#include "scene.h"

#define MASSES 32
#define SPACING 0.1     /* m */
#define MASS 0.05       /* kg */
#define STIFFNESS 4000  /* N/m: hanging, it stretches by 4 % at the top; omega_max = 2 sqrt(k / m) = 566 rad/s */
#define DAMPING 0.4     /* N s/m */
#define GRAVITY 9.81    /* m/s^2 */

static stf_result populate(stf_world *world)
{
    stf_particle masses[MASSES];
    stf_spring springs[MASSES - 1];

    for (uint32_t i = 0; i < MASSES; i++)
        masses[i] = (stf_particle){.position = {(stf_real)(SPACING * i), 0, 0},
                                   .inverse_mass = i == 0 ? 0 : (stf_real)(1 / MASS)};
    for (uint32_t i = 0; i + 1 < MASSES; i++)
        springs[i] = (stf_spring){.a = i,
                                  .b = i + 1,
                                  .stiffness = STIFFNESS,
                                  .damping = (stf_real)DAMPING,
                                  .rest_length = (stf_real)SPACING};

    const stf_result result = stf_world_add_many(world, masses, MASSES, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_springs, springs, MASSES - 1, NULL);
}

const scene scene_rope = {
    .name = "rope",
    .title = "A damped rope of 31 springs",
    .length_unit = "m",
    .time_unit = "s",
    .dimensions = 2,
    .integrator = &stf_semi_implicit_euler,
    .step = 1.0 / 600,
    .duration = 1.5,
    .size = SPACING * (MASSES - 1),
    .time_scale = 1,
    .gravity = {0, (stf_real)-GRAVITY, 0},
    .view_y = -1.5,
    .view_half_height = 2.2,
    .populate = populate,
};
