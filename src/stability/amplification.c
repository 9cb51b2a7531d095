/*
 * The amplification matrix of an integrator comes from its own step, on x'' = alpha x + beta x'. A step is linear in the
 * extended state (x, v, history), so that it gives column j of the matrix where it starts from the j-th unit vector. Elements
 * of an stf_system do not mix: two of them make a complex number, and one step does all columns side by side. Its spectral
 * radius is Gelfand's lim |M^n|^(1/n), n = 2^s by squaring, which unlike eigenvalues is well-conditioned where two of them meet.
 * Sources: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.2 and V.1; I. Gelfand, Mat. Sbornik 9, 3
 * (1941).
 */
#include "amplification.h"

#include "../real.h"

#define VARIABLES_MAX (2 + STF_HISTORY_ARRAYS_MAX)
#define LENGTH 16 /* of the system: the lanes of the smallest block, 2 for each column */
#define ARRAYS (2 + STF_WORK_ARRAYS_MAX + STF_HISTORY_ARRAYS_MAX)
#define ALIGNMENT 64

/*
 * Where the search starts, as a part of 1 / |eigenvalue|: what grows here already is taken to grow at every step. ROUNDING is
 * what the radius may be above 1 where it is 1: the matrix has elements of stf_real, and squaring adds some roundings of double;
 * 2^-SQUARINGS is below it.
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
#define DT_MOST 64.0 /* a step this long that still holds holds always: implicit methods */
#define DT_RATIO 1.1
#define BISECTIONS 24

/* Log of the largest element of a scaled power, below which its norm is below 1: 2 log VARIABLES_MAX = 3.6. */
#define SMALL -4.0

/*
 * Growth that sets in gradually, as a low power of dt, is there at every dt and only drowned in roundings below: at twice the
 * dt it is at most 2^6 times as large (order 4 and less). Growth beyond a limit comes up from 0 much faster.
 */
#define GRADUAL 128

typedef struct mode_system {
    stf_system system; /* first, so that accelerate finds the mode */
    double complex alpha, beta;
} mode_system;

static double complex element(const stf_real *array, size_t column)
{
    double complex z;

    ((double *)&z)[0] = (double)array[2 * column];
    ((double *)&z)[1] = (double)array[2 * column + 1];
    return z;
}

static void accelerate(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                       stf_real *acceleration)
{
    const mode_system *mode = (const mode_system *)system;
    const stf_real ar = (stf_real)creal(mode->alpha), ai = (stf_real)cimag(mode->alpha);
    const stf_real br = (stf_real)creal(mode->beta), bi = (stf_real)cimag(mode->beta);
    (void)time;

    for (size_t i = 0; i + 1 < system->length; i += 2) {
        const stf_real x = position[i], y = position[i + 1], v = velocity[i], w = velocity[i + 1];
        acceleration[i] = ar * x - ai * y + br * v - bi * w;
        acceleration[i + 1] = ar * y + ai * x + br * w + bi * v;
    }
}

