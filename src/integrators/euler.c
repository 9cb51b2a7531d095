/*
 * Euler's two methods. Sources: L. Euler, Institutionum calculi integralis (1768), vol. 1, ch. VII;
 * E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.2 (explicit and symplectic Euler).
 */
#include "../flight.h"

/* x(n+1) = x(n) + v(n) dt;  v(n+1) = v(n) + a(n) dt */
static inline void explicit_euler(stf_element *e, stf_real a, stf_real dt)
{
    stf_drift(e, e->v * dt);
    stf_kick(e, a * dt);
}

/* v(n+1) = v(n) + a(n) dt;  x(n+1) = x(n) + v(n+1) dt */
static inline void semi_implicit_euler(stf_element *e, stf_real a, stf_real dt)
{
    stf_kick(e, a * dt);
    stf_drift(e, e->v * dt);
}

/* `formula` and `compensated` are constants at each call. */
STF_INLINE void euler_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict x_rest,
                          stf_real *restrict v_rest, const stf_real *restrict a, stf_real dt, bool compensated,
                          void (*formula)(stf_element *e, stf_real a, stf_real dt))
{
    for (size_t i = 0; i < n; i++) {
        stf_element e = {.x = x[i], .v = v[i], .compensated = compensated};
        if (compensated)
            e.x_rest = x_rest[i], e.v_rest = v_rest[i];
        formula(&e, a[i], dt);
        x[i] = e.x;
        v[i] = e.v;
        if (compensated)
            x_rest[i] = e.x_rest, v_rest[i] = e.v_rest;
    }
}

STF_INLINE void euler_loop(stf_system *p, stf_real dt, void (*formula)(stf_element *e, stf_real a, stf_real dt))
{
    if (p->position_rest)
        euler_all(p->length, p->position, p->velocity, p->position_rest, p->velocity_rest, p->work[0], dt, true, formula);
    else
        euler_all(p->length, p->position, p->velocity, NULL, NULL, p->work[0], dt, false, formula);
}

static void explicit_euler_loop(stf_system *part, stf_real dt) { euler_loop(part, dt, explicit_euler); }

static void explicit_euler_step(stf_system *system, stf_real dt)
{
    system->accelerate(system, system->time, system->position, system->velocity, system->work[0]);
    stf_system_each(system, explicit_euler_loop, dt);
}

static inline void explicit_euler_element(stf_element *e, stf_fall fall, stf_real dt)
{
    explicit_euler(e, stf_fall_acceleration(fall, e->v), dt);
}

static void explicit_euler_flight(const stf_flight *flight, stf_real dt) { stf_fly(flight, dt, false, explicit_euler_element); }

static void semi_implicit_euler_loop(stf_system *part, stf_real dt) { euler_loop(part, dt, semi_implicit_euler); }

static void semi_implicit_euler_step(stf_system *system, stf_real dt)
{
    system->accelerate(system, system->time, system->position, system->velocity, system->work[0]);
    stf_system_each(system, semi_implicit_euler_loop, dt);
}

static inline void semi_implicit_euler_element(stf_element *e, stf_fall fall, stf_real dt)
{
    semi_implicit_euler(e, stf_fall_acceleration(fall, e->v), dt);
}

static void semi_implicit_euler_flight(const stf_flight *flight, stf_real dt)
{
    stf_fly(flight, dt, false, semi_implicit_euler_element);
}

const stf_integrator stf_explicit_euler = {
    .name = "explicit_euler",
    .step = explicit_euler_step,
    .step_flight = explicit_euler_flight,
    .order = 1,
    .evaluations = 1,
    .work_arrays = 1,
    .real_stability = 2,
    .imaginary_stability = 0, /* |1 + i z| > 1 for every z */
    .flags = STF_COMPENSATES,
};

const stf_integrator stf_semi_implicit_euler = {
    .name = "semi_implicit_euler",
    .step = semi_implicit_euler_step,
    .step_flight = semi_implicit_euler_flight,
    .order = 1,
    .evaluations = 1,
    .work_arrays = 1,
    .real_stability = 2,
    .imaginary_stability = 2,
    .flags = STF_SYMPLECTIC | STF_COMPENSATES,
};
