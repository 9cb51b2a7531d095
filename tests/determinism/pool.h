/* Ways to run the parts of a step, for stf_world_def.parallel. */
#ifndef STEADFAST_TESTS_DETERMINISM_POOL_H
#define STEADFAST_TESTS_DETERMINISM_POOL_H

#include "steadfast/base.h"

/* So many threads, the caller's among them, take the parts as they come. Only once in a program. */
stf_parallel pool_threads(unsigned threads);

/* One thread, and as many parts as a step may have, in another order at each call. */
stf_parallel pool_shuffled(void);

#endif
