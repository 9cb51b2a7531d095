/* hud: the panels beside the scene: figures, messages, the keys. */
#ifndef STEADFAST_DEMO_HUD_H
#define STEADFAST_DEMO_HUD_H

#include "draw.h"
#include "figures.h"

/* Returns the y below the panel. */
double hud_draw(canvas *c, const figures *f, const session *s);

/* What is left beside the panel, if it is shown, and above the line of keys. */
SDL_FRect hud_free_area(const canvas *c, bool shown);

/* A lost particle, and whatever is to be said for a moment (NULL: nothing), in panels from y on. Returns the y below them. */
double hud_draw_messages(canvas *c, const session *s, double y, bool still, const char *message);

/* The line at the bottom; none where the panels, which end at panels_end, reach into it. */
void hud_draw_hints(canvas *c, const session *s, double panels_end);

/* All keys, over everything. */
void hud_draw_help(canvas *c);

#endif
