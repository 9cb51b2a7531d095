/* What a world promises: refusals that change nothing, memory, time, blending, energy, what it says about itself. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"
#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"

/* A world with some of everything: particles, both kinds of springs, gravity, drag; half way through a run. */
static stf_world *busy_world(const stf_allocator *allocator)
{
    stf_world_def def = {.dimensions = 2, .integrator = &stf_velocity_verlet, .step = 1.0 / 64, .gravity = {0, -1, 0}};
    const stf_spring spring = {.a = 0, .b = 2, .stiffness = 1, .damping = (stf_real)0.25, .rest_length = 1};
    const stf_anchored_spring anchored = {.particle = 1, .stiffness = 1};
    const stf_linear_drag drag = {(stf_real)0.125};

    if (allocator)
        def.allocator = *allocator;
    def.keep_previous = def.keep_radius = true;

    stf_world *world = make_world(def);
    for (int i = 0; i < 3; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)i, 1, 0},
                                                       .velocity = {0, (stf_real)i, 0},
                                                       .inverse_mass = 1,
                                                       .radius = (stf_real)0.5}, NULL));
    add_force(world, &stf_force_springs, &spring);
    add_force(world, &stf_force_anchored_springs, &anchored);
    add_force(world, &stf_force_linear_drag, &drag);
    assert_ok(stf_world_step(world, 10));
    return world;
}

/* A lot is refused as a whole, wherever in it the bad one is; what is added later finds the lanes empty. */
static void a_bad_particle_late_in_a_lot_leaves_nothing_of_it(void **state)
{
    (void)state;
    enum { LOT = 3 * STF_BLOCK_MAX };
    static stf_particle lot[LOT];

    for (size_t bad = 0; bad < LOT; bad += LOT / 6 - 1) {
        stf_world *world = busy_world(NULL), *untouched = busy_world(NULL);
        const uint64_t before = hash_of(world);

        for (size_t i = 0; i < LOT; i++)
            lot[i] = (stf_particle){.position = {1, 2, 0}, .velocity = {3, 4, 0}, .inverse_mass = i == bad ? -1 : 1};
        assert_refused(stf_world_add_many(world, lot, LOT, NULL), STF_ERROR_MASS);
        assert_true(hash_of(world) == before);
        assert_ok(stf_world_step(world, 3));
        assert_ok(stf_world_step(untouched, 3));
        assert_true(hash_of(world) == hash_of(untouched));
        const stf_particles view = stf_world_view(world);
        for (size_t lane = view.count; lane < view.stride; lane++)
            assert_true(view.position[lane] == 0 && view.velocity[lane + view.stride] == 0 && view.inverse_mass[lane] == 0);
        stf_world_destroy(world);
        stf_world_destroy(untouched);
    }
}

static void every_result_has_its_own_text(void **state)
{
    (void)state;
    for (int i = 0; i < STF_RESULT_COUNT; i++) {
        assert_non_null(stf_result_text((stf_result)i));
        for (int j = 0; j < i; j++)
            assert_string_not_equal(stf_result_text((stf_result)i), stf_result_text((stf_result)j));
    }
    assert_non_null(stf_result_text((stf_result)-1));
    assert_non_null(stf_result_text(STF_RESULT_COUNT));

    char version[32];
    snprintf(version, sizeof version, "%d.%d.%d", STF_VERSION_MAJOR, STF_VERSION_MINOR, STF_VERSION_PATCH);
    assert_string_equal(stf_version(), version);
}

static void all_memory_comes_from_the_allocator_and_goes_back(void **state)
{
    (void)state;
    counting c = {0};
    const stf_allocator allocator = counting_allocator(&c);
    stf_world *world = busy_world(&allocator);

    assert_true(c.blocks > 0 && c.bytes > 0);
    stf_world_destroy(world);
    assert_int_equal(c.blocks, 0);
    assert_int_equal(c.bytes, 0);

    stf_world *none = NULL;
    const stf_world_def half = {.allocator = {.allocate = allocator.allocate, .user = &c}};
    assert_refused(stf_world_create(&half, &none), STF_ERROR_DESCRIPTOR);
    assert_null(none);
}

static void steps_and_questions_allocate_nothing(void **state)
{
    (void)state;
    counting c = {0};
    const stf_allocator allocator = counting_allocator(&c);
    stf_world *world = busy_world(&allocator);
    const size_t calls = c.calls;
    stf_energy energy;
    double momentum[3];
    float vertices[6];
    char text[2048];

    const stf_spring springs[] = {{0, 1, 2, 0, 0}};

    for (int k = 0; k < 3; k++) {
        if (k == 0)
            assert_ok(stf_world_set_force(world, 1, springs, 1)); /* as many records as before */
        assert_ok(stf_world_step(world, 5));
        assert_ok(stf_world_energy(world, &energy));
        assert_ok(stf_world_momentum(world, momentum));
        assert_ok(stf_world_copy_positions(world, 0.5, vertices, 0));
        stf_world_describe(world, text, sizeof text);
        stf_world_find_non_finite(world, NULL);
        assert_ok(stf_world_set_step(world, 0.01 * (k + 1)));
        assert_ok(stf_world_remove(world, 0, NULL));
    }
    assert_int_equal(c.calls, calls);
    stf_world_destroy(world);
}

/* Hands out another allocator's memory until it is told to refuse; then it notes the least that it was asked for. */
typedef struct shortage {
    stf_allocator lender;
    bool refuses;
    size_t least; /* bytes */
} shortage;

static void *lend(void *user, size_t size, size_t alignment)
{
    shortage *s = user;

    if (!s->refuses)
        return s->lender.allocate(s->lender.user, size, alignment);
    if (size < s->least)
        s->least = size;
    return NULL;
}

static void give_back(void *user, void *memory, size_t size)
{
    const shortage *s = user;
    s->lender.release(s->lender.user, memory, size);
}

/* With every array that a world may have, at the very capacities whose bytes are about as many as a size_t counts. */
static void no_room_is_asked_for_whose_bytes_wrap_round(void **state)
{
    (void)state;
    enum { ROWS = 3 * (3 + STF_HISTORY_ARRAYS_MAX + STF_WORK_ARRAYS_MAX) + 2 };
    const stf_integrator greedy = {.name = "greedy",
                                   .step = stf_rk4.step,
                                   .work_arrays = STF_WORK_ARRAYS_MAX,
                                   .history_arrays = STF_HISTORY_ARRAYS_MAX};
    const size_t limit = SIZE_MAX / sizeof(stf_real) / ROWS;
    counting c = {0};
    shortage s = {.lender = counting_allocator(&c), .least = SIZE_MAX};
    stf_world *world = make_world((stf_world_def){.integrator = &greedy,
                                                  .keep_previous = true,
                                                  .keep_radius = true,
                                                  .allocator = {.allocate = lend, .release = give_back, .user = &s}});

    add_force(world, &idle_link, NULL);
    s.refuses = true;
    for (size_t capacity = limit - 2000; capacity <= limit + 2000; capacity++)
        assert_refused(stf_world_reserve(world, capacity), STF_ERROR_MEMORY);
    assert_true(s.least > SIZE_MAX / 2);
    stf_world_destroy(world);
    assert_int_equal(c.blocks, 0);
}

