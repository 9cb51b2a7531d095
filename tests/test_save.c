/* A saved world: what it holds, that it goes on as it would have, and what is refused. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"
#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"
#include "support/saved.h"

/* Of busy_world after GOLDEN_TICKS, with velocity Verlet; the same on every machine. */
#define GOLDEN_TICKS 5
#ifdef STF_DOUBLE
#define GOLDEN UINT64_C(0xef8522831cb65efc)
#else
#define GOLDEN UINT64_C(0x4af4846b5c4c7e96)
#endif

#define TICKS 24

static const stf_allocator no_allocator;

/* Where the numbers of the head stand, and how long it is up to the integrator's name. */
enum { AT_VERSION = 8, AT_BYTES = 12, AT_REAL = 20, AT_DIMENSIONS = 24, AT_FLAGS = 28, AT_SUBSTEPS = 32, AT_STEP = 40,
       AT_TICKS = 48, AT_START_TICK = 56, AT_START_TIME = 64, AT_GRAVITY = 72,
       AT_NAME = AT_GRAVITY + 3 * (int)sizeof(stf_real) };

static void put(unsigned char *to, uint64_t number, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        to[i] = (unsigned char)(number >> (8 * i) & 0xff);
}

static uint64_t get(const unsigned char *from, size_t bytes)
{
    uint64_t number = 0;

    for (size_t i = bytes; i-- > 0;)
        number = number << 8 | from[i];
    return number;
}

/* CRC-32C bit by bit, from its definition. */
static uint32_t checksum(const unsigned char *bytes, size_t count)
{
    uint32_t sum = UINT32_MAX;

    for (size_t i = 0; i < count; i++)
        for (int bit = 0; bit < 8; bit++)
            sum = sum >> 1 ^ (((sum ^ (uint32_t)bytes[i] >> bit) & 1) ? UINT32_C(0x82f63b78) : 0);
    return ~sum;
}

/* As a liar would: the checksum fits again. */
static void sign(saved s) { put(s.bytes + s.size - 4, checksum(s.bytes, s.size - 4), 4); }

static stf_world *fresh_world(const stf_integrator *integrator) { return busy_world(integrator, 0, no_allocator); }

static stf_world *world_after(const stf_integrator *integrator, unsigned ticks)
{
    stf_world *world = fresh_world(integrator);

    for (unsigned n = 0; n < ticks; n++) {
        busy_event(world, n);
        assert_ok(stf_world_step(world, 1));
    }
    return world;
}

/* In all that is saved: not in the pads of records, which hash_of sees. */
static bool are_the_same(const stf_world *a, const stf_world *b)
{
    saved s = save_of(a);
    const bool same = saved_is(s, b);

    saved_free(&s);
    return same;
}

static void the_bytes_are_the_same_on_every_machine(void **state)
{
    (void)state;
    stf_world *world = world_after(&stf_velocity_verlet, GOLDEN_TICKS);
    saved s = save_of(world);
    uint64_t hash = UINT64_C(0xcbf29ce484222325); /* FNV-1a */

    for (size_t i = 0; i < s.size; i++)
        hash = (hash ^ s.bytes[i]) * UINT64_C(0x100000001b3);
    if (hash != GOLDEN)
        print_error("0x%016" PRIx64 ", expected 0x%016" PRIx64 "\n", hash, GOLDEN);
    assert_true(hash == GOLDEN);
    saved_free(&s);
    stf_world_destroy(world);
}

static void a_save_starts_and_ends_as_the_format_says(void **state)
{
    (void)state;
    static const unsigned char expected[] = {'S', 'T', 'F', 'W', 'O', 'R', 'L', 'D', 1, 0, 0, 0};
    stf_world *world = fresh_world(&stf_rk4);
    saved s = save_of(world);

    assert_memory_equal(s.bytes, expected, sizeof expected);
    assert_int_equal(get(s.bytes + AT_BYTES, 8), s.size);
    assert_int_equal(get(s.bytes + AT_REAL, 4), sizeof(stf_real));
    assert_int_equal(get(s.bytes + AT_DIMENSIONS, 4), 2);
    assert_int_equal(get(s.bytes + AT_NAME, 4), 3);
    assert_memory_equal(s.bytes + AT_NAME + 4, "rk4", 3);
    assert_int_equal(checksum((const unsigned char *)"123456789", 9), 0xe3069283); /* RFC 3720's */
    assert_int_equal(get(s.bytes + s.size - 4, 4), checksum(s.bytes, s.size - 4));
    saved_free(&s);
    stf_world_destroy(world);
}

static stf_real not_a_number;

static void lose_history(stf_system *system, stf_real dt)
{
    (void)dt;
    for (size_t i = 0; i < system->length; i++)
        system->history[0][i] = not_a_number;
}

