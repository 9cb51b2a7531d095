/*
 * clock: turns uneven frames into whole fixed steps.
 *
 *     const double step = 1.0 / 60;    // also the stf_world_def's, which wants .keep_previous = true for the blending
 *     stf_clock clock;
 *     stf_clock_init(&clock, &(stf_clock_def){.step = step});
 *     while (running) {
 *         unsigned ticks;
 *         stf_clock_advance(&clock, seconds_since_last_frame(), &ticks);
 *         stf_world_step(world, ticks);
 *         stf_world_copy_positions(world, stf_clock_alpha(&clock), vertices, 0);
 *         draw(vertices);
 *     }
 *
 * It is pure arithmetic in double, the same in both precisions: it reads no timer and knows no world, so a test can script
 * any sequence of frames. To round-off, between changes of the scale and the step and but for single steps,
 *
 *     ticks x step + remainder + dropped = time_scale x (sum of the frame times - set_aside)
 */
#ifndef STEADFAST_CLOCK_H
#define STEADFAST_CLOCK_H

#include "steadfast/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A frame time this close to a multiple of the display's period is taken to be that multiple. */
#define STF_CLOCK_SNAP 0.0002 /* s */

/* All zero is valid. */
typedef struct stf_clock_def {
    double step;           /* s a tick; 0: STF_DEFAULT_STEP */
    unsigned max_ticks;    /* the most ticks that one frame may ask for; 0: as many as make 0.25 s of simulated time, at least
                              1. A time scale of 20 at 30 frames a second wants more than that default */
    double display_period; /* s from one refresh of the display to the next, e.g. 1 / 59.94; 0: unknown, no frame is snapped */
    double time_scale;     /* simulated seconds a real second; 0: 1 (to start paused, set 0 with stf_clock_set_time_scale) */
} stf_clock_def;

/* A clock is a plain struct: copy it, keep it anywhere, read its fields; change them by the functions below. */
typedef struct stf_clock {
    double step;           /* s */
    double display_period; /* s, 0: none */
    double time_scale;
    unsigned max_ticks;
    bool max_ticks_by_time;   /* max_ticks is the default, and follows the step */
    unsigned single_steps;    /* ticks asked for by stf_clock_single_step and not yet run: one a frame */
    uint64_t ticks;           /* all ticks so far */
    uint64_t step_start_tick; /* ticks when the step was last set */
    double step_start_time;   /* s: simulated time then */
    double remainder;         /* s of simulated time that have not made a tick yet */
    double dropped;           /* s of simulated time given up by max_ticks, in all */
    double dropped_this_frame; /* s */
    double set_aside;         /* s of real time that snapping holds back (negative: lent); it never grows beyond a step */
} stf_clock;

/* Errors: NULL, STEP, FRAME_TIME (display_period or time_scale). */
STF_API stf_result stf_clock_init(stf_clock *clock, const stf_clock_def *def);

/*
 * A frame took frame_seconds: *ticks gets the number of ticks to run now. Errors: NULL, FRAME_TIME (negative, not finite, or
 * more steps than a double holds). On an error the clock does not change and *ticks is 0.
 */
STF_API stf_result stf_clock_advance(stf_clock *clock, double frame_seconds, unsigned *ticks);

/* How far the remainder is into the next tick: in [0, 1), the factor that stf_world_copy_positions blends by. */
STF_API double stf_clock_alpha(const stf_clock *clock);

/* s: ticks x step since the step was set, plus the time until then. */
STF_API double stf_clock_time(const stf_clock *clock);

/* 0 pauses. Errors: NULL, FRAME_TIME (negative or not finite). */
STF_API stf_result stf_clock_set_time_scale(stf_clock *clock, double time_scale);

/* Changes the step. The remainder is kept; a default max_ticks follows, one that was given stays. Errors: NULL, STEP. */
STF_API stf_result stf_clock_set_step(stf_clock *clock, double step);

/* For a window that moves to another display; 0: unknown. Errors: NULL, FRAME_TIME. */
STF_API stf_result stf_clock_set_display_period(stf_clock *clock, double display_period);

/* As in the def: 0 is as many as make 0.25 s. Errors: NULL. */
STF_API stf_result stf_clock_set_max_ticks(stf_clock *clock, unsigned max_ticks);

/* Has the next advance run one tick more than its time asks for, also when paused; called n times, the next n. Errors: NULL. */
STF_API stf_result stf_clock_single_step(stf_clock *clock);

#ifdef __cplusplus
}
#endif

#endif
