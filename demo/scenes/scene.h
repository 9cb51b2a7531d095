/*
 * The scenes: worlds with their forces, built by demo, tests and tools alike. No SDL in here, and only public headers of
 * the library. A scene is a const descriptor; its builder calls no libm function but sqrt, so that every machine builds the
 * same bits.
 */
#ifndef STEADFAST_DEMO_SCENE_H
#define STEADFAST_DEMO_SCENE_H

#include "steadfast/steadfast.h"

/* A program may hold the scenes in both precisions, as it may the library. */
#ifdef STF_DOUBLE
#define scene scene_f64
#define scenes scenes_f64
#define scene_find scene_find_f64
#define scene_create scene_create_f64
#define scene_error scene_error_f64
#define scene_drag scene_drag_f64
#define scene_volley scene_volley_f64
#define scene_oscillator scene_oscillator_f64
#define scene_kepler scene_kepler_f64
#define scene_rope scene_rope_f64
#define scene_cloth scene_cloth_f64
#define scene_solar_system scene_solar_system_f64
#endif

typedef struct scene {
    const char *name;  /* for command lines: "kepler" */
    const char *title; /* for people: "Kepler orbit, e = 0.5" */
    const char *length_unit, *time_unit; /* "m", "s"; "au", "days" */
    unsigned dimensions;
    const stf_integrator *integrator; /* a good choice for it */
    double step;                      /* time units, a good choice for it */
    double duration;                  /* time units: long enough to judge an integrator by */
    double size;                      /* length units: what errors of position are compared with */
    double time_scale;                /* time units that a second of the demo shows */
    stf_vector gravity;
    double view_x, view_y;     /* centre of what there is to see */
    double view_half_height;   /* half of its height */
    bool conserves_energy;     /* no force takes energy away or adds any */
    stf_result (*populate)(stf_world *world);

    /* The exact state of a particle at a time from the start; false where none is known. NULL: known of none. */
    bool (*exact)(size_t particle, double time, double position[3], double velocity[3]);
} scene;

extern const scene scene_drag, scene_volley, scene_oscillator, scene_kepler, scene_rope, scene_cloth, scene_solar_system;

/* All of them, NULL-terminated. */
extern const scene *const scenes[];

/* The scene of this name, or NULL. */
const scene *scene_find(const char *name);

/*
 * Makes the scene's world in *world. `overrides` (or NULL) may set integrator, step, substeps, keep_previous and
 * allocator; what is 0 there is the scene's own. Errors: those of stf_world_create and of adding particles and forces.
 */
stf_result scene_create(const scene *s, const stf_world_def *overrides, stf_world **world);

/*
 * Root mean square, over the particles whose exact position is known, of the distance to it, in length units. NaN if none
 * is.
 */
double scene_error(const scene *s, const stf_world *world);

#endif
