#include "kernels.h"

#include "flight.h"

static void accelerate(const stf_flight *flight, size_t blocks, const stf_real *restrict inverse_mass,
                       const stf_real *restrict v, stf_real *restrict a)
{
    const size_t lanes = flight->stride / STF_ROW_MULTIPLE * STF_ROW_MULTIPLE;
    const stf_real drag = flight->drag;

    for (size_t b = 0; b < blocks; b++, inverse_mass += lanes)
        for (unsigned d = 0; d < flight->dimensions; d++, a += lanes, v += lanes) {
            const stf_real gravity = flight->gravity[d];

            for (size_t i = 0; i < lanes; i++) {
                const stf_real w = inverse_mass[i];
                const stf_fall fall = {.gravity = gravity, .rate = drag * w}; /* one condition a lane: gcc wants no two */
                const stf_real pushed = stf_fall_acceleration(fall, v[i]) + a[i] * w;
                a[i] = w > 0 ? pushed : 0;
            }
        }
}

/* False for a NaN, which marks a history that is none. */
static inline bool is_at_rest(stf_real x) { return x < STF_AT_REST && x > -STF_AT_REST; }

/* What belongs to the state: its history, or its rest. */
static void settle_beside(size_t n, stf_real *restrict array, const stf_real *restrict state)
{
    for (size_t i = 0; i < n; i++)
        array[i] = is_at_rest(state[i]) && is_at_rest(array[i]) ? 0 * array[i] : array[i];
}

static void settle_state(size_t n, stf_real *restrict state)
{
    for (size_t i = 0; i < n; i++)
        state[i] = is_at_rest(state[i]) ? 0 * state[i] : state[i];
}

static void settle(const stf_flight *flight)
{
    const size_t lanes = flight->stride / STF_ROW_MULTIPLE * STF_ROW_MULTIPLE;
    const size_t n = flight->blocks * flight->dimensions * lanes;

    for (int k = 0; k < STF_HISTORY_ARRAYS_MAX && flight->history[k]; k++)
        settle_beside(n, flight->history[k], flight->velocity);
    if (flight->position_rest) {
        settle_beside(n, flight->position_rest, flight->position);
        settle_beside(n, flight->velocity_rest, flight->velocity);
    }
    settle_state(n, flight->position);
    settle_state(n, flight->velocity);
}

static bool exceeds(const stf_real *x, size_t length, stf_real most)
{
    const stf_magnitude bound = stf_magnitude_of(most);
    const size_t n = length / STF_ROW_MULTIPLE * STF_ROW_MULTIPLE;
    stf_magnitude over = 0;

    for (size_t i = 0; i < n; i++)
        over |= stf_magnitude_of(x[i]) > bound;
    return over != 0;
}

#ifndef STF_VARIANT
#define NAME stf_kernels_baseline
#define TEXT "baseline"
#else
#define PASTE(a, b) a##b
#define NAME_OF(variant) PASTE(stf_kernels_, variant)
#define QUOTE(text) #text
#define TEXT_OF(variant) QUOTE(variant)
#define NAME NAME_OF(STF_VARIANT)
#define TEXT TEXT_OF(STF_VARIANT)
#endif

static const stf_force *const forces[] = {
    &stf_force_linear_drag, &stf_force_quadratic_drag, &stf_force_attractor, &stf_force_anchored_springs,
    &stf_force_springs,     &stf_force_all_pairs_gravity, NULL,
};

const stf_kernels NAME = {.name = TEXT, .integrators = stf_integrators, .forces = forces, .accelerate = accelerate,
                           .settle = settle, .exceeds = exceeds};
