/* Particles at one point, where forces have no direction: they are 0, and particles move as if there were none. */
#include <string.h>

#include "lab.h"
#include "support/theory.h"

#define TICKS 10
#define CROWD 600 /* several blocks */

static const stf_vector point = {(stf_real)0.3, (stf_real)-0.7, (stf_real)0.1};

static void add_springs(stf_world *world, stf_real damping, stf_real rest_length)
{
    stf_spring springs[CROWD - 1];

    for (uint32_t i = 0; i + 1 < CROWD; i++)
        springs[i] = (stf_spring){.a = i, .b = i + 1, .stiffness = 10, .damping = damping, .rest_length = rest_length};
    MUST(stf_world_add_force(world, &stf_force_springs, springs, CROWD - 1, NULL));
}

static void springs(stf_world *world) { add_springs(world, 0, 0); }
static void long_springs(stf_world *world) { add_springs(world, 0, 1); }
static void damped_springs(stf_world *world) { add_springs(world, 5, 0); }

static void anchored_springs(stf_world *world)
{
    stf_anchored_spring anchored[CROWD];

    for (uint32_t i = 0; i < CROWD; i++)
        anchored[i] = (stf_anchored_spring){.particle = i, .anchor = point, .stiffness = 10, .damping = 5, .rest_length = 1};
    MUST(stf_world_add_force(world, &stf_force_anchored_springs, anchored, CROWD, NULL));
}

static void attractor(stf_world *world)
{
    lab_force(world, &stf_force_attractor, &(stf_attractor){.position = point, .strength = 10});
}

static void soft_attractor(stf_world *world)
{
    lab_force(world, &stf_force_attractor, &(stf_attractor){.position = point, .strength = 10, .softening = (stf_real)0.01});
}

static void all_pairs(stf_world *world)
{
    lab_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){.gravitational_constant = 10});
}

static void soft_all_pairs(stf_world *world)
{
    lab_force(world, &stf_force_all_pairs_gravity,
              &(stf_all_pairs_gravity){.gravitational_constant = 10, .softening = (stf_real)0.01});
}

static const struct {
    void (*add_force)(stf_world *world);
    double speed; /* m/s, of all together: away from a point that stands there would be a force */
} crowds[] = {
    {springs, 1},   {long_springs, 1},   {damped_springs, 1}, {all_pairs, 1}, {soft_all_pairs, 1},
    {attractor, 0}, {soft_attractor, 0}, {anchored_springs, 0},
};

static stf_world *crowd_world(const char *integrator, double speed)
{
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STF_DEFAULT_STEP, .capacity = CROWD});

    for (int i = 0; i < CROWD; i++)
        MUST(stf_world_add(world, &(stf_particle){.position = point, .velocity = {(stf_real)speed, 0, (stf_real)(-speed / 3)},
                                                  .inverse_mass = (stf_real)(i % 5)}, NULL));
    return world;
}

static bool same(const stf_world *a, const stf_world *b)
{
    bool all = true;

    for (size_t i = 0; i < CROWD; i++) {
        const stf_particle p = lab_particle(a, i), q = lab_particle(b, i);
        all = all && memcmp(&p, &q, sizeof p) == 0;
    }
    return all;
}

/* Velocities that differ make no force either: there is no direction that a damper could act in. */
static void expect_no_force(cell *c, const stf_world *world)
{
    static stf_real velocity[(CROWD + STF_BLOCK_MAX) * STF_DIMENSIONS_MAX], acceleration[sizeof velocity / sizeof *velocity];
    const size_t length = sizeof velocity / sizeof *velocity;
    const stf_particles view = stf_world_view(world);
    double sum = 0;

    for (size_t k = 0; k < length; k++)
        velocity[k] = (stf_real)(k % 11);
    MUST(stf_world_accelerations(world, 0, view.position, velocity, acceleration));
    for (size_t i = 0; i < CROWD; i++)
        for (size_t d = 0; d < STF_DIMENSIONS_MAX; d++)
            sum += fabs((double)acceleration[stf_particles_offset(&view, i) + d * view.stride]);
    EXPECT(c, sum == 0);
}

static void crowd(cell *c, const char *integrator, const row *at)
{
    const size_t which = (size_t)at->value;
    stf_world *world = crowd_world(integrator, crowds[which].speed);
    stf_world *free_flight = crowd_world(integrator, crowds[which].speed);
    stf_energy energy;

    crowds[which].add_force(world);
    expect_no_force(c, world);
    MUST(stf_world_step(world, TICKS));
    MUST(stf_world_step(free_flight, TICKS));
    EXPECT(c, same(world, free_flight));
    MUST(stf_world_energy(world, &energy));
    EXPECT(c, isfinite(energy.kinetic) && isfinite(energy.potential));
    cell_word(c, "no force");
    stf_world_destroy(free_flight);
    stf_world_destroy(world);
}

static const row points[] = {
    {"springs", 0, false},       {"springs of 1 m", 1, false},  {"damped springs", 2, false}, {"all pairs", 3, false},
    {"soft all pairs", 4, false}, {"attractor", 5, false},       {"soft attractor", 6, false}, {"anchored", 7, false},
};

AXIS(axis_coincident) = {
    .title = "600 particles at one point for 10 ticks, some immovable, by what acts between them",
    .holds = "A force without a direction is 0, whatever the velocities; all particles move as those of a world without it,\n"
             "to the last bit; the energy is finite.",
    ROWS(points),
    .run = crowd,
};

/* Through the anchor at each half swing, at z = 1 to the very point: small whole numbers, which have no rounding. */
static void through(cell *c, const char *integrator, const row *at)
{
    const stf_anchored_spring record = {.stiffness = (stf_real)at->value};
    stf_world *world = lab_world(integrator, (stf_world_def){.step = 1});
    theory t = theory_start(integrator, at->value, 0, 0, 1);
    unsigned at_the_point = 0;

    lab_add(world, 0, 1, 1);
    lab_force(world, &stf_force_anchored_springs, &record);
    for (int n = 1; n <= 12; n++) {
        MUST(stf_world_step(world, 1));
        theory_step(&t);
        EXPECT_CLOSE(c, lab_x(world, 0), t.x, 8 * n * REAL_EPSILON * fmax(1, t.largest_sum));
        EXPECT_CLOSE(c, lab_v(world, 0), t.u, 8 * n * REAL_EPSILON * fmax(1, t.largest_sum));
        at_the_point += lab_x(world, 0) == 0;
    }
    EXPECT(c, !(stf_integrator_find(integrator)->flags & STF_SYMPLECTIC) || at_the_point == 4);
    cell_number(c, "at it ", at_the_point, " times");
    stf_world_destroy(world);
}

static const row ways[] = {{"omega dt = 1", 1, false}};

AXIS(axis_through) = {
    .title = "Through the anchor of a spring, for 12 ticks",
    .holds = "Theory's x(n) and v(n); the symplectic methods, whose period is 6 ticks, stand at the very point 4 times (the\n"
             "number).",
    ROWS(ways),
    .run = through,
};
