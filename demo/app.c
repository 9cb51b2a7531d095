#include "app.h"

#include <SDL_image.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "controls.h"

#define WINDOW_WIDTH 1280
#define WINDOW_HEIGHT 720
#define HUD_PERIOD 0.15     /* s */
#define STABILITY_PERIOD 0.5 /* s: a look takes milliseconds for a cloth */
#define MESSAGE_SECONDS 3.0
#define DEFAULT_REFRESH 60  /* Hz, where the display doesn't say */
#define PICTURES_MAX 1000
#define PATH_MAX_LENGTH 4096

bool app_find_display(void)
{
#if defined(__linux__)
    const char *x11 = getenv("DISPLAY"), *wayland = getenv("WAYLAND_DISPLAY"), *asked = getenv("SDL_VIDEODRIVER");

    if (!(x11 && *x11) && !(wayland && *wayland) && !(asked && *asked))
        return false;
#endif
    if (SDL_Init(SDL_INIT_VIDEO) != 0)
        return false;

    const char *driver = SDL_GetCurrentVideoDriver();
    if (driver && strcmp(driver, "dummy") != 0 && strcmp(driver, "offscreen") != 0)
        return true;
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
    return false;
}

void app_say(app *a, const char *text)
{
    snprintf(a->message, sizeof a->message, "%s", text);
    a->message_seconds = MESSAGE_SECONDS;
}

void app_check(app *a, stf_result result)
{
    if (result != STF_OK)
        app_say(a, stf_result_text(result));
}

void app_restart(app *a, const settings *chosen)
{
    const bool same = a->session.settings.scene == chosen->scene;

    const stf_result bad = session_start(&a->session, chosen);

    if (bad) {
        app_check(a, bad);
        return;
    }
    a->message_seconds = 0;
    a->grab = (grab){0}; /* its forces went with the worlds */
    app_check(a, frame_start(&a->frame, &a->session, same));
}

static double display_period(SDL_Window *window)
{
    SDL_DisplayMode mode;

    if (SDL_GetCurrentDisplayMode(SDL_GetWindowDisplayIndex(window), &mode) != 0 || mode.refresh_rate <= 0)
        return 0;
    return 1.0 / mode.refresh_rate;
}

/* The path of the first picture that isn't there yet. False: all numbers are taken. */
static bool find_free_path(const app *a, char *path, size_t size)
{
    for (int n = 1; n < PICTURES_MAX; n++) {
        snprintf(path, size, "%s%ssteadfast-%s-%03d.png", a->out ? a->out : "", a->out ? "/" : "",
                 a->session.settings.scene->name, n);
        FILE *there = fopen(path, "rb");
        if (!there)
            return true;
        fclose(there);
    }
    return false;
}

static bool save_pixels(const app *a, const char *path)
{
    const int width = a->canvas->width / a->canvas->samples, height = a->canvas->height / a->canvas->samples;
    SDL_Surface *pixels = SDL_CreateRGBSurfaceWithFormat(0, width, height, 32, SDL_PIXELFORMAT_ARGB8888);
    const bool saved = pixels &&
                       SDL_RenderReadPixels(a->renderer, NULL, SDL_PIXELFORMAT_ARGB8888, pixels->pixels, pixels->pitch) == 0 &&
                       save_png(pixels, path);

    SDL_FreeSurface(pixels);
    return saved;
}

/* Saves what has been drawn and not been presented yet. */
static void save_picture(app *a)
{
    char path[PATH_MAX_LENGTH], text[MESSAGE_TEXT];

    a->save_asked = false;
    if (!find_free_path(a, path, sizeof path)) {
        app_say(a, "no picture saved: remove some of the old ones first");
    } else if (!save_pixels(a, path)) {
        snprintf(text, sizeof text, "no picture saved: %.100s", SDL_GetError());
        app_say(a, text);
    } else {
        printf("%s\n", path);
        fflush(stdout);
        snprintf(text, sizeof text, "saved %.100s", path);
        app_say(a, text);
    }
}

