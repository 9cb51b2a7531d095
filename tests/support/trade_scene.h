/* Scenes for the tests of trade, built in both precisions: this header may be included in either. */
#ifndef STEADFAST_TESTS_TRADE_SCENE_H
#define STEADFAST_TESTS_TRADE_SCENE_H

#include "steadfast/steadfast.h"

#ifdef STF_DOUBLE
#define trade_scene_build trade_scene_build_f64
#endif

/* What there is, and what `user` points at. */
typedef enum trade_scene {
    TRADE_PENDULUM,     /* a mass on a stiff anchored spring in gravity, pushed by cos(3 t) N along x: swings and stretches */
    TRADE_BINARY,       /* two masses in an orbit of eccentricity 0.3, 2 pi s long, and a light third one far away */
    TRADE_FALL,         /* quadratic drag and gravity: a known path along y, an immovable particle, and a potential of t J */
    TRADE_CHAOS,        /* three equal masses that meet closely */
    TRADE_REST,         /* nothing moves */
    TRADE_CROWD,        /* 600 particles, which fill several blocks, in drag */
    TRADE_EMPTY,        /* no particle */
    TRADE_LOST,         /* one that leaves the reals of its precision at once */
    TRADE_SCENES
} trade_scene;

/* s */
extern const double trade_scene_durations[TRADE_SCENES];

/* Of the worlds that are built; all zero at first. */
extern stf_allocator trade_scene_allocator;
extern stf_guard trade_scene_guard;

#ifndef STF_DOUBLE
stf_result trade_scene_build(void *user, stf_world **world);
#endif

/* The same in double, in whatever precision this is included. */
stf_result trade_scene_build_f64(void *user, struct stf_world_f64 **world);

/* TRADE_FALL's: y = -(u^2 / g) ln cosh(g t / u), u the terminal speed. */
bool trade_scene_exact_fall(void *user, size_t particle, double time, double position[3], double velocity[3]);

#endif
