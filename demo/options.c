#include "options.h"

#include <float.h>
#include <stdio.h>

#define SIDE_MAX 8192 /* px */
#define SUBSTEPS_MAX 1000000
#define TICKS_MAX 1000000000000ULL

const char command_name[] = "demo";

static bool take_scene(options *o, const char *value)
{
    o->settings.scene = read_scene(value);
    return o->settings.scene != NULL;
}

static bool take_integrator(options *o, const char *value)
{
    o->settings.integrator = read_integrator(value);
    return o->settings.integrator != NULL;
}

static bool take_ghost(options *o, const char *value)
{
    o->settings.ghost = read_integrator(value);
    return o->settings.ghost != NULL;
}

static bool take_step(options *o, const char *value)
{
    return is_number(value, (double)FLT_MIN, (double)FLT_MAX, &o->settings.step) ||
           complain("--step wants a positive number such as 0.01, not \"%s\"", value);
}

static bool take_substeps(options *o, const char *value)
{
    uint64_t number = 0;
    const bool good = read_whole("--substeps", value, 1, SUBSTEPS_MAX, &number);

    o->settings.substeps = (unsigned)number;
    return good;
}

static bool take_threads(options *o, const char *value)
{
    uint64_t number = 0;
    const bool good = read_whole("--threads", value, 1, WORKERS_MAX, &number);

    o->threads = (unsigned)number;
    return good;
}

static bool take_ticks(options *o, const char *value)
{
    return o->has_ticks = read_whole("--ticks", value, 0, TICKS_MAX, &o->ticks);
}

static bool take_size(options *o, const char *value)
{
    char width[8] = "", height[8] = "", rest;
    uint64_t w, h;

    if (sscanf(value, "%7[0-9]x%7[0-9]%c", width, height, &rest) == 2 && is_whole(width, WIDTH_MIN, SIDE_MAX, &w) &&
        is_whole(height, HEIGHT_MIN, SIDE_MAX, &h)) {
        o->width = (int)w;
        o->height = (int)h;
        return true;
    }
    return complain("--size wants WIDTHxHEIGHT such as 1280x720, from %dx%d to %dx%d, not \"%s\"", WIDTH_MIN, HEIGHT_MIN,
                    SIDE_MAX, SIDE_MAX, value);
}

static bool take_csv(options *o, const char *value)
{
    o->csv = value;
    return true;
}

static bool take_png(options *o, const char *value)
{
    o->png = value;
    return true;
}

static bool take_out(options *o, const char *value)
{
    o->out = value;
    return true;
}

const option command_options[] = {
    {"--scene", "NAME", take_scene, 0, "one of --list"},
    {"--integrator", "NAME", take_integrator, 0, "one of --list"},
    {"--ghost", "NAME", take_ghost, 0, "a second integrator beside it"},
    {"--step", "S", take_step, 0, "the scene's time units a tick"},
    {"--substeps", "N", take_substeps, 0, "steps of the integrator a tick"},
    {"--threads", "N", take_threads, 0, "that step the world (1); the motion is the same, bit for bit"},
    {"--size", "WxH", take_size, 0, "of window or picture, in pixels (1280x720)"},
    {"--pictures", "", NULL, 1 << MODE_PICTURES, "no window: a picture of each scene, or of the one asked for"},
    {"--out", "FOLDER", take_out, 0, "where pictures go (the current folder)"},
    {"--headless", "", NULL, 1 << MODE_HEADLESS, "no window: run one scene, print what was measured"},
    {"--ticks", "N", take_ticks, 0, "with --headless: how long (the scene's duration)"},
    {"--csv", "FILE", take_csv, 0, "with --headless: every particle at every tick"},
    {"--png", "FILE", take_png, 0, "with --headless: a picture after the last tick"},
    {"--list", "", NULL, 1 << MODE_LIST, "list scenes and integrators"},
    {"--help", "", NULL, 1 << MODE_HELP, "this"},
    {.name = NULL},
};

/* What is wrong with the options taken together. */
static bool check(const options *o)
{
    const scene *s = o->settings.scene ? o->settings.scene : scenes[0];
    const double step = o->settings.step > 0 ? o->settings.step : s->step;
    const bool runs = o->mode == MODE_HEADLESS;

    if (!runs && (o->has_ticks || o->csv || o->png))
        return o->mode > MODE_PICTURES || complain("--ticks, --csv and --png go with --headless: add it, or leave them out");
    if (runs && o->out)
        return complain("--out is for pictures of all scenes: with --headless, say --png FILE");
    if (step / (o->settings.substeps > 0 ? o->settings.substeps : 1) < (double)FLT_MIN)
        return complain("--step divided by --substeps is too small a step: make the step longer or the substeps fewer");
    return true;
}

bool options_parse(options *o, int count, char *const arguments[])
{
    unsigned modes;

    *o = (options){.mode = MODE_WINDOW};
    if (!command_line_parse(o, &modes, count, arguments))
        return false;
    while (modes >> (o->mode + 1)) /* the last in their order wins */
        o->mode++;
    return check(o);
}

void options_print_help(void)
{
    printf("The Steadfast demo. Without options: a window, where F1 shows the keys, or, where there is no display, a\n"
           "picture of each scene in the current folder.\n\n");
    command_line_print_options();
}

void options_print_list(void)
{
    printf("scenes\n");
    for (const scene *const *each = scenes; *each; each++)
        printf("  %-20s %s; step %g %s, %s\n", (*each)->name, (*each)->title, (*each)->step, (*each)->time_unit,
               (*each)->integrator->name);
    command_line_print_integrators();
}