static void time_is_ticks_times_step(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 0.1, .substeps = 3});

    for (unsigned n = 1; n <= 1000; n++) {
        assert_ok(stf_world_step(world, 1000));
        assert_int_equal(stf_world_ticks(world), 1000 * n);
        assert_true(stf_world_time(world) == 1000 * n * 0.1);
    }
    const double before = stf_world_time(world);
    assert_ok(stf_world_set_step(world, 0.25));
    assert_true(stf_world_time(world) == before);
    assert_ok(stf_world_step(world, 4));
    assert_true(stf_world_time(world) == before + 1);
    assert_int_equal(stf_world_ticks(world), 1000004);
    stf_world_destroy(world);
}

/* Records the times that it is asked for. */
#define TIMES 64
static void note_time(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    double *const *times = records;
    (void)record_count, (void)particles;
    times[0][1 + (size_t)times[0][0]] = time;
    times[0][0]++;
}

static void forces_see_the_time_of_their_stage(void **state)
{
    (void)state;
    static const stf_force noter = {.name = "noter", .record_size = sizeof(double *), .apply = note_time};
    const double expected[] = {0, 0.125, 0.125, 0.25, 0.25, 0.375, 0.375, 0.5, 0.5, 0.625, 0.625, 0.75, 0.75, 0.875, 0.875, 1};
    double times[TIMES] = {0}, *at = times;
    stf_world *world = make_world((stf_world_def){.integrator = &stf_rk4, .step = 0.5, .substeps = 2});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    add_force(world, &noter, &at);
    assert_ok(stf_world_step(world, 2));
    assert_true(times[0] == COUNT_OF(expected));
    for (size_t i = 0; i < COUNT_OF(expected); i++)
        assert_true(times[1 + i] == expected[i]);
    stf_world_destroy(world);
}

/* Ticks count on where the step changes, and time with them: for fields as for links. */
static void forces_see_the_time_that_the_world_says_after_a_change_of_step(void **state)
{
    (void)state;
    const double expected[] = {0, 0.5, 1, 1.25, 1.5};

    for (int link = 0; link < 2; link++) {
        const stf_force noter = {.name = "noter",
                                 .kind = link ? STF_LINK : STF_FIELD,
                                 .record_size = sizeof(double *),
                                 .apply = note_time};
        double times[TIMES] = {0}, *at = times;
        stf_world *world = make_world((stf_world_def){.integrator = &stf_explicit_euler, .step = 0.5});

        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
        add_force(world, &noter, &at);
        assert_ok(stf_world_step(world, 2));
        assert_ok(stf_world_set_step(world, 0.25));
        assert_ok(stf_world_step(world, 2));
        assert_ok(stf_world_step(world, 1));
        assert_true(times[0] == COUNT_OF(expected));
        for (size_t i = 0; i < COUNT_OF(expected); i++)
            assert_true(times[1 + i] == expected[i]);
        assert_true(stf_world_time(world) == 1.75);
        stf_world_destroy(world);
    }
}

/* More than a block, of particles that all differ. */
#define CROWD (2 * (size_t)STF_BLOCK_MAX + 5)

static stf_world *crowd(const stf_integrator *integrator, counting *memory)
{
    stf_world *world = make_world((stf_world_def){
        .integrator = integrator, .step = 1.0 / 8, .gravity = {0, -2, 1}, .allocator = counting_allocator(memory)});

    for (size_t i = 0; i < CROWD; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)i, 1, -(stf_real)i},
                                                       .velocity = {1, (stf_real)i, 2},
                                                       .inverse_mass = (stf_real)(i % 3)}, NULL));
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.1});
    add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 1, .softening = 1});
    return world;
}

/* Whatever integrator was there before, with history or without, in memory full of garbage. */
static void an_integrator_goes_on_as_if_it_had_started_there(void **state)
{
    (void)state;
    for (int from = 0; stf_integrators[from]; from++)
        for (int to = 0; stf_integrators[to]; to++) {
            counting c = {0}, d = {0};
            stf_world *changed = crowd(stf_integrators[from], &c), *fresh = crowd(stf_integrators[to], &d);

            if (from != to) {
                assert_ok(stf_world_step(changed, 3));
                for (size_t i = 0; i < CROWD; i++) {
                    const stf_particle particle = particle_of(changed, i);
                    assert_ok(stf_world_set(fresh, i, &particle));
                }
                assert_ok(stf_world_set_integrator(changed, stf_integrators[to]));
                assert_ok(stf_world_step(changed, 3));
                assert_ok(stf_world_step(fresh, 3));
            }
            for (size_t i = 0; i < CROWD; i++) {
                const stf_particle p = particle_of(changed, i), q = particle_of(fresh, i);
                assert_memory_equal(&p, &q, sizeof p);
            }
            stf_world_destroy(changed);
            stf_world_destroy(fresh);
        }
}

/* Adds up the velocity once in one history and twice in the other, and shows both. */
static void sum_twice(stf_system *system, stf_real dt)
{
    (void)dt;
    for (size_t i = 0; i < system->length; i++) {
        stf_real *once = &system->history[0][i], *twice = &system->history[1][i];
        *once = (*once == *once ? *once : 0) + system->velocity[i];
        *twice = (*twice == *twice ? *twice : 0) + 2 * system->velocity[i];
        system->position[i] = *once + 1000 * *twice;
    }
}

static void every_history_moves_with_its_particles(void **state)
{
    (void)state;
    const stf_integrator summing = {.name = "summing", .step = sum_twice, .history_arrays = 2};
    stf_world *world = make_world((stf_world_def){.integrator = &summing, .step = 1});

    for (int i = 0; i < 10; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 2, (stf_real)i}}, NULL));
    assert_ok(stf_world_step(world, 2));
    assert_ok(stf_world_reserve(world, 20)); /* into wider rows */
    assert_ok(stf_world_reserve(world, CROWD)); /* and into more blocks */
    assert_ok(stf_world_reserve(world, 2 * CROWD));
    assert_ok(stf_world_remove(world, 0, NULL));
    assert_ok(stf_world_step(world, 1));
    for (size_t i = 0; i < 9; i++) { /* 3 steps: 3 v and 6 v */
        const stf_vector x = particle_of(world, i).position;
        assert_true(x.x == 6003 && x.y == 2 * 6003 && x.z == 6003 * (stf_real)(i == 0 ? 9 : i));
    }
    stf_world_destroy(world);
}