static void advance(app *a, double seconds)
{
    char text[MESSAGE_TEXT];

    app_check(a, grab_follow(&a->grab, &a->session, seconds));
    app_check(a, session_advance(&a->session, seconds));
    if (a->session.clock.dropped_this_frame > 0 && !a->session.main.lost) {
        snprintf(text, sizeof text, "long frame: %.3g %s dropped", a->session.clock.dropped_this_frame,
                 a->session.settings.scene->time_unit);
        app_say(a, text);
    }
    a->message_seconds -= seconds;
    a->frame.message = a->message_seconds > 0 ? a->message : NULL;
    a->hud_age += seconds;
    a->stability_age += seconds;
    if (a->stability_age >= STABILITY_PERIOD) {
        (void)session_look_at_stability(&a->session); /* what is not finite any more keeps its last figures */
        a->stability_age = 0;
    }
    if (a->hud_age >= HUD_PERIOD) {
        figures_of_session(&a->frame.figures, &a->session, false);
        a->hud_age = 0;
    }
}

/* Some drivers don't wait for the display: a frame takes at least its period, so that the processor rests. */
static void wait_for_period(Uint64 frame_start, double period)
{
    const double rest = period - (double)(SDL_GetPerformanceCounter() - frame_start) / (double)SDL_GetPerformanceFrequency();

    if (rest > 0.001)
        SDL_Delay((Uint32)(rest * 1000));
}

static int loop(app *a)
{
    const double frequency = (double)SDL_GetPerformanceFrequency();
    const double period = a->session.display_period > 0 ? a->session.display_period : 1.0 / DEFAULT_REFRESH;
    Uint64 before = SDL_GetPerformanceCounter();

    figures_of_session(&a->frame.figures, &a->session, false);
    for (a->running = true; a->running;) {
        const Uint64 now = SDL_GetPerformanceCounter();
        SDL_Event event;

        while (SDL_PollEvent(&event))
            controls_handle(a, &event);
        advance(a, (double)(now - before) / frequency);
        before = now;
        if (!frame_draw(a->canvas, &a->frame, &a->session)) {
            fprintf(stderr, "demo: can't draw: %s\n", SDL_GetError());
            return EXIT_FAILURE;
        }
        if (a->save_asked)
            save_picture(a);
        SDL_RenderPresent(a->renderer);
        wait_for_period(now, period);
    }
    return EXIT_SUCCESS;
}

static bool open_window(app *a, const options *o)
{
    a->window = SDL_CreateWindow("Steadfast", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                 o->width ? o->width : WINDOW_WIDTH, o->height ? o->height : WINDOW_HEIGHT,
                                 SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    if (!a->window)
        return false;
    SDL_SetWindowMinimumSize(a->window, WIDTH_MIN, HEIGHT_MIN);
    a->renderer = SDL_CreateRenderer(a->window, -1, SDL_RENDERER_PRESENTVSYNC);
    a->canvas = a->renderer ? canvas_create(a->renderer, SAMPLES_QUICK) : NULL;
    return a->canvas && canvas_begin(a->canvas);
}

static void close_window(app *a)
{
    canvas_destroy(a->canvas);
    if (a->renderer)
        SDL_DestroyRenderer(a->renderer);
    if (a->window)
        SDL_DestroyWindow(a->window);
}

int app_run(const options *o)
{
    app a = {.frame = {.show_hud = true, .show_hints = true}, .out = o->out, .session = {.speed = 1}};
    settings chosen = o->settings;
    int status = EXIT_FAILURE;

    a.ghost = chosen.ghost;
    a.frame.hand = &a.grab;
    if (!chosen.scene)
        chosen.scene = scenes[0];
    if (!open_window(&a, o)) {
        fprintf(stderr, "demo: %s\n", SDL_GetError());
    } else {
        a.session.display_period = display_period(a.window);
        const stf_result bad = session_start(&a.session, &chosen);
        if (bad) {
            fprintf(stderr, "demo: the scene can't be made: %s\n", stf_result_text(bad));
        } else {
            app_check(&a, frame_start(&a.frame, &a.session, false));
            status = loop(&a);
        }
    }
    session_close(&a.session);
    close_window(&a);
    return status;
}
