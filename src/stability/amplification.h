/* The integrator's side of stability: what its steps do to one mode, and to many together. */
#ifndef STEADFAST_SRC_AMPLIFICATION_H
#define STEADFAST_SRC_AMPLIFICATION_H

#include <complex.h>

#include "steadfast/integrator.h"

#ifdef STF_DOUBLE
#define stf_amplification stf_amplification_f64
#define stf_first_growth stf_first_growth_f64
#define stf_reduced_run_grows stf_reduced_run_grows_f64
#endif

/*
 * The spectral radius of one step of dt on x'' = alpha x + beta x', over the extended state (x, v, history). Time is in units
 * that make alpha and beta about 1.
 */
double stf_amplification(const stf_integrator *integrator, double complex alpha, double complex beta, double dt);

/* The smallest dt at which a step makes the mode grow: 0 where every step does, INFINITY where none up to `most` does. */
double stf_first_growth(const stf_integrator *integrator, double complex alpha, double complex beta, double most);

/* The most unknowns of a run. */
#define STF_RUN_LENGTH_MAX 64

/* Whether a run on x'' = A x + B x', n x n, grows, and clearly: by some 0.3 % a step. */
bool stf_reduced_run_grows(const stf_integrator *integrator, size_t n, const double *a, const double *b, double dt);

#endif
