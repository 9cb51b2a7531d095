/* What a world does, at the samples of a reference, and by how much two such paths differ. */
#define STF_DOUBLE
#include <math.h>

#include "../allocator.h"
#include "reference.h"

double stf_trade_larger(double a, double b) { return isnan(a) || isnan(b) ? HUGE_VAL : a > b ? a : b; }

double stf_trade_rms(const stf_trade_reference *reference, double sum_of_squares)
{
    return reference->movable > 0 ? sqrt(sum_of_squares / (double)reference->movable) : 0;
}

double stf_trade_distance(const double a[], const double b[])
{
    double sum = 0;

    for (unsigned d = 0; d < STF_DIMENSIONS_MAX; d++)
        sum += (a[d] - b[d]) * (a[d] - b[d]);
    return sqrt(sum);
}

static size_t reals_a_sample(const stf_trade_reference *r) { return r->particles * r->dimensions; }

/* 0: it does not fit size_t */
static size_t path_bytes(const stf_trade_reference *r)
{
    const size_t samples = (size_t)r->samples + 1, most = SIZE_MAX / sizeof(double) / samples - 1 - STF_DIMENSIONS_MAX;

    return r->particles > most / r->dimensions ? 0 : samples * (reals_a_sample(r) + 1 + STF_DIMENSIONS_MAX) * sizeof(double);
}

stf_result stf_trade_path_allocate(const stf_trade_reference *r, stf_trade_path *path)
{
    const size_t bytes = path_bytes(r), samples = (size_t)r->samples + 1;

    path->position = bytes > 0 ? stf_allocator_allocate(&r->allocator, bytes) : NULL;
    if (!path->position)
        return STF_ERROR_MEMORY;
    path->energy = path->position + samples * reals_a_sample(r);
    path->momentum = path->energy + samples;
    return STF_OK;
}

void stf_trade_path_release(const stf_trade_reference *r, const stf_trade_path *path)
{
    stf_allocator_release(&r->allocator, path->position, path_bytes(r));
}

void stf_trade_path_record(const stf_trade_reference *r, stf_trade_path *path, unsigned sample, const stf_world *world)
{
    const stf_particles all = stf_world_view(world);
    double *to = path->position + sample * reals_a_sample(r);
    stf_energy energy = {0};

    for (size_t i = 0; i < r->particles; i++)
        for (unsigned d = 0; d < r->dimensions; d++)
            *to++ = all.position[stf_particles_offset(&all, i) + d * all.stride];
    stf_world_energy(world, &energy);
    path->energy[sample] = energy.kinetic + energy.potential;
    stf_world_momentum(world, path->momentum + (size_t)sample * STF_DIMENSIONS_MAX);
}

void stf_trade_path_compare(const stf_trade_reference *r, const stf_trade_path *a, const stf_trade_path *b,
                            stf_trade_accuracy *accuracy)
{
    const size_t reals = reals_a_sample(r);

    accuracy->error = accuracy->energy = accuracy->momentum = 0;
    for (unsigned k = 0; k <= r->samples; k++) {
        const size_t momentum = (size_t)k * STF_DIMENSIONS_MAX;
        double sum = 0;

        for (size_t i = k * reals; i < (k + 1) * reals; i++)
            sum += (a->position[i] - b->position[i]) * (a->position[i] - b->position[i]);
        accuracy->error = stf_trade_larger(accuracy->error, stf_trade_rms(r, sum));
        accuracy->energy = stf_trade_larger(accuracy->energy, fabs(a->energy[k] - b->energy[k]));
        accuracy->momentum =
            stf_trade_larger(accuracy->momentum, stf_trade_distance(a->momentum + momentum, b->momentum + momentum));
    }
}

void stf_trade_path_reach(stf_trade_reference *r)
{
    double half_diagonal[STF_DIMENSIONS_MAX] = {0};
    const double corner[STF_DIMENSIONS_MAX] = {0};

    for (unsigned d = 0; d < r->dimensions; d++) {
        double low = HUGE_VAL, high = -HUGE_VAL;

        for (size_t i = d; i < (r->samples + (size_t)1) * reals_a_sample(r); i += r->dimensions) {
            low = fmin(low, r->path.position[i]);
            high = fmax(high, r->path.position[i]);
        }
        r->middle[d] = r->particles > 0 ? (low + high) / 2 : 0;
        half_diagonal[d] = r->particles > 0 ? (high - low) / 2 : 0;
    }
    r->accuracy.reach = stf_trade_distance(half_diagonal, corner);
}
