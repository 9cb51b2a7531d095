/* Every force against its formula in the header, written out again in double; potentials; records that name particles. */
#include <math.h>
#include <string.h>

#include "support/check.h"

#define COUNT 300 /* more than a block in both precisions */

/* An integrator that shows accelerations: it puts them where the velocities were. */
static void show_acceleration(stf_system *system, stf_real dt)
{
    (void)dt;
    system->accelerate(system, system->time, system->position, system->velocity, system->work[0]);
    for (size_t i = 0; i < system->length; i++)
        system->velocity[i] = system->work[0][i];
}

static const stf_integrator peek = {.name = "peek", .step = show_acceleration, .work_arrays = 1};

typedef struct vector {
    double at[3];
} vector;

static vector vector_of(stf_vector v) { return (vector){{(double)v.x, (double)v.y, (double)v.z}}; }

static double dot(vector a, vector b) { return a.at[0] * b.at[0] + a.at[1] * b.at[1] + a.at[2] * b.at[2]; }

static vector difference(vector a, vector b)
{
    return (vector){{a.at[0] - b.at[0], a.at[1] - b.at[1], a.at[2] - b.at[2]}};
}

/* A world of random particles, the fifth of them immovable. */
static stf_world *random_world(unsigned dimensions, size_t count)
{
    stf_world *world = make_world((stf_world_def){.dimensions = dimensions, .integrator = &peek, .step = 1});
    uint64_t seed = dimensions;

    for (size_t i = 0; i < count; i++) {
        stf_real c[6] = {0};
        for (unsigned d = 0; d < dimensions; d++) {
            c[d] = (stf_real)(2 * next_random(&seed) - 1);
            c[3 + d] = (stf_real)(2 * next_random(&seed) - 1);
        }
        const stf_particle particle = {.position = {c[0], c[1], c[2]},
                                       .velocity = {c[3], c[4], c[5]},
                                       .inverse_mass = i == 4 ? 0 : (stf_real)(0.5 + next_random(&seed))};
        assert_ok(stf_world_add(world, &particle, NULL));
    }
    return world;
}

static void copy_particles(const stf_world *world, stf_particle particles[COUNT])
{
    for (size_t i = 0; i < stf_world_count(world); i++)
        particles[i] = particle_of(world, i);
}

/*
 * Steps the peeking world, and compares every particle's acceleration with force x inverse mass, within `scale` roundings
 * of a number near 1.
 */
static void check_forces(stf_world *world, const stf_particle *before, const vector *forces, double scale)
{
    assert_ok(stf_world_step(world, 1));
    for (size_t i = 0; i < stf_world_count(world); i++) {
        const vector a = vector_of(particle_of(world, i).velocity);
        for (unsigned d = 0; d < 3; d++)
            assert_close(a.at[d], forces[i].at[d] * (double)before[i].inverse_mass, scale * REAL_EPSILON);
    }
    stf_world_destroy(world);
}

static void linear_drag_is_minus_k_v(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++) {
        stf_world *world = random_world(dimensions, COUNT);
        stf_particle p[COUNT];
        vector f[COUNT];

        copy_particles(world, p);
        add_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.75});
        for (size_t i = 0; i < COUNT; i++)
            for (int d = 0; d < 3; d++)
                f[i].at[d] = -0.75 * vector_of(p[i].velocity).at[d];
        check_forces(world, p, f, 4);
    }
}

static void quadratic_drag_is_minus_c_speed_v(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++) {
        stf_world *world = random_world(dimensions, COUNT);
        stf_particle p[COUNT];
        vector f[COUNT];

        copy_particles(world, p);
        add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){(stf_real)0.75});
        for (size_t i = 0; i < COUNT; i++) {
            const vector v = vector_of(p[i].velocity);
            for (int d = 0; d < 3; d++)
                f[i].at[d] = -0.75 * sqrt(dot(v, v)) * v.at[d];
        }
        check_forces(world, p, f, 16);
    }
}

/* m mu d / (|d|^2 + e^2)^(3/2), towards the centre. */
static vector attraction(vector x, vector centre, double mass_times_strength, double softening)
{
    const vector d = difference(x, centre);
    const double square = dot(d, d) + softening * softening, factor = mass_times_strength / (square * sqrt(square));

    return (vector){{-factor * d.at[0], -factor * d.at[1], -factor * d.at[2]}};
}

static void add_to(vector *sum, vector term)
{
    for (int d = 0; d < 3; d++)
        sum->at[d] += term.at[d];
}

static void attractors_pull_by_the_inverse_square(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++) {
        const stf_attractor attractors[2] = {
            {.position = {2, dimensions > 1 ? 1 : 0, dimensions > 2 ? -1 : 0}, .strength = 3, .softening = (stf_real)0.5},
            {.position = {-2, 0, 0}, .strength = -2, .softening = (stf_real)0.25}};
        stf_world *world = random_world(dimensions, COUNT);
        stf_particle p[COUNT];
        vector f[COUNT] = {{{0}}};

        copy_particles(world, p);
        assert_ok(stf_world_add_force(world, &stf_force_attractor, attractors, 2, NULL));
        for (size_t i = 0; i < COUNT; i++)
            for (int r = 0; r < 2 && p[i].inverse_mass > 0; r++)
                add_to(&f[i], attraction(vector_of(p[i].position), vector_of(attractors[r].position),
                                         (double)attractors[r].strength / (double)p[i].inverse_mass,
                                         (double)attractors[r].softening));
        check_forces(world, p, f, 16 * 3 / 0.5); /* up to 3 / distance^2, d = 1 and more, and its relative slope */
    }
}

