#include "support/problem.h"

#include <math.h>

#include "scenes/scene.h"
#include "support/check.h"

static void push_with_cosine(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const stf_real push = (stf_real)cos(time);
    (void)records, (void)record_count;

    for (size_t i = 0; i < particles->count; i++)
        particles->force[i] += push;
}

const stf_force time_force = {.name = "cos t", .kind = STF_FIELD, .depends_on = STF_ON_TIME, .apply = push_with_cosine};

static void turn(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const stf_real *vx = particles->velocity, *vy = vx + particles->stride;
    stf_real *fx = particles->force, *fy = fx + particles->stride;
    (void)records, (void)record_count, (void)time;

    for (size_t i = 0; i < particles->count; i++) {
        const stf_real w = particles->inverse_mass[i], mass = w > 0 ? 1 / w : 0;
        fx[i] -= mass * vy[i];
        fy[i] += mass * vx[i];
    }
}

const stf_force magnetic_force = {.name = "magnetic", .kind = STF_FIELD, .depends_on = STF_ON_VELOCITY, .apply = turn};

static void do_nothing(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)particles, (void)time;
}

const stf_force idle_link = {.name = "idle", .kind = STF_LINK, .apply = do_nothing};

static void add_unit_spring(stf_world *world)
{
    add_force(world, &stf_force_anchored_springs, &(stf_anchored_spring){.stiffness = 1});
}

static void oscillate(double time, double state[4])
{
    state[0] = cos(time);
    state[2] = -sin(time);
}

const problem problem_oscillator = {
    .name = "oscillator",
    .dimensions = 1,
    .duration = 4,
    .start = {.position = {1, 0, 0}, .inverse_mass = 1},
    .add_forces = add_unit_spring,
    .exact = oscillate,
};

static void add_sun(stf_world *world) { add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 1}); }

static void orbit(double time, double state[4])
{
    double position[3], velocity[3];

    scene_kepler.exact(0, time, position, velocity);
    state[0] = position[0], state[1] = position[1];
    state[2] = velocity[0], state[3] = velocity[1];
}

const problem problem_kepler = {
    .name = "kepler",
    .dimensions = 2,
    .duration = 2,
    .start = {.position = {(stf_real)0.5, 0, 0}, .velocity = {0, (stf_real)1.7320508075688773, 0}, .inverse_mass = 1},
    .add_forces = add_sun,
    .exact = orbit,
};

static void add_quadratic_drag(stf_world *world)
{
    add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){.coefficient = 1});
}

static void slow_down(double time, double state[4])
{
    state[0] = log1p(time);
    state[2] = 1 / (1 + time);
}

const problem problem_nonlinear_drag = {
    .name = "nonlinear drag",
    .dimensions = 1,
    .duration = 2,
    .start = {.velocity = {1, 0, 0}, .inverse_mass = 1},
    .add_forces = add_quadratic_drag,
    .exact = slow_down,
};

static void add_time_force(stf_world *world) { add_force(world, &time_force, NULL); }

static void follow_cosine(double time, double state[4])
{
    state[0] = -cos(time);
    state[2] = sin(time);
}

const problem problem_time_dependent = {
    .name = "time-dependent force",
    .dimensions = 1,
    .duration = 2,
    .start = {.position = {-1, 0, 0}, .inverse_mass = 1},
    .add_forces = add_time_force,
    .exact = follow_cosine,
};

static void add_magnet(stf_world *world) { add_force(world, &magnetic_force, NULL); }

static void circle(double time, double state[4])
{
    state[0] = sin(time), state[1] = -cos(time);
    state[2] = cos(time), state[3] = sin(time);
}

const problem problem_magnetic = {
    .name = "magnetic force",
    .dimensions = 2,
    .duration = 4,
    .start = {.position = {0, -1, 0}, .velocity = {1, 0, 0}, .inverse_mass = 1},
    .add_forces = add_magnet,
    .exact = circle,
};

const problem *const problems[] = {
    &problem_oscillator, &problem_kepler, &problem_nonlinear_drag, &problem_time_dependent, &problem_magnetic, NULL,
};

stf_world *problem_world(const problem *p, const stf_integrator *integrator, double step)
{
    stf_world *world = make_world((stf_world_def){.dimensions = p->dimensions, .integrator = integrator, .step = step});

    assert_ok(stf_world_add(world, &p->start, NULL));
    p->add_forces(world);
    return world;
}

double problem_error(const problem *p, const stf_world *world)
{
    const stf_particle particle = particle_of(world, 0);
    const double actual[4] = {(double)particle.position.x, (double)particle.position.y, (double)particle.velocity.x,
                              (double)particle.velocity.y};
    double exact[4] = {0}, square = 0;

    p->exact(stf_world_time(world), exact);
    for (int i = 0; i < 4; i++)
        square += (actual[i] - exact[i]) * (actual[i] - exact[i]);
    return sqrt(square);
}

double problem_error_after(const problem *p, const stf_integrator *integrator, unsigned steps)
{
    stf_world *world = problem_world(p, integrator, p->duration / steps);

    assert_ok(stf_world_step(world, steps));
    const double error = problem_error(p, world);
    stf_world_destroy(world);
    return error;
}
