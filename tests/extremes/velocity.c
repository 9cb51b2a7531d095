/* Velocities from the least denormal to the largest real. */
#include <string.h>

#include "lab.h"

#define TICKS 32
#define STEP (1.0 / 64) /* s: a power of two, so that only what is denormal is rounded */

/* How many velocities an integrator adds up before it makes a step of them. */
static double sum_of(const char *integrator)
{
    return strcmp(integrator, "rk4") == 0 ? 6 : strcmp(integrator, "improved_euler") == 0 ? 2 : 1;
}

/* Position Verlet keeps v dt, not v: what that rounds away is gone. */
static double kept_of(const char *integrator, double v)
{
    const double least = (double)REAL_LEAST * REAL_EPSILON;

    return strcmp(integrator, "position_verlet") == 0 && fabs(v) < (double)REAL_LEAST / STEP
               ? nearbyint(v * STEP / least) * least / STEP
               : v;
}

static void flight(cell *c, const char *integrator, const row *at)
{
    const double v = (double)(stf_real)at->value, kept = kept_of(integrator, v), x = TICKS * STEP * kept;
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP});
    size_t index = 0;

    lab_add(world, 0, 0, 1);
    lab_add(world, 0, v, 1);
    MUST(stf_world_step(world, 1));
    if (sum_of(integrator) * v > (double)REAL_MAX) {
        EXPECT(c, stf_world_find_non_finite(world, &index) && index == 1);
        cell_tick(c, "non-finite", 1);
    } else {
        MUST(stf_world_step(world, TICKS - 1));
        EXPECT(c, lab_v(world, 1) == kept);
        EXPECT_CLOSE(c, lab_x(world, 1), x, TICKS * lab_ulp(x) / 2);
        EXPECT(c, lab_x(world, 0) == 0 && lab_v(world, 0) == 0);
        cell_word(c, kept == v ? "exact" : kept == 0 ? "rests" : "loses digits");
    }
    stf_world_destroy(world);
}

static const row speeds[] = {
    {"denormal least", (double)REAL_LEAST * REAL_EPSILON, false},
    {"denormal", (double)REAL_LEAST / 1024 * 1.3, false},
    {"normal least", (double)REAL_LEAST, false},
    {"1e-30 m/s", 1e-30, false},
    {"1e-10 m/s", 1e-10, false},
    {"1 m/s", 1, false},
    {"1e10 m/s", 1e10, false},
    {"1e30 m/s", 1e30, false},
    {"largest / 8", (double)REAL_MAX / 8, false},
    {"largest / 4", (double)REAL_MAX / 4, false},
    {"largest", (double)REAL_MAX, false},
};

AXIS(axis_velocity) = {
    .title = "Free flight for 32 ticks of 1/64 s, by speed",
    .holds = "The velocity keeps every bit and x = v t to half an ulp a tick, but: position Verlet keeps v dt, and so loses\n"
             "what is denormal of it; RK4 adds up six velocities and improved Euler two, which are infinite near the largest\n"
             "real.",
    ROWS(speeds),
    .run = flight,
};
