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

/* What to create. All zero is a valid def: `stf_world_def def = {0};`, then set what you need. */
typedef struct stf_world_def {
    unsigned dimensions;              /* 1, 2 or 3; 0: 3 */
    const stf_integrator *integrator; /* NULL: &stf_semi_implicit_euler */
    double step;                      /* s a tick; 0: 1/60 */
    unsigned substeps;                /* steps of the integrator a tick; 0: 1 */
    stf_vector gravity;               /* m/s^2 */
    size_t capacity;                  /* particles to make room for; a world grows when it must, but never in a step */
    bool keep_previous;               /* keep the positions of the tick before, for blending; costs a vector a particle */
    bool keep_radius;                 /* keep radii; costs a real a particle */
    stf_allocator allocator;          /* all zero: malloc and free */
    stf_parallel parallel;            /* all zero: no threads; else your own forces and integrators are called from several */
} stf_world_def;

/* Makes a world in *world. Errors: NULL, MEMORY, DIMENSIONS, STEP, NOT_FINITE (gravity), DESCRIPTOR (integrator; half an
   allocator; tasks without run). */
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
 * libm function but sqrt. Particles that end up non-finite are not looked for: see stf_world_find_non_finite.
 * Many ticks in one call cost less than many calls where no link force is: each block stays in cache for all of them.
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

/* Errors: NULL, DESCRIPTOR, MEMORY. Cost: a copy of the world if this integrator needs more arrays than any before. */
STF_API stf_result stf_world_set_integrator(stf_world *world, const stf_integrator *integrator);
STF_API const stf_integrator *stf_world_integrator(const stf_world *world);

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
 * bytes if a force of your own relies on that. Errors: NULL. Cost: one call of every force; no allocation.
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
