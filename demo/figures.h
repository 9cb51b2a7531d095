/* figures: what is set and measured, in words: rows of a label and a value, for the panel and the summary of a script alike. */
#ifndef STEADFAST_DEMO_FIGURES_H
#define STEADFAST_DEMO_FIGURES_H

#include "session.h"

#define FIGURES_MAX 32
#define FIGURE_TEXT 64

typedef struct figure {
    SDL_Color colour; /* of the value */
    char label[24], value[FIGURE_TEXT]; /* without a label: goes on from the row above; without both: a gap */
} figure;

typedef struct figures {
    int count;
    figure rows[FIGURES_MAX];
} figures;

/* All of them. `still`: without those that mean something only while time passes. */
void figures_of_session(figures *f, const session *s, bool still);

/* Adds what is measured of one of the session's actors. */
void figures_add_measured(figures *f, const session *s, const actor *a);

/* "order 4, 4 accelerations a step", less the first word. */
void format_order(char *text, size_t size, const stf_integrator *integrator);

/* What happened to a lost actor: "particle 3 left the finite numbers at tick 7 (0.12 s)". */
void format_loss(char *text, size_t size, const session *s, const actor *a);

#endif
