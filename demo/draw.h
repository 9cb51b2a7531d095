/*
 * draw: anti-aliased shapes and text on any SDL renderer, the software one included.
 *
 * Every shape has a feather: a rim one pixel wide that fades out, as vertex colours of SDL_RenderGeometry. Coordinates
 * are pixels, y down. Anything may be drawn anywhere: what is off the canvas or not finite is left out.
 */
#ifndef STEADFAST_DEMO_DRAW_H
#define STEADFAST_DEMO_DRAW_H

#include "canvas.h"

/* Okabe and Ito's colours, which the colour-blind can tell apart, on a dark ground. */
#define COLOUR_GROUND   ((SDL_Color){0x11, 0x15, 0x1c, 0xff})
#define COLOUR_PANEL    ((SDL_Color){0x1c, 0x22, 0x2d, 0xe0})
#define COLOUR_TEXT     ((SDL_Color){0xe9, 0xed, 0xf2, 0xff})
#define COLOUR_MUTED    ((SDL_Color){0x93, 0x9d, 0xac, 0xff})
#define COLOUR_GRID     ((SDL_Color){0x2b, 0x33, 0x40, 0xff})
#define COLOUR_MAIN     ((SDL_Color){0x56, 0xb4, 0xe9, 0xff}) /* sky blue */
#define COLOUR_GHOST    ((SDL_Color){0xe6, 0x9f, 0x00, 0xff}) /* orange */
#define COLOUR_EXACT    ((SDL_Color){0xc9, 0xcf, 0xd8, 0xff})
#define COLOUR_ATTRACTOR ((SDL_Color){0xf0, 0xe4, 0x42, 0xff}) /* yellow */
#define COLOUR_MARKER   ((SDL_Color){0xf0, 0xe4, 0x42, 0xff})
#define COLOUR_STEADY   ((SDL_Color){0x3f, 0xc9, 0x9a, 0xff}) /* bluish green, lightened */
#define COLOUR_CLOSE    ((SDL_Color){0xff, 0xc1, 0x4d, 0xff}) /* amber */
#define COLOUR_UNSTEADY ((SDL_Color){0xff, 0x6e, 0x6e, 0xff}) /* red, lightened */
#define COLOUR_WARNING  ((SDL_Color){0xff, 0x8a, 0x3d, 0xff}) /* vermillion, lightened for small text */

SDL_Color faded(SDL_Color colour, double opacity);

void draw_line(canvas *c, double x0, double y0, double x1, double y1, float width, SDL_Color colour);

/* Radius 0: sharp corners. */
void draw_box(canvas *c, SDL_FRect box, float radius, SDL_Color colour);
void draw_box_outline(canvas *c, SDL_FRect box, float radius, float width, SDL_Color colour);
void draw_disc(canvas *c, double x, double y, float radius, SDL_Color colour);
void draw_ring(canvas *c, double x, double y, float radius, float width, SDL_Color colour);

/* Across and down; `reach` is half of each arm. */
void draw_cross(canvas *c, double x, double y, float reach, float width, SDL_Color colour);

typedef enum text_align { ALIGN_LEFT, ALIGN_CENTRE, ALIGN_RIGHT } text_align;

/* The top of the line is at y; x is its left, centre or right. */
void draw_text(canvas *c, text_size size, text_align align, double x, double y, SDL_Color colour, const char *text);

#endif
