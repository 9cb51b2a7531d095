/* The numbers of the precision that a file is compiled for. */
#ifndef STEADFAST_TESTS_REAL_H
#define STEADFAST_TESTS_REAL_H

#include <float.h>

#ifdef STF_DOUBLE
#define REAL_EPSILON DBL_EPSILON
#define REAL_MAX DBL_MAX
#define REAL_LEAST DBL_MIN
#define REAL_NAME "double"
#else
#define REAL_EPSILON ((double)FLT_EPSILON)
#define REAL_MAX FLT_MAX
#define REAL_LEAST FLT_MIN
#define REAL_NAME "float"
#endif

#endif
