/*
 * The clock against scripted frame times. Most frames here are whole multiples of 2^-34 s: their sums are then exact in double
 * (below 2^19 s), and what is left to be explained is the clock's own round-off.
 */
#include <limits.h>
#include <math.h>
#include <string.h>

#include "support/check.h"

#define SLACK 1e-9 /* of a step: what the clock lends a frame that is short of whole steps by round-off */
#define UNIT_ROUND_OFF (DBL_EPSILON / 2)
#define DAY 86400.0 /* s */

static stf_clock make_clock(stf_clock_def def)
{
    stf_clock clock;

    assert_ok(stf_clock_init(&clock, &def));
    return clock;
}

/* One frame, and what is true after every frame. */
static unsigned advance(stf_clock *clock, double seconds)
{
    const stf_clock before = *clock;
    unsigned ticks = 12345;

    assert_ok(stf_clock_advance(clock, seconds, &ticks));

    /* The clock rounds the scaled frame, its sum with the remainder, the whole steps and the difference: four half ulps. */
    const double round_off = 4 * UNIT_ROUND_OFF * (seconds * clock->time_scale + fabs(before.remainder) + clock->step);
    const bool single = before.single_steps > clock->single_steps;
    const double alpha = stf_clock_alpha(clock);

    assert_true(clock->ticks == before.ticks + ticks);
    assert_true(ticks - single <= clock->max_ticks);
    assert_true(clock->remainder >= fmin(before.remainder, -SLACK * clock->step) - round_off);
    assert_true(clock->remainder < clock->step);
    assert_true(alpha >= 0 && alpha < 1);
    assert_true(alpha == (clock->remainder > 0 ? clock->remainder / clock->step : 0));
    assert_true(fabs(clock->set_aside) <= clock->step);
    return ticks;
}

static double whole_units(double seconds) { return ldexp(floor(ldexp(seconds, 34)), -34); }

/* ---- setting up ---------------------------------------------------------------------------------------------------------- */

static void zero_def_is_60_hz_at_full_speed_for_a_quarter_second(void **state)
{
    (void)state;
    const stf_clock clock = make_clock((stf_clock_def){.step = 0});

    assert_true(clock.step == 1.0 / 60);
    assert_true(clock.time_scale == 1);
    assert_true(clock.display_period == 0);
    assert_true(clock.max_ticks == 15);
    assert_true(clock.ticks == 0 && clock.step_start_tick == 0 && clock.single_steps == 0);
    assert_true(clock.remainder == 0 && clock.dropped == 0 && clock.dropped_this_frame == 0 && clock.set_aside == 0);
    assert_true(stf_clock_alpha(&clock) == 0 && stf_clock_time(&clock) == 0);
}

static void def_is_taken_over(void **state)
{
    (void)state;
    const stf_clock clock =
        make_clock((stf_clock_def){.step = 0.01, .max_ticks = 7, .display_period = 0.02, .time_scale = 0.5});

    assert_true(clock.step == 0.01);
    assert_true(clock.max_ticks == 7);
    assert_true(clock.display_period == 0.02);
    assert_true(clock.time_scale == 0.5);
}

static void init_forgets_what_was_there(void **state)
{
    (void)state;
    const stf_clock_def def = {.step = 0.01};
    stf_clock used = make_clock(def), fresh = make_clock(def);

    advance(&used, 2.004);
    assert_ok(stf_clock_single_step(&used));
    assert_ok(stf_clock_init(&used, &def));
    assert_true(advance(&used, 0.015) == advance(&fresh, 0.015));
    assert_true(used.ticks == fresh.ticks && used.dropped == 0 && used.remainder == fresh.remainder);
}

static void default_cap_is_the_ticks_of_a_quarter_second(void **state)
{
    (void)state;
    assert_true(make_clock((stf_clock_def){.step = 0.25}).max_ticks == 1);
    assert_true(make_clock((stf_clock_def){.step = 0.26}).max_ticks == 1);
    assert_true(make_clock((stf_clock_def){.step = 1e300}).max_ticks == 1);
    assert_true(make_clock((stf_clock_def){.step = 1e-300}).max_ticks == UINT_MAX);
    assert_true(make_clock((stf_clock_def){.step = DBL_MIN * DBL_EPSILON}).max_ticks == UINT_MAX);
    /* 0.25 / (1.0 / n) is an ulp below n / 4 for some n, such as 420. */
    for (unsigned n = 4; n <= 10000; n++)
        assert_int_equal(make_clock((stf_clock_def){.step = 1.0 / n}).max_ticks, n / 4);
}

/* ---- what is refused ----------------------------------------------------------------------------------------------------- */

