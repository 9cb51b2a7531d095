/* Blocks change no bit: every count, in a block or out of it, alone or together, in one call or in many. */
#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"

#define LARGEST 1000
#define STEP (1.0 / 64)
#define TICKS 5

/* Rounds of all pairs of LARGEST particles: as many as blocks, which are an even number. */
#define ROUNDS ((LARGEST + STF_BLOCK_MAX - 1) / STF_BLOCK_MAX)

static stf_particle random_particle(unsigned dimensions, uint64_t *seed)
{
    stf_real c[6] = {0};

    for (unsigned d = 0; d < dimensions; d++) {
        c[d] = (stf_real)(2 * next_random(seed) - 1);
        c[3 + d] = (stf_real)(2 * next_random(seed) - 1);
    }
    return (stf_particle){.position = {c[0], c[1], c[2]},
                          .velocity = {c[3], c[4], c[5]},
                          .inverse_mass = next_random(seed) < 0.1 ? 0 : (stf_real)(0.5 + next_random(seed))};
}

/* Every kind of field force, and one of time: nothing that ties particles together. */
static stf_world *field_world(unsigned dimensions, const stf_integrator *integrator, unsigned substeps)
{
    stf_world *world = make_world((stf_world_def){.dimensions = dimensions,
                                                  .integrator = integrator,
                                                  .step = STEP,
                                                  .substeps = substeps,
                                                  .gravity = {-1, 0, 0}});

    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.5});
    add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){(stf_real)0.25});
    add_force(world, &stf_force_attractor, &(stf_attractor){.position = {2, 0, 0}, .strength = 1});
    add_force(world, &time_force, NULL);
    return world;
}

static const size_t counts[] = {0, 1, 2, 15, 16, 17, 31, 32, 33, 63, 64, 65, 127, 128, 129, 255, 256, 257, 383, 384, 385,
                                511, 512, 513, LARGEST};

static bool same_bits(const stf_world *a, size_t i, const stf_world *b, size_t j)
{
    const stf_particle p = particle_of(a, i), q = particle_of(b, j);

    return memcmp(&p.position, &q.position, sizeof p.position) == 0 &&
           memcmp(&p.velocity, &q.velocity, sizeof p.velocity) == 0;
}

static void assert_same_particles(const stf_world *a, const stf_world *b)
{
    assert_int_equal(stf_world_count(a), stf_world_count(b));
    for (size_t i = 0; i < stf_world_count(a); i++)
        assert_true(same_bits(a, i, b, i));
}

static void a_particle_moves_alike_alone_and_in_every_count(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++)
        for (int k = 0; stf_integrators[k]; k++) {
            stf_world *alone[LARGEST];
            uint64_t seed = 1;
            stf_particle particles[LARGEST];

            for (size_t i = 0; i < LARGEST; i++) {
                particles[i] = random_particle(dimensions, &seed);
                alone[i] = field_world(dimensions, stf_integrators[k], 1);
                assert_ok(stf_world_add(alone[i], &particles[i], NULL));
                assert_ok(stf_world_step(alone[i], TICKS));
            }
            for (size_t c = 0; c < COUNT_OF(counts); c++) {
                stf_world *together = field_world(dimensions, stf_integrators[k], 1);

                assert_ok(stf_world_add_many(together, particles, counts[c], NULL));
                assert_ok(stf_world_step(together, TICKS));
                for (size_t i = 0; i < counts[c]; i++)
                    assert_true(same_bits(together, i, alone[i], 0));
                stf_world_destroy(together);
            }
            for (size_t i = 0; i < LARGEST; i++)
                stf_world_destroy(alone[i]);
        }
}

static stf_world *filled_world(const stf_integrator *integrator, size_t count, unsigned substeps)
{
    stf_world *world = field_world(3, integrator, substeps);
    uint64_t seed = 2;

    for (size_t i = 0; i < count; i++) {
        const stf_particle particle = random_particle(3, &seed);
        assert_ok(stf_world_add(world, &particle, NULL));
    }
    return world;
}

static void block_stepping_equals_whole_world_stepping(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++)
        for (size_t c = 0; c < COUNT_OF(counts); c++)
            for (unsigned substeps = 1; substeps <= 3; substeps += 2) {
                stf_world *blocks = filled_world(stf_integrators[k], counts[c], substeps);
                stf_world *whole = filled_world(stf_integrators[k], counts[c], substeps);

                add_force(whole, &idle_link, NULL);
                assert_ok(stf_world_step(blocks, TICKS));
                assert_ok(stf_world_step(whole, TICKS));
                assert_same_particles(blocks, whole);
                stf_world_destroy(blocks);
                stf_world_destroy(whole);
            }
}

/* Pushes nothing, but has a loop. */
static void push_nothing(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)particles, (void)time;
}

static const stf_force idle_field = {.name = "idle field", .apply = push_nothing};

/* The library's drag, and one of the user's own: both are written into the loop. */
static stf_real twice_the_record(const void *records, size_t record_count)
{
    (void)record_count;
    return 2 * *(const stf_real *)records;
}

static const stf_force twice_drag = {.name = "twice", .record_size = sizeof(stf_real), .drag = twice_the_record};

