/*
 * A step is linear in the extended state (x, v, history), so that from unit vectors it gives the columns of its
 * amplification matrix. The spectral radius is Gelfand's lim |M^n|^(1/n), n = 2^s by squaring, which unlike eigenvalues is
 * well-conditioned where two of them meet. Sources: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II
 * (1996), IV.2 and V.1; I. Gelfand, Mat. Sbornik 9, 3 (1941).
 */
#include "amplification.h"

#include <string.h>

#include "../real.h"

#define MODE_MAX 2                                         /* elements of a mode: complex numbers are pairs */
#define STATE_MAX (MODE_MAX * (2 + STF_HISTORY_ARRAYS_MAX)) /* elements of its extended state */
#define ARRAYS (2 + STF_WORK_ARRAYS_MAX + STF_HISTORY_ARRAYS_MAX)
#define LANES 16 /* an integrator may count on whole blocks: this is the smallest, and their alignment */
#define ALIGNMENT 64

/*
 * The search starts at DT_LEAST: what grows there already is taken to grow at every step. ROUNDING is what the radius may
 * be above 1 where it is 1: the matrix has elements of stf_real, and squaring adds roundings of double; 2^-SQUARINGS is
 * below it.
 */
#ifdef STF_DOUBLE
#define DT_LEAST 1e-4
#define SQUARINGS 50
#define ROUNDING 1e-10
#else
#define DT_LEAST 0.002
#define SQUARINGS 27
#define ROUNDING (4 * (double)FLT_EPSILON)
#endif
#define DT_MOST 64.0 /* what holds here holds always: implicit methods */
#define DT_RATIO 1.1
#define BISECTIONS 24

/* Log of the largest element of a power, below which its norm is below 1: -2 log STATE_MAX. */
#define SMALL (-5.0)

/*
 * Growth that sets in as a low power of dt is there at every dt, and only drowned in roundings below: at twice the dt it is
 * at most 2^6 times as large (order 4 and less). Growth beyond a limit comes up from 0 much faster.
 */
#define GRADUAL 128

typedef struct linear {
    stf_system system; /* first, so that accelerate finds the rest */
    size_t n;
    const double *a, *b;
    unsigned char memory[sizeof(stf_real) * STF_RUN_MAX * ARRAYS + ALIGNMENT];
} linear;

static void accelerate(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                       stf_real *acceleration)
{
    const linear *l = (const linear *)system;
    (void)time;

    memset(acceleration, 0, system->length * sizeof *acceleration);
    for (size_t i = 0; i < l->n; i++) {
        double sum = 0;
        for (size_t k = 0; k < l->n; k++)
            sum += l->a[i * l->n + k] * (double)position[k] + l->b[i * l->n + k] * (double)velocity[k];
        acceleration[i] = (stf_real)sum;
    }
}

/* All arrays 0. */
static void begin(linear *l, const stf_integrator *integrator, size_t n, const double *a, const double *b)
{
    stf_real *next = (stf_real *)(void *)(l->memory + ALIGNMENT - (uintptr_t)l->memory % ALIGNMENT);

    memset(l->memory, 0, sizeof l->memory);
    l->n = n, l->a = a, l->b = b;
    l->system = (stf_system){.length = (n + LANES - 1) / LANES * LANES, .accelerate = accelerate};
    l->system.position = next;
    l->system.velocity = next += l->system.length;
    for (int k = 0; k < integrator->history_arrays; k++)
        l->system.history[k] = next += l->system.length;
    for (int k = 0; k < integrator->work_arrays; k++)
        l->system.work[k] = next += l->system.length;
}

/* ---- one mode ------------------------------------------------------------------------------------------------------------ */

/* Element k of the extended state: begin lays position, velocity and history out one after another. */
static stf_real *element(linear *l, size_t k) { return l->system.position + k / l->n * l->system.length + k % l->n; }

