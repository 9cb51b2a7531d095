/*
 * Shots at the same speed under gravity and quadratic drag. Their paths have no closed form but for the one straight up:
 * with the terminal speed u = sqrt(m g / c), it rises as v = u tan(phi - g t / u), tan(phi) = v(0) / u, and falls
 * as v = -u tanh(g (t - t_top) / u). Source: E. A. Milne, Vectorial Mechanics (1948), sec. 102.
 */
#include <math.h>

#include "scene.h"

#define SHOTS 8
#define STRAIGHT_UP (SHOTS - 1)
#define SPEED 50.0         /* m/s */
#define GRAVITY 9.81       /* m/s^2 */
#define TERMINAL_SPEED 30.0 /* m/s */
#define DRAG (GRAVITY / (TERMINAL_SPEED * TERMINAL_SPEED)) /* kg/m for 1 kg */

static stf_result populate(stf_world *world)
{
    const stf_quadratic_drag drag = {.coefficient = (stf_real)DRAG};
    stf_particle shots[SHOTS];

    /* Points of the circle without a cosine: ((1 - s^2) / (1 + s^2), 2 s / (1 + s^2)), from 14 degrees to straight up. */
    for (size_t i = 0; i < SHOTS; i++) {
        const double s = (double)(i + 1) / SHOTS, unit = SPEED / (1 + s * s);
        shots[i] = (stf_particle){.velocity = {(stf_real)(unit * (1 - s * s)), (stf_real)(unit * 2 * s), 0},
                                  .inverse_mass = 1};
    }
    const stf_result result = stf_world_add_many(world, shots, SHOTS, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_quadratic_drag, &drag, 1, NULL);
}

static bool exact(size_t particle, double time, double position[3], double velocity[3])
{
    if (particle != STRAIGHT_UP)
        return false;

    const double u = TERMINAL_SPEED, length = u * u / GRAVITY, phi = atan(SPEED / u), angle = phi - GRAVITY * time / u;
    const double since_top = -angle; /* as an angle: g (t - t_top) / u */

    position[0] = position[2] = velocity[0] = velocity[2] = 0;
    velocity[1] = angle > 0 ? u * tan(angle) : -u * tanh(since_top);
    position[1] = -length * log(cos(phi)) + length * (angle > 0 ? log(cos(angle)) : -log(cosh(since_top)));
    return true;
}

const scene scene_volley = {
    .name = "volley",
    .title = "A volley with quadratic drag",
    .length_unit = "m",
    .time_unit = "s",
    .dimensions = 2,
    .integrator = &stf_rk4,
    .step = 1.0 / 60,
    .duration = 5,
    .size = 100,
    .time_scale = 1,
    .gravity = {0, (stf_real)-GRAVITY, 0},
    .view_x = 35,
    .view_y = 25,
    .view_half_height = 45,
    .populate = populate,
    .exact = exact,
};
