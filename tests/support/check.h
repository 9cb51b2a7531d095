/*
 * What the tests share: cmocka, and checks that cmocka lacks (its assert_float_equal compares as float, and passes for NaN).
 * Include this in place of cmocka.h.
 */
#ifndef STEADFAST_TESTS_CHECK_H
#define STEADFAST_TESTS_CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "steadfast/steadfast.h"
#include "support/real.h"

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* Fails unless |actual - expected| <= tolerance, and so for every NaN; the same infinity on both sides is close. */
#define assert_close(actual, expected, tolerance) \
    check_close((double)(actual), (double)(expected), (double)(tolerance), #actual, __FILE__, __LINE__)

/* Fail unless actual < bound or actual > bound; so for every NaN. */
#define assert_below(actual, bound) check_below((double)(actual), (double)(bound), #actual, __FILE__, __LINE__)
#define assert_above(actual, bound) check_below(-(double)(actual), -(double)(bound), "-" #actual, __FILE__, __LINE__)

#define assert_ok(result) check_result(result, STF_OK, #result, __FILE__, __LINE__)
#define assert_refused(result, expected) check_result(result, expected, #result, __FILE__, __LINE__)

/* What the checks are made of; test_support.c proves them. */
bool is_close(double actual, double expected, double tolerance);
bool is_below(double actual, double bound);

void check_close(double actual, double expected, double tolerance, const char *what, const char *file, int line);
void check_below(double actual, double bound, const char *what, const char *file, int line);
void check_result(stf_result result, stf_result expected, const char *what, const char *file, int line);

/*
 * The world's particles in full (every bit), its count, ticks, time, step, substeps, gravity, integrator, forces and
 * records.
 */
uint64_t hash_of(const stf_world *world);

/* FNV-1a, 64 bits: a hash of what `hash` is of and these bytes; from HASH_START on. */
#define HASH_START UINT64_C(0xcbf29ce484222325)
uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count);

/* The next of a sequence of pseudorandom numbers in [0, 1) with 24 bits (splitmix64); *state starts as any seed. */
double next_random(uint64_t *state);

/* Shorthands that fail the test if the library refuses. */
stf_world *make_world(stf_world_def def);
void add_force(stf_world *world, const stf_force *force, const void *record);
stf_particle particle_of(const stf_world *world, size_t index);

#endif