static void frames_of_more_steps_than_a_double_holds_are_refused(void **state)
{
    (void)state;
    const struct overflow {
        double step, scale, frame;
    } overflows[] = {{1.0 / 60, 1e300, 1e10}, {1e-300, 1, 1e10}, {1.0 / 60, 1, DBL_MAX}, {DBL_MAX, 10, DBL_MAX}};

    for (size_t i = 0; i < COUNT_OF(overflows); i++) {
        stf_clock before, clock = make_clock((stf_clock_def){.step = overflows[i].step, .display_period = 1.0 / 60});
        unsigned ticks = 12345;

        assert_ok(stf_clock_set_time_scale(&clock, overflows[i].scale));
        memcpy(&before, &clock, sizeof clock);
        assert_refused(stf_clock_advance(&clock, overflows[i].frame, &ticks), STF_ERROR_FRAME_TIME);
        assert_int_equal(ticks, 0);
        assert_memory_equal(&clock, &before, sizeof clock);
    }
}

/* ---- even frames --------------------------------------------------------------------------------------------------------- */

/*
 * A frame and n steps differ by three roundings, and the clock rounds twice more: at most 5 n half ulps of a step a frame, and
 * 10^5 x 5 n x 1.1e-16 = 6e-11 n of a step in all, which for n = 10 is within the slack.
 */
static void frames_of_n_steps_run_n_ticks_each(void **state)
{
    (void)state;
    const unsigned divisors[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

    for (size_t i = 0; i < COUNT_OF(divisors); i++) {
        const unsigned n = divisors[i];
        stf_clock divided = make_clock((stf_clock_def){.step = 1.0 / 60 / n});
        stf_clock rational = make_clock((stf_clock_def){.step = 1.0 / (60 * n)});
        for (int frame = 0; frame < 100000; frame++) {
            assert_int_equal(advance(&divided, 1.0 / 60), n);
            assert_int_equal(advance(&rational, 1.0 / 60), n);
        }
        assert_true(divided.dropped == 0 && rational.dropped == 0);
    }
}

static void ticks_are_the_whole_steps_of_the_time_so_far(void **state)
{
    (void)state;
    const unsigned rates[] = {24, 25, 30, 50, 59, 61, 75, 90, 120, 144, 165, 240, 1000}; /* Hz */

    for (size_t i = 0; i < COUNT_OF(rates); i++) {
        stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 60});
        for (unsigned frame = 1; frame <= 100000; frame++) {
            advance(&clock, 1.0 / rates[i]);
            assert_int_equal(clock.ticks, frame * 60 / rates[i]); /* whole numbers: exact */
        }
        assert_true(clock.dropped == 0);
    }
}

static void a_day_of_60_hz_is_exact(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 0});

    for (int frame = 0; frame < 60 * 86400; frame++)
        assert_int_equal(advance(&clock, 1.0 / 60), 1);
    assert_int_equal(clock.ticks, 5184000);
    assert_true(clock.remainder == 0 && clock.dropped == 0);
    assert_true(stf_clock_time(&clock) == 5184000 * (1.0 / 60));
}

/* ---- nothing is lost ----------------------------------------------------------------------------------------------------- */

/* The frames of a game that now and then waits for the disk, and now and then draws twice in a millisecond. */
static double scripted_frame(uint64_t *seed)
{
    const double kind = next_random(seed), x = next_random(seed);

    return whole_units(kind < 0.01   ? 2 * x
                       : kind < 0.02 ? 0
                       : kind < 0.10 ? 0.001 * x
                       : kind < 0.20 ? 1 / 30.0 + 0.0006 * (x - 0.5)
                                     : 1 / 60.0 + 0.0006 * (x - 0.5));
}

static void check_conservation(stf_clock_def def)
{
    stf_clock clock = make_clock(def);
    uint64_t seed = 11;
    double real = 0, round_off = 0;

    for (int frame = 0; frame < 20000; frame++) {
        const double seconds = scripted_frame(&seed);

        advance(&clock, seconds);
        real += seconds;
        /* A frame rounds its simulated time four times, what it drops and what is set aside twice, and the sum of drops. */
        round_off += UNIT_ROUND_OFF * (4 * (seconds * clock.time_scale + clock.step) + 2 * clock.dropped_this_frame +
                                       clock.dropped + 2 * clock.step * clock.time_scale);
        /* And the next line rounds each of its three sums and two products. */
        assert_close((double)clock.ticks * clock.step + clock.remainder + clock.dropped,
                     clock.time_scale * (real - clock.set_aside),
                     round_off + 5 * UNIT_ROUND_OFF * clock.time_scale * (real + clock.step));
        assert_true(clock.dropped_this_frame >= 0);
    }
    /* The script has to reach what it is for: a bound far below a tick, hitches over the cap, frames that were snapped. */
    assert_below(round_off, 1e-6 * clock.step);
    assert_above(clock.dropped, 0);
    assert_true((clock.set_aside != 0) == (def.display_period > 0));
}

