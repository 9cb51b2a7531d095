/* Ten million ticks in one run, and ticks past 2^32. */
#include <string.h>

#include "lab.h"
#include "support/theory.h"

#define STEP (1.0 / 60) /* s */
#define ROUNDINGS 8

/* Every run is made twice: in one call, and with so many looks on the way. Both end with the same bits. */
#define LOOKS 1000

static void expect_same_end(cell *c, const stf_world *world, const stf_world *other, uint64_t ticks)
{
    const stf_particle p = lab_particle(world, 0), q = lab_particle(other, 0);

    EXPECT(c, memcmp(&p, &q, sizeof p) == 0);
    EXPECT(c, stf_world_ticks(world) == ticks && stf_world_ticks(other) == ticks);
    EXPECT(c, stf_world_time(world) == stf_world_time(other));
}

/* The walk of distance.c for days: from 0 on, so that reals lie further and further apart. */
static stf_world *walk_world(const char *integrator, bool compensated)
{
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP, .compensated = compensated});

    lab_add(world, 0, 1, 1);
    return world;
}

/* Half a space a tick, the spaces growing with x: their mean over the way is at most that at the end. Or one in all. */
static void expect_walk(cell *c, const stf_world *world, bool compensated)
{
    const double ticks = (double)stf_world_ticks(world), end = ticks * STEP, spaces = compensated ? 1 : ticks / 2;

    EXPECT(c, stf_world_time(world) == end);
    EXPECT_CLOSE(c, lab_x(world, 0), end, spaces * lab_ulp(end) + ROUNDINGS * REAL_EPSILON * end);
    EXPECT(c, fabs(lab_v(world, 0) - 1) <= 2 * REAL_EPSILON);
}

static void walk(cell *c, const char *integrator, double ticks, bool compensated)
{
    stf_world *world = walk_world(integrator, compensated), *watched = walk_world(integrator, compensated);

    for (int look = 0; look < LOOKS; look++) {
        MUST(stf_world_step(watched, (unsigned)(ticks / LOOKS)));
        expect_walk(c, watched, compensated);
    }
    MUST(stf_world_step(world, (unsigned)ticks));
    expect_same_end(c, world, watched, (uint64_t)ticks);
    cell_number(c, "off ", fabs(lab_x(world, 0) - ticks * STEP), " m");
    stf_world_destroy(watched);
    stf_world_destroy(world);
}

static void flight(cell *c, const char *integrator, const row *at) { walk(c, integrator, at->value, false); }

static void compensated_flight(cell *c, const char *integrator, const row *at) { walk(c, integrator, at->value, true); }

static const row lengths[] = {{"1e3 ticks", 1e3, false}, {"1e5 ticks", 1e5, false}, {"1e7 ticks", 1e7, true}};

AXIS(axis_run_flight) = {
    .title = "A walk from the origin at 1 m/s and 60 ticks a second, by the ticks of one call",
    .holds = "At each of 1,000 looks on the way off by at most half a space between reals a tick; time = ticks x step\n"
             "exactly. In one call it ends with the same bits. The number: off at the end.",
    ROWS(lengths),
    .run = flight,
};

AXIS(axis_run_compensated) = {
    .title = "The same walk in a compensated world",
    .holds = "At each look off by at most a space between reals in all, and by what v dt itself is off.",
    ROWS(lengths),
    .run = compensated_flight,
};

static double energy_of(const stf_world *world)
{
    stf_energy energy;

    MUST(stf_world_energy(world, &energy));
    return energy.kinetic + energy.potential;
}

/*
 * How far the energy of a symplectic method swings from its start at u = 0. Semi-implicit Euler keeps x^2 + u^2 / z^2 - x u,
 * velocity Verlet (1 - z^2 / 4) x^2 + u^2 / z^2; position Verlet's velocity is ahead of that by half of the last change of a.
 */
static double swing_of(const char *integrator, double z)
{
    const double slanted = 1 / (1 - z / 2), upright = 1 / (1 - z * z / 4), ahead = 1 + z * z / 2;

    if (strcmp(integrator, "position_verlet") == 0)
        return upright * ahead * ahead;
    return stf_integrator_find(integrator)->order == 1 ? slanted : upright;
}

#define Z_SQUARE (1.0 / 64) /* (omega dt)^2 of the spring */
#define SWING 50            /* ticks */

/* Roundings of a tick are a random walk of the amplitude: six standard deviations. */
static double walk_of(double ticks) { return 6 * ROUNDINGS * sqrt(ticks) * REAL_EPSILON; }

static stf_world *spring_world(const char *integrator)
{
    stf_world *world = lab_world(integrator, (stf_world_def){.step = 1, .dimensions = 1});

    lab_add(world, 1, 0, 1);
    lab_force(world, &stf_force_anchored_springs, &(stf_anchored_spring){.stiffness = (stf_real)Z_SQUARE});
    return world;
}

/* How far from the tick at which |R|^n leaves the reals it may be: a swing, and what roundings put it off by. */
static double slack_of(double tick, double growth) { return SWING + walk_of(tick) / log(growth); }

