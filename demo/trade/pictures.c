#include "pictures.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "growth.h"
#include "table.h"
#include "terminal.h"

#define PATH_LENGTH 4096
#define NAME_LENGTH 128
#define WIDTH 1280
#define HEIGHT 720
#define MAP_CELLS 80   /* a side of the measured map */
#define MAP_LINES 320  /* a side of the grid on which the boundary is looked for */
#define MAP_SIDE 3.2   /* of k dt and omega dt */
#define MOST_ERROR 3   /* of the scene's size: worse is not drawn */

/* Okabe and Ito's colours, which people tell apart however they see them; and a shape each. */
static const struct {
    const char *colour;
    int shape;
} styles[] = {{"#7f7f7f", 1}, {"#E69F00", 5}, {"#56B4E9", 8}, {"#CC79A7", 10},
              {"#0072B2", 7}, {"#009E73", 12}, {"#D55E00", 13}};

#define STYLES (sizeof styles / sizeof *styles)

/* The file FOLDER/name, to be written; NULL: stderr says why. */
STF_PRINTF(2, 3) static FILE *open_in(const char *folder, const char *format, ...)
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

bool pictures_check(const char *folder)
{
    FILE *script = open_in(folder, "stability.gp");

    return script && fclose(script) == 0;
}

/* ---- what both kinds of pictures begin with -------------------------------------------------------------------------- */

