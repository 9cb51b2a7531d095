#ifdef __linux__
#define _GNU_SOURCE /* sched_setaffinity */
#else
#define _POSIX_C_SOURCE 200809L
#endif
#include "measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifdef __linux__
#include <sched.h>
#endif

#define DEFAULT_SAMPLE 4e-3 /* s: a clock of 50 ns and an interrupt of some us are well below a percent of it */
#define DEFAULT_TOTAL 1.0   /* s */
#define DEFAULT_ROUNDS 15
#define ROUNDS_MIN 3
#define NS 1e9

double measure_now(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec / NS;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

double measure_median(double *values, size_t count)
{
    if (count == 0)
        return 0;
    qsort(values, count, sizeof *values, compare);
    return (values[(count - 1) / 2] + values[count / 2]) / 2;
}

/* By the clock, less what the process did not get of it: with one thread, its time on the processor is the shorter. */
static double time_runs(const measure_case *c, void *context, unsigned runs)
{
    if (c->prepare)
        c->prepare(context);

    const clock_t processor = clock();
    const double start = measure_now();
    for (unsigned i = 0; i < runs; i++)
        c->run(context);
    const double taken = measure_now() - start, worked = (double)(clock() - processor) / CLOCKS_PER_SEC;
    return worked > 0 && worked < taken ? worked : taken;
}

/* The runs that fill a sample. */
static unsigned calibrate(const measure_case *c, void *context, double sample)
{
    unsigned runs = 1;
    double taken;

    while (!c->prepare && (taken = time_runs(c, context, runs)) < sample && runs < 1u << 30)
        runs = taken < sample / 4 ? runs * 4 : runs * 2;
    return runs;
}

/* One run more goes before, as the cases between the rounds took the caches for themselves. */
static void take_sample(const measure_case *c, void *context, measure_result *result)
{
    if (!c->prepare)
        c->run(context);

    const double taken = time_runs(c, context, result->runs);
    result->samples[result->rounds++] = taken * NS / (result->runs * c->items);
}

static void summarise(measure_result *result)
{
    double sorted[MEASURE_ROUNDS_MAX];

    memcpy(sorted, result->samples, sizeof sorted);
    result->median = measure_median(sorted, result->rounds);
    result->min = sorted[0];
    result->max = sorted[result->rounds - 1];
}

/* A round after the other until time is up, but no fewer than the least. */
static void run_rounds(const measure_case *cases, size_t count, const measure_plan *plan, void **contexts,
                       measure_result *results)
{
    const unsigned asked = plan->rounds ? plan->rounds : DEFAULT_ROUNDS;
    const unsigned most = asked < MEASURE_ROUNDS_MAX ? asked : MEASURE_ROUNDS_MAX;
    const unsigned least = most < ROUNDS_MIN ? most : ROUNDS_MIN;
    const double end = measure_now() + (plan->total > 0 ? plan->total : DEFAULT_TOTAL);

    for (unsigned r = 0; r < most && (r < least || measure_now() < end); r++)
        for (size_t i = 0; i < count; i++)
            if (contexts[i])
                take_sample(&cases[i], contexts[i], &results[i]);
}

void measure(const measure_case *cases, size_t count, const measure_plan *plan, measure_result *results)
{
    const double sample = plan->sample > 0 ? plan->sample : DEFAULT_SAMPLE;
    void **contexts = calloc(count, sizeof *contexts);

    memset(results, 0, count * sizeof *results);
    if (!contexts)
        return;
    for (size_t i = 0; i < count; i++) {
        contexts[i] = cases[i].setup(cases[i].argument);
        results[i].measured = contexts[i] != NULL;
        if (contexts[i])
            results[i].runs = calibrate(&cases[i], contexts[i], sample);
    }
    run_rounds(cases, count, plan, contexts, results);
    for (size_t i = 0; i < count; i++)
        if (contexts[i]) {
            summarise(&results[i]);
            if (cases[i].teardown)
                cases[i].teardown(contexts[i]);
        }
    free(contexts);
}

double measure_ratio(const measure_result *result, const measure_result *reference)
{
    double ratios[MEASURE_ROUNDS_MAX];

    if (!result->measured || !reference->measured)
        return 0;
    for (unsigned r = 0; r < result->rounds; r++)
        ratios[r] = result->samples[r] / reference->samples[r];
    return measure_median(ratios, result->rounds);
}

#ifdef __linux__
static cpu_set_t allowed;

bool measure_pin(void)
{
    const int core = sched_getcpu();
    cpu_set_t one;

    CPU_ZERO(&one);
    if (core >= 0)
        CPU_SET((size_t)core, &one);
    return sched_getaffinity(0, sizeof allowed, &allowed) == 0 && core >= 0 && sched_setaffinity(0, sizeof one, &one) == 0;
}

bool measure_unpin(void) { return CPU_COUNT(&allowed) > 0 && sched_setaffinity(0, sizeof allowed, &allowed) == 0; }
#else
bool measure_pin(void) { return false; }
bool measure_unpin(void) { return false; }
#endif

const char *measure_processor(void)
{
    static char name[128] = "a processor that gives no name";
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");

    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "model name : %127[^\n]", name) == 1)
            break;
    if (file)
        fclose(file);
    return name;
}

const char *measure_compiler(void)
{
#if defined(__clang__)
    return __VERSION__;
#elif defined(__GNUC__)
    return "gcc " __VERSION__;
#else
    return "a compiler that gives no name";
#endif
}
