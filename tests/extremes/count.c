/*
 * Worlds of 0, 1 and 10 million particles, in flight, among fields and on springs: however many there are, each moves like the
 * same one in a small world. All-pairs gravity is not here: 10 million have 5e13 pairs.
 */
#include <stdlib.h>
#include <string.h>

#include "lab.h"

#define TICKS 3
#define KINDS ((size_t)14)  /* of particles, in turn */
#define LOT ((size_t)70000) /* added at once: a multiple of KINDS */

/*
 * What a world is full of. Bits are those of a small world where no order of a sum depends on how many particles there are: a
 * particle with two springs may have them added in either order, so it has no field force that comes before them.
 */
typedef struct crowd {
    unsigned dimensions;
    bool has_fields;     /* an attractor and quadratic drag; all have linear drag and gravity */
    size_t spring_every; /* a spring ties every n-th particle to the next one; 0: there is none */
    size_t ends; /* so many at either end may feel it, one more a stage of a tick; a multiple of KINDS */
} crowd;

static const crowd in_flight = {.dimensions = 3};
static const crowd among_fields = {.dimensions = 3, .has_fields = true};
static const crowd in_pairs = {.dimensions = 3, .has_fields = true, .spring_every = 2};
static const crowd on_a_rope = {.dimensions = 2, .spring_every = 1, .ends = KINDS};

/* So many does the small world have that tells how n move. */
static size_t small_count(const crowd *of, size_t n)
{
    return n < 2 * of->ends + 2 * KINDS ? n : 2 * of->ends + KINDS + n % KINDS;
}

/* The particle there that moves like particle i of n: by its place from the nearer end, or by its kind. */
static size_t alike(const crowd *of, size_t n, size_t i)
{
    const size_t to_end = n - i, small = small_count(of, n);

    if (i < of->ends || n == small)
        return i;
    return to_end <= of->ends ? small - to_end : of->ends + (i - of->ends) % KINDS;
}

static stf_particle particle_of_kind(const crowd *of, size_t kind)
{
    const double k = (double)kind, z = of->dimensions > 2 ? 0.1 : 0;

    return (stf_particle){.position = {(stf_real)(k / 3), (stf_real)-k, (stf_real)z},
                          .velocity = {1, (stf_real)(k / 7), (stf_real)(-7 * z)},
                          .inverse_mass = (stf_real)(kind == KINDS - 1 ? 0 : 1 + k)};
}

static stf_result add_particles(stf_world *world, const crowd *of, size_t n)
{
    static stf_particle lot[LOT];
    stf_result result = STF_OK;

    for (size_t i = 0; i < LOT; i++)
        lot[i] = particle_of_kind(of, i % KINDS);
    for (size_t left = n; left > 0 && !result; left -= left < LOT ? left : LOT)
        result = stf_world_add_many(world, lot, left < LOT ? left : LOT, NULL);
    return result;
}

static stf_result set_springs(stf_world *world, stf_force_id id, size_t every, size_t n)
{
    const size_t spring_count = n > 0 ? (n - 1 + every - 1) / every : 0;
    stf_spring *springs = malloc((spring_count + 1) * sizeof *springs);
    stf_result result = springs ? STF_OK : STF_ERROR_MEMORY;

    for (size_t i = 0; i < spring_count && springs; i++)
        springs[i] = (stf_spring){.a = (uint32_t)(i * every), .b = (uint32_t)(i * every + 1), .stiffness = 3,
                                  .damping = (stf_real)0.25, .rest_length = (stf_real)0.5};
    if (!result)
        result = stf_world_set_force(world, id, springs, spring_count);
    free(springs);
    return result;
}