/* (k (l - l0) + c (w . u)) u, from b to a. */
static vector spring_force(vector d, vector w, double stiffness, double damping, double rest_length)
{
    const double length = sqrt(dot(d, d)), along = dot(w, d) / length;
    const double factor = (stiffness * (length - rest_length) + damping * along) / length;

    return (vector){{-factor * d.at[0], -factor * d.at[1], -factor * d.at[2]}};
}

static void springs_pull_both_ends_alike(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++) {
        stf_world *world = random_world(dimensions, COUNT);
        stf_particle p[COUNT];
        stf_spring springs[COUNT];
        vector f[COUNT] = {{{0}}};

        copy_particles(world, p);
        for (uint32_t s = 0; s < COUNT; s++) /* far apart in memory, and each particle in two */
            springs[s] = (stf_spring){
                .a = s, .b = (s + 137) % COUNT, .stiffness = 2, .damping = (stf_real)0.5, .rest_length = (stf_real)0.25};
        assert_ok(stf_world_add_force(world, &stf_force_springs, springs, COUNT, NULL));
        for (uint32_t s = 0; s < COUNT; s++) {
            const stf_particle *a = &p[springs[s].a], *b = &p[springs[s].b];
            vector force = spring_force(difference(vector_of(a->position), vector_of(b->position)),
                                        difference(vector_of(a->velocity), vector_of(b->velocity)), 2, 0.5, 0.25);
            add_to(&f[springs[s].a], force);
            for (int d = 0; d < 3; d++)
                force.at[d] = -force.at[d];
            add_to(&f[springs[s].b], force);
        }
        /* Two forces of at most k 2 sqrt(3) + c 2 sqrt(3), and a direction that is ill-conditioned in near pairs. */
        check_forces(world, p, f, 2 * 2.5 * 2 * sqrt(3.0) * 8);
    }
}

#define WIDTH 40
#define CLOTH (WIDTH * 20)

/* A cloth with all its springs (whole runs of both ends), some of random ends, and some twice. */
static size_t cloth_springs(stf_spring springs[8 * CLOTH])
{
    static const uint32_t steps[] = {1, 2, WIDTH, 2 * WIDTH, WIDTH + 1, WIDTH - 1};
    uint64_t seed = 7;
    size_t count = 0;

    for (uint32_t i = 0; i < CLOTH; i++)
        for (size_t s = 0; s < COUNT_OF(steps); s++)
            if (i + steps[s] < CLOTH && (steps[s] >= WIDTH || i % WIDTH + steps[s] < WIDTH))
                springs[count++] = (stf_spring){.a = i, .b = i + steps[s]};
    for (size_t extra = 0; extra < CLOTH; extra++) {
        const uint32_t a = (uint32_t)(next_random(&seed) * CLOTH), b = (uint32_t)(next_random(&seed) * CLOTH);
        if (a != b)
            springs[count++] = (stf_spring){.a = a, .b = b};
    }
    springs[count++] = springs[5];
    for (size_t s = 0; s < count; s++) {
        springs[s].stiffness = (stf_real)(1 + next_random(&seed));
        springs[s].damping = (stf_real)next_random(&seed);
        springs[s].rest_length = (stf_real)next_random(&seed);
    }
    return count;
}

static void shuffle(stf_spring *springs, size_t count, uint64_t seed)
{
    for (size_t i = count; i-- > 1;) {
        const size_t other = (size_t)(next_random(&seed) * (double)(i + 1));
        const stf_spring swapped = springs[i];
        springs[i] = springs[other];
        springs[other] = swapped;
        if (i % 2) { /* which end is a changes nothing either */
            const uint32_t end = springs[i].a;
            springs[i].a = springs[i].b;
            springs[i].b = end;
        }
    }
}

/* Each spring by itself, in double. */
static void add_spring_forces(const stf_spring *springs, size_t count, const stf_particle *particles, vector *forces)
{
    for (size_t s = 0; s < count; s++) {
        const stf_particle *a = &particles[springs[s].a], *b = &particles[springs[s].b];
        const vector d = difference(vector_of(a->position), vector_of(b->position));
        const vector w = difference(vector_of(a->velocity), vector_of(b->velocity));
        const double length = sqrt(dot(d, d));
        const double pull = (double)springs[s].stiffness * (length - (double)springs[s].rest_length) +
                            (double)springs[s].damping * dot(w, d) / length;

        for (int k = 0; k < 3; k++) {
            forces[springs[s].a].at[k] -= pull * d.at[k] / length;
            forces[springs[s].b].at[k] += pull * d.at[k] / length;
        }
    }
}