/* The smallest and the largest that is no error, alone, in a lot and set. */
static void masses_and_radii_are_taken_up_to_their_limits(void **state)
{
    (void)state;
    const stf_real least = sizeof(stf_real) == sizeof(float) ? (stf_real)FLT_MIN : (stf_real)DBL_MIN;
    const stf_particle edge[] = {{.inverse_mass = least, .radius = (stf_real)REAL_MAX},
                                 {.inverse_mass = (stf_real)REAL_MAX, .radius = least}};
    stf_world *world = make_world((stf_world_def){.keep_radius = true});

    assert_ok(stf_world_add_many(world, edge, COUNT_OF(edge), NULL));
    for (size_t i = 0; i < COUNT_OF(edge); i++) {
        assert_ok(stf_world_add(world, &edge[i], NULL));
        assert_ok(stf_world_set(world, 0, &edge[i]));
        assert_true(particle_of(world, 0).inverse_mass == edge[i].inverse_mass);
        assert_true(particle_of(world, 0).radius == edge[i].radius);
    }
    stf_world_destroy(world);
}

/* Through growth from a small block to whole ones, a removal and a set; each particle its own. */
static void radii_are_kept_where_the_def_asks_for_them(void **state)
{
    (void)state;
    enum { FEW = 10, ALL = 2 * STF_BLOCK_MAX + 5 };
    static stf_particle lot[ALL];
    stf_world *world = make_world((stf_world_def){.keep_radius = true});
    const size_t last = ALL - 1;

    for (size_t i = 0; i < ALL; i++)
        lot[i] = (stf_particle){.inverse_mass = 1, .radius = (stf_real)(i + 1)};
    assert_ok(stf_world_add_many(world, lot, FEW, NULL));
    assert_ok(stf_world_add_many(world, lot + FEW, ALL - FEW, NULL));
    assert_ok(stf_world_reserve(world, 2 * ALL));
    for (size_t i = 0; i < ALL; i++)
        assert_true(particle_of(world, i).radius == (stf_real)(i + 1));
    assert_ok(stf_world_set(world, 7, &(stf_particle){.radius = (stf_real)0.5}));
    assert_ok(stf_world_remove(world, 3, NULL));
    assert_true(particle_of(world, 7).radius == (stf_real)0.5 && particle_of(world, 3).radius == (stf_real)(last + 1));
    assert_true(particle_of(world, 6).radius == 7 && particle_of(world, 8).radius == 9);
    stf_world_destroy(world);
}

static void positions_are_copied_out_blended_and_strided(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 2, .step = 0.5, .keep_previous = true});
    float packed[2 * 300];
    struct vertex {
        float colour, xy[2];
        double more;
    } vertices[300];

    for (int i = 0; i < 300; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)i, 0, 0}, .velocity = {2, 4, 0}}, NULL));
    assert_ok(stf_world_copy_positions(world, 0, packed, 0));
    assert_true(packed[2 * 299] == 299.0f); /* nothing has moved yet */

    assert_ok(stf_world_step(world, 3)); /* previous: 2 ticks, x + 2, y + 4; now: x + 3, y + 6 */
    const double alphas[] = {0, 0.25, 0.5, 1};
    for (size_t k = 0; k < COUNT_OF(alphas); k++) {
        memset(vertices, 0, sizeof vertices);
        assert_ok(stf_world_copy_positions(world, alphas[k], packed, 0));
        assert_ok(stf_world_copy_positions(world, alphas[k], vertices[0].xy, sizeof vertices[0]));
        for (int i = 0; i < 300; i++) { /* small whole numbers and quarters: exact */
            assert_true(packed[2 * i] == (float)(i + 2 + alphas[k]));
            assert_true(packed[2 * i + 1] == (float)(4 + 2 * alphas[k]));
            assert_memory_equal(vertices[i].xy, &packed[2 * i], sizeof vertices[i].xy);
            assert_true(vertices[i].colour == 0 && vertices[i].more == 0);
        }
    }

    /* A teleport is not blended; what moved into a gap keeps its own past. */
    assert_ok(stf_world_set(world, 7, &(stf_particle){.position = {-9, 8, 0}}));
    assert_ok(stf_world_remove(world, 5, NULL));
    assert_ok(stf_world_copy_positions(world, 0.5, packed, 0));
    assert_true(packed[2 * 7] == -9 && packed[2 * 7 + 1] == 8);
    assert_true(packed[2 * 5] == 299 + 2.5f && packed[2 * 5 + 1] == 5);

    stf_world *forgetful = make_world((stf_world_def){0});
    assert_refused(stf_world_copy_positions(forgetful, 0.5, packed, 0), STF_ERROR_NO_PREVIOUS);
    assert_refused(stf_world_copy_positions(world, 1, packed, 2 * sizeof(float) - 1), STF_ERROR_STRIDE);
    assert_ok(stf_world_copy_positions(world, 1, packed, 2 * sizeof(float)));
    assert_ok(stf_world_copy_positions(forgetful, 1, NULL, 0)); /* no particles, no buffer */
    stf_world_destroy(forgetful);
    stf_world_destroy(world);
}

static void energy_and_momentum_are_their_sums(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.gravity = {0, -2, 1}});
    stf_energy energy;
    double momentum[3];

    assert_ok(stf_world_add(world, &(stf_particle){.position = {1, 3, 5}, .velocity = {1, -2, 3}, .inverse_mass = 0.5}, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.position = {9, 1, 2}, .velocity = {0, 4, 0}, .inverse_mass = 0.25}, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.position = {9, 9, 9}, .velocity = {9, 9, 9}}, NULL)); /* immovable */
    assert_ok(stf_world_energy(world, &energy));
    assert_ok(stf_world_momentum(world, momentum));
    assert_true(energy.kinetic == 2 * 14 / 2.0 + 4 * 16 / 2.0);
    assert_true(energy.potential == 2 * (2 * 3 - 5) + 4 * (2 * 1 - 2));
    assert_true(momentum[0] == 2 && momentum[1] == -4 + 16 && momentum[2] == 6);
    stf_world_destroy(world);
}

/* G m m / d between the two that have a mass; an immovable one between them neither adds nor divides by 0. */
static void immovable_particles_have_no_gravitational_energy(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 1});
    stf_energy energy;

    assert_ok(stf_world_add(world, &(stf_particle){.position = {0, 0, 0}, .inverse_mass = 1}, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.position = {1, 0, 0}}, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.position = {2, 0, 0}, .inverse_mass = 0.5}, NULL));
    add_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){.gravitational_constant = 3});
    add_force(world, &stf_force_attractor, &(stf_attractor){.position = {4, 0, 0}, .strength = 8});
    assert_ok(stf_world_energy(world, &energy));
    assert_true(energy.kinetic == 0 && energy.potential == -3 * 2 / 2.0 - 8 / 4.0 - 8 * 2 / 2.0);

    /* Softened by 1.5 m, at 2 m the distance counts as 2.5 m; no particle pulls itself. */
    const stf_all_pairs_gravity softened = {.gravitational_constant = 5, .softening = (stf_real)1.5};
    assert_ok(stf_world_set_force(world, 1, &softened, 1));
    assert_ok(stf_world_energy(world, &energy));
    assert_close(energy.potential, -5 * 2 / 2.5 - 8 / 4.0 - 8 * 2 / 2.0, 1e-14);
    stf_world_destroy(world);
}

