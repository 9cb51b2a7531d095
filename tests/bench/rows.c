#include "rows.h"

#include <string.h>

static const char *const integrators[] = {"semi_implicit_euler", "velocity_verlet", "rk4"};
static const size_t counts[] = {1000, 10000, 100000, 1000000, 10000000};

#define EULER integrators[0]
#define RK4 integrators[2]
#define COUNT_OF(array) (sizeof(array) / sizeof *(array))
#define QUICK_MOST 100000

/* Reals that semi-implicit Euler reads and writes a particle: position and velocity twice, inverse mass once. */
#define EULER_REALS 13

static size_t add_case(bench_group *g, const bench_precision *p, bench_scene scene, double items)
{
    const size_t i = g->cases_count++;

    g->scenes[i] = scene;
    g->cases[i] = (measure_case){.argument = &g->scenes[i], .setup = p->setup, .run = p->run, .teardown = p->teardown,
                                 .items = items};
    return i;
}

static bench_row *add_row(bench_group *g, const bench_precision *p, const char *name, size_t measured, const char *unit)
{
    bench_row *row = &g->rows[g->rows_count++];
    const bench_scene *scene = &g->scenes[measured];

    *row = (bench_row){.precision = p, .kind = scene->kind, .integrator = scene->integrator, .n = scene->n, .unit = unit,
                       .library = bench_is_library(scene), .measured = measured};
    snprintf(row->name, sizeof row->name, "%s", name);
    return row;
}

static void compare(bench_row *row, bench_comparison comparison, size_t first, size_t last, double target)
{
    row->comparison = comparison;
    row->first_reference = first;
    row->last_reference = last;
    row->target = target;
}

/* 1 and 2: each integrator beside its fused loop and the memory's own limit. */
static void free_group(bench_group *g, const bench_precision *p, const char *integrator, size_t n)
{
    const size_t ours = add_case(g, p, (bench_scene){FREE, LIBRARY, integrator, n}, (double)n);
    const size_t fused = add_case(g, p, (bench_scene){FREE, REFERENCE, integrator, n}, (double)n);
    char name[NAME_MAX_LENGTH];

    compare(add_row(g, p, integrator, ours, "ns/particle"), RATIO, fused, fused, 1.15);
    snprintf(name, sizeof name, "%s, fused loop", integrator);
    add_row(g, p, name, fused, "ns/particle");
    if (integrator == EULER) {
        const size_t update = add_case(g, p, (bench_scene){FREE, UPDATE, integrator, n}, (double)n);
        bench_row *row = add_row(g, p, "limit: update of the same bytes", update, "ns/particle");
        row->rate = (double)(EULER_REALS * p->real_bytes), row->rate_unit = "GB/s";
    }
    if (integrator == RK4 && n == counts[COUNT_OF(counts) - 1]) {
        const size_t euler = add_case(g, p, (bench_scene){FREE, LIBRARY, EULER, n}, (double)n);
        compare(add_row(g, p, "rk4 to semi_implicit_euler", ours, "ns/particle"), RATIO, euler, euler, 1.4);
    }
}

/* Slow numbers: drag has brought all that moves below the smallest normal number, but for what the library does about it. */
static void rest_rows(bench_group *g, const bench_precision *p, const char *name, bench_kind kind, const char *integrator,
                      size_t n)
{
    const size_t rest = add_case(g, p, (bench_scene){kind, LIBRARY_AT_REST, integrator, n}, (double)n);
    const size_t motion = add_case(g, p, (bench_scene){kind, LIBRARY, integrator, n}, (double)n);

    compare(add_row(g, p, name, rest, "ns/particle"), RATIO, motion, motion, 1.1);
}

static void rest_group(bench_group *g, const bench_precision *p, size_t n)
{
    rest_rows(g, p, "at rest, semi_implicit_euler", SLOWING, EULER, n);
    rest_rows(g, p, "at rest, rk4", SLOWING, RK4, n);
    rest_rows(g, p, "at rest, anchored springs", HUNG, EULER, n);
}