/* Runs of both ends are computed as vectors, the rest one by one: what comes out is the sum over all springs. */
static void springs_of_a_cloth_add_up(void **state)
{
    (void)state;
    static stf_spring springs[8 * CLOTH];
    static stf_particle particles[CLOTH];
    static vector forces[CLOTH];

    for (unsigned dimensions = 1; dimensions <= 3; dimensions++) {
        const size_t count = cloth_springs(springs);
        stf_world *world = random_world(dimensions, CLOTH);

        memset(forces, 0, sizeof forces);
        copy_particles(world, particles);
        add_spring_forces(springs, count, particles, forces);
        assert_ok(stf_world_add_force(world, &stf_force_springs, springs, count, NULL));
        check_forces(world, particles, forces, 400); /* some 14 springs an end, each a few roundings of some newtons */
    }
}

/* A chain is one run until an end of its springs leaves its block: one end does so before the other. */
static void chains_across_blocks_add_up(void **state)
{
    (void)state;
    static const uint32_t steps[] = {1, 7, STF_BLOCK_MAX - 1, STF_BLOCK_MAX, STF_BLOCK_MAX + 1};
    static stf_spring springs[CLOTH];
    static stf_particle particles[CLOTH];
    static vector forces[CLOTH];

    for (unsigned dimensions = 1; dimensions <= 3; dimensions++)
        for (size_t k = 0; k < COUNT_OF(steps); k++) {
            stf_world *world = random_world(dimensions, CLOTH);
            size_t count = 0;

            for (uint32_t i = 0; i + steps[k] < CLOTH; i++)
                springs[count++] = (stf_spring){.a = i, .b = i + steps[k], .stiffness = 1, .damping = (stf_real)0.5};
            memset(forces, 0, sizeof forces);
            copy_particles(world, particles);
            add_spring_forces(springs, count, particles, forces);
            assert_ok(stf_world_add_force(world, &stf_force_springs, springs, count, NULL));
            check_forces(world, particles, forces, 2 * 1.5 * 2 * sqrt(3.0) * 8); /* as above: two springs of k = 1, c = 0.5 */
        }
}

/* The most pieces that so many springs can fall into: a shortest run and a loose spring in every block. */
static void a_run_and_a_loose_spring_in_every_block_add_up(void **state)
{
    (void)state;
    enum { SHORTEST_RUN = 16, BLOCKS = 9, ALL = BLOCKS * STF_BLOCK_MAX };
    static stf_spring springs[BLOCKS * (SHORTEST_RUN + 1)];
    static stf_particle particles[ALL];
    static vector forces[ALL];
    stf_world *world = random_world(3, ALL);
    size_t count = 0;

    for (uint32_t block = 0; block < BLOCKS; block++) {
        const uint32_t first = block * STF_BLOCK_MAX;
        for (uint32_t i = 0; i < SHORTEST_RUN; i++)
            springs[count++] = (stf_spring){.a = first + i, .b = first + i + 1, .stiffness = 1, .damping = (stf_real)0.5};
        springs[count++] = (stf_spring){.a = first, .b = first + 90, .stiffness = 1, .damping = (stf_real)0.5};
    }
    copy_particles(world, particles);
    add_spring_forces(springs, count, particles, forces);
    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, count, NULL));
    check_forces(world, particles, forces, 2 * 1.5 * 2 * sqrt(3.0) * 8);
}

/* Loose springs stand by groups of 32 blocks: here from each group to every block. */
static void loose_springs_of_several_groups_add_up(void **state)
{
    (void)state;
    enum { BLOCKS = 70, ALL = BLOCKS * STF_BLOCK_MAX, APART = 31 /* no divisor of ALL: every particle is each end once */ };
    static stf_spring springs[ALL];
    static stf_particle particles[ALL];
    static vector forces[ALL];
    stf_world *world = random_world(3, ALL);
    size_t count = 0;

    for (uint32_t i = 0; i < ALL; i++) {
        const uint32_t other = (i * APART + 17) % ALL;
        if (other != i)
            springs[count++] = (stf_spring){.a = i, .b = other, .stiffness = 1, .damping = (stf_real)0.5};
    }
    copy_particles(world, particles);
    add_spring_forces(springs, count, particles, forces);
    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, count, NULL));
    check_forces(world, particles, forces, 2 * 1.5 * 2 * sqrt(3.0) * 8);
}

static void the_order_of_springs_changes_no_bit(void **state)
{
    (void)state;
    static stf_spring springs[8 * CLOTH];
    static stf_particle first[CLOTH];
    const size_t count = cloth_springs(springs);

    for (uint64_t seed = 0; seed < 4; seed++) {
        stf_world *world = random_world(3, CLOTH);

        if (seed > 0)
            shuffle(springs, count, seed);
        assert_ok(stf_world_add_force(world, &stf_force_springs, springs, count, NULL));
        assert_ok(stf_world_step(world, 1));
        for (size_t i = 0; i < CLOTH; i++) {
            const stf_particle particle = particle_of(world, i);
            if (seed == 0)
                first[i] = particle;
            assert_memory_equal(&particle, &first[i], sizeof particle);
        }
        stf_world_destroy(world);
    }
}