static void the_first_non_finite_particle_is_found(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 3, .step = 1});
    size_t index = 77;

    for (int i = 0; i < 300; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.velocity = {0, 1, 0}, .inverse_mass = 1}, NULL));
    assert_ok(stf_world_step(world, 1));
    assert_false(stf_world_find_non_finite(world, &index));
    assert_int_equal(index, 77);

    const size_t runaways[] = {299, 257, 256, 1, 0};
    for (size_t k = 0; k < COUNT_OF(runaways); k++) {
        /* Two steps at the largest speed overflow the position. */
        assert_ok(stf_world_set(world, runaways[k], &(stf_particle){.velocity = {0, 0, REAL_MAX}, .inverse_mass = 1}));
        assert_ok(stf_world_step(world, 2));
        assert_true(stf_world_find_non_finite(world, &index));
        assert_int_equal(index, runaways[k]);
        assert_true(stf_world_find_non_finite(world, NULL));
    }
    stf_world_destroy(world);
}

/* 1 N along y, as a user would write it. */
static void lift(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)time;
    for (size_t i = 0; i < particles->count; i++)
        particles->force[particles->stride + i] += 1;
}

static const stf_force lift_force = {.name = "lift", .kind = STF_FIELD, .apply = lift};

/* What an integrator remembers of the forces before must not act once: velocities of 1/64 a step are exact. */
static void changed_forces_act_from_the_very_next_step(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *world = make_world((stf_world_def){.integrator = stf_integrators[k], .step = 1.0 / 64});
        stf_force_id id;

        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
        assert_ok(stf_world_add_force(world, &lift_force, NULL, 0, &id));
        assert_ok(stf_world_step(world, 8));
        assert_close(particle_of(world, 0).velocity.y, 8 / 64.0, 8 * REAL_EPSILON);
        assert_ok(stf_world_remove_force(world, id));
        const stf_real kept = particle_of(world, 0).velocity.y;
        assert_ok(stf_world_step(world, 8));
        assert_close(particle_of(world, 0).velocity.y, kept, 8 * REAL_EPSILON);
        /* Position Verlet reckons a change of gravity from half a step before on. */
        const double half_a_step = stf_integrators[k] == &stf_position_verlet ? 2 * 0.5 / 64 : 0;
        assert_ok(stf_world_set_gravity(world, (stf_vector){0, 0, 2}));
        assert_ok(stf_world_step(world, 8));
        assert_close(particle_of(world, 0).velocity.z, 16 / 64.0 + half_a_step, 8 * REAL_EPSILON);
        assert_ok(stf_world_set_gravity(world, (stf_vector){0, 0, 0}));
        assert_ok(stf_world_step(world, 0)); /* which must not make it forget */
        assert_ok(stf_world_step(world, 8));
        assert_close(particle_of(world, 0).velocity.z, 16 / 64.0, 8 * REAL_EPSILON);
        stf_world_destroy(world);
    }
}

/*
 * New records count from the next step on: as in a world that starts with them. Position Verlet counts them half a step
 * before.
 */
static void changed_records_act_from_the_very_next_step(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        const stf_world_def def = {.dimensions = 1, .integrator = stf_integrators[k], .step = 1.0 / 8};
        stf_world *changed = make_world(def), *fresh = make_world(def);

        if (stf_integrators[k] != &stf_position_verlet) {
            assert_ok(stf_world_add(changed, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
            add_force(changed, &stf_force_linear_drag, &(stf_linear_drag){0});
            assert_ok(stf_world_step(changed, 8));
            assert_ok(stf_world_set_force(changed, 1, &(stf_linear_drag){1}, 1));
            assert_ok(stf_world_step(changed, 4));

            assert_ok(stf_world_add(fresh, &(stf_particle){.position = {1, 0, 0}, .velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
            add_force(fresh, &stf_force_linear_drag, &(stf_linear_drag){1});
            assert_ok(stf_world_step(fresh, 4));
            const stf_particle p = particle_of(changed, 0), q = particle_of(fresh, 0);
            assert_memory_equal(&p, &q, sizeof p);
        }
        stf_world_destroy(changed);
        stf_world_destroy(fresh);
    }
}

/*
 * Where there is no force the step after a teleport is exact: nothing of the old motion is left, and no other particle
 * notices.
 */
static void a_teleported_particle_moves_on_as_it_was_set(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *world = make_world((stf_world_def){.integrator = stf_integrators[k], .step = 1.0 / 8});
        const stf_particle set = {.position = {7, 8, 9}, .velocity = {-1, 2, 0}, .inverse_mass = 1};

        for (int i = 0; i < 3; i++)
            assert_ok(stf_world_add(world, &(stf_particle){.velocity = {4, 0, (stf_real)i}, .inverse_mass = 1}, NULL));
        assert_ok(stf_world_step(world, 8));
        assert_ok(stf_world_set(world, 1, &set));
        assert_ok(stf_world_step(world, 8));
        const stf_particle first = particle_of(world, 0), moved = particle_of(world, 1), last = particle_of(world, 2);
        assert_true(moved.position.x == 6 && moved.position.y == 10 && moved.position.z == 9); /* eighths: exact */
        assert_true(moved.velocity.x == -1 && moved.velocity.y == 2 && moved.velocity.z == 0);
        assert_true(first.position.x == 8 && first.position.z == 0 && last.position.x == 8 && last.position.z == 4);
        stf_world_destroy(world);
    }
}

static stf_vector corner_of_a_cube(unsigned n)
{
    return (stf_vector){(stf_real)(n & 1), (stf_real)(n >> 1 & 1), (stf_real)(n >> 2)};
}

static void gravity_is_what_was_set_last(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 1});

    for (unsigned from = 0; from < 8; from++)
        for (unsigned to = 0; to < 8; to++) {
            const stf_vector after = corner_of_a_cube(to);
            assert_ok(stf_world_set_gravity(world, corner_of_a_cube(from)));
            assert_ok(stf_world_set_gravity(world, after));
            const stf_vector g = stf_world_gravity(world);
            assert_true(g.x == after.x && g.y == after.y && g.z == after.z);
        }
    stf_world_destroy(world);
}

static void gravity_pulls_along_each_axis(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 1, .gravity = {1, 2, 4}});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_step(world, 1));
    assert_ok(stf_world_set_gravity(world, (stf_vector){8, 16, 32}));
    assert_true(stf_world_gravity(world).x == 8 && stf_world_gravity(world).y == 16 && stf_world_gravity(world).z == 32);
    assert_ok(stf_world_step(world, 1));
    const stf_vector v = particle_of(world, 0).velocity;
    assert_true(v.x == 9 && v.y == 18 && v.z == 36);
    stf_world_destroy(world);
}

