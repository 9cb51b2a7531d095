/* Mass ratios from 1 : 1e-12 to 1 : 1e12, tied by a spring or by gravity; immovable particles among them. */
#include "lab.h"
#include "support/theory.h"

#define TICKS 500
#define ROUNDINGS 8
#define Z_SQUARE 0.01 /* (omega dt)^2 of the pair */

enum { STILL, DRIFTING, FIRST, SECOND, RUN }; /* two immovable particles, the pair, and more such pairs */
#define PAIRS 16                               /* so many springs whose ends count up are computed at once */

/* The ratio of the second mass to the first, 1 kg; INFINITY: the second is immovable. */
static double inverse_of(const row *at) { return (double)(stf_real)(1 / at->value); }

static stf_world *pair_world(const char *integrator, const row *at, double v)
{
    stf_world *world = lab_world(integrator, (stf_world_def){.step = 1});

    lab_add(world, -1, 0, 0);
    lab_add(world, 0, 1, 0);
    lab_add(world, 1, 0, 1);
    lab_add(world, 0, 0, inverse_of(at));
    if (v > 0) {
        stf_particle first = lab_particle(world, FIRST);
        first.velocity.y = (stf_real)v;
        MUST(stf_world_set(world, FIRST, &first));
    }
    return world;
}

static void expect_immovable(cell *c, const stf_world *world, const row *at)
{
    EXPECT(c, lab_x(world, STILL) == -1 && lab_v(world, STILL) == 0);
    EXPECT(c, lab_x(world, DRIFTING) == (double)stf_world_ticks(world) && lab_v(world, DRIFTING) == 1);
    if (isinf(at->value))
        EXPECT(c, lab_x(world, SECOND) == 0 && lab_v(world, SECOND) == 0);
}

/* The largest |m v| of either, kg m/s. */
static double momentum_of(const stf_world *world, const row *at)
{
    const double second = isinf(at->value) ? 0 : fabs(lab_v(world, SECOND)) / inverse_of(at);

    return fmax(fabs(lab_v(world, FIRST)), second);
}

/*
 * Both ends get the same newtons, which a tick then rounds and adds: so much of the momentum is lost or made. A random walk of
 * roundings that are even within half an ulp: six standard deviations.
 */
static double momentum_tolerance(double most, double newtons)
{
    return 6 * sqrt(TICKS * ROUNDINGS / 3.0) * REAL_EPSILON / 2 * (most + newtons);
}

static void put_kept(cell *c, const row *at, double lost)
{
    if (isinf(at->value))
        cell_word(c, "exact");
    else
        cell_number(c, "kept to ", lost, "");
}

/* The same pair again, first ends and then second ends. */
static void add_run(stf_world *world, stf_spring spring)
{
    const stf_particle first = lab_particle(world, FIRST), second = lab_particle(world, SECOND);
    stf_spring springs[1 + PAIRS] = {spring};

    for (int i = 0; i < 2 * PAIRS; i++)
        MUST(stf_world_add(world, i < PAIRS ? &first : &second, NULL));
    for (uint32_t i = 0; i < PAIRS; i++) {
        springs[1 + i] = spring;
        springs[1 + i].a = RUN + i;
        springs[1 + i].b = RUN + PAIRS + i;
    }
    MUST(stf_world_add_force(world, &stf_force_springs, springs, 1 + PAIRS, NULL));
}

static void expect_same_run(cell *c, const stf_world *world)
{
    for (size_t i = RUN; i < RUN + 2 * PAIRS; i++) {
        const size_t alike = i < RUN + PAIRS ? FIRST : SECOND;
        EXPECT(c, lab_x(world, i) == lab_x(world, alike) && lab_v(world, i) == lab_v(world, alike));
    }
}

/* A mass whose reciprocal the precision does not hold with all digits. */
static bool is_refused(const row *at) { return !isinf(at->value) && inverse_of(at) < (double)REAL_LEAST; }

static void refused(cell *c, const char *integrator, const row *at)
{
    stf_world *world = lab_world(integrator, (stf_world_def){.step = 1});

    EXPECT(c, stf_world_add(world, &(stf_particle){.inverse_mass = (stf_real)inverse_of(at)}, NULL) == STF_ERROR_MASS);
    EXPECT(c, stf_world_count(world) == 0);
    cell_word(c, "refused");
    stf_world_destroy(world);
}

