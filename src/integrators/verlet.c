/*
 * Verlet's two methods. Sources: C. Störmer, Arch. Sci. Phys. Nat. 24 (1907); L. Verlet, Phys. Rev. 159, 98 (1967);
 * W. C. Swope et al., J. Chem. Phys. 76, 637 (1982) (velocity form); E. Hairer, C. Lubich, G. Wanner, Acta Numerica
 * 12, 399 (2003).
 *
 * Both take the acceleration once a step, at a velocity that is predicted with the acceleration before it. The
 * prediction is off by O(dt^2), so that both stay of second order when forces depend on velocity. For pure drag the
 * recursion is then that of the two-step Adams-Bashforth method, whose limit is k dt = 1.
 */
#include "../flight.h"

#define HALF ((stf_real)0.5)

/*
 * d(n+1) = d(n) + a(n) dt^2;  x(n+1) = x(n) + d(n+1), which is x(n+1) = 2 x(n) - x(n-1) + a(n) dt^2 without its cancellation:
 * d is kept, never computed as a difference of positions. It is what the method adds to in place of the velocity, whose rest it
 * takes: v(n+1) = d(n+1) / dt + a(n) dt / 2, as the difference is the velocity half a step ago.
 */
static inline void position_verlet(stf_element *e, stf_real a, stf_real dt)
{
    stf_sum_add(&e->history, &e->v_rest, a * dt * dt, e->compensated);
    stf_drift(e, e->history);
    e->v = e->history / dt + a * (HALF * dt);
}

/* The difference that led here, from the Taylor series, where there is none: d(n) = v(n) dt - a(n) dt^2 / 2. */
static inline void position_verlet_start(stf_element *e, stf_real a, stf_real dt)
{
    const stf_real start = (e->v - a * (HALF * dt)) * dt;
    const bool is_known = e->history == e->history;

    e->history = is_known ? e->history : start;
    e->v_rest = is_known ? e->v_rest : 0;
}

/* `formula` and `compensated` are constants at each call. */
STF_INLINE void position_verlet_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict x_rest,
                                    stf_real *restrict v_rest, stf_real *restrict d, const stf_real *restrict a, stf_real dt,
                                    bool compensated, void (*formula)(stf_element *e, stf_real a, stf_real dt))
{
    for (size_t i = 0; i < n; i++) {
        stf_element e = {.x = x[i], .v = v[i], .history = d[i], .compensated = compensated};
        if (compensated)
            e.x_rest = x_rest[i], e.v_rest = v_rest[i];
        formula(&e, a[i], dt);
        x[i] = e.x;
        v[i] = e.v;
        if (compensated)
            x_rest[i] = e.x_rest, v_rest[i] = e.v_rest;
        d[i] = e.history;
    }
}

STF_INLINE void position_verlet_each(stf_system *p, stf_real dt, void (*formula)(stf_element *e, stf_real a, stf_real dt))
{
    stf_real *x = p->position, *v = p->velocity, *a = p->work[0], *d = p->history[0];

    if (p->position_rest)
        position_verlet_all(p->length, x, v, p->position_rest, p->velocity_rest, d, a, dt, true, formula);
    else
        position_verlet_all(p->length, x, v, NULL, NULL, d, a, dt, false, formula);
}

static void position_verlet_loop(stf_system *part, stf_real dt)
{
    if (part->history_stale)
        position_verlet_each(part, dt, position_verlet_start);
    position_verlet_each(part, dt, position_verlet);
}

static void position_verlet_step(stf_system *system, stf_real dt)
{
    system->accelerate(system, system->time, system->position, system->velocity, system->work[0]);
    stf_system_each(system, position_verlet_loop, dt);
}

static inline void position_verlet_element_start(stf_element *e, stf_fall fall, stf_real dt)
{
    position_verlet_start(e, stf_fall_acceleration(fall, e->v), dt);
}

static inline void position_verlet_element(stf_element *e, stf_fall fall, stf_real dt)
{
    position_verlet(e, stf_fall_acceleration(fall, e->v), dt);
}

static void position_verlet_flight(const stf_flight *flight, stf_real dt)
{
    if (flight->history_stale)
        stf_fly(flight, dt, true, position_verlet_element_start);
    stf_fly(flight, dt, true, position_verlet_element);
}

/* v(n+1/2) = v(n) + a(n) dt / 2;  x(n+1) = x(n) + v(n+1/2) dt;  returns the predicted v(n+1) = v(n+1/2) + a(n) dt / 2 */
static inline stf_real velocity_verlet_first(stf_element *e, stf_real a, stf_real dt)
{
    const stf_real kick = a * (HALF * dt);

    stf_kick(e, kick);
    stf_drift(e, e->v * dt);
    return e->v + kick;
}

