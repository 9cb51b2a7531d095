/* The integrator's side of stability: what its steps do to x'' = A x + B x', with small matrices, n x n. */
#ifndef STEADFAST_SRC_AMPLIFICATION_H
#define STEADFAST_SRC_AMPLIFICATION_H

#include <complex.h>

#include "steadfast/integrator.h"

#ifdef STF_DOUBLE
#define stf_first_growth stf_first_growth_f64
#define stf_run_grows stf_run_grows_f64
#endif

/*
 * The smallest step at which the mode x'' = alpha x + beta x' grows: 0 where it does at every step, INFINITY where it does
 * at none up to `most`. Time is in units that make alpha and beta about 1.
 */
double stf_first_growth(const stf_integrator *integrator, double complex alpha, double complex beta, double most);

/* Whether a run grows, and clearly: by some 0.3 % a step. n is at most STF_RUN_MAX. */
#define STF_RUN_MAX 64
bool stf_run_grows(const stf_integrator *integrator, size_t n, const double *a, const double *b, double dt);

#endif
