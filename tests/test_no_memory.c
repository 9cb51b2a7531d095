/*
 * Every allocation fails once, in every call that allocates, on every scene: the call says so, the world is what it was, no
 * memory is lost, and the same call then passes and gives what it gives to a world that never lacked any.
 */
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"
#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"
#include "support/saved.h"
#include "support/trade_scene.h"

static counting memory;

/* ---- calls --------------------------------------------------------------------------------------------------------------- */

#define LOT 300

static saved larger; /* the scene with a lot of particles more */

static stf_result reserve(stf_world *world) { return stf_world_reserve(world, 3 * stf_world_count(world) + LOT); }
static stf_result add(stf_world *world) { return stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL); }

static stf_result add_many(stf_world *world)
{
    static const stf_particle lot[LOT] = {{.inverse_mass = 1}};

    return stf_world_add_many(world, lot, LOT, NULL);
}

static stf_result add_force_of_no_records(stf_world *world) { return stf_world_add_force(world, &time_force, NULL, 0, NULL); }

static stf_result add_force_of_records(stf_world *world)
{
    return stf_world_add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 1, .softening = 1}, 1, NULL);
}

static stf_result add_link(stf_world *world)
{
    const stf_spring spring = {.a = 0, .b = 1, .stiffness = 1};

    return stf_world_add_force(world, &stf_force_springs, &spring, stf_world_count(world) > 1 ? 1 : 0, NULL);
}

/* Twice the records that it has. */
static stf_result set_force(stf_world *world)
{
    const stf_force_id id = stf_world_force_at(world, 0);
    size_t count;
    const void *records = stf_world_force_records(world, id, &count);
    const size_t bytes = count * stf_world_force(world, id)->record_size;
    char *twice = malloc(2 * bytes);

    assert_true(twice && bytes > 0);
    memcpy(twice, records, bytes);
    memcpy(twice + bytes, records, bytes);
    const stf_result result = stf_world_set_force(world, id, twice, 2 * count);
    free(twice);
    return result;
}

static stf_result set_integrator(stf_world *world) { return stf_world_set_integrator(world, &remembering); }
static stf_result load(stf_world *world) { return stf_world_load(world, larger.bytes, larger.size, NULL); }

static stf_result measure_stability(stf_world *world)
{
    stf_stability found;

    return stf_stability_measure(world, &(stf_stability_def){.allocator = counting_allocator(&memory)}, &found);
}

static const struct call {
    const char *name;
    stf_result (*run)(stf_world *world);
} calls[] = {
    {"reserve", reserve},
    {"add", add},
    {"add many", add_many},
    {"add a force of no records", add_force_of_no_records},
    {"add a force of records", add_force_of_records},
    {"add a link", add_link},
    {"set a force", set_force},
    {"set the integrator", set_integrator},
    {"load", load},
    {"measure the stability", measure_stability},
};

/* ---- each of them, on each scene ----------------------------------------------------------------------------------------- */

#define SILENT_MOST 20000 /* runs of a call until there is no room left */

static stf_world *make_scene(const scene *s)
{
    const stf_world_def def = {.keep_previous = true, .keep_radius = true, .allocator = counting_allocator(&memory)};
    stf_world *world;

    memory = (counting){.calls = 0};
    assert_ok(scene_create(s, &def, &world));
    return world;
}

/* In motion, and so often called already that the next call allocates. */
static stf_world *make_subject(const scene *s, const struct call *call, size_t silent)
{
    stf_world *world = make_scene(s);

    assert_ok(stf_world_step(world, 2));
    for (size_t i = 0; i < silent; i++)
        assert_ok(call->run(world));
    return world;
}

static size_t count_silent_runs(const scene *s, const struct call *call)
{
    stf_world *world = make_subject(s, call, 0);
    const size_t before = memory.calls;
    size_t runs = 0;

    while (assert_ok(call->run(world)), memory.calls == before)
        assert_true(++runs < SILENT_MOST);
    stf_world_destroy(world);
    return runs;
}

/* Runs the call, which has the memory that it wants, and some ticks; what comes out, and the bytes that are then in use. */
static saved run_and_end(stf_world *world, const struct call *call, size_t *bytes)
{
    assert_ok(call->run(world));
    *bytes = memory.bytes;
    assert_ok(stf_world_step(world, 2));
    const saved after = save_of(world);
    stf_world_destroy(world);
    assert_int_equal(memory.blocks, 0);
    assert_int_equal(memory.bytes, 0);
    return after;
}