/* The sum of forces is rounded in the order of the records: also that of springs of the same ends. */
static void springs_of_the_same_ends_are_kept_in_one_order(void **state)
{
    (void)state;
    enum { TWINS = 6, TURNED = 3 };
    stf_spring springs[TWINS], first[TWINS];
    stf_world *world = random_world(3, 2);
    stf_force_id id;
    size_t count;
    uint64_t seed = 4;

    for (size_t s = 0; s < TWINS; s++) /* pairs that differ in one field each, the last in none */
        springs[s] = (stf_spring){.a = s == TURNED, .b = s != TURNED,
                                  .stiffness = s == 0, .damping = s == 1, .rest_length = s == 2};
    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, TWINS, &id));
    memcpy(first, stf_world_force_records(world, id, &count), sizeof first);
    for (int round = 0; round < 50; round++) {
        for (size_t s = TWINS - 1; s > 0; s--) {
            const size_t other = (size_t)(next_random(&seed) * (double)(s + 1));
            const stf_spring kept = springs[s];
            springs[s] = springs[other];
            springs[other] = kept;
        }
        assert_ok(stf_world_set_force(world, id, springs, TWINS));
        assert_memory_equal(stf_world_force_records(world, id, &count), first, sizeof first);
    }
    stf_world_destroy(world);
}

/* Springs keep their order through removals, so that a world that lost particles is as one that never had them. */
static void removals_leave_springs_in_order(void **state)
{
    (void)state;
    static stf_spring springs[8 * CLOTH];
    const size_t count = cloth_springs(springs);
    stf_world *thinned = random_world(3, CLOTH), *fresh = make_world((stf_world_def){.integrator = &peek, .step = 1});
    stf_force_id id;

    shuffle(springs, count, 3);
    assert_ok(stf_world_add_force(thinned, &stf_force_springs, springs, count, &id));
    for (size_t i = 0; i < 50; i++)
        assert_ok(stf_world_remove(thinned, i * 13, NULL));

    size_t left;
    const void *records = stf_world_force_records(thinned, id, &left);
    for (size_t i = 0; i < stf_world_count(thinned); i++) {
        const stf_particle particle = particle_of(thinned, i);
        assert_ok(stf_world_add(fresh, &particle, NULL));
    }
    assert_true(left > 0 && left < count);
    assert_ok(stf_world_add_force(fresh, &stf_force_springs, records, left, NULL));
    assert_memory_equal(stf_world_force_records(fresh, 1, NULL), records, left * sizeof(stf_spring));
    assert_ok(stf_world_step(thinned, 1));
    assert_ok(stf_world_step(fresh, 1));
    for (size_t i = 0; i < stf_world_count(thinned); i++) {
        const stf_particle a = particle_of(thinned, i), b = particle_of(fresh, i);
        assert_memory_equal(&a, &b, sizeof a);
    }
    stf_world_destroy(thinned);
    stf_world_destroy(fresh);
}

static void anchored_springs_pull_to_their_anchors_in_any_order(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++) {
        stf_world *world = random_world(dimensions, COUNT);
        stf_particle p[COUNT];
        stf_anchored_spring springs[2 * COUNT];
        vector f[COUNT] = {{{0}}};

        copy_particles(world, p);
        for (uint32_t s = 0; s < 2 * COUNT; s++) /* two for each particle, far from sorted */
            springs[s] = (stf_anchored_spring){.particle = (s * 77) % COUNT,
                                               .anchor = {s % 2 ? 3 : -3, dimensions > 1 ? 2 : 0, dimensions > 2 ? 1 : 0},
                                               .stiffness = 2,
                                               .damping = (stf_real)0.5,
                                               .rest_length = (stf_real)0.25};
        assert_ok(stf_world_add_force(world, &stf_force_anchored_springs, springs, 2 * COUNT, NULL));
        for (uint32_t s = 0; s < 2 * COUNT; s++) {
            const stf_particle *a = &p[springs[s].particle];
            add_to(&f[springs[s].particle],
                   spring_force(difference(vector_of(a->position), vector_of(springs[s].anchor)), vector_of(a->velocity), 2,
                                0.5, 0.25));
        }
        check_forces(world, p, f, 2 * 2.5 * 6 * 8);
    }
}

static void all_pairs_gravity_is_the_sum_over_all_others(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++) {
        stf_world *world = random_world(dimensions, COUNT);
        stf_particle p[COUNT];
        vector f[COUNT] = {{{0}}};

        copy_particles(world, p);
        add_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){(stf_real)0.125, (stf_real)0.5});
        for (size_t i = 0; i < COUNT; i++)
            for (size_t j = 0; j < COUNT; j++) {
                const double product = (double)p[i].inverse_mass * (double)p[j].inverse_mass;
                if (i != j && product > 0)
                    add_to(&f[i], attraction(vector_of(p[i].position), vector_of(p[j].position), 0.125 / product, 0.5));
            }
        /* 300 terms of at most G m 2 / (3 sqrt(3) e^2) = 0.4 each, rounded as their sum grows. */
        check_forces(world, p, f, 300 * 0.4 * 8);
    }
}

