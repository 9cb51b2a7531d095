/* app: the window. */
#ifndef STEADFAST_DEMO_APP_H
#define STEADFAST_DEMO_APP_H

#include "frame.h"
#include "grab.h"
#include "options.h"

#define MESSAGE_TEXT 160

typedef struct app {
    SDL_Window *window;
    SDL_Renderer *renderer;
    canvas *canvas;
    session session;
    frame frame;
    const stf_integrator *ghost; /* the last one asked for, or NULL */
    grab grab;
    double pointer_x, pointer_y; /* px of the canvas */
    const char *out;             /* the folder of pictures */
    char message[MESSAGE_TEXT];
    double message_seconds;      /* that it stays */
    double hud_age;              /* s since the figures were renewed */
    double stability_age;        /* s since the stability was looked at */
    bool running, save_asked;
} app;

/* Whether there is a display that a window would be seen on. If so SDL's video is up: SDL_Quit when done. */
bool app_find_display(void);

/* Runs the window until the user quits. Returns the exit status. */
int app_run(const options *o);

/* Starts over with these settings; if that fails, says so and goes on as before. */
void app_restart(app *a, const settings *chosen);

/* Shows a line for a moment. */
void app_say(app *a, const char *text);

/* Says what went wrong, if anything did. */
void app_check(app *a, stf_result result);

#endif
