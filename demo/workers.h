/* workers: SDL threads for the library's parallel-for hook; an engine puts its own job system here. */
#ifndef STEADFAST_DEMO_WORKERS_H
#define STEADFAST_DEMO_WORKERS_H

#include "steadfast/steadfast.h"

#define WORKERS_MAX 64

typedef struct workers workers;

/* Starts threads - 1 threads, as the one that calls works too; 1 to WORKERS_MAX. NULL: SDL_GetError says why. */
workers *workers_start(unsigned threads);

/* Ends and frees them. NULL is fine. */
void workers_stop(workers *w);

/* For stf_world_def.parallel; NULL: no threads. */
stf_parallel workers_parallel(workers *w);

#endif