/* Two records of one force push as one record each of two. */
static void every_record_of_a_force_counts(void **state)
{
    (void)state;
    const stf_linear_drag linear[] = {{(stf_real)0.5}, {(stf_real)0.3}};
    const stf_quadratic_drag quadratic[] = {{(stf_real)0.5}, {(stf_real)0.3}};
    const stf_attractor attractors[] = {{.strength = 2, .softening = 1},
                                        {.position = {1, 0, 0}, .strength = 3, .softening = 1}};
    const stf_all_pairs_gravity gravity[] = {{1, 1}, {(stf_real)0.3, 2}};
    const stf_force *const forces[] = {&stf_force_linear_drag, &stf_force_quadratic_drag, &stf_force_attractor,
                                       &stf_force_all_pairs_gravity};
    const void *const records[][2] = {
        {&linear[0], &linear[1]}, {&quadratic[0], &quadratic[1]}, {&attractors[0], &attractors[1]}, {&gravity[0], &gravity[1]}};

    for (unsigned dimensions = 1; dimensions <= 3; dimensions++)
        for (size_t k = 0; k < COUNT_OF(forces); k++) {
            stf_world *one = random_world(dimensions, COUNT), *two = random_world(dimensions, COUNT);

            assert_ok(stf_world_add_force(one, forces[k], records[k][0], 2, NULL));
            add_force(two, forces[k], records[k][0]);
            add_force(two, forces[k], records[k][1]);
            assert_ok(stf_world_step(one, 1));
            assert_ok(stf_world_step(two, 1));
            for (size_t i = 0; i < COUNT; i++) {
                const stf_particle a = particle_of(one, i), b = particle_of(two, i);
                assert_memory_equal(&a, &b, sizeof a);
            }
            stf_world_destroy(one);
            stf_world_destroy(two);
        }
}

/* Where a formula has no value the force is 0, and the state stays finite. */
/* What a particle feels does not depend on what it does: one so light that G m is 0 still falls, wherever it stands. */
static void the_lightest_particles_feel_every_other(void **state)
{
    (void)state;
    const stf_real tiny = (stf_real)(sqrt((double)REAL_LEAST) * 1e-10);
    const stf_all_pairs_gravity gravity = {.gravitational_constant = tiny};
    double felt[2] = {0, 0};

    for (size_t light = 0; light < 2; light++) {
        stf_world *world = make_world((stf_world_def){.dimensions = 1, .integrator = &peek, .step = 1});
        const size_t index = light == 0 ? 3 : COUNT - 1; /* in the first block, and in the last */

        for (size_t i = 0; i < COUNT; i++)
            assert_ok(stf_world_add(world, &(stf_particle){.position = {i == index ? 0 : 1 + (stf_real)(i % 7), 0, 0},
                                                           .inverse_mass = i == index ? 1 / tiny : tiny}, NULL));
        add_force(world, &stf_force_all_pairs_gravity, &gravity);
        assert_ok(stf_world_step(world, 1));
        felt[light] = (double)particle_of(world, index).velocity.x;
        stf_world_destroy(world);
    }
    assert_above(felt[0], 1);
    assert_close(felt[1] / felt[0], 1, 0.05); /* other sevenths of the others */
}

/* Every particle is 0 from itself, whatever the softening; an attractor's centre is as well. */
static void a_tiny_softening_makes_no_infinity_of_nothing(void **state)
{
    (void)state;
    const stf_real tiny = (stf_real)(sqrt((double)REAL_LEAST) * 10);
    stf_world *world = make_world((stf_world_def){.integrator = &peek, .step = 1});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = (stf_real)1e-20}, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.position = {2, 0, 0}, .inverse_mass = 1}, NULL));
    add_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){.gravitational_constant = 1, .softening = tiny});
    add_force(world, &stf_force_attractor, &(stf_attractor){.strength = (stf_real)1e20, .softening = tiny});
    assert_ok(stf_world_step(world, 1));
    assert_true(particle_of(world, 0).velocity.x >= 0);
    assert_below(particle_of(world, 0).velocity.x, 1);
    stf_world_destroy(world);
}

