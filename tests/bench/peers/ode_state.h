/*
 * The workloads as an ODE y' = f(y), for the libraries that solve any: y holds the positions of a group of bodies, then their
 * velocities, x of all, then y of all. Plain loops, which compilers vectorise.
 */
#ifndef STEADFAST_TESTS_ODE_STATE_H
#define STEADFAST_TESTS_ODE_STATE_H

#include <math.h>

#include "peer.h"

/* a(x, v) of bodies first to first + count - 1. x, v, a: [count dimensions]. */
static inline void ode_accelerations(const workload *w, workload_kind kind, size_t first, size_t count, const double *x,
                                     const double *v, double *a)
{
    if (kind == KEPLER) {
        for (size_t i = 0; i < count; i++) {
            const double r_squared = x[i] * x[i] + x[count + i] * x[count + i];
            const double pull = -1 / (r_squared * sqrt(r_squared));
            a[i] = pull * x[i];
            a[count + i] = pull * x[count + i];
        }
    } else if (kind == OSCILLATORS) {
        for (size_t i = 0; i < count; i++)
            a[i] = -w->stiffness[first + i] * x[i];
    } else {
        for (unsigned d = 0; d < w->dimensions; d++) {
            const double g = d == 1 ? -w->gravity : 0, drag = w->drag;
            for (size_t i = 0; i < count; i++)
                a[d * count + i] = g - drag * v[d * count + i];
        }
    }
}

/* f of one group: (x, v)' = (v, a). y and rates: [2 count dimensions]. */
static inline void ode_rates(const workload *w, workload_kind kind, size_t first, size_t count, const double *y, double *rates)
{
    const size_t half = count * (kind == KEPLER ? 2 : kind == OSCILLATORS ? 1 : w->dimensions);

    for (size_t i = 0; i < half; i++)
        rates[i] = y[half + i];
    ode_accelerations(w, kind, first, count, y, y + half, rates + half);
}

/* The bodies that one state holds; the last state of a workload may hold fewer. */
static inline size_t ode_group(const workload *w, const method *m, size_t first)
{
    const size_t left = w->count - first;

    return m->group && m->group < left ? m->group : left;
}

/* Where the components of a body stand in the states of all groups, one after another: position at [d group], velocity at
   [(dimensions + d) group]. */
static inline size_t ode_offset(const workload *w, const method *m, size_t body, size_t *group)
{
    const size_t first = m->group ? body - body % m->group : 0;

    *group = ode_group(w, m, first);
    return 2 * first * w->dimensions + (body - first);
}

/* Workload to states, and states to what peer.read gives. y: [2 count dimensions]. */
static inline void ode_load(const workload *w, const method *m, double *y)
{
    for (size_t i = 0; i < w->count; i++) {
        size_t group;
        double *body = y + ode_offset(w, m, i, &group);
        for (unsigned d = 0; d < w->dimensions; d++) {
            body[d * group] = w->position[3 * i + d];
            body[(w->dimensions + d) * group] = w->velocity[3 * i + d];
        }
    }
}

static inline void ode_store(const workload *w, const method *m, const double *y, double *position, double *velocity)
{
    for (size_t i = 0; i < w->count; i++) {
        size_t group;
        const double *body = y + ode_offset(w, m, i, &group);
        for (unsigned d = 0; d < w->dimensions; d++) {
            position[3 * i + d] = body[d * group];
            velocity[3 * i + d] = body[(w->dimensions + d) * group];
        }
    }
}

#endif
