/* The scene on a few shapes: x'' = A x + B x' with small matrices in place of the world's forces. */
#ifndef STEADFAST_SRC_REDUCTION_H
#define STEADFAST_SRC_REDUCTION_H

#include "jacobian.h"

#ifdef STF_DOUBLE
#define stf_reduction stf_reduction_f64
#define stf_reduce stf_reduce_f64
#endif

/* Time is in units of 1 / jacobian.frequency. A shape is a vector of norm 1; they are orthogonal. */
typedef struct stf_reduction {
    size_t count;         /* shapes */
    bool damped;          /* whether anything depends on velocity; else b is all 0 */
    double weight;        /* of B beside A in what the shapes are the extreme ones of */
    double *shapes;       /* [most + 1][length] */
    double *damped_shapes; /* [most][length]: B times each; NULL unless damped */
    double *a, *b;        /* [most][most], rows `count` apart: V^T A V, V^T B V */
    double left;          /* norm of what A + weight B does to the last shape beyond all shapes */
} stf_reduction;

/*
 * Krylov's space of A + weight B from the first of the shapes, which is given, of any norm but 0: `most` shapes, fewer
 * where the space is exhausted. h[most + 1][most] is scratch. Cost: one acceleration a shape, two where something depends
 * on velocity.
 */
void stf_reduce(stf_reduction *r, stf_jacobian *j, size_t most, double *h);

#endif
