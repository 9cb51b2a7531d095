/*
 * reference: what the library is measured against: the same arithmetic as its own, in the best loop of plain C that a scene's
 * author could write for that scene alone. Each is compiled for every instruction set that the library knows, in both
 * precisions, and checked against the library before it is timed.
 */
#ifndef STEADFAST_TESTS_REFERENCE_H
#define STEADFAST_TESTS_REFERENCE_H

#include "steadfast/base.h"

#ifdef STF_DOUBLE
#define reference_chosen reference_chosen_f64
#endif

/* The constants of a scene. */
typedef struct reference_law {
    stf_real dt;              /* s */
    stf_real gravity[3];      /* m/s^2 */
    stf_real drag;            /* linear: kg/s; quadratic: kg/m */
    stf_real centre[3];       /* of the attractor, m */
    stf_real strength;        /* of the attractor: m^3/s^2; all pairs: G */
    stf_real softening;       /* m */
} reference_law;

/*
 * A step of n particles, or another pass over them. Arrays a component, one after another: plain parameters with `restrict`,
 * as gcc 12 makes no vector loop of pointers that it finds in a struct. a: kept accelerations (velocity Verlet) or forces.
 */
#define REFERENCE_STEP                                                                                                     \
    size_t n, stf_real *restrict x, stf_real *restrict y, stf_real *restrict z, stf_real *restrict vx, stf_real *restrict vy, \
        stf_real *restrict vz, stf_real *restrict ax, stf_real *restrict ay, stf_real *restrict az,                       \
        const stf_real *restrict w, const reference_law *law
typedef void reference_step(REFERENCE_STEP);

/* Springs whose first ends are consecutive particles, and whose second ends are. */
typedef struct reference_run {
    uint32_t a, b; /* where the ends start */
    size_t first, count; /* in the arrays of stiffness, damping and rest length */
} reference_run;

typedef struct reference_edge {
    uint32_t a, b;
    stf_real stiffness, damping, rest_length;
} reference_edge;

/* Particles whose arrays are one piece of memory; and springs as runs or as edges, whichever is used. */
typedef struct reference_bodies {
    size_t n;
    stf_real *x[3], *v[3], *a[3], *w;
    stf_real *packed; /* [9 n]: position and velocity of a particle side by side, then its force; or scratch */
    void *memory;     /* of all arrays above */
    reference_run *runs;
    size_t run_count;
    stf_real *stiffness, *damping, *rest_length; /* of runs, one piece of memory */
    reference_edge *edges;
    size_t edge_count;
} reference_bodies;

/* One instruction set's loops. */
typedef struct reference {
    const char *isa;
    reference_step *semi_implicit_euler, *velocity_verlet, *rk4; /* gravity and linear drag */
    reference_step *rk4_field;   /* gravity, quadratic drag, an attractor */
    reference_step *push;        /* semi-implicit Euler with gravity and the forces in a */
    reference_step *update;      /* x += w, ..., vz += w: semi-implicit Euler's traffic without its arithmetic */
    reference_step *add_multiply; /* x = x * drag + dt, REFERENCE_CHAIN times in a row, for all nine that are not w */
    reference_step *copy;         /* a = -x: bandwidth from one place to another */
    void (*run_forces)(const reference_bodies *bodies);  /* a = spring forces */
    void (*edge_forces)(const reference_bodies *bodies); /* a = spring forces */
    void (*all_pairs)(const reference_bodies *bodies, const reference_law *law); /* a = gravity, N; packed: scratch */
} reference;

#define REFERENCE_CHAIN 8

/* Arrays of bodies have room for a multiple of this, w = 0 in what is left over. */
#define REFERENCE_LANES (64 / sizeof(stf_real))

/* The one of the instruction set that the library uses: the best that the processor has, or what STEADFAST_ISA names. */
const reference *reference_chosen(void);

#endif