/* Methods of order 2 and more are exact under gravity, from the first step of each particle on. */
static void particles_added_on_the_way_start_like_the_first(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        stf_world *world =
            make_world((stf_world_def){.integrator = stf_integrators[k], .step = 1.0 / 8, .gravity = {0, -2, 0}});
        const stf_particle shot = {.velocity = {0, 4, 0}, .inverse_mass = 1};

        if (stf_integrators[k]->order < 2) {
            stf_world_destroy(world);
            continue;
        }
        for (size_t i = 0; i < 20; i++) { /* one a step; the 17th makes the world grow */
            assert_ok(stf_world_add(world, &shot, NULL));
            assert_ok(stf_world_step(world, 1));
        }
        for (size_t i = 0; i < 20; i++) {
            const double t = (double)(20 - i) / 8; /* heights of at most 4 m, rounded some twice a step */
            assert_close(particle_of(world, i).position.y, 4 * t - t * t, 2 * 20 * 4 * REAL_EPSILON);
            assert_close(particle_of(world, i).velocity.y, 4 - 2 * t, 2 * 20 * 4 * REAL_EPSILON);
        }
        stf_world_destroy(world);
    }
}

static bool describes(const stf_world *world, const char *what)
{
    char text[4096];

    stf_world_describe(world, text, sizeof text);
    return strstr(text, what) != NULL;
}

static bool steps_by_blocks(const stf_world *world) { return !describes(world, "every pass runs over the whole world"); }

static void only_link_forces_make_a_world_step_as_a_whole(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){0});
    stf_force_id drag, quadratic, link, other_link;

    assert_true(steps_by_blocks(world) && describes(world, "free flight"));
    assert_ok(stf_world_add_force(world, &stf_force_linear_drag, &(stf_linear_drag){1}, 1, &drag));
    assert_true(steps_by_blocks(world) && describes(world, "free flight"));
    assert_ok(stf_world_add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){1}, 1, &quadratic));
    assert_true(steps_by_blocks(world) && describes(world, "block by block"));
    assert_ok(stf_world_remove_force(world, quadratic));
    assert_ok(stf_world_add_force(world, &idle_link, NULL, 0, &link));
    assert_ok(stf_world_add_force(world, &idle_link, NULL, 0, &other_link));
    assert_false(steps_by_blocks(world));
    assert_ok(stf_world_remove_force(world, drag));
    assert_ok(stf_world_remove_force(world, link));
    assert_false(steps_by_blocks(world));
    assert_ok(stf_world_remove_force(world, other_link));
    assert_true(steps_by_blocks(world));
    stf_world_destroy(world);
}

static void a_zeroed_def_is_the_documented_world(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){0});

    assert_int_equal(stf_world_dimensions(world), 3);
    assert_ptr_equal(stf_world_integrator(world), &stf_semi_implicit_euler);
    assert_true(stf_world_step_size(world) == 1.0 / 60);
    assert_int_equal(stf_world_substeps(world), 1);
    assert_int_equal(stf_world_count(world), 0);
    assert_int_equal(stf_world_ticks(world), 0);
    assert_ok(stf_world_step(world, 3)); /* an empty world steps */
    assert_int_equal(stf_world_ticks(world), 3);
    stf_world_destroy(world);
}

static void run_in_turn(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    for (unsigned i = 0; i < tasks; i++)
        task(context, i);
}

static void describe_says_each_thing_in_a_line(void **state)
{
    (void)state;
    stf_world *world = busy_world(NULL);
    const double real = (double)sizeof(stf_real);
    char text[4096], expected[4096];

    snprintf(expected, sizeof expected,
             "world of 2 dimensions in " REAL_NAME ": 3 particles in 1 block of 16\n"
             "tick of 0.015625 s: 1 step of velocity_verlet (order 2, 1 evaluation)\n"
             "loops compiled for %s; a step in 1 part\n"
             "links tie particles together: every pass runs over the whole world\n"
             "                                   passes a step bytes a particle\n"
             "  position, velocity, inverse mass             - %16.1f\n"
             "  previous position                            - %16.1f   one pass a tick\n"
             "  radius                                       - %16.1f\n"
             "  velocity_verlet                              1 %16.1f\n"
             "  gravity, linear drag                         -                -   in flight part of the integrator's pass, "
             "else of F / m\n"
             "  springs                                      1 ",
             stf_world_isa(world), 5 * real, 2 * real, real,
             2 * real * (stf_velocity_verlet.history_arrays + stf_velocity_verlet.work_arrays));
    stf_world_describe(world, text, sizeof text);
    assert_memory_equal(text, expected, strlen(expected));
    assert_non_null(strstr(text, "   link, 1 record, of x v, with potential\n"
                                 "  anchored_springs                             1 "));
    assert_non_null(strstr(text, "   field, 1 record, of x v, with potential\n"
                                 "  linear_drag                                  - "));
    assert_string_equal(strstr(text, "   field, 1 record, of v\n"), "   field, 1 record, of v\n");
    stf_world_destroy(world);

    world = make_world((stf_world_def){.step = 1, .parallel = {.run = run_in_turn, .tasks = 3}});
    assert_true(describes(world, "world of 3 dimensions in " REAL_NAME ": 0 particles in 0 blocks of "));
    assert_true(describes(world, "; a step in up to 3 parts\n") && !describes(world, "rests of position and velocity"));
    stf_world_destroy(world);

    world = make_world((stf_world_def){.dimensions = 1, .compensated = true});
    snprintf(expected, sizeof expected, "\n  rests of position and velocity               - %16.1f\n", 2 * real);
    assert_true(describes(world, expected));
    stf_world_destroy(world);
}

static void describe_names_what_there_is_and_cuts_cleanly(void **state)
{
    (void)state;
    stf_world *world = busy_world(NULL);
    char text[4096], piece[4096];
    const size_t length = stf_world_describe(world, text, sizeof text);
    const char *const expected[] = {"2 dimensions", REAL_NAME, "3 particles", "velocity_verlet", "springs", "anchored_springs",
                                    "linear_drag", "previous position", "radius", "bytes a particle", "passes a step"};

    assert_int_equal(length, strlen(text));
    for (size_t i = 0; i < COUNT_OF(expected); i++)
        assert_non_null(strstr(text, expected[i]));
    for (size_t size = 1; size < length + 3; size++) {
        memset(piece, 'x', sizeof piece);
        assert_int_equal(stf_world_describe(world, piece, size), length);
        assert_int_equal(strlen(piece), size <= length ? size - 1 : length);
        assert_memory_equal(piece, text, size <= length ? size - 1 : length);
        assert_int_equal(piece[size], 'x');
    }
    assert_int_equal(stf_world_describe(world, NULL, 0), length);
    assert_int_equal(stf_world_describe(NULL, text, sizeof text), 0);
    assert_string_equal(text, "");
    stf_world_destroy(world);
}

