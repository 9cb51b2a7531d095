/* Rows are timed in turn, again and again: what slows the machine for a while slows all of them, and medians do not see it. */
#include <stdlib.h>

#include "../allocator.h"
#include "trade.h"

#define NANO 1e9

void stf_trade_advance(stf_trade_run *run)
{
    run->done++;
    if (run->progress)
        run->progress(run->user, run->done, run->total);
}

/* The estimate stands where the first repeat will: that one is taken last. */
static stf_result time_once(stf_trade_run *run, unsigned repeat)
{
    stf_result result = STF_OK;

    for (size_t i = 0; i < run->count && !result; i++) {
        double *repeats = &run->seconds[i * run->repeats];

        result = run->time_row(run, i, repeats[0], &repeats[repeat]);
        stf_trade_advance(run);
    }
    return result;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* The value below which this part of them lies, interpolated between its neighbours. */
static double quantile(const double *sorted, unsigned count, double part)
{
    const double at = part * (count - 1);
    const unsigned below = (unsigned)at, above = below + 1 < count ? below + 1 : below;

    return sorted[below] + (at - below) * (sorted[above] - sorted[below]);
}

static void summarise(const stf_trade_run *run)
{
    for (size_t i = 0; i < run->count; i++) {
        double *repeats = &run->seconds[i * run->repeats];

        qsort(repeats, run->repeats, sizeof *repeats, by_size);
        run->rows[i].nanoseconds = NANO * quantile(repeats, run->repeats, 0.5) / run->simulated;
        run->rows[i].nanoseconds_low = NANO * quantile(repeats, run->repeats, 0.25) / run->simulated;
        run->rows[i].nanoseconds_high = NANO * quantile(repeats, run->repeats, 0.75) / run->simulated;
    }
}

stf_result stf_trade_time(stf_trade_run *const *runs, size_t count)
{
    unsigned most = 0;

    if (!runs)
        return STF_ERROR_NULL;
    for (size_t i = 0; i < count; i++) {
        if (!runs[i])
            return STF_ERROR_NULL;
        most = runs[i]->repeats > most ? runs[i]->repeats : most;
    }
    for (unsigned repeat = most; repeat-- > 0;)
        for (size_t i = 0; i < count; i++) {
            const stf_result result = repeat < runs[i]->repeats ? time_once(runs[i], repeat) : STF_OK;
            if (result)
                return result;
        }
    for (size_t i = 0; i < count; i++)
        summarise(runs[i]);
    return STF_OK;
}

void stf_trade_end(stf_trade_run *run)
{
    if (!run)
        return;

    const stf_allocator allocator = run->allocator;

    stf_allocator_release(&allocator, run, run->bytes);
}
