#include "plot.h"

#include <math.h>

/* Layout lengths around the area. */
#define LEFT 56.0f
#define RIGHT 10.0f
#define ABOVE 42.0f /* two lines of text */
#define BELOW 30.0f
#define TICK_GAP 6.0

plot plot_make(const canvas *c, SDL_FRect box, axis x, axis y)
{
    const float u = c->unit;

    return (plot){.area = {box.x + LEFT * u, box.y + ABOVE * u, box.w - (LEFT + RIGHT) * u, box.h - (ABOVE + BELOW) * u},
                  .left = (double)box.x,
                  .x = x,
                  .y = y};
}

point plot_at(const plot *p, double x, double y)
{
    return (point){(double)p->area.x + (x - p->x.from) / (p->x.to - p->x.from) * (double)p->area.w,
                   (double)(p->area.y + p->area.h) - (y - p->y.from) / (p->y.to - p->y.from) * (double)p->area.h};
}

static SDL_Color grid_colour(long n) { return n == 0 ? faded(COLOUR_MUTED, 0.8) : COLOUR_GRID; }

static void draw_x_ticks(canvas *c, const plot *p)
{
    const double top = (double)p->area.y, bottom = top + (double)p->area.h;
    const font *f = &c->fonts[TEXT_SMALL];
    const double label_left = (double)(p->area.x + p->area.w) - font_width(f, p->x.label) - TICK_GAP * (double)c->unit;
    char text[32];

    for (long n = (long)ceil(p->x.from / p->x.tick); (double)n * p->x.tick <= p->x.to; n++) {
        const double x = plot_at(p, (double)n * p->x.tick, 0).x;
        draw_line(c, x, top, x, bottom, c->unit, grid_colour(n));
        format_number(text, sizeof text, (double)n * p->x.tick);
        if (x + font_width(f, text) / 2.0 < label_left)
            draw_text(c, TEXT_SMALL, ALIGN_CENTRE, x, bottom + TICK_GAP * (double)c->unit, COLOUR_MUTED, text);
    }
}

static void draw_y_ticks(canvas *c, const plot *p)
{
    const double left = (double)p->area.x, right = left + (double)p->area.w;
    char text[32];

    for (long n = (long)ceil(p->y.from / p->y.tick); (double)n * p->y.tick <= p->y.to; n++) {
        const double y = plot_at(p, 0, (double)n * p->y.tick).y;
        draw_line(c, left, y, right, y, c->unit, grid_colour(n));
        format_number(text, sizeof text, (double)n * p->y.tick);
        draw_text(c, TEXT_SMALL, ALIGN_RIGHT, left - TICK_GAP * (double)c->unit, y - c->fonts[TEXT_SMALL].height / 2.0,
                  COLOUR_MUTED, text);
    }
}

void plot_axes(canvas *c, const plot *p, const char *title)
{
    const double u = (double)c->unit, left = (double)p->area.x, right = left + (double)p->area.w;
    const double title_y = (double)p->area.y - c->fonts[TEXT_BODY].height - 4 * u;

    draw_x_ticks(c, p);
    draw_y_ticks(c, p);
    draw_text(c, TEXT_BODY, ALIGN_LEFT, p->left, title_y, COLOUR_TEXT, title);
    draw_text(c, TEXT_SMALL, ALIGN_RIGHT, left - TICK_GAP * u, (double)p->area.y, COLOUR_MUTED, p->y.label);
    draw_text(c, TEXT_SMALL, ALIGN_RIGHT, right, (double)(p->area.y + p->area.h) + TICK_GAP * u, COLOUR_MUTED, p->x.label);
}

/* One line of a curve that is `along` pixels long so far. */
static void draw_dashes(canvas *c, point a, point b, float width, double dash, double along, SDL_Color colour)
{
    const double length = hypot(b.x - a.x, b.y - a.y);
    double at = 0;

    while (at < length) {
        const double phase = fmod(along + at, 2 * dash), end = fmin(length, at + (phase < dash ? dash : 2 * dash) - phase);
        const double from = at / length, to = end / length;
        if (phase < dash)
            draw_line(c, a.x + from * (b.x - a.x), a.y + from * (b.y - a.y), a.x + to * (b.x - a.x), a.y + to * (b.y - a.y),
                      width, colour);
        at = end > at ? end : length;
    }
}

void plot_curve(canvas *c, const plot *p, const point *points, size_t count, float width, double dash, SDL_Color colour)
{
    const double longest = 8.0 * (c->width + c->height); /* what is longer has blown up: it is drawn whole */
    double along = 0;

    canvas_clip(c, &p->area);
    for (size_t i = 1; i < count; i++) {
        const point a = plot_at(p, points[i - 1].x, points[i - 1].y), b = plot_at(p, points[i].x, points[i].y);
        const double length = hypot(b.x - a.x, b.y - a.y);
        if (dash > 0 && length < longest)
            draw_dashes(c, a, b, width, dash, along, colour);
        else
            draw_line(c, a.x, a.y, b.x, b.y, width, colour);
        along = length < longest ? fmod(along + length, 2 * dash + (dash > 0 ? 0 : 1)) : 0;
    }
    canvas_clip(c, NULL);
}
