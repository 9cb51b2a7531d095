#include "options.h"

#include <ctype.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE_MAX 8192 /* px */
#define SUBSTEPS_MAX 1000000
#define TICKS_MAX 1000000000000ULL

/* Each of these says on stderr what it wants where it returns false. */
typedef bool (*take_value)(options *o, const char *value);

typedef struct option {
    const char *name, *value;
    take_value take; /* NULL: the option has no value, it sets the mode */
    run_mode mode;
    const char *help;
} option;

static bool take_scene(options *o, const char *value)
{
    o->settings.scene = scene_find(value);
    if (o->settings.scene)
        return true;
    fprintf(stderr, "demo: there is no scene \"%s\"; choose one of:", value);
    for (const scene *const *each = scenes; *each; each++)
        fprintf(stderr, " %s", (*each)->name);
    fputc('\n', stderr);
    return false;
}

static const stf_integrator *find_integrator(const char *value)
{
    const stf_integrator *found = stf_integrator_find(value);

    if (found)
        return found;
    fprintf(stderr, "demo: there is no integrator \"%s\"; choose one of:", value);
    for (const stf_integrator *const *each = stf_integrators; *each; each++)
        fprintf(stderr, " %s", (*each)->name);
    fputc('\n', stderr);
    return NULL;
}

static bool take_integrator(options *o, const char *value)
{
    o->settings.integrator = find_integrator(value);
    return o->settings.integrator != NULL;
}

static bool take_ghost(options *o, const char *value)
{
    o->settings.ghost = find_integrator(value);
    return o->settings.ghost != NULL;
}

static bool take_step(options *o, const char *value)
{
    char *end;

    o->settings.step = strtod(value, &end);
    if (end != value && *end == '\0' && !isspace((unsigned char)*value) && o->settings.step >= (double)FLT_MIN &&
        o->settings.step <= (double)FLT_MAX)
        return true;
    fprintf(stderr, "demo: --step wants a positive number such as 0.01, not \"%s\"\n", value);
    return false;
}

/* A whole number from `least` to `most` in plain digits. */
static bool read_whole(const char *text, uint64_t least, uint64_t most, uint64_t *number)
{
    char *end;

    if (!isdigit((unsigned char)*text))
        return false;
    errno = 0;
    const unsigned long long read = strtoull(text, &end, 10);
    *number = read;
    return errno == 0 && *end == '\0' && read >= least && read <= most;
}

static bool take_substeps(options *o, const char *value)
{
    uint64_t number;

    if (read_whole(value, 1, SUBSTEPS_MAX, &number)) {
        o->settings.substeps = (unsigned)number;
        return true;
    }
    fprintf(stderr, "demo: --substeps wants a whole number from 1 to %d, not \"%s\"\n", SUBSTEPS_MAX, value);
    return false;
}

static bool take_threads(options *o, const char *value)
{
    uint64_t number;

    if (read_whole(value, 1, WORKERS_MAX, &number)) {
        o->threads = (unsigned)number;
        return true;
    }
    fprintf(stderr, "demo: --threads wants a whole number from 1 to %d, not \"%s\"\n", WORKERS_MAX, value);
    return false;
}

static bool take_ticks(options *o, const char *value)
{
    o->has_ticks = read_whole(value, 0, TICKS_MAX, &o->ticks);
    if (!o->has_ticks)
        fprintf(stderr, "demo: --ticks wants a whole number from 0 to %llu, not \"%s\"\n", TICKS_MAX, value);
    return o->has_ticks;
}

