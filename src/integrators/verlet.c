/*
 * Verlet's two methods. Sources: C. Störmer, Arch. Sci. Phys. Nat. 24 (1907); L. Verlet, Phys. Rev. 159, 98 (1967);
 * W. C. Swope et al., J. Chem. Phys. 76, 637 (1982) (velocity form); E. Hairer, C. Lubich, G. Wanner, Acta Numerica
 * 12, 399 (2003).
 *
 * Both take the acceleration once a step, at a velocity that is predicted with the acceleration before it. The
 * prediction is off by O(dt^2), so that both stay of second order when forces depend on velocity. For pure drag the
 * recursion is then that of the two-step Adams-Bashforth method, whose limit is k dt = 1.
 */
#include "steadfast/integrator.h"

#define HALF ((stf_real)0.5)

/*
 * d(n+1) = d(n) + a(n) dt^2;  x(n+1) = x(n) + d(n+1), which is x(n+1) = 2 x(n) - x(n-1) + a(n) dt^2 without its cancellation:
 * d is kept, never computed as a difference of positions.
 * v(n+1) = d(n+1) / dt + a(n) dt / 2: the difference is the velocity half a step ago.
 */
static void position_verlet(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict d,
                            const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        d[i] += a[i] * dt * dt;
        x[i] += d[i];
        v[i] = d[i] / dt + a[i] * (HALF * dt);
    }
}

/* The difference that led here, from the Taylor series, where there is none: d(n) = v(n) dt - a(n) dt^2 / 2. */
static void position_verlet_start(size_t n, stf_real *restrict d, const stf_real *restrict v, const stf_real *restrict a,
                                  stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real start = (v[i] - a[i] * (HALF * dt)) * dt;
        d[i] = d[i] == d[i] ? d[i] : start;
    }
}

static void position_verlet_step(stf_system *system, stf_real dt)
{
    const size_t n = system->length;
    stf_real *x = system->position, *v = system->velocity, *a = system->work[0], *d = system->history[0];

    system->accelerate(system, system->time, x, v, a);
    if (system->history_stale)
        position_verlet_start(n, d, v, a, dt);
    position_verlet(n, x, v, d, a, dt);
}

/* v(n+1/2) = v(n) + a(n) dt / 2;  x(n+1) = x(n) + v(n+1/2) dt;  predicted v(n+1) = v(n+1/2) + a(n) dt / 2 */
static void velocity_verlet_first(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict predicted_v,
                                  const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real kick = a[i] * (HALF * dt);
        v[i] += kick;
        x[i] += v[i] * dt;
        predicted_v[i] = v[i] + kick;
    }
}

/* v(n+1) = v(n+1/2) + a(n+1) dt / 2 */
static void velocity_verlet_second(size_t n, stf_real *restrict v, const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++)
        v[i] += a[i] * (HALF * dt);
}

static void velocity_verlet_step(stf_system *system, stf_real dt)
{
    const size_t n = system->length;
    stf_real *x = system->position, *v = system->velocity, *predicted_v = system->work[0], *a = system->history[0];

    if (system->history_stale)
        system->accelerate(system, system->time, x, v, a);
    velocity_verlet_first(n, x, v, predicted_v, a, dt);
    system->accelerate(system, system->time + (double)dt, x, predicted_v, a);
    velocity_verlet_second(n, v, a, dt);
}

const stf_integrator stf_position_verlet = {
    .name = "position_verlet",
    .step = position_verlet_step,
    .order = 2,
    .evaluations = 1,
    .work_arrays = 1,
    .history_arrays = 1,
    .real_stability = 1,
    .imaginary_stability = 2,
    .flags = STF_SYMPLECTIC, /* its positions could be run backwards, but not from the velocity that it reports */
};

const stf_integrator stf_velocity_verlet = {
    .name = "velocity_verlet",
    .step = velocity_verlet_step,
    .order = 2,
    .evaluations = 1,
    .work_arrays = 1,
    .history_arrays = 1,
    .real_stability = 1,
    .imaginary_stability = 2,
    .flags = STF_SYMPLECTIC | STF_REVERSIBLE,
};
