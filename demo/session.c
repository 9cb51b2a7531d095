#include "session.h"

#include <SDL.h>
#include <math.h>
#include <stdlib.h>

#define LONGEST_FRAME 0.25 /* s that one frame may make up for; what is longer is dropped */
#define MOST_WORK 1e6      /* particle steps that one frame may take: some 50 ms of them */
#define WORK_OF_TICK 8.0   /* what a tick of no particles would cost, in particle steps */
#define TRAIL_SECONDS 5.0  /* that a trail reaches back, at the scene's own time scale */
#define TRAIL_SECONDS_OF_MANY 0.5
#define MANY_TRAILS 8
#define NANOSECONDS 1e9
#define OVERHEAD_TRIES 8

static void close_actor(actor *a)
{
    stf_world_destroy(a->world);
    trail_close(&a->trail);
    free(a->drawn);
    *a = (actor){0};
}

stf_result actor_energy(const actor *a, double *energy, double *relative_change)
{
    stf_energy parts;
    const stf_result bad = stf_world_energy(a->world, &parts);

    if (bad)
        return bad;
    *energy = parts.kinetic + parts.potential;
    *relative_change = a->start_energy != 0 ? (*energy - a->start_energy) / fabs(a->start_energy) : (double)NAN;
    return STF_OK;
}

static stf_result rebase(actor *a)
{
    stf_energy parts;
    const stf_result bad = a->world ? stf_world_energy(a->world, &parts) : STF_OK;

    if (!bad && a->world)
        a->start_energy = parts.kinetic + parts.potential;
    return bad;
}

static stf_result open_actor(actor *a, const settings *chosen, const stf_integrator *integrator)
{
    const stf_world_def overrides = {
        .integrator = integrator, .step = chosen->step, .substeps = chosen->substeps, .keep_previous = true};
    stf_result bad = scene_create(chosen->scene, &overrides, &a->world);

    if (!bad) {
        const double seconds = stf_world_count(a->world) > MANY_TRAILS ? TRAIL_SECONDS_OF_MANY : TRAIL_SECONDS;
        bad = trail_open(&a->trail, a->world, seconds * chosen->scene->time_scale / stf_world_step_size(a->world));
    }
    if (!bad)
        bad = rebase(a);
    if (!bad) {
        a->drawn = calloc(stf_world_count(a->world), STF_DIMENSIONS_MAX * sizeof *a->drawn);
        bad = a->drawn ? STF_OK : STF_ERROR_MEMORY;
    }
    if (bad)
        close_actor(a);
    return bad;
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
        bad = make_clock(&made, made.settings.step, &made.clock);
    }
    if (bad) {
        session_close(&made);
        return bad;
    }
    session_close(s);
    *s = made;
    return STF_OK;
}

void session_close(session *s)
{
    close_actor(&s->main);
    close_actor(&s->ghost);
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

/* One tick; *counts grows by what the step took, in counts of the performance counter. */
static stf_result tick(actor *a, Uint64 *counts)
{
    if (!a->world || a->lost)
        return STF_OK;

    const Uint64 start = SDL_GetPerformanceCounter();
    const stf_result bad = stf_world_step(a->world, 1);
    *counts += SDL_GetPerformanceCounter() - start;
    if (bad)
        return bad;
    a->lost = stf_world_find_non_finite(a->world, &a->lost_particle);
    return trail_record(&a->trail, a->world);
}

/* Notes what ticks of the main world took. */
static void note_cost(session *s, double seconds, uint64_t ticks)
{
    const double steps = (double)ticks * s->settings.substeps * (double)stf_world_count(s->main.world);

    if (steps > 0)
        s->costs[s->cost_count++ % COST_SAMPLES] = seconds * NANOSECONDS / steps;
}

stf_result session_run(session *s, uint64_t ticks)
{
    Uint64 counts = 0, ghost_counts = 0;
    uint64_t run = 0;
    stf_result bad = STF_OK;

    for (; run < ticks && !s->main.lost && !bad; run++) {
        bad = tick(&s->main, &counts);
        if (!bad)
            bad = tick(&s->ghost, &ghost_counts);
    }
    if (run > 0) {
        const double net = (double)counts - (double)run * (double)counter_overhead();
        note_cost(s, fmax(net, 0) / (double)SDL_GetPerformanceFrequency(), run);
    }
    return bad;
}

stf_result session_place(session *s)
{
    const size_t stride = STF_DIMENSIONS_MAX * sizeof(float);
    const stf_result bad = stf_world_copy_positions(s->main.world, s->alpha, s->main.drawn, stride);

    return bad || !s->ghost.world ? bad : stf_world_copy_positions(s->ghost.world, s->alpha, s->ghost.drawn, stride);
}

stf_result session_advance(session *s, double frame_seconds)
{
    unsigned ticks;

    s->ticks_this_frame = 0;
    if (s->main.lost)
        return STF_OK;

    const stf_result bad = stf_clock_advance(&s->clock, frame_seconds, &ticks);
    if (bad)
        return bad;
    s->ticks_this_frame = ticks;
    s->alpha = stf_clock_alpha(&s->clock);
    return session_run(s, ticks);
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

stf_result session_rebase_energy(session *s)
{
    const stf_result bad = rebase(&s->main);

    return bad ? bad : rebase(&s->ghost);
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

double session_ghost_distance(const session *s)
{
    const size_t count = stf_world_count(s->ghost.world);
    double sum = 0;

    for (size_t i = 0; i < count; i++) {
        stf_particle a, b;
        if (stf_world_get(s->main.world, i, &a) || stf_world_get(s->ghost.world, i, &b))
            return (double)NAN;
        const double dx = (double)a.position.x - (double)b.position.x, dy = (double)a.position.y - (double)b.position.y;
        const double dz = (double)a.position.z - (double)b.position.z;
        sum += dx * dx + dy * dy + dz * dz;
    }
    return count > 0 ? sqrt(sum / (double)count) : (double)NAN;
}