static void coincidence_pulls_nowhere(void **state)
{
    (void)state;
    const stf_particle both = {.position = {1, 2, 3}, .inverse_mass = 1};
    const stf_spring spring = {.a = 0, .b = 1, .stiffness = 5, .damping = 1, .rest_length = 2};
    const stf_anchored_spring anchored = {.particle = 0, .anchor = {1, 2, 3}, .stiffness = 5, .damping = 1, .rest_length = 2};
    const stf_attractor attractor = {.position = {1, 2, 3}, .strength = 9};
    const stf_all_pairs_gravity gravity = {.gravitational_constant = 1};
    const stf_force *const forces[] = {&stf_force_springs, &stf_force_anchored_springs, &stf_force_attractor,
                                       &stf_force_all_pairs_gravity};
    const void *const records[] = {&spring, &anchored, &attractor, &gravity};
    const double potentials[] = {5 * 2 * 2 / 2.0, 5 * 2 * 2 / 2.0, 0, 0};

    for (size_t k = 0; k < COUNT_OF(forces); k++) {
        stf_world *world = make_world((stf_world_def){.integrator = &peek, .step = 1});
        stf_energy energy;

        assert_ok(stf_world_add(world, &both, NULL));
        assert_ok(stf_world_add(world, &both, NULL));
        add_force(world, forces[k], records[k]);
        assert_ok(stf_world_energy(world, &energy));
        assert_true(energy.potential == potentials[k]);
        assert_ok(stf_world_step(world, 1));
        for (size_t i = 0; i < 2; i++) {
            const vector a = vector_of(particle_of(world, i).velocity);
            assert_true(a.at[0] == 0 && a.at[1] == 0 && a.at[2] == 0);
        }
        stf_world_destroy(world);
    }
}

/* The forces that the next tests try in turn, on a world of dimension 2. */
typedef struct example {
    const stf_force *force;
    const void *records;
    size_t count;
} example;

static const stf_linear_drag linear = {(stf_real)0.5};
static const stf_quadratic_drag quadratic = {(stf_real)0.5};
static const stf_attractor attractor_example[] = {{{3, 1, 0}, 2, (stf_real)0.5}};
static const stf_anchored_spring anchored_example[] = {{2, {2, 2, 0}, 3, (stf_real)0.5, 1}, {0, {0, 2, 0}, 3, 0, 1}};
static const stf_spring spring_example[] = {{0, 1, 3, (stf_real)0.5, 1}, {1, 2, 3, 0, (stf_real)0.25}};
static const stf_all_pairs_gravity gravity_example = {2, (stf_real)0.5};

static const example examples[] = {
    {&stf_force_linear_drag, &linear, 1},          {&stf_force_quadratic_drag, &quadratic, 1},
    {&stf_force_attractor, attractor_example, 1},  {&stf_force_anchored_springs, anchored_example, 2},
    {&stf_force_springs, spring_example, 2},       {&stf_force_all_pairs_gravity, &gravity_example, 1},
};

static stf_world *example_world(const example *e)
{
    stf_world *world = random_world(2, 4);

    assert_ok(stf_world_add_force(world, e->force, e->records, e->count, NULL));
    return world;
}

static double potential_at(const example *e, size_t particle, int d, double shift)
{
    stf_world *world = example_world(e);
    stf_particle moved = particle_of(world, particle);
    stf_energy energy;

    *(d == 0 ? &moved.position.x : &moved.position.y) += (stf_real)shift;
    assert_ok(stf_world_set(world, particle, &moved));
    assert_ok(stf_world_energy(world, &energy));
    stf_world_destroy(world);
    return energy.potential;
}

/*
 * Central differences err by h^2 and by round-off / h: both are eps^(2/3) at h = eps^(1/3). Third derivatives are up to
 * some 100.
 */
static void forces_at_rest_are_minus_the_gradient_of_the_potential(void **state)
{
    (void)state;
    const double h = cbrt(REAL_EPSILON);

    for (size_t k = 0; k < COUNT_OF(examples); k++) {
        if (!examples[k].force->potential)
            continue;
        for (size_t i = 0; i < 4; i++) {
            stf_world *world = example_world(&examples[k]);
            for (size_t j = 0; j < 4; j++) {
                stf_particle rest = particle_of(world, j);
                rest.velocity = (stf_vector){0, 0, 0};
                assert_ok(stf_world_set(world, j, &rest));
            }
            const double mass = 1 / (double)particle_of(world, i).inverse_mass;
            assert_ok(stf_world_step(world, 1));
            const vector a = vector_of(particle_of(world, i).velocity);
            for (int d = 0; d < 2; d++) {
                const double slope = (potential_at(&examples[k], i, d, h) - potential_at(&examples[k], i, d, -h)) / (2 * h);
                assert_close(mass * a.at[d], -slope, 100 * h * h);
            }
            stf_world_destroy(world);
        }
    }
}

static void push_with_nothing(const void *records, size_t count, const stf_particles *particles, double time)
{
    (void)records, (void)count, (void)particles, (void)time;
}

static double sum_of_speeds(const void *records, size_t count, const stf_particles *particles, double time)
{
    double sum = 0;
    (void)records, (void)count, (void)time;

    for (size_t i = 0; i < particles->count; i++)
        sum += (double)particles->velocity[stf_particles_offset(particles, i) + particles->stride];
    return sum;
}

static const stf_force speeds = {.name = "speeds", .apply = push_with_nothing, .potential = sum_of_speeds};

/*
 * Springs to the origin and to the first particle, from every block and its edges: k l^2 / 2 each, whatever block they are
 * in. And a user's potential that reads velocities.
 */
