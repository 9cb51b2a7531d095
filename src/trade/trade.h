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

/* The part of a run that holds no stf_real. Its precision puts it first in a struct of its own. */
struct stf_trade_run {
    stf_allocator allocator;
    size_t bytes; /* of all of it */
    stf_trade_row *rows;
    size_t count;
    unsigned repeats;
    double simulated; /* s, times particles */
    double *seconds;  /* a whole run: [count][repeats]; in [row][0] at first what judging the row took */
    void (*progress)(void *user, size_t done, size_t total);
    void *user;
    size_t done, total; /* rows judged, and timed once */

    /* s that a whole run of this row takes, which takes about `estimate` */
    stf_result (*time_row)(const stf_trade_run *run, size_t row, double estimate, double *seconds);
};

void stf_trade_advance(stf_trade_run *run);

/* sqrt of the mean of squares over the movable, whose sum is given. */
double stf_trade_rms(const stf_trade_reference *reference, double sum_of_squares);

/* The length of the difference of two vectors of STF_DIMENSIONS_MAX. */
double stf_trade_distance(const double a[], const double b[]);

/* The larger; infinite if either is NaN: a difference from a state that is lost. */
double stf_trade_larger(double a, double b);

#endif
