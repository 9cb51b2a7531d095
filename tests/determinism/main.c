/*
 * same_bits: steps every scene under every integrator in both precisions and prints a hash of each, or compares with those kept
 * in a file. Needs nothing but the library, the scenes and POSIX threads, so that it runs wherever a cross compiler builds for.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cell.h"
#include "pool.h"
#include "steadfast/integrator.h"

#define TICKS 10000
#define QUICK_TICKS 500
#define THREADS_MAX 64
#define LINE_MAX_BYTES 256
#define NAME_MAX_BYTES 32
#define NOT_HERE 3 /* exit status: this machine does not have the instruction set that STEADFAST_ISA asks for */

static const char usage[] =
    "usage: same_bits [--quick] [--goldens FILE] [--threads N | --shuffle] [--write DIR] [--read DIR]\n"
    "prints the hash of every cell, or with --goldens the cells that are not as in FILE\n"
    "--quick: after 500 ticks, not 10,000\n"
    "--write: saves each world after a tenth of its ticks; --read: goes on from such saves\n";

void fail(const char *what, const char *of)
{
    fprintf(stderr, "same_bits: %s: %s\n", what, of);
    exit(2);
}

typedef struct golden {
    char scene[NAME_MAX_BYTES], integrator[NAME_MAX_BYTES], precision[NAME_MAX_BYTES];
    unsigned ticks, finite;
    uint64_t hash;
} golden;

static bool is_of(const golden *g, const cell *c)
{
    return g->ticks == c->ticks && strcmp(g->scene, c->scene_name) == 0 && strcmp(g->integrator, c->integrator_name) == 0 &&
           strcmp(g->precision, c->precision) == 0;
}

/* The first line of the file for this cell; false: it has none. */
static bool find_golden(FILE *file, const cell *c, golden *found)
{
    char line[LINE_MAX_BYTES];

    rewind(file);
    while (fgets(line, sizeof line, file))
        if (sscanf(line, "%31s %31s %31s %u %u %" SCNx64, found->scene, found->integrator, found->precision, &found->ticks,
                   &found->finite, &found->hash) == 6 && is_of(found, c))
            return true;
    return false;
}

static bool is_golden(FILE *goldens, const cell *c)
{
    golden g;

    if (!find_golden(goldens, c, &g)) {
        printf("  %s %s %s: no golden hash after %u ticks\n", c->scene_name, c->integrator_name, c->precision, c->ticks);
        return false;
    }
    if (g.hash == c->hash && g.finite == c->finite)
        return true;
    printf("  %s %s %s: after %u of %u ticks %016" PRIx64 ", expected after %u %016" PRIx64 "\n", c->scene_name, c->integrator_name,
           c->precision, c->finite, c->ticks, c->hash, g.finite, g.hash);
    return false;
}

static void print_cell(const cell *c)
{
    printf("%-13s %-20s %-7s %7u %7u %016" PRIx64 "\n", c->scene_name, c->integrator_name, c->precision, c->ticks, c->finite, c->hash);
}

static bool take_cell(FILE *goldens, cell c)
{
    if (!goldens)
        print_cell(&c);
    return !goldens || is_golden(goldens, &c);
}

/* Returns how many cells are not golden. */
static unsigned run_all(const cell_run *run, FILE *goldens)
{
    unsigned cells = 0, equal = 0;

    for (size_t scene = 0; scene < cell_scenes(); scene++)
        for (size_t k = 0; stf_integrators[k]; k++, cells += 2) {
            equal += take_cell(goldens, cell_run_f32(run, scene, k));
            equal += take_cell(goldens, cell_run_f64(run, scene, k));
        }
    if (goldens)
        printf("%u of %u\n", equal, cells);
    return cells - equal;
}

static unsigned threads_of(const char *text)
{
    char *end;
    const unsigned long n = strtoul(text, &end, 10);

    if (*end || n == 0 || n > THREADS_MAX)
        fail("no number of threads", text);
    return (unsigned)n;
}

static bool is_alone(const char *option) { return strcmp(option, "--quick") == 0 || strcmp(option, "--shuffle") == 0; }

/* false: there is no such option. */
static bool take_option(const char *option, const char *value, cell_run *run, FILE **goldens)
{
    if (strcmp(option, "--quick") == 0)
        run->ticks = QUICK_TICKS;
    else if (strcmp(option, "--shuffle") == 0)
        run->parallel = pool_shuffled();
    else if (strcmp(option, "--threads") == 0)
        run->parallel = pool_threads(threads_of(value));
    else if (strcmp(option, "--write") == 0)
        run->write = value;
    else if (strcmp(option, "--read") == 0)
        run->read = value;
    else if (strcmp(option, "--goldens") == 0)
        *goldens = fopen(value, "r");
    else
        return false;
    if (strcmp(option, "--goldens") == 0 && !*goldens)
        fail("cannot open", value);
    return true;
}

int main(int argc, char **argv)
{
    const char *isa = getenv("STEADFAST_ISA");
    cell_run run = {.ticks = TICKS};
    FILE *goldens = NULL;

    for (int i = 1; i < argc; i++) {
        const char *option = argv[i];

        if (!is_alone(option))
            i++;
        if (i == argc || !take_option(option, argv[i], &run, &goldens)) {
            fputs(usage, stderr);
            return 2;
        }
    }
    if (isa && strcmp(isa, cell_isa()) != 0) {
        fprintf(stderr, "same_bits: this machine or this library has no %s\n", isa);
        return NOT_HERE;
    }
    return run_all(&run, goldens) > 0;
}
