/* A scene in one precision, handed to the instrument. The source is compiled for both. */
#ifndef STEADFAST_TRADE_ROWS_H
#define STEADFAST_TRADE_ROWS_H

#include "steadfast/trade.h"

#define ROWS_INTEGRATORS_MAX 64

/* What to measure. It holds no reals. */
typedef struct rows_def {
    const char *scene_name;
    const stf_trade_reference *reference;
    const size_t *integrators; /* places in stf_integrators */
    size_t integrator_count;
    const unsigned *steps;
    size_t steps_count;
    unsigned repeats;
    void (*progress)(void *user, size_t done, size_t total);
    void *user;
} rows_def;

/* stf_trade_begin in float and in double: rows[integrator_count x steps_count]. def has to outlive the run. */
stf_result rows_begin_f32(rows_def *def, stf_trade_row *rows, stf_trade_run **run);
stf_result rows_begin_f64(rows_def *def, stf_trade_row *rows, stf_trade_run **run);

/* The scene's builder and exact solution are put into def. */
stf_result rows_make_reference(const char *scene_name, stf_trade_reference_def def, stf_trade_reference **reference);

#endif
