/*
 * Gravitation: attractors that stand still, and every particle by every other.
 * Sources: I. Newton, Principia (1687), book III, prop. 7; H. C. Plummer, MNRAS 71, 460 (1911), for the softening.
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

static stf_result all_pairs_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_all_pairs_gravity *gravity = record;
    (void)dimensions, (void)particle_count;

    return isfinite(gravity->gravitational_constant) && stf_is_coefficient(gravity->softening) ? STF_OK
                                                                                               : STF_ERROR_PARAMETERS;
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
        const stf_real square = softening_square + dx * dx + dy * dy + dz * dz;
        const stf_real reciprocal = 1 / stf_sqrt(square), inverse = square > 0 ? reciprocal : 0;
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

/* One particle that pulls. */
typedef struct source {
    stf_real x[STF_DIMENSIONS_MAX];
    stf_real strength; /* G m */
    stf_real softening_square;
} source;

/*
 * What one source does to the particles of one block: a -= G m d / (|d|^2 + e^2)^(3/2). The sum over sources runs in the
 * order of their indices and the loop over the particles that they pull, so that no sum is ever split among lanes of a
 * vector. `dimensions` is a constant at each call, so the compiler makes a loop for each.
 */
STF_INLINE void pull_block(unsigned dimensions, size_t n, size_t stride, stf_real *restrict a,
                              const stf_real *restrict x, const source *restrict from)
{
    const stf_real sx = from->x[0], sy = from->x[1], sz = from->x[2], strength = from->strength;
    const stf_real softening_square = from->softening_square;

    for (size_t i = 0; i < n; i++) {
        const stf_real dx = x[i] - sx;
        const stf_real dy = dimensions > 1 ? x[stride + i] - sy : 0;
        const stf_real dz = dimensions > 2 ? x[2 * stride + i] - sz : 0;
        const stf_real square = softening_square + dx * dx + dy * dy + dz * dz;
        const stf_real reciprocal = 1 / stf_sqrt(square), inverse = square > 0 ? reciprocal : 0;
        const stf_real pull = strength * inverse * inverse;

        a[i] -= pull * (dx * inverse);
        if (dimensions > 1)
            a[stride + i] -= pull * (dy * inverse);
        if (dimensions > 2)
            a[2 * stride + i] -= pull * (dz * inverse);
    }
}

/* F = m a, where the particle has a mass. */
static void add_force(size_t n, stf_real *restrict force, const stf_real *restrict a, const stf_real *restrict inverse_mass)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real pull = a[i] / inverse_mass[i];
        force[i] += inverse_mass[i] > 0 ? pull : 0;
    }
}

static void pull_by_all(const stf_particles *all, size_t first, stf_all_pairs_gravity gravity)
{
    const size_t stride = all->stride, at = stf_particles_offset(all, first);
    const size_t n = all->count - first < stride ? all->count - first : stride;
    stf_real a[STF_DIMENSIONS_MAX * STF_BLOCK_MAX] = {0};

    for (size_t j = 0; j < all->count; j++) {
        const stf_real *x = all->position + stf_particles_offset(all, j);
        source from = {.softening_square = gravity.softening * gravity.softening};

        if (!(all->inverse_mass[j] > 0))
            continue;
        from.strength = gravity.gravitational_constant / all->inverse_mass[j];
        for (unsigned d = 0; d < all->dimensions; d++)
            from.x[d] = x[d * stride];
        if (all->dimensions == 1)
            pull_block(1, n, stride, a, all->position + at, &from);
        else if (all->dimensions == 2)
            pull_block(2, n, stride, a, all->position + at, &from);
        else
            pull_block(3, n, stride, a, all->position + at, &from);
    }
    for (unsigned d = 0; d < all->dimensions; d++)
        add_force(n, all->force + at + d * stride, a + d * stride, all->inverse_mass + first);
}

static void all_pairs_apply(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_all_pairs_gravity *gravity = records;
    (void)time;

    for (size_t r = 0; r < record_count; r++)
        for (size_t first = all->begin; first < all->end; first += all->stride)
            pull_by_all(all, first, gravity[r]);
}

static double pair_potential(const stf_particles *all, size_t i, size_t j, stf_all_pairs_gravity gravity)
{
    const stf_real *xi = all->position + stf_particles_offset(all, i), *xj = all->position + stf_particles_offset(all, j);
    const double softening = (double)gravity.softening;
    const double square = softening * softening + stf_square_between(xi, all->stride, xj, all->stride, all->dimensions);

    if (!(square > 0))
        return 0;
    return -(double)gravity.gravitational_constant /
           ((double)all->inverse_mass[i] * (double)all->inverse_mass[j] * sqrt(square));
}

static double all_pairs_potential(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_all_pairs_gravity *gravity = records;
    double sum = 0;
    (void)time;

    for (size_t r = 0; r < record_count; r++)
        for (size_t i = 0; i < all->count; i++)
            for (size_t j = 0; j < i; j++)
                if (all->inverse_mass[i] > 0 && all->inverse_mass[j] > 0)
                    sum += pair_potential(all, i, j, gravity[r]);
    return sum;
}

const stf_force stf_force_attractor = {
    .name = "attractor",
    .kind = STF_FIELD,
    .depends_on = STF_ON_POSITION,
    .record_size = sizeof(stf_attractor),
    .apply = attractor_apply,
    .potential = attractor_potential,
    .check = attractor_check,
};

const stf_force stf_force_all_pairs_gravity = {
    .name = "all_pairs_gravity",
    .kind = STF_LINK,
    .splits = true,
    .depends_on = STF_ON_POSITION,
    .record_size = sizeof(stf_all_pairs_gravity),
    .apply = all_pairs_apply,
    .potential = all_pairs_potential,
    .check = all_pairs_check,
};
