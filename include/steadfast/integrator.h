/*
 * integrator: how time passes.
 *
 * An integrator advances x'' = a(t, x, v) by one step. It sees flat arrays and a function that gives the acceleration at
 * any time, position and velocity; it knows no particles, forces or worlds. It is a const descriptor: point
 * stf_world_def.integrator at one below or at your own.
 *
 *     static void step(stf_system *system, stf_real dt)           // semi-implicit Euler
 *     {
 *         stf_real *x = system->position, *v = system->velocity, *a = system->work[0];
 *         system->accelerate(system, system->time, x, v, a);
 *         for (size_t i = 0; i < system->length; i++) {
 *             v[i] += a[i] * dt;
 *             x[i] += v[i] * dt;
 *         }
 *     }
 *     const stf_integrator mine = {.name = "mine", .step = step, .order = 1, .evaluations = 1, .work_arrays = 1};
 *
 * Which one when, with measured figures: see the README.
 */
#ifndef STEADFAST_INTEGRATOR_H
#define STEADFAST_INTEGRATOR_H

#include "steadfast/base.h"

#ifdef __cplusplus
extern "C" {
#endif

#define STF_WORK_ARRAYS_MAX 8
#define STF_HISTORY_ARRAYS_MAX 4

typedef struct stf_system stf_system;

/*
 * What a step advances. All arrays have `length` reals and do not overlap. Some elements belong to no particle: they start as
 * 0 and their acceleration is always 0, so that they stay 0 under a step that treats all elements alike. A step changes what
 * the pointers point at, never the pointers.
 */
struct stf_system {
    size_t length;      /* reals in each array */
    double time;        /* s, when the step starts */
    stf_real *position; /* m */
    stf_real *velocity; /* m/s */
    stf_real *position_rest, *velocity_rest; /* NULL, or in a world that compensates what rounding left: see STF_COMPENSATES */
    stf_real *work[STF_WORK_ARRAYS_MAX];       /* scratch: as many as the descriptor says; undefined when a step starts */
    stf_real *history[STF_HISTORY_ARRAYS_MAX]; /* as many as the descriptor says; kept from step to step, and per particle */
    bool history_stale; /* something came between the step before and this one. The history of a particle that was added or set
                           is NaN; every particle's is where a force was added or removed or the integrator, the step or the
                           substeps changed. Else only records, gravity or other particles did: kept accelerations are old */

    /*
     * acceleration[i] = a(time, position, velocity)[i] in m/s^2, for all `length` elements. `system` is the one that the
     * step was given, never a copy. position and velocity may be its own or work arrays; acceleration is another array.
     * Costs one call of every force.
     */
    void (*accelerate)(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                       stf_real *acceleration);

    void (*each)(stf_system *system, void (*loop)(stf_system *part, stf_real dt), stf_real dt); /* see stf_system_each */
};

/*
 * Calls loop(part, dt) for systems that together are this one, each with its part of every array: on several threads where the
 * world has them and steps as a whole, else once, with this one (also where `each` is NULL). For loops that take each element
 * by itself; a step may as well loop over all of its arrays, on one thread. A loop does not call accelerate.
 */
static inline void stf_system_each(stf_system *system, void (*loop)(stf_system *part, stf_real dt), stf_real dt)
{
    if (system->each)
        system->each(system, loop, dt);
    else
        loop(system, dt);
}

/*
 * Blocks of particles in free flight, where nothing acts but gravity and linear drag: a = gravity - (drag inverse_mass) v in
 * that order of operations, and 0 for the immovable. Most particles of most games fly so; an integrator that writes this into
 * its loop keeps all of a step in registers.
 */
typedef struct stf_flight {
    size_t blocks, stride;        /* blocks of rows of `stride` reals, a multiple of 16 */
    unsigned dimensions;          /* rows a block: position[(block * dimensions + d) * stride + i] */
    stf_real *position;           /* m */
    stf_real *velocity;           /* m/s */
    stf_real *position_rest, *velocity_rest; /* as in stf_system */
    const stf_real *inverse_mass; /* 1/kg, [block * stride + i] */
    stf_real *history[STF_HISTORY_ARRAYS_MAX]; /* as in stf_system; NULL beyond those that the world has */
    bool history_stale;                        /* as in stf_system */
    stf_real gravity[STF_DIMENSIONS_MAX];      /* m/s^2 */
    stf_real drag;                             /* k of F = -k v, kg/s */
} stf_flight;

enum {
    STF_SYMPLECTIC = 1 << 0, /* for forces of position alone: energy errors stay bounded */
    STF_REVERSIBLE = 1 << 1, /* for forces of position alone: turn all velocities round and it runs back, but for round-off */
    /*
     * May step a world that compensates: where the system has rests, x += d is y = d + rest, s = x + y, rest = y - (s - x),
     * x = s (W. Kahan, Comm. ACM 8, 40 (1965)), and v likewise. A particle that was added or set has rests of 0; where the
     * integrator is changed that of velocity becomes 0, since it may be that of another sum which stands for the velocity.
     */
    STF_COMPENSATES = 1 << 2
};

/* name and step are required, and the arrays that step uses; step_flight makes it faster; the rest is for people and
   instruments (flags also for creation), and no step reads it. */
typedef struct stf_integrator {
    const char *name; /* "rk4" */
    void (*step)(stf_system *system, stf_real dt); /* dt in s */
    void (*step_flight)(const stf_flight *flight, stf_real dt); /* NULL, or what step does, in one pass and with the same bits:
                                                                   compile it without contraction (-ffp-contract=off) */
    int order;                  /* of the global error, of positions and velocities, for forces of t, x and v */
    int evaluations;            /* calls of accelerate a step, once the history is built */
    int work_arrays;            /* 0 to STF_WORK_ARRAYS_MAX */
    int history_arrays;         /* 0 to STF_HISTORY_ARRAYS_MAX */
    double real_stability;      /* the k dt (k: linear drag over mass) below which nothing grows */
    double imaginary_stability; /* the omega dt of an undamped spring below which nothing grows; 0: every step grows */
    unsigned flags;             /* STF_SYMPLECTIC | STF_REVERSIBLE | STF_COMPENSATES */
} stf_integrator;

/* Orders, evaluations and stability limits of each are in its descriptor; its formula and source are in src/integrators/. */
STF_API extern const stf_integrator stf_explicit_euler;
STF_API extern const stf_integrator stf_semi_implicit_euler;
STF_API extern const stf_integrator stf_midpoint;       /* RK2 */
STF_API extern const stf_integrator stf_improved_euler; /* Heun */
STF_API extern const stf_integrator stf_rk4;
STF_API extern const stf_integrator stf_position_verlet; /* Störmer */
STF_API extern const stf_integrator stf_velocity_verlet;

/* All of the above, in this order, NULL-terminated: for tests, tools and menus. */
STF_API extern const stf_integrator *const stf_integrators[];

/* The one of stf_integrators with this name, or NULL. */
STF_API const stf_integrator *stf_integrator_find(const char *name);

#ifdef __cplusplus
}
#endif

#endif
