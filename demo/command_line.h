/* command_line: how both programs, the demo and trade, read their options. No SDL in here. */
#ifndef STEADFAST_DEMO_COMMAND_LINE_H
#define STEADFAST_DEMO_COMMAND_LINE_H

#include "scenes/scene.h"

enum { EXIT_USAGE = 2 }; /* beside EXIT_SUCCESS and EXIT_FAILURE */

/* What is asked for: each program has a struct of its own. */
typedef struct options options;

typedef struct option {
    const char *name, *value; /* "--step", "S"; "": it has none */
    bool (*take)(options *o, const char *value); /* false: said on stderr what is wrong. NULL: it has no value, but: */
    unsigned flag;
    const char *help;
} option;

/* What messages start with, and the options, up to one without a name: each program has its own. */
extern const char command_name[];
extern const option command_options[];

/* *flags gets those of all options without a value. False: said on stderr in one line what is wrong and what to do. */
bool command_line_parse(options *o, unsigned *flags, int count, char *const arguments[]);

void command_line_print_options(void);
void command_line_print_integrators(void);

/* On stderr, in one line behind the command's name. Always false. */
STF_PRINTF(1, 2) bool complain(const char *format, ...);

/* Read a value. NULL or false: it is none, and stderr says so. */
const scene *read_scene(const char *value);
const stf_integrator *read_integrator(const char *value);
bool read_whole(const char *option_name, const char *value, uint64_t least, uint64_t most, uint64_t *number);

/* Whether `text` is such a number and nothing else; a whole one in plain digits. Says nothing. */
bool is_whole(const char *text, uint64_t least, uint64_t most, uint64_t *number);
bool is_number(const char *text, double least, double most, double *number);

#endif
