/* What the two precisions differ in, beside the names. */
#ifndef STEADFAST_SRC_REAL_H
#define STEADFAST_SRC_REAL_H

#include <float.h>
#include <math.h>
#include <string.h>

#include "steadfast/base.h"
#include "variant.h"

/* The same bits everywhere needs arithmetic in the type itself: on 32-bit x86 compile with -msse2 -mfpmath=sse. */
#if FLT_EVAL_METHOD != 0
#error "Steadfast needs FLT_EVAL_METHOD 0: float arithmetic in float, double arithmetic in double"
#endif

#ifdef STF_DOUBLE
#define STF_REAL_MIN DBL_MIN
#define STF_REAL_MAX DBL_MAX
#define STF_REAL_NAME "double"
#define STF_MAGNITUDE_MAX INT64_MAX
typedef int64_t stf_magnitude;
static inline stf_real stf_sqrt(stf_real x) { return sqrt(x); }
#else
#define STF_REAL_MIN FLT_MIN
#define STF_REAL_MAX FLT_MAX
#define STF_REAL_NAME "float"
#define STF_MAGNITUDE_MAX INT32_MAX
typedef int32_t stf_magnitude;
static inline stf_real stf_sqrt(stf_real x) { return sqrtf(x); }
#endif

/*
 * Rows of blocks are multiples of so many reals, a cache line of floats. A loop that the compiler sees to be one needs no loop
 * for a rest; shorter runs of springs are not worth a vector, and sums over lanes are made in as many places.
 */
#define STF_ROW_MULTIPLE ((size_t)16)

/* |x| as an integer, in the order of magnitudes: finite, infinite, NaN (IEEE 754-2008, 5.10). A comparison of reals may raise a
   floating-point flag; of these none does. */
static inline stf_magnitude stf_magnitude_of(stf_real x)
{
    stf_magnitude bits;

    memcpy(&bits, &x, sizeof bits);
    return bits & STF_MAGNITUDE_MAX;
}

static inline bool stf_vector_is_finite(stf_vector v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

/* Whether v is 0 in the dimensions that a world of `dimensions` lacks. */
static inline bool stf_vector_fits(stf_vector v, unsigned dimensions)
{
    return (dimensions > 2 || v.z == 0) && (dimensions > 1 || v.y == 0);
}

static inline bool stf_is_coefficient(stf_real x) { return isfinite(x) && x >= 0; }

/* 0 of the immovable, else of a mass that is a stf_real. */
static inline bool stf_is_inverse_mass(stf_real x) { return stf_is_coefficient(x) && (x == 0 || x >= STF_REAL_MIN); }

#endif
