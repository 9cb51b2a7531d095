/*
 * trade: what each integrator and step costs and how wrong it is, measured on your scene, on this machine.
 *
 * You give a function that builds the scene, as it builds its world, once in each precision: a file that is compiled as it is
 * and, with STF_DOUBLE, a second time under another name. The double one is the reference of both.
 *
 *     stf_result build(void *user, stf_world **world);                       // scene.c
 *     stf_result build_in_double(void *user, struct stf_world_f64 **world);  // scene.c again, with STF_DOUBLE
 *
 *     stf_trade_reference *reference;
 *     stf_trade_reference_create(&(stf_trade_reference_def){.build = build_in_double, .duration = 2}, &reference);
 *
 *     const unsigned steps[] = {64, 128, 256, 512};
 *     stf_trade_row rows[7 * 4];
 *     stf_trade(&(stf_trade_def){.build = build, .reference = reference, .integrators = stf_integrators, .integrator_count = 7,
 *                                .steps = steps, .steps_count = 4}, rows);
 *
 *     const stf_trade_row *pick = stf_trade_cheapest(rows, 7 * 4, 0.001);    // 1 mm
 *     stf_trade_reference_destroy(reference);
 *
 * Rows hold no stf_real: those of both precisions may stand in one array, and the questions below then choose among both.
 * These functions allocate, and call libm; none of them belongs into a frame.
 */
#ifndef STEADFAST_TRADE_H
#define STEADFAST_TRADE_H

#include "steadfast/integrator.h"
#include "steadfast/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An error is known if it is at least this many times as large as the error of the reference that it was measured against. */
#define STF_TRADE_MARGIN 100

/* A run is bounded if it never leaves the reference's middle by more than this many times its reach. */
#define STF_TRADE_BOUND 10

/* ---- the reference: where the particles should be, in double --------------------------------------------------------- */

typedef struct stf_trade_reference stf_trade_reference;

struct stf_world_f64; /* stf_world in double */

/* build and duration are required. Called with `user`; it makes the same world every time. */
typedef struct stf_trade_reference_def {
    stf_result (*build)(void *user, struct stf_world_f64 **world);

    /* The exact state of a particle `time` s after the world was built; false where it is not known. NULL, or false for any
       particle: the reference is a run. Taken to be right to 64 ulps of the reach. */
    bool (*exact)(void *user, size_t particle, double time, double position[3], double velocity[3]);

    void *user;
    double duration;           /* s */
    unsigned samples;          /* equal parts of the duration, at whose ends errors are taken; 0: 256 */
    double error;              /* m: a run this good will do; 0: until round-off stops it */
    uint64_t accelerations;    /* the most to spend on a run, on its coarser ones as well; 0: 1,000,000 */
    stf_allocator allocator;   /* all zero: malloc and free */
} stf_trade_reference_def;

/*
 * Makes a reference in *reference: the exact solution, or a run of Gragg's method extrapolated to order 8 (Gragg 1965; Bulirsch
 * and Stoer 1966), its step halved until that changes nothing any more. A guard of the world is off. Errors: NULL, STEP (a
 * duration that is not positive and finite, or too short for its steps; an error that is negative or NaN), NOT_FINITE and
 * DIMENSIONS (of what exact says), MEMORY, DESCRIPTOR, and what build returns. Memory: samples x dimensions doubles a particle;
 * twice in a run.
 */
STF_API stf_result stf_trade_reference_create(const stf_trade_reference_def *def, stf_trade_reference **reference);

/* NULL is fine. */
STF_API void stf_trade_reference_destroy(stf_trade_reference *reference);

/* How far it is itself off. In chaos, or where `accelerations` ran out, this may be as large as the scene, or infinite. */
typedef struct stf_trade_accuracy {
    double error;    /* m: the most, of all samples, by which the RMS over particles changed when the last step was halved */
    double energy;   /* J, likewise */
    double momentum; /* kg m/s, likewise */
    bool exact;      /* it is the exact solution, and the three are round-off */
    unsigned steps;  /* of the run; 0: exact */
    double reach;    /* m: half the diagonal of the box that holds it all */
} stf_trade_accuracy;
STF_API stf_trade_accuracy stf_trade_reference_accuracy(const stf_trade_reference *reference);

/* ---- the measurement ------------------------------------------------------------------------------------------------- */

