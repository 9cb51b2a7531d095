/*
 * world: owns the particles, joins forces and integrator, runs steps.
 *
 * Every function that takes a world refuses NULL with STF_ERROR_NULL (getters of a plain value return 0 or NULL). A world
 * is changed by one thread at a time, and read (functions that take it const) by any number; two worlds share nothing.
 * Calling these functions from inside a force or an integrator is not allowed.
 */
#ifndef STEADFAST_WORLD_H
#define STEADFAST_WORLD_H

#include "steadfast/force.h"
#include "steadfast/integrator.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct stf_world stf_world;

/* What watches over the state: see stf_world_fault. All zero: nothing does. */
typedef enum stf_guard_mode {
    STF_GUARD_OFF,
    STF_GUARD_REPORT, /* says so, and changes no bit */
    STF_GUARD_FREEZE  /* takes the world back to the last tick that was good, and lets it go no further */
} stf_guard_mode;

typedef struct stf_guard {
    stf_guard_mode mode;
    unsigned interval;     /* ticks from a look at every particle to the next; 0: 16 where a link force acts, else 512 */
    double position_bound; /* m, for the magnitude of each component; 0: all that is finite */
    double velocity_bound; /* m/s, likewise */
} stf_guard;

/* The most substeps of a tick: more than any scene can use, and few enough that a wrong number is not hours. */
#define STF_SUBSTEPS_MAX 1000000

/* What to create. All zero is a valid def: `stf_world_def def = {0};`, then set what you need. */
typedef struct stf_world_def {
    unsigned dimensions;              /* 1, 2 or 3; 0: 3 */
    const stf_integrator *integrator; /* NULL: &stf_semi_implicit_euler */
    double step;                      /* s a tick; 0: 1/60 */
    unsigned substeps;                /* steps of the integrator a tick, to STF_SUBSTEPS_MAX; 0: 1 */
    stf_vector gravity;               /* m/s^2 */
    size_t capacity;                  /* particles to make room for; a world grows when it must, but never in a step */
    bool keep_previous;               /* keep the positions of the tick before, for blending; costs a vector a particle */
    bool keep_radius;                 /* keep radii; costs a real a particle */
    bool compensated;                 /* keep what rounding leaves of positions and velocities, and add it in the next step: in
                                         float for long runs and places far from the origin. What is read out is the rounded
                                         state. Costs two vectors a particle, and their way through memory */
    stf_guard guard;                  /* all zero: none; else some 10 ns a step, some 3% and a copy of the state */
    stf_allocator allocator;          /* all zero: malloc and free */
    stf_parallel parallel;            /* all zero: no threads; else your own forces and integrators are called from several */
} stf_world_def;

/* Makes a world in *world. Errors: NULL, MEMORY, DIMENSIONS, STEP, SUBSTEPS, NOT_FINITE (gravity), DESCRIPTOR (integrator, also
   one without STF_COMPENSATES in a world that is compensated; half an allocator; tasks without run), PARAMETERS (guard). */
STF_API stf_result stf_world_create(const stf_world_def *def, stf_world **world);

/* Frees a world. NULL is fine. */
STF_API void stf_world_destroy(stf_world *world);

/* ---- particles: indices run from 0 to count - 1 ------------------------------------------------------------------------ */

STF_API size_t stf_world_count(const stf_world *world);

/* Makes room for `capacity` particles in all. Errors: MEMORY. Cost: copies all particles if it has to grow. */
STF_API stf_result stf_world_reserve(stf_world *world, size_t capacity);

/*
 * Adds one particle; its index goes to *index unless that is NULL. Errors: NOT_FINITE, DIMENSIONS, MASS, RADIUS, MEMORY.
 * Cost: a world that is full moves to twice the room. Whatever changes a world costs velocity Verlet one acceleration more in
 * the next step, since the one that it kept is of the world before.
 */
STF_API stf_result stf_world_add(stf_world *world, const stf_particle *particle, size_t *index);

/* Adds particles[count]: all, or none. Their indices run from *first (unless NULL). Errors and cost as stf_world_add. */
STF_API stf_result stf_world_add_many(stf_world *world, const stf_particle *particles, size_t count, size_t *first);

