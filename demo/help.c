/* The panel that lists the keys. */
#include <stdio.h>

#include "hud.h"

/* Layout lengths. */
#define WIDTH 760.0
#define LINE 23.0
#define PADDING 26.0
#define KEY_COLUMN 190.0
#define LIST_COLUMN 500.0
#define CORNER 10.0f

typedef struct key_help {
    const char *key, *does;
} key_help;

static const key_help keys[] = {
    {"[  ]", "scene before, after"},
    {"digit", "integrator"},
    {"G", "ghost: a second integrator"},
    {"Shift digit", "integrator of the ghost"},
    {"P, Space", "pause"},
    {"O", "one step, then pause"},
    {"R", "restart"},
    {"+  −", "time runs faster, slower"},
    {",  .", "halve, double the step"},
    {";  '", "fewer, more substeps"},
    {"A", "substeps as advised"},
    {"left drag", "pull a particle"},
    {"wheel, right drag", "zoom, move the view"},
    {"V", "the scene's own view"},
    {"H", "hide or show the figures"},
    {"F12", "save a picture"},
    {"F1", "this panel"},
    {"Esc", "quit"},
};

#define KEYS (sizeof keys / sizeof *keys)

static void draw_integrators(canvas *c, double x, double y)
{
    const double u = (double)c->unit;
    char line[64];

    draw_text(c, TEXT_BODY, ALIGN_LEFT, x, y, COLOUR_TEXT, "Integrators");
    for (int i = 0; stf_integrators[i]; i++) {
        y += LINE * u;
        snprintf(line, sizeof line, "%d", i + 1);
        draw_text(c, TEXT_BODY, ALIGN_LEFT, x, y, COLOUR_MAIN, line);
        draw_text(c, TEXT_BODY, ALIGN_LEFT, x + 24 * u, y, COLOUR_MUTED, stf_integrators[i]->name);
    }
}

void hud_draw_help(canvas *c)
{
    const double u = (double)c->unit, height = (2 * PADDING + 34 + LINE * (KEYS + 3) + 8) * u;
    const double left = (c->width - WIDTH * u) / 2, top = (c->height - height) / 2;
    const double x = left + PADDING * u;
    double y = top + PADDING * u;
    const SDL_FRect panel = {(float)left, (float)top, (float)(WIDTH * u), (float)height};
    const SDL_Color ground = {COLOUR_PANEL.r, COLOUR_PANEL.g, COLOUR_PANEL.b, 0xf6};

    draw_box(c, (SDL_FRect){0, 0, (float)c->width, (float)c->height}, 0, faded(COLOUR_GROUND, 0.6));
    draw_box(c, panel, CORNER * c->unit, ground);
    draw_text(c, TEXT_TITLE, ALIGN_LEFT, x, y, COLOUR_TEXT, "Keys");
    y += 34 * u;
    draw_integrators(c, left + LIST_COLUMN * u, y);
    for (size_t i = 0; i < KEYS; i++, y += LINE * u) {
        draw_text(c, TEXT_BODY, ALIGN_LEFT, x, y, COLOUR_MAIN, keys[i].key);
        draw_text(c, TEXT_BODY, ALIGN_LEFT, x + KEY_COLUMN * u, y, COLOUR_TEXT, keys[i].does);
    }
    draw_text(c, TEXT_SMALL, ALIGN_LEFT, x, y + 8 * u, COLOUR_MUTED,
              "Another integrator, ghost, step or substeps starts the scene over: all figures are of one setting.");
    draw_text(c, TEXT_SMALL, ALIGN_LEFT, x, y + (8 + LINE) * u, COLOUR_MUTED,
              "Energies are looked at once a frame: what is largest in between is not seen.");
    draw_text(c, TEXT_SMALL, ALIGN_LEFT, x, y + (8 + 2 * LINE) * u, COLOUR_MUTED,
              "Cost is of ticks between frames, with cold caches; --headless runs them in a row and shows it warm.");
}