static void ticks_remainder_and_drops_add_up_to_the_frames(void **state)
{
    (void)state;
    const double steps[] = {1.0 / 30, 1.0 / 60, 1.0 / 64, 0.01, 1.0 / 240}, scales[] = {1, 0.5, 2, 1.0 / 3},
                 periods[] = {0, 1.0 / 60, 1 / 59.94};

    for (size_t i = 0; i < COUNT_OF(steps); i++)
        for (size_t j = 0; j < COUNT_OF(scales); j++)
            for (size_t k = 0; k < COUNT_OF(periods); k++)
                check_conservation((stf_clock_def){
                    .step = steps[i],
                    .time_scale = scales[j],
                    .display_period = periods[k],
                    .max_ticks = 10,
                });
}

/* With powers of two nothing rounds, and frames of whole units come no nearer to a step than the slack. */
static void in_powers_of_two_every_frame_is_exact(void **state)
{
    (void)state;
    const double scales[] = {1, 0.5, 2};

    for (size_t i = 0; i < COUNT_OF(scales); i++) {
        stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64, .time_scale = scales[i], .max_ticks = 10});
        uint64_t seed = 12;
        double real = 0;

        for (int frame = 0; frame < 20000; frame++) {
            const double seconds = scripted_frame(&seed);
            const double dropped = clock.dropped;
            const unsigned ticks = advance(&clock, seconds);

            real += seconds;
            assert_true((double)clock.ticks + 64 * clock.dropped == floor(64 * scales[i] * real));
            assert_true(clock.remainder == scales[i] * real - floor(64 * scales[i] * real) / 64);
            assert_true(clock.dropped_this_frame == clock.dropped - dropped);
            assert_true(clock.dropped_this_frame == 0 || ticks == 10);
        }
        assert_above(clock.dropped, 0);
    }
}

/*
 * A frame that is short of whole steps by just what the clock lends may leave, by round-off, a remainder below what is lent.
 * The next frame must not take it for a tick that is missing.
 */
static void a_frame_of_no_time_after_a_lent_one_runs_no_tick(void **state)
{
    (void)state;
    for (int whole = 1; whole <= 15; whole++) {
        const double frame = (whole - SLACK) / 60;
        for (int ulps = -500; ulps <= 500; ulps++) {
            stf_clock clock = make_clock((stf_clock_def){.step = 0});
            const unsigned ticks = advance(&clock, frame + ulps * DBL_EPSILON * frame);
            assert_true((int)ticks == whole || (int)ticks == whole - 1);
            assert_int_equal(advance(&clock, 0), 0);
            assert_ok(stf_clock_set_time_scale(&clock, 0));
            assert_int_equal(advance(&clock, 1), 0);
            assert_int_equal(clock.ticks, ticks);
        }
    }
}

/* Lent time is paid back by the frames after it: the clock lends what is below the slack, and nothing that is above. */
static void what_is_lent_is_a_billionth_of_a_step(void **state)
{
    (void)state;
    stf_clock lent = make_clock((stf_clock_def){.step = 1}), not_lent = make_clock((stf_clock_def){.step = 1});

    assert_int_equal(advance(&lent, 1 - 0.9 * SLACK), 1);
    assert_close(lent.remainder, -0.9 * SLACK, UNIT_ROUND_OFF);
    assert_true(stf_clock_alpha(&lent) == 0);
    assert_int_equal(advance(&lent, 1 - 0.5 * SLACK), 0);
    assert_int_equal(advance(&not_lent, 1 - 1.1 * SLACK), 0);
    assert_close(not_lent.remainder, 1 - 1.1 * SLACK, UNIT_ROUND_OFF);
}

/* ---- displays ------------------------------------------------------------------------------------------------------------ */

#define NTSC_PERIOD (1 / 59.94) /* s; a step of 1/60 is 999/1000 of it: the display owes one tick more every 999 frames */

/*
 * When a program sees refresh `n` of a display: up to 0.075 ms early or late, so that frames are up to 0.15 ms off, and their
 * errors do not add up.
 */
static double time_of_refresh(unsigned n, double period, uint64_t *seed)
{
    return whole_units(1 + n * period + 0.00015 * (next_random(seed) - 0.5));
}

static void snapped_frames_of_a_5994_hz_display_run_one_tick_but_for_one_in_999(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 60, .display_period = NTSC_PERIOD});
    uint64_t seed = 13;
    double last = time_of_refresh(0, NTSC_PERIOD, &seed);

    for (unsigned frame = 1; frame <= 100000; frame++) {
        const double now = time_of_refresh(frame, NTSC_PERIOD, &seed);
        assert_int_equal(advance(&clock, now - last), frame % 999 == 0 ? 2 : 1);
        last = now;
    }
    assert_int_equal(clock.ticks, 100000 + 100000 / 999);
    assert_true(fabs(clock.set_aside) <= 0.00015 + 1e-9); /* the first timer error and the last; periods in whole units */
}

