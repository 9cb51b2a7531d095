#include "spring.h"
#include "steadfast/force.h"

static stf_result spring_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_spring *spring = record;
    (void)dimensions;

    if (spring->a >= particle_count || spring->b >= particle_count)
        return STF_ERROR_PARTICLE;
    if (spring->a == spring->b || !stf_is_spring(spring->stiffness, spring->damping, spring->rest_length))
        return STF_ERROR_PARAMETERS;
    return STF_OK;
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
            stf_spring_factor(square, w_dot_d, springs[s].stiffness, springs[s].damping, springs[s].rest_length);
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

static double spring_potential(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_spring *springs = records;
    double sum = 0;
    (void)time;

    for (size_t s = 0; s < record_count; s++) {
        const stf_real *a = all->position + stf_particles_offset(all, springs[s].a);
        const stf_real *b = all->position + stf_particles_offset(all, springs[s].b);
        sum += stf_spring_energy(stf_square_between(a, all->stride, b, all->stride, all->dimensions), springs[s].stiffness,
                             springs[s].rest_length);
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
