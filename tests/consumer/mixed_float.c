/* One program of two files, one of each precision: the double world is the reference that the float one is held against. */
#include <float.h>
#include <math.h>
#include <stdio.h>

#include <steadfast/steadfast.h>

double angle_in_double(unsigned ticks); /* mixed_double.c */
stf_result load_in_double(const void *buffer, size_t size);

static float angle_in_float(unsigned ticks)
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
    return atan2f(end.position.y, end.position.x);
}

/* A world that was saved in float. */
static stf_result save_in_float_load_in_double(void)
{
    const stf_world_def def = {0};
    unsigned char buffer[1024];
    stf_world *world;

    if (stf_world_create(&def, &world) != STF_OK || stf_world_save(world, buffer, sizeof buffer) != STF_OK)
        return STF_ERROR_MEMORY;

    const size_t size = stf_world_save_size(world);

    stf_world_destroy(world);
    return load_in_double(buffer, size);
}

/*
 * A circle of radius 1 at speed 1: the angle is the time. RK4's error over a second is below (1/64)^4 = 6e-8; in float each of
 * the 64 steps rounds by a few ulps, and the two worlds must differ, or they are one.
 */
int main(void)
{
    const float in_float = angle_in_float(64);
    const double in_double = angle_in_double(64), gap = fabs((double)in_float - in_double);

    if (!(sizeof(stf_real) == sizeof(float) && fabs(in_double - 1) < 6e-8 && gap > 0 && gap < 64 * 4 * (double)FLT_EPSILON)) {
        fprintf(stderr, "mixed_float.c: the angles are %.9g in float and %.17g in double\n", (double)in_float, in_double);
        return 1;
    }
    if (save_in_float_load_in_double() != STF_ERROR_PRECISION) {
        fprintf(stderr, "mixed_float.c: a double world does not refuse what a float world saved\n");
        return 1;
    }
    return 0;
}