/* x86's arithmetic gives a NaN with the sign set, ARM's one without. */
static void every_nan_is_saved_as_one(void **state)
{
    (void)state;
    static const stf_integrator loser = {.name = "loser", .step = lose_history, .history_arrays = 1};
    stf_world *world = make_world((stf_world_def){.integrator = &loser});
    saved saves[2];

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    for (int i = 0; i < 2; i++) {
        not_a_number = i == 0 ? (stf_real)NAN : -(stf_real)NAN;
        assert_ok(stf_world_step(world, 1));
        saves[i] = save_of(world);
        saves[i].bytes[AT_TICKS] = 0;
    }
    assert_memory_equal(saves[0].bytes, saves[1].bytes, saves[0].size - 4);
    saved_free(&saves[0]);
    saved_free(&saves[1]);
    stf_world_destroy(world);
}

/* `loaded` becomes `s` and, stepped, what was saved after. */
static void assert_goes_on(stf_world *loaded, const saved *saves, unsigned k)
{
    assert_ok(stf_world_load(loaded, saves[k].bytes, saves[k].size, NULL));
    assert_true(saved_is(saves[k], loaded));
    if (k < TICKS) {
        assert_ok(stf_world_step(loaded, 1));
        assert_true(saved_is(saves[k + 1], loaded));
    }
    if (k + 7 <= TICKS) {
        assert_ok(stf_world_step(loaded, 6));
        assert_true(saved_is(saves[k + 7], loaded));
    }
}

static void every_scene_goes_on_with_the_same_bits_from_every_tick(void **state)
{
    (void)state;
    for (int n = 0; scenes[n]; n++)
        for (int m = 0; saved_integrators[m]; m++) {
            const stf_world_def def = {.integrator = saved_integrators[m], .keep_previous = n % 2 == 0};
            saved saves[TICKS + 1];
            stf_world *world, *other;

            assert_ok(scene_create(scenes[n], &def, &world));
            for (unsigned k = 0; k <= TICKS; k++) {
                saves[k] = save_of(world);
                assert_ok(stf_world_step(world, 1));
            }
            for (unsigned k = 0; k <= TICKS; k++) {
                assert_ok(scene_create(scenes[n], &def, &other));
                assert_goes_on(other, saves, k);
                stf_world_destroy(other);
            }
            for (unsigned k = 0; k <= TICKS; k++)
                saved_free(&saves[k]);
            stf_world_destroy(world);
        }
}

/* History is lost, in part and in whole; counts change; the world that is loaded into has had another life. */
static void a_busy_world_goes_on_with_the_same_bits_from_every_tick(void **state)
{
    (void)state;
    static const size_t capacities[] = {0, 40, 5000};

    for (int m = 0; saved_integrators[m]; m++)
        for (size_t c = 0; c < COUNT_OF(capacities); c++) {
            stf_world *world = fresh_world(saved_integrators[m]);
            stf_world *other = busy_world(saved_integrators[m], capacities[c], no_allocator);

            assert_ok(stf_world_step(other, 3));
            for (unsigned n = 0; n < TICKS; n++) {
                saved before = save_of(world);
                busy_event(world, n);
                saved between = save_of(world);
                assert_ok(stf_world_step(world, 1));

                assert_ok(stf_world_load(other, before.bytes, before.size, NULL));
                assert_true(saved_is(before, other));
                busy_event(other, n);
                assert_ok(stf_world_step(other, 1));
                assert_true(are_the_same(other, world));

                assert_ok(stf_world_load(other, between.bytes, between.size, NULL));
                assert_true(saved_is(between, other));
                assert_ok(stf_world_step(other, 1));
                assert_true(are_the_same(other, world));
                saved_free(&before);
                saved_free(&between);
            }
            stf_world_destroy(other);
            stf_world_destroy(world);
        }
}

/* Blocks of particles that the world never had, and lanes that a longer one leaves behind. */
static void a_world_grows_and_shrinks_to_what_is_loaded(void **state)
{
    (void)state;
    static const size_t counts[] = {0, 1, 15, 16, 17, 300, 256, 1000, 3};
    stf_world *into = make_world((stf_world_def){.integrator = &stf_velocity_verlet});

    add_force(into, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){1, 1});
    for (size_t c = 0; c < COUNT_OF(counts); c++) {
        stf_world *world = make_world((stf_world_def){.integrator = &stf_velocity_verlet});
        uint64_t seed = c;

        add_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){2, 1});
        for (size_t i = 0; i < counts[c]; i++)
            assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)next_random(&seed), (stf_real)i, 0},
                                                           .inverse_mass = 1}, NULL));
        assert_ok(stf_world_step(world, 1));
        saved s = save_of(world);
        assert_ok(stf_world_load(into, s.bytes, s.size, NULL));
        assert_true(saved_is(s, into));
        assert_ok(stf_world_step(world, 2));
        assert_ok(stf_world_step(into, 2));
        assert_true(are_the_same(into, world));
        saved_free(&s);
        stf_world_destroy(world);
    }
    stf_world_destroy(into);
}

