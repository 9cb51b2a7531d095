#include "../real.h"
#include "steadfast/force.h"

static stf_result check_coefficient(stf_real coefficient)
{
    return stf_is_coefficient(coefficient) ? STF_OK : STF_ERROR_PARAMETERS;
}

static stf_result linear_check(const void *record, unsigned dimensions, size_t particle_count)
{
    (void)dimensions, (void)particle_count;
    return check_coefficient(((const stf_linear_drag *)record)->coefficient);
}

static stf_result quadratic_check(const void *record, unsigned dimensions, size_t particle_count)
{
    (void)dimensions, (void)particle_count;
    return check_coefficient(((const stf_quadratic_drag *)record)->coefficient);
}

/* F = -k v */
static void linear_row(size_t n, stf_real *restrict force, const stf_real *restrict v, stf_real k)
{
    for (size_t i = 0; i < n; i++)
        force[i] -= k * v[i];
}

static void linear_apply(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const stf_linear_drag *drag = records;
    (void)time;

    for (size_t r = 0; r < record_count; r++)
        for (unsigned d = 0; d < particles->dimensions; d++)
            linear_row(particles->count, particles->force + d * particles->stride,
                       particles->velocity + d * particles->stride, drag[r].coefficient);
}

static void add_square(size_t n, stf_real *restrict sum, const stf_real *restrict v)
{
    for (size_t i = 0; i < n; i++)
        sum[i] += v[i] * v[i];
}

/* c |v| from |v|^2 */
static void square_root(size_t n, stf_real *restrict speed, stf_real c)
{
    for (size_t i = 0; i < n; i++)
        speed[i] = c * stf_sqrt(speed[i]);
}

/* F = -(c |v|) v */
static void quadratic_row(size_t n, stf_real *restrict force, const stf_real *restrict v,
                          const stf_real *restrict c_speed)
{
    for (size_t i = 0; i < n; i++)
        force[i] -= c_speed[i] * v[i];
}

static void quadratic_apply(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const stf_quadratic_drag *drag = records;
    const size_t n = particles->count, stride = particles->stride;
    (void)time;

    for (size_t r = 0; r < record_count; r++) {
        stf_real speed[STF_BLOCK_MAX] = {0};

        for (unsigned d = 0; d < particles->dimensions; d++)
            add_square(n, speed, particles->velocity + d * stride);
        square_root(n, speed, drag[r].coefficient);
        for (unsigned d = 0; d < particles->dimensions; d++)
            quadratic_row(n, particles->force + d * stride, particles->velocity + d * stride, speed);
    }
}

const stf_force stf_force_linear_drag = {
    .name = "linear_drag",
    .kind = STF_FIELD,
    .depends_on = STF_ON_VELOCITY,
    .record_size = sizeof(stf_linear_drag),
    .apply = linear_apply,
    .check = linear_check,
};

const stf_force stf_force_quadratic_drag = {
    .name = "quadratic_drag",
    .kind = STF_FIELD,
    .depends_on = STF_ON_VELOCITY,
    .record_size = sizeof(stf_quadratic_drag),
    .apply = quadratic_apply,
    .check = quadratic_check,
};
