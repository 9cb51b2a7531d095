/*
 * Linear drag and springs, where theory (support/theory.h) gives the state after every tick, what it is multiplied by, and the
 * tick at which it leaves the reals. One particle of five moves; two of the others are immovable.
 */
#include <string.h>

#include "lab.h"
#include "support/theory.h"

#define PARTICLES 5
#define MOVED 3               /* the particle that moves */
#define TICKS 1000u           /* that a state is followed for */
#define TICKS_GROWING 100000u /* that one is which grows, or until it is not finite */
#define SLACK 1               /* ticks that roundings may bring the end of the reals nearer or further */
#define ROUNDINGS 8           /* of half an ulp each, of each term of a step */

/* A run beside its theory, and how far apart the two may be. */
typedef struct run {
    stf_world *world, *guarded; /* the same twice, one of them with a guard that freezes */
    theory t;
    double z, q; /* omega dt or k dt: the other is 0 */
    double growth;
    stf_particle last_good[PARTICLES]; /* the world's, after the last tick at which it was finite */
    double error, error_x; /* that roundings can have made so far: of the amplitude or velocity; under drag, of the position */
} run;

/* The amplitude of a spring, or the speed. */
static double size_of(const run *r)
{
    const theory *t = &r->t;

    return ldexp(r->z > 0 ? hypot(t->x, t->u / r->z) : fmax(fabs(t->u), fabs(t->history) / fmax(1, r->q)), t->exponent);
}

/* Roundings of all steps, grown by the steps that follow. Roots that are close to each other mix what they multiply. */
static double mixing(double z)
{
    return z > 0 ? 2 / sqrt(fmin(1, fabs(1 - z * z / 4))) : 2;
}

static void step_both(run *r)
{
    const double before = size_of(r);
    const double roundings = ROUNDINGS * theory_roundings(r->t.integrator, r->z + r->q);

    MUST(stf_world_step(r->world, 1));
    theory_step(&r->t);
    r->error = r->growth * r->error + roundings * REAL_EPSILON * fmax(before, size_of(r));
    r->error_x += r->error + ROUNDINGS * REAL_EPSILON * fabs(ldexp(r->t.x, r->t.exponent));
}

static void expect_theory(cell *c, const run *r)
{
    const double tolerance = mixing(r->z) * r->error + LAB_REST;
    const double x = ldexp(r->t.x, r->t.exponent), v = ldexp(r->t.u, r->t.exponent);

    EXPECT_CLOSE(c, lab_x(r->world, MOVED), x, r->z > 0 ? tolerance : mixing(0) * r->error_x + LAB_REST);
    EXPECT_CLOSE(c, lab_v(r->world, MOVED), v, tolerance * fmax(1, r->z));
}

/* Whether the last step had a number that the precision does not hold. */
static bool overflows(const run *r)
{
    const double most = log2((double)REAL_MAX);

    return log2(r->t.largest_sum) + r->t.exponent >= most ||
           (r->z > 0 && log2(r->t.largest_product) + 2 * r->t.exponent >= most);
}

/* Returns the tick at which the world is no longer finite, or 0. Theory has to say the same, up to roundings. */
static unsigned follow(cell *c, run *r, unsigned ticks)
{
    unsigned found = 0, predicted = 0;

    for (unsigned n = 1; n <= ticks && !(found && predicted) && !(predicted && n > predicted + SLACK); n++) {
        size_t index;

        step_both(r);
        if (!predicted && overflows(r))
            predicted = n;
        if (!found && stf_world_find_non_finite(r->world, &index)) {
            found = n;
            EXPECT(c, index == MOVED);
        }
        for (size_t i = 0; i < PARTICLES && !found; i++)
            r->last_good[i] = lab_particle(r->world, i);
        if (!found && !predicted)
            expect_theory(c, r);
    }
    EXPECT_CLOSE(c, found, predicted, SLACK);
    EXPECT(c, (found > 0) == (predicted > 0));
    return found;
}

static void expect_others_as_they_were(cell *c, const stf_world *world, double ticks)
{
    EXPECT(c, lab_x(world, 0) == 1 && lab_v(world, 0) == 0);
    EXPECT(c, lab_x(world, 1) == ticks && lab_v(world, 1) == 1); /* immovable: it keeps its velocity */
    EXPECT(c, lab_x(world, 2) == 0 && lab_v(world, 2) == 0);
    EXPECT(c, lab_x(world, 4) == 0 && lab_v(world, 4) == 0);
}

/* In one call and far beyond the tick at which the other left the finite: the guard names it, and has stopped before. */
static void expect_guard(cell *c, const run *r, unsigned found)
{
    const unsigned ticks = (unsigned)stf_world_ticks(r->world), last_good = found ? found - 1 : ticks;
    stf_fault fault = {.tick = 0};

    EXPECT(c, stf_world_step(r->guarded, found ? 2 * ticks : ticks) == (found ? STF_ERROR_DIVERGED : STF_OK));
    EXPECT(c, stf_world_fault(r->guarded, &fault) == (found > 0));
    EXPECT(c, !found || (fault.tick == found && fault.particle == MOVED));
    EXPECT(c, stf_world_ticks(r->guarded) == last_good);
    for (size_t i = 0; i < PARTICLES; i++) {
        const stf_particle p = lab_particle(r->guarded, i);
        EXPECT(c, memcmp(&p, &r->last_good[i], sizeof p) == 0);
    }
}