/* What compensation costs where it is wanted. */
static void compensated_group(bench_group *g, const bench_precision *p, bench_kind kind, const char *integrator, size_t n)
{
    const bench_scene plain = {kind, LIBRARY, integrator, n}, compensated = {kind, LIBRARY_COMPENSATED, integrator, n};
    const double items = kind == CLOTH ? (double)bench_springs(&plain) : (double)n;
    const size_t without = add_case(g, p, plain, items), with = add_case(g, p, compensated, items);
    char name[NAME_MAX_LENGTH];

    snprintf(name, sizeof name, "compensated, %s", kind == CLOTH ? "cloth" : integrator);
    compare(add_row(g, p, name, with, kind == CLOTH ? "ns/spring" : "ns/particle"), RATIO, without, without, 0);
}

/* 2: the general path, block by block. */
static void field_group(bench_group *g, const bench_precision *p, size_t n)
{
    const size_t ours = add_case(g, p, (bench_scene){FIELD, LIBRARY, RK4, n}, (double)n);
    const size_t fused = add_case(g, p, (bench_scene){FIELD, REFERENCE, RK4, n}, (double)n);

    compare(add_row(g, p, "rk4, quadratic drag and attractor", ours, "ns/particle"), RATIO, fused, fused, 2.5);
    add_row(g, p, "rk4, the same, fused loop", fused, "ns/particle");
}

/* 3: 1.8 ns a spring where the reference takes 1.6. */
static void cloth_group(bench_group *g, const bench_precision *p, size_t n)
{
    const bench_scene ours = {CLOTH, LIBRARY, EULER, n}, shuffled = {CLOTH, LIBRARY_SHUFFLED, EULER, n};
    const bench_scene runs = {CLOTH, REFERENCE, EULER, n}, edges = {CLOTH, EDGES, EULER, n};
    const double springs = (double)bench_springs(&ours);
    const size_t in_order = add_case(g, p, ours, springs), in_none = add_case(g, p, shuffled, springs);
    const size_t reference = add_case(g, p, runs, springs), list = add_case(g, p, edges, springs);

    compare(add_row(g, p, "cloth, springs in order", in_order, "ns/spring"), RATIO, reference, reference, 1.8 / 1.6);
    compare(add_row(g, p, "cloth, springs shuffled", in_none, "ns/spring"), RATIO, reference, reference, 1.8 / 1.6);
    add_row(g, p, "cloth, hand-laid runs", reference, "ns/spring");
    compare(add_row(g, p, "cloth, edge list", list, "ns/spring"), RATIO, reference, reference, 0);
}

static void graph_group(bench_group *g, const bench_precision *p, size_t n)
{
    const bench_scene ours = {GRAPH, LIBRARY, EULER, n};
    const bench_scene given = {GRAPH, EDGES, EULER, n}, sorted = {GRAPH, EDGES_SORTED, EULER, n};
    const double springs = (double)bench_springs(&ours);
    const size_t library = add_case(g, p, ours, springs), first = add_case(g, p, given, springs);
    const size_t last = add_case(g, p, sorted, springs);

    compare(add_row(g, p, "graph, random springs", library, "ns/spring"), RATIO, first, last, 1.2);
    add_row(g, p, "graph, edge loop", first, "ns/spring");
    add_row(g, p, "graph, edge loop, sorted by ends", last, "ns/spring");
}

static void do_nothing(void *context) { (void)context; }

/* 4: a pair is one particle's pull on one other: n (n - 1) of them. */
static void pairs_group(bench_group *g, const bench_precision *p, size_t n, bool alone)
{
    const double pairs = (double)n * (double)(n - 1);
    const size_t ours = add_case(g, p, (bench_scene){PAIRS, LIBRARY, EULER, n}, pairs);
    bench_row *row = add_row(g, p, "all-pairs gravity", ours, "ns/pair");

    if (alone) {
        g->plan.rounds = 1;
        g->cases[ours].prepare = do_nothing; /* one run is a sample */
        return;
    }
    const size_t tiles = add_case(g, p, (bench_scene){PAIRS, REFERENCE, EULER, n}, pairs);
    compare(row, RATIO, tiles, tiles, 1.1);
    add_row(g, p, "all-pairs gravity, tiles", tiles, "ns/pair");
}