static bool take_size(options *o, const char *value)
{
    char width[8] = "", height[8] = "", rest;
    uint64_t w, h;

    if (sscanf(value, "%7[0-9]x%7[0-9]%c", width, height, &rest) == 2 && read_whole(width, WIDTH_MIN, SIDE_MAX, &w) &&
        read_whole(height, HEIGHT_MIN, SIDE_MAX, &h)) {
        o->width = (int)w;
        o->height = (int)h;
        return true;
    }
    fprintf(stderr, "demo: --size wants WIDTHxHEIGHT such as 1280x720, from %dx%d to %dx%d, not \"%s\"\n", WIDTH_MIN,
            HEIGHT_MIN, SIDE_MAX, SIDE_MAX, value);
    return false;
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

static const option all_options[] = {
    {"--scene", "NAME", take_scene, MODE_WINDOW, "one of --list"},
    {"--integrator", "NAME", take_integrator, MODE_WINDOW, "one of --list"},
    {"--ghost", "NAME", take_ghost, MODE_WINDOW, "a second integrator beside it"},
    {"--step", "S", take_step, MODE_WINDOW, "the scene's time units a tick"},
    {"--substeps", "N", take_substeps, MODE_WINDOW, "steps of the integrator a tick"},
    {"--threads", "N", take_threads, MODE_WINDOW, "that step the world (1); the motion is the same, bit for bit"},
    {"--size", "WxH", take_size, MODE_WINDOW, "of window or picture, in pixels (1280x720)"},
    {"--pictures", "", NULL, MODE_PICTURES, "no window: a picture of each scene, or of the one asked for"},
    {"--out", "FOLDER", take_out, MODE_WINDOW, "where pictures go (the current folder)"},
    {"--headless", "", NULL, MODE_HEADLESS, "no window: run one scene, print what was measured"},
    {"--ticks", "N", take_ticks, MODE_WINDOW, "with --headless: how long (the scene's duration)"},
    {"--csv", "FILE", take_csv, MODE_WINDOW, "with --headless: every particle at every tick"},
    {"--png", "FILE", take_png, MODE_WINDOW, "with --headless: a picture after the last tick"},
    {"--list", "", NULL, MODE_LIST, "list scenes and integrators"},
    {"--help", "", NULL, MODE_HELP, "this"},
};

#define OPTIONS (sizeof all_options / sizeof *all_options)

static const option *find_option(const char *name)
{
    for (size_t i = 0; i < OPTIONS; i++)
        if (strcmp(all_options[i].name, name) == 0)
            return &all_options[i];
    return NULL;
}

static bool complain(const char *what)
{
    fprintf(stderr, "demo: %s\n", what);
    return false;
}

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
    *o = (options){.mode = MODE_WINDOW};
    for (int i = 1; i < count; i++) {
        const option *found = find_option(arguments[i]);

        if (!found) {
            fprintf(stderr, "demo: \"%s\" is no option; --help lists them\n", arguments[i]);
            return false;
        }
        if (!found->take) {
            o->mode = found->mode > o->mode ? found->mode : o->mode;
            continue;
        }
        if (i + 1 == count || find_option(arguments[i + 1])) {
            fprintf(stderr, "demo: %s wants a value behind it; --help lists the options\n", arguments[i]);
            return false;
        }
        if (!found->take(o, arguments[++i]))
            return false;
    }
    return check(o);
}

void options_print_help(void)
{
    printf("The Steadfast demo. Without options: a window, where F1 shows the keys, or, where there is no display, a\n"
           "picture of each scene in the current folder.\n\n");
    for (size_t i = 0; i < OPTIONS; i++)
        printf("  %-12s %-7s %s\n", all_options[i].name, all_options[i].value, all_options[i].help);
}

void options_print_list(void)
{
    printf("scenes\n");
    for (const scene *const *each = scenes; *each; each++)
        printf("  %-20s %s; step %g %s, %s\n", (*each)->name, (*each)->title, (*each)->step, (*each)->time_unit,
               (*each)->integrator->name);
    printf("integrators\n");
    for (const stf_integrator *const *each = stf_integrators; *each; each++)
        printf("  %-20s order %d, %d acceleration%s a step\n", (*each)->name, (*each)->order, (*each)->evaluations,
               (*each)->evaluations == 1 ? "" : "s");
}
