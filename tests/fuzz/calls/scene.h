/* A small scene out of bytes, built in both precisions: this header may be included in either. */
#ifndef STEADFAST_TESTS_FUZZ_SCENE_H
#define STEADFAST_TESTS_FUZZ_SCENE_H

#include "../fuzz.h"

#ifdef STF_DOUBLE
#define scene_build scene_build_f64
#endif

#define SCENE_BYTES 24
#define SCENE_PARTICLES_MAX 3

/* What `user` points at. */
typedef struct scene {
    program program; /* a copy of it is read, so that the scene is the same each time */
    unsigned more_particles, more_dimensions;
    ration *ration; /* of the worlds */
    stf_result result; /* of the last build, and what it made */
    unsigned particles;
    bool is_compensated;
} scene;

#ifndef STF_DOUBLE
stf_result scene_build(void *user, stf_world **world);
#endif

/* The same in double, in whatever precision this is included. */
stf_result scene_build_f64(void *user, struct stf_world_f64 **world);

#endif
