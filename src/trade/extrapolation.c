/*
 * Gragg's modified midpoint rule, extrapolated to order 8, in double. Its error is a series in h^2 for every smooth a(t, x, v),
 * so that the results of n = 2, 4, 6 and 8 parts of a step are weighted to be rid of the terms h^2, h^4 and h^6. Sources:
 * W. B. Gragg, SIAM J. Numer. Anal. 2, 384 (1965); R. Bulirsch, J. Stoer, Numer. Math. 8, 1 (1966); E. Hairer, S. P. Norsett,
 * G. Wanner, Solving Ordinary Differential Equations I (1993), sec. II.9 (which shows that Gragg's smoothing is not needed).
 */
#define STF_DOUBLE
#include "reference.h"

#include "../sum.h"

#define COLUMNS 4
#define EVALUATIONS 17 /* 2 + 4 + 6 + 8, of which the first is shared */

static const int parts[COLUMNS] = {2, 4, 6, 8};

/* The product over i of n_j^2 / (n_j^2 - n_i^2), i other than j: Lagrange's polynomial in h^2, taken at 0. */
static const double weights[COLUMNS] = {-1.0 / 360, 16.0 / 45, -729.0 / 280, 1024.0 / 315};

/* z = y + f h, to another array */
static void start(size_t n, double *restrict z, const double *restrict y, const double *restrict f, double h)
{
    for (size_t i = 0; i < n; i++)
        z[i] = y[i] + f[i] * h;
}

/* z += f h */
static void advance(size_t n, double *restrict z, const double *restrict f, double h)
{
    for (size_t i = 0; i < n; i++)
        z[i] += f[i] * h;
}

/* sum += w (z - y): weighted changes, not weighted states, lose fewer digits */
static void gather(size_t n, double *restrict sum, const double *restrict z, const double *restrict y, double w)
{
    for (size_t i = 0; i < n; i++)
        sum[i] += w * (z[i] - y[i]);
}

/* sum += d; not what costs here, so that one loop does both. */
static void add_all(size_t n, double *sum, double *rest, const double *d)
{
    for (size_t i = 0; i < n; i++)
        stf_sum_add(&sum[i], rest ? &rest[i] : NULL, d[i], rest != NULL);
}

static void swap(double **a, double **b)
{
    double *const first = *a;

    *a = *b;
    *b = first;
}

/* z(1) = y + h f(y);  z(m+1) = z(m-1) + 2 h f(z(m)), where y = (x, v), f = (v, a) */
static void step(stf_system *system, double dt)
{
    const size_t n = system->length;
    double *x = system->position, *v = system->velocity, *first_a = system->work[0], *a = system->work[1];
    double *sum_x = system->work[2], *sum_v = system->work[3];

    for (size_t i = 0; i < n; i++)
        sum_x[i] = sum_v[i] = 0;
    system->accelerate(system, system->time, x, v, first_a);

    for (int column = 0; column < COLUMNS; column++) {
        const double h = dt / parts[column];
        double *x0 = system->work[4], *v0 = system->work[5], *x1 = system->work[6], *v1 = system->work[7];

        start(n, x0, x, v, 0);
        start(n, v0, v, first_a, 0);
        start(n, x1, x, v, h);
        start(n, v1, v, first_a, h);
        for (int m = 1; m < parts[column]; m++) {
            system->accelerate(system, system->time + m * h, x1, v1, a);
            advance(n, x0, v1, 2 * h);
            advance(n, v0, a, 2 * h);
            swap(&x0, &x1);
            swap(&v0, &v1);
        }
        gather(n, sum_x, x1, x, weights[column]);
        gather(n, sum_v, v1, v, weights[column]);
    }
    add_all(n, x, system->position_rest, sum_x);
    add_all(n, v, system->velocity_rest, sum_v);
}

const stf_integrator stf_trade_extrapolation = {
    .name = "extrapolation",
    .step = step,
    .order = 8,
    .evaluations = EVALUATIONS,
    .work_arrays = 8,
    .flags = STF_COMPENSATES,
};
