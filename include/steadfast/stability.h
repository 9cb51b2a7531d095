/*
 * stability: the largest step that a world's integrator survives in the scene as it stands.
 *
 * A step is stable as long as the integrator makes no small disturbance grow that would not grow by itself. How fast a
 * scene swings and how strongly it is damped says its Jacobian, A = da/dx and B = da/dv. No force has to supply it:
 * products with vectors come from differences of stf_world_accelerations, and so the user's own forces count like the
 * library's. A Krylov space reduces the scene to its extreme shapes, each mode there is x'' = -omega^2 x - k x', and the
 * integrator's own step on that says at which length it starts to grow: no table of limits, and so the user's own
 * integrators count as well.
 *
 *     stf_stability found;
 *     stf_stability_measure(world, NULL, &found);
 *     if (found.substeps > stf_world_substeps(world))
 *         stf_world_set_substeps(world, found.substeps);
 *
 * Sources: D. A. Knoll, D. E. Keyes, J. Comput. Phys. 193, 357 (2004), sec. 2.3 (differences); Z. Bai, Y. Su, SIAM J. Matrix
 * Anal. Appl. 26, 640 (2005) (reduction); F. Tisseur, K. Meerbergen, SIAM Rev. 43, 235 (2001) (modes of x'' = A x + B x').
 *
 * What it can't know: it is linear, and of this moment. A scene that gets stiffer (a cloth that is stretched, an orbit that
 * comes closer) wants another look. Modes that are much slower than the fastest, or than a growth, are not told from free
 * motion: below some 1/20 of it in float (1/6 in nets), 1/1000 in double. So where growth is above 0, a limit of INFINITY
 * only says that no mode could be told, as in a rope that a far too long step has crumpled. Where dampers are in proportion
 * to springs, limits are right within 2 %. In 20 nets of 200 masses with springs and dampers of all kinds, limits were up
 * to some 20 % too long; the advice, which keeps away from them by STF_STABILITY_SAFETY, held in all. Explicit Euler is the
 * exception: it is limited by the least damped mode, which in large nets hides among the others, and its limit may be off
 * by half. Where springs buckle, the limits of midpoint and improved Euler may be too short.
 */
#ifndef STEADFAST_STABILITY_H
#define STEADFAST_STABILITY_H

#include "steadfast/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The advised step is at most this part of the limit. */
#define STF_STABILITY_SAFETY 0.8

/* The most accelerations of the world that a call takes. */
#define STF_STABILITY_ACCELERATIONS_MAX 60

/* All zero is a valid def, and so is NULL. */
typedef struct stf_stability_def {
    stf_allocator allocator; /* all zero: malloc and free */
    unsigned accelerations;  /* at most, 25 to 60, what is outside is taken as the nearest; 0: 60. Fewer cost less memory,
                                and find the limits of large nets of springs less exactly */
} stf_stability_def;

/* "The mode" is the one that sets the limit. Where nothing does, particle is SIZE_MAX, and force, omega and damping are 0. */
typedef struct stf_stability {
    double limit;          /* s, the step of the integrator beyond which it grows; 0: at every step; INFINITY: none found */
    double step;           /* s, the present one: step of the world / substeps */
    double load;           /* step / limit: below 1 it is steady, from 1 on it grows */
    double omega;          /* rad/s: sqrt(stiffness / mass) of the mode; 0 where damping leaves no swing to be told */
    double damping;        /* k of the mode, 1/s: drag over mass */
    double omega_dt, k_dt; /* omega and damping times the present step */
    size_t particle;       /* the one that moves most in the mode */
    stf_force_id force;    /* the one that does most in it */
    unsigned substeps;     /* that bring the present tick to STF_STABILITY_SAFETY of the limit or below; 0: none does */
    double growth;         /* 1/s: how fast the scene itself flies apart (saddles, repelling forces): e^(growth t) at any
                              step. 0: it does not. No limit counts that, and no step helps */
    double residual;       /* of the mode's eigenvalue, as a part of it, or the error of the differences: 0.01 is 1 % */
    unsigned accelerations; /* that this call took */
} stf_stability;

/*
 * Measures the world where it stands, at its present integrator, and changes nothing. Errors: NULL, MEMORY, DESCRIPTOR
 * (half an allocator), NOT_FINITE (positions, velocities or accelerations). Cost: at most def->accelerations of the world,
 * s of them, and some 2 s^2 operations for each component of a particle: 8 ms for the demo's cloth. Memory, for the time
 * of the call: at most 8 s + 72 bytes for each component of a particle, in whole blocks (1.7 kB for one in 3D), and 150 kB.
 */
STF_API stf_result stf_stability_measure(const stf_world *world, const stf_stability_def *def, stf_stability *stability);

#ifdef __cplusplus
}
#endif

#endif