/* Copies a particle out. Its radius is 0 where the world keeps none. Errors: PARTICLE. */
STF_API stf_result stf_world_get(const stf_world *world, size_t index, stf_particle *particle);

/*
 * Replaces a particle. A new position is a teleport: the previous one is set as well, and nothing is blended. The
 * integrator starts afresh from this state; for position Verlet that is a step of first order, and a particle on a spring
 * that is set at every tick gains energy. To drive a particle, make it immovable (inverse mass 0) and set its velocity: it
 * is blended, and moves by velocity x step a tick. Errors: PARTICLE, and as stf_world_add.
 */
STF_API stf_result stf_world_set(stf_world *world, size_t index, const stf_particle *particle);

/*
 * Removes a particle: the last one takes its index. *moved (unless NULL) gets the index that the moved particle had, which
 * is `index` itself where the removed one was the last. Records of forces are renumbered, those that name the removed
 * particle dropped. Errors: PARTICLE. Cost: a few looks at each record that names particles, to renumber and to arrange them.
 */
STF_API stf_result stf_world_remove(stf_world *world, size_t index, size_t *moved);

/* Removes all particles, and all records of forces that name particles. Keeps capacity, time, forces and settings. */
STF_API stf_result stf_world_clear(stf_world *world);

/*
 * Copies all positions out for a vertex buffer, as floats in both precisions: particle i's `dimensions` floats start at
 * byte i * stride_bytes of `positions`; stride_bytes 0 packs them. alpha in [0, 1] blends: 0 is the state one tick ago, 1 is
 * now; below 1 the world has to keep previous positions. Errors: ALPHA, NO_PREVIOUS, STRIDE. Cost: one pass.
 */
STF_API stf_result stf_world_copy_positions(const stf_world *world, double alpha, void *positions, size_t stride_bytes);

/* ---- forces ------------------------------------------------------------------------------------------------------------ */

/* Names a force of a world; never 0, never used again. */
typedef uint32_t stf_force_id;

/*
 * Adds a force with a copy of its records[record_count]. The descriptor has to outlive the world. A force without
 * parameters takes NULL and 0; so does one whose records are still to come. The id goes to *id unless that is NULL. Errors:
 * DESCRIPTOR, PARAMETERS, PARTICLE (a record names one that is not there), DIMENSIONS, NOT_FINITE, MEMORY (also where all ids
 * have been used). Cost: an allocation; for the first link force also the integrator's work arrays for all particles.
 */
STF_API stf_result stf_world_add_force(stf_world *world, const stf_force *force, const void *records,
                                       size_t record_count, stf_force_id *id);

/*
 * Replaces the records of a force. Errors: FORCE, and as stf_world_add_force. Cost: a copy; a sort where the force keeps them
 * in order (one pass, if they come in the order that stf_world_force_records shows); an allocation only where there are more
 * than ever before; velocity Verlet's acceleration. Position Verlet takes the change to have come half a step ago, so
 * that records may change at every tick. A force that is known beforehand had better compute its change from `time` in
 * apply.
 */
STF_API stf_result stf_world_set_force(stf_world *world, stf_force_id id, const void *records, size_t record_count);

/* The world's records of a force, to read; *record_count gets their number. NULL if there are none or no such force. They
   may stand in another order than they were given in, and stay valid until force or particles change. */
STF_API const void *stf_world_force_records(const stf_world *world, stf_force_id id, size_t *record_count);

/* Errors: FORCE. */
STF_API stf_result stf_world_remove_force(stf_world *world, stf_force_id id);

/* The id of the n-th force, in the order they were added, and 0 past the last. */
STF_API stf_force_id stf_world_force_at(const stf_world *world, size_t n);

/* The descriptor of a force; NULL if there is no such force. */
STF_API const stf_force *stf_world_force(const stf_world *world, stf_force_id id);

/* a = g for all but the immovable, in m/s^2 (Galilei's law). As to integrators, like stf_world_set_force. Errors: NOT_FINITE,
   DIMENSIONS. */