static void without_snapping_jitter_makes_frames_of_no_and_of_two_ticks(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 60});
    uint64_t seed = 13;
    double last = time_of_refresh(0, NTSC_PERIOD, &seed);
    int none = 0, two = 0;

    for (unsigned frame = 1; frame <= 100000; frame++) {
        const double now = time_of_refresh(frame, NTSC_PERIOD, &seed);
        const unsigned ticks = advance(&clock, now - last);
        none += ticks == 0;
        two += ticks == 2;
        last = now;
    }
    assert_true(none > 10);
    assert_true(two > 100000 / 999 + 10);
}

static void check_stray(double stated_period, double real_period)
{
    const double step = 1.0 / 60;
    stf_clock clock = make_clock((stf_clock_def){.step = step, .display_period = stated_period});
    uint64_t seed = 14;
    const double first = time_of_refresh(0, real_period, &seed);
    double last = first, most_set_aside = 0;

    for (unsigned frame = 1; last - first < 3600; frame++) {
        const double now = time_of_refresh(frame, real_period, &seed);
        advance(&clock, now - last);
        last = now;
        /* Over 216,000 frames round-off, some ulps of a step each, stays far below 1e-9 s. */
        const double simulated = (double)clock.ticks * step;
        assert_close(simulated + clock.remainder, now - first, step + 1e-9);
        assert_close(simulated, now - first, 2 * step + 1e-9);
        most_set_aside = fmax(most_set_aside, fabs(clock.set_aside));
    }
    /* The script reaches the limit: but for it, the hour would end 3.6 s off. */
    assert_above(most_set_aside, step - STF_CLOCK_SNAP);
    assert_true(clock.dropped == 0);
}

static void a_display_that_misstates_its_period_keeps_real_time_to_a_step(void **state)
{
    (void)state;
    check_stray(1.0 / 60, 1 / 59.94);
    check_stray(1 / 59.94, 1.0 / 60);
}

/* The remainder of a clock's first frame, whose step is too long for a tick: the time that the frame was taken for. */
static double taken_for(double frame, double period, double scale)
{
    stf_clock clock = make_clock((stf_clock_def){.step = 16, .display_period = period, .time_scale = scale});

    assert_int_equal(advance(&clock, frame), 0);
    assert_close(clock.set_aside, frame - clock.remainder / scale, 4 * UNIT_ROUND_OFF);
    return clock.remainder;
}

static void frames_within_a_fifth_of_a_millisecond_of_a_multiple_are_snapped(void **state)
{
    (void)state;
    const double periods[] = {1.0 / 60, 1 / 59.94, 1.0 / 144}, barely = 1e-9, off[] = {0, 1e-6, 0.0001, 0.0002 - barely},
                 far_off[] = {0.0002 + barely, 0.0003, 0.001, 0.003};

    for (size_t i = 0; i < COUNT_OF(periods); i++)
        for (int n = 1; n <= 3; n++) {
            const double multiple = n * periods[i];
            for (size_t j = 0; j < COUNT_OF(off); j++) {
                assert_true(taken_for(multiple + off[j], periods[i], 1) == multiple);
                assert_true(taken_for(multiple - off[j], periods[i], 1) == multiple);
            }
            for (size_t j = 0; j < COUNT_OF(far_off); j++) {
                assert_true(taken_for(multiple + far_off[j], periods[i], 1) == multiple + far_off[j]);
                assert_true(taken_for(multiple - far_off[j], periods[i], 1) == multiple - far_off[j]);
            }
        }
}

static void frames_near_zero_are_not_snapped(void **state)
{
    (void)state;
    const double frames[] = {0, 1e-9, 0.0001, 0.00019, 0.0002};

    for (size_t i = 0; i < COUNT_OF(frames); i++)
        assert_true(taken_for(frames[i], 1.0 / 60, 1) == frames[i]);
}

static void frames_are_snapped_before_they_are_scaled(void **state)
{
    (void)state;
    assert_true(taken_for(0.0251, 0.025, 0.5) == 0.0125);
    assert_true(taken_for(0.0251, 0.025, 4) == 0.1);
    assert_true(taken_for(0.0125, 0.025, 2) == 0.025);
}

