/*
 * Compensated sums: a number that is added to at every step, and beside it what rounding left of it, which goes into the next
 * addition. The sum of n terms d is then off by 2 eps sum |d| (and n eps^2 of that), where a plain one is by up to n eps / 2 of
 * itself. Sources: W. Kahan, Comm. ACM 8, 40 (1965); D. Goldberg, ACM Computing Surveys 23, 5 (1991), theorem 8 (the bound, of
 * terms of any size); E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), VIII.5 (in integrators).
 */
#ifndef STEADFAST_SRC_SUM_H
#define STEADFAST_SRC_SUM_H

#include "real.h"

/* sum += d. `compensated` is a constant at each call; where it is false there is no rest. */
static inline void stf_sum_add(stf_real *sum, stf_real *rest, stf_real d, bool compensated)
{
    const stf_real before = *sum, added = compensated ? d + *rest : d, after = before + added;

    *sum = after;
    if (compensated)
        *rest = added - (after - before);
}

#endif