STF_API stf_result stf_world_set_gravity(stf_world *world, stf_vector gravity);
STF_API stf_vector stf_world_gravity(const stf_world *world);

/* ---- time -------------------------------------------------------------------------------------------------------------- */

/*
 * Runs `ticks` ticks: each is `substeps` steps of the integrator of step / substeps seconds. Allocates nothing and calls no
 * libm function but sqrt (with a guard, on some machines, those of <fenv.h>). Errors: DIVERGED, which only a guard finds;
 * without one, particles that end up non-finite are not looked for. At every tick whose number is a multiple of
 * STF_SETTLE_TICKS, what is smaller than STF_AT_REST becomes 0 (see particle.h). Many ticks in one call cost less than many
 * calls where no link force is: each block stays in cache for all of them.
 */
STF_API stf_result stf_world_step(stf_world *world, unsigned ticks);

STF_API uint64_t stf_world_ticks(const stf_world *world);

/* Simulated seconds: ticks x step, counted from the last change of the step, never a sum of steps. */
STF_API double stf_world_time(const stf_world *world);

/* s a tick. Errors: STEP. Cost, for this and the next two: the history of the integrator starts afresh, one pass over it. */
STF_API stf_result stf_world_set_step(stf_world *world, double step);
STF_API double stf_world_step_size(const stf_world *world);

/* Errors: SUBSTEPS, STEP. */
STF_API stf_result stf_world_set_substeps(stf_world *world, unsigned substeps);
STF_API unsigned stf_world_substeps(const stf_world *world);

/* Errors: NULL, DESCRIPTOR (as stf_world_create), MEMORY. Cost: a copy of the world if this integrator needs more arrays than
   any before. */
STF_API stf_result stf_world_set_integrator(stf_world *world, const stf_integrator *integrator);
STF_API const stf_integrator *stf_world_integrator(const stf_world *world);

/* ---- divergence -------------------------------------------------------------------------------------------------------- */

/*
 * With a guard (stf_world_def.guard) stf_world_step tells which particle left the finite, or your bounds, and after which tick:
 *
 *     if (stf_world_step(world, ticks) == STF_ERROR_DIVERGED && stf_world_fault(world, &fault)) {
 *         ...log fault.particle, fault.tick
 *         stf_world_remove(world, fault.particle, NULL);     // or set it to rest, or shorten the step
 *         stf_world_clear_fault(world);                      // the next step goes on from there
 *     }
 *
 * STF_GUARD_REPORT: the world has gone through all ticks, with the bits that it has without a guard. The step that finds the
 * fault returns the error, once; until you clear it the guard rests. STF_GUARD_FREEZE: the world is what it was after the last
 * good tick, fault.tick - 1, and stf_world_ticks and stf_world_time say so. Until you clear the fault, steps change nothing
 * and return the error. Previous positions are the positions, so that a frozen world stands still whatever alpha is. All other
 * functions work as ever.
 *
 * When: a number that overflows, or a 0 / 0, is found in the step that made it, as the processor marks it. What no arithmetic
 * of the step made (a NaN that your force read somewhere) and your bounds are found at a look at every particle, at each tick
 * that the interval divides: a frozen world has then gone back by less than an interval, though never behind your last change
 * of it. A particle that leaves a bound and is back before the look goes unseen. With interval 1 all is found at once, at the
 * cost of a look a tick. Where the processor keeps no flags the interval is 1.
 *
 * The tick is exact: from the last look the ticks are run again one by one, with the calls of your own forces and integrators.
 * Those have to be functions of what they are given; if they are not, the tick is at most that at which the fault was seen. So
 * it is for what a look finds in a world that only reports and was changed since the look before. A state that was bad to
 * begin with (a particle set outside of a bound) has the tick from which the step started.
 *
 * Cost: some 10 ns a step, and from 10,000 particles on at most 3%. A look checks and copies position, velocity and history,
 * which takes as long as two steps of an Euler method in flight. A world that may freeze and is changed before a step has one
 * made each time, since it never goes back behind a change (an Euler method in flight then takes three times as long); one
 * that reports has not. Memory: that copy, 24 bytes a particle in float, 3D, and the history. A fault costs up to twice as
 * many ticks as there were since the last look. The floating-point flags of your threads are left as the step alone would
 * leave them.
 */
