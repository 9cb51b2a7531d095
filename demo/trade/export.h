/* What programs read. */
#ifndef STEADFAST_TRADE_EXPORT_H
#define STEADFAST_TRADE_EXPORT_H

#include <stdio.h>

#include "sweep.h"

void export_csv_head(FILE *csv);
void export_csv(FILE *csv, const sweep *s);

/* An array of scenes, with their rows and picks. */
void export_json(FILE *json, const sweep *sweeps, size_t count);

#endif