/* v(n+1) = v(n+1/2) + a(n+1) dt / 2 */
static inline void velocity_verlet_second(stf_element *e, stf_real a, stf_real dt) { stf_kick(e, a * (HALF * dt)); }

STF_INLINE void velocity_verlet_first_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict x_rest,
                                          stf_real *restrict v_rest, stf_real *restrict predicted_v, const stf_real *restrict a,
                                          stf_real dt, bool compensated)
{
    for (size_t i = 0; i < n; i++) {
        stf_element e = {.x = x[i], .v = v[i], .compensated = compensated};
        if (compensated)
            e.x_rest = x_rest[i], e.v_rest = v_rest[i];
        predicted_v[i] = velocity_verlet_first(&e, a[i], dt);
        x[i] = e.x;
        v[i] = e.v;
        if (compensated)
            x_rest[i] = e.x_rest, v_rest[i] = e.v_rest;
    }
}

STF_INLINE void velocity_verlet_second_all(size_t n, stf_real *restrict v, stf_real *restrict v_rest,
                                           const stf_real *restrict a, stf_real dt, bool compensated)
{
    for (size_t i = 0; i < n; i++) {
        stf_element e = {.v = v[i], .v_rest = compensated ? v_rest[i] : 0, .compensated = compensated};
        velocity_verlet_second(&e, a[i], dt);
        v[i] = e.v;
        if (compensated)
            v_rest[i] = e.v_rest;
    }
}

static void velocity_verlet_first_loop(stf_system *p, stf_real dt)
{
    stf_real *predicted_v = p->work[0], *a = p->history[0];

    if (p->position_rest)
        velocity_verlet_first_all(p->length, p->position, p->velocity, p->position_rest, p->velocity_rest, predicted_v, a, dt,
                                  true);
    else
        velocity_verlet_first_all(p->length, p->position, p->velocity, NULL, NULL, predicted_v, a, dt, false);
}

static void velocity_verlet_second_loop(stf_system *p, stf_real dt)
{
    if (p->velocity_rest)
        velocity_verlet_second_all(p->length, p->velocity, p->velocity_rest, p->history[0], dt, true);
    else
        velocity_verlet_second_all(p->length, p->velocity, NULL, p->history[0], dt, false);
}

static void velocity_verlet_step(stf_system *system, stf_real dt)
{
    stf_real *x = system->position, *predicted_v = system->work[0], *a = system->history[0];

    if (system->history_stale)
        system->accelerate(system, system->time, x, system->velocity, a);
    stf_system_each(system, velocity_verlet_first_loop, dt);
    system->accelerate(system, system->time + (double)dt, x, predicted_v, a);
    stf_system_each(system, velocity_verlet_second_loop, dt);
}

static inline void velocity_verlet_element_start(stf_element *e, stf_fall fall, stf_real dt)
{
    (void)dt;
    e->history = stf_fall_acceleration(fall, e->v);
}

static inline void velocity_verlet_element(stf_element *e, stf_fall fall, stf_real dt)
{
    const stf_real predicted_v = velocity_verlet_first(e, e->history, dt);

    e->history = stf_fall_acceleration(fall, predicted_v);
    velocity_verlet_second(e, e->history, dt);
}

static void velocity_verlet_flight(const stf_flight *flight, stf_real dt)
{
    if (flight->history_stale)
        stf_fly(flight, dt, true, velocity_verlet_element_start);
    stf_fly(flight, dt, true, velocity_verlet_element);
}

const stf_integrator stf_position_verlet = {
    .name = "position_verlet",
    .step = position_verlet_step,
    .step_flight = position_verlet_flight,
    .order = 2,
    .evaluations = 1,
    .work_arrays = 1,
    .history_arrays = 1,
    .real_stability = 1,
    .imaginary_stability = 2,
    .flags = STF_SYMPLECTIC | STF_COMPENSATES, /* it could be run backwards, but not from the velocity that it reports */
};

const stf_integrator stf_velocity_verlet = {
    .name = "velocity_verlet",
    .step = velocity_verlet_step,
    .step_flight = velocity_verlet_flight,
    .order = 2,
    .evaluations = 1,
    .work_arrays = 1,
    .history_arrays = 1,
    .real_stability = 1,
    .imaginary_stability = 2,
    .flags = STF_SYMPLECTIC | STF_REVERSIBLE | STF_COMPENSATES,
};