static void ids_are_those_of_the_saved_world(void **state)
{
    (void)state;
    stf_world *world = fresh_world(&stf_rk4), *other = make_world((stf_world_def){.dimensions = 2, .integrator = &stf_rk4,
                                                                                  .keep_previous = true, .keep_radius = true});
    saved s = save_of(world);
    stf_force_id id;

    add_force(other, &stf_force_springs, NULL);
    add_force(other, &stf_force_anchored_springs, NULL);
    add_force(other, &stf_force_linear_drag, NULL);
    add_force(other, &mixed_force, NULL);
    assert_ok(stf_world_load(other, s.bytes, s.size, NULL));
    assert_true(are_the_same(other, world));
    assert_int_equal(stf_world_force_at(other, 1), 3);
    assert_ok(stf_world_add_force(other, &stf_force_attractor, NULL, 0, &id));
    assert_int_equal(id, 6);
    saved_free(&s);
    stf_world_destroy(other);
    stf_world_destroy(world);
}

/* An id is never used again, and never 0: behind the last there is none. */
static void after_the_last_id_no_force_is_added(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.integrator = &stf_rk4});
    saved s = save_of(world);
    stf_force_id id = 0;

    put(s.bytes + AT_NAME + 4 + strlen("rk4"), UINT32_MAX - 1, 4);
    sign(s);
    assert_ok(stf_world_load(world, s.bytes, s.size, NULL));
    assert_ok(stf_world_add_force(world, &stf_force_linear_drag, NULL, 0, &id));
    assert_true(id == UINT32_MAX);
    assert_ok(stf_world_remove_force(world, id));
    assert_refused(stf_world_add_force(world, &stf_force_linear_drag, NULL, 0, NULL), STF_ERROR_MEMORY);
    assert_int_equal(stf_world_force_at(world, 0), 0);
    saved_free(&s);
    stf_world_destroy(world);
}

/* Loading these bytes, out of memory of exactly their size, is refused so and changes nothing. */
static stf_result refusal(stf_world *world, saved before, const unsigned char *bytes, size_t size)
{
    const uint64_t hash = hash_of(world);
    unsigned char *exact = malloc(size ? size : 1);
    stf_mismatch mismatch;

    assert_non_null(exact);
    memcpy(exact, bytes, size);
    const stf_result result = stf_world_load(world, exact, size, &mismatch);
    free(exact);
    assert_true(!mismatch.what == (result != STF_ERROR_MISMATCH));
    if (result) {
        assert_true(hash_of(world) == hash);
        assert_true(saved_is(before, world));
    }
    return result;
}

static void every_truncation_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    stf_world *world = world_after(&stf_position_verlet, 3), *into = fresh_world(&stf_position_verlet);
    saved s = save_of(world), before = save_of(into);

    for (size_t size = 0; size < s.size; size++)
        assert_refused(refusal(into, before, s.bytes, size), STF_ERROR_TRUNCATED);
    for (size_t size = 0; size <= AT_VERSION; size++)
        assert_refused(refusal(into, before, (const unsigned char *)"STFWORLD", size), STF_ERROR_TRUNCATED);
    for (size_t size = 1; size < 12; size++)
        assert_refused(refusal(into, before, (const unsigned char *)"\x89PNG\r\n\x1a\n\0\0\0\0", size), STF_ERROR_FOREIGN);

    /* as short as a version can be told, and not */
    unsigned char other[AT_REAL + 4] = "STFWORLD"; /* start and checksum */
    other[AT_VERSION] = 99;
    assert_refused(refusal(into, before, other, sizeof other), STF_ERROR_VERSION);
    assert_refused(refusal(into, before, other, sizeof other - 1), STF_ERROR_TRUNCATED);

    saved longer = {.bytes = calloc(1, s.size + 1), .size = s.size + 1};
    memcpy(longer.bytes, s.bytes, s.size);
    assert_refused(refusal(into, before, longer.bytes, longer.size), STF_ERROR_ALTERED);
    saved_free(&longer);
    saved_free(&before);
    saved_free(&s);
    stf_world_destroy(into);
    stf_world_destroy(world);
}