/* Binary fractions, so that "a step" is met exactly: step = 2^-13 s, and frames that are as much over the period. */
static void one_step_is_the_most_that_is_set_aside_or_lent(void **state)
{
    (void)state;
    const double step = 1 / 8192.0, period = 0.25;

    for (int sign = -1; sign <= 1; sign += 2) {
        stf_clock clock = make_clock((stf_clock_def){.step = step, .display_period = period, .max_ticks = 4096});

        assert_int_equal(advance(&clock, period + sign * step), 2048);
        assert_true(clock.set_aside == sign * step);
        assert_int_equal(advance(&clock, period + sign * step), 2048 + sign);
        assert_true(clock.set_aside == sign * step);
        assert_int_equal(advance(&clock, period - sign * step), 2048);
        assert_true(clock.set_aside == 0);
    }
}

/* ---- long frames --------------------------------------------------------------------------------------------------------- */

static void a_long_frame_is_capped_and_says_what_it_dropped(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64});

    assert_int_equal(clock.max_ticks, 16);
    assert_int_equal(advance(&clock, 16.5 / 64), 16);
    assert_true(clock.dropped_this_frame == 0 && clock.remainder == 0.5 / 64);

    assert_int_equal(advance(&clock, 2), 16); /* 128 steps and the half that was left */
    assert_true(clock.dropped_this_frame == 112.0 / 64);
    assert_true(clock.dropped == 112.0 / 64);
    assert_true(clock.remainder == 0.5 / 64);

    assert_int_equal(advance(&clock, 1.0 / 64), 1);
    assert_true(clock.dropped_this_frame == 0);
    assert_true(clock.dropped == 112.0 / 64);

    assert_int_equal(advance(&clock, 17.25 / 64), 16);
    assert_true(clock.dropped_this_frame == 1.0 / 64);
    assert_true(clock.dropped == 113.0 / 64);
    assert_true(clock.remainder == 0.75 / 64);
    assert_true(stf_clock_time(&clock) == 49.0 / 64);
}

static void the_cap_is_the_users(void **state)
{
    (void)state;
    const unsigned caps[] = {1, 2, 100, 127, 128, 129, UINT_MAX};

    for (size_t i = 0; i < COUNT_OF(caps); i++) {
        stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64, .max_ticks = caps[i]});
        const unsigned run = caps[i] < 128 ? caps[i] : 128;
        assert_int_equal(advance(&clock, 2), run);
        assert_true(clock.dropped == (128 - run) / 64.0);
    }
}

static void a_frame_of_a_day_or_an_age_is_capped(void **state)
{
    (void)state;
    const double steps[] = {1.0 / 64, 1.0 / 60, 0.01}, frames[] = {DAY, 1.7e9, 1e12, 1e13, 1e15, 1e100, 1e300};

    for (size_t i = 0; i < COUNT_OF(steps); i++)
        for (size_t j = 0; j < COUNT_OF(frames); j++) {
            stf_clock clock = make_clock((stf_clock_def){.step = steps[i], .display_period = 1 / 59.94});

            assert_int_equal(advance(&clock, frames[j]), clock.max_ticks);
            /* As in advance: four half ulps, and one more each for what is dropped and for this sum. */
            assert_close((double)clock.ticks * clock.step + clock.remainder + clock.dropped, frames[j] - clock.set_aside,
                         8 * UNIT_ROUND_OFF * frames[j]);
            assert_int_equal(advance(&clock, 0), 0);
            assert_true(advance(&clock, 1.5 * clock.step) <= 2);
            assert_true(clock.dropped_this_frame == 0);
        }

    /* From 2^53 steps on, whole x step is off by steps: what that leaves is no remainder. */
    uint64_t seed = 15;
    for (int i = 0; i < 1000; i++) {
        stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 60});
        assert_int_equal(advance(&clock, 1e15 * (1 + next_random(&seed))), 15);
        assert_true(clock.remainder == 0);
    }

    stf_clock day = make_clock((stf_clock_def){.step = 1.0 / 64});
    assert_int_equal(advance(&day, DAY), 16);
    assert_true(day.remainder == 0 && day.dropped == DAY - 0.25);
}

/* ---- slower, faster, tick by tick ---------------------------------------------------------------------------------------- */

static void scale_0_pauses_and_keeps_the_remainder(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 0.01});

    assert_int_equal(advance(&clock, 0.017), 1);
    const double remainder = clock.remainder;
    assert_above(remainder, 0.0069);
    assert_ok(stf_clock_set_time_scale(&clock, 0));
    for (int frame = 0; frame < 1000; frame++) {
        assert_int_equal(advance(&clock, frame == 500 ? 1000 : 0.017), 0);
        assert_true(clock.remainder == remainder && clock.dropped == 0);
    }
    assert_int_equal(clock.ticks, 1);
    assert_ok(stf_clock_set_time_scale(&clock, 1));
    assert_int_equal(advance(&clock, 0.004), 1);
}

