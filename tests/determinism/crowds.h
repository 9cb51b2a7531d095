/* Scenes of many blocks: those of the demo have one block, the cloth a few, and threads and orders of blocks are to matter. */
#ifndef STEADFAST_TESTS_DETERMINISM_CROWDS_H
#define STEADFAST_TESTS_DETERMINISM_CROWDS_H

#include "scenes/scene.h"

#ifdef STF_DOUBLE
#define crowds crowds_f64
#define crowd_is_compensated crowd_is_compensated_f64
#endif

/* They are stepped this part of the ticks of the demo's scenes. */
#define CROWD_SHARE 100

/* NULL-terminated. */
extern const scene *const crowds[];

/* Whether its world keeps rests. */
bool crowd_is_compensated(const scene *crowd);

#endif