static stf_result expected_of(size_t at, const unsigned char *bytes, size_t size)
{
    if (at < AT_VERSION)
        return STF_ERROR_FOREIGN;
    if (at < AT_BYTES)
        return STF_ERROR_VERSION;
    return at < AT_REAL && get(bytes + AT_BYTES, 8) > size ? STF_ERROR_TRUNCATED : STF_ERROR_ALTERED;
}

static void every_altered_byte_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    stf_world *world = world_after(&stf_position_verlet, 3), *into = fresh_world(&stf_position_verlet);
    saved s = save_of(world), before = save_of(into);

    for (size_t at = 0; at < s.size; at++)
        for (unsigned value = 1; value < 256; value += at < AT_NAME ? 1 : 42) {
            s.bytes[at] ^= (unsigned char)value;
            assert_refused(refusal(into, before, s.bytes, s.size), expected_of(at, s.bytes, s.size));
            s.bytes[at] ^= (unsigned char)value;
        }
    assert_ok(refusal(into, before, s.bytes, s.size));
    saved_free(&before);
    saved_free(&s);
    stf_world_destroy(into);
    stf_world_destroy(world);
}

/* Every byte and every place of a length, with a checksum that fits: refused, or loaded as a world that can be used. */
static void lies_with_a_fitting_checksum_do_no_harm(void **state)
{
    (void)state;
    static const unsigned char values[] = {0x00, 0x01, 0x7f, 0x80, 0xff};
    stf_world *world = world_after(&stf_velocity_verlet, 3), *into = fresh_world(&stf_velocity_verlet);
    saved s = save_of(world), before = save_of(into);
    unsigned refused = 0, accepted = 0;

    for (size_t at = 0; at + 4 < s.size; at++)
        for (size_t v = 0; v < COUNT_OF(values); v++)
            for (size_t width = 1; width <= 8 && at + width + 4 <= s.size; width += 7) {
                saved lie = copy_of(s);
                memset(lie.bytes + at, values[v], width);
                sign(lie);
                if (refusal(into, before, lie.bytes, lie.size)) {
                    refused++;
                } else {
                    accepted++;
                    if (stf_world_substeps(into) < 1000) /* up to STF_SUBSTEPS_MAX it may say, which takes a while */
                        assert_ok(stf_world_step(into, 2));
                    assert_false(stf_world_count(into) > 100);
                    assert_ok(stf_world_load(into, before.bytes, before.size, NULL));
                }
                saved_free(&lie);
            }
    assert_true(refused > 1000 && accepted > 100);
    saved_free(&before);
    saved_free(&s);
    stf_world_destroy(into);
    stf_world_destroy(world);
}

typedef struct lie {
    size_t at, bytes;
    uint64_t number;
    stf_result expected;
} lie;

