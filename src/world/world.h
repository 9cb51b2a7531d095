/* What the files of the world share. */
#ifndef STEADFAST_SRC_WORLD_H
#define STEADFAST_SRC_WORLD_H

#include "../allocator.h"
#include "../kernels.h"
#include "storage.h"

/* Names of these functions for the second precision; the public ones are in precision.h. */
#ifdef STF_DOUBLE
#define stf_world_renew_history stf_world_renew_history_f64
#define stf_world_forget_history stf_world_forget_history_f64
#define stf_world_is_tied stf_world_is_tied_f64
#define stf_world_is_free stf_world_is_free_f64
#define stf_flight_start stf_flight_start_f64
#define stf_range_start stf_range_start_f64
#define stf_range_next stf_range_next_f64
#define stf_world_particles stf_world_particles_f64
#define stf_world_renumber_forces stf_world_renumber_forces_f64
#define stf_world_drop_particle_records stf_world_drop_particle_records_f64
#define stf_world_release_forces stf_world_release_forces_f64
#define stf_world_check_step stf_world_check_step_f64
#define stf_world_check_gravity stf_world_check_gravity_f64
#define stf_world_put_gravity stf_world_put_gravity_f64
#define stf_force_check_records stf_force_check_records_f64
#define stf_force_arrange_records stf_force_arrange_records_f64
#define stf_force_allocate_records stf_force_allocate_records_f64
#define stf_force_has_room stf_force_has_room_f64
#define stf_force_release_records stf_force_release_records_f64
#define stf_fields_size stf_fields_size_f64
#define stf_fields_packed_size stf_fields_packed_size_f64
#define stf_fields_pack stf_fields_pack_f64
#define stf_fields_unpack stf_fields_unpack_f64
#define stf_world_advance stf_world_advance_f64
#define stf_guard_complete stf_guard_complete_f64
#define stf_guard_reset stf_guard_reset_f64
#define stf_guard_run stf_guard_run_f64
#define stf_guard_interval stf_guard_interval_f64
#define stf_guard_find_fault stf_guard_find_fault_f64
#define stf_guard_keep_checkpoint stf_guard_keep_checkpoint_f64
#define stf_guard_find_first_fault stf_guard_find_first_fault_f64
#define stf_guard_go_back stf_guard_go_back_f64
#define stf_guard_step stf_guard_step_f64
#endif

/* The last look of the guard, and the state that it found good (stf_storage.checkpoint). */
typedef struct stf_checkpoint {
    bool is_valid;
    bool history_stale; /* then */
    bool is_suspect;    /* a flag was raised since, maybe by history that will not be finite later: every tick is looked at */
    uint64_t tick, next; /* when it was, and when the next look is */
} stf_checkpoint;

/* A force of a world. */
typedef struct stf_added_force {
    const stf_force *force, *acting; /* as given, and as this machine runs it fastest */
    stf_force_id id;
    void *records;
    size_t record_count;
    size_t bytes; /* allocated for records */
} stf_added_force;

struct stf_world {
    stf_allocator allocator;
    stf_parallel parallel;
    const stf_kernels *kernels;
    const stf_integrator *integrator, *stepper; /* as given, and as this machine runs it fastest */
    unsigned dimensions, substeps;
    bool keep_previous, keep_radius, compensated;
    double step; /* s */
    uint64_t ticks, step_start_tick;
    double step_start_time; /* s, at step_start_tick */
    stf_real gravity[STF_DIMENSIONS_MAX]; /* m/s^2 */

    size_t count;
    stf_storage storage;
    bool history_stale;

    stf_guard guard;
    stf_fault fault;
    stf_checkpoint checkpoint;
    bool clears_flags; /* flags were raised once: from then on they are cleared before each step */
    bool *raised; /* in a step that is watched: gets whether a part of it raised a flag (flags.h); else NULL */

    stf_added_force *forces;
    size_t force_count, force_capacity;
    stf_force_id last_force_id;
};

static inline size_t stf_world_blocks(const stf_world *world)
{
    return (world->count + world->storage.stride - 1) >> world->storage.shift;
}

/* Reals of a block in an array of vectors. */
static inline size_t stf_world_block_length(const stf_world *world) { return world->storage.stride * world->dimensions; }

/* Marks the history of `count` particles from `first` as none: NaN in every component. */
void stf_world_forget_history(stf_world *world, size_t first, size_t count);

/*
 * Another integrator starts without history, and with 0 in lanes of no particle, where the one before may have left what it
 * liked, and in the rest of the velocity, of which that one may have made something else.
 */
void stf_world_renew_history(stf_world *world);

/* An array that a world may have or not, from some place on. */
static inline stf_real *stf_world_at(stf_real *array, size_t at) { return array ? array + at : NULL; }

/* Where the first component of particle i stands in an array of vectors. */
static inline size_t stf_world_offset(const stf_world *world, size_t i)
{
    return (i >> world->storage.shift) * stf_world_block_length(world) + (i & (world->storage.stride - 1));
}

/* How many of `count` particles from i on stand in its block. */
static inline size_t stf_world_lanes(const stf_world *world, size_t i, size_t count)
{
    const size_t lanes = world->storage.stride - (i & (world->storage.stride - 1));

    return count < lanes ? count : lanes;
}

/* What a force sees of the blocks from first_block, their state in arrays that start with that block. */
stf_particles stf_world_particles(const stf_world *world, size_t first_block, size_t blocks, const stf_real *position,
                                  const stf_real *velocity, stf_real *force);