static void records_are_replaced_by_more_by_fewer_and_by_themselves(void **state)
{
    (void)state;
    stf_world *world = busy_world(NULL);
    const stf_spring springs[] = {{0, 1, 2, 0, 0}, {1, 2, 3, 0, 0}, {2, 0, 4, 0, 0}};
    const size_t sizes[] = {3, 3, 1, 2, 0, 1};
    size_t count;

    for (size_t k = 0; k < COUNT_OF(sizes); k++) {
        assert_ok(stf_world_set_force(world, 1, springs + 3 - sizes[k], sizes[k]));
        const stf_spring *now = stf_world_force_records(world, 1, &count);
        assert_int_equal(count, sizes[k]);
        if (count > 0)
            assert_memory_equal(now, springs + 3 - sizes[k], count * sizeof *springs);
        assert_ok(stf_world_set_force(world, 1, now, count)); /* the world's own */
        now = stf_world_force_records(world, 1, &count);
        assert_int_equal(count, sizes[k]);
        if (count > 0)
            assert_memory_equal(now, springs + 3 - sizes[k], count * sizeof *springs);
        assert_ok(stf_world_step(world, 1));
    }
    /* A removal leaves fewer records than there is room for. */
    assert_ok(stf_world_set_force(world, 1, springs, 3));
    assert_ok(stf_world_remove(world, 1, NULL));
    stf_world_force_records(world, 1, &count);
    assert_int_equal(count, 1);
    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_set_force(world, 1, springs, 3));
    const stf_spring *now = stf_world_force_records(world, 1, &count);
    assert_int_equal(count, 3);
    assert_memory_equal(now, springs, sizeof springs);
    stf_world_destroy(world);
}

/* All of eight records but their padding. */
static void copy_fields(const stf_anchored_spring *springs, double fields[8][6])
{
    for (size_t s = 0; s < 8; s++) {
        const double of_this[6] = {springs[s].particle, (double)springs[s].anchor.x + 2 * (double)springs[s].anchor.y,
                                   (double)springs[s].anchor.z, (double)springs[s].stiffness,
                                   (double)springs[s].damping, (double)springs[s].rest_length};
        memcpy(fields[s], of_this, sizeof of_this);
    }
}

/* The sum of forces is rounded in the order of the records, and so the order must not depend on how they were given. */
static void anchored_springs_are_kept_in_one_order(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){0});
    stf_anchored_spring springs[8];
    double first[8][6];
    stf_force_id id;
    uint64_t seed = 4;
    size_t count;

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    for (size_t s = 0; s < COUNT_OF(springs); s++) /* pairs that differ in one field each, the last in none */
        springs[s] = (stf_anchored_spring){.particle = s == 0,
                                           .anchor = {s == 1, s == 2, s == 3},
                                           .stiffness = s == 4,
                                           .damping = s == 5,
                                           .rest_length = s == 6};
    assert_ok(stf_world_add_force(world, &stf_force_anchored_springs, springs, COUNT_OF(springs), &id));
    copy_fields(stf_world_force_records(world, id, &count), first);
    for (int round = 0; round < 50; round++) {
        for (size_t s = COUNT_OF(springs) - 1; s > 0; s--) {
            const size_t other = (size_t)(next_random(&seed) * (double)(s + 1));
            const stf_anchored_spring kept = springs[s];
            springs[s] = springs[other];
            springs[other] = kept;
        }
        assert_ok(stf_world_set_force(world, id, springs, COUNT_OF(springs)));
        double now[8][6];
        copy_fields(stf_world_force_records(world, id, &count), now);
        assert_memory_equal(now, first, sizeof first);
    }
    stf_world_destroy(world);
}

/* The particle that takes the place of a removed one brings its history along, and does not take over the other's. */
static void a_moved_particle_goes_on_as_if_alone(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        const stf_world_def def = {.integrator = stf_integrators[k], .step = 1.0 / 8};
        stf_world *pair = make_world(def), *alone = make_world(def);
        size_t moved;

        assert_ok(stf_world_add(pair, &(stf_particle){.position = {5, 0, 0}, .inverse_mass = 1}, NULL));
        assert_ok(stf_world_add(pair, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
        assert_ok(stf_world_add(alone, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
        add_force(pair, &stf_force_linear_drag, &(stf_linear_drag){1});
        add_force(alone, &stf_force_linear_drag, &(stf_linear_drag){1});
        assert_ok(stf_world_step(pair, 4));
        assert_ok(stf_world_step(alone, 4));
        assert_ok(stf_world_remove(pair, 0, &moved));
        assert_ok(stf_world_set_force(alone, 1, &(stf_linear_drag){1}, 1)); /* has velocity Verlet accelerate anew, as removing does */
        assert_ok(stf_world_step(pair, 4));
        assert_ok(stf_world_step(alone, 4));
        const stf_particle p = particle_of(pair, 0), q = particle_of(alone, 0);
        assert_memory_equal(&p, &q, sizeof p);
        stf_world_destroy(pair);
        stf_world_destroy(alone);
    }
}

/* An impulse given by get and set does not make a blended position jump; a new position does not blend. */
static void only_a_new_position_is_a_teleport(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .step = 1, .keep_previous = true});
    float x;

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {2, 0, 0}}, NULL));
    assert_ok(stf_world_step(world, 1));
    stf_particle particle = particle_of(world, 0);
    particle.velocity.x = 4;
    assert_ok(stf_world_set(world, 0, &particle));
    assert_ok(stf_world_copy_positions(world, 0.5, &x, 0));
    assert_true(x == 1);
    particle.position.x = 3;
    assert_ok(stf_world_set(world, 0, &particle));
    assert_ok(stf_world_copy_positions(world, 0.5, &x, 0));
    assert_true(x == 3);
    stf_world_destroy(world);
}

/* Few and large moves, however the particles come in. */
static void many_small_lots_move_the_world_seldom(void **state)
{
    (void)state;
    static const stf_particle lot[100];
    counting c = {0}, exact = {0};
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .allocator = counting_allocator(&c)});
    stf_world *once = make_world((stf_world_def){.dimensions = 1, .allocator = counting_allocator(&exact)});

    for (int n = 0; n < 1000; n++)
        assert_ok(stf_world_add_many(world, lot, COUNT_OF(lot), NULL));
    assert_true(c.calls < 2 + 17); /* the world, its first room, and log2(100,000) doublings */

    stf_particle *all = calloc(100000, sizeof *all);
    assert_non_null(all);
    assert_ok(stf_world_add_many(once, all, 100000, NULL));
    assert_true(exact.bytes < 100000 * 5 * sizeof(stf_real)); /* state and a work array: nothing to spare but the last block */
    free(all);
    stf_world_destroy(world);
    stf_world_destroy(once);
}

/* A world that has no particles yet has nothing to grow from, whatever was reserved. */
static void room_for_a_first_lot_is_exact(void **state)
{
    (void)state;
    enum { RESERVED = 90000, LOT = 100000 };
    counting c = {0};
    stf_world *world = make_world((stf_world_def){.dimensions = 1, .allocator = counting_allocator(&c)});
    stf_particle *lot = calloc(LOT, sizeof *lot);

    assert_non_null(lot);
    assert_ok(stf_world_reserve(world, RESERVED));
    assert_ok(stf_world_add_many(world, lot, LOT, NULL));
    assert_true(c.bytes < LOT * 4 * sizeof(stf_real)); /* state, inverse mass, and no more than a block to work in */
    free(lot);
    stf_world_destroy(world);
}

