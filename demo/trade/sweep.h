/* One scene, measured: every integrator at every step in both precisions. */
#ifndef STEADFAST_TRADE_SWEEP_H
#define STEADFAST_TRADE_SWEEP_H

#include "../scenes/scene.h"
#include "rows.h"

#define SWEEP_LEVELS_MAX 20

/* Both precisions, or one. */
typedef enum precision { PRECISION_BOTH, PRECISION_FLOAT, PRECISION_DOUBLE } precision;

typedef struct sweep_settings {
    const stf_integrator *integrator; /* NULL: all */
    precision precision;
    unsigned levels;   /* steps to try, each half of the one before; 0: as many as `quick` allows for */
    unsigned repeats;
    double tolerance;  /* the smallest error asked about, as a part of the scene's size; 0: all that there is to know */
    bool quick;        /* spend seconds on a scene, not half a minute */
    unsigned shard, shards; /* this part, from 1, of so many */
} sweep_settings;

typedef struct sweep {
    const scene *scene;
    double duration; /* the scene's, rounded up to a whole number of its longest step */
    unsigned samples;
    unsigned steps[SWEEP_LEVELS_MAX]; /* that make the duration */
    size_t levels;
    size_t integrators[ROWS_INTEGRATORS_MAX]; /* places in stf_integrators */
    size_t integrator_count;
    size_t particles;
    stf_trade_accuracy reference;
    stf_trade_row *rows; /* [precisions][integrator_count][levels]: float first */
    size_t count;
} sweep;

/* Measures. Nothing is there to measure (count is 0) where no part of the scene belongs to the shard. */
stf_result sweep_run(sweep *s, const scene *of, const sweep_settings *settings);

void sweep_free(sweep *s);

/* The row of an integrator (by its place in stf_integrators) at a number of steps; NULL: not measured. */
const stf_trade_row *sweep_row(const sweep *s, size_t integrator, bool in_double, unsigned steps);

#endif
