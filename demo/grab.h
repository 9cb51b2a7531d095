/*
 * grab: a hand that holds a particle. It pulls by a force of the demo's own, a damped spring to the cursor, in both worlds
 * alike. An immovable particle is put where the cursor is.
 */
#ifndef STEADFAST_DEMO_GRAB_H
#define STEADFAST_DEMO_GRAB_H

#include "session.h"

typedef struct grab_handle {
    uint32_t particle;
    stf_vector anchor;            /* length units */
    stf_real stiffness, damping;
} grab_handle;

/* All zero: an empty hand. */
typedef struct grab {
    bool active, movable;
    stf_force_id main_force, ghost_force;
    grab_handle handle;
    stf_vector target;            /* where the cursor is; the handle is on its way there */
} grab;

/* Takes hold of a particle where it is. */
stf_result grab_start(grab *g, session *s, size_t particle);

/* Once a frame: has the handle follow the target, quickly but not at once. Does nothing with an empty hand. */
stf_result grab_follow(grab *g, session *s, double seconds);

/* Lets go. Does nothing with an empty hand. */
stf_result grab_end(grab *g, session *s);

#endif
