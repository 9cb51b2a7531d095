/*
 * The work-precision race: for each method the cheapest setting that meets the error, found by a search on a few of the bodies;
 * then each peer's cheapest method is timed on all of them, beside the others.
 */
#include <math.h>
#include <stdlib.h>

#include "../measure.h"
#include "table.h"

#define BODIES 1000
#define SAMPLE 50        /* bodies of the search */
#define SAMPLE_LIMIT 1.2 /* s that a run of the search may take: what takes longer, 24 s for all, is out of reach */
#define PRUNE 10         /* a method that costs so many times the peer's best is given up */
#define SLOW 1           /* s: a run that would take longer is not made: the sample's time counts, times BODIES / SAMPLE */
#define PRUNE_FROM 0.05  /* s: and such times are never taken for much: another program may have had the core */
#define FINE 1.02        /* how exact the setting is found, */
#define COARSE 1.1       /* and where a run of the sample takes more than COARSE_FROM s */
#define COARSE_FROM 0.2
#define PEERS_MAX 16
#define METHODS_MAX 64

/* A work w is a number of steps, or a tolerance of 1 / w: more costs more. */
static double setting_of(const entry *e, double work)
{
    return e->method->adaptive ? 1 / work : e->workload->duration / ceil(work);
}

/* sqrt(sum |difference|^2 / sum |exact|^2) over positions and velocities; their units are such that both are about 1. */
static double error_of(const entry *e, const double *position, const double *velocity)
{
    const workload *w = e->workload;
    double *exact = need(6 * w->count * sizeof *exact), *exact_velocity = exact + 3 * w->count, sum = 0, scale = 0;

    for (size_t i = 0; i < 6 * w->count; i++)
        exact[i] = 0;
    workload_exact(w, w->duration, exact, exact_velocity);
    for (size_t i = 0; i < w->count; i++)
        for (unsigned d = 0; d < w->dimensions; d++) {
            const size_t n = 3 * i + d;
            sum += pow(position[n] - exact[n], 2) + pow(velocity[n] - exact_velocity[n], 2);
            scale += pow(exact[n], 2) + pow(exact_velocity[n], 2);
        }
    free(exact);
    return isfinite(sum) ? sqrt(sum / scale) : HUGE_VAL;
}

/* One run from the start; gives its seconds and sets e->error. */
static double run_once(entry *e)
{
    const size_t length = 3 * e->workload->count;
    double *position = need(2 * length * sizeof *position), start, taken;
    void *self = e->peer->create(e->workload, e->method, e->setting);

    for (size_t i = 0; i < 2 * length; i++)
        position[i] = 0;
    start = measure_now();
    e->peer->advance(self, e->workload->duration);
    taken = measure_now() - start;
    e->peer->read(self, position, position + length);
    e->error = error_of(e, position, position + length);
    e->peer->destroy(self);
    free(position);
    return taken;
}

/* One run at this work: whether it is exact enough. */
static bool meets(entry *e, double work, double *taken)
{
    e->setting = setting_of(e, work);
    *taken = run_once(e);
    return e->error <= e->tolerance;
}

/* The least work whose error is within e->tolerance, and the seconds of its run; 0 if it takes more than limit. From `work`. */
static double search(entry *e, double work, double limit, double *taken)
{
    double low = 0, t;

    for (; !meets(e, work, taken); work *= 2) {
        if (*taken > limit || work > 1e15)
            return 0;
        low = work;
    }
    if (low == 0) /* it was good enough: look below */
        for (low = work / 2; low >= 1 && meets(e, low, &t); low /= 2) {
            work = low;
            *taken = t;
        }
    while (work > low * (*taken > COARSE_FROM ? COARSE : FINE) && (e->method->adaptive || ceil(work) > ceil(low) + 1)) {
        const double middle = sqrt(work * low);
        if (meets(e, middle, &t)) {
            work = middle;
            *taken = t;
        } else {
            low = middle;
        }
    }
    return work;
}

/* What was found on the sample may miss a little on all, or be too good: moves by small steps, within SLOW seconds. Gives the
   seconds of one run, or 0 if it doesn't meet. */
static double settle(entry *e, double *work)
{
    double taken, t, spent = 0;

    while (!meets(e, *work, &taken)) {
        *work *= FINE;
        if ((spent += taken) > SLOW)
            return 0;
    }
    while ((spent += taken) < SLOW && *work > 2 && meets(e, *work / FINE, &t)) {
        *work /= FINE;
        taken = t;
    }
    e->setting = setting_of(e, *work);
    spent = run_once(e);
    return fmin(spent, taken);
}

/*
 * The peer's cheapest method, in *best; the seconds of one run, or 0 if none gets there. starts: the work that each method
 * took for the tolerance before, where it starts now; negative: it did not get there.
 */
