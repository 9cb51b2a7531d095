/* What the files of the world share. */
#ifndef STEADFAST_SRC_WORLD_H
#define STEADFAST_SRC_WORLD_H

#include "../allocator.h"
#include "../real.h"
#include "steadfast/world.h"

/* Names of these functions for the second precision; the public ones are in precision.h. */
#ifdef STF_DOUBLE
#define stf_storage_require stf_storage_require_f64
#define stf_world_clear_history stf_world_clear_history_f64
#define stf_world_forget_history stf_world_forget_history_f64
#define stf_storage_release stf_storage_release_f64
#define stf_world_particles stf_world_particles_f64
#define stf_world_renumber_forces stf_world_renumber_forces_f64
#define stf_world_drop_particle_records stf_world_drop_particle_records_f64
#define stf_world_release_forces stf_world_release_forces_f64
#endif

/* All arrays of a world, in one piece of memory. Lanes that hold no particle have position, velocity and inverse mass 0. */
typedef struct stf_storage {
    void *memory;
    size_t bytes;
    size_t capacity; /* particles: a whole number of blocks */
    size_t stride;   /* particles a block, a power of two */
    unsigned shift;  /* stride == 1 << shift */
    bool whole;      /* work arrays are as large as the world, else as one block */
    int history_arrays, work_arrays;
    stf_real *position, *velocity, *previous;         /* [capacity * dimensions], in blocks; previous NULL if not kept */
    stf_real *inverse_mass, *radius;                  /* [capacity]; radius NULL if not kept */
    stf_real *history[STF_HISTORY_ARRAYS_MAX];        /* as position */
    stf_real *work[STF_WORK_ARRAYS_MAX];
} stf_storage;

/* A force of a world. */
typedef struct stf_added_force {
    const stf_force *force;
    stf_force_id id;
    void *records;
    size_t record_count;
    size_t bytes; /* allocated for records */
} stf_added_force;

struct stf_world {
    stf_allocator allocator;
    const stf_integrator *integrator;
    unsigned dimensions, substeps;
    bool keep_previous, keep_radius;
    double step; /* s */
    uint64_t ticks, step_start_tick;
    double step_start_time; /* s, at step_start_tick */
    stf_real gravity[STF_DIMENSIONS_MAX]; /* m/s^2 */

    size_t count;
    stf_storage storage;
    bool history_stale;

    stf_added_force *forces;
    size_t force_count, force_capacity;
    stf_force_id last_force_id;
};

/*
 * Has storage with at least this room, for this integrator's arrays, and with `whole` work arrays, or as much of each as there
 * was before; moves the particles and their history there. STF_ERROR_MEMORY leaves all as it was.
 */
stf_result stf_storage_require(stf_world *world, size_t capacity, const stf_integrator *integrator, bool whole);
void stf_storage_release(stf_world *world);

static inline size_t stf_world_blocks(const stf_world *world)
{
    return (world->count + world->storage.stride - 1) >> world->storage.shift;
}

/* Reals of a block in an array of vectors. */
static inline size_t stf_world_block_length(const stf_world *world) { return world->storage.stride * world->dimensions; }

/* Sets all history to 0, that of no particle too: another integrator may have left there what it liked. */
void stf_world_clear_history(stf_world *world);

/* Marks the history of `count` particles from `first` as none: NaN in every component. */
void stf_world_forget_history(stf_world *world, size_t first, size_t count);

/* Where the first component of particle i stands in an array of vectors. */
static inline size_t stf_world_offset(const stf_world *world, size_t i)
{
    return (i >> world->storage.shift) * stf_world_block_length(world) + (i & (world->storage.stride - 1));
}

/* What a force sees of the blocks from first_block, their state in arrays that start with that block. */
stf_particles stf_world_particles(const stf_world *world, size_t first_block, size_t blocks, const stf_real *position,
                                  const stf_real *velocity, stf_real *force);

/* A force whose records are still to come, or all gone, is not called. */
static inline bool stf_force_acts(const stf_added_force *added)
{
    return added->force->record_size == 0 || added->record_count > 0;
}

/* Whether a link force ties particles together, so that all of them have to step at once. */
static inline bool stf_world_is_tied(const stf_world *world)
{
    for (size_t i = 0; i < world->force_count; i++)
        if (world->forces[i].force->kind == STF_LINK && stf_force_acts(&world->forces[i]))
            return true;
    return false;
}

/* Particle `removed` is gone, particle `last` has its index. */
void stf_world_renumber_forces(stf_world *world, size_t removed, size_t last);

/* All particles are gone, and with them the records that name particles. */
void stf_world_drop_particle_records(stf_world *world);

void stf_world_release_forces(stf_world *world);

#endif
