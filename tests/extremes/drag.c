/* Drag beyond the theory of linear.c: quadratic drag in every direction, and linear drags whose sum is past the reals. */
#include <string.h>

#include "lab.h"
#include "support/theory.h"

#define STEP (1.0 / 16) /* s */
#define ROUNDINGS 8

#define HALVING 128 /* ticks in which the speed halves: c v(0) dt = 1 / 128 */

/* Unit vectors, for worlds of so many dimensions; (3, 4) / 5 and (2, 3, 6) / 7 are some. */
typedef struct direction {
    unsigned dimensions;
    double of[STF_DIMENSIONS_MAX];
} direction;

static const direction directions[] = {
    {1, {1, 0, 0}}, {2, {1, 0, 0}}, {2, {0, 1, 0}},      {2, {0.6, -0.8, 0}},   {3, {1, 0, 0}},
    {3, {0, 1, 0}}, {3, {0, 0, 1}}, {3, {0, -0.6, 0.8}}, {3, {-0.6, 0, 0.8}}, {3, {2 / 7.0, 3 / 7.0, -6 / 7.0}},
};

/* What a tick of this order is off by at most: the next term of the series of 1 / (1 + c v(0) t), and as much again. */
static double tick_error(int order) { return 2 * pow(HALVING, -order - 1); }

/* v' = -c |v| v: from 1 m/s on |v| = 1 / (1 + c t) in any direction. Position Verlet starts with a tick of first order. */
static void quadratic(cell *c, const char *integrator, const row *at)
{
    const direction *to = &directions[(size_t)at->value];
    const stf_quadratic_drag record = {(stf_real)(1 / (HALVING * STEP))};
    const double first = strcmp(integrator, "position_verlet") == 0 ? tick_error(1) : 0;
    const double each = tick_error(stf_integrator_find(integrator)->order) + ROUNDINGS * REAL_EPSILON;
    const stf_particle particle = {.velocity = {(stf_real)to->of[0], (stf_real)to->of[1], (stf_real)to->of[2]},
                                   .inverse_mass = 1};
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP, .dimensions = to->dimensions});
    double most = 0;

    MUST(stf_world_add(world, &particle, NULL));
    lab_force(world, &stf_force_quadratic_drag, &record);
    for (int n = 1; n <= HALVING; n++) {
        MUST(stf_world_step(world, 1));
        const stf_vector velocity = lab_particle(world, 0).velocity;
        const double v[] = {(double)velocity.x, (double)velocity.y, (double)velocity.z};
        const double speed = 1 / (1 + n / (double)HALVING);
        for (int d = 0; d < STF_DIMENSIONS_MAX; d++) {
            EXPECT_CLOSE(c, v[d], speed * to->of[d], (first + n * each) * fabs(to->of[d]));
            most = fmax(most, fabs(v[d] - speed * to->of[d]));
        }
    }
    cell_number(c, "off ", most, " m/s");
    stf_world_destroy(world);
}

static const row ways[] = {
    {"1D", 0, false},    {"2D, x", 1, false}, {"2D, y", 2, false},  {"2D, xy", 3, false}, {"3D, x", 4, false},
    {"3D, y", 5, false}, {"3D, z", 6, false}, {"3D, yz", 7, false}, {"3D, xz", 8, false}, {"3D, xyz", 9, false},
};

AXIS(axis_drag_quadratic) = {
    .title = "Quadratic drag for 128 ticks, to half the speed, by direction",
    .holds = "Each component is its own at the start / (1 + c v(0) t), as far as the order of the integrator goes,\n"
             "whatever the direction.",
    ROWS(ways),
    .run = quadratic,
};

#define SUM_TICKS 32
enum { STILL, DRIFTING, AT_REST, HEAVY, LIGHT };

/*
 * Of several linear drags the sum acts, at most the largest real. A mass of 1 / the least normal number then has a k / m of 4
 * at most, and all stays finite until a mass of 1 kg joins in.
 */
static void sum(cell *c, const char *integrator, const row *at)
{
    const stf_linear_drag drags[] = {{(stf_real)at->value * REAL_MAX}, {(stf_real)at->value * REAL_MAX}};
    const double k = fmin(2 * at->value, 1) * (double)REAL_MAX, q = k * (double)REAL_LEAST * STEP;
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP});
    theory t = theory_start(integrator, 0, q, 0, STEP);
    size_t index = 0;

    lab_add(world, 1, 0, 0);
    lab_add(world, 0, 1, 0);
    lab_add(world, 2, 0, 1);
    lab_add(world, 0, 1, (double)REAL_LEAST);
    lab_force(world, &stf_force_linear_drag, &drags[0]);
    lab_force(world, &stf_force_linear_drag, &drags[1]);
    for (int n = 1; n <= SUM_TICKS; n++) {
        MUST(stf_world_step(world, 1));
        theory_step(&t);
        EXPECT(c, !stf_world_find_non_finite(world, NULL));
        EXPECT_CLOSE(c, lab_v(world, HEAVY), ldexp(t.u, t.exponent) / STEP, n * ROUNDINGS * REAL_EPSILON);
        EXPECT(c, lab_x(world, STILL) == 1 && lab_v(world, STILL) == 0);
        EXPECT(c, lab_x(world, DRIFTING) == n * STEP && lab_v(world, DRIFTING) == 1);
        EXPECT(c, lab_x(world, AT_REST) == 2 && lab_v(world, AT_REST) == 0);
    }
    lab_add(world, 0, 1, 1);
    MUST(stf_world_step(world, 3));
    EXPECT(c, stf_world_find_non_finite(world, &index) && index == LIGHT);
    cell_change(c, "decays", theory_drag_growth(integrator, q) - 1);
    stf_world_destroy(world);
}

static const row sums[] = {{"1/4 each", 0.25, false}, {"1/2", 0.5, false}, {"3/4", 0.75, false}, {"all", 1, false}};

AXIS(axis_drag_sum) = {
    .title = "Two linear drags, each of so much of the largest real",
    .holds = "The sum acts, or the largest real: a mass of 1 / the least normal number decays by R(k dt / m), what is\n"
             "immovable or at rest keeps every bit, and a mass of 1 kg is non-finite within three ticks.",
    ROWS(sums),
    .run = sum,
};
