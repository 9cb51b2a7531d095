/* camera: which lengths of a scene are where on the canvas. A parallel projection of three dimensions. */
#ifndef STEADFAST_DEMO_CAMERA_H
#define STEADFAST_DEMO_CAMERA_H

#include <SDL.h>

#include "scenes/scene.h"

/* How the user looks at a scene; kept when the window changes its size. */
typedef struct look {
    double right[3], up[3];  /* unit vectors: where the canvas's axes point in the scene */
    double centre_x, centre_y; /* what is in the middle, along right and up, length units */
    double zoom;             /* 1: all of the scene */
} look;

typedef struct camera {
    look look;
    SDL_FRect area;          /* px */
    double scale;            /* px a length unit */
} camera;

typedef struct point {
    double x, y;
} point;

/* The view that the scene asks for; one in three dimensions is turned to show its depth, or, without gravity, to face
   the plane that it moves in. */
look look_at_scene(const scene *s, const stf_world *world);

camera camera_make(const scene *s, const look *l, SDL_FRect area);

/* px */
point camera_project(const camera *c, const double position[3]);
point camera_project_vector(const camera *c, stf_vector position);

/* The position that is that many pixels from `from` on the canvas, at the same depth, in `dimensions` dimensions. */
stf_vector camera_move(const camera *c, stf_vector from, double pixels_x, double pixels_y, unsigned dimensions);

/* Changes the look so that the pixel (x, y) keeps what it shows. */
void look_zoom(look *l, const camera *c, double factor, double x, double y);
void look_pan(look *l, const camera *c, double pixels_x, double pixels_y);

#endif