static double best_of(const peer *p, const char *section, const workload *all, const workload *sample, double tolerance,
                      double *starts, entry *best)
{
    double best_taken = 0, best_sample = SAMPLE_LIMIT / PRUNE;
    size_t n = 0;

    for (const method *m = p->methods(); m->name; m++, n++) {
        entry e = {.peer = p, .method = m, .workload = sample, .tolerance = tolerance};
        double taken, work;
        if (!(m->workloads >> all->kind & 1) || starts[n] < 0 || !(is_ours(p) || asked(section, p, m)))
            continue;
        work = search(&e, starts[n] > 0 ? starts[n] : m->adaptive ? 100 : 16, fmax(PRUNE * best_sample, PRUNE_FROM), &taken);
        starts[n] = work > 0 ? work : -1;
        if (work == 0)
            continue;
        best_sample = fmin(best_sample, taken);
        taken *= (double)BODIES / SAMPLE;
        if (taken < SLOW) {
            e.workload = all;
            taken = settle(&e, &work);
        } else {
            meets(&e, work, &(double){0});
        }
        if (taken > 0 && (best_taken == 0 || taken < best_taken)) {
            best_taken = taken;
            *best = e;
        }
    }
    return best_taken;
}

/* What is too slow for all bodies is left out. */
static void *setup(const void *argument)
{
    entry *e = (entry *)(uintptr_t)argument;

    return e->workload->count == BODIES ? e : NULL;
}

static void prepare(void *context)
{
    entry *e = context;

    if (e->self)
        e->peer->destroy(e->self);
    e->self = e->peer->create(e->workload, e->method, e->setting);
}

static void run(void *context)
{
    entry *e = context;

    e->peer->advance(e->self, e->workload->duration);
}

static void teardown(void *context)
{
    entry *e = context;

    e->peer->destroy(e->self);
}

static void print(const char *section, const entry *e, double seconds, double ratio, bool extrapolated)
{
    char setting[32];

    if (e->method->adaptive)
        snprintf(setting, sizeof setting, "tolerance %.2g", e->setting);
    else
        snprintf(setting, sizeof setting, "%.0f steps", round(e->workload->duration / e->setting));
    printf("  %-10s %-38s %-18s %9.1e %10.3f %9.2f%s\n", e->peer->name, e->method->name, setting, e->error, seconds * 1e3,
           ratio, extrapolated ? "  (50 bodies, times 20)" : "");
    write_csv(section, e->workload->count, e, setting, seconds * 1e3, "ms", ratio);
}

static bool can(const peer *p, const char *section, workload_kind kind)
{
    for (const method *m = p->methods(); m->name; m++)
        if ((m->workloads >> kind & 1) && (is_ours(p) || asked(section, p, m)))
            return true;
    return false;
}

/* All peers to one tolerance: the best of each, measured in turns. starts: the work that each method took last time. */
static void heat(const char *section, const workload *all, const workload *sample, double tolerance,
                 double starts[PEERS_MAX][METHODS_MAX])
{
    entry entries[PEERS_MAX], *e = entries;
    double once[PEERS_MAX];
    measure_case cases[PEERS_MAX];
    measure_result results[PEERS_MAX];
    const char *out_of_reach[PEERS_MAX];
    size_t count = 0, missing = 0;

    printf("\n  to a relative error of %.0e\n  %-10s %-38s %-18s %9s %10s %9s\n", tolerance, "peer", "method", "setting",
           "error", "ms", "x ours");
    for (size_t p = 0; peers[p] && p < PEERS_MAX; p++) {
        if (!can(peers[p], section, all->kind))
            continue;
        once[count] = best_of(peers[p], section, all, sample, tolerance, starts[p], e);
        if (once[count] == 0) {
            out_of_reach[missing++] = peers[p]->name;
            continue;
        }
        cases[count] = (measure_case){
            .argument = e, .setup = setup, .prepare = prepare, .run = run, .teardown = teardown, .items = 1};
        count++;
        e++;
    }
    measure(cases, count, &(measure_plan){.total = 1.5}, results);
    for (size_t i = 0; i < count; i++) {
        const bool timed = results[i].measured;
        const double seconds = timed ? results[i].median / 1e9 : once[i], ours = results[0].median / 1e9;
        print(section, &entries[i], seconds, timed ? measure_ratio(&results[i], &results[0]) : seconds / ours, !timed);
    }
    for (size_t i = 0; i < missing; i++)
        printf("  %-10s out of reach\n", out_of_reach[i]);
}

void race(void)
{
    static const double tolerances[] = {1e-3, 1e-6, 1e-9};
    static const struct {
        workload_kind kind;
        const char *section, *title;
    } kinds[] = {{KEPLER, "kepler", "1,000 Kepler orbits, e = 0.5, semi-major axes of 0.9 to 1.1, over the period of 1"},
                 {OSCILLATORS, "oscillators", "1,000 oscillators, frequencies of 0.9 to 1.1, over ten periods of 1"}};

    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        double starts[PEERS_MAX][METHODS_MAX] = {{0}};
        if (!asked_section(kinds[k].section))
            continue;

        workload *all = workload_race(kinds[k].kind, BODIES), *sample = workload_race(kinds[k].kind, SAMPLE);
        printf("\n%s: %s, in double unless a peer has only float\n", kinds[k].section, kinds[k].title);
        for (size_t t = 0; t < sizeof tolerances / sizeof *tolerances; t++)
            heat(kinds[k].section, all, sample, tolerances[t], starts);
        workload_free(all);
        workload_free(sample);
    }
}