static void scale_is_simulated_seconds_a_real_second(void **state)
{
    (void)state;
    const struct scaled {
        double scale;
        unsigned ticks; /* of 100 s in frames of 1/64 s at a step of 1/64 s */
    } scaled[] = {{0.5, 3200}, {1, 6400}, {2, 12800}, {1e-3, 6}, {15, 96000}};

    for (size_t i = 0; i < COUNT_OF(scaled); i++) {
        stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64, .time_scale = scaled[i].scale});
        for (int frame = 0; frame < 6400; frame++)
            advance(&clock, 1.0 / 64);
        assert_int_equal(clock.ticks, scaled[i].ticks);
        assert_true(clock.dropped == 0);
    }
}

static void a_new_scale_is_that_of_the_next_frame(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64});

    assert_int_equal(advance(&clock, 1.75 / 64), 1);
    assert_ok(stf_clock_set_time_scale(&clock, 2));
    assert_true(clock.remainder == 0.75 / 64 && clock.ticks == 1);
    assert_int_equal(advance(&clock, 1.0 / 64), 2);
    assert_true(clock.remainder == 0.75 / 64);
}

/* What was set aside at a long step is more than a short one: frames that give it back are still snapped. */
static void what_is_set_aside_comes_back_after_a_shorter_step(void **state)
{
    (void)state;
    const double period = 1.0 / 64, late = 0.0001;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64, .display_period = period});

    for (int frame = 0; frame < 100; frame++)
        advance(&clock, period + late);
    assert_close(clock.set_aside, 100 * late, 100 * 100 * late * UNIT_ROUND_OFF);
    assert_ok(stf_clock_set_step(&clock, 1.0 / 1024));
    stf_clock away = clock;
    unsigned ticks;
    assert_ok(stf_clock_advance(&away, period + late, &ticks));
    assert_true(away.set_aside == clock.set_aside);
    assert_ok(stf_clock_advance(&clock, period - late, &ticks));
    assert_close(clock.set_aside, 99 * late, 100 * 100 * late * UNIT_ROUND_OFF);
    assert_int_equal(ticks, 16);
}

/* After a tick of 1/60 s the time so far would be rounded once more if it were counted from there. */
static void setting_the_step_that_it_has_changes_nothing(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 60});

    (void)advance(&clock, 0.02);
    const stf_clock before = clock;
    assert_ok(stf_clock_set_step(&clock, 1.0 / 60));
    assert_memory_equal(&clock, &before, sizeof clock);
}

static void a_paused_clock_does_not_tick_when_its_step_gets_shorter(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1});
    unsigned ticks = 7;

    assert_ok(stf_clock_advance(&clock, 0.75, &ticks));
    assert_ok(stf_clock_set_time_scale(&clock, 0));
    assert_ok(stf_clock_set_step(&clock, 0.5));
    assert_ok(stf_clock_advance(&clock, 0.25, &ticks));
    assert_int_equal(ticks, 0);
    assert_true(clock.remainder == 0.75 && stf_clock_alpha(&clock) < 1);
    assert_ok(stf_clock_set_time_scale(&clock, 1));
    assert_ok(stf_clock_advance(&clock, 0, &ticks));
    assert_int_equal(ticks, 1);
    assert_true(clock.remainder == 0.25);
}

/* The default cap is a quarter of a second whatever the step becomes; a cap that was given is kept. */
static void default_cap_follows_the_step(void **state)
{
    (void)state;
    stf_clock by_default = make_clock((stf_clock_def){.step = 1.0 / 64});
    stf_clock given = make_clock((stf_clock_def){.step = 1.0 / 64, .max_ticks = 16});

    assert_int_equal(by_default.max_ticks, 16);
    assert_ok(stf_clock_set_step(&by_default, 1.0 / 1024));
    assert_ok(stf_clock_set_step(&given, 1.0 / 1024));
    assert_int_equal(by_default.max_ticks, 256);
    assert_int_equal(given.max_ticks, 16);
    assert_int_equal(advance(&by_default, 0.25), 256);
    assert_int_equal(advance(&given, 0.25), 16);

    assert_ok(stf_clock_set_max_ticks(&given, 0));
    assert_ok(stf_clock_set_max_ticks(&by_default, 5));
    assert_int_equal(given.max_ticks, 256);
    assert_ok(stf_clock_set_step(&given, 1));
    assert_ok(stf_clock_set_step(&by_default, 1));
    assert_int_equal(given.max_ticks, 1);
    assert_int_equal(by_default.max_ticks, 5);
    assert_refused(stf_clock_set_max_ticks(NULL, 5), STF_ERROR_NULL);
}