/* Steps to where |R|^n leaves the reals, and looks for it tick by tick. */
static void expect_leaving(cell *c, const char *integrator, double tick, double growth)
{
    const unsigned slack = (unsigned)slack_of(tick, growth);
    stf_world *world = spring_world(integrator);
    bool found = false;
    size_t index = 1;

    MUST(stf_world_step(world, (unsigned)tick - slack));
    EXPECT(c, !stf_world_find_non_finite(world, NULL));
    for (unsigned n = 0; n < 2 * slack && !found; n++) {
        MUST(stf_world_step(world, 1));
        found = stf_world_find_non_finite(world, &index);
    }
    EXPECT(c, found && index == 0);
    cell_tick(c, "non-finite", stf_world_ticks(world));
    stf_world_destroy(world);
}

/* Returns the energy over that of the start. */
static double expect_energy(cell *c, const stf_world *world, double growth)
{
    const double ticks = (double)stf_world_ticks(world), factor = energy_of(world) / (Z_SQUARE / 2);
    const double expected = exp(2 * ticks * log(growth));
    const double most = swing_of(stf_world_integrator(world)->name, sqrt(Z_SQUARE)) * (1 + 2 * walk_of(ticks));

    EXPECT(c, factor <= expected * most && factor >= expected / most);
    return factor;
}

static void spring(cell *c, const char *integrator, const row *at)
{
    const double growth = theory_spring_growth(integrator, sqrt(Z_SQUARE)), ticks = at->value;
    const double leaving = growth > 1 ? log((double)REAL_MAX) / 2 / log(growth) : (double)INFINITY; /* x^2 is past the reals */
    const double slack = growth > 1 ? slack_of(leaving, growth) : 0;
    stf_world *world = spring_world(integrator), *watched = spring_world(integrator);
    double factor = 1;

    for (double n = ticks / LOOKS; n <= ticks; n += ticks / LOOKS) {
        MUST(stf_world_step(watched, (unsigned)(ticks / LOOKS)));
        EXPECT(c, stf_world_time(watched) == n);
        if (n < leaving - slack)
            factor = expect_energy(c, watched, growth);
        else if (n > leaving + slack)
            EXPECT(c, !isfinite(energy_of(watched)));
    }
    MUST(stf_world_step(world, (unsigned)ticks));
    expect_same_end(c, world, watched, (uint64_t)ticks);
    if (leaving < ticks)
        expect_leaving(c, integrator, leaving, growth);
    else if (fabs(factor - 1) < 0.5)
        cell_change(c, "energy", factor - 1);
    else
        cell_number(c, "energy x", factor, "");
    stf_world_destroy(watched);
    stf_world_destroy(world);
}

AXIS(axis_run_spring) = {
    .title = "A spring of 50 ticks a swing, by the ticks of one call",
    .holds = "The energy is, at each of 1,000 looks on the way, that of the start times |R(iz)|^2n, within the swing of the\n"
             "symplectic methods and a random walk of roundings; or it is past the reals, at the tick at which theory says\n"
             "so, to a swing. In one call it ends with the same bits.",
    ROWS(lengths),
    .run = spring,
};

#define FULL 4294967295U /* ticks that a call can run: 2^32 - 1 */

/* A user's force that pushes nothing and writes down the time of its first call. */
typedef struct ear {
    double *heard; /* s; NaN: not called yet */
} ear;

static void listen(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const ear *e = records;
    (void)record_count, (void)particles;

    if (isnan(*e->heard))
        *e->heard = time;
}

static const stf_force ear_force = {.name = "ear", .kind = STF_FIELD, .depends_on = STF_ON_TIME, .record_size = sizeof(ear),
                                    .apply = listen, .fields = STF_NOT_SAVED};

/* An empty world gets there at once. Velocity Verlet asks for the end of the tick, which it adds up itself. */
static void ticks_past(cell *c, const char *integrator, const row *at)
{
    const unsigned calls = (unsigned)at->value;
    const uint64_t before = (uint64_t)FULL * calls;
    const double other_step = 1.0 / 50;
    const bool asks_for_end = strcmp(integrator, "velocity_verlet") == 0;
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP});
    double heard = (double)NAN;

    for (unsigned i = 0; i < calls; i++)
        MUST(stf_world_step(world, FULL));
    EXPECT(c, stf_world_ticks(world) == before && stf_world_time(world) == (double)before * STEP);
    lab_add(world, 0, 0, 1);
    lab_force(world, &ear_force, &(ear){&heard});
    for (unsigned n = 0; n < 12; n++) {
        const double start = (double)(before + n) * STEP, end = (double)(before + n + 1) * STEP;
        heard = (double)NAN;
        MUST(stf_world_step(world, 1));
        if (asks_for_end && n > 0) /* in the first tick it has no acceleration yet, and asks for the start */
            EXPECT_CLOSE(c, heard, end, DBL_EPSILON * end + REAL_EPSILON * STEP);
        else
            EXPECT(c, heard == start);
        EXPECT(c, stf_world_ticks(world) == before + n + 1 && stf_world_time(world) == end);
    }
    MUST(stf_world_set_step(world, other_step));
    MUST(stf_world_step(world, 7));
    EXPECT(c, stf_world_time(world) == (double)(before + 12) * STEP + 7 * other_step);
    EXPECT(c, stf_world_ticks(world) == before + 19);
    cell_word(c, "exact");
    stf_world_destroy(world);
}

static const row passes[] = {{"2^32", 1, false}, {"2^33", 2, false}, {"2^48", 65536, false}};

AXIS(axis_ticks) = {
    .title = "Ticks past 2^32, at 60 a second",
    .holds = "Ticks are counted, time = ticks x step to the last bit, as forces hear it; a change of the step goes on from\n"
             "there.",
    ROWS(passes),
    .run = ticks_past,
};
