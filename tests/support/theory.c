#include "support/theory.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

static bool is(const char *integrator, const char *name) { return strcmp(integrator, name) == 0; }

static bool is_verlet(const char *integrator) { return is(integrator, "position_verlet") || is(integrator, "velocity_verlet"); }

static bool is_symplectic(const char *integrator) { return is_verlet(integrator) || is(integrator, "semi_implicit_euler"); }

/* ---- Runge-Kutta methods: stage s lies along the slopes of the stage before ---------------------------------------------- */

#define STAGES_MAX 4

typedef struct tableau {
    const char *integrator;
    int stages;
    double along[STAGES_MAX]; /* how far stage s goes along the slopes of stage s - 1 */
    double weights[STAGES_MAX], divisor;
} tableau;

static const tableau tableaux[] = {
    {"explicit_euler", 1, {0}, {1}, 1},
    {"midpoint", 2, {0, 0.5}, {0, 1}, 1},
    {"improved_euler", 2, {0, 1}, {1, 1}, 2},
    {"rk4", 4, {0, 0.5, 0.5, 1}, {1, 2, 2, 1}, 6},
};

static const tableau *tableau_of(const char *integrator)
{
    for (size_t i = 0; i < sizeof tableaux / sizeof *tableaux; i++)
        if (is(integrator, tableaux[i].integrator))
            return &tableaux[i];
    return NULL;
}

/* R(z) = 1 + z + z^2 / 2 + ...: these methods have as many stages as their order. Its real and imaginary part at x or i y. */
static double stability_function(const char *integrator, double x, double y, double *imaginary)
{
    const tableau *method = tableau_of(integrator);
    double term = 1, term_i = 0, sum = 1, sum_i = 0;

    for (int k = 1; k <= (method ? method->stages : 1); k++) {
        const double next = (term * x - term_i * y) / k;
        term_i = (term * y + term_i * x) / k;
        term = next;
        sum += term;
        sum_i += term_i;
    }
    *imaginary = sum_i;
    return sum;
}

double theory_drag_factor(const char *integrator, double q)
{
    double imaginary;

    return stability_function(integrator, -q, 0, &imaginary);
}

/* Both Verlet methods, whose acceleration is one prediction old, obey v(n+2) = (1 - 3 q / 2) v(n+1) + (q / 2) v(n). */
double theory_drag_growth(const char *integrator, double q)
{
    const double sum = 1 - 1.5 * q;

    return is_verlet(integrator) ? (fabs(sum) + sqrt(sum * sum + 2 * q)) / 2 : fabs(theory_drag_factor(integrator, q));
}

/* The symplectic methods have x(n+1) - (2 - z^2) x(n) + x(n-1) = 0. */
double theory_spring_growth(const char *integrator, double z)
{
    if (is_symplectic(integrator)) {
        const double half = fabs(1 - z * z / 2);
        return half <= 1 ? 1 : half + sqrt(half * half - 1);
    }

    double imaginary;
    const double real = stability_function(integrator, 0, z, &imaginary);

    return hypot(real, imaginary);
}

double theory_roundings(const char *integrator, double z)
{
    const tableau *method = tableau_of(integrator);
    double term = 1, sum = 1;

    for (int k = 1; k <= (method ? method->stages : 2); k++) {
        term *= method ? z / k : z;
        sum += term;
    }
    return sum;
}

double theory_frequency_error(const char *integrator, double z)
{
    if (is_symplectic(integrator))
        return 2 * asin(z / 2) / z - 1;

    double imaginary;
    const double real = stability_function(integrator, 0, z, &imaginary);

    return atan2(imaginary, real) / z - 1;
}

/* ---- the motion ---------------------------------------------------------------------------------------------------------- */

static void note(double *largest, double x) { *largest = fmax(*largest, fabs(x)); }

/* a dt^2 */
static double accelerate(theory *t, double x, double u)
{
    const double a = -t->z_square * x - t->q * u;

    note(&t->largest_product, x * x);
    note(&t->largest_product, x * u);
    note(&t->largest_sum, u);
    note(&t->largest_sum, a);
    return a;
}

static void runge_kutta_step(theory *t, const tableau *method)
{
    double x = t->x, u = t->u, slope_x = 0, slope_u = 0, sum_x = 0, sum_u = 0;

    for (int s = 0; s < method->stages; s++) {
        x = t->x + method->along[s] * slope_x;
        u = t->u + method->along[s] * slope_u;
        slope_x = u;
        slope_u = accelerate(t, x, u);
        sum_x += method->weights[s] * slope_x;
        sum_u += method->weights[s] * slope_u;
    }
    note(&t->largest_sum, sum_x);
    note(&t->largest_sum, sum_u);
    t->x += sum_x / method->divisor;
    t->u += sum_u / method->divisor;
}

static void semi_implicit_euler_step(theory *t)
{
    t->u += accelerate(t, t->x, t->u);
    t->x += t->u;
}

static void position_verlet_step(theory *t)
{
    const double a = accelerate(t, t->x, t->u);

    t->history += a;
    t->x += t->history;
    t->u = t->history + a / 2;
}

static void velocity_verlet_step(theory *t)
{
    const double half = t->u + t->history / 2;

    t->x += half;
    t->history = accelerate(t, t->x, half + t->history / 2);
    t->u = half + t->history / 2;
}

theory theory_start(const char *integrator, double z_square, double q, double x, double u)
{
    theory t = {.integrator = integrator, .z_square = z_square, .q = q, .x = x, .u = u};
    const double a = accelerate(&t, x, u);

    t.history = is(integrator, "position_verlet") ? u - a / 2 : a;
    return t;
}

/* A power of two changes no digit; a step takes nothing beyond the square root of the range. */
static void scale(theory *t)
{
    const double size = fmax(fmax(fabs(t->x), fabs(t->u)), fabs(t->history));
    int exponent = 0;

    if (size > 0x1p100 || (size > 0 && size < 0x1p-100))
        frexp(size, &exponent);
    t->x = ldexp(t->x, -exponent);
    t->u = ldexp(t->u, -exponent);
    t->history = ldexp(t->history, -exponent);
    t->exponent += exponent;
}

void theory_step(theory *t)
{
    const tableau *method = tableau_of(t->integrator);

    scale(t);
    t->largest_product = t->largest_sum = 0;
    if (method)
        runge_kutta_step(t, method);
    else if (is(t->integrator, "semi_implicit_euler"))
        semi_implicit_euler_step(t);
    else if (is(t->integrator, "position_verlet"))
        position_verlet_step(t);
    else
        velocity_verlet_step(t);
    note(&t->largest_sum, t->x);
    note(&t->largest_sum, t->u);
}