static void display_period_can_change_and_refuses_what_the_def_does(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64});
    const double refused[] = {-1, (double)NAN, (double)INFINITY};

    assert_ok(stf_clock_set_display_period(&clock, 1.0 / 64));
    advance(&clock, 1.0 / 64 + 0.0001);
    assert_true(clock.set_aside > 0);
    const stf_clock before = clock;
    for (size_t i = 0; i < COUNT_OF(refused); i++)
        assert_refused(stf_clock_set_display_period(&clock, refused[i]), STF_ERROR_FRAME_TIME);
    assert_refused(stf_clock_set_display_period(NULL, 1), STF_ERROR_NULL);
    assert_memory_equal(&clock, &before, sizeof clock);
    assert_ok(stf_clock_set_display_period(&clock, 0));
    advance(&clock, 1.0 / 64 + 0.0001);
    assert_true(clock.set_aside == before.set_aside);
}

/* What is left of a frame may be more steps than a double holds, once the steps are short enough. */
static void a_remainder_of_too_many_steps_is_refused(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1});
    unsigned ticks = 7;

    assert_int_equal(advance(&clock, 0.5), 0);
    assert_ok(stf_clock_set_step(&clock, 1e-310));
    const stf_clock before = clock;
    assert_refused(stf_clock_advance(&clock, 0, &ticks), STF_ERROR_FRAME_TIME);
    assert_int_equal(ticks, 0);
    assert_memory_equal(&clock, &before, sizeof clock);
}

static void single_steps_run_one_a_frame_while_paused(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64});

    assert_ok(stf_clock_set_time_scale(&clock, 0));
    for (int i = 0; i < 3; i++)
        assert_ok(stf_clock_single_step(&clock));
    for (unsigned i = 0; i < 3; i++) {
        assert_int_equal(clock.single_steps, 3 - i);
        assert_int_equal(advance(&clock, 1), 1);
    }
    assert_int_equal(advance(&clock, 1), 0);
    assert_int_equal(clock.ticks, 3);
    assert_true(clock.remainder == 0 && clock.dropped == 0 && stf_clock_time(&clock) == 3.0 / 64);
}

static void single_steps_come_on_top_of_a_running_clock(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64});

    assert_ok(stf_clock_single_step(&clock));
    assert_ok(stf_clock_single_step(&clock));
    assert_int_equal(advance(&clock, 1.5 / 64), 2);
    assert_true(clock.remainder == 0.5 / 64);
    assert_int_equal(advance(&clock, 2), 17); /* above the cap too */
    assert_true(clock.dropped == 112.0 / 64 && clock.remainder == 0.5 / 64);
    assert_int_equal(advance(&clock, 1.0 / 64), 1);
}

static void a_single_step_waits_for_a_frame_that_has_room(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1e-9, .max_ticks = UINT_MAX});

    assert_ok(stf_clock_single_step(&clock));
    assert_true(advance(&clock, 5) == UINT_MAX);
    assert_int_equal(clock.single_steps, 1);
    assert_int_equal(advance(&clock, 0), 1);
    assert_int_equal(clock.single_steps, 0);
}

/* ---- the step, and long games -------------------------------------------------------------------------------------------- */

static void time_goes_on_from_where_the_step_was_changed(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64, .max_ticks = 16});

    assert_int_equal(advance(&clock, 10.25 / 64), 10);
    for (int n = 1; n <= 20; n++) {
        const double before = stf_clock_time(&clock), remainder = clock.remainder, step = 1.0 / (60 + n);
        const uint64_t ticks = clock.ticks;

        assert_ok(stf_clock_set_step(&clock, step));
        assert_true(stf_clock_time(&clock) == before);
        assert_true(clock.remainder == remainder && clock.ticks == ticks && clock.step == step);
        advance(&clock, 3.5 * step);
        advance(&clock, 3.5 * step);
        assert_true(clock.ticks - ticks == 7 || clock.ticks - ticks == 8);
        assert_true(stf_clock_time(&clock) == before + (double)(clock.ticks - ticks) * step);
    }
    assert_int_equal(clock.max_ticks, 16); /* as it was */
}

static void a_step_shorter_than_the_remainder_keeps_alpha_below_1(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1});

    assert_int_equal(advance(&clock, 0.75), 0);
    assert_ok(stf_clock_set_step(&clock, 0.25));
    assert_true(clock.remainder == 0.75);
    assert_true(stf_clock_alpha(&clock) == 1 - DBL_EPSILON / 2);
    assert_ok(stf_clock_set_step(&clock, 0.75));
    assert_true(stf_clock_alpha(&clock) == 1 - DBL_EPSILON / 2);
    assert_ok(stf_clock_set_step(&clock, 1.5));
    assert_true(stf_clock_alpha(&clock) == 0.5);
    assert_ok(stf_clock_set_step(&clock, 0.25));
    assert_ok(stf_clock_set_max_ticks(&clock, 3));
    assert_int_equal(advance(&clock, 0), 3);
    assert_true(clock.remainder == 0 && clock.dropped == 0);
}

