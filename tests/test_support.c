/* The tests' own checks: each must be able to fail. */
#include <math.h>

#include "support/check.h"

static void close_knows_near_from_far(void **state)
{
    (void)state;
    assert_true(is_close(1, 1, 0));
    assert_true(is_close(1, 1 + 1e-9, 2e-9));
    assert_false(is_close(1, 1 + 1e-9, 1e-10));
    assert_false(is_close(-1, 1, 1.9));
    assert_true(is_close(1e300, 1.5e300, 1e300));
}

static void close_fails_for_nan_and_infinity(void **state)
{
    (void)state;
    assert_false(is_close((double)NAN, 1, 1e300));
    assert_false(is_close(1, (double)NAN, 1e300));
    assert_false(is_close((double)NAN, (double)NAN, 1e300));
    assert_false(is_close((double)INFINITY, 1, 1e300));
    assert_false(is_close((double)INFINITY, -(double)INFINITY, 1e300));
    assert_false(is_close(1, 2, (double)NAN));
    assert_true(is_close((double)INFINITY, (double)INFINITY, 0));
}

static void below_is_strict_and_fails_for_nan(void **state)
{
    (void)state;
    assert_true(is_below(1, 2));
    assert_false(is_below(2, 2));
    assert_false(is_below((double)NAN, 2));
    assert_false(is_below(1, (double)NAN));
}

static void hash_sees_every_part_of_a_world(void **state)
{
    (void)state;
    stf_world *world = make_world((stf_world_def){.keep_radius = true});
    const stf_particle particle = {.position = {1, 2, 3}, .velocity = {4, 5, 6}, .inverse_mass = 7, .radius = 8};
    const stf_linear_drag drag = {1}, more_drag = {2};
    stf_force_id id;
    uint64_t hashes[12];
    size_t count = 0;

    assert_ok(stf_world_add(world, &particle, NULL));
    hashes[count++] = hash_of(world);
    for (int change = 0; change < 4; change++) {
        stf_particle changed = particle;
        *(change == 0   ? &changed.position.z
          : change == 1 ? &changed.velocity.y
          : change == 2 ? &changed.inverse_mass
                        : &changed.radius) *= 1 + (stf_real)REAL_EPSILON;
        assert_ok(stf_world_set(world, 0, &changed));
        hashes[count++] = hash_of(world);
    }
    assert_ok(stf_world_set_step(world, 0.25));
    hashes[count++] = hash_of(world);
    assert_ok(stf_world_set_gravity(world, (stf_vector){0, 0, 1}));
    hashes[count++] = hash_of(world);
    assert_ok(stf_world_add_force(world, &stf_force_linear_drag, &drag, 1, &id));
    hashes[count++] = hash_of(world);
    assert_ok(stf_world_set_force(world, id, &more_drag, 1));
    hashes[count++] = hash_of(world);
    assert_ok(stf_world_set_integrator(world, &stf_rk4));
    hashes[count++] = hash_of(world);
    assert_ok(stf_world_set_substeps(world, 3));
    hashes[count++] = hash_of(world);
    assert_ok(stf_world_step(world, 1));
    hashes[count++] = hash_of(world);

    assert_int_equal(count, COUNT_OF(hashes));
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++)
            assert_true(hashes[i] != hashes[j]);
    stf_world_destroy(world);
}

static void random_numbers_are_seeded_and_in_range(void **state)
{
    (void)state;
    uint64_t a = 1, b = 1, other = 2;
    double sum = 0;
    int same = 0;

    for (int i = 0; i < 10000; i++) {
        const double x = next_random(&a);
        assert_true(x >= 0 && x < 1);
        assert_true(x == next_random(&b));
        same += x == next_random(&other);
        sum += x;
    }
    assert_true(same < 10);
    assert_close(sum / 10000, 0.5, 5 * 0.2887 / 100); /* five standard errors: 1 / sqrt(12) / sqrt(10000) */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(close_knows_near_from_far),
        cmocka_unit_test(close_fails_for_nan_and_infinity),
        cmocka_unit_test(below_is_strict_and_fails_for_nan),
        cmocka_unit_test(hash_sees_every_part_of_a_world),
        cmocka_unit_test(random_numbers_are_seeded_and_in_range),
    };

    return cmocka_run_group_tests_name("support, " REAL_NAME, tests, NULL, NULL);
}
