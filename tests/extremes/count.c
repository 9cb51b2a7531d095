/* Worlds of 0, 1 and 10 million particles: however many there are, each moves like the same one alone. */
#include <string.h>

#include "lab.h"

#define TICKS 3
#define KINDS 7     /* of particles, in turn */
#define LOT ((size_t)70000) /* added at once: a multiple of KINDS */

static stf_particle particle_of_kind(size_t kind)
{
    const double k = (double)kind;

    return (stf_particle){.position = {(stf_real)(k / 3), (stf_real)-k, (stf_real)0.1},
                          .velocity = {1, (stf_real)(k / 7), (stf_real)-0.7},
                          .inverse_mass = (stf_real)(kind == KINDS - 1 ? 0 : 1 + k)};
}

static stf_world *world_of(const char *integrator, size_t count)
{
    static stf_particle lot[LOT];
    const stf_linear_drag drag = {(stf_real)0.3};
    stf_world *world = lab_world(integrator, (stf_world_def){.gravity = {0, (stf_real)-9.81, 0}, .capacity = count});

    for (size_t i = 0; i < LOT; i++)
        lot[i] = particle_of_kind(i % KINDS);
    for (size_t left = count; left > 0; left -= left < LOT ? left : LOT)
        MUST(stf_world_add_many(world, lot, left < LOT ? left : LOT, NULL));
    lab_force(world, &stf_force_linear_drag, &drag);
    return world;
}

/* Sums in double of n equal terms, each rounded; all terms of momentum and energy here have one sign. */
static void expect_sums(cell *c, const stf_world *world, const stf_world *one_of_each)
{
    const double n = (double)stf_world_count(world), whole = floor(n / KINDS), tolerance = n * DBL_EPSILON;
    double expected[STF_DIMENSIONS_MAX] = {0}, kinetic = 0, momentum[STF_DIMENSIONS_MAX];
    stf_energy energy;

    for (size_t kind = 0; kind + 1 < KINDS && n > 0; kind++) {
        const stf_particle p = lab_particle(one_of_each, kind);
        const double times = (whole + (double)((double)kind < n - whole * KINDS)) / (double)p.inverse_mass;
        const double v[] = {(double)p.velocity.x, (double)p.velocity.y, (double)p.velocity.z};
        for (int d = 0; d < STF_DIMENSIONS_MAX; d++) {
            expected[d] += times * v[d];
            kinetic += times * v[d] * v[d] / 2;
        }
    }
    MUST(stf_world_momentum(world, momentum));
    MUST(stf_world_energy(world, &energy));
    for (int d = 0; d < STF_DIMENSIONS_MAX; d++)
        EXPECT_CLOSE(c, momentum[d], expected[d], tolerance * n);
    EXPECT_CLOSE(c, energy.kinetic, kinetic, tolerance * fabs(kinetic));
}

static void count(cell *c, const char *integrator, const row *at)
{
    const size_t n = (size_t)at->value;
    stf_world *world = world_of(integrator, n), *one_of_each = world_of(integrator, KINDS);
    size_t different = 0;

    MUST(stf_world_step(world, TICKS));
    MUST(stf_world_step(one_of_each, TICKS));
    EXPECT(c, stf_world_count(world) == n && stf_world_ticks(world) == TICKS);
    EXPECT(c, stf_world_time(world) == TICKS * STF_DEFAULT_STEP);
    EXPECT(c, !stf_world_find_non_finite(world, NULL));
    for (size_t i = 0; i < n; i++) {
        const stf_particle p = lab_particle(world, i), q = lab_particle(one_of_each, i % KINDS);
        different += memcmp(&p, &q, sizeof p) != 0;
    }
    EXPECT(c, different == 0);
    expect_sums(c, world, one_of_each);
    cell_word(c, n > 0 ? "same bits" : "nothing");
    stf_world_destroy(one_of_each);
    stf_world_destroy(world);
}

static const row counts[] = {
    {"0", 0, false}, {"1", 1, false}, {"1,000", 1000, false}, {"10,000,000", 1e7, true},
};

AXIS(axis_count) = {
    .title = "Particles in the world, falling with drag for 3 ticks",
    .holds = "Each has the bits of the same particle in a world of seven; momentum and energy are the sums of all; an empty\n"
             "world has neither, and its ticks and time go on.",
    ROWS(counts),
    .run = count,
};