/* 5: what a step costs beside the work of its particles, */
static void overhead_group(bench_group *g, const bench_precision *p, size_t n)
{
    const size_t ours = add_case(g, p, (bench_scene){FREE, LIBRARY, EULER, n}, 1);
    const size_t fused = add_case(g, p, (bench_scene){FREE, REFERENCE, EULER, n}, 1);

    compare(add_row(g, p, "step of a small world", ours, "ns/step"), DIFFERENCE, fused, fused, 60);
    add_row(g, p, "step of a small world, fused loop", fused, "ns/step");
}

/* and whether a particle costs the same in a large world. RK4, where arithmetic hides the cache's own steps. */
static void flat_group(bench_group *g, const bench_precision *p)
{
    for (size_t i = 0; i < 3; i++) {
        const size_t ours = add_case(g, p, (bench_scene){FREE, LIBRARY, RK4, counts[i]}, (double)counts[i]);
        if (i > 0)
            compare(add_row(g, p, "rk4 to rk4 of 1e3 particles", ours, "ns/particle"), RATIO, 0, 0, 1.1);
    }
}

/* 6. Beside it what two threads make of plain arithmetic at that moment: a second core may be half of one, or busy. */
static void threads_group(bench_group *g, const bench_precision *p, const char *name, bench_scene scene)
{
    const bool springs = scene.kind == CLOTH, pairs = scene.kind == PAIRS;
    const double n = (double)scene.n, items = springs ? (double)bench_springs(&scene) : pairs ? n * (n - 1) : n;
    bench_scene split = scene;

    split.form = LIBRARY_THREADS;
    const size_t one = add_case(g, p, scene, items), two = add_case(g, p, split, items);
    compare(add_row(g, p, name, two, springs ? "ns/spring" : pairs ? "ns/pair" : "ns/particle"), RATIO, one, one, 1 / 1.8);

    const bench_scene plain = {MACHINE, ADD_MULTIPLY, EULER, 100000}, halves = {MACHINE, ADD_MULTIPLY_THREADS, EULER, 100000};
    const size_t alone = add_case(g, p, plain, (double)plain.n), both = add_case(g, p, halves, (double)halves.n);
    compare(add_row(g, p, "two threads, limit: add, multiply", both, "ns/particle"), RATIO, alone, alone, 0);
}

/* The guard beside the same without: whole intervals, so that each sample has its looks. */
static void guard_group(bench_group *g, const bench_precision *p, const char *name, bench_scene scene)
{
    const bool small = scene.n <= 100, springs = scene.kind == CLOTH || scene.kind == GRAPH, pairs = scene.kind == PAIRS;
    const double n = (double)scene.n, a_step = small ? 1 : springs ? (double)bench_springs(&scene) : pairs ? n * (n - 1) : n;
    bench_scene guarded = scene;
    bench_row *row;

    guarded.form = LIBRARY_GUARDED;
    const size_t off = add_case(g, p, scene, BENCH_INTERVAL * a_step), on = add_case(g, p, guarded, BENCH_INTERVAL * a_step);
    g->cases[off].run = g->cases[on].run = p->run_interval;
    row = add_row(g, p, name, on, small ? "ns/step" : springs ? "ns/spring" : pairs ? "ns/pair" : "ns/particle");
    if (small)
        compare(row, DIFFERENCE, off, off, 60);
    else
        compare(row, RATIO, off, off, 1.03);
}

static void machine_group(bench_group *g, const bench_precision *p, size_t n)
{
    const size_t copy = add_case(g, p, (bench_scene){MACHINE, COPY, EULER, n}, (double)n);
    bench_row *row = add_row(g, p, "limit: copy of the positions", copy, "ns/particle");

    row->rate = (double)(6 * p->real_bytes), row->rate_unit = "GB/s";
    if (n > counts[0])
        return;
    const size_t arithmetic = add_case(g, p, (bench_scene){MACHINE, ADD_MULTIPLY, EULER, n}, (double)n);
    row = add_row(g, p, "limit: add and multiply", arithmetic, "ns/particle");
    row->rate = 9 * 8 * 2, row->rate_unit = "Gflop/s"; /* nine reals, each a chain of eight */
}