static stf_world *flying_world(const stf_integrator *integrator, size_t count, const stf_force *drag)
{
    stf_world *world = make_world((stf_world_def){
        .integrator = integrator, .step = STEP, .substeps = 2, .gravity = {1, -9, (stf_real)0.3}, .keep_previous = true});
    const stf_real coefficient = (stf_real)0.7;
    uint64_t seed = count;

    for (size_t i = 0; i < count; i++) {
        stf_particle particle = random_particle(3, &seed);
        if (i % 5 == 4)
            particle.inverse_mass = 0;
        assert_ok(stf_world_add(world, &particle, NULL));
    }
    if (drag)
        add_force(world, drag, &coefficient);
    return world;
}

/* A world where nothing acts but gravity and drag is stepped in one pass. That has to be seen nowhere but on the clock. */
static void flight_changes_no_bit(void **state)
{
    (void)state;
    const stf_force *const drags[] = {NULL, &stf_force_linear_drag, &twice_drag};

    for (int k = 0; stf_integrators[k]; k++)
        for (size_t c = 0; c < COUNT_OF(counts); c++)
            for (size_t f = 0; f < COUNT_OF(drags); f++) {
                stf_world *flying = flying_world(stf_integrators[k], counts[c], drags[f]);
                stf_world *stepping = flying_world(stf_integrators[k], counts[c], drags[f]);

                add_force(stepping, &idle_field, NULL);
                for (unsigned ticks = 0; ticks <= 3; ticks++) {
                    assert_ok(stf_world_step(flying, ticks));
                    assert_ok(stf_world_step(stepping, ticks));
                    assert_same_particles(flying, stepping);
                    if (ticks == 2 && counts[c] > 1) {
                        const stf_particle set = particle_of(flying, 1);
                        assert_ok(stf_world_set(flying, 1, &set));
                        assert_ok(stf_world_set(stepping, 1, &set));
                    }
                }
                stf_world_destroy(flying);
                stf_world_destroy(stepping);
            }
}

static void run_and_count(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    for (unsigned i = 0; i < tasks; i++)
        task(context, i);
    ++*(unsigned *)user;
}

static void user_drag_is_twice_its_record(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 0.25});

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {4, 0, 0}, .inverse_mass = (stf_real)0.5}, NULL));
    add_force(world, &twice_drag, &(stf_real){1});
    assert_ok(stf_world_step(world, 1));
    assert_true(particle_of(world, 0).velocity.x == 3); /* 4 - 0.25 x 2 x 0.5 x 4 */
    stf_world_destroy(world);
}

/* What became of each particle of a world that is stepped in so many parts; the parts run in an order that the seed shuffles. */
static void run_shuffled(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    unsigned order[64];
    uint64_t *seed = user;

    assert_true(tasks > 1 && tasks <= COUNT_OF(order));
    for (unsigned i = 0; i < tasks; i++) {
        const unsigned other = (unsigned)(next_random(seed) * (i + 1));
        order[i] = order[other];
        order[other] = i;
    }
    for (unsigned i = 0; i < tasks; i++)
        task(context, order[i]);
}

static stf_world *tied_world(const stf_integrator *integrator, size_t count, const stf_force *link, stf_parallel parallel)
{
    stf_world *world = make_world((stf_world_def){.integrator = integrator, .step = STEP, .parallel = parallel});
    const stf_all_pairs_gravity gravity = {.gravitational_constant = (stf_real)0.01, .softening = 1};
    uint64_t seed = count;

    for (size_t i = 0; i < count; i++) {
        const stf_particle particle = random_particle(3, &seed);
        assert_ok(stf_world_add(world, &particle, NULL));
    }
    add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 1, .softening = 1});
    add_force(world, link, link == &stf_force_all_pairs_gravity ? &gravity : NULL);
    return world;
}

/* An engine's thread pool may run one job at a time, and any number of threads may read a world. */
static void reading_a_world_uses_no_threads(void **state)
{
    (void)state;
    unsigned calls = 0;
    const stf_parallel counted = {.run = run_and_count, .tasks = 4, .user = &calls};
    stf_world *world = tied_world(&stf_rk4, LARGEST, &stf_force_all_pairs_gravity, counted);
    const stf_particles view = stf_world_view(world);
    stf_real *a = calloc((view.count + view.stride) * view.dimensions, sizeof *a);

    assert_non_null(a);
    assert_ok(stf_world_accelerations(world, 0, view.position, view.velocity, a));
    assert_int_equal(calls, 0);
    assert_ok(stf_world_step(world, 1));
    assert_int_equal(calls, 4 * (1 + ROUNDS + 1) + 4); /* accelerations and loops of RK4 */
    free(a);
    stf_world_destroy(world);
}

/* Each record is a real, their sum need not be: 0 times an infinity would be no number. */
static void drags_that_overflow_leave_the_immovable_alone(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = STEP});
    const stf_linear_drag drags[] = {{REAL_MAX}, {REAL_MAX}};

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 0, 0}}, NULL));
    assert_ok(stf_world_add_force(world, &stf_force_linear_drag, drags, COUNT_OF(drags), NULL));
    assert_ok(stf_world_step(world, 2));
    assert_true(particle_of(world, 0).position.x == (stf_real)(2 * STEP));
    assert_true(stf_world_view(world).position[1] == 0);
    stf_world_destroy(world);
}

static void parts_change_no_bit(void **state)
{
    (void)state;
    const stf_force *const links[] = {&idle_link, &stf_force_all_pairs_gravity};

    for (int k = 0; stf_integrators[k]; k++)
        for (size_t l = 0; l < COUNT_OF(links); l++)
            for (unsigned tasks = 2; tasks <= 7; tasks += 5) {
                uint64_t seed = tasks;
                const stf_parallel shuffled = {.run = run_shuffled, .tasks = tasks, .user = &seed};
                stf_world *alone = tied_world(stf_integrators[k], LARGEST, links[l], (stf_parallel){.tasks = 0});
                stf_world *split = tied_world(stf_integrators[k], LARGEST, links[l], shuffled);

                assert_ok(stf_world_step(alone, 2));
                assert_ok(stf_world_step(split, 2));
                assert_true(seed != tasks); /* it was split */
                assert_same_particles(alone, split);
                stf_world_destroy(alone);
                stf_world_destroy(split);
            }
}

