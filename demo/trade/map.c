/* Stability maps: where a step breaks. */
#include <math.h>

#include "growth.h"
#include "plot.h"
#include "terminal.h"

#define MAP_CELLS 80  /* a side of the measured map */
#define MAP_LINES 320 /* a side of the grid on which the boundary is looked for */
#define MAP_SIDE 3.2  /* of k dt and omega dt */

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
    char name[PLOT_NAME_LENGTH];

    while (stf_integrators[count])
        count++;
    plot_write_setup(script);
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
                plot_name(stf_integrators[place]->name, name), (unsigned long)place, (unsigned long)place);
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

bool plot_write_maps(const char *folder)
{
    FILE *data = plot_open(folder, "stability.dat"), *theory = data ? plot_open(folder, "stability.theory") : NULL;
    FILE *script = theory ? plot_open(folder, "stability.gp") : NULL;

    if (script) {
        write_growth(data, theory);
        write_map_script(script);
    }
    const bool data_written = plot_close(data), theory_written = plot_close(theory), script_written = plot_close(script);

    return data_written && theory_written && script_written;
}
