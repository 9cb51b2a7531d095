#include "session.h"

#include <SDL.h>
#include <math.h>
#include <stdlib.h>

#define LONGEST_FRAME 0.25 /* s that one frame may make up for; what is longer is dropped */
#define MOST_WORK 1e6      /* particle steps that one frame may take: some 50 ms of them */
#define WORK_OF_TICK 8.0   /* what a tick of no particles would cost, in particle steps */
#define EVERY_TICK_MOST 64 /* particles of a world whose energy is cheap enough to be looked at every tick */
#define WHOLE_TICK 1e-6    /* ticks: a duration this little short of a whole number has all of them */
#define TICKS_MOST 1e15    /* what takes longer never ends */
#define NANOSECONDS 1e9
#define OVERHEAD_TRIES 8

static stf_result open_actor(actor *a, const settings *chosen, const stf_integrator *integrator)
{
    const stf_world_def overrides = {.integrator = integrator,
                                     .step = chosen->step,
                                     .substeps = chosen->substeps,
                                     .keep_previous = true,
                                     .parallel = workers_parallel(chosen->workers)};

    return actor_open(a, chosen->scene, &overrides);
}

/* The clock's limit is in ticks, so another step or speed wants another clock. */
static stf_result make_clock(const session *s, double step, stf_clock *clock)
{
    const double time_scale = s->settings.scene->time_scale * s->speed;
    const double work = (double)stf_world_count(s->main.world) * s->settings.substeps + WORK_OF_TICK;
    const double most = fmin(LONGEST_FRAME * time_scale / step, MOST_WORK / work);
    const stf_clock_def def = {.step = step,
                               .max_ticks = most < 1 ? 1 : most < UINT32_MAX ? (unsigned)most : UINT32_MAX,
                               .display_period = s->display_period,
                               .time_scale = time_scale};
    const stf_result bad = stf_clock_init(clock, &def);

    return bad ? bad : s->paused ? stf_clock_set_time_scale(clock, 0) : STF_OK;
}

/* The drag scene's plots end: a world that ran on would leave them. */
static uint64_t find_last_tick(const settings *chosen)
{
    const double ticks = floor(chosen->scene->duration / chosen->step + WHOLE_TICK);

    if (chosen->scene != &scene_drag || ticks > TICKS_MOST)
        return UINT64_MAX;
    return ticks < 1 ? 1 : (uint64_t)ticks;
}

stf_result session_start(session *s, const settings *chosen)
{
    session made = {.settings = *chosen, .display_period = s->display_period, .speed = s->speed > 0 ? s->speed : 1,
                    .paused = s->paused, .alpha = 1};
    const scene *of = chosen->scene;

    made.settings.integrator = chosen->integrator ? chosen->integrator : of->integrator;
    stf_result bad = open_actor(&made.main, chosen, made.settings.integrator);
    if (!bad && chosen->ghost)
        bad = open_actor(&made.ghost, chosen, chosen->ghost);
    if (!bad) {
        made.settings.step = stf_world_step_size(made.main.world);
        made.settings.substeps = stf_world_substeps(made.main.world);
        made.last_tick = find_last_tick(&made.settings);
        bad = make_clock(&made, made.settings.step, &made.clock);
    }
    if (!bad)
        bad = session_look_at_stability(&made);
    if (bad) {
        session_close(&made);
        return bad;
    }
    made.at_start = made.stability;
    session_close(s);
    *s = made;
    return STF_OK;
}

void session_close(session *s)
{
    actor_close(&s->main);
    actor_close(&s->ghost);
}

/* What reading the performance counter twice takes by itself: as long as a step of one particle. */
static Uint64 counter_overhead(void)
{
    Uint64 least = UINT64_MAX;

    for (int i = 0; i < OVERHEAD_TRIES; i++) {
        const Uint64 start = SDL_GetPerformanceCounter(), taken = SDL_GetPerformanceCounter() - start;
        least = taken < least ? taken : least;
    }
    return least;
}

/* Notes what ticks of the main world took. */
static void note_cost(session *s, double seconds, uint64_t ticks)
{
    const double steps = (double)ticks * s->settings.substeps * (double)stf_world_count(s->main.world);

    if (steps > 0)
        s->costs[s->cost_count++ % COST_SAMPLES] = seconds * NANOSECONDS / steps;
}

