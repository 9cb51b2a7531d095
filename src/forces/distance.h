/* Squares of distances in double, for potentials. Components stand `stride` apart, as in stf_particles. */
#ifndef STEADFAST_SRC_DISTANCE_H
#define STEADFAST_SRC_DISTANCE_H

#include "../real.h"

static inline double stf_square_between(const stf_real *a, const stf_real *b, size_t stride, unsigned dimensions)
{
    double square = 0;

    for (unsigned d = 0; d < dimensions; d++) {
        const double distance = (double)a[d * stride] - (double)b[d * stride];
        square += distance * distance;
    }
    return square;
}

static inline double stf_square_to_point(const stf_real *x, size_t stride, unsigned dimensions, stf_vector point)
{
    const stf_real components[STF_DIMENSIONS_MAX] = {point.x, point.y, point.z};
    double square = 0;

    for (unsigned d = 0; d < dimensions; d++) {
        const double distance = (double)x[d * stride] - (double)components[d];
        square += distance * distance;
    }
    return square;
}

#endif