/* 8 */
static void bytes_group(bench_group *g, const bench_precision *p)
{
    static const double reals[] = {7, 10, 7}; /* position, velocity, inverse mass; velocity Verlet's acceleration */

    for (size_t i = 0; i < COUNT_OF(integrators); i++) {
        g->scenes[i] = (bench_scene){FREE, LIBRARY, integrators[i], 1000000};
        char name[NAME_MAX_LENGTH];
        snprintf(name, sizeof name, "memory, %s", integrators[i]);
        compare(add_row(g, p, name, i, "bytes/particle"), VALUE, 0, 0, reals[i] * (double)p->real_bytes);
    }
    /* 4: forces reach from block to block, so that all accelerations are kept at once: a vector more, whatever n is */
    g->scenes[COUNT_OF(integrators)] = (bench_scene){PAIRS, LIBRARY, EULER, 1000000};
    compare(add_row(g, p, "memory, all-pairs gravity", COUNT_OF(integrators), "bytes/particle"), VALUE, 0, 0,
            10 * (double)p->real_bytes);
}

typedef struct taker {
    void (*take)(bench_group *group, void *user);
    void *user;
} taker;

static bench_group *fresh(bench_group *g)
{
    memset(g, 0, sizeof *g);
    return g;
}

static void give(bench_group *g, const taker *to) { to->take(g, to->user); }

/* In float, which is what wants it. */
static void compensated_groups(bench_group *g, const bench_precision *p, const taker *to, bool quick)
{
    for (size_t i = 0; i < COUNT_OF(integrators); i++)
        for (size_t c = 0; c < COUNT_OF(counts) - 1 && (!quick || counts[c] <= QUICK_MOST); c += c == 0 ? 2 : 1)
            compensated_group(fresh(g), p, FREE, integrators[i], counts[c]), give(g, to);
    compensated_group(fresh(g), p, CLOTH, EULER, 64 * 64), give(g, to);
}

static void small_groups(bench_group *g, const bench_precision *p, const taker *to)
{
    static const size_t small[] = {0, 1, 10, 100};

    machine_group(fresh(g), p, 1000), give(g, to);
    for (size_t i = 0; i < COUNT_OF(small); i++)
        overhead_group(fresh(g), p, small[i]), give(g, to);
    flat_group(fresh(g), p), give(g, to);
    bytes_group(fresh(g), p), give(g, to);
    cloth_group(fresh(g), p, 64 * 64), give(g, to);
    cloth_group(fresh(g), p, 256 * 256), give(g, to);
    graph_group(fresh(g), p, 1000), give(g, to);
    graph_group(fresh(g), p, 100000), give(g, to);
    pairs_group(fresh(g), p, 1000, false), give(g, to);
    threads_group(fresh(g), p, "two threads, semi_implicit_euler", (bench_scene){FREE, LIBRARY, EULER, 100000}), give(g, to);
    threads_group(fresh(g), p, "two threads, rk4", (bench_scene){FREE, LIBRARY, RK4, 100000}), give(g, to);
    threads_group(fresh(g), p, "two threads, cloth", (bench_scene){CLOTH, LIBRARY, EULER, 128 * 128}), give(g, to);
    threads_group(fresh(g), p, "two threads, all-pairs gravity", (bench_scene){PAIRS, LIBRARY, EULER, 4000}), give(g, to);
}

/* Up to what still takes seconds: a run is an interval. */
static void guard_groups(bench_group *g, const bench_precision *p, const taker *to, bool quick)
{
    static const size_t small[] = {1, 100};
    const size_t most = quick ? QUICK_MOST : 10 * QUICK_MOST;

    for (size_t i = 0; i < COUNT_OF(small); i++)
        guard_group(fresh(g), p, "guard, step of a small world", (bench_scene){FREE, LIBRARY, EULER, small[i]}), give(g, to);
    for (size_t c = 0; counts[c] <= most; c++)
        guard_group(fresh(g), p, "guard, semi_implicit_euler", (bench_scene){FREE, LIBRARY, EULER, counts[c]}), give(g, to);
    guard_group(fresh(g), p, "guard, rk4", (bench_scene){FREE, LIBRARY, RK4, counts[2]}), give(g, to);
    guard_group(fresh(g), p, "guard, quadratic drag and attractor", (bench_scene){FIELD, LIBRARY, RK4, 1000}), give(g, to);
    guard_group(fresh(g), p, "guard, cloth", (bench_scene){CLOTH, LIBRARY, EULER, 64 * 64}), give(g, to);
    guard_group(fresh(g), p, "guard, random springs", (bench_scene){GRAPH, LIBRARY, EULER, 1000}), give(g, to);
    guard_group(fresh(g), p, "guard, all-pairs gravity", (bench_scene){PAIRS, LIBRARY, EULER, 1000}), give(g, to);
}

