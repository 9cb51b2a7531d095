/*
 * session: a scene at work. Its world, a ghost of it with another integrator that steps in lockstep, the clock that drives
 * both, and what is measured of them. No graphics: the window, the pictures and the scripts run the same sessions.
 */
#ifndef STEADFAST_DEMO_SESSION_H
#define STEADFAST_DEMO_SESSION_H

#include "actor.h"
#include "workers.h"

/* Chosen by the user; what is 0 or NULL is the scene's own. Ghost NULL: none. */
typedef struct settings {
    const scene *scene;
    const stf_integrator *integrator, *ghost;
    double step; /* time units a tick */
    unsigned substeps;
    workers *workers; /* the threads that step; NULL: the caller's alone. They outlive the session */
} settings;

#define COST_SAMPLES 61 /* frames that the median is taken over */

typedef struct session {
    settings settings;
    actor main, ghost;
    stf_clock clock;
    double display_period; /* s, 0: unknown */
    double speed;          /* the user's factor on the scene's own time scale */
    bool paused;
    bool by_hand; /* a particle was moved by hand: exact solution and energy at the start are of another scene */
    uint64_t last_tick; /* where the scene ends; UINT64_MAX: nowhere */
    double alpha; /* how far between the last two ticks to draw, 0 to 1 */
    unsigned ticks_this_frame;
    double dropped; /* time units, before this clock */
    double costs[COST_SAMPLES]; /* ns a particle a step: a ring */
    size_t cost_count;
} session;

/* Makes worlds and clock for these settings; on an error *s is as it was. *s all zero is valid and has no worlds. */
stf_result session_start(session *s, const settings *settings);
void session_close(session *s);

/* A frame took that many seconds: runs what ticks are due, up to the scene's end, then looks at the energies. */
stf_result session_advance(session *s, double frame_seconds);

/*
 * Runs that many ticks, whatever the clock says; stops early where the main world is lost. Looks at the energies at every
 * tick, or, for worlds of more than 64 particles, at every (count / 64 + 1)-th and the last.
 */
stf_result session_run(session *s, uint64_t ticks);

/* Whether the scene's last tick has been run: session_advance then runs no more. */
bool session_has_ended(const session *s);

/* Blends the last two states of each world into its `drawn`. */
stf_result session_place(session *s);

stf_result session_set_paused(session *s, bool paused);
stf_result session_set_speed(session *s, double speed);

/* Simulated time of the state that is drawn: up to a tick before the world's. */
double session_drawn_time(const session *s);

/* Time units given up on long frames, in all. */
double session_dropped(const session *s);

/* Median of the cost over the last frames that ran a tick, ns a particle a step of the integrator; NaN before the first. */
double session_cost(const session *s);

#endif
