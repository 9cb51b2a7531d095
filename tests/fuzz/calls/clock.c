/* The clock: a few frames, and the sum that its header promises. */
#include <math.h>
#include <string.h>

#include "game.h"

static bool is_duration(double seconds) { return isfinite(seconds) && seconds >= 0; }

/* s of simulated time that the clock accounts for. */
static double accounted(const stf_clock *c, uint64_t ticks) { return (double)ticks * c->step + c->remainder + c->dropped; }

static void advance(stf_clock *c, double frame)
{
    stf_clock before;
    unsigned ticks = 77;

    memcpy(&before, c, sizeof before); /* with its pads */
    const stf_result result = stf_clock_advance(c, frame, &ticks);

    claim(result == STF_OK || result == STF_ERROR_FRAME_TIME);
    claim(is_duration(frame) || result == STF_ERROR_FRAME_TIME);
    if (result) {
        claim(memcmp(c, &before, sizeof before) == 0 && ticks == 0);
        return;
    }
    const unsigned single = before.single_steps - c->single_steps;
    claim(single <= 1 && ticks - single <= c->max_ticks && c->ticks == before.ticks + ticks);
    claim(stf_clock_alpha(c) >= 0 && stf_clock_alpha(c) < 1 && c->dropped_this_frame >= 0);

    const double in = c->time_scale * (frame - (c->set_aside - before.set_aside));
    const double out = accounted(c, ticks - single) - accounted(&before, 0);
    const double size = fabs(in) + fabs(accounted(c, ticks)) + fabs(accounted(&before, 0)) + c->step;
    claim(!isfinite(size) || fabs(in - out) <= 1e-12 * size); /* some round-offs, and no step */
}

static stf_result change(stf_clock *c, unsigned what, double x)
{
    switch (what) {
    case 0: return stf_clock_set_step(c, x);
    case 1: return stf_clock_set_time_scale(c, x);
    case 2: return stf_clock_set_display_period(c, x);
    case 3: return stf_clock_set_max_ticks(c, isfinite(x) && x >= 0 && x < 1000 ? (unsigned)(16 * x) : 1);
    default: return stf_clock_single_step(c);
    }
}

void use_clock(game *g)
{
    const unsigned byte = take(&g->program), what = byte % 8;
    const double x = take_double(&g->program);
    stf_clock *c = &g->clock, before;

    memcpy(&before, c, sizeof before);
    if (c->step == 0 || byte >= 250) {
        const stf_clock_def def = {.step = x, .display_period = byte & 1 ? 1.0 / 60 : 0, .max_ticks = byte & 7};
        claim(stf_clock_init(c, &def) == (x == 0 || (isfinite(x) && x > 0) ? STF_OK : STF_ERROR_STEP));
    } else if (what < 5) {
        const double time = stf_clock_time(c);
        const bool is_good = what > 2 || (is_duration(x) && (what > 0 || x > 0));

        claim((change(c, what, x) == STF_OK) == is_good);
        claim(is_good || memcmp(c, &before, sizeof before) == 0);
        claim(stf_clock_time(c) == time || !isfinite(time));
    } else
        advance(c, what == 7 ? x / 16 : x);
}
