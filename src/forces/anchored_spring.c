#include <string.h>

#include "spring.h"
#include "steadfast/force.h"

static stf_result anchored_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_anchored_spring *spring = record;

    if (spring->particle >= particle_count)
        return STF_ERROR_PARTICLE;
    if (!stf_vector_is_finite(spring->anchor))
        return STF_ERROR_NOT_FINITE;
    if (!stf_vector_fits(spring->anchor, dimensions))
        return STF_ERROR_DIMENSIONS;
    return stf_is_spring(spring->stiffness, spring->damping, spring->rest_length) ? STF_OK : STF_ERROR_PARAMETERS;
}

static bool anchored_renumber(void *record, size_t removed, size_t last)
{
    stf_anchored_spring *spring = record;

    if (spring->particle == removed)
        return false;
    if (spring->particle == last)
        spring->particle = (uint32_t)removed;
    return true;
}

static int compare_reals(stf_real a, stf_real b) { return (a > b) - (a < b); }

/* By particle, so that each block finds its own; then by all else, so that the order never depends on the sort. */
static int compare_anchored(const stf_anchored_spring *a, const stf_anchored_spring *b)
{
    const int by_particle = (a->particle > b->particle) - (a->particle < b->particle);
    const stf_real fields_a[] = {a->anchor.x, a->anchor.y, a->anchor.z, a->stiffness, a->damping, a->rest_length};
    const stf_real fields_b[] = {b->anchor.x, b->anchor.y, b->anchor.z, b->stiffness, b->damping, b->rest_length};
    int order = by_particle;

    for (size_t i = 0; order == 0 && i < sizeof fields_a / sizeof *fields_a; i++)
        order = compare_reals(fields_a[i], fields_b[i]);
    return order;
}

/* Puts springs[end] where it belongs among springs[0 .. end), which are sorted. */
static void insert_last(stf_anchored_spring *springs, size_t end)
{
    const stf_anchored_spring last = springs[end];
    size_t at = end;

    while (at > 0 && compare_anchored(&springs[at - 1], &last) > 0)
        at--;
    memmove(&springs[at + 1], &springs[at], (end - at) * sizeof *springs);
    springs[at] = last;
}

/* Restores the heap below `root`: no spring is less than its children. */
static void sift_down(stf_anchored_spring *springs, size_t root, size_t count)
{
    const stf_anchored_spring sifted = springs[root];

    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && compare_anchored(&springs[child], &springs[child + 1]) < 0)
            child++;
        if (compare_anchored(&sifted, &springs[child]) >= 0)
            break;
        springs[root] = springs[child];
        root = child;
    }
    springs[root] = sifted;
}

/* Heapsort (J. W. J. Williams, Comm. ACM 7, 347 (1964)): qsort may allocate, behind the engine's allocator. */
static void sort(stf_anchored_spring *springs, size_t count)
{
    for (size_t root = count / 2; root-- > 0;)
        sift_down(springs, root, count);
    for (size_t end = count; end-- > 1;) {
        const stf_anchored_spring largest = springs[0];
        springs[0] = springs[end];
        springs[end] = largest;
        sift_down(springs, 0, end);
    }
}

/* A removed particle leaves the springs sorted but for the few at the end whose particle took its index. */
#define FEW_OUT_OF_ORDER 16

static void anchored_arrange(void *records, size_t record_count)
{
    stf_anchored_spring *springs = records;
    size_t sorted = 1;

    while (sorted < record_count && compare_anchored(&springs[sorted - 1], &springs[sorted]) <= 0)
        sorted++;
    if (record_count - sorted > FEW_OUT_OF_ORDER)
        sort(springs, record_count);
    for (; sorted < record_count && record_count - sorted <= FEW_OUT_OF_ORDER; sorted++)
        insert_last(springs, sorted);
}

/* The first of the springs, sorted by particle, whose particle is not below `particle`. */
static size_t first_spring_of(const stf_anchored_spring *springs, size_t spring_count, size_t particle)
{
    size_t low = 0, high = spring_count;

    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (springs[middle].particle < particle)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void anchored_apply(const void *records, size_t record_count, const stf_particles *block, double time)
{
    const stf_anchored_spring *springs = records;
    const size_t end = block->first + block->count;
    (void)time;

    for (size_t s = first_spring_of(springs, record_count, block->first); s < record_count && springs[s].particle < end; s++) {
        const stf_real anchor[] = {springs[s].anchor.x, springs[s].anchor.y, springs[s].anchor.z};
        const size_t i = springs[s].particle - block->first;
        stf_real d[STF_DIMENSIONS_MAX], square = 0, w_dot_d = 0;

        for (unsigned k = 0; k < block->dimensions; k++) {
            d[k] = block->position[k * block->stride + i] - anchor[k];
            square += d[k] * d[k];
            w_dot_d += block->velocity[k * block->stride + i] * d[k];
        }
        const stf_real factor =
            stf_spring_factor(square, w_dot_d, springs[s].stiffness, springs[s].damping, springs[s].rest_length);
        for (unsigned k = 0; k < block->dimensions; k++)
            block->force[k * block->stride + i] -= factor * d[k];
    }
}

static double anchored_potential(const void *records, size_t record_count, const stf_particles *block, double time)
{
    const stf_anchored_spring *springs = records;
    const size_t end = block->first + block->count;
    double sum = 0;
    (void)time;

    for (size_t s = first_spring_of(springs, record_count, block->first); s < record_count && springs[s].particle < end; s++) {
        const stf_real anchor[] = {springs[s].anchor.x, springs[s].anchor.y, springs[s].anchor.z};
        const stf_real *x = block->position + (springs[s].particle - block->first);

        sum += stf_spring_energy(stf_square_between(x, block->stride, anchor, 1, block->dimensions), springs[s].stiffness,
                             springs[s].rest_length);
    }
    return sum;
}

const stf_force stf_force_anchored_springs = {
    .name = "anchored_springs",
    .kind = STF_FIELD,
    .depends_on = STF_ON_POSITION | STF_ON_VELOCITY,
    .record_size = sizeof(stf_anchored_spring),
    .apply = anchored_apply,
    .potential = anchored_potential,
    .check = anchored_check,
    .renumber = anchored_renumber,
    .arrange = anchored_arrange,
};
