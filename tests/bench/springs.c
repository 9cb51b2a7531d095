/* The springs of a scene: as a list in some order, and, of the cloth, as runs. */
#include <math.h>
#include <stdlib.h>

#include "bodies.h"
#include "random.h"

#define SPRINGS_A_PARTICLE 4 /* of the random graph */
#define SLACK 0.9            /* its rest lengths, over the distances at the start */

/* A family of the cloth's springs: from (row, column) to (row + down, column + right), the other diagonal from the right. */
typedef struct family {
    unsigned down, right;
    bool leftwards;
} family;

static const family families[] = {{0, 1, false}, {1, 0, false}, {1, 1, false}, {1, 1, true}, {0, 2, false}, {2, 0, false}};

#define FAMILIES (sizeof families / sizeof *families)

static unsigned side_of(const bench_scene *scene) { return (unsigned)(sqrt((double)scene->n) + 0.5); }

#ifndef STF_DOUBLE
size_t bench_springs(const bench_scene *scene)
{
    size_t count = 0;

    for (size_t f = 0; scene->kind == CLOTH && f < FAMILIES; f++)
        count += (size_t)(side_of(scene) - families[f].down) * (side_of(scene) - families[f].right);
    return scene->kind == GRAPH ? SPRINGS_A_PARTICLE * scene->n : count;
}
#endif

static double distance(const bench_scene *scene, uint32_t a, uint32_t b)
{
    const stf_vector p = bench_particle(scene, a).position, q = bench_particle(scene, b).position;
    const double x = (double)(p.x - q.x), y = (double)(p.y - q.y), z = (double)(p.z - q.z);

    return sqrt(x * x + y * y + z * z);
}

static reference_edge edge(const bench_scene *scene, uint32_t a, uint32_t b)
{
    if (scene->kind == CLOTH)
        return (reference_edge){a, b, 500, (stf_real)0.05, (stf_real)distance(scene, a, b)};
    return (reference_edge){a, b, 10, (stf_real)0.1, (stf_real)(SLACK * distance(scene, a, b))};
}

/* Spring number i of a family, row by row, in a cloth with `row` of them a row. */
static reference_edge family_edge(const bench_scene *scene, const family *f, size_t row, size_t column)
{
    const size_t side = side_of(scene);
    const size_t left = row * side + column, right = left + f->right;

    return edge(scene, (uint32_t)(f->leftwards ? right : left), (uint32_t)((f->leftwards ? left : right) + f->down * side));
}

/* Mass by mass, as one would write the loop. */
static void cloth_edges(const bench_scene *scene, reference_edge *edges)
{
    const size_t side = side_of(scene);

    for (size_t row = 0; row < side; row++)
        for (size_t column = 0; column < side; column++)
            for (size_t f = 0; f < FAMILIES; f++)
                if (row + families[f].down < side && column + families[f].right < side)
                    *edges++ = family_edge(scene, &families[f], row, column);
}

static void graph_edges(const bench_scene *scene, reference_edge *edges)
{
    for (size_t i = 0; i < SPRINGS_A_PARTICLE * scene->n; i++) {
        const uint32_t a = (uint32_t)((double)scene->n * random_of(i, 10));
        const uint32_t other = (uint32_t)((double)(scene->n - 1) * random_of(i, 11));
        edges[i] = edge(scene, a, other < a ? other : other + 1);
    }
}

static void shuffle(reference_edge *edges, size_t count)
{
    for (size_t i = count; i > 1; i--) {
        const size_t j = (size_t)((double)i * random_of(i, 12));
        const reference_edge swapped = edges[i - 1];
        edges[i - 1] = edges[j];
        edges[j] = swapped;
    }
}

static int by_ends(const void *first, const void *second)
{
    const reference_edge *p = first, *q = second;
    const int by_a = (p->a > q->a) - (p->a < q->a);

    return by_a ? by_a : (p->b > q->b) - (p->b < q->b);
}

reference_edge *bench_edges(const bench_scene *scene)
{
    const size_t count = bench_springs(scene);
    reference_edge *edges = count ? malloc(count * sizeof *edges) : NULL;

    if (!edges)
        return NULL;
    if (scene->kind == CLOTH)
        cloth_edges(scene, edges);
    else
        graph_edges(scene, edges);
    if (scene->form == LIBRARY_SHUFFLED)
        shuffle(edges, count);
    if (scene->form == EDGES_SORTED)
        qsort(edges, count, sizeof *edges, by_ends);
    return edges;
}

/*
 * Straight down or along, one run goes through all rows at once, and springs that leave a row's end are not there: a family
 * that moves to the right has a run a row.
 */
bool bench_cloth_runs(const bench_scene *scene, reference_bodies *bodies)
{
    const size_t side = side_of(scene), springs = bench_springs(scene);
    reference_run *runs = malloc(FAMILIES * side * sizeof *runs);
    stf_real *reals = malloc(3 * springs * sizeof *reals);
    size_t at = 0;

    bodies->runs = runs;
    bodies->stiffness = reals, bodies->damping = reals + springs, bodies->rest_length = reals + 2 * springs;
    for (size_t f = 0; runs && reals && f < FAMILIES; f++) {
        const size_t rows = side - families[f].down, columns = side - families[f].right;
        for (size_t row = 0; row < rows; row++) {
            const reference_edge start = family_edge(scene, &families[f], row, 0);
            if (families[f].right > 0 || row == 0)
                runs[bodies->run_count++] =
                    (reference_run){start.a, start.b, at, families[f].right > 0 ? columns : rows * columns};
            for (size_t column = 0; column < columns; column++, at++) {
                const reference_edge e = family_edge(scene, &families[f], row, column);
                reals[at] = e.stiffness, reals[springs + at] = e.damping, reals[2 * springs + at] = e.rest_length;
            }
        }
    }
    return runs && reals;
}