void bench_groups(bool quick, void (*take)(bench_group *group, void *user), void *user)
{
    const bench_precision *const precisions[] = {&bench_float, &bench_double};
    const taker to = {take, user};
    bench_group g;

    for (size_t k = 0; k < COUNT_OF(precisions); k++) {
        const bench_precision *p = precisions[k];

        for (size_t i = 0; i < COUNT_OF(integrators); i++)
            for (size_t c = 0; c < COUNT_OF(counts) && (!quick || counts[c] <= QUICK_MOST); c++)
                free_group(fresh(&g), p, integrators[i], counts[c]), give(&g, &to);
        for (size_t c = 0; c < COUNT_OF(counts) - 1 && (!quick || counts[c] <= QUICK_MOST); c += 3)
            field_group(fresh(&g), p, counts[c]), give(&g, &to);
        small_groups(&g, p, &to);
        guard_groups(&g, p, &to, quick);
        if (quick)
            continue;
        rest_group(fresh(&g), p, counts[COUNT_OF(counts) - 2]), give(&g, &to);
        machine_group(fresh(&g), p, counts[COUNT_OF(counts) - 1]), give(&g, &to);
        pairs_group(fresh(&g), p, 10000, false), give(&g, &to);
    }
    compensated_groups(&g, &bench_float, &to, quick);
    bench_rollback_group(fresh(&g), integrators[1], 10000), give(&g, &to);
    if (quick)
        return;
    pairs_group(fresh(&g), &bench_float, 100000, true), give(&g, &to);
    bench_creation_group(fresh(&g), counts[COUNT_OF(counts) - 1]), give(&g, &to);
}

void bench_row_text(const bench_row *row, char *text, size_t size)
{
    snprintf(text, size, "%s %s %zu", row->name, row->precision->name, row->n);
}

static size_t fastest(const measure_result *results, const bench_row *row)
{
    size_t best = row->first_reference;

    for (size_t i = row->first_reference; i <= row->last_reference; i++)
        if (results[i].median < results[best].median)
            best = i;
    return best;
}

/* The median over the rounds of what a step costs more than its reference. */
static double excess(const measure_result *result, const measure_result *reference)
{
    double more[MEASURE_ROUNDS_MAX];

    for (unsigned r = 0; r < result->rounds; r++)
        more[r] = result->samples[r] - reference->samples[r];
    return measure_median(more, result->rounds);
}

static void find_value(bench_row *row, const bench_scene *scene)
{
    const double bytes = (double)row->precision->world_bytes(scene) / (double)scene->n;
    const double shown = (double)(long)(bytes * 10 + 0.5) / 10; /* a block's work arrays and the world itself are below that */

    row->result = (measure_result){.measured = bytes > 0, .median = shown, .min = shown, .max = shown};
    row->compared = shown;
}

void bench_run_group(bench_group *g)
{
    measure_result results[GROUP_MAX];

    if (g->cases_count > 0)
        measure(g->cases, g->cases_count, &g->plan, results);
    for (size_t i = 0; i < g->rows_count; i++) {
        bench_row *row = &g->rows[i];
        if (row->comparison == VALUE) {
            find_value(row, &g->scenes[row->measured]);
            continue;
        }
        const measure_result *reference = &results[fastest(results, row)];
        row->result = results[row->measured];
        if (row->comparison == RATIO)
            row->compared = measure_ratio(&row->result, reference);
        if (row->comparison == DIFFERENCE && reference->measured)
            row->compared = excess(&row->result, reference);
    }
}