/* Two whole calls of a flight, blocks that are left over, and enough for several parts. */
#define MANY (20 * (size_t)STF_BLOCK_MAX + 5)

/* What acts decides how a world is stepped: nothing, a field or a link. */
static stf_world *large_world(const stf_integrator *integrator, const stf_force *acting, stf_parallel parallel)
{
    stf_world *world = make_world((stf_world_def){.integrator = integrator, .step = STEP, .substeps = 2, .gravity = {1, -9, 2},
                                                  .keep_previous = true, .parallel = parallel});
    uint64_t seed = 6;

    assert_ok(stf_world_reserve(world, MANY));
    for (size_t i = 0; i < MANY; i++) {
        const stf_particle particle = random_particle(3, &seed);
        assert_ok(stf_world_add(world, &particle, NULL));
    }
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.7});
    if (acting)
        add_force(world, acting, NULL);
    return world;
}

static void assert_same_previous(const stf_world *a, const stf_world *b)
{
    static float of_a[3 * MANY], of_b[3 * MANY];

    assert_ok(stf_world_copy_positions(a, 0, of_a, 0));
    assert_ok(stf_world_copy_positions(b, 0, of_b, 0));
    assert_memory_equal(of_a, of_b, sizeof of_a);
}

static void flight_of_many_blocks_changes_no_bit(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        uint64_t seed = 1;
        stf_world *flying = large_world(stf_integrators[k], NULL, (stf_parallel){.tasks = 0});
        stf_world *split =
            large_world(stf_integrators[k], NULL, (stf_parallel){.run = run_shuffled, .tasks = 3, .user = &seed});
        stf_world *stepping = large_world(stf_integrators[k], &idle_field, (stf_parallel){.tasks = 0});

        for (unsigned ticks = 1; ticks <= 2; ticks++) {
            assert_ok(stf_world_step(flying, ticks));
            assert_ok(stf_world_step(split, ticks));
            assert_ok(stf_world_step(stepping, ticks));
            assert_same_particles(flying, stepping);
            assert_same_particles(split, stepping);
        }
        assert_true(seed != 1); /* it was split */
        stf_world_destroy(flying);
        stf_world_destroy(split);
        stf_world_destroy(stepping);
    }
}

/* Blocks that are stepped by themselves, under a force of time. */
static void parts_of_loose_blocks_change_no_bit(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++)
        for (unsigned tasks = 2; tasks <= 4; tasks++) {
            uint64_t seed = 1;
            const stf_parallel shuffled = {.run = run_shuffled, .tasks = tasks, .user = &seed};
            stf_world *alone = large_world(stf_integrators[k], &time_force, (stf_parallel){.tasks = 0});
            stf_world *split = large_world(stf_integrators[k], &time_force, shuffled);

            assert_ok(stf_world_step(alone, 2));
            assert_ok(stf_world_step(split, 2));
            assert_true(seed != 1); /* it was split */
            assert_same_particles(alone, split);
            stf_world_destroy(alone);
            stf_world_destroy(split);
        }
}

/* Pushes every particle, whatever its part is: so says a link that does not say that it splits. */
static void push_all(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)time;
    for (size_t i = 0; i < particles->count; i++)
        particles->force[stf_particles_offset(particles, i)] += 1;
}

static void a_link_of_the_user_is_called_once_for_all_parts(void **state)
{
    (void)state;
    static const stf_force pusher = {.name = "pusher", .kind = STF_LINK, .apply = push_all};
    uint64_t seed = 1;
    stf_world *world = make_world(
        (stf_world_def){.step = 1, .parallel = {.run = run_shuffled, .tasks = 3, .user = &seed}});

    for (size_t i = 0; i < LARGEST; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    add_force(world, &pusher, NULL);
    assert_ok(stf_world_step(world, 1));
    assert_true(seed != 1); /* it was split */
    for (size_t i = 0; i < LARGEST; i++)
        assert_true(particle_of(world, i).velocity.x == 1);
    stf_world_destroy(world);
}

/* However a world is stepped, alpha 0 is where every particle was a tick ago. */
static void previous_positions_are_those_of_the_tick_before(void **state)
{
    (void)state;
    const stf_force *const acting[] = {NULL, &idle_field, &idle_link};
    static float before[3 * MANY], previous[3 * MANY];

    for (size_t f = 0; f < COUNT_OF(acting); f++)
        for (unsigned tasks = 0; tasks <= 3; tasks += 3) {
            uint64_t seed = 1;
            const stf_parallel parallel = {.run = tasks ? run_shuffled : NULL, .tasks = tasks, .user = &seed};
            stf_world *world = large_world(&stf_rk4, acting[f], parallel);
            stf_world *behind = large_world(&stf_rk4, acting[f], parallel);

            assert_ok(stf_world_step(world, 3));
            assert_ok(stf_world_step(behind, 2));
            assert_ok(stf_world_copy_positions(behind, 1, before, 0));
            assert_ok(stf_world_copy_positions(world, 0, previous, 0));
            assert_memory_equal(previous, before, sizeof previous);
            assert_ok(stf_world_step(behind, 1));
            assert_same_previous(world, behind);
            stf_world_destroy(world);
            stf_world_destroy(behind);
        }
}

/* Springs as whole runs and loose, whose ends are in the same part and in two. */
static stf_world *spring_world(unsigned dimensions, stf_parallel parallel)
{
    static const uint32_t steps[] = {1, 40, LARGEST / 2};
    static stf_spring springs[(COUNT_OF(steps) + 1) * LARGEST];
    stf_world *world = make_world((stf_world_def){.dimensions = dimensions, .step = STEP, .parallel = parallel});
    uint64_t seed = dimensions;
    size_t count = 0;

    for (uint32_t i = 0; i < LARGEST; i++) {
        const stf_particle particle = random_particle(dimensions, &seed);
        assert_ok(stf_world_add(world, &particle, NULL));
        for (size_t s = 0; s < COUNT_OF(steps); s++)
            if (i + steps[s] < LARGEST)
                springs[count++] = (stf_spring){.a = i, .b = i + steps[s]};
        const uint32_t other = (uint32_t)(next_random(&seed) * LARGEST);
        if (other != i)
            springs[count++] = (stf_spring){.a = i, .b = other};
    }
    for (size_t s = 0; s < count; s++) {
        springs[s].stiffness = (stf_real)next_random(&seed);
        springs[s].damping = (stf_real)next_random(&seed);
        springs[s].rest_length = (stf_real)next_random(&seed);
    }
    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, count, NULL));
    return world;
}

