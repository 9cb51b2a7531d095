/* The integrator of references. Include it with STF_DOUBLE. */
#ifndef STEADFAST_SRC_TRADE_EXTRAPOLATION_H
#define STEADFAST_SRC_TRADE_EXTRAPOLATION_H

#include "steadfast/integrator.h"

extern const stf_integrator stf_trade_extrapolation;

#endif
