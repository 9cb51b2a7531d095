/* rows: what the benchmark shows, and what is measured in one list for it. */
#ifndef STEADFAST_TESTS_ROWS_H
#define STEADFAST_TESTS_ROWS_H

#include "measure.h"
#include "workload.h"

#define GROUP_MAX 8
#define NAME_MAX_LENGTH 48

/* How a row is compared. */
typedef enum bench_comparison { ALONE, RATIO, DIFFERENCE, VALUE } bench_comparison;

/* One line: a case, and what it is compared with. */
typedef struct bench_row {
    char name[NAME_MAX_LENGTH];
    const bench_precision *precision;
    bench_kind kind;
    const char *integrator;
    size_t n;
    const char *unit;
    bool library; /* else a reference or a limit */
    size_t measured, first_reference, last_reference; /* cases of the group; of several references the fastest counts */
    bench_comparison comparison;
    double target;         /* the ratio, the difference or the value is to be at most this; 0: none */
    double rate;           /* bytes or operations an item; 0: not shown */
    const char *rate_unit; /* of rate per ns */
    /* what was found */
    measure_result result;
    double compared; /* 0: not */
} bench_row;

/* Cases that are measured in turns, and the rows that they give. */
typedef struct bench_group {
    bench_scene scenes[GROUP_MAX];
    measure_case cases[GROUP_MAX];
    bench_row rows[GROUP_MAX];
    size_t cases_count, rows_count;
    measure_plan plan;
} bench_group;

/* Gives each group in turn to `take`, largest last. quick: no more than 1e5 particles. */
void bench_groups(bool quick, void (*take)(bench_group *group, void *user), void *user);

/* Whether a name on the command line means this row: a part of what bench_row_text gives. */
void bench_row_text(const bench_row *row, char *text, size_t size);

/* Measures a group, unless it has but VALUE rows, and fills in what was found. */
void bench_run_group(bench_group *group);

/* Creation of n particles by stf_world_add_many beside memcpy; in float. */
void bench_creation_group(bench_group *group, size_t n);

/* A snapshot and its restoration beside memcpy; in float. */
void bench_rollback_group(bench_group *group, const char *integrator, size_t n);

/* ---- report ---- */

void bench_print_header(FILE *file, bool pinned);
void bench_print_row(FILE *file, const bench_row *row);
void bench_csv_header(FILE *file);
void bench_csv_row(FILE *file, const bench_row *row);

/* Draws ns a particle against particles into PREFIX.svg and PREFIX.png; says so if there is no gnuplot. */
void bench_picture(const bench_row *rows, size_t count, const char *prefix);

#endif
