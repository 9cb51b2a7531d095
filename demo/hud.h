/* hud: what is measured, in words and aligned columns, and the panel that lists the keys. */
#ifndef STEADFAST_DEMO_HUD_H
#define STEADFAST_DEMO_HUD_H

#include "draw.h"
#include "session.h"

#define HUD_ROWS_MAX 28
#define HUD_TEXT 64

typedef struct hud_row {
    SDL_Color colour; /* of the value */
    char label[24], value[HUD_TEXT];
} hud_row;

/* The rows are kept, so that they can be renewed less often than they are drawn: digits that flicker can't be read. */
typedef struct hud {
    int count;
    hud_row rows[HUD_ROWS_MAX]; /* without a label and value: a gap */
} hud;

void hud_refresh(hud *h, const session *s);

/* Returns the y below the panel. */
double hud_draw(canvas *c, const hud *h, const session *s);

/* What is left beside the panel, if it is shown, and above the line of keys. */
SDL_FRect hud_free_area(const canvas *c, bool shown);

/* Lost particles, and whatever is to be said for a moment (NULL: nothing), in panels from y on. */
void hud_draw_messages(canvas *c, const session *s, double y, const char *message);

/* The line at the bottom. */
void hud_draw_hints(canvas *c);

/* All keys, over everything. */
void hud_draw_help(canvas *c);

#endif
