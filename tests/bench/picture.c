/* The picture: ns a particle against particles, float, gravity and drag. */
#include <stdlib.h>
#include <string.h>

#include "rows.h"

/* Okabe and Ito's colours, told apart by the colour-blind too. */
static const struct {
    const char *row, *title, *style;
} lines[] = {
    {"rk4", "RK4", "lc '#d55e00' lw 4 pt 7 ps 1.2"},
    {"rk4, fused loop", "its fused loop", "lc '#7a3600' lw 1.5 dt 2 pt 6 ps 1.2"},
    {"velocity_verlet", "velocity Verlet", "lc '#009e73' lw 4 pt 5 ps 1.2"},
    {"velocity_verlet, fused loop", "its fused loop", "lc '#004d38' lw 1.5 dt 2 pt 4 ps 1.2"},
    {"semi_implicit_euler", "semi-implicit Euler", "lc '#56b4e9' lw 4 pt 9 ps 1.5"},
    {"semi_implicit_euler, fused loop", "its fused loop", "lc '#0072b2' lw 1.5 dt 2 pt 8 ps 1.4"},
    {"limit: update of the same bytes", "memory limit of Euler", "lc '#bbbbbb' lw 8"},
};

#define LINES (sizeof lines / sizeof *lines)

static bool on_line(const bench_row *row, size_t line)
{
    return row->precision == &bench_float && row->result.measured && strcmp(row->name, lines[line].row) == 0;
}

static void write_data(FILE *file, const bench_row *rows, size_t count)
{
    for (size_t line = 0; line < LINES; line++) {
        fprintf(file, "$line%zu << END\n", line);
        for (size_t i = 0; i < count; i++)
            if (on_line(&rows[i], line))
                fprintf(file, "%zu %g\n", rows[i].n, rows[i].result.median);
        fprintf(file, "END\n");
    }
}

static void write_plot(FILE *file, const char *terminal, const char *prefix, const char *suffix)
{
    fprintf(file, "set terminal %s\nset output '%s.%s'\nplot ", terminal, prefix, suffix);
    for (size_t line = 0; line < LINES; line++)
        fprintf(file, "%s$line%zu using 1:2 with %s %s title '%s'", line ? ", " : "", line,
                line + 1 < LINES ? "linespoints" : "lines", lines[line].style, lines[line].title);
    fprintf(file, "\n");
}

void bench_picture(const bench_row *rows, size_t count, const char *prefix)
{
    char script[512], command[600];

    snprintf(script, sizeof script, "%s.gp", prefix);
    FILE *file = fopen(script, "w");
    if (!file) {
        fprintf(stderr, "bench: can't write %s: give --picture a place where files can be written\n", script);
        return;
    }
    write_data(file, rows, count);
    fprintf(file, "set logscale xy\nset grid xtics ytics lt 1 lc '#dddddd' lw 1\nset border 3 lc '#666666'\nset tics nomirror\n"
                  "set xrange [700:1.4e7]\nset yrange [0.2:*]\nset format x '10^{%%T}'\n"
                  "set ytics (0.2, 0.5, 1, 2, 5, 10, 20, 50)\n"
                  "set xlabel 'particles'\nset ylabel 'ns a particle a step'\n"
                  "set title \"A step with gravity and linear drag, float, 3D, one core\\n{/*0.8 %s, %s, %s}\" noenhanced\n"
                  "set title enhanced\nset key bmargin center vertical Left reverse maxrows 2 spacing 1.3 samplen 3\n",
            measure_processor(), measure_compiler(), bench_isa());
    write_plot(file, "svg size 1280,720 font 'sans-serif,17' background '#ffffff'", prefix, "svg");
    write_plot(file, "pngcairo size 1280,720 font 'sans,13' background '#ffffff'", prefix, "png");
    fclose(file);
    snprintf(command, sizeof command, "gnuplot '%s'", script);
    if (system("command -v gnuplot >/dev/null 2>&1") != 0)
        printf("\nNo picture: gnuplot is not there (make deps ALSO=gnuplot); its script is %s\n", script);
    else if (system(command) != 0)
        fprintf(stderr, "bench: gnuplot failed on %s: run it by hand to see why\n", script);
    else
        printf("\nPicture: %s.png and %s.svg\n", prefix, prefix);
}