/* One integrator at one step. Distances are the RMS over all particles that have a finite mass. */
typedef struct stf_trade_row {
    const char *integrator; /* its descriptor's name */
    bool in_double;
    bool finite;            /* no NaN and no infinity in any sample; where false, the errors are infinite */
    bool bounded;           /* see STF_TRADE_BOUND */
    bool on_front;          /* set by stf_trade_front */
    unsigned steps;         /* that make the duration */
    double step;            /* s */
    double end_error;       /* m: distance from the reference at the end */
    double largest_error;   /* m: the largest of all samples */
    double reference_error; /* m: the reference's own */
    double energy_error;    /* J: largest |E - E of the reference|; where energy is conserved that is its drift */
    double momentum_error;  /* kg m/s: likewise */
    double accelerations;   /* of the world, counted */
    double nanoseconds;     /* a particle for each simulated second: median of the repeats */
    double nanoseconds_low, nanoseconds_high; /* their lower and upper quartile */
} stf_trade_row;

/* All but what says 0 or NULL is required. */
typedef struct stf_trade_def {
    stf_result (*build)(void *user, stf_world **world); /* integrator, step and substeps are replaced,
                                                           and a guard is off */
    void *user;
    const stf_trade_reference *reference;
    const stf_integrator *const *integrators;
    size_t integrator_count;
    const unsigned *steps; /* how many make the duration: each a multiple of the samples or a whole part of them */
    size_t steps_count;
    unsigned repeats;      /* 0: 25 */
    double repeat_seconds; /* s, how long one repeat of one row takes at least; of a longer run the start is timed. A coarse
                              timer may take a hundred times that; no repeat is more than 100,000 runs. 0: 0.00025 */
    double (*seconds)(void *user);                           /* a timer, with `user`; NULL: C's clock() */
    void (*progress)(void *user, size_t done, size_t total); /* called now and then, with `user`; NULL */
    stf_allocator allocator;                                 /* all zero: malloc and free */
} stf_trade_def;

/*
 * Measures every integrator at every step: rows[integrator_count x steps_count], the steps of the first integrator first. One
 * run gives the errors; then each repeat times all rows in turn, so that what slows the machine down for a while slows all.
 * Errors: NULL, STEP (a count of steps that shares no samples), PARTICLE, DIMENSIONS (build's world is not the reference's),
 * MEMORY, DESCRIPTOR, and what build and stf_world_set_* return. On an error the rows are undefined.
 */
STF_API stf_result stf_trade(const stf_trade_def *def, stf_trade_row *rows);

/*
 * The same in parts, to compare costs across precisions or scenes: stf_trade_begin measures all but the costs, stf_trade_time
 * times the rows of all these runs in turn, and stf_trade_end frees a run. Until then it needs the rows, the reference and the
 * integrators. Errors: as stf_trade.
 */
typedef struct stf_trade_run stf_trade_run;
STF_API stf_result stf_trade_begin(const stf_trade_def *def, stf_trade_row *rows, stf_trade_run **run);
STF_API stf_result stf_trade_time(stf_trade_run *const *runs, size_t count);
STF_API void stf_trade_end(stf_trade_run *run);

/* ---- what to pick ---------------------------------------------------------------------------------------------------- */

/* Whether the reference is good enough to judge this row's largest error: false in chaos, and at the floor of double. */
STF_API bool stf_trade_error_is_known(const stf_trade_row *row);

/*
 * m: what the largest error is at most: 5 % more than at any sample, since between samples it may be larger, and the
 * reference's own. An error that is not known counts as STF_TRADE_MARGIN times that. Infinite for a run that was not finite and
 * bounded.
 */
STF_API double stf_trade_error_bound(const stf_trade_row *row);

/* Sets on_front: the Pareto front, the rows to which no other is preferable in error and cost. */
STF_API void stf_trade_front(stf_trade_row *rows, size_t count);

/* The cheapest row with an error bound of at most `error` m; NULL: none. */
STF_API const stf_trade_row *stf_trade_cheapest(const stf_trade_row *rows, size_t count, double error);

/* The row with the smallest error bound for at most `nanoseconds` a particle for each simulated second; NULL: none. */
STF_API const stf_trade_row *stf_trade_most_accurate(const stf_trade_row *rows, size_t count, double nanoseconds);

#ifdef __cplusplus
}
#endif

#endif
