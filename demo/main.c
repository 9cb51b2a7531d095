/* The Steadfast demo: a window on the scenes; pictures of them where there is no display; runs for scripts. */
#include <SDL.h>
#include <SDL_ttf.h>
#include <stdio.h>
#include <stdlib.h>

#include "app.h"
#include "headless.h"

static int run(const options *o)
{
    switch (o->mode) {
    case MODE_HELP:
        options_print_help();
        return EXIT_SUCCESS;
    case MODE_LIST:
        options_print_list();
        return EXIT_SUCCESS;
    case MODE_HEADLESS:
        return headless_run(o);
    case MODE_PICTURES:
        return headless_pictures(o);
    case MODE_WINDOW:
        break;
    }
    if (app_find_display())
        return app_run(o);
    printf("There is no display: a picture of each scene instead.\n");
    return headless_pictures(o);
}

static int run_with_threads(options *o)
{
    if (o->threads > 1) {
        o->settings.workers = workers_start(o->threads);
        if (!o->settings.workers) {
            fprintf(stderr, "demo: can't start %u threads: %s; ask for fewer\n", o->threads, SDL_GetError());
            return EXIT_FAILURE;
        }
    }
    const int status = run(o);
    workers_stop(o->settings.workers);
    return status;
}

int main(int argc, char *argv[])
{
    options o;
    int status = EXIT_USAGE;

    if (options_parse(&o, argc, argv))
        status = run_with_threads(&o);
    if (TTF_WasInit())
        TTF_Quit();
    SDL_Quit();
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == EXIT_SUCCESS) {
        fprintf(stderr, "demo: can't write to the standard output\n");
        status = EXIT_FAILURE;
    }
    return status;
}
