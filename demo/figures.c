#include "figures.h"

#include <math.h>
#include <stdio.h>

#include "draw.h"

#define SHORT_STEP 10 /* time units: times of longer steps are shown without decimals */
#define ENERGY_NOISE 1e-6 /* an energy this small a part of its scale is round-off: it is shown as 0 */
#define ENERGY_TIMES_MOST 10 /* energy that has grown beyond this many times is better shown in joules */

static void add_row(figures *f, SDL_Color colour, const char *label, const char *value)
{
    if (f->count == FIGURES_MAX)
        return;

    figure *row = &f->rows[f->count++];
    row->colour = colour;
    snprintf(row->label, sizeof row->label, "%s", label);
    snprintf(row->value, sizeof row->value, "%s", value);
}

static void add_gap(figures *f) { add_row(f, COLOUR_TEXT, "", ""); }

/* A value with its unit behind it. */
static void add_number(figures *f, SDL_Color colour, const char *label, double value, const char *unit)
{
    char number[32], text[FIGURE_TEXT];

    format_number(number, sizeof number, value);
    snprintf(text, sizeof text, "%s%s%s", number, isfinite(value) ? " " : "", isfinite(value) ? unit : "");
    add_row(f, colour, label, text);
}

static void add_count(figures *f, const char *label, uint64_t count)
{
    char text[FIGURE_TEXT];

    snprintf(text, sizeof text, "%llu", (unsigned long long)count);
    add_row(f, COLOUR_TEXT, label, text);
}

void format_order(char *text, size_t size, const stf_integrator *integrator)
{
    snprintf(text, size, "%d, %d acceleration%s a step", integrator->order, integrator->evaluations,
             integrator->evaluations == 1 ? "" : "s");
}

static void add_integrator(figures *f, const char *label, const stf_integrator *integrator, SDL_Color colour)
{
    char text[FIGURE_TEXT];

    format_order(text, sizeof text, integrator);
    add_row(f, colour, label, integrator->name);
    add_row(f, COLOUR_TEXT, "order", text);
}

/* ---- energy -------------------------------------------------------------------------------------------------------------- */

/* Relative to the start, or in joules where that is 0. */
static void add_energy_error(figures *f, const energy_samples *e)
{
    const bool relative = fabs(e->start) > ENERGY_NOISE * e->scale;
    const double one = relative ? fabs(e->start) : 1;

    add_number(f, COLOUR_TEXT, "energy error", (e->now - e->start) / one, relative ? "of E(0)" : "J");
    add_number(f, COLOUR_MUTED, "", e->largest_change / one, "at most");
}

static double without_noise(const energy_samples *e, double energy)
{
    return fabs(energy) < ENERGY_NOISE * e->scale ? 0 : energy;
}

static void add_energy(figures *f, const session *s, const actor *a)
{
    const scene *of = s->settings.scene;
    const energy_samples *e = &a->energy;
    const double now = without_noise(e, e->now), start = without_noise(e, e->start);
    /* A part of the energy at the start means something only where no height is 0 by choice. */
    const bool falls = of->gravity.x != 0 || of->gravity.y != 0 || of->gravity.z != 0;

    if (a->lost) {
        add_row(f, COLOUR_WARNING, "energy", "lost");
    } else if (s->by_hand) {
        add_row(f, COLOUR_MUTED, "energy", "moved by hand");
    } else if (of->conserves_energy) {
        add_energy_error(f, e);
    } else if (!falls && start > 0 && now < ENERGY_TIMES_MOST * start) {
        add_number(f, COLOUR_TEXT, "energy left", 100 * now / start, "%");
    } else {
        add_number(f, COLOUR_TEXT, "energy", now, "J");
        add_number(f, COLOUR_MUTED, "", start, "J at the start");
    }
}

/* ---- error, distance ----------------------------------------------------------------------------------------------------- */

/* Of how many particles the exact solution is known. */
static size_t count_exact(const scene *of, const stf_world *world)
{
    double position[3], velocity[3];
    size_t known = 0;

    for (size_t i = 0; i < stf_world_count(world); i++)
        known += of->exact(i, 0, position, velocity);
    return known;
}

static void add_error(figures *f, const session *s, const actor *a)
{
    const scene *of = s->settings.scene;
    const size_t count = stf_world_count(a->world), known = of->exact ? count_exact(of, a->world) : 0;
    char text[FIGURE_TEXT];

    if (known == 0) {
        add_row(f, COLOUR_MUTED, "error", "no exact solution");
    } else if (a->lost) {
        add_row(f, COLOUR_WARNING, "error", "lost");
    } else if (s->by_hand) {
        add_row(f, COLOUR_MUTED, "error", "moved by hand");
    } else {
        const char *label = count == 1 ? "position error" : known == 1 ? "error" : "error, rms";
        add_number(f, COLOUR_TEXT, label, scene_error(of, a->world), of->length_unit);
        snprintf(text, sizeof text, "known for %lu of %lu", (unsigned long)known, (unsigned long)count);
        if (known < count)
            add_row(f, COLOUR_MUTED, "", text);
    }
}

