/*
 * Euler's two methods. Sources: L. Euler, Institutionum calculi integralis (1768), vol. 1, ch. VII;
 * E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.2 (explicit and symplectic Euler).
 */
#include "steadfast/integrator.h"

/* x(n+1) = x(n) + v(n) dt;  v(n+1) = v(n) + a(n) dt */
static void explicit_euler(size_t n, stf_real *restrict x, stf_real *restrict v, const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        x[i] += v[i] * dt;
        v[i] += a[i] * dt;
    }
}

/* v(n+1) = v(n) + a(n) dt;  x(n+1) = x(n) + v(n+1) dt */
static void semi_implicit_euler(size_t n, stf_real *restrict x, stf_real *restrict v, const stf_real *restrict a,
                                stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        v[i] += a[i] * dt;
        x[i] += v[i] * dt;
    }
}

static void explicit_euler_step(stf_system *system, stf_real dt)
{
    stf_real *a = system->work[0];

    system->accelerate(system, system->time, system->position, system->velocity, a);
    explicit_euler(system->length, system->position, system->velocity, a, dt);
}

static void semi_implicit_euler_step(stf_system *system, stf_real dt)
{
    stf_real *a = system->work[0];

    system->accelerate(system, system->time, system->position, system->velocity, a);
    semi_implicit_euler(system->length, system->position, system->velocity, a, dt);
}

const stf_integrator stf_explicit_euler = {
    .name = "explicit_euler",
    .step = explicit_euler_step,
    .order = 1,
    .evaluations = 1,
    .work_arrays = 1,
    .real_stability = 2,
    .imaginary_stability = 0, /* |1 + i z| > 1 for every z */
};

const stf_integrator stf_semi_implicit_euler = {
    .name = "semi_implicit_euler",
    .step = semi_implicit_euler_step,
    .order = 1,
    .evaluations = 1,
    .work_arrays = 1,
    .real_stability = 2,
    .imaginary_stability = 2,
    .flags = STF_SYMPLECTIC,
};