static uint64_t bits_of(double x)
{
    uint64_t bits;

    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void each_lie_has_its_own_error(void **state)
{
    (void)state;
    stf_world *into = make_world((stf_world_def){.dimensions = 1, .integrator = &stf_velocity_verlet, .keep_radius = true});
    const stf_particle particle = {.position = {1, 0, 0}, .velocity = {2, 0, 0}, .inverse_mass = 3, .radius = 4};
    const size_t real = sizeof(stf_real);
    const uint64_t infinity = sizeof(stf_real) == 4 ? UINT64_C(0x7f800000) : UINT64_C(0x7ff0000000000000);
    const uint64_t minus = sizeof(stf_real) == 4 ? UINT64_C(0xbf800000) : UINT64_C(0xbff0000000000000);

    assert_ok(stf_world_add(into, &particle, NULL));
    add_force(into, &stf_force_linear_drag, &(stf_linear_drag){1});
    saved s = save_of(into), before = save_of(into);
    const size_t after_name = AT_NAME + 4 + strlen("velocity_verlet"), force = after_name + 20;
    const size_t id = force + 4 + strlen("linear_drag") + 4, records = id + 4 + 4 + 1, arrays = records + 8 + real;
    const lie lies[] = {
        {AT_VERSION, 4, 2, STF_ERROR_VERSION},
        {AT_VERSION, 4, 0, STF_ERROR_VERSION},
        {AT_BYTES, 8, UINT64_MAX, STF_ERROR_TRUNCATED},
        {AT_BYTES, 8, 0, STF_ERROR_ALTERED},
        {AT_REAL, 4, 12 - real, STF_ERROR_PRECISION},
        {AT_DIMENSIONS, 4, 3, STF_ERROR_MISMATCH},
        {AT_FLAGS, 4, 2 + 8, STF_ERROR_MISMATCH}, /* compensated */
        {AT_FLAGS, 4, 2 + 16, STF_ERROR_ALTERED},
        {AT_SUBSTEPS, 4, 0, STF_ERROR_SUBSTEPS},
        {AT_STEP, 8, bits_of(-1), STF_ERROR_STEP},
        {AT_STEP, 8, bits_of((double)NAN), STF_ERROR_STEP},
        {AT_START_TICK, 8, 1, STF_ERROR_ALTERED},
        {AT_START_TIME, 8, bits_of((double)INFINITY), STF_ERROR_NOT_FINITE},
        {AT_GRAVITY, real, infinity, STF_ERROR_NOT_FINITE},
        {AT_GRAVITY + real, real, minus, STF_ERROR_DIMENSIONS},
        {AT_NAME, 4, UINT32_MAX, STF_ERROR_ALTERED},
        {AT_NAME + 4, 1, 'x', STF_ERROR_MISMATCH},
        {after_name, 4, 0, STF_ERROR_ALTERED}, /* the last id */
        {after_name + 4, 8, UINT64_MAX, STF_ERROR_MISMATCH},
        {after_name + 12, 8, UINT64_MAX, STF_ERROR_ALTERED}, /* particles */
        {after_name + 12, 8, UINT64_MAX / real / 5 + 2, STF_ERROR_ALTERED},
        {after_name + 12, 8, 2, STF_ERROR_ALTERED},
        {after_name + 12, 8, 0, STF_ERROR_ALTERED},
        {force, 4, UINT32_MAX, STF_ERROR_ALTERED},
        {force + 4, 1, 'x', STF_ERROR_MISMATCH},
        {id - 4, 4, 1, STF_ERROR_MISMATCH}, /* kind */
        {id, 4, 0, STF_ERROR_ALTERED},
        {id, 4, 2, STF_ERROR_ALTERED},
        {id + 8, 1, '4', STF_ERROR_MISMATCH}, /* fields */
        {records, 8, UINT64_MAX, STF_ERROR_ALTERED},
        {records, 8, UINT64_MAX / real + 2, STF_ERROR_ALTERED},
        {records, 8, 0, STF_ERROR_ALTERED},
        {records + 8, real, minus, STF_ERROR_PARAMETERS},
        {arrays, real, infinity, STF_ERROR_NOT_FINITE},
        {arrays + real, real, infinity, STF_ERROR_NOT_FINITE},
        {arrays + 2 * real, real, 1, STF_ERROR_MASS},
        {arrays + 3 * real, real, minus, STF_ERROR_RADIUS},
        {arrays + 4 * real, real, infinity, STF_OK}, /* history is the integrator's own */
    };

    assert_int_equal(s.size, arrays + 5 * real + 4);
    for (size_t i = 0; i < COUNT_OF(lies); i++) {
        saved told = copy_of(s);
        put(told.bytes + lies[i].at, lies[i].number, lies[i].bytes);
        sign(told);
        const stf_result result = refusal(into, before, told.bytes, told.size);
        if (result != lies[i].expected)
            print_error("lie %zu:\n", i);
        assert_refused(result, lies[i].expected);
        saved_free(&told);
    }
    saved_free(&before);
    saved_free(&s);
    stf_world_destroy(into);
}

static void blow(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)particles, (void)time;
}

