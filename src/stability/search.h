/* What the parts of a measurement share: what it works with, the modes of the reduced scene, the report. */
#ifndef STEADFAST_SRC_SEARCH_H
#define STEADFAST_SRC_SEARCH_H

#include <complex.h>

#include "../allocator.h"
#include "reduction.h"
#include "steadfast/stability.h"

#ifdef STF_DOUBLE
#define stf_search stf_search_f64
#define stf_search_find_limiting stf_search_find_limiting_f64
#define stf_search_find_shape stf_search_find_shape_f64
#define stf_search_report stf_search_report_f64
#define stf_mode_root stf_mode_root_f64
#endif

#define STF_SEARCH_FOR_FORCES 3 /* accelerations kept back for the share of each force */
#define STF_SEARCH_SCRATCH 3    /* vectors beside the shapes */

/* In units of the frequency. */
typedef struct stf_mode {
    double complex lambda;
    double complex alpha, beta;
    double limit; /* INFINITY: none, or above that of another */
} stf_mode;

typedef struct stf_search {
    const stf_integrator *integrator;
    stf_allocator allocator;
    stf_jacobian jacobian;
    stf_reduction reduction;
    unsigned accelerations; /* at most */
    void *memory;
    size_t bytes;
    double *scratch[STF_SEARCH_SCRATCH]; /* [jacobian.length] */
    double complex *matrix, *values, *shape;
    double *h;     /* of stf_reduce; then `calm` */
    double *calm;  /* [count][count]: A without what grows by itself */
    double growth; /* of that */
} stf_search;

/* The mode of the lowest limit; of several at 0 the fastest. Its limit is INFINITY where none has one. */
stf_mode stf_search_find_limiting(stf_search *s);

/* y of (lambda^2 - lambda B - A) y = 0, as parts of the shapes, into s->shape. */
void stf_search_find_shape(stf_search *s, double complex lambda);

/* The eigenvalue of x'' = alpha x + beta x' that is the larger, or the one that grows more. */
double complex stf_mode_root(const stf_mode *m, bool growing);

/* What the limiting mode is in the world. */
void stf_search_report(stf_search *s, const stf_mode *m, stf_stability *found);

#endif
