/*
 * drag_plots: the lecture's plots of v against t under linear drag, one for each of its steps: the exact curve, and the
 * points that an integrator makes, joined by straight lines. Each plot has a world of its own.
 */
#ifndef STEADFAST_DEMO_DRAG_PLOTS_H
#define STEADFAST_DEMO_DRAG_PLOTS_H

#include "plot.h"
#include "session.h"

#define DRAG_PLOTS 4
#define DRAG_POINTS_MAX 64

typedef struct drag_curve {
    size_t count;
    point points[DRAG_POINTS_MAX]; /* time and velocity */
} drag_curve;

typedef struct drag_plots {
    drag_curve main[DRAG_PLOTS], ghost[DRAG_PLOTS]; /* no points without a ghost */
} drag_plots;

/* Runs the worlds of all plots with the integrators and substeps of these settings. */
stf_result drag_plots_run(drag_plots *d, const settings *chosen);

/* With a marker for the session's own world in the plot of its step, if there is one. */
void drag_plots_draw(canvas *c, const drag_plots *d, const session *s, SDL_FRect box);

#endif
