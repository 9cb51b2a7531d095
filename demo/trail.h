/* trail: where the particles of a world have been lately, for scenes of few particles. */
#ifndef STEADFAST_DEMO_TRAIL_H
#define STEADFAST_DEMO_TRAIL_H

#include "steadfast/steadfast.h"

#define TRAIL_PARTICLES_MAX 64 /* worlds with more have none */
#define TRAIL_POINTS_MAX 512     /* of one particle */
#define TRAIL_POINTS_IN_ALL 2048 /* more cost more time to draw than they show */

/* All zero: a trail of nothing. */
typedef struct trail {
    size_t particles;
    unsigned stride; /* ticks from a point to the next */
    size_t capacity; /* points of each particle */
    size_t length;   /* points that it has so far */
    uint64_t recorded; /* points so far; the last was taken at tick (recorded - 1) * stride */
    stf_vector *points; /* [capacity][particles]: a ring */
} trail;

/* Starts with the world's present state, at its tick 0. `ticks` is how far back it is to reach. Errors: MEMORY. */
stf_result trail_open(trail *t, const stf_world *world, double ticks);
void trail_close(trail *t);

/* To be called after each tick. */
stf_result trail_record(trail *t, const stf_world *world);

/* Where `particle` was `age` points before the last one; age < t->length. */
stf_vector trail_point(const trail *t, size_t particle, size_t age);

#endif
