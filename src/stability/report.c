/* The limiting mode in the world: which particle moves most in it, which force does most, how many substeps it takes. */
#include <string.h>

#include "../real.h"
#include "search.h"

/* The shape of the mode in the world: its real part, when its largest element is real. */
static void find_world_shape(stf_search *s, const stf_mode *m, double *u)
{
    const size_t n = s->jacobian.length;
    double complex largest = 0;

    stf_search_find_shape(s, m->lambda);
    for (size_t k = 0; k < s->reduction.count; k++)
        largest = cabs(s->shape[k]) > cabs(largest) ? s->shape[k] : largest;
    memset(u, 0, n * sizeof *u);
    for (size_t k = 0; k < s->reduction.count; k++) {
        const double part = creal(s->shape[k] * conj(largest)) / cabs(largest);
        for (size_t i = 0; i < n; i++)
            u[i] += part * s->reduction.shapes[k * n + i];
    }
}

/* Where dx = u / sqrt(m) is largest. */
static size_t find_particle(const stf_jacobian *j, const double *u)
{
    double largest = -1;
    size_t found = SIZE_MAX;

    for (size_t i = 0; i < j->at.count; i++) {
        double square = 0;
        for (unsigned d = 0; d < j->at.dimensions; d++) {
            const size_t k = stf_particles_offset(&j->at, i) + d * j->at.stride;
            square += j->root[k] * j->root[k] * u[k] * u[k];
        }
        if (square > largest)
            largest = square, found = i;
    }
    return found;
}

static stf_force_id find_force(stf_jacobian *j, const double *u, double size)
{
    double largest = 0;
    stf_force_id found = 0, id;

    for (size_t n = 0; (id = stf_world_force_at(j->world, n)) != 0; n++) {
        double of_position, of_velocity;
        stf_jacobian_force_share(j, id, u, &of_position, &of_velocity);
        const double share = of_position + size * of_velocity;
        if (share > largest)
            largest = share, found = id;
    }
    j->spent += STF_SEARCH_FOR_FORCES;
    return found;
}

static unsigned count_substeps(double tick, double limit)
{
    const double needed = fmax(1, ceil(tick / (STF_STABILITY_SAFETY * limit)));

    return limit > 0 && needed <= STF_SUBSTEPS_MAX ? (unsigned)needed : 0;
}

void stf_search_report(stf_search *s, const stf_mode *m, stf_stability *found)
{
    const double unit = s->jacobian.frequency, size = cabs(stf_mode_root(m, false));
    double *u = s->scratch[0];

    find_world_shape(s, m, u);
    found->limit = m->limit / unit;
    found->load = found->step / found->limit;
    found->omega = unit * fmax(sqrt(cabs(m->alpha)), fabs(cimag(stf_mode_root(m, false))));
    found->damping = unit * fmax(-creal(m->beta), 0);
    found->omega_dt = found->omega * found->step;
    found->k_dt = found->damping * found->step;
    found->particle = find_particle(&s->jacobian, u);
    found->force = find_force(&s->jacobian, u, unit * size);
    found->substeps = count_substeps(stf_world_step_size(s->jacobian.world), found->limit);
    const double residual = s->reduction.left * cabs(s->shape[s->reduction.count - 1]) / (2 * size * size);
    found->residual = fmax(residual, s->jacobian.noise);
}