/* M = (M / |M|)^2; returns log |M|, the largest element. */
static double square(size_t n, double *m)
{
    double scaled[STATE_MAX * STATE_MAX], largest = 0;

    for (size_t i = 0; i < n * n; i++)
        largest = fmax(largest, fabs(m[i]));
    if (!(largest > 0))
        return -(double)INFINITY;
    for (size_t i = 0; i < n * n; i++) {
        scaled[i] = m[i] / largest;
        m[i] = 0;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            for (size_t j = 0; j < n; j++)
                m[i * n + j] += scaled[i * n + k] * scaled[k * n + j];
    return log(largest);
}

/* By how much a step multiplies the mode in the long run. Where that is below 1, by how much is not told exactly. */
static double amplification(const stf_integrator *integrator, size_t n, const double *a, const double *b, double dt)
{
    const size_t order = n * (2 + (size_t)integrator->history_arrays);
    double matrix[STATE_MAX * STATE_MAX], log_norm = 0, power = 1;
    linear l;

    for (size_t j = 0; j < order; j++) {
        begin(&l, integrator, n, a, b);
        *element(&l, j) = 1;
        integrator->step(&l.system, (stf_real)dt);
        for (size_t i = 0; i < order; i++) {
            matrix[i * order + j] = (double)*element(&l, i);
            if (!isfinite(matrix[i * order + j]))
                return (double)INFINITY;
        }
    }
    for (int s = 0; s < SQUARINGS && log_norm > SMALL; s++, power *= 2)
        log_norm = 2 * (log_norm + square(order, matrix));
    return exp(log_norm / power);
}

double stf_first_growth(const stf_integrator *integrator, double complex alpha, double complex beta, double most)
{
    const size_t n = cimag(alpha) == 0 && cimag(beta) == 0 ? 1 : 2;
    const double a[] = {creal(alpha), -cimag(alpha), cimag(alpha), creal(alpha)};
    const double b[] = {creal(beta), -cimag(beta), cimag(beta), creal(beta)};
    double below = 0, above = DT_LEAST;

    while (amplification(integrator, n, a, b, above) <= 1 + ROUNDING) {
        if (above >= fmin(most, DT_MOST))
            return (double)INFINITY;
        below = above;
        above *= DT_RATIO;
    }
    if (below == 0)
        return 0;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = (below + above) / 2;
        *(amplification(integrator, n, a, b, middle) <= 1 + ROUNDING ? &below : &above) = middle;
    }
    if (b[0] == 0 && amplification(integrator, n, a, b, 2 * above) < 1 + GRADUAL * ROUNDING)
        return 0;
    return below;
}

/* ---- many modes together ------------------------------------------------------------------------------------------------- */

#define RUN_STEPS 1600
#define RUN_RATE 3e-3 /* a step: what modes that beat against each other can look like over half a run */
#define RUN_FAR 1e12  /* as large, or as small, there is no doubt */

bool stf_run_grows(const stf_integrator *integrator, size_t n, const double *a, const double *b, double dt)
{
    double largest[4] = {0}; /* in each quarter of the run */
    linear l;
    stf_system *system = &l.system;

    begin(&l, integrator, n, a, b);
    system->history_stale = true;
    for (size_t i = 0; i < n; i++) {
        system->position[i] = (stf_real)((1 + 0.1 * (double)(i % 7)) * (i % 3 ? 1 : -1));
        for (int k = 0; k < integrator->history_arrays; k++)
            system->history[k][i] = (stf_real)NAN;
    }
    for (unsigned step = 0; step < RUN_STEPS; step++) {
        double size = 0;
        integrator->step(system, (stf_real)dt);
        system->history_stale = false;
        for (size_t i = 0; i < n; i++)
            size += fabs((double)system->position[i]) + fabs((double)system->velocity[i]);
        if (!(size < RUN_FAR) || size < 1 / RUN_FAR)
            return !(size < 1);
        largest[4 * step / RUN_STEPS] = fmax(largest[4 * step / RUN_STEPS], size);
    }
    return log(largest[3] / largest[1]) > RUN_RATE * RUN_STEPS / 2;
}
