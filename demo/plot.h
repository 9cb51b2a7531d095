/* plot: curves over axes. */
#ifndef STEADFAST_DEMO_PLOT_H
#define STEADFAST_DEMO_PLOT_H

#include "camera.h"
#include "draw.h"

typedef struct axis {
    double from, to, tick; /* tick: the distance of two labels, which stand at its multiples */
    const char *label;     /* with its unit: "t, s" */
} axis;

typedef struct plot {
    SDL_FRect area; /* px, inside the axes */
    double left;    /* px, of the title */
    axis x, y;
} plot;

/* A plot whose axes, labels and title fill `box`. */
plot plot_make(const canvas *c, SDL_FRect box, axis x, axis y);

void plot_axes(canvas *c, const plot *p, const char *title);

point plot_at(const plot *p, double x, double y);

/* Joins points by straight lines, `dash` pixels with as many between, or whole if dash is 0. Nothing leaves the area. */
void plot_curve(canvas *c, const plot *p, const point *points, size_t count, float width, double dash, SDL_Color colour);

#endif