static void forces_without_records_sleep(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.dimensions = 1});
    stf_force_id drag, springs;
    stf_energy energy;
    const stf_spring spring = {0, 1, 1, 0, 0};

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 0, 0}, .inverse_mass = 1}, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.position = {2, 0, 0}, .inverse_mass = 1}, NULL));
    assert_ok(stf_world_add_force(world, &stf_force_linear_drag, NULL, 0, &drag));
    assert_ok(stf_world_add_force(world, &stf_force_springs, NULL, 0, &springs));
    assert_true(steps_by_blocks(world));
    assert_ok(stf_world_step(world, 1));
    assert_ok(stf_world_energy(world, &energy));
    assert_true(particle_of(world, 0).velocity.x == 1 && energy.potential == 0);

    assert_ok(stf_world_set_force(world, springs, &spring, 1));
    assert_false(steps_by_blocks(world));
    assert_ok(stf_world_step(world, 1));
    assert_above(particle_of(world, 0).velocity.x, 1);
    assert_ok(stf_world_remove(world, 1, NULL));
    assert_true(steps_by_blocks(world));
    assert_ok(stf_world_step(world, 1));
    stf_world_destroy(world);
}

/* The change of velocity of particle `index` in a step of 1 s, relative to -mu / r^2. */
static double relative_pull(stf_world *world, size_t index, double expected)
{
    assert_ok(stf_world_step(world, 1));
    const double pull = (double)particle_of(world, index).velocity.x / -expected;
    stf_world_destroy(world);
    return pull;
}

/* Where mu / r, mu / r^2 and newtons are floats, attraction is right: the cube of r need not be one. */
static void attraction_reaches_to_the_edge_of_the_reals(void **state)
{
    (void)state;
    const struct {
        double strength, distance, mass;
    } cases[] = {{1, 1e-18, 1}, {1, 1e-13, 1}, {1, 1e-6, 1e6}, {1, 1, 1e-6}, {1, 1e6, 1}, {1, 1e15, 1},  {1, 1e16, 1},
                 {1, 1e18, 1},  {1e36, 1e18, 1e-6}, {1e-24, 1e-12, 1e6}, {1.327e20, 7.4e12, 0.1}};

    for (size_t k = 0; k < COUNT_OF(cases); k++) {
        const double expected = cases[k].strength / cases[k].distance / cases[k].distance;
        const stf_world_def def = {.dimensions = 1, .step = 1};
        stf_world *field = make_world(def), *pair = make_world(def);
        const stf_particle light = {.position = {(stf_real)cases[k].distance, 0, 0},
                                    .inverse_mass = (stf_real)(1 / cases[k].mass)};
        const stf_attractor attractor = {.strength = (stf_real)cases[k].strength};
        const stf_all_pairs_gravity gravity = {.gravitational_constant = (stf_real)cases[k].strength};

        assert_ok(stf_world_add(field, &light, NULL));
        assert_ok(stf_world_add_force(field, &stf_force_attractor, &attractor, 1, NULL));
        assert_ok(stf_world_add(pair, &(stf_particle){.inverse_mass = 1}, NULL));
        assert_ok(stf_world_add(pair, &light, NULL));
        assert_ok(stf_world_add_force(pair, &stf_force_all_pairs_gravity, &gravity, 1, NULL));
        assert_close(relative_pull(field, 0, expected), 1, 10 * REAL_EPSILON);
        assert_close(relative_pull(pair, 1, expected), 1, 10 * REAL_EPSILON);
    }
}

static void known_integrators_and_records_take_no_more_memory(void **state)
{
    (void)state;
    counting c = {0};
    const stf_allocator allocator = counting_allocator(&c);
    stf_world *world = busy_world(&allocator);
    const stf_spring springs[] = {{0, 1, 1, 0, 0}, {0, 2, 1, 0, 0}, {1, 2, 1, 0, 0}};

    for (int k = 0; stf_integrators[k]; k++)
        assert_ok(stf_world_set_integrator(world, stf_integrators[k]));
    assert_ok(stf_world_set_force(world, 1, springs, 3));
    const size_t calls = c.calls;
    for (int round = 0; round < 3; round++) {
        for (int k = 0; stf_integrators[k]; k++) {
            assert_ok(stf_world_set_integrator(world, stf_integrators[k]));
            assert_ok(stf_world_step(world, 1));
        }
        assert_ok(stf_world_set_force(world, 1, springs + round, (size_t)(3 - round)));
    }
    assert_ok(stf_world_remove(world, 0, NULL));
    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_set_force(world, 1, springs, 3));
    assert_int_equal(c.calls, calls);
    stf_world_destroy(world);
}

static void forces_keep_their_ids(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){0});
    stf_force_id ids[20], again;
    size_t count;

    for (uint32_t i = 0; i < 20; i++) {
        const stf_linear_drag drag = {(stf_real)i};
        assert_ok(stf_world_add_force(world, &stf_force_linear_drag, &drag, 1, &ids[i]));
    }
    for (uint32_t i = 0; i < 20; i += 2)
        assert_ok(stf_world_remove_force(world, ids[i]));
    for (uint32_t i = 0; i < 20; i++) {
        const stf_linear_drag *drag = stf_world_force_records(world, ids[i], &count);
        assert_int_equal(count, i % 2);
        assert_true(i % 2 ? drag->coefficient == (stf_real)i : drag == NULL);
        assert_int_equal(stf_world_force_at(world, i), i < 10 ? ids[2 * i + 1] : 0);
    }
    assert_ok(stf_world_add_force(world, &stf_force_linear_drag, &(stf_linear_drag){1}, 1, &again));
    assert_int_equal(again, ids[19] + 1);
    stf_world_destroy(world);
}

static void clear_empties_and_keeps_the_rest(void **state)
{
    (void)state;
    stf_world *world = busy_world(NULL);
    const double time = stf_world_time(world);

    assert_ok(stf_world_clear(world));
    assert_int_equal(stf_world_count(world), 0);
    assert_true(stf_world_time(world) == time);
    assert_ok(stf_world_add(world, &(stf_particle){.position = {1, 0, 0}}, NULL));
    assert_ok(stf_world_step(world, 10));
    const stf_particle particle = particle_of(world, 0);
    assert_true(particle.position.x == 1 && particle.velocity.y == 0);
    stf_world_destroy(world);
}

static void every_scene_is_made_and_stays_finite_with_its_own_integrator(void **state)
{
    (void)state;
    for (int s = 0; scenes[s]; s++) {
        stf_world *world;

        assert_ok(scene_create(scenes[s], NULL, &world));
        assert_true(stf_world_count(world) > 0);
        assert_ok(stf_world_step(world, (unsigned)(scenes[s]->duration / scenes[s]->step)));
        assert_false(stf_world_find_non_finite(world, NULL));
        if (scenes[s]->exact) /* a good step for it: within a tenth of its size; explicit Euler on drag is the lecture's */
            assert_below(scene_error(scenes[s], world), 0.1 * scenes[s]->size);
        else
            assert_true(isnan(scene_error(scenes[s], world)));
        assert_ptr_equal(scene_find(scenes[s]->name), scenes[s]);
        stf_world_destroy(world);
    }
    assert_null(scene_find("nowhere"));
}

