/* Initial value problems with exact solutions, one particle each, for measuring integrators. */
#ifndef STEADFAST_TESTS_PROBLEM_H
#define STEADFAST_TESTS_PROBLEM_H

#include "steadfast/steadfast.h"

typedef struct problem {
    const char *name;
    unsigned dimensions;
    double duration; /* s: a power of two, so that a step of duration / 2^n is exact in float */
    stf_particle start;
    void (*add_forces)(stf_world *world);
    void (*exact)(double time, double state[4]); /* x, y, vx, vy */
} problem;

extern const problem problem_oscillator;     /* x'' = -x */
extern const problem problem_kepler;         /* e = 0.5, from the pericentre */
extern const problem problem_nonlinear_drag; /* v' = -|v| v */
extern const problem problem_time_dependent; /* x'' = cos t */
extern const problem problem_magnetic;       /* v' = B x v */

/* All of them, NULL-terminated. */
extern const problem *const problems[];

stf_world *problem_world(const problem *p, const stf_integrator *integrator, double step);

/* The distance of the world's particle from the exact state, in position and velocity together. */
double problem_error(const problem *p, const stf_world *world);

/* problem_error after `steps` steps that fill the duration. */
double problem_error_after(const problem *p, const stf_integrator *integrator, unsigned steps);

/* A link force that ties particles together and does nothing: it makes a world step as a whole. */
extern const stf_force idle_link;

/* Forces of tests, as a user would write them: F = cos t along x, and F = m B x v with B = 1 along z. */
extern const stf_force time_force, magnetic_force;

#endif
