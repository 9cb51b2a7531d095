/*
 * Free flight: the acceleration of gravity and linear drag, for the loop that adds forces to it and for the integrators' loops
 * that it is written into. Sources: Galilei's law; Stokes' drag F = -k v.
 */
#ifndef STEADFAST_SRC_FLIGHT_H
#define STEADFAST_SRC_FLIGHT_H

#include "steadfast/integrator.h"
#include "sum.h"

/* What is constant over a step for one element: 0 for the immovable. */
typedef struct stf_fall {
    stf_real gravity; /* m/s^2 */
    stf_real rate;    /* k / m, 1/s */
} stf_fall;

static inline stf_fall stf_fall_of(stf_real gravity, stf_real drag, stf_real inverse_mass)
{
    return (stf_fall){.gravity = inverse_mass > 0 ? gravity : 0, .rate = drag * inverse_mass};
}

/* a = g - (k / m) v */
static inline stf_real stf_fall_acceleration(stf_fall f, stf_real v) { return f.gravity - f.rate * v; }

/* One element of a system or flight: what an integrator's formulas step. */
typedef struct stf_element {
    stf_real x, v;
    stf_real history;        /* of integrators that have any */
    stf_real x_rest, v_rest; /* what rounding left of x and v, in worlds that keep it */
    bool compensated;        /* whether they do: a constant in each loop */
} stf_element;

/* x += d and v += d: what each method ends with, by the names that symplectic methods have for them. */
static inline void stf_drift(stf_element *e, stf_real d) { stf_sum_add(&e->x, &e->x_rest, d, e->compensated); }
static inline void stf_kick(stf_element *e, stf_real d) { stf_sum_add(&e->v, &e->v_rest, d, e->compensated); }

typedef void stf_element_step(stf_element *element, stf_fall fall, stf_real dt);

/*
 * Steps every element of a flight, row by row. `step`, `has_history` and `compensated` are constants at each call, so the
 * compiler writes them into the loop. With the dimensions inside the inner loop neither gcc 12 nor clang 14 found plain vector
 * loads any more.
 */
/* One loop, as gcc 12 forgets `restrict` in parts of it; NOLINTNEXTLINE(readability-function-cognitive-complexity) */
STF_INLINE void stf_flight_rows(const stf_flight *flight, stf_real *restrict x, stf_real *restrict v,
                                stf_real *restrict x_rest, stf_real *restrict v_rest, stf_real *restrict history,
                                const stf_real *restrict inverse_mass, stf_real dt, bool has_history, bool compensated,
                                stf_element_step *step)
{
    const size_t lanes = flight->stride / STF_ROW_MULTIPLE * STF_ROW_MULTIPLE;
    const stf_real drag = flight->drag;

    for (size_t b = 0; b < flight->blocks; b++, inverse_mass += lanes)
        for (unsigned d = 0; d < flight->dimensions; d++, x += lanes, v += lanes) {
            const stf_real gravity = flight->gravity[d];

            for (size_t i = 0; i < lanes; i++) {
                stf_element e = {.x = x[i], .v = v[i], .history = has_history ? history[i] : 0, .compensated = compensated};
                if (compensated)
                    e.x_rest = x_rest[i], e.v_rest = v_rest[i];
                step(&e, stf_fall_of(gravity, drag, inverse_mass[i]), dt);
                x[i] = e.x;
                v[i] = e.v;
                if (compensated)
                    x_rest[i] = e.x_rest, v_rest[i] = e.v_rest;
                if (has_history)
                    history[i] = e.history;
            }
            if (has_history)
                history += lanes;
            if (compensated)
                x_rest += lanes, v_rest += lanes;
        }
}

STF_INLINE void stf_fly(const stf_flight *flight, stf_real dt, bool has_history, stf_element_step *step)
{
    if (flight->position_rest)
        stf_flight_rows(flight, flight->position, flight->velocity, flight->position_rest, flight->velocity_rest,
                        flight->history[0], flight->inverse_mass, dt, has_history, true, step);
    else
        stf_flight_rows(flight, flight->position, flight->velocity, NULL, NULL, flight->history[0], flight->inverse_mass, dt,
                        has_history, false, step);
}

#endif
