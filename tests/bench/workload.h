/*
 * workload: the scenes that are measured, each as a world of the library and as the references' arrays. workload.c and what it
 * calls is compiled for float and for double; bench_precision is what the rest of the benchmark sees of either.
 */
#ifndef STEADFAST_TESTS_WORKLOAD_H
#define STEADFAST_TESTS_WORKLOAD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef enum bench_kind {
    FREE,    /* gravity and linear drag */
    SLOWING, /* linear drag alone */
    HUNG,    /* every particle on a damped spring to the origin */
    FIELD,   /* gravity, quadratic drag and an attractor */
    CLOTH,   /* a square cloth of structural, shear and bend springs, with gravity */
    GRAPH,   /* 4 springs a particle between random ends */
    PAIRS,   /* every particle pulls every other */
    MACHINE, /* none: what the machine can do */
    KINDS
} bench_kind;

/* Who steps it, and in which form. */
typedef enum bench_form {
    LIBRARY,
    LIBRARY_SHUFFLED, /* springs in random order */
    LIBRARY_AT_REST,  /* slowed by drag until velocities are as small as reals get */
    LIBRARY_COMPENSATED,
    LIBRARY_THREADS,  /* on two threads */
    LIBRARY_GUARDED,  /* with the guard on */
    REFERENCE,        /* the loop of the integrator; of springs, runs; of pairs, tiles */
    EDGES,            /* a gather and a scatter a spring */
    EDGES_SORTED,     /* by first end, then by second */
    UPDATE,           /* reads and writes what semi-implicit Euler does */
    COPY,
    ADD_MULTIPLY,
    ADD_MULTIPLY_THREADS /* on two threads */
} bench_form;

typedef struct bench_scene {
    bench_kind kind;
    bench_form form;
    const char *integrator; /* its name; NULL: semi_implicit_euler */
    size_t n;               /* particles; of a cloth, a square number */
} bench_scene;

static inline bool bench_is_library(const bench_scene *scene) { return scene->form <= LIBRARY_GUARDED; }

typedef struct bench_precision {
    const char *name;
    size_t real_bytes;
    void *(*setup)(const void *scene); /* for measure_case; run makes one step */
    void (*run)(void *context);
    void (*run_interval)(void *context); /* as many steps as the guard lets go by between two looks, in calls of one */
    void (*teardown)(void *context);
    /* Whether this form moves as the library does, to round-off (on two threads: bit by bit); else says so on stderr. */
    bool (*check)(const bench_scene *scene);
    /* Bytes that a world of n particles holds, from its allocator. */
    size_t (*world_bytes)(const bench_scene *scene);
} bench_precision;

extern const bench_precision bench_float, bench_double;

#define BENCH_INTERVAL 512 /* the guard's longest of its own */

/* Springs of a scene. */
size_t bench_springs(const bench_scene *scene);

/* The instruction set that the library uses: what the processor has or STEADFAST_ISA names. */
const char *bench_isa(void);

#endif
