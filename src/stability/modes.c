/*
 * The modes of the reduced scene are (lambda^2 - lambda B - A) y = 0. Each is taken by itself, as x'' = alpha x + beta x'
 * with the quotients alpha = y* A y and beta = y* B y, and has a first step at which the integrator makes it grow. For
 * Runge-Kutta methods that is all, since they see eigenvalues only. Others mix modes that are damped unalike: so the
 * reduced scene is run as well, and the limit lowered where that grows before. Source: F. Tisseur, K. Meerbergen, SIAM
 * Rev. 43, 235 (2001).
 */
#include <string.h>

#include "../real.h"
#include "amplification.h"
#include "eigen.h"
#include "search.h"

#define FLOOR_MOST 0.5  /* however rough the forces are */
#define FLOOR 2.0       /* times sqrt(noise): eigenvalues that small a part of the largest are round-off around 0 */
#define GROWING 0.01    /* growth by this part of the eigenvalue is one of the scene itself, less is round-off */
#define ALIKE 1e-6      /* modes whose damping over frequency differs by no more have the same limit, scaled */
#define JUST_BELOW 0.98 /* where the reduced scene has to hold, or the limit is looked for below */
#define BISECTIONS 10

/* lambda of x'' = A x + B x': of y' = (0 1; A B) y, or where nothing is damped of lambda^2 x = A x. Returns how many. */
static size_t find_eigenvalues(stf_search *s)
{
    const stf_reduction *r = &s->reduction;
    const size_t n = r->count, order = r->damped ? 2 * n : n;

    for (size_t i = 0; i < order * order; i++)
        s->matrix[i] = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++) {
            s->matrix[(order - n + i) * order + k] = r->a[i * n + k];
            if (r->damped)
                s->matrix[(n + i) * order + n + k] = r->b[i * n + k];
        }
    for (size_t i = 0; r->damped && i < n; i++)
        s->matrix[i * order + n + i] = 1;
    stf_eigenvalues(order, s->matrix, s->values);
    for (size_t i = 0; i < order && !r->damped; i++)
        s->values[i] = csqrt(s->values[i]);
    return order;
}

void stf_search_find_shape(stf_search *s, double complex lambda)
{
    const stf_reduction *r = &s->reduction;
    const size_t n = r->count;

    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            s->matrix[i * n + k] = (i == k ? lambda * lambda : 0) - lambda * r->b[i * n + k] - r->a[i * n + k];
    stf_null_vector(n, s->matrix, s->shape);
}

/* y* M y */
static double complex quotient(const stf_search *s, const double *m)
{
    const size_t n = s->reduction.count;
    double complex sum = 0;

    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            sum += conj(s->shape[i]) * m[i * n + k] * s->shape[k];
    return sum;
}

/* Without an imaginary part that is round-off. */
static double complex tidy(double complex z) { return fabs(cimag(z)) < ALIKE * cabs(z) ? creal(z) : z; }

double complex stf_mode_root(const stf_mode *m, bool growing)
{
    const double complex half = m->beta / 2, away = csqrt(half * half + m->alpha), a = half + away, b = half - away;

    return (growing ? creal(a) > creal(b) : cabs(a) > cabs(b)) ? a : b;
}

/* Fills in what the mode of m->lambda is, and its limit where that is below `lowest`. `before`: one that may be alike. */
static void look_at(stf_search *s, stf_mode *m, const stf_mode *before, double lowest)
{
    m->alpha = tidy(m->lambda * m->lambda);
    m->beta = 0;
    m->limit = (double)INFINITY;
    if (s->reduction.damped) {
        stf_search_find_shape(s, m->lambda);
        m->alpha = tidy(quotient(s, s->reduction.a));
        m->beta = tidy(quotient(s, s->reduction.b));
    }

    const double size = cabs(stf_mode_root(m, false)), growth = creal(stf_mode_root(m, true)), noise = s->jacobian.noise;
    if (growth > GROWING * size) {
        s->growth = fmax(s->growth, growth);
        return;
    }
    if (cabs(m->alpha) < noise * size * size)
        m->alpha = 0; /* nothing that pulls it back either: round-off would be seen as a swing */
    if (creal(m->alpha) > 0)
        m->alpha -= creal(m->alpha); /* no force that drives it apart */
    if (creal(m->beta) > -noise * size)
        m->beta -= creal(m->beta); /* no damping, and no growth */

    const double old = cabs(stf_mode_root(before, false));
    const double complex alpha = m->alpha / (size * size), beta = m->beta / size;
    if (before->limit < (double)INFINITY && cabs(alpha - before->alpha / (old * old)) < ALIKE &&
        cabs(beta - before->beta / old) < ALIKE)
        m->limit = before->limit * old / size;
    else
        m->limit = stf_first_growth(s->integrator, alpha, beta, lowest * size) / size;
}

/* A -= alpha y y^T: of a mode that grows by itself nothing is left that drives it. */
static void calm_down(stf_search *s, double complex lambda)
{
    const size_t n = s->reduction.count;

    stf_search_find_shape(s, lambda);
    const double alpha = creal(quotient(s, s->reduction.a));
    for (size_t i = 0; i < n && alpha > 0; i++)
        for (size_t k = 0; k < n; k++)
            s->calm[i * n + k] -= alpha * creal(s->shape[i] * conj(s->shape[k]));
}

static stf_mode find_lowest(stf_search *s)
{
    const size_t count = find_eigenvalues(s);
    const double floor_part = fmin(FLOOR * sqrt(s->jacobian.noise), FLOOR_MOST);
    stf_mode limiting = {.limit = (double)INFINITY}, before = limiting;
    double fastest = 0;

    s->calm = s->h;
    memcpy(s->calm, s->reduction.a, s->reduction.count * s->reduction.count * sizeof *s->calm);
    for (size_t i = 0; i < count; i++)
        fastest = fmax(fastest, cabs(s->values[i]));
    for (size_t i = 0; i < count; i++) {
        stf_mode now = {.lambda = s->values[i]};
        const double size = cabs(now.lambda);
        if (s->reduction.damped && creal(now.lambda) > 0)
            calm_down(s, now.lambda);
        if (!(size > 0) || size < floor_part * fastest || cimag(now.lambda) < -ALIKE * size)
            continue;
        look_at(s, &now, &before, limiting.limit);
        before = now;
        if (now.limit < limiting.limit || (now.limit == limiting.limit && size > cabs(limiting.lambda)))
            limiting = now;
    }
    return limiting;
}

/* Lowers the limit to where the reduced scene as a whole, but for what grows by itself, stops to grow. */
static void lower(const stf_search *s, stf_mode *m)
{
    const stf_reduction *r = &s->reduction;
    double below = 0, above = JUST_BELOW * m->limit;

    if (!r->damped || !(m->limit > 0) || !(m->limit < (double)INFINITY) ||
        !stf_run_grows(s->integrator, r->count, s->calm, r->b, above))
        return;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = (below + above) / 2;
        *(stf_run_grows(s->integrator, r->count, s->calm, r->b, middle) ? &above : &below) = middle;
    }
    m->limit = below;
}

stf_mode stf_search_find_limiting(stf_search *s)
{
    stf_mode limiting = find_lowest(s);

    lower(s, &limiting);
    return limiting;
}
