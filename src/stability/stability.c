/* Takes the memory of a measurement, reduces the scene to its extreme shapes, and has the mode found that sets the limit. */
#include "steadfast/stability.h"

#include "../real.h"
#include "amplification.h"
#include "search.h"

#define ACCELERATIONS_MIN 25

/* All that the call needs: `most` is the larger of the number of shapes and, with damping, twice that number. */
static stf_result take_memory(stf_search *s, size_t most)
{
    stf_jacobian *j = &s->jacobian;
    stf_reduction *r = &s->reduction;
    const size_t matrices = (most * most + 2 * most) * sizeof(double complex) + (3 * most + 1) * most * sizeof(double);
    const size_t each = (2 + STF_SEARCH_SCRATCH + most) * sizeof(double) + 4 * sizeof(stf_real);

    if (j->length > (SIZE_MAX - matrices) / each)
        return STF_ERROR_MEMORY;
    s->bytes = matrices + j->length * each;
    s->memory = stf_allocator_allocate(&s->allocator, s->bytes);
    if (!s->memory)
        return STF_ERROR_MEMORY;

    stf_real *state = s->memory; /* first: forces may want it aligned */
    j->position = state;
    j->velocity = state + j->length;
    j->acceleration = state + 2 * j->length;
    j->base = state + 3 * j->length;
    s->matrix = (double complex *)(void *)(state + 4 * j->length);
    s->values = s->matrix + most * most;
    s->shape = s->values + most;
    s->h = (double *)(void *)(s->shape + most);
    r->a = s->h + (most + 1) * most;
    r->b = r->a + most * most;
    j->root = r->b + most * most;
    for (size_t k = 0; k < STF_SEARCH_SCRATCH; k++)
        s->scratch[k] = j->root + (k + 1) * j->length;
    r->shapes = s->scratch[STF_SEARCH_SCRATCH - 1] + j->length;
    return STF_OK;
}

/* A vector that no shape is perpendicular to, but by a very odd chance; always the same (splitmix64). */
static void fill_with_noise(const stf_jacobian *j, uint64_t seed, double *u)
{
    for (size_t i = 0; i < j->length; i++) {
        uint64_t z = seed += UINT64_C(0x9e3779b97f4a7c15);
        z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
        z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
        u[i] = j->root[i] > 0 ? (double)(z >> 11) / (double)(UINT64_C(1) << 52) - 1 : 0;
    }
}

/* Finds how far to displace, whether velocity matters, and about how fast things are. False: nothing depends on anything. */
static bool settle(stf_search *s)
{
    stf_jacobian *j = &s->jacobian;

    fill_with_noise(j, 1, s->scratch[0]);
    const double stiffness = stf_jacobian_settle_displacement(j, s->scratch[0], s->scratch[1], s->scratch[2]);
    j->frequency = stiffness > 0 ? sqrt(stiffness) : 1;
    fill_with_noise(j, 2, s->scratch[0]);
    const double damping = stf_jacobian_settle_speed(j, s->scratch[0], s->scratch[1], s->scratch[2]);
    s->reduction.damped = damping > 0;
    if (!(stiffness > 0) && damping > 0)
        j->frequency = damping;
    s->reduction.weight = 1;
    if (damping > 0 && stf_first_growth(s->integrator, -1, 0, 1) == 0)
        s->reduction.weight = -fmax(1, j->frequency / damping);
    return stiffness > 0 || damping > 0;
}

static void reduce(stf_search *s)
{
    stf_jacobian *j = &s->jacobian;
    const size_t left = (s->accelerations - j->spent - STF_SEARCH_FOR_FORCES) / (s->reduction.damped ? 2 : 1);
    const size_t most = left < j->unknowns ? left : j->unknowns;

    fill_with_noise(j, 3, s->reduction.shapes);
    s->reduction.damped_shapes = s->reduction.shapes + (most + 1) * j->length;
    stf_reduce(&s->reduction, j, most, s->h);
}

static void measure(stf_search *s, stf_stability *found)
{
    stf_jacobian *j = &s->jacobian;

    stf_jacobian_begin(j);
    if (!j->finite || j->unknowns == 0 || !settle(s))
        return;
    reduce(s);
    if (!j->finite)
        return;

    const stf_mode limiting = stf_search_find_limiting(s);
    found->growth = s->growth * j->frequency;
    if (limiting.limit < (double)INFINITY)
        stf_search_report(s, &limiting, found);
}

stf_result stf_stability_measure(const stf_world *world, const stf_stability_def *def, stf_stability *stability)
{
    if (!world || !stability)
        return STF_ERROR_NULL;

    const stf_stability_def given = def ? *def : (stf_stability_def){.accelerations = 0};
    const unsigned most = given.accelerations ? given.accelerations : STF_STABILITY_ACCELERATIONS_MAX;
    const stf_particles at = stf_world_view(world);
    stf_search s = {.integrator = stf_world_integrator(world), .jacobian = {.world = world, .at = at, .finite = true}};
    stf_stability found = {.limit = (double)INFINITY,
                           .step = stf_world_step_size(world) / stf_world_substeps(world),
                           .particle = SIZE_MAX,
                           .substeps = 1};

    if (!stf_allocator_complete(given.allocator, &s.allocator))
        return STF_ERROR_DESCRIPTOR;
    s.accelerations = most < ACCELERATIONS_MIN                 ? ACCELERATIONS_MIN
                      : most > STF_STABILITY_ACCELERATIONS_MAX ? STF_STABILITY_ACCELERATIONS_MAX
                                                               : most;
    if (at.count > 0) {
        s.jacobian.length = (at.count + at.stride - 1) / at.stride * at.stride * at.dimensions;
        const stf_result bad = take_memory(&s, s.accelerations);
        if (bad)
            return bad;
        measure(&s, &found);
        stf_allocator_release(&s.allocator, s.memory, s.bytes);
    }
    if (!s.jacobian.finite)
        return STF_ERROR_NOT_FINITE;
    found.accelerations = s.jacobian.spent;
    *stability = found;
    return STF_OK;
}
