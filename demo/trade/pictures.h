/* Work-precision diagrams and stability maps, drawn by gnuplot. */
#ifndef STEADFAST_TRADE_PICTURES_H
#define STEADFAST_TRADE_PICTURES_H

#include "sweep.h"

/* Whether files can be written into the folder; if not, says so on stderr. */
bool pictures_check(const char *folder);

/*
 * Writes data and gnuplot's scripts into the folder and has gnuplot make trade_SCENE and stability as .svg and .png. Where
 * gnuplot is not there, the data and the scripts are, and stderr says so.
 */
bool pictures_draw(const char *folder, const sweep *sweeps, size_t count);

#endif
