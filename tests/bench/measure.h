/*
 * measure: what a piece of code costs, on one core, beside others. Cases of one list are measured in turns, round after round,
 * so that what slows the machine for a while slows all of them: a ratio is taken within each round, and its median counts.
 * Time in which another process had the core does not count. What waits or sleeps can't be measured with it.
 */
#ifndef STEADFAST_TESTS_MEASURE_H
#define STEADFAST_TESTS_MEASURE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MEASURE_ROUNDS_MAX 31

typedef struct measure_case {
    const char *name;
    const void *argument;               /* of setup */
    void *(*setup)(const void *argument); /* gives the context of all below; NULL: it can't, and the case is left out */
    void (*prepare)(void *context);     /* before each sample, not timed; a sample is then one run. NULL: none */
    void (*run)(void *context);         /* what is timed, as often as it takes to fill a sample */
    void (*teardown)(void *context);    /* NULL: none */
    double items;                       /* pieces of work in one run: results are a piece */
} measure_case;

/* How long to measure. Where all is 0 the defaults count. */
typedef struct measure_plan {
    double sample;   /* s a sample at least; 0: 4 ms */
    double total;    /* s, after which no further round starts, but at least three are run if so many are asked for; 0: 1 s */
    unsigned rounds; /* at most; 0: 15 */
} measure_plan;

/* ns a piece of work. */
typedef struct measure_result {
    bool measured;
    unsigned rounds, runs; /* samples; runs in each */
    double samples[MEASURE_ROUNDS_MAX];
    double median, min, max;
} measure_result;

/* Sets up all cases, measures them in turns into results[count], tears them down. */
void measure(const measure_case *cases, size_t count, const measure_plan *plan, measure_result *results);

/* The median over the rounds of `result` to `reference`, both from one call of measure; 0 if either was left out. */
double measure_ratio(const measure_result *result, const measure_result *reference);

/* The median of values[count], which it sorts. */
double measure_median(double *values, size_t count);

/* s since some moment; never runs backwards. */
double measure_now(void);

/* Keeps the process on the core that it is on, so that no move between cores falls into a sample. False: not on this system. */
bool measure_pin(void);
/* Lets it, and threads that it starts from then on, run on every core that it was allowed before; whether it was pinned. */
bool measure_unpin(void);

/* The processor's name, and the compiler's and its version. Static storage. */
const char *measure_processor(void);
const char *measure_compiler(void);

#ifdef __cplusplus
}
#endif

#endif
