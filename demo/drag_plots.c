#include "drag_plots.h"

#include <math.h>
#include <stdio.h>

#define GAP 12.0f          /* layout length between plots */
#define MOST_VELOCITY 1.4  /* of the axis, in speeds at the start */
#define EXACT_POINTS 200
#define SAME_STEP 1e-6     /* relative */

static const double plot_steps[DRAG_PLOTS] = {0.2, 0.8, 1.6, 2.4}; /* the lecture's, in s */

static stf_result run(drag_curve *curve, const settings *chosen, const stf_integrator *integrator, double step)
{
    const stf_world_def def = {.integrator = integrator, .step = step, .substeps = chosen->substeps};
    stf_world *world;
    stf_result bad = scene_create(chosen->scene, &def, &world);

    curve->count = 0;
    if (bad)
        return bad;
    while (!bad && curve->count < DRAG_POINTS_MAX) {
        stf_particle particle;
        bad = stf_world_get(world, 0, &particle);
        if (bad || !isfinite(particle.velocity.x))
            break;
        curve->points[curve->count++] = (point){stf_world_time(world), (double)particle.velocity.x};
        if (stf_world_time(world) > chosen->scene->duration - step / 2)
            break;
        bad = stf_world_step(world, 1);
    }
    stf_world_destroy(world);
    return bad;
}

stf_result drag_plots_run(drag_plots *d, const settings *chosen)
{
    stf_result bad = STF_OK;

    for (size_t i = 0; i < DRAG_PLOTS && !bad; i++) {
        d->ghost[i].count = 0;
        bad = run(&d->main[i], chosen, chosen->integrator, plot_steps[i]);
        if (!bad && chosen->ghost)
            bad = run(&d->ghost[i], chosen, chosen->ghost, plot_steps[i]);
    }
    return bad;
}

static void draw_exact(canvas *c, const plot *p, const scene *of)
{
    point points[EXACT_POINTS];

    for (size_t i = 0; i < EXACT_POINTS; i++) {
        double position[3], velocity[3];
        points[i].x = of->duration * (double)i / (EXACT_POINTS - 1);
        points[i].y = of->exact(0, points[i].x, position, velocity) ? velocity[0] : (double)NAN;
    }
    plot_curve(c, p, points, EXACT_POINTS, 1.5f * c->unit, 5 * (double)c->unit, COLOUR_EXACT);
}

static void draw_curve(canvas *c, const plot *p, const drag_curve *curve, bool ghost)
{
    const double dash = ghost ? 9 * (double)c->unit : 0;

    plot_curve(c, p, curve->points, curve->count, 2 * c->unit, dash, ghost ? COLOUR_GHOST : COLOUR_MAIN);
    canvas_clip(c, &p->area);
    for (size_t i = 0; i < curve->count; i++) {
        const point at = plot_at(p, curve->points[i].x, curve->points[i].y);
        if (ghost)
            draw_ring(c, at.x, at.y, 4.5f * c->unit, 1.5f * c->unit, COLOUR_GHOST);
        else
            draw_disc(c, at.x, at.y, 3.5f * c->unit, COLOUR_MAIN);
    }
    canvas_clip(c, NULL);
}

static void draw_marker(canvas *c, const plot *p, const session *s)
{
    const double gap = 6 * (double)c->unit, time = stf_world_time(s->main.world);
    stf_particle particle;

    if (time > p->x.to || stf_world_get(s->main.world, 0, &particle) || !isfinite(particle.velocity.x))
        return;
    const point at = plot_at(p, time, (double)particle.velocity.x);
    const bool right = time < (p->x.from + p->x.to) / 2; /* of the line there is room */
    const double top = (double)p->area.y, bottom = top + (double)p->area.h;
    draw_line(c, at.x, top, at.x, bottom, c->unit, faded(COLOUR_MARKER, 0.5));
    if (at.y > top && at.y < bottom)
        draw_ring(c, at.x, at.y, 7 * c->unit, 2 * c->unit, COLOUR_MARKER);
    draw_text(c, TEXT_SMALL, right ? ALIGN_LEFT : ALIGN_RIGHT, at.x + (right ? gap : -gap), top, COLOUR_MARKER, "now");
}

static void format_title(char *title, size_t size, double step, unsigned substeps)
{
    const int length = snprintf(title, size, "Δt = %.1f s", step);

    if (substeps > 1)
        snprintf(title + length, size - (size_t)length, " ÷ %u", substeps);
}

static double largest_error(const scene *of, const drag_curve *curve)
{
    double largest = 0, position[3], velocity[3];

    for (size_t i = 0; i < curve->count; i++)
        if (of->exact(0, curve->points[i].x, position, velocity))
            largest = fmax(largest, fabs(curve->points[i].y - velocity[0]));
    return largest;
}

/* In the line-th line above the plot, beside a title in the first; in few words where it is narrow. */
static void draw_error(canvas *c, const plot *p, const char *title, double error, int line, SDL_Color colour)
{
    const font *f = &c->fonts[TEXT_SMALL];
    const double u = (double)c->unit, right = (double)(p->area.x + p->area.w);
    const double room = right - p->left - font_width(&c->fonts[TEXT_BODY], title) - 12 * u;
    char number[32], text[64];

    format_number(number, sizeof number, error);
    snprintf(text, sizeof text, "largest error %s m/s", number);
    if (font_width(f, text) > room)
        snprintf(text, sizeof text, "%s m/s", number);
    draw_text(c, TEXT_SMALL, ALIGN_RIGHT, right, (double)p->area.y - line * f->height - 5 * u, colour, text);
}

static void draw_errors(canvas *c, const plot *p, const char *title, const scene *of, const drag_curve *curve,
                        const drag_curve *ghost)
{
    draw_error(c, p, title, largest_error(of, curve), ghost->count > 0 ? 2 : 1, COLOUR_MAIN);
    if (ghost->count > 0)
        draw_error(c, p, title, largest_error(of, ghost), 1, COLOUR_GHOST);
}

void drag_plots_draw(canvas *c, const drag_plots *d, const session *s, SDL_FRect box)
{
    const scene *of = s->settings.scene;
    const float gap = GAP * c->unit, w = (box.w - gap) / 2, h = (box.h - gap) / 2;
    const axis time = {.from = 0, .to = of->duration * 1.04, .tick = 2, .label = "t, s"};
    const axis velocity = {.from = -MOST_VELOCITY, .to = MOST_VELOCITY, .tick = 0.5, .label = "v, m/s"};

    for (size_t i = 0; i < DRAG_PLOTS; i++) {
        const SDL_FRect cell = {box.x + (float)(i % 2) * (w + gap), box.y + (float)(i / 2) * (h + gap), w, h};
        const plot p = plot_make(c, cell, time, velocity);

        char title[64];

        format_title(title, sizeof title, plot_steps[i], s->settings.substeps);
        plot_axes(c, &p, title);
        draw_errors(c, &p, title, of, &d->main[i], &d->ghost[i]);
        draw_exact(c, &p, of);
        draw_curve(c, &p, &d->ghost[i], true);
        draw_curve(c, &p, &d->main[i], false);
        if (fabs(s->settings.step - plot_steps[i]) <= SAME_STEP * plot_steps[i])
            draw_marker(c, &p, s);
    }
}