static void fail_if_called(const void *records, size_t record_count, const stf_particles *all, double time)
{
    (void)records, (void)all, (void)time;
    fail_msg("called with %zu records", record_count);
}

static const stf_force asleep = {.name = "asleep", .kind = STF_LINK, .record_size = 1, .apply = fail_if_called};

static void parts_pull_each_end_of_a_spring_once(void **state)
{
    (void)state;
    for (unsigned dimensions = 1; dimensions <= 3; dimensions++)
        for (unsigned tasks = 2; tasks <= 7; tasks++) {
            uint64_t seed = tasks;
            stf_world *alone = spring_world(dimensions, (stf_parallel){.tasks = 0});
            stf_world *split = spring_world(dimensions, (stf_parallel){.run = run_shuffled, .tasks = tasks, .user = &seed});

            if (tasks % 2 == 0) { /* beside a link that does not split all fields come first, then link after link */
                add_force(split, &idle_link, NULL);
                assert_ok(stf_world_add_force(split, &asleep, NULL, 0, NULL));
            }
            assert_ok(stf_world_step(alone, 2));
            assert_ok(stf_world_step(split, 2));
            assert_true(seed != tasks); /* it was split */
            assert_same_particles(alone, split);
            stf_world_destroy(alone);
            stf_world_destroy(split);
        }
}

/* The scratch that each part of a step was given, as the integrator below sees it. */
#define SCRATCH_ARRAYS 2
#define SCRATCH_PARTS 5
static struct {
    unsigned part;
    const stf_real *begin[SCRATCH_PARTS * SCRATCH_ARRAYS], *end[SCRATCH_PARTS * SCRATCH_ARRAYS];
} scratch;

static void fill_scratch(stf_system *system, stf_real dt)
{
    for (size_t k = 0; k < SCRATCH_ARRAYS; k++) {
        for (size_t i = 0; i < system->length; i++)
            system->work[k][i] = dt;
        scratch.begin[scratch.part * SCRATCH_ARRAYS + k] = system->work[k];
        scratch.end[scratch.part * SCRATCH_ARRAYS + k] = system->work[k] + system->length;
    }
}

static void run_and_say_which(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    assert_int_equal(tasks, SCRATCH_PARTS);
    for (scratch.part = 0; scratch.part < tasks; scratch.part++)
        task(context, scratch.part);
}

/* Parts may run at the same time, so no two may write to the same place; nor may they write over particles. */
static void parts_have_scratch_of_their_own(void **state)
{
    (void)state;
    const stf_integrator filler = {.name = "filler", .step = fill_scratch, .work_arrays = SCRATCH_ARRAYS};
    const stf_parallel parallel = {.run = run_and_say_which, .tasks = SCRATCH_PARTS};
    stf_world *world = large_world(&filler, NULL, parallel), *still = large_world(&filler, NULL, (stf_parallel){.tasks = 0});

    memset(&scratch, 0, sizeof scratch);
    assert_ok(stf_world_step(world, 1));
    for (size_t a = 0; a < COUNT_OF(scratch.begin); a++) {
        assert_non_null(scratch.begin[a]);
        for (size_t b = 0; b < a; b++)
            assert_true(scratch.end[a] <= scratch.begin[b] || scratch.end[b] <= scratch.begin[a]);
    }
    assert_same_particles(world, still);
    stf_world_destroy(world);
    stf_world_destroy(still);
}

