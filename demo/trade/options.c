#include "options.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#define REPEATS 25
#define REPEATS_MAX 1000
#define SHARDS_MAX 1000000

const char command_name[] = "trade";

static bool take_scene(options *o, const char *value)
{
    o->scene = read_scene(value);
    return o->scene != NULL;
}

static bool take_integrator(options *o, const char *value)
{
    o->sweep.integrator = read_integrator(value);
    return o->sweep.integrator != NULL;
}

static bool take_precision(options *o, const char *value)
{
    if (strcmp(value, "float") == 0)
        o->sweep.precision = PRECISION_FLOAT;
    else if (strcmp(value, "double") == 0)
        o->sweep.precision = PRECISION_DOUBLE;
    else if (strcmp(value, "both") != 0)
        return complain("--precision wants float, double or both, not \"%s\"", value);
    return true;
}

static bool take_tolerance(options *o, const char *value)
{
    return is_number(value, DBL_MIN, DBL_MAX, &o->sweep.tolerance) ||
           complain("--tolerance wants a part of the scene's size such as 1e-3, not \"%s\"", value);
}

static bool take_budget(options *o, const char *value)
{
    return is_number(value, DBL_MIN, DBL_MAX, &o->budget) ||
           complain("--budget wants nanoseconds such as 5000, not \"%s\"", value);
}

static bool take_levels(options *o, const char *value)
{
    uint64_t number = 0;
    const bool good = read_whole("--levels", value, 1, SWEEP_LEVELS_MAX, &number);

    o->sweep.levels = (unsigned)number;
    return good;
}

static bool take_repeats(options *o, const char *value)
{
    uint64_t number = 0;
    const bool good = read_whole("--repeats", value, 1, REPEATS_MAX, &number);

    o->sweep.repeats = (unsigned)number;
    return good;
}

static bool take_shard(options *o, const char *value)
{
    char shard[9] = "", shards[9] = "", rest;
    uint64_t i, n;

    if (sscanf(value, "%8[0-9]/%8[0-9]%c", shard, shards, &rest) == 2 && is_whole(shards, 1, SHARDS_MAX, &n) &&
        is_whole(shard, 1, n, &i)) {
        o->sweep.shard = (unsigned)i;
        o->sweep.shards = (unsigned)n;
        return true;
    }
    return complain("--shard wants I/N with I from 1 to N, such as 3/8, not \"%s\"", value);
}

static bool take_csv(options *o, const char *value)
{
    o->csv = value;
    return true;
}

static bool take_json(options *o, const char *value)
{
    o->json = value;
    return true;
}

static bool take_pictures(options *o, const char *value)
{
    o->pictures = value;
    return true;
}

enum { FLAG_MARKDOWN = 1 << 0, FLAG_LIST = 1 << 1, FLAG_HELP = 1 << 2 };

const option command_options[] = {
    {"--scene", "NAME", take_scene, 0, "one of --list (all)"},
    {"--integrator", "NAME", take_integrator, 0, "one of --list (all)"},
    {"--precision", "NAME", take_precision, 0, "float, double or both (both)"},
    {"--tolerance", "PART", take_tolerance, 0, "only answer: the cheapest for an error of this part of the scene's size"},
    {"--budget", "NS", take_budget, 0, "only answer: the most accurate for these ns a particle for each unit of time"},
    {"--levels", "N", take_levels, 0, "steps to try, each half of the one before (10, fewer where that takes long)"},
    {"--repeats", "N", take_repeats, 0, "of each timing (25)"},
    {"--csv", "FILE", take_csv, 0, "all that was measured, one line a row; - is stdout, in place of the tables"},
    {"--json", "FILE", take_json, 0, "the same with references and picks"},
    {"--pictures", "FOLDER", take_pictures, 0, "diagrams and stability maps, SVG and PNG, drawn by gnuplot, with their data"},
    {"--shard", "I/N", take_shard, 0, "only the I-th of N parts, as CSV; part 1 writes the head, so that they concatenate"},
    {"--markdown", "", NULL, FLAG_MARKDOWN, "the picks as a table for the README, in place of the tables"},
    {"--list", "", NULL, FLAG_LIST, "list scenes and integrators"},
    {"--help", "", NULL, FLAG_HELP, "this"},
    {.name = NULL},
};

/* What is wrong with the options taken together. */
static bool check(options *o)
{
    const bool asks = o->sweep.tolerance > 0 || o->budget > 0;

    if (asks && (o->csv || o->json || o->pictures || o->markdown || o->sweep.shards > 0))
        return complain("--tolerance and --budget only answer: leave out --csv, --json, --pictures, --markdown and --shard");
    if (o->sweep.shards > 0 && (o->json || o->pictures || o->markdown))
        return complain("a shard gives CSV: leave out --json, --pictures and --markdown");
    if (o->sweep.shards > 0 && !o->csv)
        o->csv = "-";
    o->only_csv = o->sweep.shards > 0 || (o->csv && strcmp(o->csv, "-") == 0);
    if (o->sweep.shards == 0)
        o->sweep.shard = o->sweep.shards = 1;
    o->sweep.quick = asks;
    return true;
}

bool options_parse(options *o, int count, char *const arguments[])
{
    unsigned flags;

    *o = (options){.sweep = {.repeats = REPEATS}};
    if (!command_line_parse(o, &flags, count, arguments))
        return false;
    o->markdown = flags & FLAG_MARKDOWN;
    o->list = flags & FLAG_LIST;
    o->help = flags & FLAG_HELP;
    return check(o);
}

void options_print_help(void)
{
    printf("What each integrator and step costs and how wrong it is, on the demo's scenes, on this machine. Without\n"
           "options: a table of each scene.\n\n");
    command_line_print_options();
}

void options_print_list(void)
{
    printf("scenes\n");
    for (const scene *const *each = scenes; *each; each++)
        printf("  %-20s %s; size %g %s, step %g %s, %s\n", (*each)->name, (*each)->title, (*each)->size, (*each)->length_unit,
               (*each)->step, (*each)->time_unit, (*each)->integrator->name);
    command_line_print_integrators();
}
