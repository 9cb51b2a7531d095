/* What the roundings of a tick come to on average: a run of millions of ticks drifts by that times its ticks. */
#include <stdint.h>

#include "lab.h"
#include "support/theory.h"

#define PARTICLES 8192      /* every other one flies */
#define Z_SQUARE_MOST 0.001 /* (omega dt)^2 */
#define ROUNDINGS 8

/* From 1 to 2, evenly: D. E. Knuth, The Art of Computer Programming 2 (1997), 3.3.4, table 1, line 26. */
static double any(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return 1 + ldexp((double)(*state >> 11), -53);
}

/* F = -k x without a rounding where k is a power of two: the library's springs, which divide by a length, have their own. */
static void pull(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const stf_real stiffness = *(const stf_real *)records;
    (void)record_count, (void)time;

    for (size_t i = 0; i < particles->count; i++)
        particles->force[i] -= stiffness * particles->position[i];
}

static const stf_force pull_force = {.name = "pull", .kind = STF_FIELD, .depends_on = STF_ON_POSITION,
                                     .record_size = sizeof(stf_real), .apply = pull, .fields = "r"};

/*
 * Half of the particles fly out of the origin, and half are let go at rest: a tick then only adds to what is 0, x or v, so that
 * no digit is lost but those of what it adds. Steps have the digits of a float, so that (omega dt)^2 is exact in double: what
 * theory rounds differs from particle to particle as well.
 */
static void tick(cell *c, const char *integrator, const row *at)
{
    const double dt = (double)(float)at->value, stiffness = ldexp(1, ilogb(Z_SQUARE_MOST / (dt * dt)));
    const double tolerance = 6 * sqrt(2 * ROUNDINGS / 3.0) * REAL_EPSILON / 2 / sqrt(PARTICLES); /* six standard deviations */
    static double expected[PARTICLES];
    stf_world *world = lab_world(integrator, (stf_world_def){.step = dt, .dimensions = 1});
    double flying = 0, let_go = 0; /* mean relative errors */
    uint64_t state = 1;

    for (size_t i = 0; i < PARTICLES; i++) {
        const bool flies = i % 2 == 0;
        const double size = (double)(stf_real)any(&state), x = flies ? 0 : size, v = flies ? size : 0;
        theory t = theory_start(integrator, stiffness * dt * dt, 0, x, v * dt);

        theory_step(&t);
        expected[i] = flies ? t.x : t.u / dt;
        lab_add(world, x, v, 1);
    }
    lab_force(world, &pull_force, &(stf_real){(stf_real)stiffness});
    MUST(stf_world_step(world, 1));
    for (size_t i = 0; i < PARTICLES; i += 2) {
        flying += (lab_x(world, i) - expected[i]) / expected[i] / (PARTICLES / 2);
        let_go += (lab_v(world, i + 1) - expected[i + 1]) / expected[i + 1] / (PARTICLES / 2);
    }
    EXPECT_CLOSE(c, flying, 0, tolerance);
    EXPECT_CLOSE(c, let_go, 0, tolerance);
    cell_number(c, "", fmax(fabs(flying), fabs(let_go)) / REAL_EPSILON, " ulp");
    stf_world_destroy(world);
}

static const row steps[] = {
    {"1e-9 s", 1e-9, false},     {"1e-6 s", 1e-6, false}, {"1e-3 s", 1e-3, false}, {"1e-2 s", 1e-2, false},
    {"1/60 s", 1.0 / 60, false}, {"1 s", 1, false},       {"1000 s", 1e3, false},
};

AXIS(axis_bias) = {
    .title = "The mean rounding of a tick on a spring, by step",
    .holds = "Of 4,096 different velocities and of as many accelerations: the mean relative error of what a tick adds is 0,\n"
             "to six standard deviations of eight roundings each. The number: in spaces between reals at 1. A weight dt / 6\n"
             "that is rounded by itself puts every tick off the same way, by up to a third.",
    ROWS(steps),
    .run = tick,
};