/* Runs of gnuplot start in its folder; `output` and `format` are asked for on its command line. */
static void write_setup(FILE *script)
{
    fprintf(script,
            "if (format eq 'svg') { set terminal svg size %d,%d font 'sans,14' background '#ffffff' } else "
            "{ set terminal pngcairo size %d,%d font 'sans,11' background '#ffffff' }\n"
            "set encoding utf8\nset output output\n"
            "set border 3 linecolor '#555555'\nset tics nomirror out textcolor '#333333'\n"
            "set grid linecolor '#e4e4e4' linetype 1\n"
            "set style line 100 linecolor '#b0b0b0' dashtype 3\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT);
    for (size_t i = 0; i < STYLES; i++)
        fprintf(script, "set style line %lu linecolor '%s' linewidth 2 pointtype %d pointsize 1\n", (unsigned long)i + 1,
                styles[i].colour, styles[i].shape);
}

/* Names as people write them: gnuplot takes _ for a subscript. */
static const char *plain(const char *name, char text[64])
{
    snprintf(text, 64, "%s", name);
    for (char *c = text; *c; c++)
        *c = *c == '_' ? ' ' : *c;
    return text;
}

/* ---- error against cost ---------------------------------------------------------------------------------------------- */

static bool is_drawn(const sweep *s, const stf_trade_row *row)
{
    return row->bounded && stf_trade_error_is_known(row) && row->largest_error < MOST_ERROR * s->scene->size;
}

/* A block each precision and integrator, float first; then one each precision of the rows on the front. */
static void write_rows(FILE *data, const sweep *s)
{
    fprintf(data, "# cost [ns a particle for each %s], largest error [%s]\n", s->scene->time_unit, s->scene->length_unit);
    for (size_t i = 0; i < s->count; i++) {
        const stf_trade_row *row = &s->rows[i];

        if (i % s->levels == 0)
            fprintf(data, "%s# %s, %s\nNaN NaN\n", i > 0 ? "\n\n" : "", row->integrator, row->in_double ? "double" : "float");
        if (is_drawn(s, row))
            fprintf(data, "%.6g %.6g\n", row->nanoseconds, row->largest_error);
    }
    for (int in_double = 0; in_double < 2; in_double++) {
        fprintf(data, "\n\n# on the front, %s\nNaN NaN\n", in_double ? "double" : "float");
        for (size_t i = 0; i < s->count; i++)
            if (s->rows[i].on_front && s->rows[i].in_double == in_double && is_drawn(s, &s->rows[i]))
                fprintf(data, "%.6g %.6g\n", s->rows[i].nanoseconds, s->rows[i].largest_error);
    }
}

/* A decade more on either side than there are points. */
static void write_ranges(FILE *script, const sweep *s)
{
    double least_cost = HUGE_VAL, most_cost = 0, least_error = table_tolerances[2] * s->scene->size;

    for (size_t i = 0; i < s->count; i++)
        if (is_drawn(s, &s->rows[i])) {
            least_cost = fmin(least_cost, s->rows[i].nanoseconds);
            most_cost = fmax(most_cost, s->rows[i].nanoseconds);
            least_error = fmin(least_error, s->rows[i].largest_error);
        }
    if (most_cost > 0)
        fprintf(script, "set xrange [%g:%g]\n", least_cost / 1.5, most_cost * 1.5);
    fprintf(script, "set yrange [%g:%g]\n", least_error / 3, MOST_ERROR * s->scene->size);
}

static void write_panel(FILE *script, const sweep *s, bool in_double, size_t blocks, size_t first_block)
{
    char name[64];

    fprintf(script, "set title 'in %s' offset 0,-0.5\nplot ", in_double ? "double" : "float");
    for (size_t i = 0; i < sizeof table_tolerances / sizeof *table_tolerances; i++)
        fprintf(script, "%g notitle with lines linestyle 100, ", table_tolerances[i] * s->scene->size);
    fprintf(script, "'trade_%s.dat' index %lu %s with points pointtype 6 pointsize 2.4 linewidth 1.5 linecolor '#333333', \\\n",
            s->scene->name, (unsigned long)(blocks + in_double), in_double ? "notitle" : "title 'none is better'");
    for (size_t i = 0; i < s->integrator_count; i++) {
        const size_t place = s->integrators[i];

        fprintf(script, "     '' index %lu ", (unsigned long)(first_block + i));
        if (in_double && first_block > 0)
            fprintf(script, "notitle");
        else
            fprintf(script, "title '%s'", plain(stf_integrators[place]->name, name));
        fprintf(script, " with linespoints linestyle %lu%s\n", (unsigned long)(place % STYLES) + 1,
                i + 1 < s->integrator_count ? ", \\" : "");
    }
}

/* Beside the right panel, where no data is. */
static void write_tolerances(FILE *script, const sweep *s)
{
    for (size_t i = 0; i < sizeof table_tolerances / sizeof *table_tolerances; i++)
        fprintf(script, "set label %lu '%g size' at graph 1.01, first %g left font ',9' textcolor '#777777'\n",
                (unsigned long)i + 1, table_tolerances[i], table_tolerances[i] * s->scene->size);
}

static void write_script(FILE *script, const sweep *s)
{
    const size_t each = s->integrator_count, blocks = s->count / s->levels;
    const bool both = blocks > each, in_days = strcmp(s->scene->time_unit, "days") == 0;

    write_setup(script);
    write_ranges(script, s);
    fprintf(script,
            "set logscale xy\nset format xy '10^{%%L}'\nset xlabel 'cost [ns a particle for each simulated %s]'\n"
            "set multiplot title \"%s: what accuracy costs\" font ',15'\n"
            "set key at screen 0.5,0.035 center bottom horizontal maxrows 2 samplen 3 width 2 textcolor '#333333'\n"
            "set tmargin at screen 0.87\nset bmargin at screen 0.24\n",
            in_days ? "day" : "second", s->scene->title);
    fprintf(script, "set lmargin at screen 0.075\nset rmargin at screen %s\nset ylabel 'largest error, RMS [%s]'\n",
            both ? "0.495" : "0.925", s->scene->length_unit);
    if (both) {
        write_panel(script, s, false, blocks, 0);
        fprintf(script, "set lmargin at screen 0.515\nset rmargin at screen 0.935\nunset ylabel\nset format y ''\n");
    }
    write_tolerances(script, s);
    write_panel(script, s, s->rows[s->count - 1].in_double, blocks, both ? each : 0);
    fprintf(script, "unset multiplot\n");
}

static bool write_diagram(const char *folder, const sweep *s)
{
    FILE *data = open_in(folder, "trade_%s.dat", s->scene->name);
    FILE *script = data ? open_in(folder, "trade_%s.gp", s->scene->name) : NULL;
    bool written = script != NULL;

    if (data) {
        write_rows(data, s);
        written = !ferror(data) && written;
        written = fclose(data) == 0 && written;
    }
    if (script) {
        write_script(script, s);
        written = !ferror(script) && written;
        written = fclose(script) == 0 && written;
    }
    return written;
}

/* ---- where a step breaks --------------------------------------------------------------------------------------------- */

/* A block an integrator: omega dt, k dt, log2 of the measured growth at the middles of cells. */
static void write_growth(FILE *data, FILE *theory)
{
    fprintf(data, "# omega dt, k dt, log2 of the measured growth a step\n");
    fprintf(theory, "# omega dt, k dt, above 0 where theory says that something grows\n");
    for (size_t place = 0; stf_integrators[place]; place++) {
        fprintf(data, "%s# %s\n", place > 0 ? "\n\n" : "", stf_integrators[place]->name);
        fprintf(theory, "%s# %s\n", place > 0 ? "\n\n" : "", stf_integrators[place]->name);
        show_progress("stability", stf_integrators[place]->name, 0);
        for (int row = 0; row < MAP_CELLS; row++)
            for (int column = 0; column < MAP_CELLS; column++) {
                const double k = MAP_SIDE * (row + 0.5) / MAP_CELLS, omega = MAP_SIDE * (column + 0.5) / MAP_CELLS;
                fprintf(data, "%.4f %.4f %.4f\n", omega, k, log2(fmax(growth_measured(place, k, omega), 0.001)));
            }
        for (int row = 0; row <= MAP_LINES; row++) {
            for (int column = 0; column <= MAP_LINES; column++) {
                const double k = MAP_SIDE * row / MAP_LINES, omega = MAP_SIDE * column / MAP_LINES;
                fprintf(theory, "%.4f %.4f %.6g\n", omega, k, growth_theory(place, k, omega));
            }
            fputs(row < MAP_LINES ? "\n" : "", theory);
        }
    }
    show_progress(NULL, NULL, 0);
}

static void write_map_script(FILE *script)
{
    size_t count = 0;
    char name[64];

    while (stf_integrators[count])
        count++;
    write_setup(script);
    fprintf(script,
            "set contour base\nset cntrparam levels discrete 1e-6\nunset surface\n"
            "do for [i=0:%lu] { set table sprintf('stability_%%d.line', i); "
            "splot 'stability.theory' index i using 1:2:3 with lines; unset table }\nunset contour\nset surface\n"
            "set multiplot layout 2,%lu title 'A spring with drag: what a step makes of it' font ',15' "
            "margins 0.05,0.985,0.085,0.88 spacing 0.035,0.13\n"
            "set xrange [0:%g]\nset yrange [0:%g]\nset xtics 1\nset ytics 1\n"
            "set cbrange [-1:1]\nunset colorbox\nunset grid\nset key off\n"
            "set palette defined (-1 '#0072B2', -0.02 '#eaf3f9', 0 '#ffffff', 0.02 '#fcece2', 1 '#D55E00')\n",
            (unsigned long)count - 1, (unsigned long)(count + 2) / 2, MAP_SIDE, MAP_SIDE);
    for (size_t place = 0; place < count; place++)
        fprintf(script,
                "set title '%s' offset 0,-0.6\nset xlabel 'ω dt' offset 0,0.6\nset ylabel 'k dt' offset 1.5,0\n"
                "plot 'stability.dat' index %lu using 1:2:3 with image, 'stability_%lu.line' using 1:2 with lines linewidth 2 "
                "linecolor '#000000'\n",
                plain(stf_integrators[place]->name, name), (unsigned long)place, (unsigned long)place);
    /* What the colours mean, in the last place. */
    fprintf(script,
            "unset border\nunset tics\nunset xlabel\nunset ylabel\nunset title\nset xrange [0:1]\nset yrange [0:1]\n"
            "set label 1 'growth a step, measured' at 0.02,0.93 font ',11' textcolor '#333333'\n"
            "set label 2 '½ or less' at 0.02,0.70\nset label 3 '1' at 0.5,0.70 center\n"
            "set label 4 '2 or more' at 0.98,0.70 right\n"
            "set object 1 rectangle from 0.02,0.42 to 0.14,0.48 fillcolor '#000000' fillstyle solid noborder\n"
            "set label 5 'theory: nothing grows' at 0.2,0.45\nset label 6 'on its blue side' at 0.2,0.36\n"
            "set label 7 'k: drag over mass' at 0.02,0.18 textcolor '#777777'\n"
            "set label 8 'ω: √(stiffness / mass)' at 0.02,0.08 textcolor '#777777'\n"
            "set samples 100\nset isosamples 2,2\n"
            "plot '+' using ($0/99.*0.96+0.02):(0.80):(-1.+2.*$0/99.) with points pointtype 5 pointsize 2.2 palette\n"
            "unset multiplot\n");
}

static bool write_map(const char *folder)
{
    FILE *data = open_in(folder, "stability.dat"), *theory = data ? open_in(folder, "stability.theory") : NULL;
    FILE *script = theory ? open_in(folder, "stability.gp") : NULL;
    bool written = script != NULL;

    if (written) {
        write_growth(data, theory);
        write_map_script(script);
    }
    FILE *const files[] = {data, theory, script};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        if (files[i]) {
            written = !ferror(files[i]) && written;
            written = fclose(files[i]) == 0 && written;
        }
    return written;
}

/* ---- gnuplot --------------------------------------------------------------------------------------------------------- */

/* A folder in single quotes, for a shell. false: it does not fit. */
static bool quote(const char *folder, char *quoted, size_t size)
{
    size_t length = 0;

    for (quoted[length++] = '\''; *folder; folder++) {
        if (length + 6 > size)
            return false;
        if (*folder == '\'')
            length += (size_t)sprintf(quoted + length, "'\\''");
        else
            quoted[length++] = *folder;
    }
    quoted[length++] = '\'';
    quoted[length] = '\0';
    return true;
}

static bool draw(const char *quoted_folder, const char *name)
{
    static const char *const formats[] = {"svg", "png"};
    char command[2 * PATH_LENGTH];

    for (int i = 0; i < 2; i++) {
        snprintf(command, sizeof command, "cd -- %s && gnuplot -e \"format='%s'; output='%s.%s'\" %s.gp", quoted_folder,
                 formats[i], name, formats[i], name);
        if (system(command) != 0) {
            fprintf(stderr, "trade: gnuplot could not draw %s.%s; its script, %s.gp, is in the same folder\n", name, formats[i],
                    name);
            return false;
        }
    }
    return true;
}

bool pictures_draw(const char *folder, const sweep *sweeps, size_t count)
{
    char quoted[PATH_LENGTH], name[NAME_LENGTH];
    bool good = true;

    for (size_t i = 0; i < count && good; i++)
        good = write_diagram(folder, &sweeps[i]);
    good = good && write_map(folder) && quote(folder, quoted, sizeof quoted);
    if (!good)
        return false;
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        fprintf(stderr, "trade: gnuplot is not there, so there are no pictures, only their data: type: make deps\n");
        return true;
    }
    for (size_t i = 0; i < count && good; i++) {
        show_progress("gnuplot", sweeps[i].scene->name, (double)i / (double)count);
        snprintf(name, sizeof name, "trade_%s", sweeps[i].scene->name);
        good = draw(quoted, name);
    }
    good = good && draw(quoted, "stability");
    show_progress(NULL, NULL, 0);
    return good;
}
