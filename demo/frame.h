/* frame: one whole picture of a session, in the window and off screen alike; and pictures as files. */
#ifndef STEADFAST_DEMO_FRAME_H
#define STEADFAST_DEMO_FRAME_H

#include "camera.h"
#include "drag_plots.h"
#include "draw.h"
#include "hud.h"
#include "session.h"
#include "stage.h"

typedef struct frame {
    look look;
    figures figures; /* kept, so that they can be renewed less often than drawn: digits that flicker can't be read */
    drag_plots plots; /* of the drag scene only */
    bool still; /* no window: time and keys mean nothing */
    bool show_hud, show_hints, show_help;
    const char *message; /* or NULL */
    const grab *hand;    /* or NULL */
} frame;

/* To be called when a session has (re)started. Keeps the look if the scene is the same, as `keep_look` says. */
stf_result frame_start(frame *f, const session *s, bool keep_look);

/* Where the scene is drawn. */
camera frame_camera(const canvas *c, const frame *f, const session *s);

/* Draws everything; the caller presents it. False: SDL_GetError says why. */
bool frame_draw(canvas *c, const frame *f, session *s);

/* Draws one frame off screen, with no video system at all, and saves it. False: SDL_GetError says why. */
bool frame_save(frame *f, session *s, int width, int height, const char *path);

/* Writes a surface as PNG, and looks whether all of it arrived. False: SDL_GetError says why. */
bool save_png(SDL_Surface *surface, const char *path);

/* Whether a file can be written there; makes an empty one if there is none. */
bool is_writable(const char *path);

#endif