static void add_distance(figures *f, const session *s)
{
    const char *label = stf_world_count(s->main.world) == 1 ? "distance" : "distance, rms";

    if (s->main.lost || s->ghost.lost)
        add_row(f, COLOUR_WARNING, label, "lost");
    else
        add_number(f, COLOUR_TEXT, label, actor_distance(&s->main, &s->ghost), s->settings.scene->length_unit);
}

/* ---- stability ----------------------------------------------------------------------------------------------------------- */

/* A word beside each colour, for those who can't tell the colours apart. */
static void add_stability(figures *f, const session *s)
{
    const stf_stability *now = &s->stability, *advice = session_advice(s);
    const double percent = 100 * now->load;
    char text[FIGURE_TEXT];

    if (s->main.lost || percent >= 100) {
        if (now->limit == 0)
            snprintf(text, sizeof text, "grows at every step");
        else if (advice->substeps > s->settings.substeps)
            snprintf(text, sizeof text, "grows: %u substeps hold (A)", advice->substeps);
        else
            snprintf(text, sizeof text, "grows");
        add_row(f, COLOUR_UNSTEADY, "stability", text);
    } else if (percent > 100 * STF_STABILITY_SAFETY) {
        snprintf(text, sizeof text, "close: %.0f %% of the limit", percent);
        add_row(f, COLOUR_CLOSE, "stability", text);
    } else if (percent == 0 && now->growth > 0) { /* what flies apart hides what swings: see stability.h */
        add_row(f, COLOUR_CLOSE, "stability", "no limit told: flies apart");
    } else {
        snprintf(text, sizeof text, percent > 0 ? "steady: %.2g %% of the limit" : "steady: no limit", percent);
        add_row(f, COLOUR_STEADY, "stability", text);
    }
    snprintf(text, sizeof text, "ω dt %.3g, k dt %.3g", now->omega_dt, now->k_dt);
    if (now->limit < (double)INFINITY)
        add_row(f, COLOUR_MUTED, "", text);
}

void figures_add_measured(figures *f, const session *s, const actor *a)
{
    const double cost = session_cost(s);

    if (a == &s->main && isnan(cost))
        add_row(f, COLOUR_MUTED, "cost", "not yet measured");
    else if (a == &s->main)
        add_number(f, COLOUR_TEXT, "cost", cost, "ns/particle/step");
    if (a == &s->main)
        add_stability(f, s);
    add_energy(f, s, a);
    add_error(f, s, a);
    if (a == &s->ghost)
        add_distance(f, s);
}

/* Simulated time. */
static void format_time(char *text, size_t size, const session *s, const actor *a)
{
    const int decimals = s->settings.step < SHORT_STEP ? 2 : 0;

    snprintf(text, size, "%.*f %s", decimals, stf_world_time(a->world), s->settings.scene->time_unit);
}

void format_loss(char *text, size_t size, const session *s, const actor *a)
{
    char time[FIGURE_TEXT];

    format_time(time, sizeof time, s, a);
    snprintf(text, size, "particle %lu left the finite numbers at tick %llu (%s)", (unsigned long)a->lost_particle,
             (unsigned long long)stf_world_ticks(a->world), time);
}

/* ---- all of them --------------------------------------------------------------------------------------------------------- */

static void add_pace(figures *f, const session *s)
{
    const double dropped = session_dropped(s);
    char text[FIGURE_TEXT];

    snprintf(text, sizeof text, "%u tick%s", s->ticks_this_frame, s->ticks_this_frame == 1 ? "" : "s");
    add_row(f, COLOUR_TEXT, "this frame", text);
    add_number(f, dropped > 0 ? COLOUR_WARNING : COLOUR_TEXT, "dropped", dropped, s->settings.scene->time_unit);
    snprintf(text, sizeof text, "×%g%s", s->speed, s->paused ? ", paused" : "");
    add_row(f, s->paused ? COLOUR_WARNING : COLOUR_TEXT, "speed", text);
}

static void add_time(figures *f, const session *s, bool still)
{
    const char *unit = s->settings.scene->time_unit;
    const bool ended = session_has_ended(s) && !still;
    char time[FIGURE_TEXT / 2], text[FIGURE_TEXT];

    add_number(f, COLOUR_TEXT, "step", s->settings.step, unit);
    add_count(f, "substeps", s->settings.substeps);
    add_gap(f);
    format_time(time, sizeof time, s, &s->main);
    snprintf(text, sizeof text, "%s%s", time, ended ? ", end: R restarts" : "");
    add_row(f, ended ? COLOUR_WARNING : COLOUR_TEXT, "time", text);
    add_count(f, "ticks", stf_world_ticks(s->main.world));
    if (!still)
        add_pace(f, s);
    add_gap(f);
}

void figures_of_session(figures *f, const session *s, bool still)
{
    f->count = 0;
    add_integrator(f, "integrator", s->settings.integrator, COLOUR_MAIN);
    add_time(f, s, still);
    figures_add_measured(f, s, &s->main);
    if (!s->ghost.world)
        return;
    add_gap(f);
    add_integrator(f, "ghost", s->settings.ghost, COLOUR_GHOST);
    figures_add_measured(f, s, &s->ghost);
}
