/* canvas: what is drawn on: an SDL renderer, fonts of the right size, and a batch of triangles on their way to it. */
#ifndef STEADFAST_DEMO_CANVAS_H
#define STEADFAST_DEMO_CANVAS_H

#include <SDL.h>
#include <stdbool.h>

#include "text.h"

/*
 * SDL's software renderer puts the corners of triangles on whole pixels. There a picture is drawn larger and halved: 2
 * samples across and down a pixel where it has to be quick, 4 where not. Graphics hardware needs 1.
 */
#define SAMPLES_QUICK 2
#define SAMPLES_FINE 4
#define SAMPLES_LEVELS 2 /* log2 of the most */

#define BATCH_VERTICES 6144
#define BATCH_INDICES  (3 * BATCH_VERTICES)

typedef struct canvas {
    SDL_Renderer *renderer;
    int width, height; /* px, of samples where there are more than one a pixel */
    int samples;       /* across and down a pixel */
    SDL_Texture *targets[SAMPLES_LEVELS]; /* that samples are drawn to, then halved to, on their way to pixels */
    float unit;        /* px that a layout length of 1 takes: 1 at 1280 x 720 */
    font fonts[TEXT_SIZE_COUNT];
    int vertex_count, index_count;
    SDL_Vertex vertices[BATCH_VERTICES];
    int indices[BATCH_INDICES];
} canvas;

/* NULL without memory. The renderer stays the caller's. `samples` are taken if it is a software renderer. */
canvas *canvas_create(SDL_Renderer *renderer, int samples);
void canvas_destroy(canvas *c);

/* Starts a picture: learns the size, loads the fonts that suit it, clears. False: no font, and SDL_GetError says why. */
bool canvas_begin(canvas *c);

/* Hands what is batched to the renderer: to be called before the renderer is used past the batch. */
void canvas_flush(canvas *c);

/* Ends a picture: all of it is in the renderer, to be presented. False: SDL_GetError. */
bool canvas_end(canvas *c);

/* Textures are gone (the device was reset): makes them anew with the next picture. */
void canvas_forget_textures(canvas *c);

/* Nothing is drawn outside of `area` any more; NULL: everywhere again. */
void canvas_clip(canvas *c, const SDL_FRect *area);

#endif
