#include "command_line.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool complain(const char *format, ...)
{
    va_list arguments;

    fprintf(stderr, "%s: ", command_name);
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    return false;
}

const scene *read_scene(const char *value)
{
    const scene *found = scene_find(value);

    if (found)
        return found;
    fprintf(stderr, "%s: there is no scene \"%s\"; choose one of:", command_name, value);
    for (const scene *const *each = scenes; *each; each++)
        fprintf(stderr, " %s", (*each)->name);
    fputc('\n', stderr);
    return NULL;
}

const stf_integrator *read_integrator(const char *value)
{
    const stf_integrator *found = stf_integrator_find(value);

    if (found)
        return found;
    fprintf(stderr, "%s: there is no integrator \"%s\"; choose one of:", command_name, value);
    for (const stf_integrator *const *each = stf_integrators; *each; each++)
        fprintf(stderr, " %s", (*each)->name);
    fputc('\n', stderr);
    return NULL;
}

bool is_whole(const char *text, uint64_t least, uint64_t most, uint64_t *number)
{
    char *end;

    if (!isdigit((unsigned char)*text))
        return false;
    errno = 0;
    *number = strtoull(text, &end, 10);
    return errno == 0 && *end == '\0' && *number >= least && *number <= most;
}

bool is_number(const char *text, double least, double most, double *number)
{
    char *end;

    *number = strtod(text, &end);
    return end != text && *end == '\0' && !isspace((unsigned char)*text) && *number >= least && *number <= most;
}

bool read_whole(const char *option_name, const char *value, uint64_t least, uint64_t most, uint64_t *number)
{
    return is_whole(value, least, most, number) ||
           complain("%s wants a whole number from %llu to %llu, not \"%s\"", option_name, (unsigned long long)least,
                    (unsigned long long)most, value);
}

static const option *find_option(const char *name)
{
    for (const option *each = command_options; each->name; each++)
        if (strcmp(each->name, name) == 0)
            return each;
    return NULL;
}

bool command_line_parse(options *o, unsigned *flags, int count, char *const arguments[])
{
    *flags = 0;
    for (int i = 1; i < count; i++) {
        const option *found = find_option(arguments[i]);

        if (!found)
            return complain("\"%s\" is no option; --help lists them", arguments[i]);
        *flags |= found->flag;
        if (!found->take)
            continue;
        if (i + 1 == count || find_option(arguments[i + 1]))
            return complain("%s wants a value behind it; --help lists the options", arguments[i]);
        if (!found->take(o, arguments[++i]))
            return false;
    }
    return true;
}

void command_line_print_options(void)
{
    for (const option *each = command_options; each->name; each++)
        printf("  %-12s %-7s %s\n", each->name, each->value, each->help);
}

void command_line_print_integrators(void)
{
    printf("integrators\n");
    for (const stf_integrator *const *each = stf_integrators; *each; each++)
        printf("  %-20s order %d, %d acceleration%s a step\n", (*each)->name, (*each)->order, (*each)->evaluations,
               (*each)->evaluations == 1 ? "" : "s");
}