static void what_does_not_match_is_named(void **state)
{
    (void)state;
    static const stf_force wind = {.name = "wind", .record_size = sizeof(stf_real), .apply = blow, .fields = "r"};
    static const stf_force link = {.name = "wind", .record_size = sizeof(stf_real), .apply = blow, .fields = "r",
                                   .kind = STF_LINK};
    static const stf_force large = {.name = "wind", .record_size = 2 * sizeof(stf_real), .apply = blow, .fields = "rr"};
    static const stf_force pointing = {.name = "wind", .record_size = sizeof(stf_real), .apply = blow, .fields = STF_NOT_SAVED};
    static const stf_force bare = {.name = "wind", .apply = blow};
    static const stf_force windy = {.name = "windy", .record_size = sizeof(stf_real), .apply = blow, .fields = "r"};
    const stf_integrator eulers = {.name = "semi_implicit_euler", .step = remembering.step, .work_arrays = 1,
                                          .history_arrays = 2};
    const stf_real strength = 1;
    const struct {
        stf_world_def def;
        const stf_force *forces[3];
        const char *what, *saved;
        size_t force;
    } cases[] = {
        {{.dimensions = 2}, {&stf_force_linear_drag, &wind}, "dimensions", "", 0},
        {{.keep_previous = true}, {&stf_force_linear_drag, &wind}, "keep_previous", "", 0},
        {{.keep_radius = true}, {&stf_force_linear_drag, &wind}, "keep_radius", "", 0},
        {{.compensated = true}, {&stf_force_linear_drag, &wind}, "compensated", "", 0},
        {{.integrator = &stf_rk4}, {&stf_force_linear_drag, &wind}, "integrator", "semi_implicit_euler", 0},
        {{.integrator = &eulers}, {&stf_force_linear_drag, &wind}, "history_arrays", "semi_implicit_euler", 0},
        {{.step = 1}, {&stf_force_linear_drag}, "force count", "", 0},
        {{.step = 1}, {&stf_force_linear_drag, &wind, &wind}, "force count", "", 0},
        {{.step = 1}, {&wind, &stf_force_linear_drag}, "name", "linear_drag", 0},
        {{.step = 1}, {&stf_force_linear_drag, &windy}, "name", "wind", 1},
        {{.step = 1}, {&stf_force_linear_drag, &link}, "kind", "wind", 1},
        {{.step = 1}, {&stf_force_linear_drag, &large}, "fields", "wind", 1},
        {{.step = 1}, {&stf_force_linear_drag, &pointing}, "fields", "wind", 1},
        {{.step = 1}, {&stf_force_linear_drag, &bare}, "fields", "wind", 1},
        {{.step = 1}, {&stf_force_linear_drag, &wind}, NULL, "", 0},
    };
    stf_world *world = make_world((stf_world_def){.step = 2});
    saved s;

    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){1});
    add_force(world, &wind, &strength);
    s = save_of(world);
    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        stf_world *other = make_world(cases[i].def);
        stf_mismatch mismatch = {.force = 77};

        for (size_t k = 0; k < COUNT_OF(cases[i].forces) && cases[i].forces[k]; k++)
            add_force(other, cases[i].forces[k], NULL);
        saved before = save_of(other);
        assert_refused(stf_world_load(other, s.bytes, s.size, &mismatch), cases[i].what ? STF_ERROR_MISMATCH : STF_OK);
        assert_true(!mismatch.what == !cases[i].what);
        if (mismatch.what) {
            assert_string_equal(mismatch.what, cases[i].what);
            assert_refused(stf_world_load(other, s.bytes, s.size, NULL), STF_ERROR_MISMATCH);
            assert_true(saved_is(before, other));
        }
        assert_string_equal(mismatch.saved, cases[i].saved);
        assert_int_equal(mismatch.force, cases[i].force);
        saved_free(&before);
        stf_world_destroy(other);
    }
    saved_free(&s);
    stf_world_destroy(world);
}

static void a_long_name_is_cut_off(void **state)
{
    (void)state;
    static const stf_force longest = {.name = "0123456789012345678901234567890123456789012345678901234567890", .apply = blow};
    stf_world *world = make_world((stf_world_def){.step = 1}), *other = make_world((stf_world_def){.step = 1});
    stf_mismatch mismatch;

    add_force(world, &longest, NULL);
    add_force(other, &stf_force_linear_drag, NULL);
    saved s = save_of(world);
    assert_refused(stf_world_load(other, s.bytes, s.size, &mismatch), STF_ERROR_MISMATCH);
    assert_string_equal(mismatch.saved, "01234567890123456789012345678901234567890123456");
    saved_free(&s);
    stf_world_destroy(other);
    stf_world_destroy(world);
}

static stf_result of_particle_0(const void *record, unsigned dimensions, size_t particle_count)
{
    (void)record, (void)dimensions;
    return particle_count > 0 ? STF_OK : STF_ERROR_PARTICLE;
}

static void records_with_pointers_stay_as_they_are(void **state)
{
    (void)state;
    int here = 0, there = 0;
    const stf_force owner = {.name = "owner", .record_size = sizeof(int *), .apply = blow, .fields = STF_NOT_SAVED,
                             .check = of_particle_0};
    stf_world *world = make_world((stf_world_def){.step = 1}), *other = make_world((stf_world_def){.step = 1});
    stf_world *empty = make_world((stf_world_def){.step = 1});

    assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
    assert_ok(stf_world_add(other, &(stf_particle){.inverse_mass = 2}, NULL));
    add_force(world, &owner, &(int *){&here});
    add_force(other, &owner, &(int *){&there});
    add_force(empty, &owner, NULL);
    saved s = save_of(world), nothing = save_of(empty);
    assert_ok(stf_world_load(other, s.bytes, s.size, NULL));
    assert_true(particle_of(other, 0).inverse_mass == 1);
    assert_ptr_equal(*(int *const *)stf_world_force_records(other, 1, NULL), &there);

    const uint64_t before = hash_of(other);
    assert_refused(stf_world_load(other, nothing.bytes, nothing.size, NULL), STF_ERROR_PARTICLE);
    assert_true(hash_of(other) == before);
    saved_free(&nothing);
    saved_free(&s);
    stf_world_destroy(empty);
    stf_world_destroy(other);
    stf_world_destroy(world);
}