/* The link is added while the world is empty, so that it makes room for the work of all once, and copies none. */
static stf_result fill(stf_world *world, const crowd *of, size_t n)
{
    stf_force_id id = 0;
    stf_result result = STF_OK;

    lab_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.3});
    if (of->has_fields) {
        lab_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){(stf_real)0.2});
        lab_force(world, &stf_force_attractor, &(stf_attractor){.position = {2, -3, 1}, .strength = 5});
    }
    if (of->spring_every > 0)
        result = stf_world_add_force(world, &stf_force_springs, NULL, 0, &id);
    if (!result)
        result = add_particles(world, of, n);
    return result || !id ? result : set_springs(world, id, of->spring_every, n);
}

/* NULL, and the cell is broken, where the machine has not the memory. */
static stf_world *world_of(cell *c, const char *integrator, const crowd *of, size_t n, stf_guard guard)
{
    const stf_world_def def = {.integrator = stf_integrator_find(integrator), .dimensions = of->dimensions,
                               .gravity = {0, (stf_real)-9.81, 0}, .capacity = n, .guard = guard};
    stf_world *world = NULL;

    if (EXPECT_OK(c, stf_world_create(&def, &world)) && EXPECT_OK(c, fill(world, of, n)))
        return world;
    stf_world_destroy(world);
    return NULL;
}

/* Each has the bits of its like; momentum and kinetic energy are the sums of n of these in double, rounded here and there. */
static void expect_alike(cell *c, const stf_world *world, const crowd *of, const stf_world *small)
{
    const size_t n = stf_world_count(world);
    const double tolerance = 2 * (double)n * DBL_EPSILON;
    double sum[STF_DIMENSIONS_MAX] = {0}, size[STF_DIMENSIONS_MAX] = {0}, kinetic = 0, momentum[STF_DIMENSIONS_MAX];
    stf_energy energy;
    size_t different = 0;

    for (size_t i = 0; i < n; i++) {
        const stf_particle p = lab_particle(world, i), q = lab_particle(small, alike(of, n, i));
        const double v[] = {(double)q.velocity.x, (double)q.velocity.y, (double)q.velocity.z};
        const double mass = q.inverse_mass > 0 ? 1 / (double)q.inverse_mass : 0; /* the immovable are left out */
        different += memcmp(&p, &q, sizeof p) != 0;
        for (int d = 0; d < STF_DIMENSIONS_MAX; d++) {
            sum[d] += mass * v[d];
            size[d] += mass * fabs(v[d]);
            kinetic += mass * v[d] * v[d] / 2;
        }
    }
    EXPECT(c, different == 0);
    MUST(stf_world_momentum(world, momentum));
    MUST(stf_world_energy(world, &energy));
    for (int d = 0; d < STF_DIMENSIONS_MAX; d++)
        EXPECT_CLOSE(c, momentum[d], sum[d], tolerance * size[d]);
    EXPECT_CLOSE(c, energy.kinetic, kinetic, 3 * tolerance * kinetic);
}

static void count(cell *c, const char *integrator, const row *at, const crowd *of)
{
    const size_t n = (size_t)at->value;
    const stf_guard none = {.mode = STF_GUARD_OFF};
    stf_world *world = world_of(c, integrator, of, n, none), *small = world_of(c, integrator, of, small_count(of, n), none);

    if (world && small) {
        MUST(stf_world_step(world, TICKS));
        MUST(stf_world_step(small, TICKS));
        EXPECT(c, stf_world_count(world) == n && stf_world_ticks(world) == TICKS);
        EXPECT(c, stf_world_time(world) == TICKS * STF_DEFAULT_STEP);
        EXPECT(c, !stf_world_find_non_finite(world, NULL));
        expect_alike(c, world, of, small);
        cell_word(c, n > 0 ? "same bits" : "nothing");
    }
    stf_world_destroy(small);
    stf_world_destroy(world);
}

static const row counts[] = {
    {"0", 0, false}, {"1", 1, false}, {"1,000", 1000, false}, {"10,000,000", 1e7, true},
};

static void count_in_flight(cell *c, const char *integrator, const row *at) { count(c, integrator, at, &in_flight); }

