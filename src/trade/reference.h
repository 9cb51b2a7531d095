/* What references are made with. All of it is in double: include it with STF_DOUBLE. */
#ifndef STEADFAST_SRC_TRADE_REFERENCE_H
#define STEADFAST_SRC_TRADE_REFERENCE_H

#include "trade.h"

/* The integrator of references. */
extern const stf_integrator stf_trade_extrapolation;

/* Errors: MEMORY. */
stf_result stf_trade_path_allocate(const stf_trade_reference *r, stf_trade_path *path);
void stf_trade_path_release(const stf_trade_reference *r, const stf_trade_path *path);

/* The world as it stands is this sample. */
void stf_trade_path_record(const stf_trade_reference *r, stf_trade_path *path, unsigned sample, const stf_world *world);

/* By how much two paths differ. */
void stf_trade_path_compare(const stf_trade_reference *r, const stf_trade_path *a, const stf_trade_path *b,
                            stf_trade_accuracy *accuracy);

/* The box that holds the reference's path: its middle, and half of its diagonal. */
void stf_trade_path_reach(stf_trade_reference *r);

#endif
