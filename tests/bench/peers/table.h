/* What the tables of peers.c and race.c share. */
#ifndef STEADFAST_TESTS_TABLE_H
#define STEADFAST_TESTS_TABLE_H

#include <stdio.h>

#include "peer.h"

/* The peers that were found when this was built, ours first, NULL-terminated (list.c, which make writes). */
extern const peer *const peers[];

/* A way of a peer to do a workload, and what came of it. */
typedef struct entry {
    const peer *peer;
    const method *method;
    const workload *workload;
    void *self; /* while it is measured */
    unsigned steps; /* in a run of FLIGHT and CLOTH */
    double setting; /* of the race */
    double error, tolerance; /* how far it is off, and how far it may be */
} entry;

bool is_ours(const peer *p);

/* Whether "section/peer/method" is to be run: it holds the word that was asked for, or nothing was asked. */
bool asked(const char *section, const peer *p, const method *m);

/* Whether any row of the section is. */
bool asked_section(const char *section);

/* One line for the CSV file, if there is one. count: of bodies or ties. */
void write_csv(const char *section, size_t count, const entry *e, const char *setting, double value, const char *unit,
               double ratio);

/* The work-precision tables. */
void race(void);

#endif
