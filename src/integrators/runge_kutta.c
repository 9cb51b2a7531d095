/*
 * Explicit Runge-Kutta methods on the first-order system (x, v)' = (v, a(t, x, v)): the slope of a stage is its own
 * velocity and the acceleration at its own time, position and velocity.
 * Sources: W. Kutta, Z. Math. Phys. 46 (1901); K. Heun, Z. Math. Phys. 45 (1900); E. Hairer, S. P. Norsett,
 * G. Wanner, Solving Ordinary Differential Equations I (1993), table II.1.2.
 */
#include "../flight.h"

#define HALF ((stf_real)0.5)

/* Where a stage takes its slopes. */
typedef struct stage {
    stf_real x, v;
} stage;

/* The stage that lies dt along the slopes: x + slope_x dt;  v + slope_v dt */
static inline stage advance(stf_real x, stf_real v, stf_real slope_x, stf_real slope_v, stf_real dt)
{
    return (stage){.x = x + slope_x * dt, .v = v + slope_v * dt};
}

static void predict_all(size_t n, stf_real *restrict stage_x, stf_real *restrict stage_v, const stf_real *restrict x,
                        const stf_real *restrict v, const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        const stage s = advance(x[i], v[i], v[i], a[i], dt);
        stage_x[i] = s.x;
        stage_v[i] = s.v;
    }
}

/* ---- midpoint ------------------------------------------------------------------------------------------------------------ */

/* x(n+1) = x(n) + v2 dt;  v(n+1) = v(n) + a2 dt, where 2 is the stage at dt / 2 */
static inline void midpoint(stf_element *e, stf_real v2, stf_real a2, stf_real dt)
{
    stf_drift(e, v2 * dt);
    stf_kick(e, a2 * dt);
}

STF_INLINE void midpoint_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict x_rest,
                             stf_real *restrict v_rest, const stf_real *restrict v2, const stf_real *restrict a2, stf_real dt,
                             bool compensated)
{
    for (size_t i = 0; i < n; i++) {
        stf_element e = {.x = x[i], .v = v[i], .compensated = compensated};
        if (compensated)
            e.x_rest = x_rest[i], e.v_rest = v_rest[i];
        midpoint(&e, v2[i], a2[i], dt);
        x[i] = e.x;
        v[i] = e.v;
        if (compensated)
            x_rest[i] = e.x_rest, v_rest[i] = e.v_rest;
    }
}

/* Work arrays: a, and x and v of the stage. */
static void midpoint_predict_loop(stf_system *part, stf_real dt)
{
    predict_all(part->length, part->work[1], part->work[2], part->position, part->velocity, part->work[0], HALF * dt);
}

static void midpoint_loop(stf_system *p, stf_real dt)
{
    if (p->position_rest)
        midpoint_all(p->length, p->position, p->velocity, p->position_rest, p->velocity_rest, p->work[2], p->work[0], dt, true);
    else
        midpoint_all(p->length, p->position, p->velocity, NULL, NULL, p->work[2], p->work[0], dt, false);
}

static void midpoint_step(stf_system *system, stf_real dt)
{
    stf_real *a = system->work[0], *stage_x = system->work[1], *stage_v = system->work[2];

    system->accelerate(system, system->time, system->position, system->velocity, a);
    stf_system_each(system, midpoint_predict_loop, dt);
    system->accelerate(system, system->time + 0.5 * (double)dt, stage_x, stage_v, a);
    stf_system_each(system, midpoint_loop, dt);
}

static inline void midpoint_element(stf_element *e, stf_fall fall, stf_real dt)
{
    const stage s = advance(e->x, e->v, e->v, stf_fall_acceleration(fall, e->v), HALF * dt);

    midpoint(e, s.v, stf_fall_acceleration(fall, s.v), dt);
}

static void midpoint_flight(const stf_flight *flight, stf_real dt) { stf_fly(flight, dt, false, midpoint_element); }

/* ---- improved Euler ------------------------------------------------------------------------------------------------------ */

/* x(n+1) = x(n) + (v1 + v2) dt / 2;  v(n+1) = v(n) + (a1 + a2) dt / 2, where 2 is the stage at dt */
static inline void improved_euler(stf_element *e, stf_real v2, stf_real a1, stf_real a2, stf_real dt)
{
    stf_drift(e, (e->v + v2) * (HALF * dt));
    stf_kick(e, (a1 + a2) * (HALF * dt));
}