static void potentials_count_every_block_once(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 2});
    const uint32_t held[] = {1, 127, 128, 129, 255, 256, 257, COUNT - 1};
    stf_anchored_spring anchored[COUNT_OF(held)];
    stf_spring springs[COUNT_OF(held)];
    stf_energy energy;
    double expected = 0;

    for (size_t i = 0; i < COUNT; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {0, (stf_real)i, 0}, .velocity = {0, (stf_real)i, 0},
                                                       .inverse_mass = 1}, NULL));
    expected += COUNT * (COUNT - 1) / 2;
    for (size_t s = 0; s < COUNT_OF(held); s++) {
        anchored[s] = (stf_anchored_spring){.particle = held[s], .stiffness = 2};
        springs[s] = (stf_spring){.a = 0, .b = held[s], .stiffness = 4};
        expected += 3 * (double)held[s] * (double)held[s];
    }
    assert_ok(stf_world_add_force(world, &stf_force_anchored_springs, anchored, COUNT_OF(held), NULL));
    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, COUNT_OF(held), NULL));
    assert_ok(stf_world_add_force(world, &speeds, NULL, 0, NULL));
    assert_ok(stf_world_energy(world, &energy));
    assert_true(energy.potential == expected); /* whole numbers */
    stf_world_destroy(world);
}

/* The accelerations of all four particles when position, velocity or time are other than in the example. */
static void accelerations_with(const example *e, unsigned changed, vector a[4])
{
    stf_world *world = example_world(e);

    for (size_t i = 0; i < 4; i++) {
        stf_particle particle = particle_of(world, i);
        if (changed & STF_ON_POSITION)
            particle.position.x += (stf_real)(0.125 * (double)(i + 1));
        if (changed & STF_ON_VELOCITY)
            particle.velocity.x += (stf_real)(0.125 * (double)(i + 1));
        assert_ok(stf_world_set(world, i, &particle));
    }
    if (changed & STF_ON_TIME) {
        assert_ok(stf_world_set_integrator(world, &stf_semi_implicit_euler));
        stf_particle particles[4];
        for (size_t i = 0; i < 4; i++)
            particles[i] = particle_of(world, i);
        assert_ok(stf_world_step(world, 5));
        for (size_t i = 0; i < 4; i++)
            assert_ok(stf_world_set(world, i, &particles[i]));
        assert_ok(stf_world_set_integrator(world, &peek));
    }
    assert_ok(stf_world_step(world, 1));
    for (size_t i = 0; i < 4; i++)
        a[i] = vector_of(particle_of(world, i).velocity);
    stf_world_destroy(world);
}

static void forces_depend_on_exactly_what_they_say(void **state)
{
    (void)state;
    const unsigned flags[] = {STF_ON_POSITION, STF_ON_VELOCITY, STF_ON_TIME};

    for (size_t k = 0; k < COUNT_OF(examples); k++)
        for (size_t f = 0; f < COUNT_OF(flags); f++) {
            vector before[4], after[4];
            bool changed = false;

            accelerations_with(&examples[k], 0, before);
            accelerations_with(&examples[k], flags[f], after);
            for (size_t i = 0; i < 4; i++)
                changed = changed || before[i].at[0] != after[i].at[0] || before[i].at[1] != after[i].at[1];
            assert_int_equal(changed, (examples[k].force->depends_on & flags[f]) != 0);
        }
}

static stf_real boundless_drag(const void *records, size_t record_count)
{
    (void)record_count;
    return *(const stf_real *)records;
}

static const stf_force boundless_force = {.name = "boundless", .record_size = sizeof(stf_real), .drag = boundless_drag};

static void immovable_particles_feel_no_drag_of_a_user_whatever_it_is(void **state)
{
    (void)state;
    const stf_real drags[] = {(stf_real)INFINITY, -(stf_real)INFINITY, (stf_real)NAN};

    for (size_t k = 0; k < COUNT_OF(drags); k++) {
        stf_world *world = make_world((stf_world_def){.step = 0.5});

        assert_ok(stf_world_add(world, &(stf_particle){.velocity = {2, 0, 0}}, NULL));
        add_force(world, &boundless_force, &drags[k]);
        assert_ok(stf_world_step(world, 2));
        const stf_particle after = particle_of(world, 0);
        assert_true(after.position.x == 2 && after.velocity.x == 2);
        stf_world_destroy(world);
    }
}

static void immovable_particles_feel_nothing_not_even_infinity(void **state)
{
    (void)state;
    const stf_particle fixed = {.position = {1, 0, 0}, .velocity = {2, 0, 0}};
    const stf_attractor at_its_place = {.position = {1, 0, 0}, .strength = REAL_MAX};
    stf_world *world = make_world((stf_world_def){.gravity = {0, -10, 0}, .step = 0.5, .integrator = &stf_rk4});

    assert_ok(stf_world_add(world, &fixed, NULL));
    add_force(world, &stf_force_attractor, &at_its_place);
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){REAL_MAX});
    assert_ok(stf_world_step(world, 4));
    const stf_particle after = particle_of(world, 0);
    assert_true(after.position.x == 5 && after.position.y == 0 && after.velocity.x == 2 && after.velocity.y == 0);
    stf_world_destroy(world);
}