static void ticks_pass_32_bits(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1.0 / 64, .max_ticks = 16});

    clock.ticks = UINT64_C(0xfffffffc);
    for (int frame = 0; frame < 10; frame++)
        assert_int_equal(advance(&clock, 1.0 / 64), 1);
    assert_true(clock.ticks == UINT64_C(0x100000006));
    assert_true(stf_clock_time(&clock) == ldexp(1, 26) + 6.0 / 64);

    assert_ok(stf_clock_set_step(&clock, 0.5));
    assert_true(clock.step_start_tick == UINT64_C(0x100000006));
    assert_int_equal(advance(&clock, 1), 2);
    assert_true(stf_clock_time(&clock) == ldexp(1, 26) + 6.0 / 64 + 1);
}

/* A sum of 10^5 steps of 0.01 s is off by thousands of ulps; a product is never off by more than half of one. */
static void time_is_a_product_and_never_a_sum(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 0.01});

    for (int frame = 1; frame <= 100000; frame++) {
        advance(&clock, 0.01);
        assert_true(stf_clock_time(&clock) == (double)clock.ticks * 0.01);
    }
}

static void single_steps_are_no_more_than_can_be_counted(void **state)
{
    (void)state;
    stf_clock clock = make_clock((stf_clock_def){.step = 1});

    clock.single_steps = UINT_MAX;
    assert_ok(stf_clock_single_step(&clock));
    assert_true(clock.single_steps == UINT_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zero_def_is_60_hz_at_full_speed_for_a_quarter_second),
        cmocka_unit_test(def_is_taken_over),
        cmocka_unit_test(init_forgets_what_was_there),
        cmocka_unit_test(default_cap_is_the_ticks_of_a_quarter_second),
        cmocka_unit_test(frames_of_more_steps_than_a_double_holds_are_refused),
        cmocka_unit_test(frames_of_n_steps_run_n_ticks_each),
        cmocka_unit_test(ticks_are_the_whole_steps_of_the_time_so_far),
        cmocka_unit_test(a_day_of_60_hz_is_exact),
        cmocka_unit_test(ticks_remainder_and_drops_add_up_to_the_frames),
        cmocka_unit_test(in_powers_of_two_every_frame_is_exact),
        cmocka_unit_test(a_frame_of_no_time_after_a_lent_one_runs_no_tick),
        cmocka_unit_test(what_is_lent_is_a_billionth_of_a_step),
        cmocka_unit_test(snapped_frames_of_a_5994_hz_display_run_one_tick_but_for_one_in_999),
        cmocka_unit_test(without_snapping_jitter_makes_frames_of_no_and_of_two_ticks),
        cmocka_unit_test(a_display_that_misstates_its_period_keeps_real_time_to_a_step),
        cmocka_unit_test(frames_within_a_fifth_of_a_millisecond_of_a_multiple_are_snapped),
        cmocka_unit_test(frames_near_zero_are_not_snapped),
        cmocka_unit_test(frames_are_snapped_before_they_are_scaled),
        cmocka_unit_test(one_step_is_the_most_that_is_set_aside_or_lent),
        cmocka_unit_test(a_long_frame_is_capped_and_says_what_it_dropped),
        cmocka_unit_test(the_cap_is_the_users),
        cmocka_unit_test(a_frame_of_a_day_or_an_age_is_capped),
        cmocka_unit_test(scale_0_pauses_and_keeps_the_remainder),
        cmocka_unit_test(scale_is_simulated_seconds_a_real_second),
        cmocka_unit_test(a_new_scale_is_that_of_the_next_frame),
        cmocka_unit_test(what_is_set_aside_comes_back_after_a_shorter_step),
        cmocka_unit_test(setting_the_step_that_it_has_changes_nothing),
        cmocka_unit_test(a_paused_clock_does_not_tick_when_its_step_gets_shorter),
        cmocka_unit_test(default_cap_follows_the_step),
        cmocka_unit_test(display_period_can_change_and_refuses_what_the_def_does),
        cmocka_unit_test(a_remainder_of_too_many_steps_is_refused),
        cmocka_unit_test(single_steps_run_one_a_frame_while_paused),
        cmocka_unit_test(single_steps_come_on_top_of_a_running_clock),
        cmocka_unit_test(a_single_step_waits_for_a_frame_that_has_room),
        cmocka_unit_test(time_goes_on_from_where_the_step_was_changed),
        cmocka_unit_test(a_step_shorter_than_the_remainder_keeps_alpha_below_1),
        cmocka_unit_test(ticks_pass_32_bits),
        cmocka_unit_test(time_is_a_product_and_never_a_sum),
        cmocka_unit_test(single_steps_are_no_more_than_can_be_counted),
    };

    return cmocka_run_group_tests_name("clock, " REAL_NAME, tests, NULL, NULL);
}
