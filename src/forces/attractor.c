/*
 * Gravitation by points that stand still. Sources: I. Newton, Principia (1687), book III, prop. 7; H. C. Plummer, MNRAS 71, 460
 * (1911), for the softening.
 */
#include "distance.h"
#include "steadfast/force.h"

static stf_result attractor_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_attractor *attractor = record;
    (void)particle_count;

    if (!stf_vector_is_finite(attractor->position))
        return STF_ERROR_NOT_FINITE;
    if (!stf_vector_fits(attractor->position, dimensions))
        return STF_ERROR_DIMENSIONS;
    return isfinite(attractor->strength) && stf_is_coefficient(attractor->softening) ? STF_OK : STF_ERROR_PARAMETERS;
}

/*
 * F = -m mu d / (|d|^2 + e^2)^(3/2), as two factors: the cube of a distance leaves the reals long before the force does. 0 at
 * the very centre and for the immovable. `dimensions` is a constant at each call, so the compiler makes a loop for each.
 */
STF_INLINE void attract(unsigned dimensions, size_t n, size_t stride, stf_real *restrict force, const stf_real *restrict x,
                           const stf_real *restrict inverse_mass, const stf_attractor *restrict attractor)
{
    const stf_real cx = attractor->position.x, cy = attractor->position.y, cz = attractor->position.z;
    const stf_real softening_square = attractor->softening * attractor->softening, strength = attractor->strength;

    for (size_t i = 0; i < n; i++) {
        const stf_real dx = x[i] - cx;
        const stf_real dy = dimensions > 1 ? x[stride + i] - cy : 0;
        const stf_real dz = dimensions > 2 ? x[2 * stride + i] - cz : 0;
        const stf_real apart = dx * dx + dy * dy + dz * dz, square = softening_square + apart;
        const stf_real reciprocal = 1 / stf_sqrt(square), inverse = apart > 0 ? reciprocal : 0;
        const stf_real pull = strength * inverse * inverse / inverse_mass[i];
        const stf_real factor = inverse_mass[i] > 0 ? pull : 0;

        force[i] -= factor * (dx * inverse);
        if (dimensions > 1)
            force[stride + i] -= factor * (dy * inverse);
        if (dimensions > 2)
            force[2 * stride + i] -= factor * (dz * inverse);
    }
}

static void attractor_apply(const void *records, size_t record_count, const stf_particles *p, double time)
{
    const stf_attractor *attractors = records;
    (void)time;

    for (size_t r = 0; r < record_count; r++)
        if (p->dimensions == 1)
            attract(1, p->count, p->stride, p->force, p->position, p->inverse_mass, &attractors[r]);
        else if (p->dimensions == 2)
            attract(2, p->count, p->stride, p->force, p->position, p->inverse_mass, &attractors[r]);
        else
            attract(3, p->count, p->stride, p->force, p->position, p->inverse_mass, &attractors[r]);
}

static double attractor_potential(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const stf_attractor *attractors = records;
    double sum = 0;
    (void)time;

    for (size_t r = 0; r < record_count; r++) {
        const stf_real centre[STF_DIMENSIONS_MAX] = {attractors[r].position.x, attractors[r].position.y,
                                                     attractors[r].position.z};
        const double softening = (double)attractors[r].softening;

        for (size_t i = 0; i < particles->count; i++) {
            const double square = softening * softening + stf_square_between(particles->position + i, particles->stride, centre,
                                                                             1, particles->dimensions);
            if (particles->inverse_mass[i] > 0 && square > 0)
                sum -= (double)attractors[r].strength / ((double)particles->inverse_mass[i] * sqrt(square));
        }
    }
    return sum;
}

const stf_force stf_force_attractor = {
    .name = "attractor",
    .kind = STF_FIELD,
    .depends_on = STF_ON_POSITION,
    .record_size = sizeof(stf_attractor),
    .fields = "rrrrr",
    .apply = attractor_apply,
    .potential = attractor_potential,
    .check = attractor_check,
};