STF_INLINE void improved_euler_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict x_rest,
                                   stf_real *restrict v_rest, const stf_real *restrict v2, const stf_real *restrict a1,
                                   const stf_real *restrict a2, stf_real dt, bool compensated)
{
    for (size_t i = 0; i < n; i++) {
        stf_element e = {.x = x[i], .v = v[i], .compensated = compensated};
        if (compensated)
            e.x_rest = x_rest[i], e.v_rest = v_rest[i];
        improved_euler(&e, v2[i], a1[i], a2[i], dt);
        x[i] = e.x;
        v[i] = e.v;
        if (compensated)
            x_rest[i] = e.x_rest, v_rest[i] = e.v_rest;
    }
}

/* Work arrays: a1, a2, and x and v of the stage. */
static void improved_euler_predict_loop(stf_system *part, stf_real dt)
{
    predict_all(part->length, part->work[2], part->work[3], part->position, part->velocity, part->work[0], dt);
}

static void improved_euler_loop(stf_system *p, stf_real dt)
{
    const stf_real *a1 = p->work[0], *a2 = p->work[1], *v2 = p->work[3];

    if (p->position_rest)
        improved_euler_all(p->length, p->position, p->velocity, p->position_rest, p->velocity_rest, v2, a1, a2, dt, true);
    else
        improved_euler_all(p->length, p->position, p->velocity, NULL, NULL, v2, a1, a2, dt, false);
}

static void improved_euler_step(stf_system *system, stf_real dt)
{
    stf_real *a1 = system->work[0], *a2 = system->work[1], *stage_x = system->work[2], *stage_v = system->work[3];

    system->accelerate(system, system->time, system->position, system->velocity, a1);
    stf_system_each(system, improved_euler_predict_loop, dt);
    system->accelerate(system, system->time + (double)dt, stage_x, stage_v, a2);
    stf_system_each(system, improved_euler_loop, dt);
}

static inline void improved_euler_element(stf_element *e, stf_fall fall, stf_real dt)
{
    const stf_real a1 = stf_fall_acceleration(fall, e->v);
    const stage s = advance(e->x, e->v, e->v, a1, dt);

    improved_euler(e, s.v, a1, stf_fall_acceleration(fall, s.v), dt);
}

static void improved_euler_flight(const stf_flight *flight, stf_real dt)
{
    stf_fly(flight, dt, false, improved_euler_element);
}

/* ---- RK4 ----------------------------------------------------------------------------------------------------------------- */

/* What the four stages add up to: v1 + 2 v2 + 2 v3 + v4, and the accelerations likewise. */
typedef struct sums {
    stf_real v, a;
} sums;

/* Stages 2 and 3 count twice. */
static inline sums add_middle(sums sum, stf_real v, stf_real a) { return (sums){.v = sum.v + 2 * v, .a = sum.a + 2 * a}; }

/* x(n+1) = x(n) + dt sum / 6, v likewise. (dt sum) / 6, as a rounded dt / 6 would bias every step. */
static inline void rk4(stf_element *e, sums sum, stf_real v4, stf_real a4, stf_real dt)
{
    stf_drift(e, dt * (sum.v + v4) / 6);
    stf_kick(e, dt * (sum.a + a4) / 6);
}

/* The first stage's slopes start the sums, and the second stage starts from x and v along them. */
static void rk4_first_all(size_t n, stf_real *restrict stage_x, stf_real *restrict stage_v, stf_real *restrict sum_v,
                          stf_real *restrict sum_a, const stf_real *restrict x, const stf_real *restrict v,
                          const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        const stage next = advance(x[i], v[i], v[i], a[i], dt);
        sum_v[i] = v[i];
        sum_a[i] = a[i];
        stage_x[i] = next.x;
        stage_v[i] = next.v;
    }
}

/* From a middle stage to the next one: from x and v of the step along this stage's slopes. */
static void rk4_middle_all(size_t n, stf_real *restrict stage_x, stf_real *restrict stage_v, stf_real *restrict sum_v,
                           stf_real *restrict sum_a, const stf_real *restrict x, const stf_real *restrict v,
                           const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++) {
        const sums sum = add_middle((sums){.v = sum_v[i], .a = sum_a[i]}, stage_v[i], a[i]);
        const stage next = advance(x[i], v[i], stage_v[i], a[i], dt);
        stage_x[i] = next.x;
        stage_v[i] = next.v;
        sum_v[i] = sum.v;
        sum_a[i] = sum.a;
    }
}

