#include "spring.h"

#include "../sort.h"
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

/* By particle, so that each block finds its own; then by all else, so that the order never depends on the sort. */
static int compare_anchored(const void *left, const void *right)
{
    const stf_anchored_spring *a = left, *b = right;
    const int by_particle = (a->particle > b->particle) - (a->particle < b->particle);
    const stf_real fields_a[] = {a->anchor.x, a->anchor.y, a->anchor.z, a->stiffness, a->damping, a->rest_length};
    const stf_real fields_b[] = {b->anchor.x, b->anchor.y, b->anchor.z, b->stiffness, b->damping, b->rest_length};
    int order = by_particle;

    for (size_t i = 0; order == 0 && i < sizeof fields_a / sizeof *fields_a; i++)
        order = stf_compare_reals(fields_a[i], fields_b[i]);
    return order;
}

static void anchored_arrange(void *records, size_t record_count)
{
    stf_sort(records, record_count, sizeof(stf_anchored_spring), compare_anchored);
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

        for (unsigned k = 0; k < block->dimensions; k++) { /* 3 at most */
            /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
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
    .fields = "4rrrrrr",
    .apply = anchored_apply,
    .potential = anchored_potential,
    .check = anchored_check,
    .renumber = anchored_renumber,
    .arrange = anchored_arrange,
};