/* A link that keeps to its part needs no other part to be done; for one that does not all fields come first, then all links. */
static void links_of_the_library_run_within_the_parts(void **state)
{
    (void)state;
    const stf_force *const links[] = {&stf_force_all_pairs_gravity, &stf_force_springs, &idle_link};
    const stf_all_pairs_gravity gravity = {.gravitational_constant = 1, .softening = 1};
    const stf_spring spring = {.a = 0, .b = LARGEST - 1, .stiffness = 1};
    const void *const records[] = {&gravity, &spring, NULL};

    for (size_t l = 0; l < COUNT_OF(links); l++) {
        unsigned calls = 0;
        stf_world *world =
            make_world((stf_world_def){.step = STEP, .parallel = {.run = run_and_count, .tasks = 2, .user = &calls}});
        const stf_particle particle = {.inverse_mass = 1};

        for (size_t i = 0; i < LARGEST; i++)
            assert_ok(stf_world_add(world, &particle, NULL));
        add_force(world, links[l], records[l]);
        assert_ok(stf_world_step(world, 1)); /* semi-implicit Euler: one acceleration, and one loop of its own */
        if (links[l] == &stf_force_all_pairs_gravity)
            assert_int_equal(calls, 1 + ROUNDS + 1 + 1); /* fields, rounds, the last pass, the loop */
        else
            assert_int_equal(calls, (links[l]->splits ? 1 : 2) + 1);
        assert_true(links[l]->splits == (links[l] == &stf_force_springs));
        stf_world_destroy(world);
    }
}

/* Its record says where to count the calls that are of no particles, or of a part of a round. */
static void count_odd_calls(const void *records, size_t record_count, const stf_particles *all, double time)
{
    unsigned *const *odd = (unsigned *const *)records;
    (void)record_count, (void)time;

    **odd += all->begin >= all->end || all->round != 0 || all->part != 0 || all->parts != 1;
}

/* Alone, and beside a link that does not split: then link comes after link. */
static void a_link_that_splits_has_no_rounds(void **state)
{
    (void)state;
    const stf_force link = {.name = "odd", .kind = STF_LINK, .splits = true, .record_size = sizeof(unsigned *),
                            .apply = count_odd_calls};
    uint64_t seed = 1;
    unsigned odd = 0, *record = &odd;
    stf_world *world = tied_world(&stf_rk4, LARGEST, &link, (stf_parallel){.run = run_shuffled, .tasks = 2, .user = &seed});

    assert_ok(stf_world_set_force(world, stf_world_force_at(world, 1), &record, 1));
    assert_ok(stf_world_step(world, 1));
    add_force(world, &idle_link, NULL);
    assert_ok(stf_world_step(world, 1));
    assert_int_equal(odd, 0);
    stf_world_destroy(world);
}

/* An engine may hand out more tasks than there are blocks, or just one. */
static void parts_are_never_more_than_blocks(void **state)
{
    (void)state;
    for (unsigned tasks = 1; tasks <= 64; tasks += 63) {
        uint64_t seed = 1;
        const stf_parallel shuffled = {.run = run_shuffled, .tasks = tasks, .user = &seed};
        stf_world *small = tied_world(&stf_rk4, 3, &idle_link, shuffled);
        stf_world *large = tied_world(&stf_rk4, LARGEST, &idle_link, shuffled);

        assert_ok(stf_world_step(small, 2));
        assert_ok(stf_world_step(large, 2));
        assert_ok(stf_world_remove_force(large, 2)); /* untied, it steps by blocks with scratch for each part */
        assert_ok(stf_world_step(large, 2));
        assert_true((seed != 1) == (tasks > 1));
        stf_world_destroy(small);
        stf_world_destroy(large);
    }
    stf_world *world = NULL;
    assert_refused(stf_world_create(&(stf_world_def){.parallel = {.tasks = 2}}, &world), STF_ERROR_DESCRIPTOR);

    stf_force either_way = stf_force_all_pairs_gravity; /* parts of rounds, or of particles: not both */
    either_way.splits = true;
    world = make_world((stf_world_def){0});
    assert_refused(stf_world_add_force(world, &either_way, NULL, 0, NULL), STF_ERROR_DESCRIPTOR);
    stf_world_destroy(world);
}

static void many_ticks_in_one_call_equal_one_tick_in_many(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *once = filled_world(stf_integrators[k], 300, 2), *often = filled_world(stf_integrators[k], 300, 2);

        assert_ok(stf_world_step(once, 20));
        for (int n = 0; n < 20; n++)
            assert_ok(stf_world_step(often, 1));
        assert_ok(stf_world_step(often, 0));
        assert_same_particles(once, often);
        assert_int_equal(stf_world_ticks(once), stf_world_ticks(often));
        stf_world_destroy(once);
        stf_world_destroy(often);
    }
}

/*
 * The times that forces see are ticks x step too, so that replays do not depend on the frame rate: at a step that is not
 * exact.
 */
static void groups_of_ticks_change_no_bit(void **state)
{
    (void)state;
    stf_world *single = filled_world(&stf_rk4, 20, 2), *grouped = filled_world(&stf_rk4, 20, 2);
    const unsigned groups[] = {3, 1, 7, 2, 11};
    unsigned ticks = 0;

    for (int change = 0; change < 2; change++) {
        assert_ok(stf_world_set_step(single, change ? 1.0 / 70 : 1.0 / 60));
        assert_ok(stf_world_set_step(grouped, change ? 1.0 / 70 : 1.0 / 60));
        for (size_t g = 0; g < 200; g++) {
            const unsigned group = groups[g % COUNT_OF(groups)];
            assert_ok(stf_world_step(grouped, group));
            for (unsigned n = 0; n < group; n++)
                assert_ok(stf_world_step(single, 1));
            ticks += group;
        }
        assert_same_particles(single, grouped);
        assert_int_equal(stf_world_ticks(grouped), ticks);
    }
    stf_world_destroy(single);
    stf_world_destroy(grouped);
}

