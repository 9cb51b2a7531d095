/* What diagrams and maps share: files in the folder of pictures, and how gnuplot's scripts begin. */
#ifndef STEADFAST_TRADE_PLOT_H
#define STEADFAST_TRADE_PLOT_H

#include <stdio.h>

#include "sweep.h"

#define PLOT_NAME_LENGTH 64
#define PLOT_STYLES 7 /* gnuplot's line styles 1 to 7: a colour and a shape each; style 100 is a quiet line */

/* The file FOLDER/name, to be written; NULL: stderr says why. */
STF_PRINTF(2, 3) FILE *plot_open(const char *folder, const char *format, ...);

/* Closes it, if it is there. Whether it was written to its end. */
bool plot_close(FILE *file);

/* Terminal, colours, axes. Runs of gnuplot start in the folder; `output` and `format` are given on its command line. */
void plot_write_setup(FILE *script);

/* A name as people write it: gnuplot takes _ for a subscript. */
const char *plot_name(const char *name, char text[PLOT_NAME_LENGTH]);

/* The data and script of a scene's work-precision diagram; of the stability maps. Whether they could be written. */
bool plot_write_diagram(const char *folder, const sweep *s);
bool plot_write_maps(const char *folder);

#endif
