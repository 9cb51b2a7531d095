/*
 * Real threads, POSIX: a world that steps on several gives the bits of one; worlds on several share nothing; a world is read by
 * any number. Each is compared with the same done alone; `make tsan` has the thread sanitizer look on.
 */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"
#include "support/check.h"

#define THREADS 4
#define TICKS 20
#define PARTICLES 1000 /* fill several blocks */

/* ---- an engine's threads, in the least that does it ---------------------------------------------------------------------- */

typedef struct call {
    pthread_t thread;
    void (*task)(void *context, unsigned index);
    void *context;
    unsigned index, stride, tasks;
} call;

static void *take_every_other(void *argument)
{
    const call *c = argument;

    for (unsigned i = c->index; i < c->tasks; i += c->stride)
        c->task(c->context, i);
    return NULL;
}

static void run_on_threads(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    const unsigned threads = tasks < THREADS ? tasks : THREADS;
    call calls[THREADS];
    (void)user;

    for (unsigned t = 0; t < threads; t++) {
        calls[t] = (call){.task = task, .context = context, .index = t, .stride = threads, .tasks = tasks};
        if (pthread_create(&calls[t].thread, NULL, take_every_other, &calls[t]) != 0)
            abort();
    }
    for (unsigned t = 0; t < threads; t++)
        pthread_join(calls[t].thread, NULL);
}

static const stf_parallel threads = {.run = run_on_threads, .tasks = 2 * THREADS};
static const stf_parallel alone = {.tasks = 0};

/* ---- a world in which every force acts ----------------------------------------------------------------------------------- */

static void fill(stf_world *world)
{
    stf_particle particles[PARTICLES];
    stf_spring springs[PARTICLES - 1];
    uint64_t seed = 1;

    for (uint32_t i = 0; i < PARTICLES; i++)
        particles[i] = (stf_particle){.position = {(stf_real)i, (stf_real)next_random(&seed), 0}, .inverse_mass = 1};
    for (uint32_t i = 0; i + 1 < PARTICLES; i++)
        springs[i] = (stf_spring){.a = i, .b = i % 7 ? i + 1 : (i * i + 1) % PARTICLES, .stiffness = 10, .rest_length = 1};
    assert_ok(stf_world_add_many(world, particles, PARTICLES, NULL));
    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, COUNT_OF(springs), NULL));
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.5});
    add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){(stf_real)0.25});
    add_force(world, &stf_force_attractor, &(stf_attractor){.position = {2, 0, 0}, .strength = 1});
    add_force(world, &stf_force_anchored_springs, &(stf_anchored_spring){.particle = PARTICLES / 2, .stiffness = 1});
    add_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){.gravitational_constant = 1, .softening = 1});
}

static stf_world *full_world(const stf_integrator *integrator, stf_parallel parallel)
{
    stf_world *world = make_world(
        (stf_world_def){.integrator = integrator, .keep_previous = true, .gravity = {0, -1, 0}, .parallel = parallel});

    fill(world);
    return world;
}

/* Particles alone: records have pads. */
static uint64_t bits_of(const stf_world *world)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);

    for (size_t i = 0; i < stf_world_count(world); i++) {
        stf_particle particle;
        unsigned char bytes[sizeof particle];

        stf_world_get(world, i, &particle);
        memcpy(bytes, &particle, sizeof bytes);
        for (size_t k = 0; k < sizeof bytes; k++)
            hash = (hash ^ bytes[k]) * UINT64_C(0x100000001b3);
    }
    return hash;
}

/* ---- tests --------------------------------------------------------------------------------------------------------------- */

static uint64_t hash_of_scene(const scene *s, const stf_integrator *integrator, stf_parallel parallel)
{
    stf_world *world;

    assert_ok(scene_create(s, &(stf_world_def){.integrator = integrator, .parallel = parallel}, &world));
    assert_ok(stf_world_step(world, TICKS));
    const uint64_t hash = bits_of(world);
    stf_world_destroy(world);
    return hash;
}

static void every_scene_steps_on_threads_as_alone(void **state)
{
    (void)state;
    for (int s = 0; scenes[s]; s++)
        for (int k = 0; stf_integrators[k]; k++)
            assert_true(hash_of_scene(scenes[s], stf_integrators[k], threads) ==
                        hash_of_scene(scenes[s], stf_integrators[k], alone));
}

static void every_force_acts_on_threads_as_alone(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *one = full_world(stf_integrators[k], alone), *several = full_world(stf_integrators[k], threads);

        assert_ok(stf_world_step(one, 3));
        assert_ok(stf_world_step(several, 3));
        assert_true(bits_of(one) == bits_of(several));
        stf_world_destroy(one);
        stf_world_destroy(several);
    }
}

