/*
 * The same bits everywhere: one number for the state of every scene under every integrator after 300 ticks. It was the same
 * with gcc and clang, from -O0 to -O3, with and without wider vectors; a change of it is a change of what the library computes.
 */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "scenes/scene.h"
#include "support/check.h"

#define TICKS 300

#ifdef STF_DOUBLE
#define GOLDEN UINT64_C(0xceb893181c4373a0)
typedef uint64_t real_bits;
#else
#define GOLDEN UINT64_C(0xc77b6ce82252ebbb)
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

static uint64_t hash_run(uint64_t hash, const scene *s, const stf_integrator *integrator)
{
    const stf_world_def def = {.integrator = integrator};
    stf_world *world;

    assert_ok(scene_create(s, &def, &world));
    assert_ok(stf_world_step(world, TICKS));
    for (size_t i = 0; i < stf_world_count(world); i++) {
        const stf_particle p = particle_of(world, i);
        const stf_real reals[] = {p.position.x, p.position.y, p.position.z, p.velocity.x, p.velocity.y, p.velocity.z};
        for (size_t k = 0; k < COUNT_OF(reals); k++)
            hash = hash_real(hash, reals[k]);
    }
    stf_world_destroy(world);
    return hash;
}

static void every_scene_and_integrator_gives_the_bits_it_always_gave(void **state)
{
    (void)state;
    uint64_t hash = UINT64_C(0xcbf29ce484222325);

    for (int s = 0; scenes[s]; s++)
        for (int k = 0; stf_integrators[k]; k++)
            hash = hash_run(hash, scenes[s], stf_integrators[k]);
    if (hash != GOLDEN)
        print_error("0x%016" PRIx64 ", expected 0x%016" PRIx64 "\n", hash, GOLDEN);
    assert_true(hash == GOLDEN);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_scene_and_integrator_gives_the_bits_it_always_gave)};

    return cmocka_run_group_tests_name("same bits, " REAL_NAME, tests, NULL, NULL);
}