/*
 * The exact solutions of the scenes are solutions: they start where the particles start, and their v is the slope of their
 * x.
 */
static void exact_solutions_are_consistent(void **state)
{
    (void)state;
    const double h = 1e-5, round_off = 1e-9;

    for (int s = 0; scenes[s]; s++) {
        stf_world *world;

        if (!scenes[s]->exact)
            continue;
        assert_ok(scene_create(scenes[s], NULL, &world));
        assert_below(scene_error(scenes[s], world), scenes[s]->size * 4 * REAL_EPSILON);
        for (size_t i = 0; i < stf_world_count(world); i++)
            for (double t = 0.125; t < scenes[s]->duration; t += scenes[s]->duration / 7) {
                double before[3], after[3], x[3], v[3], unused[3];
                if (!scenes[s]->exact(i, t, x, v))
                    continue;
                scenes[s]->exact(i, t - h, before, unused);
                scenes[s]->exact(i, t + h, after, unused);
                for (int d = 0; d < 3; d++) /* h^2 / 6 times a third derivative of up to some 100, and round-off over h */
                    assert_close((after[d] - before[d]) / (2 * h), v[d], h * h * 100 + round_off * scenes[s]->size);
            }
        stf_world_destroy(world);
    }
}

static void describe_tells_how_a_world_steps(void **state)
{
    (void)state;
    const stf_integrator plain = {.name = "plain", .step = stf_rk4.step, .work_arrays = stf_rk4.work_arrays};
    const struct {
        stf_world_def def;
        const stf_force *force;
        const char *expected;
    } cases[] = {
        {{.parallel = {.run = run_in_turn, .tasks = 3}}, NULL, "a step in up to 3 parts"},
        {{.step = 1}, NULL, "free flight"},
        {{.integrator = &plain}, NULL, "block by block"},
        {{.step = 1}, &time_force, "field, 0 records, of t"},
        {{.step = 1}, &idle_link, "links tie particles together"},
    };

    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        stf_world *world = make_world(cases[i].def);
        char text[2048];

        if (cases[i].force)
            add_force(world, cases[i].force, NULL);
        stf_world_describe(world, text, sizeof text);
        assert_non_null(strstr(text, cases[i].expected));
        stf_world_destroy(world);
    }
}

static void an_empty_lot_needs_no_particles(void **state)
{
    (void)state;
    stf_world *world = busy_world(NULL);
    const uint64_t before = hash_of(world);
    size_t first = 77;

    assert_ok(stf_world_add_many(world, NULL, 0, &first));
    assert_true(first == 3 && hash_of(world) == before);
    stf_world_destroy(world);
}

static size_t too_many(size_t record_count) { return record_count > 1 ? SIZE_MAX : 0; }

static void a_force_says_how_many_records_are_too_many(void **state)
{
    (void)state;
    const stf_force lonely = {.name = "lonely", .record_size = sizeof(stf_linear_drag), .apply = stf_force_quadratic_drag.apply,
                              .arranged_size = too_many};
    const stf_quadratic_drag records[2] = {{1}, {2}};
    stf_world *world = busy_world(NULL);
    const uint64_t before = hash_of(world);

    assert_refused(stf_world_add_force(world, &lonely, records, 2, NULL), STF_ERROR_MEMORY);
    assert_true(hash_of(world) == before);
    assert_ok(stf_world_add_force(world, &lonely, records, 1, NULL));
    stf_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bad_particle_late_in_a_lot_leaves_nothing_of_it),
        cmocka_unit_test(every_result_has_its_own_text),
        cmocka_unit_test(all_memory_comes_from_the_allocator_and_goes_back),
        cmocka_unit_test(steps_and_questions_allocate_nothing),
        cmocka_unit_test(no_room_is_asked_for_whose_bytes_wrap_round),
        cmocka_unit_test(time_is_ticks_times_step),
        cmocka_unit_test(forces_see_the_time_of_their_stage),
        cmocka_unit_test(forces_see_the_time_that_the_world_says_after_a_change_of_step),
        cmocka_unit_test(an_integrator_goes_on_as_if_it_had_started_there),
        cmocka_unit_test(every_history_moves_with_its_particles),
        cmocka_unit_test(masses_and_radii_are_taken_up_to_their_limits),
        cmocka_unit_test(radii_are_kept_where_the_def_asks_for_them),
        cmocka_unit_test(positions_are_copied_out_blended_and_strided),
        cmocka_unit_test(energy_and_momentum_are_their_sums),
        cmocka_unit_test(immovable_particles_have_no_gravitational_energy),
        cmocka_unit_test(the_first_non_finite_particle_is_found),
        cmocka_unit_test(changed_forces_act_from_the_very_next_step),
        cmocka_unit_test(changed_records_act_from_the_very_next_step),
        cmocka_unit_test(a_teleported_particle_moves_on_as_it_was_set),
        cmocka_unit_test(gravity_is_what_was_set_last),
        cmocka_unit_test(gravity_pulls_along_each_axis),
        cmocka_unit_test(particles_added_on_the_way_start_like_the_first),
        cmocka_unit_test(only_link_forces_make_a_world_step_as_a_whole),
        cmocka_unit_test(a_zeroed_def_is_the_documented_world),
        cmocka_unit_test(describe_says_each_thing_in_a_line),
        cmocka_unit_test(describe_names_what_there_is_and_cuts_cleanly),
        cmocka_unit_test(records_are_replaced_by_more_by_fewer_and_by_themselves),
        cmocka_unit_test(anchored_springs_are_kept_in_one_order),
        cmocka_unit_test(a_moved_particle_goes_on_as_if_alone),
        cmocka_unit_test(only_a_new_position_is_a_teleport),
        cmocka_unit_test(many_small_lots_move_the_world_seldom),
        cmocka_unit_test(room_for_a_first_lot_is_exact),
        cmocka_unit_test(forces_without_records_sleep),
        cmocka_unit_test(attraction_reaches_to_the_edge_of_the_reals),
        cmocka_unit_test(known_integrators_and_records_take_no_more_memory),
        cmocka_unit_test(forces_keep_their_ids),
        cmocka_unit_test(clear_empties_and_keeps_the_rest),
        cmocka_unit_test(every_scene_is_made_and_stays_finite_with_its_own_integrator),
        cmocka_unit_test(exact_solutions_are_consistent),
        cmocka_unit_test(describe_tells_how_a_world_steps),
        cmocka_unit_test(an_empty_lot_needs_no_particles),
        cmocka_unit_test(a_force_says_how_many_records_are_too_many),
    };

    return cmocka_run_group_tests_name("world, " REAL_NAME, tests, NULL, NULL);
}