STF_INLINE void rk4_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict x_rest,
                        stf_real *restrict v_rest, const stf_real *restrict sum_v, const stf_real *restrict sum_a,
                        const stf_real *restrict v4, const stf_real *restrict a4, stf_real dt, bool compensated)
{
    for (size_t i = 0; i < n; i++) {
        stf_element e = {.x = x[i], .v = v[i], .compensated = compensated};
        if (compensated)
            e.x_rest = x_rest[i], e.v_rest = v_rest[i];
        rk4(&e, (sums){.v = sum_v[i], .a = sum_a[i]}, v4[i], a4[i], dt);
        x[i] = e.x;
        v[i] = e.v;
        if (compensated)
            x_rest[i] = e.x_rest, v_rest[i] = e.v_rest;
    }
}

/* Work arrays: a, x and v of the stage, and the two sums. */
static void rk4_first_loop(stf_system *part, stf_real dt)
{
    rk4_first_all(part->length, part->work[1], part->work[2], part->work[3], part->work[4], part->position, part->velocity,
                  part->work[0], dt);
}

static void rk4_middle_loop(stf_system *part, stf_real dt)
{
    rk4_middle_all(part->length, part->work[1], part->work[2], part->work[3], part->work[4], part->position, part->velocity,
                   part->work[0], dt);
}

static void rk4_loop(stf_system *p, stf_real dt)
{
    const stf_real *sum_v = p->work[3], *sum_a = p->work[4], *v4 = p->work[2], *a4 = p->work[0];

    if (p->position_rest)
        rk4_all(p->length, p->position, p->velocity, p->position_rest, p->velocity_rest, sum_v, sum_a, v4, a4, dt, true);
    else
        rk4_all(p->length, p->position, p->velocity, NULL, NULL, sum_v, sum_a, v4, a4, dt, false);
}

static void rk4_step(stf_system *system, stf_real dt)
{
    const double t = system->time, t_half = t + 0.5 * (double)dt, t_full = t + (double)dt;
    stf_real *a = system->work[0], *stage_x = system->work[1], *stage_v = system->work[2];

    system->accelerate(system, t, system->position, system->velocity, a);
    stf_system_each(system, rk4_first_loop, HALF * dt);
    system->accelerate(system, t_half, stage_x, stage_v, a);
    stf_system_each(system, rk4_middle_loop, HALF * dt);
    system->accelerate(system, t_half, stage_x, stage_v, a);
    stf_system_each(system, rk4_middle_loop, dt);
    system->accelerate(system, t_full, stage_x, stage_v, a);
    stf_system_each(system, rk4_loop, dt);
}

static inline void rk4_element(stf_element *e, stf_fall fall, stf_real dt)
{
    const stf_real a1 = stf_fall_acceleration(fall, e->v);
    const stage two = advance(e->x, e->v, e->v, a1, HALF * dt);
    const stf_real a2 = stf_fall_acceleration(fall, two.v);
    const stage three = advance(e->x, e->v, two.v, a2, HALF * dt);
    const stf_real a3 = stf_fall_acceleration(fall, three.v);
    const stage four = advance(e->x, e->v, three.v, a3, dt);
    const sums sum = add_middle(add_middle((sums){.v = e->v, .a = a1}, two.v, a2), three.v, a3);

    rk4(e, sum, four.v, stf_fall_acceleration(fall, four.v), dt);
}

static void rk4_flight(const stf_flight *flight, stf_real dt) { stf_fly(flight, dt, false, rk4_element); }

/* ---- descriptors --------------------------------------------------------------------------------------------------------- */

/* Both methods of order 2 have the stability function 1 + z + z^2 / 2: |R| > 1 on all of the imaginary axis. */
const stf_integrator stf_midpoint = {
    .name = "midpoint",
    .step = midpoint_step,
    .step_flight = midpoint_flight,
    .order = 2,
    .evaluations = 2,
    .work_arrays = 3,
    .real_stability = 2,
    .imaginary_stability = 0,
    .flags = STF_COMPENSATES,
};

const stf_integrator stf_improved_euler = {
    .name = "improved_euler",
    .step = improved_euler_step,
    .step_flight = improved_euler_flight,
    .order = 2,
    .evaluations = 2,
    .work_arrays = 4,
    .real_stability = 2,
    .imaginary_stability = 0,
    .flags = STF_COMPENSATES,
};

/* R(z) = 1 + z + z^2 / 2 + z^3 / 6 + z^4 / 24: R = 1 at z = -2.785..., |R| = 1 at z = 2 sqrt(2) i. */
const stf_integrator stf_rk4 = {
    .name = "rk4",
    .step = rk4_step,
    .step_flight = rk4_flight,
    .order = 4,
    .evaluations = 4,
    .work_arrays = 5,
    .real_stability = 2.7852935634052822,
    .imaginary_stability = 2.8284271247461903,
    .flags = STF_COMPENSATES,
};