static void what_can_not_be_saved_is_refused(void **state)
{
    (void)state;
    static const stf_force silent = {.name = "silent", .record_size = sizeof(stf_real), .apply = blow};
    stf_world *world = make_world((stf_world_def){.step = 1, .integrator = &stf_explicit_euler});
    unsigned char buffer[1024];
    const stf_real record = 1;
    stf_force_id id;

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {REAL_MAX, 0, 0}, .inverse_mass = 1}, NULL));
    add_force(world, &stf_force_attractor, NULL);
    assert_ok(stf_world_add_force(world, &silent, NULL, 0, &id));
    const size_t size = stf_world_save_size(world);
    assert_true(size <= sizeof buffer);
    assert_ok(stf_world_save(world, buffer, size)); /* no records, nothing to say of them */
    assert_int_equal(stf_world_save_size(NULL), 0);
    assert_refused(stf_world_save(NULL, buffer, size), STF_ERROR_NULL);
    assert_refused(stf_world_save(world, NULL, size), STF_ERROR_NULL);
    assert_refused(stf_world_load(NULL, buffer, size, NULL), STF_ERROR_NULL);
    assert_refused(stf_world_load(world, NULL, size, NULL), STF_ERROR_NULL);
    buffer[size - 1] = 0x77;
    for (size_t less = 0; less < size; less++)
        assert_refused(stf_world_save(world, buffer, less), STF_ERROR_BUFFER);
    assert_int_equal(buffer[size - 1], 0x77);

    assert_ok(stf_world_set_force(world, id, &record, 1));
    assert_refused(stf_world_save(world, buffer, sizeof buffer), STF_ERROR_UNSAVABLE);
    assert_ok(stf_world_remove_force(world, id));
    assert_ok(stf_world_set_step(world, 2));
    assert_ok(stf_world_step(world, 1));
    assert_true(stf_world_find_non_finite(world, NULL));
    assert_refused(stf_world_save(world, buffer, sizeof buffer), STF_ERROR_NOT_FINITE);
    stf_world_destroy(world);
}

/* Ticks of the longest step are soon past the largest double; in float they never are. */
static void a_world_at_no_finite_time_is_not_saved(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = (double)REAL_MAX});
    unsigned char bytes[256];

    assert_ok(stf_world_step(world, 4));
    assert_ok(stf_world_set_step(world, 1));
    const stf_result result = stf_world_save(world, bytes, sizeof bytes);
    assert_refused(result, isfinite(stf_world_time(world)) ? STF_OK : STF_ERROR_NOT_FINITE);
    assert_true(result || stf_world_load(world, bytes, stf_world_save_size(world), NULL) == STF_OK);
    stf_world_destroy(world);
}

static void fields_have_to_make_up_the_record(void **state)
{
    (void)state;
    typedef struct odd {
        uint8_t a;
        double b;
        uint16_t c;
    } odd;
    const struct {
        const char *fields;
        size_t size;
        bool good;
    } cases[] = {
        {"182", sizeof(odd), true},     {"18", sizeof(odd), false},  {"1822", sizeof(odd), true}, {"18222", sizeof(odd), true},
        {"1822222", sizeof(odd), false}, {"x", 1, false},             {"1x", 1, false},            {"", 0, true},
        {"", 1, false},                 {"1", 0, false},             {"*", 7, true},              {"111", 3, true},
        {"r", sizeof(stf_real), true},  {"rr", sizeof(stf_real), false},
    };
    stf_world *world = make_world((stf_world_def){.step = 1});

    for (size_t i = 0; i < COUNT_OF(cases); i++) {
        const stf_force force = {.name = "odd", .record_size = cases[i].size, .apply = blow, .fields = cases[i].fields};
        stf_force_id id = 0;

        assert_refused(stf_world_add_force(world, &force, NULL, 0, &id), cases[i].good ? STF_OK : STF_ERROR_DESCRIPTOR);
        if (id)
            assert_ok(stf_world_remove_force(world, id));
    }
    stf_world_destroy(world);
}

static void without_memory_nothing_changes(void **state)
{
    (void)state;
    stf_world *world = world_after(&stf_velocity_verlet, 12);
    unsigned failures = 0;

    for (int i = 0; i < 1000; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)i, 0, 0}, .inverse_mass = 1}, NULL));
    saved s = save_of(world);
    for (bool done = false; !done; failures++) {
        counting memory = {.blocks = 0};
        stf_world *into = busy_world(&stf_velocity_verlet, 0, counting_allocator(&memory));
        saved before = save_of(into);
        const size_t blocks = memory.blocks;

        memory.fail_at = memory.calls + failures + 1;
        const stf_result result = stf_world_load(into, s.bytes, s.size, NULL);
        done = result == STF_OK;
        if (!done) {
            assert_refused(result, STF_ERROR_MEMORY);
            assert_true(saved_is(before, into));
            assert_int_equal(memory.blocks, blocks);
            assert_ok(stf_world_step(into, 1));
            assert_ok(stf_world_load(into, s.bytes, s.size, NULL));
        }
        assert_true(saved_is(s, into));
        saved_free(&before);
        stf_world_destroy(into);
        assert_int_equal(memory.blocks, 0);
        assert_int_equal(memory.bytes, 0);
    }
    assert_int_equal(failures, 7); /* the list of forces, four kinds of records, the particles; and once none */
    saved_free(&s);
    stf_world_destroy(world);
}