static stf_world *start_world(const char *integrator, stf_guard_mode guard, double x, double v)
{
    stf_world *world = lab_world(integrator, (stf_world_def){.step = 1, .guard = {.mode = guard}});

    lab_add(world, 1, 0, 0);
    lab_add(world, 0, 1, 0);
    lab_add(world, 0, 0, 1);
    lab_add(world, x, v, 1);
    lab_add(world, 0, 0, 2);
    return world;
}

static run start(const char *integrator, double z_square, double q, double x, double v)
{
    run r = {.z = sqrt(z_square), .q = q, .t = theory_start(integrator, z_square, q, x, v)};

    r.growth = z_square > 0 ? theory_spring_growth(integrator, r.z) : theory_drag_growth(integrator, q);
    r.world = start_world(integrator, STF_GUARD_OFF, x, v);
    r.guarded = start_world(integrator, STF_GUARD_FREEZE, x, v);
    return r;
}

static void add_force(const run *r, const stf_force *force, const void *record)
{
    lab_force(r->world, force, record);
    lab_force(r->guarded, force, record);
}

/* Factors within a rounding of 1 are 1. */
static bool is_bounded(double growth) { return fabs(growth - 1) < 4 * DBL_EPSILON; }

/* Follows the run and says what it did, and by how much a tick changes the size of the state. */
static void watch(cell *c, run *r)
{
    const unsigned found = follow(c, r, r->growth > 1 ? TICKS_GROWING : TICKS);

    EXPECT(c, !found || r->growth > 1);
    if (found)
        cell_tick(c, "non-finite", found);
    else if (!is_bounded(r->growth))
        cell_change(c, r->growth > 1 ? "grows" : "decays", r->growth - 1);
    else if (r->z > 0)
        cell_change(c, "bounded", theory_frequency_error(r->t.integrator, r->z));
    else
        cell_word(c, "bounded");
    expect_others_as_they_were(c, r->world, (double)stf_world_ticks(r->world));
    expect_guard(c, r, found);
    stf_world_destroy(r->guarded);
    stf_world_destroy(r->world);
}

static void drag(cell *c, const char *integrator, const row *at)
{
    const stf_linear_drag record = {(stf_real)at->value};
    const double q = (double)record.coefficient, limit = stf_integrator_find(integrator)->real_stability;
    run r = start(integrator, 0, q, 0, 1);

    EXPECT(c, is_bounded(r.growth) ? fabs(q / limit - 1) < REAL_EPSILON : (q < limit) == (r.growth < 1));
    add_force(&r, &stf_force_linear_drag, &record);
    watch(c, &r);
}

static void spring(cell *c, const char *integrator, const row *at)
{
    const stf_anchored_spring record = {.particle = MOVED, .stiffness = (stf_real)(at->value * at->value)};
    const double limit = stf_integrator_find(integrator)->imaginary_stability;
    run r = start(integrator, (double)record.stiffness, 0, 1, 0);

    EXPECT(c, is_bounded(r.growth) || (r.z < limit) == (r.growth < 1));
    add_force(&r, &stf_force_anchored_springs, &record);
    watch(c, &r);
}

static const row drags[] = {
    {"0.01", 0.01, false}, {"0.1", 0.1, false}, {"0.5", 0.5, false}, {"1", 1, false},       {"1.5", 1.5, false},
    {"2", 2, false},       {"2.5", 2.5, false}, {"3", 3, false},     {"10", 10, false},     {"100", 100, false},
    {"1e3", 1e3, false},   {"1e4", 1e4, false}, {"1e5", 1e5, false}, {"1e6", 1e6, false},
};

AXIS(axis_drag) = {
    .title = "Linear drag, k dt",
    .holds = "v(n) = R(k dt)^n v(0) to a few ulps a tick; decays where |R| < 1, by |R| - 1 a tick, as real_stability says;\n"
             "elsewhere particle 3 is found non-finite at the tick that R says, and a guard names both and freezes before.",
    ROWS(drags),
    .run = drag,
};

static const row springs[] = {
    {"0.01", 0.01, false}, {"0.1", 0.1, false}, {"0.5", 0.5, false}, {"1", 1, false},     {"1.9", 1.9, false},
    {"2.1", 2.1, false},   {"2.9", 2.9, false}, {"10", 10, false},   {"100", 100, false}, {"1e3", 1e3, false},
    {"1e4", 1e4, false},   {"1e5", 1e5, false}, {"1e6", 1e6, false},
};

AXIS(axis_spring) = {
    .title = "An undamped spring, omega dt",
    .holds = "x(n) and v(n) are M^n of the start to a few ulps a tick: bounded, with a frequency that is too high by the\n"
             "number shown, 2 asin(z/2) / z - 1; or the amplitude grows or decays by |R(iz)| - 1 a tick. Beyond\n"
             "imaginary_stability particle 3 is found non-finite at the tick at which M^n leaves the reals, and a guard names\n"
             "both and freezes before.",
    ROWS(springs),
    .run = spring,
};