typedef enum stf_fault_kind {
    STF_FAULT_NONE,
    STF_FAULT_VELOCITY_NOT_FINITE, /* of several at once, the first of these */
    STF_FAULT_POSITION_NOT_FINITE,
    STF_FAULT_VELOCITY_BOUND,
    STF_FAULT_POSITION_BOUND
} stf_fault_kind;

typedef struct stf_fault {
    size_t particle; /* the lowest that was bad after this tick */
    uint64_t tick;   /* the first after which any was: what stf_world_ticks was then */
    stf_fault_kind kind;
} stf_fault;

/* Whether the guard has found a fault that was not cleared; *fault (unless NULL) gets it. */
STF_API bool stf_world_fault(const stf_world *world, stf_fault *fault);

/* The guard watches again, from this state on. */
STF_API stf_result stf_world_clear_fault(stf_world *world);

/* Also clears the fault. Errors: PARAMETERS (no such mode; a bound that is negative or not finite), MEMORY. Cost: a copy of the
   world where it had no guard before. */
STF_API stf_result stf_world_set_guard(stf_world *world, stf_guard guard);

/* As it was given; its interval may have become 1. */
STF_API stf_guard stf_world_guard(const stf_world *world);

/* ---- what can be asked ------------------------------------------------------------------------------------------------- */

STF_API unsigned stf_world_dimensions(const stf_world *world);

/*
 * The instruction set that this world's loops were compiled for: "avx512", "avx2" or "baseline", the widest that the machine
 * has, or what the environment variable STEADFAST_ISA named when the world was made, if the machine has that. All give the same
 * bits. A copy of a descriptor of the library is your own, and runs the baseline's loops.
 */
STF_API const char *stf_world_isa(const stf_world *world);

typedef struct stf_energy {
    double kinetic;   /* J: sum of m v^2 / 2 */
    double potential; /* J: uniform gravity (-m g . x) and every force that has a potential */
} stf_energy;

/*
 * Immovable particles have no finite mass and are left out. Summed in double, in the order of indices. Cost: one pass, and
 * one a potential; all-pairs gravity's takes n (n - 1) / 2 pairs.
 */
STF_API stf_result stf_world_energy(const stf_world *world, stf_energy *energy);

/* momentum[3] in kg m/s, summed as above. */
STF_API stf_result stf_world_momentum(const stf_world *world, double momentum[STF_DIMENSIONS_MAX]);

/*
 * The particles where they stand, to read: positions, velocities and inverse masses of the whole world in its blocks, no copy;
 * force is NULL. Valid until the next call that takes the world not const. All zero for NULL.
 */
STF_API stf_particles stf_world_view(const stf_world *world);

/*
 * acceleration = a(time, position, velocity) in m/s^2, gravity and every force of this world as it stands, for any state that
 * is asked about; the world is not changed. The three arrays do not overlap, are laid out as those of stf_world_view and as
 * long, lanes behind the last particle included (finite numbers, best 0): stride x dimensions reals a block; aligned to 64
 * bytes if a force of your own relies on that. Errors: NULL, NOT_FINITE (time). Cost: one call of every force; no
 * allocation.
 */
STF_API stf_result stf_world_accelerations(const stf_world *world, double time, const stf_real *position,
                                           const stf_real *velocity, stf_real *acceleration);

/*
 * Whether any position or velocity is a NaN or an infinity; if so the lowest such particle goes to *index unless that is
 * NULL.
 */
STF_API bool stf_world_find_non_finite(const stf_world *world, size_t *index);

/*
 * Writes what the world models and what each of it costs (passes a step of the integrator, bytes a particle) into
 * text[size] as lines of aligned plain text, cut off if it is too long, always terminated. Returns the length of the whole
 * text, as snprintf does; text may be NULL if size is 0. 4,096 bytes hold some twenty forces.
 */
STF_API size_t stf_world_describe(const stf_world *world, char *text, size_t size);

#ifdef __cplusplus
}
#endif

#endif
