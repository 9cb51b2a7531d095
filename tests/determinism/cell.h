/*
 * A cell of the table: one scene under one integrator in one precision, stepped and hashed. Holds no reals; cell.c is compiled
 * for both precisions.
 */
#ifndef STEADFAST_TESTS_DETERMINISM_CELL_H
#define STEADFAST_TESTS_DETERMINISM_CELL_H

#include "steadfast/base.h"

typedef struct cell {
    const char *scene_name, *integrator_name, *precision;
    unsigned ticks;  /* asked for */
    unsigned finite; /* after so many of them the state was still finite */
    uint64_t hash;   /* of that state, as stf_world_save writes it: all that a world keeps, whatever the machine's order of bytes */
} cell;

/* How to run all cells. */
typedef struct cell_run {
    unsigned ticks; /* of the demo's scenes; of those of many blocks a part, see crowds.h */
    stf_parallel parallel;
    const char *write; /* a directory to save each world in after a tenth of its ticks; NULL: none */
    const char *read;  /* a directory of such saves to go on from; NULL: start at the start */
} cell_run;

/* The demo's scenes and those of crowds.h. */
size_t cell_scenes(void);

/* Runs the cell of this scene and integrator. What the library refuses ends the program. */
cell cell_run_f32(const cell_run *run, size_t scene, size_t integrator);
cell cell_run_f64(const cell_run *run, size_t scene, size_t integrator);

/* The instruction set that worlds get. */
const char *cell_isa(void);

/* One line to stderr, and the end. */
void fail(const char *what, const char *of);

#endif