AXIS(axis_count) = {
    .title = "Particles in the world, falling with drag for 3 ticks",
    .holds = "Each has the bits of the same particle in a world of some twenty; momentum and energy are the sums of all; an\n"
             "empty world has neither, and its ticks and time go on.",
    ROWS(counts),
    .run = count_in_flight,
};

static void count_in_pairs(cell *c, const char *integrator, const row *at) { count(c, integrator, at, &in_pairs); }

AXIS(axis_count_pairs) = {
    .title = "Particles in the world, pulled by an attractor too, slowed by quadratic drag, and tied in pairs by springs",
    .holds = "As above: each pair has the bits of the same pair in the small world.",
    ROWS(counts),
    .run = count_in_pairs,
};

static void count_on_a_rope(cell *c, const char *integrator, const row *at) { count(c, integrator, at, &on_a_rope); }

AXIS(axis_count_rope) = {
    .title = "Particles in the world, all on one rope of springs, in two dimensions",
    .holds = "As above: the ends have the bits of those of a rope of some fifty, and the rest those of its middle.",
    ROWS(counts),
    .run = count_on_a_rope,
};

/* A user's force that pushes one particle by a NaN, which no arithmetic made, from some time on. */
typedef struct poison {
    size_t particle;
    double from; /* s */
} poison;

static void poison_apply(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const poison *p = records;
    (void)record_count;

    if (time >= p->from && p->particle >= particles->first && p->particle - particles->first < particles->count)
        particles->force[p->particle - particles->first] = (stf_real)NAN;
}

static const stf_force poison_force = {.name = "poison", .kind = STF_FIELD, .depends_on = STF_ON_TIME,
                                       .record_size = sizeof(poison), .apply = poison_apply, .fields = STF_NOT_SAVED};

#define LOOK 4                         /* ticks from one look of the guard to the next */
#define FROM (2.25 * STF_DEFAULT_STEP) /* s: methods that ask for the middle or the end meet it in tick 3, others in 4 */

/* Its like in a small world without a guard is looked at tick by tick, and says at which the last of n is lost. */
static void lose_last(cell *c, const char *integrator, const row *at)
{
    const crowd *of = &among_fields;
    const size_t n = (size_t)at->value, last = n - 1, like = alike(of, n, last);
    const stf_guard none = {.mode = STF_GUARD_OFF}, freeze = {.mode = STF_GUARD_FREEZE, .interval = LOOK};
    stf_world *world = world_of(c, integrator, of, n, freeze), *small = world_of(c, integrator, of, small_count(of, n), none);
    stf_world *good = world_of(c, integrator, of, small_count(of, n), none);
    stf_fault fault = {.tick = 0};

    if (world && small && good) {
        lab_force(world, &poison_force, &(poison){last, FROM});
        lab_force(small, &poison_force, &(poison){like, FROM});
        lab_force(good, &poison_force, &(poison){like, FROM});
        do
            MUST(stf_world_step(small, 1));
        while (!stf_world_find_non_finite(small, NULL) && stf_world_ticks(small) < LOOK);
        MUST(stf_world_step(good, (unsigned)stf_world_ticks(small) - 1));
        EXPECT(c, stf_world_step(world, LOOK) == STF_ERROR_DIVERGED && stf_world_fault(world, &fault));
        EXPECT(c, fault.particle == last && fault.tick == stf_world_ticks(small));
        EXPECT(c, stf_world_ticks(world) == stf_world_ticks(good));
        expect_alike(c, world, of, good);
        cell_tick(c, "last", fault.tick);
    }
    stf_world_destroy(good);
    stf_world_destroy(small);
    stf_world_destroy(world);
}

static const row losses[] = {{"1", 1, false}, {"1,000", 1000, false}, {"10,000,000", 1e7, true}};

AXIS(axis_count_guard) = {
    .title = "Particles in the world, pulled and slowed likewise, with a guard that looks every 4 ticks; a NaN pushes the last",
    .holds = "The guard names the last one and the tick at which its like in a small world is lost, and the world is frozen\n"
             "with the bits of the tick before.",
    ROWS(losses),
    .run = lose_last,
};
