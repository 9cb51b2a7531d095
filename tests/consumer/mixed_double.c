/* The double file of mixed_float.c: it says so itself, without a compiler's flag. */
#define STF_DOUBLE
#include <steadfast/steadfast.h>

#include <math.h>

double angle_in_double(unsigned ticks);

double angle_in_double(unsigned ticks)
{
    const stf_particle planet = {.position = {1, 0, 0}, .velocity = {0, 1, 0}, .inverse_mass = 1};
    const stf_attractor sun = {.strength = 1};
    stf_world_def def = {.integrator = &stf_rk4, .step = 1.0 / 64};
    stf_world *world;
    stf_particle end;

    if (stf_world_create(&def, &world) != STF_OK || stf_world_add(world, &planet, NULL) != STF_OK ||
        stf_world_add_force(world, &stf_force_attractor, &sun, 1, NULL) != STF_OK || stf_world_step(world, ticks) != STF_OK ||
        stf_world_get(world, 0, &end) != STF_OK)
        return -1;
    stf_world_destroy(world);
    return atan2(end.position.y, end.position.x);
}
