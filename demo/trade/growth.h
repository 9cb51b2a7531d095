/* How a damped spring grows in a step: measured, and the boundary that theory draws. */
#ifndef STEADFAST_TRADE_GROWTH_H
#define STEADFAST_TRADE_GROWTH_H

#include <stddef.h>

/* By what factor x'' = -omega^2 x - k x' grows in a step, from real runs in double. integrator: a place in stf_integrators. */
double growth_measured(size_t integrator, double k_dt, double omega_dt);

/* Below 0 where theory says that nothing grows, above 0 where something does. NaN: this integrator's theory is not here. */
double growth_theory(size_t integrator, double k_dt, double omega_dt);

#endif
