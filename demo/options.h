/* options: what the command line asks for. */
#ifndef STEADFAST_DEMO_OPTIONS_H
#define STEADFAST_DEMO_OPTIONS_H

#include "command_line.h"
#include "session.h"

typedef enum run_mode { MODE_WINDOW, MODE_HEADLESS, MODE_PICTURES, MODE_LIST, MODE_HELP } run_mode;

/* px. A window or picture that is smaller has no room for figures that can be read. */
#define WIDTH_MIN 800
#define HEIGHT_MIN 640

struct options {
    run_mode mode;
    settings settings; /* scene NULL: none asked for */
    unsigned threads; /* 0: not asked for */
    bool has_ticks;
    uint64_t ticks;
    int width, height; /* px; 0: not asked for */
    const char *csv, *png, *out; /* paths, or NULL */
};

/* False: said on stderr in one line what is wrong and what to do. */
bool options_parse(options *o, int count, char *const arguments[]);

void options_print_help(void);
void options_print_list(void);

#endif
