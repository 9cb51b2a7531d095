/*
 * Damped springs: Hooke's law with a damper along the spring. Sources: R. Hooke, De potentia restitutiva (1678);
 * A. Witkin, D. Baraff, Physically Based Modeling, SIGGRAPH course notes (1997), Particle System Dynamics, sec. 3.
 */
#include <stdlib.h>

#include "distance.h"
#include "steadfast/force.h"

static bool is_spring(stf_real stiffness, stf_real damping, stf_real rest_length)
{
    return stf_is_coefficient(stiffness) && stf_is_coefficient(damping) && stf_is_coefficient(rest_length);
}

static stf_result spring_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_spring *spring = record;
    (void)dimensions;

    if (spring->a >= particle_count || spring->b >= particle_count)
        return STF_ERROR_PARTICLE;
    if (spring->a == spring->b || !is_spring(spring->stiffness, spring->damping, spring->rest_length))
        return STF_ERROR_PARAMETERS;
    return STF_OK;
}

static stf_result anchored_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_anchored_spring *spring = record;

    if (spring->particle >= particle_count)
        return STF_ERROR_PARTICLE;
    if (!stf_vector_is_finite(spring->anchor))
        return STF_ERROR_NOT_FINITE;
    if (!stf_vector_fits(spring->anchor, dimensions))
        return STF_ERROR_DIMENSIONS;
    return is_spring(spring->stiffness, spring->damping, spring->rest_length) ? STF_OK : STF_ERROR_PARAMETERS;
}

static bool spring_renumber(void *record, size_t removed, size_t last)
{
    stf_spring *spring = record;

    if (spring->a == removed || spring->b == removed)
        return false;
    if (spring->a == last)
        spring->a = (uint32_t)removed;
    if (spring->b == last)
        spring->b = (uint32_t)removed;
    return true;
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

/* The factor f of F = -f d: (k (l - l0) + c (w . u)) / l with u = d / l and w . d given; 0 where l is 0. */
static inline stf_real spring_factor(stf_real square, stf_real w_dot_d, stf_real stiffness, stf_real damping,
                                     stf_real rest_length)
{
    const stf_real length = stf_sqrt(square);

    return length > 0 ? (stiffness * (length - rest_length) + damping * (w_dot_d / length)) / length : 0;
}

/* `dimensions` is a constant at each call, so the compiler makes a loop for each. */
static inline void apply_springs(unsigned dimensions, const stf_spring *springs, size_t spring_count,
                                 const stf_particles *all)
{
    const stf_real *x = all->position, *v = all->velocity;
    stf_real *force = all->force;

    for (size_t s = 0; s < spring_count; s++) {
        const size_t a = stf_particles_offset(all, springs[s].a), b = stf_particles_offset(all, springs[s].b);
        stf_real d[STF_DIMENSIONS_MAX], square = 0, w_dot_d = 0;

        for (unsigned k = 0; k < dimensions; k++) {
            const size_t row = k * all->stride;
            d[k] = x[a + row] - x[b + row];
            square += d[k] * d[k];
            w_dot_d += (v[a + row] - v[b + row]) * d[k];
        }
        const stf_real factor =
            spring_factor(square, w_dot_d, springs[s].stiffness, springs[s].damping, springs[s].rest_length);
        for (unsigned k = 0; k < dimensions; k++) {
            const size_t row = k * all->stride;
            force[a + row] -= factor * d[k];
            force[b + row] += factor * d[k];
        }
    }
}

static void spring_apply(const void *records, size_t record_count, const stf_particles *all, double time)
{
    (void)time;

    if (all->dimensions == 1)
        apply_springs(1, records, record_count, all);
    else if (all->dimensions == 2)
        apply_springs(2, records, record_count, all);
    else
        apply_springs(3, records, record_count, all);
}

static double spring_energy(double square, stf_real stiffness, stf_real rest_length)
{
    const double stretch = sqrt(square) - (double)rest_length;

    return (double)stiffness * stretch * stretch / 2;
}

static double spring_potential(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_spring *springs = records;
    double sum = 0;
    (void)time;

    for (size_t s = 0; s < record_count; s++) {
        const stf_real *a = all->position + stf_particles_offset(all, springs[s].a);
        const stf_real *b = all->position + stf_particles_offset(all, springs[s].b);
        sum += spring_energy(stf_square_between(a, b, all->stride, all->dimensions), springs[s].stiffness,
                             springs[s].rest_length);
    }
    return sum;
}

static int compare_reals(stf_real a, stf_real b) { return (a > b) - (a < b); }

/* By particle, so that each block finds its own; then by all else, so that the order never depends on the sort. */
static int compare_anchored(const void *left, const void *right)
{
    const stf_anchored_spring *a = left, *b = right;
    const int by_particle = (a->particle > b->particle) - (a->particle < b->particle);
    const stf_real fields_a[] = {a->anchor.x, a->anchor.y, a->anchor.z, a->stiffness, a->damping, a->rest_length};
    const stf_real fields_b[] = {b->anchor.x, b->anchor.y, b->anchor.z, b->stiffness, b->damping, b->rest_length};
    int order = by_particle;

    for (size_t i = 0; order == 0 && i < sizeof fields_a / sizeof *fields_a; i++)
        order = compare_reals(fields_a[i], fields_b[i]);
    return order;
}

static void anchored_arrange(void *records, size_t record_count)
{
    qsort(records, record_count, sizeof(stf_anchored_spring), compare_anchored);
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
            spring_factor(square, w_dot_d, springs[s].stiffness, springs[s].damping, springs[s].rest_length);
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
        const stf_real *x = block->position + (springs[s].particle - block->first);

        sum += spring_energy(stf_square_to_point(x, block->stride, block->dimensions, springs[s].anchor),
                             springs[s].stiffness, springs[s].rest_length);
    }
    return sum;
}

const stf_force stf_force_springs = {
    .name = "springs",
    .kind = STF_LINK,
    .depends_on = STF_ON_POSITION | STF_ON_VELOCITY,
    .record_size = sizeof(stf_spring),
    .apply = spring_apply,
    .potential = spring_potential,
    .check = spring_check,
    .renumber = spring_renumber,
};

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
