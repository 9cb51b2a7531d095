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
 * d is kept, never computed as a difference of positions.
 * v(n+1) = d(n+1) / dt + a(n) dt / 2: the difference is the velocity half a step ago.
 */
static inline void position_verlet(stf_real *x, stf_real *v, stf_real *d, stf_real a, stf_real dt)
{
    *d += a * dt * dt;
    *x += *d;
    *v = *d / dt + a * (HALF * dt);
}

/* The difference that led here, from the Taylor series, where there is none: d(n) = v(n) dt - a(n) dt^2 / 2. */
static inline stf_real position_verlet_start(stf_real d, stf_real v, stf_real a, stf_real dt)
{
    const stf_real start = (v - a * (HALF * dt)) * dt;

    return d == d ? d : start;
}

static void position_verlet_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict d,
                                const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++)
        position_verlet(&x[i], &v[i], &d[i], a[i], dt);
}

static void position_verlet_start_all(size_t n, stf_real *restrict d, const stf_real *restrict v,
                                      const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++)
        d[i] = position_verlet_start(d[i], v[i], a[i], dt);
}

static void position_verlet_loop(stf_system *part, stf_real dt)
{
    const size_t n = part->length;
    stf_real *x = part->position, *v = part->velocity, *a = part->work[0], *d = part->history[0];

    if (part->history_stale)
        position_verlet_start_all(n, d, v, a, dt);
    position_verlet_all(n, x, v, d, a, dt);
}

static void position_verlet_step(stf_system *system, stf_real dt)
{
    system->accelerate(system, system->time, system->position, system->velocity, system->work[0]);
    stf_system_each(system, position_verlet_loop, dt);
}

static inline void position_verlet_element_start(stf_element *e, stf_fall fall, stf_real dt)
{
    e->history = position_verlet_start(e->history, e->v, stf_fall_acceleration(fall, e->v), dt);
}

static inline void position_verlet_element(stf_element *e, stf_fall fall, stf_real dt)
{
    position_verlet(&e->x, &e->v, &e->history, stf_fall_acceleration(fall, e->v), dt);
}

static void position_verlet_flight(const stf_flight *flight, stf_real dt)
{
    if (flight->history_stale)
        stf_fly(flight, dt, true, position_verlet_element_start);
    stf_fly(flight, dt, true, position_verlet_element);
}

/* v(n+1/2) = v(n) + a(n) dt / 2;  x(n+1) = x(n) + v(n+1/2) dt;  returns the predicted v(n+1) = v(n+1/2) + a(n) dt / 2 */
static inline stf_real velocity_verlet_first(stf_real *x, stf_real *v, stf_real a, stf_real dt)
{
    const stf_real kick = a * (HALF * dt);

    *v += kick;
    *x += *v * dt;
    return *v + kick;
}

/* v(n+1) = v(n+1/2) + a(n+1) dt / 2 */
static inline void velocity_verlet_second(stf_real *v, stf_real a, stf_real dt) { *v += a * (HALF * dt); }

static void velocity_verlet_first_all(size_t n, stf_real *restrict x, stf_real *restrict v, stf_real *restrict predicted_v,
                                      const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++)
        predicted_v[i] = velocity_verlet_first(&x[i], &v[i], a[i], dt);
}

static void velocity_verlet_second_all(size_t n, stf_real *restrict v, const stf_real *restrict a, stf_real dt)
{
    for (size_t i = 0; i < n; i++)
        velocity_verlet_second(&v[i], a[i], dt);
}

static void velocity_verlet_first_loop(stf_system *part, stf_real dt)
{
    velocity_verlet_first_all(part->length, part->position, part->velocity, part->work[0], part->history[0], dt);
}

static void velocity_verlet_second_loop(stf_system *part, stf_real dt)
{
    velocity_verlet_second_all(part->length, part->velocity, part->history[0], dt);
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
    const stf_real predicted_v = velocity_verlet_first(&e->x, &e->v, e->history, dt);

    e->history = stf_fall_acceleration(fall, predicted_v);
    velocity_verlet_second(&e->v, e->history, dt);
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
    .flags = STF_SYMPLECTIC, /* its positions could be run backwards, but not from the velocity that it reports */
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
    .flags = STF_SYMPLECTIC | STF_REVERSIBLE,
};
