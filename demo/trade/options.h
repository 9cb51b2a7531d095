/* The command line. */
#ifndef STEADFAST_TRADE_OPTIONS_H
#define STEADFAST_TRADE_OPTIONS_H

#include "../command_line.h"
#include "sweep.h"

struct options {
    const scene *scene; /* NULL: all */
    sweep_settings sweep;
    double budget; /* ns a particle for each unit of simulated time; 0: not asked */
    const char *csv, *json, *pictures; /* NULL: not asked for */
    bool only_csv; /* no tables */
    bool markdown, list, help;
};

/* false: what is wrong has been said on stderr. */
bool options_parse(options *o, int count, char *const arguments[]);

void options_print_help(void);
void options_print_list(void);

#endif
