#define _POSIX_C_SOURCE 200112L
#include "fuzz.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* No input of a fuzzer asks for more than this in earnest. */
#define BLOCK_MAX ((size_t)1 << 26)

bool fuzz_verbose = false;

void broken(const char *what, const char *file, int line)
{
    fprintf(stderr, "%s:%d: not so: %s\n", file, line, what);
    abort();
}

/* ---- numbers ----------------------------------------------------------------------------------------------------------- */

unsigned take(program *p)
{
    if (p->left == 0)
        return 0;

    p->left--;
    return *p->at++;
}

uint64_t take_integer(program *p, size_t bytes)
{
    uint64_t number = 0;

    for (size_t i = 0; i < bytes; i++)
        number |= (uint64_t)take(p) << (8 * i);
    return number;
}

stf_real take_real(program *p)
{
    static const stf_real extremes[] = {
        (stf_real)-0.0, (stf_real)1e-3, (stf_real)1e3, (stf_real)1e9, (stf_real)-1e9, (stf_real)1e18, (stf_real)1e-18,
        (stf_real)-1e30, (stf_real)1e-30, REAL_LEAST, REAL_LEAST / 2, REAL_MAX, -REAL_MAX, REAL_MAX / 4, (stf_real)NAN,
        (stf_real)INFINITY, -(stf_real)INFINITY};
    const unsigned byte = take(p), first = 256 - COUNT_OF(extremes);
    stf_real x = ((stf_real)byte - 100) / 4;

    if (byte >= first)
        return extremes[byte - first];
    if (byte > 200) {
        const uint64_t bits = take_integer(p, sizeof x);
#ifdef STF_DOUBLE
        memcpy(&x, &bits, sizeof x);
#else
        const uint32_t word = (uint32_t)bits;
        memcpy(&x, &word, sizeof x);
#endif
    }
    return x;
}

double take_double(program *p)
{
    static const double extremes[] = {
        -1, (double)NAN, (double)INFINITY, -(double)INFINITY, DBL_MAX, DBL_MIN, DBL_MIN / 2, 1e300, 1e-300, (double)FLT_MIN,
        (double)FLT_MAX, 1e-40, 1e40, 1e-6, 1e6, -0.0};
    const unsigned byte = take(p), first = 256 - COUNT_OF(extremes);
    double x = byte / 240.0;

    if (byte >= first)
        return extremes[byte - first];
    if (byte > 230) {
        const uint64_t bits = take_integer(p, sizeof x);
        memcpy(&x, &bits, sizeof x);
    }
    return x;
}

stf_vector take_vector(program *p, unsigned dimensions)
{
    stf_vector v = {.x = take_real(p)};

    if (dimensions > 1)
        v.y = take_real(p);
    if (dimensions > 2)
        v.z = take_real(p);
    return v;
}

bool is_same_real(stf_real a, stf_real b) { return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b)); }
bool is_same_vector(stf_vector a, stf_vector b)
{
    return is_same_real(a.x, b.x) && is_same_real(a.y, b.y) && is_same_real(a.z, b.z);
}

/* ---- memory ------------------------------------------------------------------------------------------------------------ */

static void *allocate(void *user, size_t size, size_t alignment)
{
    ration *r = user;
    void *memory = NULL;

    claim(!r->closed);
    claim(size > 0 && alignment > 0 && (alignment & (alignment - 1)) == 0);
    if ((r->fail_in > 0 && --r->fail_in == 0) || size > BLOCK_MAX || posix_memalign(&memory, alignment, size) != 0) {
        r->refused = true;
        return NULL;
    }
    memset(memory, r->garbage, size);
    r->blocks++;
    return memory;
}

static void release(void *user, void *memory, size_t size)
{
    ration *r = user;

    claim(memory && r->blocks > 0);
    memset(memory, r->garbage, size); /* it has this size, or the sanitizer says so */
    free(memory);
    r->blocks--;
}

stf_allocator ration_allocator(ration *r)
{
    return (stf_allocator){.allocate = allocate, .release = release, .user = r};
}

/* ---- worlds ------------------------------------------------------------------------------------------------------------ */

static unsigned fault(bool is_bad, stf_result result) { return is_bad ? 1U << result : 0; }

unsigned vector_faults(stf_vector v, unsigned dimensions)
{
    return fault(!(isfinite(v.x) && isfinite(v.y) && isfinite(v.z)), STF_ERROR_NOT_FINITE) |
           fault((dimensions < 3 && v.z != 0) || (dimensions < 2 && v.y != 0), STF_ERROR_DIMENSIONS);
}

unsigned particle_faults(const stf_particle *p, unsigned dimensions, bool keep_radius)
{
    const bool has_mass = p->inverse_mass == 0 || (p->inverse_mass >= REAL_LEAST && isfinite(p->inverse_mass));

    return vector_faults(p->position, dimensions) | vector_faults(p->velocity, dimensions) |
           fault(!has_mass, STF_ERROR_MASS) |
           fault(!(p->radius >= 0 && isfinite(p->radius)) || (!keep_radius && p->radius != 0), STF_ERROR_RADIUS);
}

bool is_step(double step, unsigned substeps)
{
    const double least = (double)REAL_LEAST, most = (double)REAL_MAX, part = step / substeps;

    return isfinite(step) && part >= least && part <= most;
}

void run_backwards(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    while (tasks > 0)
        task(context, --tasks);
}

void choose_instructions(unsigned byte)
{
    static const char *const names[] = {"avx512", "avx2", "baseline"};

    claim(setenv("STEADFAST_ISA", names[byte % COUNT_OF(names)], 1) == 0);
}