static stf_result sample_energies(session *s)
{
    const stf_result bad = actor_sample_energy(&s->main);

    return bad ? bad : actor_sample_energy(&s->ghost);
}

/* Runs ticks, and looks at the energies at every `sample_every`-th and the last. */
static stf_result run(session *s, uint64_t ticks, uint64_t sample_every)
{
    Uint64 counts = 0, ghost_counts = 0;
    uint64_t done = 0;
    stf_result bad = STF_OK;

    for (; done < ticks && !s->main.lost && !bad; done++) {
        bad = actor_tick(&s->main, &counts);
        if (!bad)
            bad = actor_tick(&s->ghost, &ghost_counts);
        if (!bad && stf_world_ticks(s->main.world) % sample_every == 0)
            bad = sample_energies(s);
    }
    if (done > 0) {
        const double net = (double)counts - (double)done * (double)counter_overhead();
        note_cost(s, fmax(net, 0) / (double)SDL_GetPerformanceFrequency(), done);
    }
    return bad || done == 0 ? bad : sample_energies(s);
}

stf_result session_run(session *s, uint64_t ticks)
{
    const size_t count = stf_world_count(s->main.world);

    return run(s, ticks, count > EVERY_TICK_MOST ? count / EVERY_TICK_MOST + 1 : 1);
}

stf_result session_place(session *s)
{
    const size_t stride = STF_DIMENSIONS_MAX * sizeof(float);
    const stf_result bad = stf_world_copy_positions(s->main.world, s->alpha, s->main.drawn, stride);

    return bad || !s->ghost.world ? bad : stf_world_copy_positions(s->ghost.world, s->alpha, s->ghost.drawn, stride);
}

stf_result session_look_at_stability(session *s)
{
    return s->main.lost ? STF_OK : stf_stability_measure(s->main.world, NULL, &s->stability);
}

const stf_stability *session_advice(const session *s)
{
    return s->main.lost || s->stability.load >= 1 ? &s->at_start : &s->stability;
}

bool session_has_ended(const session *s) { return stf_world_ticks(s->main.world) >= s->last_tick; }

stf_result session_advance(session *s, double frame_seconds)
{
    unsigned due;

    s->ticks_this_frame = 0;
    if (s->main.lost || session_has_ended(s))
        return STF_OK;

    stf_result bad = stf_clock_advance(&s->clock, frame_seconds, &due);
    if (bad)
        return bad;
    const uint64_t left = s->last_tick - stf_world_ticks(s->main.world);
    s->ticks_this_frame = due < left ? due : (unsigned)left;
    bad = run(s, s->ticks_this_frame, UINT64_MAX);
    if (session_has_ended(s) || (s->paused && s->ticks_this_frame > 0)) /* a single step shows what its figures are of */
        s->alpha = 1;
    else if (!s->paused)
        s->alpha = stf_clock_alpha(&s->clock);
    return bad;
}

stf_result session_set_paused(session *s, bool paused)
{
    const stf_result bad =
        stf_clock_set_time_scale(&s->clock, paused ? 0 : s->settings.scene->time_scale * s->speed);

    if (!bad)
        s->paused = paused;
    return bad;
}

stf_result session_set_speed(session *s, double speed)
{
    const double before = s->speed;
    stf_clock clock;

    s->speed = speed;
    const stf_result bad = make_clock(s, s->settings.step, &clock);
    if (bad) {
        s->speed = before;
        return bad;
    }
    s->dropped += s->clock.dropped;
    s->clock = clock;
    return STF_OK;
}

double session_drawn_time(const session *s)
{
    const double drawn = stf_world_time(s->main.world) - (1 - s->alpha) * s->settings.step;

    return drawn > 0 ? drawn : 0;
}

double session_dropped(const session *s) { return s->dropped + s->clock.dropped; }

static int compare(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;

    return (a > b) - (a < b);
}

double session_cost(const session *s)
{
    const size_t count = s->cost_count < COST_SAMPLES ? s->cost_count : COST_SAMPLES;
    double sorted[COST_SAMPLES];

    for (size_t i = 0; i < count; i++)
        sorted[i] = s->costs[i];
    qsort(sorted, count, sizeof *sorted, compare);
    return count > 0 ? sorted[count / 2] : (double)NAN;
}
