/* Work-precision diagrams: error against cost. */
#include <math.h>
#include <string.h>

#include "plot.h"
#include "table.h"

#define MOST_ERROR 3 /* of the scene's size: worse is not drawn */

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
    char name[PLOT_NAME_LENGTH];

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
            fprintf(script, "title '%s'", plot_name(stf_integrators[place]->name, name));
        fprintf(script, " with linespoints linestyle %lu%s\n", (unsigned long)(place % PLOT_STYLES) + 1,
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

    plot_write_setup(script);
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

bool plot_write_diagram(const char *folder, const sweep *s)
{
    FILE *data = plot_open(folder, "trade_%s.dat", s->scene->name);
    FILE *script = data ? plot_open(folder, "trade_%s.gp", s->scene->name) : NULL;

    if (script) {
        write_rows(data, s);
        write_script(script, s);
    }
    const bool data_written = plot_close(data), script_written = plot_close(script);

    return data_written && script_written;
}