/* The work arrays of a tied world grow with it. */
static void tied_worlds_grow_like_others(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *tied = filled_world(stf_integrators[k], 10, 1), *loose = filled_world(stf_integrators[k], 10, 1);
        uint64_t seed = 5;

        add_force(tied, &idle_link, NULL);
        add_force(loose, &time_force, NULL);
        add_force(tied, &time_force, NULL);
        for (size_t lot = 0; lot < 5; lot++) {
            for (size_t i = 0; i < 200; i++) {
                const stf_particle particle = random_particle(3, &seed);
                assert_ok(stf_world_add(tied, &particle, NULL));
                assert_ok(stf_world_add(loose, &particle, NULL));
            }
            assert_ok(stf_world_step(tied, 2));
            assert_ok(stf_world_step(loose, 2));
            assert_same_particles(tied, loose);
        }
        stf_world_destroy(tied);
        stf_world_destroy(loose);
    }
}

/* Growing copies particles and history to other memory, with blocks of another width while they are small. */
static void making_room_changes_no_bit(void **state)
{
    (void)state;
    const size_t rooms[] = {0, 17, 100, 1000, 5000};

    for (int k = 0; stf_integrators[k]; k++)
        for (size_t r = 0; r < COUNT_OF(rooms); r++) {
            stf_world *grown = filled_world(stf_integrators[k], 10, 1), *left = filled_world(stf_integrators[k], 10, 1);

            assert_ok(stf_world_step(grown, 3));
            assert_ok(stf_world_step(left, 3));
            assert_ok(stf_world_reserve(grown, rooms[r]));
            assert_ok(stf_world_step(grown, 3));
            assert_ok(stf_world_step(left, 3));
            assert_same_particles(grown, left);
            stf_world_destroy(grown);
            stf_world_destroy(left);
        }
}

/* Bulk and single adds, and a removal that moves the last particle into the gap, end in the same particles. */
static void ways_of_filling_a_world_are_equal(void **state)
{
    (void)state;
    uint64_t seed = 3;
    stf_particle particles[LARGEST];
    stf_world *many = field_world(3, &stf_velocity_verlet, 1), *single = field_world(3, &stf_velocity_verlet, 1);
    size_t index, moved;

    for (size_t i = 0; i < LARGEST; i++)
        particles[i] = random_particle(3, &seed);
    assert_ok(stf_world_add_many(many, particles, LARGEST - 1, &index));
    assert_int_equal(index, 0);

    for (size_t i = 0; i < LARGEST - 1; i++) {
        if (i == 500) { /* one too many, whose place the next to come is moved to */
            assert_ok(stf_world_add(single, &particles[LARGEST - 1], &index));
            assert_int_equal(index, 500);
        }
        assert_ok(stf_world_add(single, &particles[i], &index));
    }
    assert_ok(stf_world_remove(single, 500, &moved));
    assert_int_equal(moved, LARGEST - 1);
    const stf_particle last = particle_of(single, 500);
    assert_memory_equal(&last.position, &particles[LARGEST - 2].position, sizeof last.position);

    for (size_t i = 500; i < LARGEST - 1; i++)
        assert_ok(stf_world_set(single, i, &particles[i]));
    assert_ok(stf_world_step(many, TICKS));
    assert_ok(stf_world_step(single, TICKS));
    assert_same_particles(many, single);
    stf_world_destroy(many);
    stf_world_destroy(single);
}

/* What a force was handed, call by call. */
typedef struct census {
    size_t calls, particles, next_first;
    bool in_order;
} census;

static void count_particles(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    census *c = *(census *const *)records;
    (void)record_count, (void)time;

    c->calls++;
    c->in_order = c->in_order && particles->first == c->next_first && particles->stride == (size_t)1 << particles->shift &&
                  particles->stride <= STF_BLOCK_MAX && particles->dimensions == 3 && (uintptr_t)particles->force % 64 == 0 &&
                  (uintptr_t)particles->position % 64 == 0 && (uintptr_t)particles->velocity % 64 == 0;
    c->particles += particles->count;
    c->next_first += particles->count;
    for (size_t i = 0; i < particles->count; i++)
        particles->force[stf_particles_offset(particles, i) + 2 * particles->stride] += (stf_real)(particles->first + i);
}

/*
 * Every particle in turn, whole blocks but for the last, the whole world at once for a link; and the force reaches that
 * particle.
 */
static void forces_are_handed_every_particle_once(void **state)
{
    (void)state;
    for (int link = 0; link < 2; link++)
        for (size_t c = 0; c < COUNT_OF(counts); c++) {
            const stf_force counter = {.name = "census",
                                       .kind = link ? STF_LINK : STF_FIELD,
                                       .record_size = sizeof(census *),
                                       .apply = count_particles};
            census seen = {.in_order = true}, *at = &seen;
            stf_world *world = make_world((stf_world_def){.step = 1});

            for (size_t i = 0; i < counts[c]; i++)
                assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
            add_force(world, &counter, &at);
            assert_ok(stf_world_step(world, 1));
            assert_true(seen.in_order);
            assert_int_equal(seen.particles, counts[c]);
            assert_int_equal(seen.calls, link ? counts[c] > 0 : (counts[c] + STF_BLOCK_MAX - 1) / STF_BLOCK_MAX);
            for (size_t i = 0; i < counts[c]; i++)
                assert_true(particle_of(world, i).velocity.z == (stf_real)i);
            stf_world_destroy(world);
        }
}

