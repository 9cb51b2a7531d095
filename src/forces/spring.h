/*
 * What both kinds of damped springs share: Hooke's law with a damper along the spring. Sources: R. Hooke, De potentia
 * restitutiva (1678); A. Witkin, D. Baraff, Physically Based Modeling, SIGGRAPH course notes (1997), Particle System Dynamics.
 */
#ifndef STEADFAST_SRC_SPRING_H
#define STEADFAST_SRC_SPRING_H

#include "distance.h"

static inline bool stf_is_spring(stf_real stiffness, stf_real damping, stf_real rest_length)
{
    return stf_is_coefficient(stiffness) && stf_is_coefficient(damping) && stf_is_coefficient(rest_length);
}

/* The factor f of F = -f d: (k (l - l0) + c (w . u)) / l with u = d / l and w . d given; 0 where l is 0. */
static inline stf_real stf_spring_factor(stf_real square, stf_real w_dot_d, stf_real stiffness, stf_real damping,
                                     stf_real rest_length)
{
    const stf_real length = stf_sqrt(square), inverse = 1 / length;
    const stf_real factor = (stiffness * (length - rest_length) + damping * (w_dot_d * inverse)) * inverse;

    return length > 0 ? factor : 0;
}

static inline int stf_compare_reals(stf_real a, stf_real b) { return (a > b) - (a < b); }

/* k (l - l0)^2 / 2, from l^2 */
static inline double stf_spring_energy(double square, stf_real stiffness, stf_real rest_length)
{
    const double stretch = sqrt(square) - (double)rest_length;

    return (double)stiffness * stretch * stretch / 2;
}

#endif
