/* The double file of mixed_float.c: it says so itself, without a compiler's flag. */
#define STF_DOUBLE
#include <steadfast/steadfast.h>

#include <math.h>

double angle_in_double(unsigned ticks);
stf_result load_in_double(const void *buffer, size_t size);

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

/* What a double world says to a saved one. */
stf_result load_in_double(const void *buffer, size_t size)
{
    const stf_world_def def = {0};
    stf_world *world;

    if (stf_world_create(&def, &world) != STF_OK)
        return STF_ERROR_MEMORY;

    const stf_result result = stf_world_load(world, buffer, size, NULL);

    stf_world_destroy(world);
    return result;
}