/* As if it had been saved so: the length says that it is whole, and the checksum fits. */
static void every_cut_with_a_fitting_checksum_is_refused(void **state)
{
    (void)state;
    stf_world *world = world_after(&stf_position_verlet, 3), *into = fresh_world(&stf_position_verlet);
    saved s = save_of(world), before = save_of(into);

    for (size_t size = AT_REAL + 4; size < s.size; size++) {
        saved cut = copy_of(s);

        cut.size = size;
        put(cut.bytes + AT_BYTES, size, 8);
        sign(cut);
        assert_true(refusal(into, before, cut.bytes, cut.size) != STF_OK);
        saved_free(&cut);
    }
    saved_free(&before);
    saved_free(&s);
    stf_world_destroy(into);
    stf_world_destroy(world);
}

static void a_force_of_no_records_has_none_in_a_save(void **state)
{
    (void)state;
    static const stf_force pointers = {.name = "pointers", .record_size = sizeof(int *), .apply = blow,
                                       .fields = STF_NOT_SAVED};
    const stf_force *const forces[] = {&idle_link, &pointers};

    for (size_t i = 0; i < COUNT_OF(forces); i++) {
        stf_world *world = make_world((stf_world_def){.dimensions = 1});

        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
        add_force(world, forces[i], NULL);
        saved s = save_of(world), told = copy_of(s);
        put(told.bytes + s.size - 4 - 3 * sizeof(stf_real) - 8, 1, 8); /* before position, velocity, inverse mass, checksum */
        sign(told);
        assert_refused(refusal(world, s, told.bytes, told.size), STF_ERROR_ALTERED);
        assert_ok(refusal(world, s, s.bytes, s.size));
        saved_free(&told);
        saved_free(&s);
        stf_world_destroy(world);
    }
}

static void a_world_without_forces_is_saved_and_loaded(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.step = 1}), *other = make_world((stf_world_def){.step = 2});

    assert_ok(stf_world_add(world, &(stf_particle){.velocity = {1, 2, 3}, .inverse_mass = 1}, NULL));
    saved s = save_of(world);
    assert_ok(stf_world_load(other, s.bytes, s.size, NULL));
    assert_true(saved_is(s, other));
    saved_free(&s);
    stf_world_destroy(other);
    stf_world_destroy(world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bytes_are_the_same_on_every_machine),
        cmocka_unit_test(a_save_starts_and_ends_as_the_format_says),
        cmocka_unit_test(every_nan_is_saved_as_one),
        cmocka_unit_test(every_scene_goes_on_with_the_same_bits_from_every_tick),
        cmocka_unit_test(a_busy_world_goes_on_with_the_same_bits_from_every_tick),
        cmocka_unit_test(a_world_grows_and_shrinks_to_what_is_loaded),
        cmocka_unit_test(ids_are_those_of_the_saved_world),
        cmocka_unit_test(after_the_last_id_no_force_is_added),
        cmocka_unit_test(every_truncation_is_refused_and_changes_nothing),
        cmocka_unit_test(every_altered_byte_is_refused_and_changes_nothing),
        cmocka_unit_test(lies_with_a_fitting_checksum_do_no_harm),
        cmocka_unit_test(each_lie_has_its_own_error),
        cmocka_unit_test(what_does_not_match_is_named),
        cmocka_unit_test(a_long_name_is_cut_off),
        cmocka_unit_test(records_with_pointers_stay_as_they_are),
        cmocka_unit_test(what_can_not_be_saved_is_refused),
        cmocka_unit_test(a_world_at_no_finite_time_is_not_saved),
        cmocka_unit_test(fields_have_to_make_up_the_record),
        cmocka_unit_test(without_memory_nothing_changes),
        cmocka_unit_test(every_cut_with_a_fitting_checksum_is_refused),
        cmocka_unit_test(a_force_of_no_records_has_none_in_a_save),
        cmocka_unit_test(a_world_without_forces_is_saved_and_loaded),
    };

    return cmocka_run_group_tests_name("save, " REAL_NAME, tests, NULL, NULL);
}
