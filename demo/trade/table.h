/* What a person reads. */
#ifndef STEADFAST_TRADE_TABLE_H
#define STEADFAST_TRADE_TABLE_H

#include "sweep.h"

/* The scene, its reference, every row, the errors at equal cost, and what to pick. */
void table_print(const sweep *s);

/* The pick for a tolerance as a part of the scene's size (0: not asked), and for a budget in ns a particle for each unit of
   simulated time (0: not asked). */
void table_print_answers(const sweep *s, double tolerance, double budget);

/* One row of the README's table: the picks in one precision. */
void table_print_markdown_head(void);
void table_print_markdown(const sweep *s);

/* The tolerances of tables and diagrams, as parts of the scene's size. */
extern const double table_tolerances[3];

/* "1/60 s" where it is a whole part of a second, else "0.0123 s". */
const char *table_step(const sweep *s, const stf_trade_row *row, char text[64]);

#endif
