/* extremes: prints the matrix, and fails if a cell does not hold. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "matrix.h"
#include "steadfast/integrator.h"

#define LABEL 15
#define COLUMN (CELL_TEXT + 1)

static const char *const precisions[] = {"float", "double"};

#define AXES(X) \
    X(axis_step) X(axis_step_end) X(axis_drag) X(axis_drag_sum) X(axis_drag_quadratic) X(axis_spring) X(axis_mass_spring) \
    X(axis_mass_gravity) X(axis_distance) X(axis_distance_compensated) X(axis_distance_spring) X(axis_velocity) \
    X(axis_scale_springs) X(axis_scale_attractor) X(axis_scale_all_pairs) X(axis_scale_drag) X(axis_coincident) \
    X(axis_through) X(axis_count) X(axis_count_pairs) X(axis_count_guard) X(axis_count_rope) X(axis_run_flight) \
    X(axis_run_compensated) X(axis_run_spring) X(axis_bias) X(axis_ticks)

#define DECLARE(name) extern const axis name##_float, name##_double;
#define LIST(name) {&name##_float, &name##_double},
AXES(DECLARE)
static const axis *const axes[][2] = {AXES(LIST)};

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

typedef struct total {
    bool check; /* no table, and no heavy cells */
    unsigned cells, broken;
    char report[64][400]; /* one line for each of the first broken cells */
} total;

/* The table is printed cell by cell, as some take long. */
static void show(const total *t, int width, const char *text)
{
    if (!t->check)
        printf("%-*s", width, text);
    fflush(stdout);
}

/* semi_implicit_euler as "semi_implicit" over "euler" */
static void show_heads(const total *t, const char *precision)
{
    show(t, LABEL, precision);
    for (int i = 0; stf_integrators[i]; i++) {
        char first[CELL_TEXT + 1];
        const char *name = stf_integrators[i]->name, *cut = strrchr(name, '_');
        snprintf(first, sizeof first, "%.*s", cut ? (int)(cut - name) : CELL_TEXT, name);
        show(t, COLUMN, first);
    }
    show(t, 0, "\n");
    show(t, LABEL, "");
    for (int i = 0; stf_integrators[i]; i++) {
        const char *cut = strrchr(stf_integrators[i]->name, '_');
        show(t, COLUMN, cut ? cut + 1 : "");
    }
    show(t, 0, "\n");
}

static void run_cell(total *t, const axis *a, const row *r, const char *integrator, const char *precision)
{
    cell c = {.text = ""};

    a->run(&c, integrator, r);
    show(t, c.broken[0] != 0, c.broken[0] ? "!" : "");
    show(t, COLUMN - (c.broken[0] != 0), c.text);
    t->cells++;
    if (!c.broken[0])
        return;
    if (t->broken < COUNT_OF(t->report))
        snprintf(t->report[t->broken], sizeof t->report[0], "%s: %s, %s, %s, %s", c.broken, a->title, r->label, integrator,
                 precision);
    t->broken++;
}

static void run_axis(total *t, const axis *a, const char *precision)
{
    show_heads(t, precision);
    for (const row *r = a->rows; r < a->rows + a->row_count; r++) {
        if (r->heavy && t->check)
            continue;
        show(t, LABEL, r->label);
        for (int i = 0; stf_integrators[i]; i++)
            run_cell(t, a, r, stf_integrators[i]->name, precision);
        show(t, 0, "\n");
    }
    show(t, 0, "\n");
}

int main(int count, char **arguments)
{
    static total t;

    t.check = count == 2 && strcmp(arguments[1], "--check") == 0;
    if (count > 1 && !t.check) {
        fprintf(stderr, "extremes: give no option, or --check: no table, and without what takes long or much memory\n");
        return EXIT_FAILURE;
    }
    for (size_t i = 0; i < COUNT_OF(axes); i++) {
        if (!t.check)
            printf("%s\n%s\n\n", axes[i][0]->title, axes[i][0]->holds);
        for (size_t p = 0; p < COUNT_OF(precisions); p++)
            run_axis(&t, axes[i][p], precisions[p]);
    }
    for (unsigned i = 0; i < t.broken && i < COUNT_OF(t.report); i++)
        fprintf(stderr, "%s\n", t.report[i]);
    printf("extremes: %u of %u cells hold\n", t.cells - t.broken, t.cells);
    return t.broken ? EXIT_FAILURE : EXIT_SUCCESS;
}
