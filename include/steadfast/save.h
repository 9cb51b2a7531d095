/*
 * save: a world as bytes, for files and other machines, and as a plain copy, for rollback.
 *
 *     size_t size = stf_world_save_size(world);                  // to a file
 *     void *buffer = malloc(size);
 *     stf_world_save(world, buffer, size);
 *
 *     stf_world *world = create_my_world();                      // later: the same def, the same forces in the same order
 *     stf_mismatch mismatch;
 *     if (stf_world_load(world, buffer, size, &mismatch) == STF_ERROR_MISMATCH)
 *         ...mismatch says what is not the same
 *
 *     stf_world_snapshot(world, memory, size);                   // before a tick whose input is a guess
 *     stf_world_step(world, 1);
 *     stf_world_restore(world, memory, size);                    // the input has come and was another: run the tick anew
 *
 * A world that is saved and loaded, or restored, steps on with the bits that it would have had: particles, previous positions,
 * radii, rests, the integrator's history, ticks, time, step, substeps, gravity, the records and ids of forces. Code can't be
 * saved: integrator and forces are matched with those of the world that is loaded into. A guard is that world's own, and starts
 * afresh.
 */
#ifndef STEADFAST_SAVE_H
#define STEADFAST_SAVE_H

#include "steadfast/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- save and load ------------------------------------------------------------------------------------------------------- */

/* Bytes that stf_world_save needs for this world as it stands; 0 for NULL. */
STF_API size_t stf_world_save_size(const stf_world *world);

/*
 * Writes the world into buffer[size]: the first stf_world_save_size bytes of it, the same on every machine for the same world,
 * in a format with a version, the precision and a checksum (CRC-32C). Records are written as their force's `fields` say.
 * Errors: BUFFER (too small), UNSAVABLE (a force has records and no fields), NOT_FINITE (a position, velocity, previous
 * position, or the time when the step was set: it would not load). Cost: some 150 ns a particle; no allocation.
 */
STF_API stf_result stf_world_save(const stf_world *world, void *buffer, size_t size);

/* What of a world is not as it was saved. */
typedef struct stf_mismatch {
    const char *what; /* "dimensions", "keep_previous", "keep_radius", "compensated", "integrator", "history_arrays" (of the
                         integrator of that name), "force count"; of one force "name", "kind", "fields". NULL: nothing */
    size_t force;     /* which force, as stf_world_force_at counts; of others 0 */
    char saved[48];   /* the name of the saved integrator or force, cut off if it is longer; of others empty */
} stf_mismatch;

/*
 * Makes the world what was saved in buffer[size]; size is what it was saved with. The world has to have the same
 * dimensions, keep_previous, keep_radius and compensated, an integrator of the same name and the same forces: as many, in the
 * same order, each with the name, kind and fields that it had. Its particles, records, time and settings are replaced, and ids
 * of forces are those of the saved world. A force with STF_NOT_SAVED keeps the records that it has here; those have to suit the
 * saved particles. Allocator and threads stay.
 *
 * Nothing in the buffer is believed: lengths are checked against it, values as if they were given to stf_world_add and
 * stf_world_add_force. Errors: FOREIGN (no saved world), VERSION, TRUNCATED, ALTERED, PRECISION (saved by the other one),
 * MISMATCH (*mismatch says of what, unless it is NULL), MEMORY; NOT_FINITE, MASS, RADIUS, STEP, SUBSTEPS, DIMENSIONS and what
 * a force's check returns, of bytes that no world would save. Cost: some 150 ns a particle; an allocation for each force that
 * has records and one for their list, and room for the particles if there is too little.
 */
STF_API stf_result stf_world_load(stf_world *world, const void *buffer, size_t size, stf_mismatch *mismatch);

/* ---- rollback ------------------------------------------------------------------------------------------------------------ */

/* Bytes that stf_world_snapshot needs for this world as it stands; 0 for NULL. Grows with particles, records and forces. */
STF_API size_t stf_world_snapshot_size(const stf_world *world);

/*
 * Copies the world into memory[size], of any alignment, for stf_world_restore in the same process: plain bytes without a
 * checksum, not for files. Errors: BUFFER. Cost: one copy of the particles and the integrator's history (some 28 bytes a
 * particle in float, 3D), and of all records, whatever they hold; no allocation.
 */
STF_API stf_result stf_world_snapshot(const stf_world *world, void *memory, size_t size);

/*
 * Makes the world what it was at the snapshot, whatever has happened since: particles that were added are gone, those that were
 * removed are back, and so are records, integrator, settings and time. Forces that were added since are removed, and their ids
 * will be given again. Errors: SNAPSHOT (no snapshot of at most `size` bytes; a force of it was removed since; no room).
 * Cost: as stf_world_snapshot; records that have changed are arranged anew. Allocates nothing: a world's room for particles and
 * for the records of a force never shrinks, but for stf_world_load, after which there may be too little for earlier records.
 *
 * Another world takes the snapshot as well, to look ahead in a copy, if it has the same dimensions, keep_previous,
 * keep_radius and compensated, room (stf_world_reserve; records as many as there were; an integrator with as many history
 * arrays), and forces with the same ids and descriptors.
 */
STF_API stf_result stf_world_restore(stf_world *world, const void *memory, size_t size);

#ifdef __cplusplus
}
#endif

#endif
