/* What C99 does not have: a timer that is better than clock(), and whether stderr is read by a person. */
#ifndef STEADFAST_TRADE_TERMINAL_H
#define STEADFAST_TRADE_TERMINAL_H

#include <stdbool.h>

/* s from any moment on; `user` is not used. */
double monotonic_seconds(void *user);

/* Shows where a long task is, on a line that the next one overwrites; nothing where stderr is no terminal. NULL clears it. */
void show_progress(const char *what, const char *part, double fraction);

#endif