/* Whatever the masses, y = x1 - x2 obeys y'' = -k (1/m1 + 1/m2) y: theory gives every tick. */
static void spring(cell *c, const char *integrator, const row *at)
{
    if (is_refused(at)) {
        refused(c, integrator, at);
        return;
    }

    const double both = 1 + inverse_of(at);
    const stf_spring record = {.a = FIRST, .b = SECOND, .stiffness = (stf_real)(Z_SQUARE / both)};
    const double z_square = (double)record.stiffness * both, z = sqrt(z_square);
    stf_world *world = pair_world(integrator, at, 0);
    theory t = theory_start(integrator, z_square, 0, 1, 0);
    double most = 0, worst = 0, error = 0, momentum[STF_DIMENSIONS_MAX] = {0};

    add_run(world, record);
    for (int n = 1; n <= TICKS; n++) {
        MUST(stf_world_step(world, 1));
        theory_step(&t);
        most = fmax(most, momentum_of(world, at));
        error = fmax(1, theory_spring_growth(integrator, z)) * error + ROUNDINGS * REAL_EPSILON * hypot(t.x, t.u / z);
        EXPECT_CLOSE(c, lab_x(world, FIRST) - lab_x(world, SECOND), t.x, 2 * error);
        EXPECT_CLOSE(c, lab_v(world, FIRST) - lab_v(world, SECOND), t.u, 2 * error);
        if (!isinf(at->value))
            MUST(stf_world_momentum(world, momentum));
        worst = fmax(worst, fabs(momentum[0]) / (1 + PAIRS));
    }
    expect_same_run(c, world);
    EXPECT_CLOSE(c, worst, 0, momentum_tolerance(most, (double)record.stiffness * exp(TICKS * Z_SQUARE / 2)));
    expect_immovable(c, world, at);
    put_kept(c, at, worst / most);
    stf_world_destroy(world);
}

static const row ratios[] = {
    {"1 : 1", 1, false},       {"1 : 1e3", 1e3, false},   {"1 : 1e6", 1e6, false},         {"1 : 1e9", 1e9, false},
    {"1 : 1e12", 1e12, false}, {"1 : 1e40", 1e40, false}, {"1 : 1e-6", 1e-6, false},       {"1 : 1e-12", 1e-12, false},
    {"1 : immovable", (double)INFINITY, false},
};

AXIS(axis_mass_spring) = {
    .title = "Two masses on a spring, by their ratio, for 500 ticks",
    .holds = "The distance is that of the theory for k (1/m1 + 1/m2), to a few ulps a tick; momentum stays 0 to round-off\n"
             "(the number: in parts of the largest m v); immovable particles keep position and velocity to the last bit.",
    ROWS(ratios),
    .run = spring,
};

/* The orbit of y = x1 - x2 is that of one particle around a centre of G (m1 + m2), under the same integrator. */
static void gravity(cell *c, const char *integrator, const row *at)
{
    if (is_refused(at)) {
        refused(c, integrator, at);
        return;
    }

    const double mass = 1 / inverse_of(at), second = isinf(at->value) ? 0 : mass;
    const stf_all_pairs_gravity record = {.gravitational_constant = (stf_real)(Z_SQUARE / (1 + second))};
    const double strength = (double)record.gravitational_constant * (1 + second), speed = (double)(stf_real)sqrt(Z_SQUARE);
    const stf_attractor centre = {.strength = (stf_real)strength};
    stf_world *world = pair_world(integrator, at, speed), *orbit = pair_world(integrator, at, speed);
    double start[STF_DIMENSIONS_MAX], momentum[STF_DIMENSIONS_MAX];

    lab_force(world, &stf_force_all_pairs_gravity, &record);
    lab_force(orbit, &stf_force_attractor, isinf(at->value) ? NULL : &centre);
    MUST(stf_world_momentum(world, start));
    for (int n = 1; n <= TICKS; n++) {
        MUST(stf_world_step(world, 1));
        MUST(stf_world_step(orbit, 1));
        const stf_vector one = lab_particle(world, FIRST).position, two = lab_particle(world, SECOND).position;
        const stf_vector expected = lab_particle(orbit, FIRST).position;
        /* an error of the speed is one of the period: along the orbit it grows by 3 omega dt a tick */
        const double tolerance = ROUNDINGS * n * (1 + 3 * n * sqrt(Z_SQUARE)) * REAL_EPSILON;
        EXPECT_CLOSE(c, one.x - two.x, expected.x, tolerance * fmax(1, fabs((double)two.x)));
        EXPECT_CLOSE(c, one.y - two.y, expected.y, tolerance * fmax(1, fabs((double)two.y)));
    }
    MUST(stf_world_momentum(world, momentum));
    const double lost = hypot(momentum[0] - start[0], momentum[1] - start[1]);
    EXPECT_CLOSE(c, lost, 0, momentum_tolerance(2 * speed, Z_SQUARE));
    expect_immovable(c, world, at);
    put_kept(c, at, lost / speed);
    stf_world_destroy(orbit);
    stf_world_destroy(world);
}

AXIS(axis_mass_gravity) = {
    .title = "Two masses in each other's orbit, by their ratio, for 500 ticks of 0.1 / omega",
    .holds = "The difference of their positions moves as one particle around a centre of G (m1 + m2); momentum is kept to\n"
             "round-off (the number: what is lost of it); the immovable neither pull nor feel, so that a pair with one of\n"
             "them flies straight.",
    ROWS(ratios),
    .run = gravity,
};
