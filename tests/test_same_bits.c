/*
 * The same bits everywhere: one number for the state of every scene under every integrator after 300 ticks, whatever instruction
 * set the loops were compiled for and into however many parts a step is split. It was the same with gcc and clang, from -O0 to
 * -O3, on x86-64 and aarch64; a change of it is a change of what the library computes.
 */
#define _POSIX_C_SOURCE 200112L /* setenv */

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/scene.h"
#include "support/check.h"

#define TICKS 300

#ifdef STF_DOUBLE
#define GOLDEN UINT64_C(0x0b57fae0ef6227c2)
typedef uint64_t real_bits;
#else
#define GOLDEN UINT64_C(0x9c37937d851e9c66)
typedef uint32_t real_bits;
#endif

/* FNV-1a over the bits from low to high, whatever the order of bytes in memory. What is not finite counts as one thing. */
static uint64_t hash_real(uint64_t hash, stf_real x)
{
    real_bits bits = 0;

    if (isfinite(x))
        memcpy(&bits, &x, sizeof bits);
    else
        bits = (real_bits)-1;
    for (size_t byte = 0; byte < sizeof bits; byte++)
        hash = (hash ^ ((bits >> (8 * byte)) & 0xff)) * UINT64_C(0x100000001b3);
    return hash;
}

static uint64_t hash_run(uint64_t hash, const scene *s, const stf_integrator *integrator, stf_parallel parallel, unsigned ticks)
{
    const stf_world_def def = {.integrator = integrator, .parallel = parallel};
    stf_world *world;

    assert_ok(scene_create(s, &def, &world));
    assert_ok(stf_world_step(world, ticks));
    for (size_t i = 0; i < stf_world_count(world); i++) {
        const stf_particle p = particle_of(world, i);
        const stf_real reals[] = {p.position.x, p.position.y, p.position.z, p.velocity.x, p.velocity.y, p.velocity.z};
        for (size_t k = 0; k < COUNT_OF(reals); k++)
            hash = hash_real(hash, reals[k]);
    }
    stf_world_destroy(world);
    return hash;
}

static uint64_t hash_all(stf_parallel parallel, unsigned ticks)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);

    for (int s = 0; scenes[s]; s++)
        for (int k = 0; stf_integrators[k]; k++)
            hash = hash_run(hash, scenes[s], stf_integrators[k], parallel, ticks);
    return hash;
}

static void every_scene_and_integrator_gives_the_bits_it_always_gave(void **state)
{
    (void)state;
    const uint64_t hash = hash_all((stf_parallel){.tasks = 0}, TICKS);

    if (hash != GOLDEN)
        print_error("0x%016" PRIx64 ", expected 0x%016" PRIx64 "\n", hash, GOLDEN);
    assert_true(hash == GOLDEN);
}

/* Only those that the machine has differ from the default, so elsewhere this proves nothing; it says what it proved. */
static void every_instruction_set_gives_the_same_bits(void **state)
{
    (void)state;
    static const char *const isas[] = {"baseline", "avx2", "avx512"};
    const char *given = getenv("STEADFAST_ISA");
    char *before = given ? strcpy(malloc(strlen(given) + 1), given) : NULL;
    uint64_t hashes[COUNT_OF(isas)];

    for (size_t i = 0; i < COUNT_OF(isas); i++) {
        assert_int_equal(setenv("STEADFAST_ISA", isas[i], 1), 0);
        stf_world *world = make_world((stf_world_def){.step = 1});
        print_message("asked for %s, got %s\n", isas[i], stf_world_isa(world));
        stf_world_destroy(world);
        hashes[i] = hash_all((stf_parallel){.tasks = 0}, TICKS / 10);
    }
    assert_int_equal(before ? setenv("STEADFAST_ISA", before, 1) : unsetenv("STEADFAST_ISA"), 0);
    free(before);
    for (size_t i = 1; i < COUNT_OF(isas); i++)
        assert_true(hashes[i] == hashes[0]);
}

static bool is_given(const char *wanted, const char *expected)
{
    assert_int_equal(setenv("STEADFAST_ISA", wanted, 1), 0);
    stf_world *world = make_world((stf_world_def){.step = 1});
    const bool is_expected = strcmp(stf_world_isa(world), expected) == 0;
    stf_world_destroy(world);
    return is_expected;
}

/* Every machine runs the baseline, and what runs the widest set runs all below it. An unknown name is as none. */
static void the_instruction_set_that_is_asked_for_is_given(void **state)
{
    (void)state;
    const char *given = getenv("STEADFAST_ISA");
    char *before = given ? strcpy(malloc(strlen(given) + 1), given) : NULL;

    assert_int_equal(unsetenv("STEADFAST_ISA"), 0);
    stf_world *world = make_world((stf_world_def){.step = 1});
    const char *widest = stf_world_isa(world);
    stf_world_destroy(world);

    assert_true(is_given("baseline", "baseline"));
    assert_true(is_given(widest, widest));
    assert_true(is_given("avx512", widest));
    assert_true(is_given("avx2", strcmp(widest, "avx512") == 0 ? "avx2" : widest));
    assert_true(is_given("no such set", widest));
    assert_true(is_given("", widest));
    assert_int_equal(before ? setenv("STEADFAST_ISA", before, 1) : unsetenv("STEADFAST_ISA"), 0);
    free(before);
}

/* The last part first: no part may need another. */
static void run_backwards(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    unsigned *calls = user;

    for (unsigned i = tasks; i-- > 0; (*calls)++)
        task(context, i);
}

static void every_number_of_parts_gives_the_same_bits(void **state)
{
    (void)state;
    const uint64_t alone = hash_all((stf_parallel){.tasks = 0}, TICKS / 10);

    for (unsigned tasks = 2; tasks <= 7; tasks++) {
        unsigned calls = 0;
        assert_true(hash_all((stf_parallel){.run = run_backwards, .tasks = tasks, .user = &calls}, TICKS / 10) == alone);
        assert_true(calls > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_and_integrator_gives_the_bits_it_always_gave),
        cmocka_unit_test(every_instruction_set_gives_the_same_bits),
        cmocka_unit_test(the_instruction_set_that_is_asked_for_is_given),
        cmocka_unit_test(every_number_of_parts_gives_the_same_bits),
    };

    return cmocka_run_group_tests_name("same bits, " REAL_NAME, tests, NULL, NULL);
}
