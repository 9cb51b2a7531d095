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
                          .exceeds = exceeds};
