#include "matrix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

void cell_word(cell *c, const char *word) { snprintf(c->text, sizeof c->text, "%s", word); }

void cell_number(cell *c, const char *before, double number, const char *after)
{
    snprintf(c->text, sizeof c->text, "%s%.2g%s", before, number, after);
}

void cell_change(cell *c, const char *word, double change)
{
    snprintf(c->text, sizeof c->text, "%s %+.3g%%", word, 100 * change);
}

void cell_tick(cell *c, const char *word, uint64_t tick)
{
    snprintf(c->text, sizeof c->text, "%s @%llu", word, (unsigned long long)tick);
}

void cell_expect(cell *c, bool holds, const char *what, const char *file, int line)
{
    if (!holds && !c->broken[0])
        snprintf(c->broken, sizeof c->broken, "%s:%d: not so: %s", file, line, what);
}

void cell_expect_close(cell *c, double actual, double expected, double tolerance, const char *what, const char *file, int line)
{
    if (!(fabs(actual - expected) <= tolerance) && !c->broken[0])
        snprintf(c->broken, sizeof c->broken, "%s:%d: %s is %.9g, and not %.9g within %.3g", file, line, what, actual, expected,
                 tolerance);
}

bool cell_expect_ok(cell *c, stf_result result, const char *file, int line)
{
    if (result && !c->broken[0]) {
        snprintf(c->broken, sizeof c->broken, "%s:%d: %s", file, line, stf_result_text(result));
        cell_word(c, "refused");
    }
    return !result;
}

void matrix_must(stf_result result, const char *file, int line)
{
    if (!result)
        return;
    fprintf(stderr, "extremes: %s:%d: %s\n", file, line, stf_result_text(result));
    exit(EXIT_FAILURE);
}