/* The n-th allocation of the call fails. False: it has no n-th. */
static bool survives(const scene *s, const struct call *call, size_t silent, size_t n, saved expected, size_t expected_bytes)
{
    stf_world *world = make_subject(s, call, silent);
    saved before = save_of(world);
    const uint64_t hash = hash_of(world);
    size_t bytes;

    memory.fail_at = memory.calls + n;
    const stf_result result = call->run(world);
    const bool has_failed = memory.calls >= memory.fail_at;
    if (has_failed) {
        assert_refused(result, STF_ERROR_MEMORY);
        assert_true(saved_is(before, world) && hash_of(world) == hash);
        saved after = run_and_end(world, call, &bytes);
        assert_true(after.size == expected.size && memcmp(after.bytes, expected.bytes, after.size) == 0);
        assert_int_equal(bytes, expected_bytes);
        saved_free(&after);
    } else {
        assert_ok(result);
        stf_world_destroy(world);
    }
    saved_free(&before);
    return has_failed;
}

/* How many allocations the call has, each of which failed once. */
static size_t check_call(const scene *s, const struct call *call)
{
    const size_t silent = count_silent_runs(s, call);
    size_t bytes, n = 1;
    saved expected = run_and_end(make_subject(s, call, silent), call, &bytes);

    while (survives(s, call, silent, n, expected, bytes))
        n++;
    if (n == 1)
        print_error("%s: %s never asks for memory\n", s->name, call->name);
    assert_true(n > 1);
    saved_free(&expected);
    return n - 1;
}

static void every_call_survives_every_lack_of_memory(void **state)
{
    (void)state;
    size_t failures = 0;

    for (const scene *const *s = scenes; *s; s++) {
        stf_world *world = make_scene(*s);

        assert_ok(add_many(world));
        larger = save_of(world);
        stf_world_destroy(world);
        for (size_t i = 0; i < COUNT_OF(calls); i++)
            failures += check_call(*s, &calls[i]);
        saved_free(&larger);
    }
    print_message("%zu allocations failed\n", failures);
}

static void no_scene_is_left_half_made(void **state)
{
    (void)state;
    for (const scene *const *s = scenes; *s; s++) {
        bool is_made = false;

        for (size_t n = 1; !is_made; n++) {
            stf_world *world = NULL;

            memory = (counting){.fail_at = n};
            const stf_world_def def = {.keep_previous = true, .keep_radius = true, .allocator = counting_allocator(&memory)};
            const stf_result result = scene_create(*s, &def, &world);
            is_made = memory.calls < n;
            assert_refused(result, is_made ? STF_OK : STF_ERROR_MEMORY);
            assert_true(is_made == (world != NULL));
            stf_world_destroy(world);
            assert_int_equal(memory.blocks, 0);
            assert_int_equal(memory.bytes, 0);
        }
    }
}

/* ---- trade, with all worlds that it has built ---------------------------------------------------------------------------- */

/* A timer by which all that is measured takes longer than a look at the timer. */
static double seconds_that_grow(void *user)
{
    static double step, now;
    (void)user;

    step += 1;
    return now += step;
}

static stf_result trade(trade_scene *which, stf_trade_row *rows)
{
    enum { SAMPLES = 8 };
    static const unsigned steps[] = {SAMPLES};
    const stf_allocator allocator = counting_allocator(&memory);
    stf_trade_reference *reference = NULL;
    stf_result result = stf_trade_reference_create(
        &(stf_trade_reference_def){.build = trade_scene_build_f64, .user = which, .duration = trade_scene_durations[*which],
                                   .samples = SAMPLES, .accelerations = 5000, .allocator = allocator},
        &reference);

    assert_true((result == STF_OK) == (reference != NULL));
    if (!result)
        result = stf_trade(&(stf_trade_def){.build = trade_scene_build, .user = which, .reference = reference,
                                            .integrators = stf_integrators, .integrator_count = 2, .steps = steps,
                                            .steps_count = 1, .repeats = 2, .seconds = seconds_that_grow,
                                            .allocator = allocator},
                           rows);
    stf_trade_reference_destroy(reference);
    return result;
}

static void a_trade_survives_every_lack_of_memory(void **state)
{
    (void)state;
    trade_scene_allocator = counting_allocator(&memory);
    for (unsigned which = 0; which < TRADE_SCENES; which++) {
        trade_scene of = (trade_scene)which;
        stf_trade_row expected[2], rows[2];
        bool is_done = false;

        memory = (counting){.calls = 0};
        assert_ok(trade(&of, expected));
        for (size_t n = 1; !is_done; n++) {
            memory = (counting){.fail_at = n};
            const stf_result result = trade(&of, rows);
            is_done = memory.calls < n;
            assert_refused(result, is_done ? STF_OK : STF_ERROR_MEMORY);
            assert_int_equal(memory.blocks, 0);
            assert_int_equal(memory.bytes, 0);
        }
        for (int i = 0; i < 2; i++)
            assert_true(rows[i].end_error == expected[i].end_error && rows[i].largest_error == expected[i].largest_error);
    }
    trade_scene_allocator = (stf_allocator){.user = NULL};
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_call_survives_every_lack_of_memory),
        cmocka_unit_test(no_scene_is_left_half_made),
        cmocka_unit_test(a_trade_survives_every_lack_of_memory),
    };

    return cmocka_run_group_tests_name("no memory, " REAL_NAME, tests, NULL, NULL);
}
