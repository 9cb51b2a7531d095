#include "support/trade_scene.h"

#include <float.h>
#include <math.h>

#define GRAVITY 9.81
#define TERMINAL_SPEED 5.0

#ifndef TRADE_SCENE_BUILDER_ONLY

const double trade_scene_durations[TRADE_SCENES] = {2, 8, 2, 8, 1, 1, 1, 4};
stf_allocator trade_scene_allocator;
stf_guard trade_scene_guard;

bool trade_scene_exact_fall(void *user, size_t particle, double time, double position[3], double velocity[3])
{
    const double u = TERMINAL_SPEED, angle = GRAVITY * time / u;
    (void)user;

    for (int d = 0; d < 3; d++)
        position[d] = velocity[d] = 0;
    if (particle == 0) {
        position[1] = -u * u / GRAVITY * log(cosh(angle));
        velocity[1] = -u * tanh(angle);
    } else
        position[0] = 1;
    return true;
}

#endif

static stf_result add(stf_world *world, double x, double y, double vx, double vy, double inverse_mass)
{
    const stf_particle p = {.position = {(stf_real)x, (stf_real)y, 0},
                            .velocity = {(stf_real)vx, (stf_real)vy, 0},
                            .inverse_mass = (stf_real)inverse_mass};

    return stf_world_add(world, &p, NULL);
}

static void sway(const void *records, size_t count, const stf_particles *particles, double time)
{
    (void)records, (void)count;
    for (size_t i = 0; i < particles->count; i++)
        particles->force[i] += (stf_real)cos(3 * time);
}

static const stf_force sway_force = {.name = "sway", .apply = sway, .depends_on = STF_ON_TIME};

static stf_result add_pendulum(stf_world *world)
{
    const stf_anchored_spring rod = {.particle = 0, .stiffness = 400, .rest_length = 1};
    stf_result result = add(world, 1, 0, 0, 0, 1);

    if (!result)
        result = stf_world_add_force(world, &sway_force, NULL, 0, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_anchored_springs, &rod, 1, NULL);
}

static stf_result add_gravity(stf_world *world, double softening)
{
    const stf_all_pairs_gravity all = {.gravitational_constant = 1, .softening = (stf_real)softening};

    return stf_world_add_force(world, &stf_force_all_pairs_gravity, &all, 1, NULL);
}

/* Masses of 0.5 at 0.7 from each other, the pericentre of a = 1: v = sqrt((1 + e) / (1 - e)) between them. */
static stf_result add_binary(stf_world *world)
{
    const double speed = sqrt(1.3 / 0.7);
    stf_result result = add(world, 0.35, 0, 0, speed / 2, 2);

    if (!result)
        result = add(world, -0.35, 0, 0, -speed / 2, 2);
    if (!result)
        result = add(world, 0, 5, 0.4, 0, 1e4);
    return result ? result : add_gravity(world, 0);
}

static void push_nothing(const void *records, size_t count, const stf_particles *particles, double time)
{
    (void)records, (void)count, (void)particles, (void)time;
}

static double potential_of_time(const void *records, size_t count, const stf_particles *particles, double time)
{
    (void)records, (void)count;
    return particles->first == 0 ? time : 0;
}

static const stf_force timer_force = {.name = "timer", .apply = push_nothing, .potential = potential_of_time};

static stf_result add_fall(stf_world *world)
{
    const stf_quadratic_drag drag = {.coefficient = (stf_real)(GRAVITY / (TERMINAL_SPEED * TERMINAL_SPEED))};
    stf_result result = add(world, 0, 0, 0, 0, 1);

    if (!result)
        result = add(world, 1, 0, 0, 0, 0);
    if (!result)
        result = stf_world_add_force(world, &timer_force, NULL, 0, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_quadratic_drag, &drag, 1, NULL);
}

/* Burrau's: masses 3, 4 and 5 at rest at the corners opposite to the sides of a right triangle (E. Burrau, 1913). */
static stf_result add_chaos(stf_world *world)
{
    stf_result result = add(world, 1, 3, 0, 0, 1 / 3.0);

    if (!result)
        result = add(world, -2, -1, 0, 0, 1 / 4.0);
    if (!result)
        result = add(world, 1, -1, 0, 0, 1 / 5.0);
    return result ? result : add_gravity(world, 0);
}

static stf_result add_crowd(stf_world *world)
{
    const stf_linear_drag drag = {.coefficient = 1};
    stf_result result = stf_world_add_force(world, &stf_force_linear_drag, &drag, 1, NULL);

    for (int i = 0; i < 600 && !result; i++)
        result = add(world, i, 0, 0, 1, 1);
    return result;
}

static stf_result add_rest(stf_world *world) { return add(world, 5.3, 0.1, 0, 0, 1); }

static stf_result add_lost(stf_world *world)
{
    const double largest = sizeof(stf_real) == sizeof(double) ? DBL_MAX : (double)FLT_MAX;

    return add(world, largest / 2, 0, largest / 2, 0, 1);
}

static stf_result add_nothing(stf_world *world)
{
    (void)world;
    return STF_OK;
}

stf_result trade_scene_build(void *user, stf_world **world)
{
    static stf_result (*const populate[TRADE_SCENES])(stf_world *) = {
        add_pendulum, add_binary, add_fall, add_chaos, add_rest, add_crowd, add_nothing, add_lost};
    const trade_scene which = *(const trade_scene *)user;
    const bool falls = which == TRADE_PENDULUM || which == TRADE_FALL;
    const stf_world_def def = {.dimensions = 2, .gravity = {0, falls ? (stf_real)-GRAVITY : 0, 0},
                               .allocator = trade_scene_allocator, .guard = trade_scene_guard};
    stf_world *made;
    stf_result result = stf_world_create(&def, &made);
    if (result)
        return result;

    result = populate[which](made);
    if (result)
        stf_world_destroy(made);
    else
        *world = made;
    return result;
}
