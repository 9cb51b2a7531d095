/*
 * session: a scene at work. Its world, a ghost of it with another integrator that steps in lockstep, the clock that drives
 * both, and what is measured of them. No graphics: the window, the pictures and the scripts run the same sessions.
 */
#ifndef STEADFAST_DEMO_SESSION_H
#define STEADFAST_DEMO_SESSION_H

#include "scenes/scene.h"
#include "trail.h"

/* Chosen by the user; what is 0 or NULL is the scene's own. Ghost NULL: none. */
typedef struct settings {
    const scene *scene;
    const stf_integrator *integrator, *ghost;
    double step; /* time units a tick */
    unsigned substeps;
} settings;

/* A world that takes part. */
typedef struct actor {
    stf_world *world; /* NULL: takes no part */
    trail trail;
    float *drawn;           /* [count][3]: positions to draw, set by session_place */
    double start_energy;    /* at tick 0, or when a hand let go */
    bool lost;              /* not finite any more since its last tick: it is stepped no further */
    size_t lost_particle;
} actor;

#define COST_SAMPLES 61 /* frames that the median is taken over */

typedef struct session {
    settings settings;
    actor main, ghost;
    stf_clock clock;
    double display_period; /* s, 0: unknown */
    double speed;          /* the user's factor on the scene's own time scale */
    bool paused;
    bool by_hand; /* a particle was moved by hand: the exact solution is of another scene */
    double alpha; /* how far between the last two ticks to draw, 0 to 1 */
    unsigned ticks_this_frame;
    double dropped; /* time units, before this clock */
    double costs[COST_SAMPLES]; /* ns a particle a step: a ring */
    size_t cost_count;
} session;

/* Makes worlds and clock for these settings; on an error *s is as it was. *s all zero is valid and has no worlds. */
stf_result session_start(session *s, const settings *settings);
void session_close(session *s);

/* A frame took that many seconds: runs what ticks are due. */
stf_result session_advance(session *s, double frame_seconds);

/* Runs that many ticks, whatever the clock says; stops early where the main world is lost. */
stf_result session_run(session *s, uint64_t ticks);

/* Blends the last two states of each world into its `drawn`. */
stf_result session_place(session *s);

stf_result session_set_paused(session *s, bool paused);
stf_result session_set_speed(session *s, double speed);

/* The energies are no longer those of the start: from here on they are compared with the present ones. */
stf_result session_rebase_energy(session *s);

/* Simulated time of the state that is drawn: up to a tick before the world's. */
double session_drawn_time(const session *s);

/* Time units given up on long frames, in all. */
double session_dropped(const session *s);

/* Energy now, and its change relative to the start's amount (NaN if that is 0). */
stf_result actor_energy(const actor *a, double *energy, double *relative_change);

/* Median of the cost over the last frames that ran a tick, ns a particle a step of the integrator; NaN before the first. */
double session_cost(const session *s);

/* Root mean square of the distance between each particle and its ghost, length units; NaN without a ghost. */
double session_ghost_distance(const session *s);

#endif
