/* What the parts of the instrument share. It holds no stf_real, and so has one name in both precisions. */
#ifndef STEADFAST_SRC_TRADE_TRADE_H
#define STEADFAST_SRC_TRADE_TRADE_H

#include "steadfast/trade.h"

/* What a world does, at samples 0 (the start) to `samples`. */
typedef struct stf_trade_path {
    double *position; /* m: [samples + 1][particles][dimensions] */
    double *energy;   /* J: [samples + 1] */
    double *momentum; /* kg m/s: [samples + 1][STF_DIMENSIONS_MAX] */
} stf_trade_path;

struct stf_trade_reference {
    stf_allocator allocator;
    size_t particles, movable; /* movable: with a finite mass */
    unsigned dimensions, samples;
    double duration; /* s */
    stf_trade_path path;
    double middle[STF_DIMENSIONS_MAX]; /* m */
    stf_trade_accuracy accuracy;
};

/* sqrt of the mean of squares over the movable, whose sum is given. */
double stf_trade_rms(const stf_trade_reference *reference, double sum_of_squares);

/* The length of the difference of two vectors of STF_DIMENSIONS_MAX. */
double stf_trade_distance(const double a[], const double b[]);

/* The larger; infinite if either is NaN: a difference from a state that is lost. */
double stf_trade_larger(double a, double b);

#endif
