/*
 * Explicit Runge-Kutta methods on the first-order system (x, v)' = (v, a(t, x, v)): the slope of a stage is its own
 * velocity and the acceleration at its own time, position and velocity.
 * Sources: W. Kutta, Z. Math. Phys. 46 (1901); K. Heun, Z. Math. Phys. 45 (1900); E. Hairer, S. P. Norsett,
 * G. Wanner, Solving Ordinary Differential Equations I (1993), table II.1.2.
 */
#include "steadfast/integrator.h"

#define HALF ((stf_real)0.5)

/* x = x + v dt;  v = v + a dt, to other arrays */
static void predict(size_t n, stf_real *restrict stage_x, stf_real *restrict stage_v, const stf_real *restrict x,
                    const stf_real *restrict v, const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        stage_x[i] = x[i] + v[i] * dt;
        stage_v[i] = v[i] + a[i] * dt;
    }
}

/* x = x + v2 dt;  v = v + a2 dt, where 2 is the stage at dt / 2 */
static void midpoint_finish(size_t n, stf_real *restrict x, stf_real *restrict v, const stf_real *restrict v2,
                            const stf_real *restrict a2, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        x[i] += v2[i] * dt;
        v[i] += a2[i] * dt;
    }
}

static void midpoint_step(stf_system *system, stf_real dt)
{
    const size_t n = system->length;
    stf_real *x = system->position, *v = system->velocity;
    stf_real *a = system->work[0], *stage_x = system->work[1], *stage_v = system->work[2];

    system->accelerate(system, system->time, x, v, a);
    predict(n, stage_x, stage_v, x, v, a, HALF * dt);
    system->accelerate(system, system->time + 0.5 * (double)dt, stage_x, stage_v, a);
    midpoint_finish(n, x, v, stage_v, a, dt);
}

/* x = x + (v1 + v2) dt / 2;  v = v + (a1 + a2) dt / 2, where 2 is the stage at dt */
static void improved_euler_finish(size_t n, stf_real *restrict x, stf_real *restrict v, const stf_real *restrict v2,
                                  const stf_real *restrict a1, const stf_real *restrict a2, stf_real half_dt)
{
    for (size_t i = 0; i < n; i++) {
        x[i] += (v[i] + v2[i]) * half_dt;
        v[i] += (a1[i] + a2[i]) * half_dt;
    }
}

static void improved_euler_step(stf_system *system, stf_real dt)
{
    const size_t n = system->length;
    stf_real *x = system->position, *v = system->velocity;
    stf_real *a1 = system->work[0], *a2 = system->work[1], *stage_x = system->work[2], *stage_v = system->work[3];

    system->accelerate(system, system->time, x, v, a1);
    predict(n, stage_x, stage_v, x, v, a1, dt);
    system->accelerate(system, system->time + (double)dt, stage_x, stage_v, a2);
    improved_euler_finish(n, x, v, stage_v, a1, a2, HALF * dt);
}

/* The first stage's slopes start the sums. */
static void rk4_first(size_t n, stf_real *restrict stage_x, stf_real *restrict stage_v, stf_real *restrict sum_v,
                      stf_real *restrict sum_a, const stf_real *restrict x, const stf_real *restrict v,
                      const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        sum_v[i] = v[i];
        sum_a[i] = a[i];
        stage_x[i] = x[i] + v[i] * dt;
        stage_v[i] = v[i] + a[i] * dt;
    }
}

/* Stages 2 and 3 count twice; the next stage starts from x and v along this one's slopes. */
static void rk4_middle(size_t n, stf_real *restrict stage_x, stf_real *restrict stage_v, stf_real *restrict sum_v,
                       stf_real *restrict sum_a, const stf_real *restrict x, const stf_real *restrict v,
                       const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        sum_v[i] += 2 * stage_v[i];
        sum_a[i] += 2 * a[i];
        stage_x[i] = x[i] + stage_v[i] * dt;
        stage_v[i] = v[i] + a[i] * dt;
    }
}

/* x = x + dt (v1 + 2 v2 + 2 v3 + v4) / 6, v likewise. (dt sum) / 6, as a rounded dt / 6 would bias every step. */
static void rk4_finish(size_t n, stf_real *restrict x, stf_real *restrict v, const stf_real *restrict sum_v,
                       const stf_real *restrict sum_a, const stf_real *restrict v4, const stf_real *restrict a4,
                       stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        x[i] += dt * (sum_v[i] + v4[i]) / 6;
        v[i] += dt * (sum_a[i] + a4[i]) / 6;
    }
}

static void rk4_step(stf_system *system, stf_real dt)
{
    const size_t n = system->length;
    const double t = system->time, t_half = t + 0.5 * (double)dt, t_full = t + (double)dt;
    stf_real *x = system->position, *v = system->velocity;
    stf_real *a = system->work[0], *stage_x = system->work[1], *stage_v = system->work[2];
    stf_real *sum_v = system->work[3], *sum_a = system->work[4];

    system->accelerate(system, t, x, v, a);
    rk4_first(n, stage_x, stage_v, sum_v, sum_a, x, v, a, HALF * dt);
    system->accelerate(system, t_half, stage_x, stage_v, a);
    rk4_middle(n, stage_x, stage_v, sum_v, sum_a, x, v, a, HALF * dt);
    system->accelerate(system, t_half, stage_x, stage_v, a);
    rk4_middle(n, stage_x, stage_v, sum_v, sum_a, x, v, a, dt);
    system->accelerate(system, t_full, stage_x, stage_v, a);
    rk4_finish(n, x, v, sum_v, sum_a, stage_v, a, dt);
}

/* Both methods of order 2 have the stability function 1 + z + z^2 / 2: |R| > 1 on all of the imaginary axis. */
const stf_integrator stf_midpoint = {
    .name = "midpoint",
    .step = midpoint_step,
    .order = 2,
    .evaluations = 2,
    .work_arrays = 3,
    .real_stability = 2,
    .imaginary_stability = 0,
};

const stf_integrator stf_improved_euler = {
    .name = "improved_euler",
    .step = improved_euler_step,
    .order = 2,
    .evaluations = 2,
    .work_arrays = 4,
    .real_stability = 2,
    .imaginary_stability = 0,
};

/* R(z) = 1 + z + z^2 / 2 + z^3 / 6 + z^4 / 24: R = 1 at z = -2.785..., |R| = 1 at z = 2 sqrt(2) i. */
const stf_integrator stf_rk4 = {
    .name = "rk4",
    .step = rk4_step,
    .order = 4,
    .evaluations = 4,
    .work_arrays = 5,
    .real_stability = 2.7852935634052822,
    .imaginary_stability = 2.8284271247461903,
};
