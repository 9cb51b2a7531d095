/* Far from the origin, where reals lie far apart: what still moves, and how far off it gets. */
#include "lab.h"
#include "support/theory.h"

#define STEP (1.0 / 60) /* s */
#define TICKS 600       /* 10 s */
#define ROUNDINGS 8

/*
 * A tick adds v dt to x, rounded to the nearest real: nothing happens below half the space to the next one, and just above it
 * the particle goes a whole one a tick. All others are off by half a space a tick at most, and by what v dt itself is off.
 */
static void flight(cell *c, const char *integrator, const row *at)
{
    enum { WALKS, JUST_FROZEN, JUST_MOVES };
    const double start = (double)(stf_real)at->value, space = lab_ulp(start), dt = (double)(stf_real)STEP;
    const double freezing = space / 2 / dt, seconds = TICKS * STEP, end = start + seconds;
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP});

    lab_add(world, start, 1, 1);
    lab_add(world, start, freezing * 0.99, 1);
    lab_add(world, start, freezing * 1.01, 1);
    MUST(stf_world_step(world, 1));
    if (start > 0) {
        EXPECT(c, lab_x(world, JUST_FROZEN) == start);
        EXPECT(c, lab_x(world, JUST_MOVES) == start + space);
    }
    MUST(stf_world_step(world, TICKS - 1));
    EXPECT(c, start > 0 ? lab_x(world, JUST_FROZEN) == start : true);

    const double off = lab_x(world, WALKS) - end;
    if (start > 0 && freezing > 1) {
        EXPECT(c, lab_x(world, WALKS) == start);
        cell_number(c, "frozen <", freezing, "m/s");
    } else {
        EXPECT_CLOSE(c, off, 0, TICKS * lab_ulp(end) / 2 + ROUNDINGS * REAL_EPSILON * seconds);
        cell_number(c, "off ", fabs(off), " m");
    }
    stf_world_destroy(world);
}

static const row places[] = {
    {"0 m", 0, false},      {"1 m", 1, false},      {"1e3 m", 1e3, false},   {"1e4 m", 1e4, false},
    {"1e5 m", 1e5, false},  {"1e6 m", 1e6, false},  {"1e7 m", 1e7, false},   {"1e8 m", 1e8, false},
    {"1e9 m", 1e9, false},  {"1e10 m", 1e10, false}, {"1e11 m", 1e11, false}, {"1e12 m", 1e12, false},
};

AXIS(axis_distance) = {
    .title = "A walk of 10 s at 1 m/s and 60 ticks a second, by distance from the origin",
    .holds = "Frozen, to the last bit, where v dt is less than half the space between two reals; the number: below which\n"
             "speed (1 % less is frozen, 1 % more moves by one real a tick). Else off by at most half a space a tick: the\n"
             "number.",
    ROWS(places),
    .run = flight,
};

/* What a tick loses is added in the next, so that the sum is off by a space at most: of its own, and of v dt's roundings. */
static void compensated_flight(cell *c, const char *integrator, const row *at)
{
    enum { WALKS, WOULD_FREEZE };
    const double start = (double)(stf_real)at->value, freezing = lab_ulp(start) / 2 / (double)(stf_real)STEP;
    const double speeds[] = {1, (double)(stf_real)(freezing * 0.99)}, seconds = TICKS * STEP;
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP, .compensated = true});

    for (size_t i = 0; i < 2; i++)
        lab_add(world, start, speeds[i], 1);
    MUST(stf_world_step(world, TICKS));
    for (size_t i = WALKS; i <= WOULD_FREEZE; i++) {
        const double way = speeds[i] * seconds;
        EXPECT_CLOSE(c, lab_x(world, i), start + way, lab_ulp(start + way) + ROUNDINGS * REAL_EPSILON * way);
    }
    cell_number(c, "off ", fabs(lab_x(world, WALKS) - start - seconds), " m");
    stf_world_destroy(world);
}

AXIS(axis_distance_compensated) = {
    .title = "The same walk in a compensated world",
    .holds = "Off by at most a space between two reals in all, at 1 m/s (the number) and 1 % below the speed that freezes.",
    ROWS(places),
    .run = compensated_flight,
};

/* omega dt is 0.1: some ten swings. Theory starts from where the particle was put, about a metre from the anchor. */
static void swing(cell *c, const char *integrator, const row *at)
{
    const stf_anchored_spring record = {.anchor = {(stf_real)at->value, 0, 0}, .stiffness = (stf_real)0.01};
    const double centre = (double)record.anchor.x, z = sqrt((double)record.stiffness), space = lab_ulp(centre + 1);
    const double amplitude = (double)(stf_real)(centre + 1) - centre;
    const double growth = fmax(1, theory_spring_growth(integrator, z));
    stf_world *world = lab_world(integrator, (stf_world_def){.step = 1});
    theory t = theory_start(integrator, (double)record.stiffness, 0, amplitude, 0);
    double error = 0, off = 0;

    lab_add(world, centre + 1, 0, 1);
    lab_force(world, &stf_force_anchored_springs, &record);
    for (int n = 1; n <= TICKS; n++) {
        MUST(stf_world_step(world, 1));
        theory_step(&t);
        error = growth * error + space / 2 + ROUNDINGS * REAL_EPSILON * hypot(t.x, t.u / z);
        off = lab_x(world, 0) - centre - t.x;
        EXPECT_CLOSE(c, off, 0, 1.01 * error);
    }
    if (amplitude > 0)
        cell_number(c, "off ", fabs(off), " m");
    else
        cell_word(c, "no swing");
    EXPECT(c, amplitude > 0 || (lab_x(world, 0) == centre && lab_v(world, 0) == 0));
    stf_world_destroy(world);
}

AXIS(axis_distance_spring) = {
    .title = "Ten swings of 1 m around an anchor, at 63 ticks a swing, by distance from the origin",
    .holds = "Every tick within half a space between reals, summed up, of the theory's swing from where the particle stands\n"
             "when it is put a metre away; no swing where the next real is more than two metres away. The number: off at the\n"
             "end.",
    ROWS(places),
    .run = swing,
};
