/*
 * The matrix of extremes: axes with rows, a cell for each row, integrator and precision. A cell runs worlds, holds them against
 * what theory or a header says must come out, and says in a word and a number what did.
 */
#ifndef STEADFAST_TESTS_MATRIX_H
#define STEADFAST_TESTS_MATRIX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "steadfast/base.h"

#define CELL_TEXT 18

typedef struct cell {
    char text[CELL_TEXT + 1]; /* "decays 0.82" */
    char broken[240];         /* the first expectation that did not hold, with its place; empty: all held */
} cell;

/* What a cell says: a word; with a number between ("off ", 0.3, " m"); with a change, 0.01 being +1%; with a tick. */
void cell_word(cell *c, const char *word);
void cell_number(cell *c, const char *before, double number, const char *after);
void cell_change(cell *c, const char *word, double change);
void cell_tick(cell *c, const char *word, uint64_t tick);

/* Hold or break the cell. The second wants |actual - expected| <= tolerance, and so breaks it for every NaN. */
#define EXPECT(c, condition) cell_expect(c, condition, #condition, __FILE__, __LINE__)
#define EXPECT_CLOSE(c, actual, expected, tolerance) \
    cell_expect_close(c, (double)(actual), (double)(expected), (double)(tolerance), #actual, __FILE__, __LINE__)
/* Breaks the cell for an error, with what it says: for what a smaller machine may refuse. Returns whether there was none. */
#define EXPECT_OK(c, result) cell_expect_ok(c, result, __FILE__, __LINE__)
void cell_expect(cell *c, bool holds, const char *what, const char *file, int line);
void cell_expect_close(cell *c, double actual, double expected, double tolerance, const char *what, const char *file, int line);
bool cell_expect_ok(cell *c, stf_result result, const char *file, int line);

/* For what a cell needs before it can say anything: ends the program with one line if it fails. */
#define MUST(result) matrix_must(result, __FILE__, __LINE__)
void matrix_must(stf_result result, const char *file, int line);

typedef struct row {
    const char *label;
    double value;
    bool heavy; /* takes long or much memory: not in the quick part */
} row;

typedef struct axis {
    const char *title, *holds; /* and what must hold, by what */
    const row *rows;
    size_t row_count;
    void (*run)(cell *c, const char *integrator, const row *r);
} axis;

#define ROWS(array) .rows = (array), .row_count = sizeof(array) / sizeof *(array)

/* The name of an axis in the precision that the file is compiled for. */
#ifdef STF_DOUBLE
#define AXIS(name) const axis name##_double
#else
#define AXIS(name) const axis name##_float
#endif

#endif
