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

static stf_real linear_drag(const void *records, size_t record_count)
{
    const stf_linear_drag *drag = records;
    stf_real sum = 0;

    for (size_t r = 0; r < record_count; r++)
        sum += drag[r].coefficient;
    return sum;
}

/* F = -(c |v|) v. `dimensions` is a constant at each call, so the compiler makes a loop for each. */
STF_INLINE void quadratic(unsigned dimensions, size_t n, size_t stride, stf_real *restrict force,
                             const stf_real *restrict v, stf_real c)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real vx = v[i], vy = dimensions > 1 ? v[stride + i] : 0, vz = dimensions > 2 ? v[2 * stride + i] : 0;
        const stf_real c_speed = c * stf_sqrt(vx * vx + vy * vy + vz * vz);

        force[i] -= c_speed * vx;
        if (dimensions > 1)
            force[stride + i] -= c_speed * vy;
        if (dimensions > 2)
            force[2 * stride + i] -= c_speed * vz;
    }
}

static void quadratic_apply(const void *records, size_t record_count, const stf_particles *p, double time)
{
    const stf_quadratic_drag *drag = records;
    (void)time;

    for (size_t r = 0; r < record_count; r++)
        if (p->dimensions == 1)
            quadratic(1, p->count, p->stride, p->force, p->velocity, drag[r].coefficient);
        else if (p->dimensions == 2)
            quadratic(2, p->count, p->stride, p->force, p->velocity, drag[r].coefficient);
        else
            quadratic(3, p->count, p->stride, p->force, p->velocity, drag[r].coefficient);
}

const stf_force stf_force_linear_drag = {
    .name = "linear_drag",
    .kind = STF_FIELD,
    .depends_on = STF_ON_VELOCITY,
    .record_size = sizeof(stf_linear_drag),
    .fields = "r",
    .drag = linear_drag,
    .check = linear_check,
};

const stf_force stf_force_quadratic_drag = {
    .name = "quadratic_drag",
    .kind = STF_FIELD,
    .depends_on = STF_ON_VELOCITY,
    .record_size = sizeof(stf_quadratic_drag),
    .fields = "r",
    .apply = quadratic_apply,
    .check = quadratic_check,
};
