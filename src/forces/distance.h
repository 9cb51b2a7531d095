/* The square of a distance in double, for potentials. */
#ifndef STEADFAST_SRC_DISTANCE_H
#define STEADFAST_SRC_DISTANCE_H

#include "../real.h"

/* |a - b|^2; the components of each stand that far apart: a particle's by its block's stride, a vector's next to each other. */
static inline double stf_square_between(const stf_real *a, size_t a_stride, const stf_real *b, size_t b_stride,
                                        unsigned dimensions)
{
    double square = 0;

    for (unsigned d = 0; d < STF_DIMENSIONS_MAX && d < dimensions; d++) {
        const double distance = (double)a[d * a_stride] - (double)b[d * b_stride];
        square += distance * distance;
    }
    return square;
}

#endif