/* Whole rows of a vector, no more than room for all takes, and no larger than a block. */
static void a_small_world_has_one_small_block(void **state)
{
    (void)state;
    const struct {
        size_t capacity, stride;
    } cases[] = {{0, 16}, {1, 16}, {16, 16}, {17, 32}, {32, 32}, {33, 64}, {STF_BLOCK_MAX, STF_BLOCK_MAX},
                 {STF_BLOCK_MAX + 1, STF_BLOCK_MAX}, {10000, STF_BLOCK_MAX}};

    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        stf_world *world = make_world((stf_world_def){.capacity = cases[i].capacity});
        assert_int_equal(stf_world_view(world).stride, cases[i].stride);
        stf_world_destroy(world);
    }
}

/* Counts what is not 0 in the lanes of a block behind its particles; the inverse masses too, which end with the block. */
static void count_spare_lanes(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    stf_real *count = *(stf_real *const *)records;
    (void)record_count, (void)time;

    *count = 0;
    for (size_t i = particles->count; i < particles->stride; i++) {
        *count += particles->inverse_mass[i] != 0;
        for (size_t d = 0; d < particles->dimensions; d++) {
            const stf_real x = particles->position[d * particles->stride + i], v = particles->velocity[d * particles->stride + i];
            *count += (stf_real)((x != 0) + (v != 0));
        }
    }
}

/* Sets every velocity to the number of x, v and a there that are not 0. */
static void count_elements(stf_system *system, stf_real dt)
{
    (void)dt;
    system->accelerate(system, system->time, system->position, system->velocity, system->work[0]);
    for (size_t i = 0; i < system->length; i++)
        system->velocity[i] = (stf_real)((system->position[i] != 0) + (system->velocity[i] != 0) + (system->work[0][i] != 0));
}

/* So says integrator.h: whatever the allocator hands out, and after removals. */
static void elements_of_no_particle_are_zero(void **state)
{
    (void)state;
    stf_real left_over = 1;
    counting c = {0};
    const stf_integrator counter = {.name = "counter", .step = count_elements, .work_arrays = 1};
    stf_world *world = make_world((stf_world_def){.integrator = &counter,
                                                  .step = 1,
                                                  .gravity = {0, -1, 0},
                                                  .allocator = counting_allocator(&c)});
    const stf_force spy = {.name = "spy", .record_size = sizeof(stf_real *), .apply = count_spare_lanes};
    stf_real *at = &left_over;

    for (size_t i = 0; i < 20; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {1, 1, 1}, .velocity = {1, 1, 1}, .inverse_mass = 1}, NULL));
    for (size_t i = 0; i < 10; i++)
        assert_ok(stf_world_remove(world, 3, NULL));
    add_force(world, &spy, &at);
    assert_ok(stf_world_step(world, 1));
    assert_true(left_over == 0);
    for (size_t i = 0; i < 10; i++)
        assert_true(particle_of(world, i).velocity.y == 3 && particle_of(world, i).velocity.x == 2);

    assert_ok(stf_world_clear(world));
    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    left_over = 1;
    assert_ok(stf_world_step(world, 1));
    assert_true(left_over == 0);
    stf_world_destroy(world);
}

/* Keeps dt in its history, for all elements alike, and as any step may leaves the rest alone. */
static void leave_something(stf_system *system, stf_real dt)
{
    for (size_t i = 0; i < system->length; i++)
        system->history[0][i] = dt;
}

static void an_integrator_finds_nothing_of_the_one_before(void **state)
{
    (void)state;
    const stf_integrator litterer = {.name = "litterer", .step = leave_something, .history_arrays = 1};
    const stf_force spy = {.name = "spy", .record_size = sizeof(stf_real *), .apply = count_spare_lanes};
    stf_real left_over = 1, *at = &left_over;
    stf_world *world = make_world((stf_world_def){.integrator = &litterer, .step = 1});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_step(world, 1));
    add_force(world, &spy, &at);
    assert_ok(stf_world_set_integrator(world, &stf_position_verlet));
    assert_ok(stf_world_step(world, 5));
    assert_true(left_over == 0);
    stf_world_destroy(world);
}

/* With semi-implicit Euler and a step of 1 s the velocity gains just the acceleration. */
static void assert_acceleration_is_what_a_step_adds(size_t count, bool tied)
{
    const stf_real wave = (stf_real)0.37;
    stf_world *world = make_world((stf_world_def){.dimensions = 3, .step = 1, .gravity = {0, -8, 1}});

    for (size_t i = 0; i < count; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {wave * (stf_real)i, 1, 0},
                                                       .velocity = {1, (stf_real)i, wave},
                                                       .inverse_mass = (stf_real)(i % 3)}, NULL));
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.25});
    add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 1, .softening = 1});
    if (tied)
        add_force(world, &stf_force_springs, &(stf_spring){.a = 0, .b = (uint32_t)count - 1, .stiffness = 1});

    const stf_particles view = stf_world_view(world);
    const size_t blocks = (count + view.stride - 1) / view.stride, length = blocks * view.stride * view.dimensions;
    stf_real *before = calloc(length, sizeof *before), *acceleration = calloc(length, sizeof *acceleration);
    const uint64_t hash = hash_of(world);

    assert_non_null(before);
    assert_non_null(acceleration);
    assert_int_equal(view.count, count);
    assert_null(view.force);
    memcpy(before, view.velocity, length * sizeof *before);
    assert_ok(stf_world_accelerations(world, 0, view.position, view.velocity, acceleration));
    assert_true(hash_of(world) == hash);
    assert_ok(stf_world_step(world, 1));
    for (size_t i = 0; i < length; i++)
        assert_true(view.velocity[i] == before[i] + acceleration[i]);
    for (size_t i = 0; i < count; i++) {
        const stf_real *x = view.position + stf_particles_offset(&view, i);
        const stf_vector expected = particle_of(world, i).position;
        assert_true(x[0] == expected.x && x[view.stride] == expected.y && x[2 * view.stride] == expected.z);
        assert_true(view.inverse_mass[i] == particle_of(world, i).inverse_mass);
    }
    free(before);
    free(acceleration);
    stf_world_destroy(world);
}

