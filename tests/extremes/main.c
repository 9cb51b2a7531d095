/* extremes: prints the matrix, and fails if a cell does not hold. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "matrix.h"

#define LABEL 15
#define COLUMN (CELL_TEXT + 1)

static const char *const precisions[] = {"float", "double"};
static const char *const integrators[] = {"explicit_euler", "semi_implicit_euler", "midpoint",       "improved_euler",
                                          "rk4",            "position_verlet",     "velocity_verlet"};

#define AXES(X) \
    X(axis_step) X(axis_step_end) X(axis_drag) X(axis_spring) X(axis_mass_spring) X(axis_mass_gravity) X(axis_distance) \
    X(axis_distance_spring) X(axis_velocity)

#define DECLARE(name) extern const axis name##_float, name##_double;
#define LIST(name) {&name##_float, &name##_double},
AXES(DECLARE)
static const axis *const axes[][2] = {AXES(LIST)};

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

typedef struct total {
    bool quick;
    unsigned cells, broken;
    char report[64][400]; /* one line for each of the first broken cells */
} total;

/* semi_implicit_euler as "semi_implicit" over "euler" */
static void print_heads(const char *precision)
{
    char first[COUNT_OF(integrators)][CELL_TEXT + 1];

    printf("%-*s", LABEL, precision);
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        snprintf(first[i], sizeof first[i], "%s", integrators[i]);
        char *cut = strrchr(first[i], '_');
        if (cut)
            *cut = 0;
        printf("%-*s", COLUMN, first[i]);
    }
    printf("\n%-*s", LABEL, "");
    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        const char *cut = strrchr(integrators[i], '_');
        printf("%-*s", COLUMN, cut ? cut + 1 : "");
    }
    printf("\n");
}

static void run_cell(total *t, const axis *a, const row *r, const char *integrator, const char *precision)
{
    const setting s = {.integrator = integrator};
    cell c = {.text = ""};

    a->run(&c, &s, r);
    printf("%s%-*s", c.broken[0] ? "!" : "", COLUMN - (c.broken[0] != 0), c.text);
    fflush(stdout);
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
    print_heads(precision);
    for (const row *r = a->rows; r < a->rows + a->row_count; r++) {
        if (r->heavy && t->quick)
            continue;
        printf("%-*s", LABEL, r->label);
        for (size_t i = 0; i < COUNT_OF(integrators); i++)
            run_cell(t, a, r, integrators[i], precision);
        printf("\n");
    }
    printf("\n");
}

int main(int count, char **arguments)
{
    static total t;

    t.quick = count == 2 && strcmp(arguments[1], "--quick") == 0;
    if (count > 1 && !t.quick) {
        fprintf(stderr, "extremes: usage: extremes [--quick]: without what takes long or much memory\n");
        return EXIT_FAILURE;
    }
    for (size_t i = 0; i < COUNT_OF(axes); i++) {
        printf("%s\n%s\n\n", axes[i][0]->title, axes[i][0]->holds);
        for (size_t p = 0; p < COUNT_OF(precisions); p++)
            run_axis(&t, axes[i][p], precisions[p]);
    }
    for (unsigned i = 0; i < t.broken && i < COUNT_OF(t.report); i++)
        fprintf(stderr, "%s\n", t.report[i]);
    printf("%u cells, %u broken\n", t.cells, t.broken);
    return t.broken ? EXIT_FAILURE : EXIT_SUCCESS;
}
