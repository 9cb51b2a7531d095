/* Steps from 1e-9 to 1e3 s in free fall, and the ends of what is a step. */
#include <string.h>

#include "lab.h"

#define TICKS 1000
#define GRAVITY (-10.0) /* m/s^2 */

/* x of free fall from 0 at 1 m/s. Euler's methods take the velocity from the start or the end of each tick. */
static double fall(const char *integrator, double n, double dt)
{
    const bool at_start = strcmp(integrator, "explicit_euler") == 0, at_end = strcmp(integrator, "semi_implicit_euler") == 0;

    return n * dt + GRAVITY * dt * dt * n * (n + at_end - at_start) / 2;
}

/* Each tick rounds v, and what is added to it three times at most; errors of v then add up in x, which is rounded likewise. */
static void decade(cell *c, const char *integrator, const row *at)
{
    const double dt = (double)(stf_real)at->value, n = TICKS;
    const double v = 1 + n * GRAVITY * dt, x = fall(integrator, n, dt);
    const double v_most = fmax(1, fabs(v)), x_most = fmax(fabs(x), fall(integrator, ceil(-1 / GRAVITY / dt), dt));
    const double v_tolerance = n * REAL_EPSILON * (v_most / 2 + 3 * fabs(GRAVITY) * dt);
    const double x_tolerance = n * dt * v_tolerance / 2 + n * REAL_EPSILON * (x_most / 2 + 3 * v_most * dt);
    stf_world *world = lab_world(integrator, (stf_world_def){.step = at->value, .gravity = {(stf_real)GRAVITY, 0, 0}});

    lab_add(world, 0, 1, 1);
    lab_add(world, 0, 1, 0); /* immovable: it does not fall */
    MUST(stf_world_step(world, TICKS));
    EXPECT_CLOSE(c, lab_v(world, 1), 1, REAL_EPSILON);
    EXPECT_CLOSE(c, lab_x(world, 1), n * dt, n * lab_ulp(n * dt));
    EXPECT_CLOSE(c, lab_v(world, 0), v, v_tolerance);
    EXPECT_CLOSE(c, lab_x(world, 0), x, x_tolerance);
    EXPECT(c, stf_world_time(world) == TICKS * at->value);
    cell_number(c, "off ", fabs(lab_x(world, 0) - x) / lab_ulp(x), " ulp");
    stf_world_destroy(world);
}

static const row decades[] = {
    {"1e-9 s", 1e-9, false}, {"1e-8 s", 1e-8, false}, {"1e-7 s", 1e-7, false}, {"1e-6 s", 1e-6, false}, {"1e-5 s", 1e-5, false},
    {"1e-4 s", 1e-4, false}, {"1e-3 s", 1e-3, false}, {"1e-2 s", 1e-2, false}, {"0.1 s", 0.1, false},   {"1 s", 1, false},
    {"10 s", 10, false},     {"100 s", 100, false},   {"1000 s", 1000, false},
};

AXIS(axis_step) = {
    .title = "Free fall for 1,000 ticks, by step",
    .holds = "x and v are the parabola (Euler's methods: half a tick off) to the sum of the roundings, and time = ticks x\n"
             "step exactly. The number: x at the end, in units of its last place.",
    ROWS(decades),
    .run = decade,
};

static void refused(cell *c, const char *integrator, double step)
{
    const stf_world_def def = {.integrator = stf_integrator_find(integrator), .step = step};
    stf_world *never = NULL, *world = lab_world(integrator, (stf_world_def){.step = 0.5});

    lab_add(world, 0, 1, 1);
    MUST(stf_world_step(world, 1));
    EXPECT(c, stf_world_create(&def, &never) == STF_ERROR_STEP && !never);
    EXPECT(c, stf_world_set_step(world, step) == STF_ERROR_STEP);
    MUST(stf_world_step(world, 1));
    EXPECT(c, stf_world_step_size(world) == 0.5 && stf_world_time(world) == 1 && lab_x(world, 0) == 1);
    cell_word(c, "refused");
    stf_world_destroy(world);
}

/* RK4 adds up six velocities before it divides by 6. */
static bool overflows(const char *integrator, double x, double increment)
{
    const double factor = strcmp(integrator, "rk4") == 0 ? 6 : 1;

    return factor * increment > (double)REAL_MAX || x + increment > (double)REAL_MAX;
}

#define END_TICKS 8
#define END_SPEED 0.5 /* m/s */

static void end(cell *c, const char *integrator, const row *at)
{
    if (!(at->value >= (double)REAL_LEAST && at->value <= (double)REAL_MAX)) {
        refused(c, integrator, at->value);
        return;
    }

    const double increment = END_SPEED * at->value;
    stf_world *world = lab_world(integrator, (stf_world_def){.step = at->value});
    double x = 0;

    lab_add(world, 0, END_SPEED, 1);
    cell_word(c, "exact");
    for (unsigned n = 1; n <= END_TICKS; n++) {
        MUST(stf_world_step(world, 1));
        EXPECT(c, stf_world_find_non_finite(world, NULL) == overflows(integrator, x, increment));
        if (overflows(integrator, x, increment)) {
            cell_tick(c, "non-finite", n);
            break;
        }
        x += increment;
        EXPECT_CLOSE(c, lab_x(world, 0), x, n * lab_ulp(x));
        EXPECT_CLOSE(c, lab_v(world, 0), END_SPEED, REAL_EPSILON);
    }
    stf_world_destroy(world);
}

static const row ends[] = {
    {"-1 s", -1, false},     {"1e-39 s", 1e-39, false}, {"least normal", (double)REAL_LEAST, false},
    {"1e37 s", 1e37, false}, {"1e39 s", 1e39, false},   {"largest", (double)REAL_MAX, false},
    {"NaN", (double)NAN, false},     {"infinity", (double)INFINITY, false},
};

AXIS(axis_step_end) = {
    .title = "The ends of what is a step",
    .holds = "What is no normal number of the precision is refused, and nothing changes. At the ends 0.5 m/s moves a\n"
             "particle by half a step a tick, until it is past the largest real; RK4 adds up six velocities, and is past it\n"
             "six times as soon.",
    ROWS(ends),
    .run = end,
};
