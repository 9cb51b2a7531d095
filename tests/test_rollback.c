/* Snapshots: what was comes back, whatever has happened since, without an allocation. */
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"
#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"
#include "support/saved.h"

/* A snapshot in memory of exactly its size, and what the world was then. */
typedef struct moment {
    unsigned char *bytes;
    size_t size;
    saved then;
} moment;

static moment snapshot_of(const stf_world *world)
{
    moment m = {.size = stf_world_snapshot_size(world), .then = save_of(world)};

    m.bytes = malloc(m.size);
    assert_non_null(m.bytes);
    assert_ok(stf_world_snapshot(world, m.bytes, m.size));
    return m;
}

static void forget(moment *m)
{
    free(m->bytes);
    saved_free(&m->then);
}

static void every_scene_is_run_again_with_the_same_bits(void **state)
{
    (void)state;
    for (int n = 0; scenes[n]; n++)
        for (int k = 0; saved_integrators[k]; k++) {
            const stf_world_def def = {.integrator = saved_integrators[k], .keep_previous = n % 2 == 0};
            stf_world *world;

            assert_ok(scene_create(scenes[n], &def, &world));
            for (unsigned tick = 0; tick < 6; tick++) {
                moment m = snapshot_of(world);
                assert_ok(stf_world_step(world, 4));
                saved after = save_of(world);
                assert_ok(stf_world_restore(world, m.bytes, m.size));
                assert_true(saved_is(m.then, world));
                assert_ok(stf_world_step(world, 4));
                assert_true(saved_is(after, world));
                saved_free(&after);
                forget(&m);
            }
            stf_world_destroy(world);
        }
}

/* Back over every event, and over several; the events happen again as they did. */
static void events_are_undone_and_done_again_without_an_allocation(void **state)
{
    (void)state;
    enum { TICKS = 24, BACK = 5 };

    for (int k = 0; saved_integrators[k]; k++) {
        counting memory = {.blocks = 0};
        stf_world *world = busy_world(saved_integrators[k], 0, counting_allocator(&memory));
        moment moments[TICKS + 1];

        for (unsigned n = 0; n < TICKS; n++) {
            moments[n] = snapshot_of(world);
            busy_event(world, n);
            assert_ok(stf_world_step(world, 1));
            const size_t calls = memory.calls;
            for (unsigned back = n < BACK ? 0 : n - BACK; back <= n; back++) {
                moments[n + 1] = snapshot_of(world);
                assert_ok(stf_world_restore(world, moments[back].bytes, moments[back].size));
                assert_true(saved_is(moments[back].then, world));
                for (unsigned again = back; again <= n; again++) {
                    busy_event(world, again);
                    assert_ok(stf_world_step(world, 1));
                }
                assert_true(saved_is(moments[n + 1].then, world));
                forget(&moments[n + 1]);
            }
            assert_int_equal(memory.calls, calls);
        }
        for (unsigned n = 0; n < TICKS; n++)
            forget(&moments[n]);
        stf_world_destroy(world);
        assert_int_equal(memory.blocks, 0);
    }
}

/* Over sizes of blocks, and with lanes of no particle between. */
static void a_world_that_grew_or_shrank_is_what_it_was(void **state)
{
    (void)state;
    static const size_t counts[] = {0, 1, 15, 16, 17, 100, 255, 256, 257, 1000};

    for (size_t from = 0; from < COUNT_OF(counts); from++)
        for (size_t to = 0; to < COUNT_OF(counts); to++) {
            stf_world *world = make_world((stf_world_def){.dimensions = 3, .integrator = &stf_velocity_verlet,
                                                          .keep_previous = true, .keep_radius = true});
            uint64_t seed = from + 100 * to;

            add_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){1, 1});
            for (size_t i = 0; i < counts[from]; i++)
                assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)next_random(&seed), (stf_real)i, 0},
                                                               .inverse_mass = 1, .radius = 1}, NULL));
            assert_ok(stf_world_step(world, 1));
            moment m = snapshot_of(world);
            assert_ok(stf_world_step(world, 1));
            saved after = save_of(world);
            while (stf_world_count(world) < counts[to])
                assert_ok(stf_world_add(world, &(stf_particle){.position = {7, (stf_real)next_random(&seed), 1},
                                                               .inverse_mass = 1, .radius = 2}, NULL));
            while (stf_world_count(world) > counts[to])
                assert_ok(stf_world_remove(world, 0, NULL));
            assert_ok(stf_world_step(world, 1));

            assert_ok(stf_world_restore(world, m.bytes, m.size));
            assert_true(saved_is(m.then, world));
            assert_ok(stf_world_step(world, 1));
            assert_true(saved_is(after, world));
            saved_free(&after);
            forget(&m);
            stf_world_destroy(world);
        }
}

