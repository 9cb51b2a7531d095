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

static void settle_history(size_t n, stf_real *restrict history, const stf_real *restrict v)
{
    for (size_t i = 0; i < n; i++)
        history[i] = is_at_rest(v[i]) & is_at_rest(history[i]) ? 0 * history[i] : history[i];
}

static void settle_state(size_t n, stf_real *restrict x, stf_real *restrict v)
{
    for (size_t i = 0; i < n; i++) {
        x[i] = is_at_rest(x[i]) ? 0 * x[i] : x[i];
        v[i] = is_at_rest(v[i]) ? 0 * v[i] : v[i];
    }
}

static void settle(size_t length, stf_real *position, stf_real *velocity, stf_real *const *history, int history_arrays)
{
    const size_t n = length / STF_ROW_MULTIPLE * STF_ROW_MULTIPLE;

    for (int k = 0; k < history_arrays; k++)
        settle_history(n, history[k], velocity);
    settle_state(n, position, velocity);
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
                           .settle = settle};
