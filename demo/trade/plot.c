#include "plot.h"

#include <errno.h>
#include <stdarg.h>
#include <string.h>

#define PATH_LENGTH 4096
#define WIDTH 1280
#define HEIGHT 720

/* Okabe and Ito's colours, which people tell apart however they see them; and a shape each. */
static const struct {
    const char *colour;
    int shape;
} styles[PLOT_STYLES] = {{"#7f7f7f", 1}, {"#E69F00", 5}, {"#56B4E9", 8}, {"#CC79A7", 10},
              {"#0072B2", 7}, {"#009E73", 12}, {"#D55E00", 13}};

FILE *plot_open(const char *folder, const char *format, ...)
{
    char path[PATH_LENGTH];
    const int length = snprintf(path, sizeof path, "%s/", folder);
    va_list arguments;

    if (length < 0 || (size_t)length >= sizeof path)
        return NULL;
    va_start(arguments, format);
    vsnprintf(path + length, sizeof path - (size_t)length, format, arguments);
    va_end(arguments);
    errno = 0;
    FILE *file = fopen(path, "w");
    if (!file)
        fprintf(stderr, "trade: can't write \"%s\" (%s): --pictures wants a folder that exists and may be written\n", path,
                strerror(errno));
    return file;
}

bool plot_close(FILE *file)
{
    if (!file)
        return false;

    const bool written = !ferror(file);

    return fclose(file) == 0 && written;
}

void plot_write_setup(FILE *script)
{
    fprintf(script,
            "if (format eq 'svg') { set terminal svg size %d,%d font 'sans,14' background '#ffffff' } else "
            "{ set terminal pngcairo size %d,%d font 'sans,11' background '#ffffff' }\n"
            "set encoding utf8\nset output output\n"
            "set border 3 linecolor '#555555'\nset tics nomirror out textcolor '#333333'\n"
            "set grid linecolor '#e4e4e4' linetype 1\n"
            "set style line 100 linecolor '#b0b0b0' dashtype 3\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT);
    for (size_t i = 0; i < PLOT_STYLES; i++)
        fprintf(script, "set style line %lu linecolor '%s' linewidth 2 pointtype %d pointsize 1\n", (unsigned long)i + 1,
                styles[i].colour, styles[i].shape);
}

const char *plot_name(const char *name, char text[PLOT_NAME_LENGTH])
{
    snprintf(text, PLOT_NAME_LENGTH, "%s", name);
    for (char *c = text; *c; c++)
        *c = *c == '_' ? ' ' : *c;
    return text;
}
