#include "pictures.h"

#include <stdio.h>
#include <stdlib.h>

#include "plot.h"
#include "terminal.h"

#define PATH_LENGTH 4096
#define NAME_LENGTH 128

bool pictures_check(const char *folder)
{
    return plot_close(plot_open(folder, "stability.gp"));
}

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
        good = plot_write_diagram(folder, &sweeps[i]);
    good = good && plot_write_maps(folder) && quote(folder, quoted, sizeof quoted);
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
