/* Which instruction set a world gets. That all of them give the same bits, tests/determinism proves. */
#define _POSIX_C_SOURCE 200112L /* setenv */

#include <stdlib.h>
#include <string.h>

#include "support/check.h"

static const char *isa_of_a_world(void)
{
    stf_world *world = make_world((stf_world_def){.step = 1});
    const char *isa = stf_world_isa(world);

    stf_world_destroy(world);
    return isa;
}

static bool is_given(const char *wanted, const char *expected)
{
    assert_int_equal(setenv("STEADFAST_ISA", wanted, 1), 0);
    return strcmp(isa_of_a_world(), expected) == 0;
}

/* Every machine runs the baseline, and what runs the widest set runs all below it. An unknown name is as none. */
static void the_instruction_set_that_is_asked_for_is_given(void **state)
{
    (void)state;
    const char *given = getenv("STEADFAST_ISA");
    char *before = given ? strcpy(malloc(strlen(given) + 1), given) : NULL;

    assert_int_equal(unsetenv("STEADFAST_ISA"), 0);
    const char *widest = isa_of_a_world();

    assert_true(is_given("baseline", "baseline"));
    assert_true(is_given(widest, widest));
    assert_true(is_given("avx512", widest));
    assert_true(is_given("avx2", strcmp(widest, "avx512") == 0 ? "avx2" : widest));
    assert_true(is_given("no such set", widest));
    assert_true(is_given("", widest));
    assert_int_equal(before ? setenv("STEADFAST_ISA", before, 1) : unsetenv("STEADFAST_ISA"), 0);
    free(before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_instruction_set_that_is_asked_for_is_given),
    };

    return cmocka_run_group_tests_name("instruction sets, " REAL_NAME, tests, NULL, NULL);
}
