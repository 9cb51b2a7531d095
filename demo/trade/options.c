#include "options.h"

#include <ctype.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define REPEATS 25
#define REPEATS_MAX 1000
#define SHARDS_MAX 1000000

/* Each of these says on stderr what it wants where it returns false. */
typedef bool (*take_value)(options *o, const char *value);

typedef struct option {
    const char *name, *value;
    take_value take;
    const char *help;
} option;

static bool take_scene(options *o, const char *value)
{
    o->scene = scene_find(value);
    if (o->scene)
        return true;
    fprintf(stderr, "trade: there is no scene \"%s\"; choose one of:", value);
    for (const scene *const *each = scenes; *each; each++)
        fprintf(stderr, " %s", (*each)->name);
    fputc('\n', stderr);
    return false;
}

static bool take_integrator(options *o, const char *value)
{
    o->sweep.integrator = stf_integrator_find(value);
    if (o->sweep.integrator)
        return true;
    fprintf(stderr, "trade: there is no integrator \"%s\"; choose one of:", value);
    for (const stf_integrator *const *each = stf_integrators; *each; each++)
        fprintf(stderr, " %s", (*each)->name);
    fputc('\n', stderr);
    return false;
}

static bool take_precision(options *o, const char *value)
{
    if (strcmp(value, "float") == 0)
        o->sweep.precision = PRECISION_FLOAT;
    else if (strcmp(value, "double") == 0)
        o->sweep.precision = PRECISION_DOUBLE;
    else if (strcmp(value, "both") != 0) {
        fprintf(stderr, "trade: --precision wants float, double or both, not \"%s\"\n", value);
        return false;
    }
    return true;
}

static bool read_positive(const char *text, double *number)
{
    char *end;

    *number = strtod(text, &end);
    return end != text && *end == '\0' && !isspace((unsigned char)*text) && *number >= DBL_MIN && *number <= DBL_MAX;
}

static bool take_tolerance(options *o, const char *value)
{
    if (read_positive(value, &o->sweep.tolerance))
        return true;
    fprintf(stderr, "trade: --tolerance wants a part of the scene's size such as 1e-3, not \"%s\"\n", value);
    return false;
}

static bool take_budget(options *o, const char *value)
{
    if (read_positive(value, &o->budget))
        return true;
    fprintf(stderr, "trade: --budget wants nanoseconds such as 5000, not \"%s\"\n", value);
    return false;
}

/* A whole number from 1 to `most` in plain digits, and what follows it. */
static bool read_whole(const char *text, unsigned most, unsigned *number, const char **rest)
{
    const size_t digits = strspn(text, "0123456789");
    const unsigned long read = digits > 0 && digits < 9 ? strtoul(text, NULL, 10) : 0;

    *number = (unsigned)read;
    *rest = text + digits;
    return read >= 1 && read <= most;
}

static bool take_levels(options *o, const char *value)
{
    const char *rest;

    if (read_whole(value, SWEEP_LEVELS_MAX, &o->sweep.levels, &rest) && *rest == '\0')
        return true;
    fprintf(stderr, "trade: --levels wants a whole number from 1 to %d, not \"%s\"\n", SWEEP_LEVELS_MAX, value);
    return false;
}

static bool take_repeats(options *o, const char *value)
{
    const char *rest;

    if (read_whole(value, REPEATS_MAX, &o->sweep.repeats, &rest) && *rest == '\0')
        return true;
    fprintf(stderr, "trade: --repeats wants a whole number from 1 to %d, not \"%s\"\n", REPEATS_MAX, value);
    return false;
}

static bool take_shard(options *o, const char *value)
{
    const char *rest;

    if (read_whole(value, SHARDS_MAX, &o->sweep.shard, &rest) && *rest == '/' &&
        read_whole(rest + 1, SHARDS_MAX, &o->sweep.shards, &rest) && *rest == '\0' && o->sweep.shard <= o->sweep.shards)
        return true;
    fprintf(stderr, "trade: --shard wants I/N with I from 1 to N, such as 3/8, not \"%s\"\n", value);
    return false;
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

static bool take_markdown(options *o, const char *value)
{
    (void)value;
    return o->markdown = true;
}

static bool take_list(options *o, const char *value)
{
    (void)value;
    return o->list = true;
}

static bool take_help(options *o, const char *value)
{
    (void)value;
    return o->help = true;
}

/* An option with an empty `value` takes none. */
static const option all_options[] = {
    {"--scene", "NAME", take_scene, "one of --list (all)"},
    {"--integrator", "NAME", take_integrator, "one of --list (all)"},
    {"--precision", "NAME", take_precision, "float, double or both (both)"},
    {"--tolerance", "PART", take_tolerance, "only answer: the cheapest for an error of this part of the scene's size"},
    {"--budget", "NS", take_budget, "only answer: the most accurate for these ns a particle for each unit of time"},
    {"--levels", "N", take_levels, "steps to try, each half of the one before (10, fewer where that takes long)"},
    {"--repeats", "N", take_repeats, "of each timing (25)"},
    {"--csv", "FILE", take_csv, "all that was measured, one line a row; - is stdout, in place of the tables"},
    {"--json", "FILE", take_json, "the same with references and picks"},
    {"--pictures", "FOLDER", take_pictures, "diagrams and stability maps, SVG and PNG, drawn by gnuplot, with their data"},
    {"--shard", "I/N", take_shard, "only the I-th of N parts, as CSV; part 1 writes the head, so that they concatenate"},
    {"--markdown", "", take_markdown, "the picks as a table for the README, in place of the tables"},
    {"--list", "", take_list, "list scenes and integrators"},
    {"--help", "", take_help, "this"},
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
    fprintf(stderr, "trade: %s\n", what);
    return false;
}

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
    *o = (options){.sweep = {.repeats = REPEATS}};
    for (int i = 1; i < count; i++) {
        const option *found = find_option(arguments[i]);

        if (!found) {
            fprintf(stderr, "trade: \"%s\" is no option; --help lists them\n", arguments[i]);
            return false;
        }
        const bool has_value = found->value[0] != '\0';
        if (has_value && (i + 1 == count || find_option(arguments[i + 1]))) {
            fprintf(stderr, "trade: %s wants a value behind it; --help lists the options\n", arguments[i]);
            return false;
        }
        if (!found->take(o, has_value ? arguments[++i] : NULL))
            return false;
    }
    return check(o);
}

void options_print_help(void)
{
    printf("What each integrator and step costs and how wrong it is, on the demo's scenes, on this machine. Without\n"
           "options: a table of each scene.\n\n");
    for (size_t i = 0; i < OPTIONS; i++)
        printf("  %-12s %-7s %s\n", all_options[i].name, all_options[i].value, all_options[i].help);
}

void options_print_list(void)
{
    printf("scenes\n");
    for (const scene *const *each = scenes; *each; each++)
        printf("  %-20s %s; size %g %s, step %g %s, %s\n", (*each)->name, (*each)->title, (*each)->size, (*each)->length_unit,
               (*each)->step, (*each)->time_unit, (*each)->integrator->name);
    printf("integrators\n");
    for (const stf_integrator *const *each = stf_integrators; *each; each++)
        printf("  %-20s order %d, %d acceleration%s a step\n", (*each)->name, (*each)->order, (*each)->evaluations,
               (*each)->evaluations == 1 ? "" : "s");
}