/* The whole life of a world; checks are left to the thread of the tests. */
static void live(void *hashes, unsigned index)
{
    const stf_integrator *integrator = stf_integrators[index % 7];
    stf_world *world = NULL;
    char text[4096];

    if (scene_create(&scene_cloth, &(stf_world_def){.integrator = integrator}, &world))
        return;
    stf_world_step(world, 2);
    const size_t size = stf_world_snapshot_size(world), save_size = stf_world_save_size(world);
    void *snapshot = malloc(size), *save = malloc(save_size);
    if (snapshot && save) {
        stf_stability stability;
        stf_world_snapshot(world, snapshot, size);
        stf_world_save(world, save, save_size);
        stf_world_remove(world, 5, NULL);
        stf_world_step(world, 1);
        stf_world_restore(world, snapshot, size);
        stf_world_load(world, save, save_size, NULL);
        stf_world_describe(world, text, sizeof text);
        stf_stability_measure(world, &(stf_stability_def){.accelerations = 25}, &stability);
        stf_world_step(world, 1);
    }
    ((uint64_t *)hashes)[index] = bits_of(world);
    free(save);
    free(snapshot);
    stf_world_destroy(world);
}

static void worlds_on_several_threads_share_nothing(void **state)
{
    (void)state;
    uint64_t one_by_one[2 * THREADS] = {0}, at_once[2 * THREADS] = {0};

    for (unsigned i = 0; i < COUNT_OF(one_by_one); i++)
        live(one_by_one, i);
    run_on_threads(NULL, COUNT_OF(at_once), live, at_once);
    assert_memory_equal(one_by_one, at_once, sizeof at_once);
    assert_true(at_once[0] != 0);
}

typedef struct reading {
    const stf_world *world;
    double sums[2 * THREADS]; /* of what each reader was told */
} reading;

/* Every function that takes the world const and computes something. */
static void read_all(void *context, unsigned index)
{
    reading *r = context;
    const stf_world *world = r->world;
    const stf_particles view = stf_world_view(world);
    const size_t reals = (view.count + view.stride) * view.dimensions, size = stf_world_snapshot_size(world);
    stf_real *accelerations = calloc(reals, sizeof *accelerations);
    float *positions = calloc(reals, sizeof *positions);
    unsigned char *bytes = calloc(1, size + stf_world_save_size(world));
    stf_energy energy = {0, 0};
    stf_stability stability = {.omega = 0};
    double momentum[STF_DIMENSIONS_MAX] = {0}, sum = 0;
    char text[4096] = "";

    if (accelerations && positions && bytes) {
        stf_world_accelerations(world, 0, view.position, view.velocity, accelerations);
        stf_world_copy_positions(world, 0.5, positions, 0);
        stf_world_energy(world, &energy);
        stf_world_momentum(world, momentum);
        stf_world_snapshot(world, bytes, size);
        stf_world_save(world, bytes + size, stf_world_save_size(world));
        stf_stability_measure(world, &(stf_stability_def){.accelerations = 25}, &stability);
        sum = energy.kinetic + energy.potential + momentum[0] + stability.omega + stf_world_find_non_finite(world, NULL);
        sum += (double)stf_world_describe(world, text, sizeof text);
        for (size_t i = 0; i < reals; i++)
            sum += (double)accelerations[i] + (double)positions[i];
    }
    r->sums[index] = sum;
    free(bytes);
    free(positions);
    free(accelerations);
}

static void readers_share_a_world(void **state)
{
    (void)state;
    stf_world *world = full_world(&stf_velocity_verlet, threads);
    reading by_one = {.world = world}, at_once = {.world = world};

    assert_ok(stf_world_step(world, 1));
    const uint64_t before = bits_of(world);
    read_all(&by_one, 0);
    assert_true(by_one.sums[0] != 0 && bits_of(world) == before);
    run_on_threads(NULL, COUNT_OF(at_once.sums), read_all, &at_once);
    for (size_t i = 0; i < COUNT_OF(at_once.sums); i++)
        assert_true(at_once.sums[i] == by_one.sums[0]);
    assert_true(bits_of(world) == before);
    stf_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_steps_on_threads_as_alone),
        cmocka_unit_test(every_force_acts_on_threads_as_alone),
        cmocka_unit_test(worlds_on_several_threads_share_nothing),
        cmocka_unit_test(readers_share_a_world),
    };

    return cmocka_run_group_tests_name("threads, " REAL_NAME, tests, NULL, NULL);
}