static void springs_follow_their_particles_when_others_are_removed(void **state)
{
    (void)state;
    stf_world *world = random_world(2, 6);
    const stf_spring springs[] = {{0, 5, 1, 0, 0}, {1, 2, 2, 0, 0}, {5, 3, 3, 0, 0}, {4, 1, 4, 0, 0}};
    const stf_anchored_spring anchored[] = {{5, {0, 0, 0}, 1, 0, 0}, {1, {0, 0, 0}, 2, 0, 0}, {0, {0, 0, 0}, 3, 0, 0}};
    stf_force_id springs_id, anchored_id;
    size_t moved, count;

    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, 4, &springs_id));
    assert_ok(stf_world_add_force(world, &stf_force_anchored_springs, anchored, 3, &anchored_id));
    const stf_particle last = particle_of(world, 5);

    assert_ok(stf_world_remove(world, 1, &moved));
    assert_int_equal(moved, 5);
    assert_memory_equal(&(stf_real[]){particle_of(world, 1).position.x}, &last.position.x, sizeof(stf_real));

    const stf_spring *left = stf_world_force_records(world, springs_id, &count);
    assert_int_equal(count, 2);
    assert_true(left[0].a == 0 && left[0].b == 1 && left[0].stiffness == 1);
    assert_true(left[1].a == 1 && left[1].b == 3 && left[1].stiffness == 3);

    const stf_anchored_spring *held = stf_world_force_records(world, anchored_id, &count);
    assert_int_equal(count, 2);
    assert_true(held[0].particle == 0 && held[0].stiffness == 3);
    assert_true(held[1].particle == 1 && held[1].stiffness == 1);

    assert_ok(stf_world_remove(world, 4, &moved)); /* the last: nobody moves */
    assert_int_equal(moved, 4);
    assert_non_null(stf_world_force_records(world, springs_id, &count));
    assert_int_equal(count, 2);
    assert_ok(stf_world_step(world, 1));

    assert_ok(stf_world_clear(world));
    assert_null(stf_world_force_records(world, springs_id, &count));
    assert_int_equal(count, 0);
    assert_ok(stf_world_step(world, 1));
    stf_world_destroy(world);
}

static void link_forces_keep_momentum(void **state)
{
    (void)state;
    for (size_t k = 4; k < 6; k++) {
        stf_world *world = make_world((stf_world_def){.dimensions = 2, .integrator = &stf_rk4, .step = 1.0 / 64});
        double before[3], after[3];

        for (int i = 0; i < 4; i++)
            assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)i, (stf_real)(i * i) / 4, 0},
                                                           .velocity = {1, (stf_real)-i, 0},
                                                           .inverse_mass = 1 / (stf_real)(i + 1)}, NULL));
        assert_ok(stf_world_add_force(world, examples[k].force, examples[k].records, examples[k].count, NULL));
        assert_ok(stf_world_momentum(world, before));
        assert_ok(stf_world_step(world, 100));
        assert_ok(stf_world_momentum(world, after));
        for (int d = 0; d < 3; d++) /* 400 evaluations, each rounding forces of up to some 10 N over 1/64 s */
            assert_close(after[d], before[d], 400 * 10 / 64.0 * REAL_EPSILON);
        stf_world_destroy(world);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_drag_is_minus_k_v),
        cmocka_unit_test(quadratic_drag_is_minus_c_speed_v),
        cmocka_unit_test(attractors_pull_by_the_inverse_square),
        cmocka_unit_test(springs_pull_both_ends_alike),
        cmocka_unit_test(springs_of_a_cloth_add_up),
        cmocka_unit_test(chains_across_blocks_add_up),
        cmocka_unit_test(a_run_and_a_loose_spring_in_every_block_add_up),
        cmocka_unit_test(loose_springs_of_several_groups_add_up),
        cmocka_unit_test(the_order_of_springs_changes_no_bit),
        cmocka_unit_test(springs_of_the_same_ends_are_kept_in_one_order),
        cmocka_unit_test(removals_leave_springs_in_order),
        cmocka_unit_test(anchored_springs_pull_to_their_anchors_in_any_order),
        cmocka_unit_test(all_pairs_gravity_is_the_sum_over_all_others),
        cmocka_unit_test(every_record_of_a_force_counts),
        cmocka_unit_test(the_lightest_particles_feel_every_other),
        cmocka_unit_test(a_tiny_softening_makes_no_infinity_of_nothing),
        cmocka_unit_test(coincidence_pulls_nowhere),
        cmocka_unit_test(forces_at_rest_are_minus_the_gradient_of_the_potential),
        cmocka_unit_test(potentials_count_every_block_once),
        cmocka_unit_test(forces_depend_on_exactly_what_they_say),
        cmocka_unit_test(immovable_particles_feel_nothing_not_even_infinity),
        cmocka_unit_test(immovable_particles_feel_no_drag_of_a_user_whatever_it_is),
        cmocka_unit_test(springs_follow_their_particles_when_others_are_removed),
        cmocka_unit_test(link_forces_keep_momentum),
    };

    return cmocka_run_group_tests_name("force, " REAL_NAME, tests, NULL, NULL);
}
