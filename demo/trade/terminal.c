#define _POSIX_C_SOURCE 199309L
#include "terminal.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#define NANO 1e-9
#define CLEAR_LINE "\r\033[K"

double monotonic_seconds(void *user)
{
    struct timespec now = {0};
    (void)user;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + NANO * (double)now.tv_nsec;
}

void show_progress(const char *what, const char *part, double fraction)
{
    if (!isatty(STDERR_FILENO))
        return;
    if (what)
        fprintf(stderr, CLEAR_LINE "trade: %s, %s: %.0f %%", what, part, 100 * fraction);
    else
        fputs(CLEAR_LINE, stderr);
    fflush(stderr);
}