static void accelerations_are_those_of_a_step_and_change_nothing(void **state)
{
    (void)state;
    for (int tied = 0; tied < 2; tied++) {
        assert_acceleration_is_what_a_step_adds(2, tied);
        assert_acceleration_is_what_a_step_adds(2 * STF_BLOCK_MAX + 5, tied);
    }
    assert_int_equal(stf_world_view(NULL).count, 0);
    assert_refused(stf_world_accelerations(NULL, 0, NULL, NULL, NULL), STF_ERROR_NULL);
}

static void accelerations_are_of_the_time_that_is_asked_for(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 1});
    stf_real a[3 * STF_BLOCK_MAX];

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    add_force(world, &time_force, NULL);
    const stf_real *x = stf_world_view(world).position, *v = stf_world_view(world).velocity;
    assert_ok(stf_world_accelerations(world, 0, x, v, a));
    assert_true(a[0] == 1); /* cos 0 */
    assert_ok(stf_world_accelerations(world, 1, x, v, a));
    assert_close(a[0], 0.54030230586813977, REAL_EPSILON); /* cos 1 */
    assert_refused(stf_world_accelerations(NULL, 0, x, v, a), STF_ERROR_NULL);
    assert_refused(stf_world_accelerations(world, 0, NULL, v, a), STF_ERROR_NULL);
    assert_refused(stf_world_accelerations(world, 0, x, NULL, a), STF_ERROR_NULL);
    assert_refused(stf_world_accelerations(world, 0, x, v, NULL), STF_ERROR_NULL);
    stf_world_destroy(world);
}

static void stand_still(stf_system *system, stf_real dt) { (void)system, (void)dt; }

/* No particles and no arrays is no memory that is missed. */
static void an_empty_world_of_an_integrator_without_arrays_steps(void **state)
{
    (void)state;
    const stf_integrator still = {.name = "still", .step = stand_still};
    stf_world *world = make_world((stf_world_def){.integrator = &still, .step = 1});

    assert_ok(stf_world_step(world, 2));
    assert_int_equal(stf_world_view(world).count, 0);
    assert_ok(stf_world_add(world, &(stf_particle){.position = {1, 2, 3}}, NULL));
    assert_ok(stf_world_step(world, 2));
    assert_true(particle_of(world, 0).position.z == 3);
    stf_world_destroy(world);
}

/* More arrays need other memory, with as much room. */
static void room_is_kept_where_the_integrator_changes(void **state)
{
    (void)state;
    counting c = {0};
    stf_world *world = make_world((stf_world_def){.capacity = LARGEST, .allocator = counting_allocator(&c)});

    assert_ok(stf_world_set_integrator(world, &stf_rk4));
    const size_t calls = c.calls;
    for (size_t i = 0; i < LARGEST; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_int_equal(c.calls, calls);
    stf_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_particle_moves_alike_alone_and_in_every_count),
        cmocka_unit_test(block_stepping_equals_whole_world_stepping),
        cmocka_unit_test(flight_changes_no_bit),
        cmocka_unit_test(reading_a_world_uses_no_threads),
        cmocka_unit_test(drags_that_overflow_leave_the_immovable_alone),
        cmocka_unit_test(user_drag_is_twice_its_record),
        cmocka_unit_test(parts_change_no_bit),
        cmocka_unit_test(parts_pull_each_end_of_a_spring_once),
        cmocka_unit_test(flight_of_many_blocks_changes_no_bit),
        cmocka_unit_test(parts_of_loose_blocks_change_no_bit),
        cmocka_unit_test(a_link_of_the_user_is_called_once_for_all_parts),
        cmocka_unit_test(previous_positions_are_those_of_the_tick_before),
        cmocka_unit_test(parts_have_scratch_of_their_own),
        cmocka_unit_test(links_of_the_library_run_within_the_parts),
        cmocka_unit_test(a_link_that_splits_has_no_rounds),
        cmocka_unit_test(parts_are_never_more_than_blocks),
        cmocka_unit_test(many_ticks_in_one_call_equal_one_tick_in_many),
        cmocka_unit_test(groups_of_ticks_change_no_bit),
        cmocka_unit_test(tied_worlds_grow_like_others),
        cmocka_unit_test(making_room_changes_no_bit),
        cmocka_unit_test(ways_of_filling_a_world_are_equal),
        cmocka_unit_test(forces_are_handed_every_particle_once),
        cmocka_unit_test(a_small_world_has_one_small_block),
        cmocka_unit_test(elements_of_no_particle_are_zero),
        cmocka_unit_test(an_integrator_finds_nothing_of_the_one_before),
        cmocka_unit_test(accelerations_are_those_of_a_step_and_change_nothing),
        cmocka_unit_test(accelerations_are_of_the_time_that_is_asked_for),
        cmocka_unit_test(an_empty_world_of_an_integrator_without_arrays_steps),
        cmocka_unit_test(room_is_kept_where_the_integrator_changes),
    };

    return cmocka_run_group_tests_name("blocks, " REAL_NAME, tests, NULL, NULL);
}
