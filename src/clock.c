#include "steadfast/clock.h"

#include <float.h>
#include <limits.h>
#include <math.h>

#define DEFAULT_LONGEST_FRAME 0.25 /* s */

/*
 * A remainder that lacks less than this part of a step makes a tick: sums of frames that are whole steps on paper are
 * some ulps short of them in binary, and must not wait for the next frame. What was lent is kept as a negative remainder.
 */
#define WHOLE_STEP_SLACK 1e-9

/*
 * The quotient of a remainder and its step may round up to 1, and a step that was just made shorter may be below the
 * remainder.
 */
#define LARGEST_BELOW_1 (1 - DBL_EPSILON / 2)

static bool is_step(double step) { return isfinite(step) && step > 0; }
static bool is_duration(double seconds) { return isfinite(seconds) && seconds >= 0; }

/* As many as make the longest frame, and at least one. */
static unsigned default_max_ticks(double step)
{
    const double ticks = DEFAULT_LONGEST_FRAME / step + WHOLE_STEP_SLACK;

    return ticks < 1 ? 1 : ticks < UINT_MAX ? (unsigned)ticks : UINT_MAX;
}

stf_result stf_clock_init(stf_clock *clock, const stf_clock_def *def)
{
    if (!clock || !def)
        return STF_ERROR_NULL;

    const double step = def->step == 0 ? STF_DEFAULT_STEP : def->step;

    if (!is_step(step))
        return STF_ERROR_STEP;
    if (!is_duration(def->display_period) || !is_duration(def->time_scale))
        return STF_ERROR_FRAME_TIME;

    *clock = (stf_clock){
        .step = step,
        .display_period = def->display_period,
        .time_scale = def->time_scale == 0 ? 1 : def->time_scale,
        .max_ticks = def->max_ticks ? def->max_ticks : default_max_ticks(step),
        .max_ticks_by_time = def->max_ticks == 0,
    };
    return STF_OK;
}

/*
 * The frame time to reckon with: the multiple of the display's period that it is close to, so that the timer's jitter does
 * not make one frame run no tick and the next run two. The difference is set aside, and a frame that would take more than a
 * step of it is left as it is: a display whose period is not what it says can't pull simulated time away from real time.
 */
static double snap(stf_clock *clock, double frame_seconds)
{
    const double period = clock->display_period;

    if (period <= 0)
        return frame_seconds;

    const double snapped = period * floor(frame_seconds / period + 0.5);
    const double set_aside = clock->set_aside + (frame_seconds - snapped);

    if (snapped <= 0 || fabs(frame_seconds - snapped) > STF_CLOCK_SNAP)
        return frame_seconds;
    if (fabs(set_aside) > clock->step && fabs(set_aside) > fabs(clock->set_aside))
        return frame_seconds;

    clock->set_aside = set_aside;
    return snapped;
}

stf_result stf_clock_advance(stf_clock *clock, double frame_seconds, unsigned *ticks)
{
    if (ticks)
        *ticks = 0;
    if (!clock || !ticks)
        return STF_ERROR_NULL;
    if (!is_duration(frame_seconds))
        return STF_ERROR_FRAME_TIME;
    if (!isfinite((fabs(clock->remainder) + frame_seconds * clock->time_scale) / clock->step))
        return STF_ERROR_FRAME_TIME;

    const double simulated = clock->remainder + snap(clock, frame_seconds) * clock->time_scale;
    /* A lent remainder is no tick; neither is, while paused, one that a shorter step has made whole. */
    const double whole =
        clock->time_scale > 0 ? fmax(0, floor(simulated / clock->step + WHOLE_STEP_SLACK)) : 0;
    const double run = whole < clock->max_ticks ? whole : clock->max_ticks;
    const double remainder = simulated - whole * clock->step;
    const bool single = clock->single_steps > 0 && run < UINT_MAX;

    clock->dropped_this_frame = (whole - run) * clock->step;
    clock->dropped += clock->dropped_this_frame;
    /* A frame of 2^53 steps has round-off in place of a remainder. */
    clock->remainder = whole > 0 && fabs(remainder) > clock->step ? 0 : remainder;
    clock->single_steps -= single;
    *ticks = (unsigned)run + single;
    clock->ticks += *ticks;
    return STF_OK;
}

double stf_clock_alpha(const stf_clock *clock)
{
    if (!clock || clock->remainder <= 0)
        return 0;

    const double alpha = clock->remainder / clock->step;
    return alpha < 1 ? alpha : LARGEST_BELOW_1;
}

double stf_clock_time(const stf_clock *clock)
{
    return clock ? clock->step_start_time + (double)(clock->ticks - clock->step_start_tick) * clock->step : 0;
}

stf_result stf_clock_set_time_scale(stf_clock *clock, double time_scale)
{
    if (!clock)
        return STF_ERROR_NULL;
    if (!is_duration(time_scale))
        return STF_ERROR_FRAME_TIME;

    clock->time_scale = time_scale;
    return STF_OK;
}

stf_result stf_clock_set_step(stf_clock *clock, double step)
{
    if (!clock)
        return STF_ERROR_NULL;
    if (!is_step(step))
        return STF_ERROR_STEP;
    if (step == clock->step)
        return STF_OK; /* as in the world: both round their time at the same ticks */

    clock->step_start_time = stf_clock_time(clock);
    clock->step_start_tick = clock->ticks;
    clock->step = step;
    if (clock->max_ticks_by_time)
        clock->max_ticks = default_max_ticks(step);
    return STF_OK;
}

stf_result stf_clock_set_display_period(stf_clock *clock, double display_period)
{
    if (!clock)
        return STF_ERROR_NULL;
    if (!is_duration(display_period))
        return STF_ERROR_FRAME_TIME;

    clock->display_period = display_period;
    return STF_OK;
}

stf_result stf_clock_set_max_ticks(stf_clock *clock, unsigned max_ticks)
{
    if (!clock)
        return STF_ERROR_NULL;

    clock->max_ticks = max_ticks ? max_ticks : default_max_ticks(clock->step);
    clock->max_ticks_by_time = max_ticks == 0;
    return STF_OK;
}

stf_result stf_clock_single_step(stf_clock *clock)
{
    if (!clock)
        return STF_ERROR_NULL;

    if (clock->single_steps < UINT_MAX)
        clock->single_steps++;
    return STF_OK;
}