static void another_integrator_is_undone(void **state)
{
    (void)state;
    for (int from = 0; saved_integrators[from]; from++)
        for (int to = 0; saved_integrators[to]; to++) {
            stf_world *world = busy_world(saved_integrators[from], 0, (stf_allocator){.user = NULL});

            assert_ok(stf_world_step(world, 3));
            moment m = snapshot_of(world);
            assert_ok(stf_world_step(world, 2));
            saved after = save_of(world);
            assert_ok(stf_world_restore(world, m.bytes, m.size));
            assert_ok(stf_world_set_integrator(world, saved_integrators[to]));
            assert_ok(stf_world_step(world, 2));
            assert_ok(stf_world_restore(world, m.bytes, m.size));
            assert_true(saved_is(m.then, world));
            assert_ok(stf_world_step(world, 2));
            assert_true(saved_is(after, world));
            saved_free(&after);
            forget(&m);
            stf_world_destroy(world);
        }
}

static void forces_that_were_added_since_go(void **state)
{
    (void)state;
    counting memory = {.blocks = 0};
    stf_world *world = busy_world(&stf_rk4, 0, counting_allocator(&memory));
    const size_t blocks = memory.blocks;
    moment before = snapshot_of(world);
    stf_force_id id, again;

    assert_ok(stf_world_add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){1}, 1, &id));
    add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 1});
    moment later = snapshot_of(world);
    assert_ok(stf_world_restore(world, before.bytes, before.size));
    assert_true(saved_is(before.then, world));
    assert_int_equal(memory.blocks, blocks);
    assert_ok(stf_world_add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){2}, 1, &again));
    assert_int_equal(again, id);

    assert_refused(stf_world_restore(world, later.bytes, later.size), STF_ERROR_SNAPSHOT); /* its attractor is gone */
    add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 3});
    assert_ok(stf_world_restore(world, later.bytes, later.size));
    assert_true(saved_is(later.then, world));
    forget(&later);
    forget(&before);
    stf_world_destroy(world);
    assert_int_equal(memory.blocks, 0);
}

static void push_nothing(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)particles, (void)time;
}

/* Sizes are compared with 0 in many places: this one is as near as it gets. */
static void a_record_of_one_byte_is_kept(void **state)
{
    (void)state;
    static const stf_force force = {.name = "one byte", .record_size = 1, .apply = push_nothing, .fields = "1"};
    stf_world *world = make_world((stf_world_def){.step = 1});
    stf_force_id id;
    size_t count;

    assert_ok(stf_world_add_force(world, &force, &(uint8_t){7}, 1, &id));
    moment before = snapshot_of(world);
    for (int load = 0; load < 2; load++) {
        assert_ok(stf_world_set_force(world, id, &(uint8_t){8}, 1));
        assert_false(saved_is(before.then, world));
        if (load)
            assert_ok(stf_world_load(world, before.then.bytes, before.then.size, NULL));
        else
            assert_ok(stf_world_restore(world, before.bytes, before.size));
        assert_int_equal(*(const uint8_t *)stf_world_force_records(world, id, &count), 7);
        assert_int_equal(count, 1);
    }
    forget(&before);
    stf_world_destroy(world);
}

static void assert_not_restored(stf_world *world, const moment *m, size_t size)
{
    saved before = save_of(world);

    assert_refused(stf_world_restore(world, m->bytes, size), STF_ERROR_SNAPSHOT);
    assert_true(saved_is(before, world));
    saved_free(&before);
}

static void stand_still(stf_system *system, stf_real dt) { (void)system, (void)dt; }

