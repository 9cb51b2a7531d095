/* What a step costs, beside the best plain C and the machine's own limits. `make bench` runs it; --help lists the options. */
#include <stdlib.h>
#include <string.h>

#include "rows.h"

#define ROWS_MAX 512

typedef struct options {
    const char *only, *csv, *picture;
    bool quick, list, check, help;
} options;

typedef struct run {
    options options;
    FILE *csv;
    bench_row rows[ROWS_MAX];
    size_t count;
} run;

static void print_help(void)
{
    printf("bench [ROW] [options]: ns a particle, spring, pair or step, beside the best plain C loop for the same\n"
           "  ROW             only rows whose \"name real n\" contains this, and what is measured with them: 'rk4 float 1000'\n"
           "  --list          the rows' names, without measuring\n"
           "  --quick         at most 1e5 particles, and short: seconds, for a first look\n"
           "  --csv FILE      the rows as comma-separated values too\n"
           "  --picture NAME  draws NAME.png and NAME.svg with gnuplot\n"
           "  --check         only checks that every reference moves as the library does\n"
           "STEADFAST_ISA=baseline|avx2|avx512 chooses the instruction set of library and references.\n");
}

static bool parse(int count, char **arguments, options *o)
{
    for (int i = 1; i < count; i++) {
        const char *a = arguments[i], *value = i + 1 < count ? arguments[i + 1] : NULL;

        if (strcmp(a, "--list") == 0)
            o->list = true;
        else if (strcmp(a, "--quick") == 0)
            o->quick = true;
        else if (strcmp(a, "--check") == 0)
            o->check = true;
        else if (strcmp(a, "--help") == 0)
            o->help = true;
        else if (strcmp(a, "--csv") == 0 && value)
            o->csv = value, i++;
        else if (strcmp(a, "--picture") == 0 && value)
            o->picture = value, i++;
        else if (a[0] != '-' && !o->only)
            o->only = a;
        else
            return false;
    }
    return true;
}

static bool is_asked_for(const bench_group *group, const char *only)
{
    char text[2 * NAME_MAX_LENGTH];
    bool asked = !only;

    for (size_t i = 0; i < group->rows_count && !asked; i++) {
        bench_row_text(&group->rows[i], text, sizeof text);
        asked = strstr(text, only) != NULL;
    }
    return asked;
}

static void list_group(const bench_group *group)
{
    char text[2 * NAME_MAX_LENGTH];

    for (size_t i = 0; i < group->rows_count; i++) {
        bench_row_text(&group->rows[i], text, sizeof text);
        printf("%s\n", text);
    }
}

static void take_group(bench_group *group, void *user)
{
    run *r = user;

    if (!is_asked_for(group, r->options.only))
        return;
    if (r->options.list) {
        list_group(group);
        return;
    }
    group->plan.sample = r->options.quick ? 1e-3 : 4e-3; /* s */
    group->plan.total = r->options.quick ? 0.05 : 0.5;
    bench_run_group(group);
    for (size_t i = 0; i < group->rows_count; i++) {
        bench_print_row(stdout, &group->rows[i]);
        if (r->csv)
            bench_csv_row(r->csv, &group->rows[i]);
        if (r->count < ROWS_MAX)
            r->rows[r->count++] = group->rows[i];
    }
}

static void print_summary(const run *r)
{
    size_t targets = 0, met = 0;

    for (size_t i = 0; i < r->count; i++)
        if (r->rows[i].target > 0 && r->rows[i].result.measured) {
            targets++;
            met += r->rows[i].compared <= r->rows[i].target;
        }
    printf("\n%zu of %zu targets met\n", met, targets);
}

/* Every reference on a scene small enough to be quick, and of no round number of particles. */
static bool check_all(void)
{
    static const bench_scene scenes[] = {
        {FREE, REFERENCE, "semi_implicit_euler", 777},
        {FREE, REFERENCE, "velocity_verlet", 777},
        {FREE, REFERENCE, "rk4", 777},
        {FIELD, REFERENCE, "rk4", 777},
        {CLOTH, REFERENCE, NULL, 23 * 23},
        {CLOTH, EDGES, NULL, 23 * 23},
        {GRAPH, EDGES, NULL, 777},
        {GRAPH, EDGES_SORTED, NULL, 777},
        {PAIRS, REFERENCE, NULL, 777},
        {FREE, LIBRARY_THREADS, "rk4", 7777},
        {CLOTH, LIBRARY_THREADS, NULL, 64 * 64},
        {PAIRS, LIBRARY_THREADS, NULL, 777},
        {FREE, LIBRARY_GUARDED, "velocity_verlet", 7777},
        {CLOTH, LIBRARY_GUARDED, NULL, 64 * 64},
    };
    const bench_precision *const precisions[] = {&bench_float, &bench_double};
    bool same = true;

    for (size_t k = 0; k < 2; k++)
        for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++)
            same = precisions[k]->check(&scenes[i]) && same;
    return same;
}

static int measure_all(run *r)
{
    if (r->options.csv) {
        r->csv = fopen(r->options.csv, "w");
        if (!r->csv) {
            fprintf(stderr, "bench: can't write %s: give --csv another file\n", r->options.csv);
            return EXIT_FAILURE;
        }
        bench_csv_header(r->csv);
    }
    bench_print_header(stdout, measure_pin());
    bench_groups(r->options.quick, take_group, r);
    if (r->csv)
        fclose(r->csv);
    if (r->count == 0) {
        fprintf(stderr, "bench: no row's name has '%s' in it; see bench --list\n", r->options.only);
        return EXIT_FAILURE;
    }
    print_summary(r);
    if (r->options.picture)
        bench_picture(r->rows, r->count, r->options.picture);
    return EXIT_SUCCESS;
}

int main(int count, char **arguments)
{
    static run r;

    if (!parse(count, arguments, &r.options)) {
        fprintf(stderr, "bench: unknown or incomplete option; see bench --help\n");
        return EXIT_FAILURE;
    }
    if (r.options.help) {
        print_help();
        return EXIT_SUCCESS;
    }
    if (r.options.list) {
        bench_groups(r.options.quick, take_group, &r);
        return EXIT_SUCCESS;
    }
    if (!check_all())
        return EXIT_FAILURE;
    if (r.options.check) {
        printf("bench: every reference moves as the library does (%s)\n", bench_isa());
        return EXIT_SUCCESS;
    }
    return measure_all(&r);
}
