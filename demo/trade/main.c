/* What each integrator and step costs and how wrong it is: see --help. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "export.h"
#include "options.h"
#include "pictures.h"
#include "table.h"
#include "terminal.h"

#define SCENES_MAX 64

/* Opened before anything is measured, so that a wrong path does not cost a sweep. NULL is not asked for. */
static bool open_output(const char *path, FILE **file)
{
    *file = NULL;
    if (!path)
        return true;
    errno = 0;
    *file = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
    if (!*file)
        fprintf(stderr, "trade: can't write \"%s\" (%s): name a file in a folder that exists and may be written\n", path,
                strerror(errno));
    return *file != NULL;
}

static bool close_output(const char *path, FILE *file)
{
    if (!file)
        return true;

    const bool written = !ferror(file);
    const bool closed = (file == stdout ? fflush(file) : fclose(file)) == 0;

    if (!written || !closed)
        fprintf(stderr, "trade: %s could not be written to its end: is the disk full?\n", path);
    return written && closed;
}

static void print(const options *o, const sweep *s, FILE *csv)
{
    if (csv)
        export_csv(csv, s);
    if (o->sweep.quick)
        table_print_answers(s, o->sweep.tolerance, o->budget);
    else if (o->markdown)
        table_print_markdown(s);
    else if (!o->only_csv)
        table_print(s);
    fflush(stdout);
}

/* sweeps[SCENES_MAX]; *count gets how many have rows. */
static bool run(const options *o, sweep *sweeps, size_t *count, FILE *csv)
{
    if (csv && o->sweep.shard == 1)
        export_csv_head(csv);
    if (o->markdown)
        table_print_markdown_head();
    for (const scene *const *each = scenes; *each && *count < SCENES_MAX; each++) {
        sweep *s = &sweeps[*count];

        if (o->scene && o->scene != *each)
            continue;
        const stf_result result = sweep_run(s, *each, &o->sweep);
        *count += 1;
        if (result) {
            show_progress(NULL, NULL, 0);
            fprintf(stderr, "trade: %s: %s\n", (*each)->name, stf_result_text(result));
            return false;
        }
        if (s->count > 0)
            print(o, s, csv);
    }
    return true;
}

int main(int argument_count, char *arguments[])
{
    options o;
    FILE *csv, *json;
    sweep sweeps[SCENES_MAX];
    size_t count = 0;

    if (!options_parse(&o, argument_count, arguments))
        return EXIT_USAGE;
    if (o.help || o.list) {
        (o.help ? options_print_help : options_print_list)();
        return EXIT_SUCCESS;
    }
    if (!open_output(o.csv, &csv) || !open_output(o.json, &json) || (o.pictures && !pictures_check(o.pictures)))
        return EXIT_USAGE;

    bool good = run(&o, sweeps, &count, csv);
    if (good && json)
        export_json(json, sweeps, count);
    if (good && o.pictures)
        good = pictures_draw(o.pictures, sweeps, count);
    good = close_output(o.csv, csv) && good;
    good = close_output(o.json, json) && good;
    for (size_t i = 0; i < count; i++)
        sweep_free(&sweeps[i]);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