static void what_is_no_snapshot_of_it_is_refused(void **state)
{
    (void)state;
    static const stf_integrator idle = {.name = "idle", .step = stand_still, .history_arrays = 1};
    const stf_world_def others[] = {
        {.dimensions = 3, .keep_previous = true, .keep_radius = true, .capacity = 100},
        {.dimensions = 2, .keep_previous = false, .keep_radius = true, .capacity = 100},
        {.dimensions = 2, .keep_previous = true, .keep_radius = false, .capacity = 100},
        {.dimensions = 2, .keep_previous = true, .keep_radius = true, .capacity = 100}, /* no room for history */
        {.dimensions = 2, .keep_previous = true, .keep_radius = true, .capacity = 100, .integrator = &idle}, /* nor for work */
    };
    stf_world *world = make_world((stf_world_def){.dimensions = 2, .keep_previous = true, .keep_radius = true,
                                                  .integrator = &stf_velocity_verlet, .capacity = 100});
    stf_world *small = make_world((stf_world_def){.dimensions = 2, .keep_previous = true, .keep_radius = true,
                                                  .integrator = &stf_velocity_verlet});
    const stf_spring springs[] = {{0, 1, 1, 0, 0}, {0, 1, 2, 0, 0}};

    for (int i = 0; i < 40; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)i, 0, 0}, .inverse_mass = 1}, NULL));
    moment m = snapshot_of(world);
    for (size_t size = 0; size < m.size; size++)
        assert_not_restored(world, &m, size);
    assert_refused(stf_world_snapshot(world, m.bytes, m.size - 1), STF_ERROR_BUFFER);
    for (size_t i = 0; i < COUNT_OF(others); i++) {
        stf_world *other = make_world(others[i]);
        assert_not_restored(other, &m, m.size);
        stf_world_destroy(other);
    }
    assert_not_restored(small, &m, m.size);
    assert_ok(stf_world_reserve(small, 40));
    assert_ok(stf_world_restore(small, m.bytes, m.size));
    assert_true(saved_is(m.then, small));
    m.bytes[0] ^= 1;
    assert_not_restored(world, &m, m.size);
    forget(&m);

    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, 2, NULL));
    assert_ok(stf_world_add_force(small, &stf_force_springs, springs, 1, NULL));
    m = snapshot_of(world);
    assert_not_restored(small, &m, m.size); /* room for one record */
    assert_ok(stf_world_set_force(small, 1, springs, 2));
    assert_ok(stf_world_restore(small, m.bytes, m.size));
    assert_true(saved_is(m.then, small));
    stf_world *another = make_world((stf_world_def){.dimensions = 2, .keep_previous = true, .keep_radius = true,
                                                    .integrator = &stf_velocity_verlet, .capacity = 100});
    add_force(another, &stf_force_linear_drag, &(stf_linear_drag){1});
    assert_not_restored(another, &m, m.size); /* of the same id, another force */
    stf_world_destroy(another);
    assert_ok(stf_world_remove_force(world, 1));
    assert_not_restored(world, &m, m.size);
    add_force(world, &stf_force_springs, NULL);
    assert_not_restored(world, &m, m.size);

    assert_int_equal(stf_world_snapshot_size(NULL), 0);
    assert_refused(stf_world_snapshot(NULL, m.bytes, m.size), STF_ERROR_NULL);
    assert_refused(stf_world_snapshot(world, NULL, m.size), STF_ERROR_NULL);
    assert_refused(stf_world_restore(NULL, m.bytes, m.size), STF_ERROR_NULL);
    assert_refused(stf_world_restore(world, NULL, m.size), STF_ERROR_NULL);
    forget(&m);
    stf_world_destroy(small);
    stf_world_destroy(world);
}

static void a_force_without_records_is_restored(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 1});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    add_force(world, &time_force, NULL);
    moment m = snapshot_of(world);
    assert_ok(stf_world_step(world, 3));
    assert_ok(stf_world_restore(world, m.bytes, m.size));
    assert_true(saved_is(m.then, world));
    forget(&m);
    stf_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_is_run_again_with_the_same_bits),
        cmocka_unit_test(events_are_undone_and_done_again_without_an_allocation),
        cmocka_unit_test(a_world_that_grew_or_shrank_is_what_it_was),
        cmocka_unit_test(another_integrator_is_undone),
        cmocka_unit_test(forces_that_were_added_since_go),
        cmocka_unit_test(a_record_of_one_byte_is_kept),
        cmocka_unit_test(what_is_no_snapshot_of_it_is_refused),
        cmocka_unit_test(a_force_without_records_is_restored),
    };

    return cmocka_run_group_tests_name("rollback, " REAL_NAME, tests, NULL, NULL);
}
