/* storage: the arrays of a world. */
#ifndef STEADFAST_SRC_STORAGE_H
#define STEADFAST_SRC_STORAGE_H

#include "../real.h"
#include "steadfast/world.h"

#ifdef STF_DOUBLE
#define stf_storage_require stf_storage_require_f64
#define stf_storage_open_block stf_storage_open_block_f64
#define stf_storage_kept stf_storage_kept_f64
#define stf_storage_copy_rows stf_storage_copy_rows_f64
#define stf_world_kept stf_world_kept_f64
#define stf_storage_changing stf_storage_changing_f64
#endif

/* All arrays of a world, in one piece of memory. Blocks that hold particles have position, velocity and
   inverse mass 0 in the lanes that hold none; blocks behind them are not written before they are opened. */
typedef struct stf_storage {
    void *memory;
    size_t bytes;
    size_t taken;    /* arrays that have got their place */
    size_t capacity; /* particles: a whole number of blocks */
    size_t stride;   /* particles a block, a power of two */
    unsigned shift;  /* stride == 1 << shift */
    bool whole;      /* work arrays are as large as the world, else as one block for each part of a step */
    bool guarded;    /* has room for a checkpoint */
    int history_arrays, work_arrays;
    stf_real *position, *velocity, *previous;         /* [capacity * dimensions], in blocks; previous NULL if not kept */
    stf_real *position_rest, *velocity_rest;          /* as position; NULL in worlds that do not compensate */
    stf_real *inverse_mass, *radius;                  /* [capacity]; radius NULL if not kept */
    stf_real *history[STF_HISTORY_ARRAYS_MAX];        /* as position */
    stf_real *work[STF_WORK_ARRAYS_MAX];
    stf_real *checkpoint;                             /* as stf_storage_changing, one array after the other */
} stf_storage;

/*
 * Has storage with at least this room, for this integrator's arrays, and with `whole` work arrays, or as much of each as there
 * was before; moves the particles and their history there. STF_ERROR_MEMORY leaves all as it was.
 */
stf_result stf_storage_require(stf_world *world, size_t capacity, const stf_integrator *integrator, bool whole);

/* Sets a block to 0 that gets its first particle: memory that is never used is never touched. */
void stf_storage_open_block(const stf_world *world, size_t block);

/* An array that outlasts a step, and what its reals have to be. */
typedef struct stf_kept {
    stf_real *array;
    size_t rows; /* components a particle */
    enum { STF_KEPT_FINITE, STF_KEPT_INVERSE_MASS, STF_KEPT_RADIUS, STF_KEPT_ANYTHING } rule;
} stf_kept;

#define STF_KEPT_MAX (7 + STF_HISTORY_ARRAYS_MAX)

/* All of them, the history last, in an order that depends on nothing; returns how many. */
size_t stf_storage_kept(const stf_storage *storage, size_t dimensions, stf_kept kept[STF_KEPT_MAX]);

/* Likewise, without history that the world's integrator does not have. */
size_t stf_world_kept(const stf_world *world, stf_kept kept[STF_KEPT_MAX]);

/* Where component d of particle i stands. */
static inline stf_real *stf_kept_at(const stf_storage *storage, const stf_kept *kept, size_t i, size_t d)
{
    const size_t block = i >> storage->shift, lane = i & (storage->stride - 1);

    return kept->array + (block * kept->rows + d) * storage->stride + lane;
}

/* Copies an array of `rows` components a particle. Strides differ only while there is one block, here and there. */
void stf_storage_copy_rows(void *to, size_t to_stride, const void *from, size_t from_stride, size_t rows, size_t count);

#define STF_CHANGING_MAX (4 + STF_HISTORY_ARRAYS_MAX)

/* What the steps after this one start from and a step changes: vectors, in an order that depends on nothing; how many. */
size_t stf_storage_changing(const stf_storage *storage, stf_real *arrays[STF_CHANGING_MAX]);

#endif