/* A force whose records are still to come, or all gone, does not act. */
static inline bool stf_force_acts(const stf_added_force *added)
{
    return added->force->record_size == 0 || added->record_count > 0;
}

/* Whether a link force ties particles together, so that all of them have to step at once. */
bool stf_world_is_tied(const stf_world *world);

/* Whether nothing acts but gravity and linear drag. */
bool stf_world_is_free(const stf_world *world);

/* Sets gravity, drag and the shape of blocks, but no blocks. */
void stf_flight_start(stf_flight *flight, const stf_world *world);

/* What one step of the integrator advances: one block where nothing ties particles together, else all of them. */
typedef struct stf_range {
    stf_system system; /* first, so that accelerate finds the range that its system is part of */
    const stf_world *world;
    size_t first_block, blocks;
    bool is_tied;
    unsigned parts; /* of a call of accelerate or each */
    stf_flight flight; /* without blocks */
} stf_range;

/* Makes the range of these blocks, with the scratch of this part of the step; and moves it on to the blocks behind. */
void stf_range_start(stf_range *range, const stf_world *world, size_t first_block, size_t blocks, unsigned part);
void stf_range_next(stf_range *range);

#define STF_PARTS_MAX 1024

/* Into how many parts work is split that has `most` of them. */
static inline unsigned stf_world_parts(const stf_world *world, size_t most)
{
    const unsigned given = world->parallel.run ? world->parallel.tasks : 1;
    const unsigned tasks = given < STF_PARTS_MAX ? given : STF_PARTS_MAX;

    return most < 2 || tasks < 2 ? 1 : most < tasks ? (unsigned)most : tasks;
}

/* As below, on the engine's threads, and takes note of the flags that they raise. */
void stf_guard_run(const stf_world *world, unsigned parts, void (*task)(void *, unsigned), void *context);

/* Calls task(context, part) for every part, on the engine's threads if there are several. */
static inline void stf_world_run(const stf_world *world, unsigned parts, void (*task)(void *, unsigned), void *context)
{
    if (parts == 1)
        task(context, 0);
    else if (world->raised)
        stf_guard_run(world, parts, task, context);
    else
        world->parallel.run(world->parallel.user, parts, task, context);
}

/* Particle `removed` is gone, particle `last` has its index. */
void stf_world_renumber_forces(stf_world *world, size_t removed, size_t last);

/* All particles are gone, and with them the records that name particles. */
void stf_world_drop_particle_records(stf_world *world);

void stf_world_release_forces(stf_world *world);

/* Whether there may be so many substeps, and each is a number that the precision holds without loss. */
stf_result stf_world_check_step(double step, unsigned substeps);

stf_result stf_world_check_gravity(stf_vector gravity, unsigned dimensions);
void stf_world_put_gravity(stf_world *world, stf_vector gravity);

/* ---- records of a force, for what brings them from elsewhere ---- */

/* Whether they suit the force and the world with so many particles. */
stf_result stf_force_check_records(const stf_world *world, const stf_force *force, const void *records, size_t record_count,
                                   size_t particle_count);

/* Gives `added` memory of its own for so many records, unset; what it had before is not released. */
stf_result stf_force_allocate_records(const stf_world *world, stf_added_force *added, size_t record_count);

/* Whether so many go into the memory that it has: never less than it ever had. */
bool stf_force_has_room(const stf_added_force *added, size_t record_count);

/* Its first record_count records, which have been checked, become its records, in the order that the force wants. */
void stf_force_arrange_records(stf_added_force *added, size_t record_count);
void stf_force_release_records(const stf_world *world, stf_added_force *added);

/* Bytes of a struct of these fields (stf_force.fields), 0 if there are none such; and of its numbers alone. */
size_t stf_fields_size(const char *fields);
size_t stf_fields_packed_size(const char *fields);

/* A record as its numbers without pads, low bytes first; and back. Pads are left as they are. */
void stf_fields_pack(const char *fields, const void *record, unsigned char *packed);
void stf_fields_unpack(const char *fields, const unsigned char *packed, void *record);

/* Where the checkpoint has the k-th of stf_storage_changing. */
static inline stf_real *stf_storage_checkpoint(const stf_world *world, size_t k)
{
    return world->storage.checkpoint + k * world->storage.capacity * world->dimensions;
}

/* Runs ticks, and nobody looks. */
void stf_world_advance(stf_world *world, unsigned ticks);

/* ---- the guard, for what makes and steps a world ---- */

/* Fills in what was left to the library. Errors: PARAMETERS. */
stf_result stf_guard_complete(stf_guard *guard);

/* Ticks from look to look. */
unsigned stf_guard_interval(const stf_world *world);

/* No fault, and no checkpoint: something else than a step has changed the world. */
void stf_guard_reset(stf_world *world);

stf_result stf_guard_step(stf_world *world, unsigned ticks);

/* Whether a particle is bad as the world stands, and which; not bounded: whether any is not finite, and then which is bad. */
bool stf_guard_find_fault(const stf_world *world, bool is_bounded, stf_fault *fault);

/* The state as it stands is good, and what is gone back to. */
void stf_guard_keep_checkpoint(stf_world *world);

/* From a fault that is there to the first since the checkpoint: leaves the world as it is, or takes it to the tick before. */
void stf_guard_find_first_fault(stf_world *world, stf_fault *fault);
void stf_guard_go_back(stf_world *world, stf_fault *fault);

#endif