/* M = (M / |M|)^2; returns log |M|, the largest element. */
static double square(size_t n, double complex *m)
{
    double complex scaled[VARIABLES_MAX * VARIABLES_MAX];
    double largest = 0;

    for (size_t i = 0; i < n * n; i++)
        largest = fmax(largest, cabs(m[i]));
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

/* Stops at a power of M whose norm is below 1, and so the radius: by how much is not asked. */
static double spectral_radius(size_t n, double complex *m)
{
    double log_norm = 0, power = 1; /* of M^power */

    for (size_t i = 0; i < n * n; i++)
        if (!isfinite(creal(m[i])) || !isfinite(cimag(m[i])))
            return (double)INFINITY;
    for (int s = 0; s < SQUARINGS && log_norm > SMALL; s++, power *= 2)
        log_norm = 2 * (log_norm + square(n, m));
    return exp(log_norm / power);
}

double stf_amplification(const stf_integrator *integrator, double complex alpha, double complex beta, double dt)
{
    const size_t n = 2 + (size_t)integrator->history_arrays;
    unsigned char memory[ARRAYS * LENGTH * sizeof(stf_real) + ALIGNMENT] = {0};
    stf_real *arrays = (stf_real *)(void *)(memory + ALIGNMENT - (uintptr_t)memory % ALIGNMENT);
    stf_real *variables[VARIABLES_MAX];
    double complex matrix[VARIABLES_MAX * VARIABLES_MAX];
    mode_system mode = {.system = {.length = LENGTH, .position = arrays, .velocity = arrays + LENGTH, .accelerate = accelerate},
                        .alpha = alpha,
                        .beta = beta};

    for (size_t k = 0; k < n; k++)
        variables[k] = arrays + k * LENGTH;
    for (size_t k = 2; k < n; k++)
        mode.system.history[k - 2] = variables[k];
    for (int k = 0; k < integrator->work_arrays; k++)
        mode.system.work[k] = arrays + (n + (size_t)k) * LENGTH;
    for (size_t k = 0; k < n; k++)
        variables[k][2 * k] = 1;
    integrator->step(&mode.system, (stf_real)dt);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            matrix[i * n + j] = element(variables[i], j);
    return spectral_radius(n, matrix);
}

static bool mode_grows(const stf_integrator *integrator, double complex alpha, double complex beta, double dt)
{
    return !(stf_amplification(integrator, alpha, beta, dt) <= 1 + ROUNDING);
}

double stf_first_growth(const stf_integrator *integrator, double complex alpha, double complex beta, double most)
{
    double below = 0, above = DT_LEAST;

    while (!mode_grows(integrator, alpha, beta, above)) {
        if (above >= fmin(most, DT_MOST))
            return (double)INFINITY;
        below = above;
        above *= DT_RATIO;
    }
    if (below == 0)
        return 0;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = (below + above) / 2;
        *(mode_grows(integrator, alpha, beta, middle) ? &above : &below) = middle;
    }
    if (creal(beta) == 0 && stf_amplification(integrator, alpha, beta, 2 * above) < 1 + GRADUAL * ROUNDING)
        return 0;
    return below;
}

/* ---- many modes ---------------------------------------------------------------------------------------------------------- */

#define RUN_STEPS 1600
#define RUN_RATE 3e-3 /* a step: what modes that beat against each other can look like over half a run */
#define RUN_FAR 1e12

typedef struct run_system {
    stf_system system; /* first, so that accelerate_all finds the run */
    size_t n;
    const double *a, *b;
} run_system;

static void accelerate_all(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                           stf_real *acceleration)
{
    const run_system *run = (const run_system *)system;
    (void)time;

    for (size_t i = 0; i < system->length; i++)
        acceleration[i] = 0;
    for (size_t i = 0; i < run->n; i++) {
        double sum = 0;
        for (size_t k = 0; k < run->n; k++)
            sum += run->a[i * run->n + k] * (double)position[k] + run->b[i * run->n + k] * (double)velocity[k];
        acceleration[i] = (stf_real)sum;
    }
}

bool stf_reduced_run_grows(const stf_integrator *integrator, size_t n, const double *a, const double *b, double dt)
{
    unsigned char memory[ARRAYS * STF_RUN_LENGTH_MAX * sizeof(stf_real) + ALIGNMENT] = {0};
    stf_real *next = (stf_real *)(void *)(memory + ALIGNMENT - (uintptr_t)memory % ALIGNMENT);
    run_system run = {.system = {.length = (n + LENGTH - 1) / LENGTH * LENGTH, .accelerate = accelerate_all, .history_stale = true},
                      .n = n,
                      .a = a,
                      .b = b};
    stf_system *system = &run.system;
    double largest[4] = {0}; /* in each quarter of the run */

    system->position = next;
    system->velocity = next += system->length;
    for (int k = 0; k < integrator->work_arrays; k++)
        system->work[k] = next += system->length;
    for (int k = 0; k < integrator->history_arrays; k++) {
        system->history[k] = next += system->length;
        for (size_t i = 0; i < n; i++)
            system->history[k][i] = (stf_real)NAN;
    }
    for (size_t i = 0; i < n; i++)
        system->position[i] = (stf_real)(1 + 0.1 * (double)(i % 7)) * (i % 3 ? 1 : -1);
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
    return log(largest[3] / largest[1]) > RUN_STEPS / 2 * RUN_RATE;
}
