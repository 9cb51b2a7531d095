/*
 * Rayleigh and Ritz's method on Krylov's space of A + weight B: where A and B are symmetric their extreme shapes come
 * first. A and B are kept apart, so that x'' = A x + B x' stays one: what is damped in the scene is damped in the
 * reduction, and no disturbance grows that would not. Sources: W. E. Arnoldi, Quart. Appl. Math. 9, 17 (1951); Z. Bai, Y.
 * Su, SIAM J. Matrix Anal. Appl. 26, 640 (2005) (projections that keep second order); J. W. Daniel, W. B. Gragg, L.
 * Kaufman, G. W. Stewart, Math. Comp. 30, 772 (1976) (orthogonalise again where much was cancelled).
 */
#include "reduction.h"

#include <math.h>

#include "eigen.h"

#define CANCELLED 0.7    /* a norm that falls below this part of what it was: orthogonalise again */
#define EXHAUSTED 1e-12  /* what is left beside this is round-off of double */
#define NOISE_TIMES 16.0 /* asymmetry of this many times the noise is noise */

static double scale_to_one(size_t n, double *v)
{
    const double norm = sqrt(stf_dot(n, v, v));

    for (size_t i = 0; i < n && norm > 0; i++)
        v[i] /= norm;
    return norm;
}

/* w -= V V^T w, for the shapes up to j; adds V^T w to column j of h. */
static void orthogonalise(size_t n, size_t j, size_t most, const double *shapes, double *w, double *h)
{
    for (size_t i = 0; i <= j; i++) {
        const double *v = shapes + i * n, part = stf_dot(n, v, w);

        for (size_t k = 0; k < n; k++)
            w[k] -= part * v[k];
        h[i * most + j] += part;
    }
}

/* (M + M^T) / 2, where what they differ by is noise. */
static void symmetrise(size_t n, double *m, double noise)
{
    double apart = 0, together = 0;

    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            apart = hypot(apart, m[i * n + j] - m[j * n + i]);
            together = hypot(together, m[i * n + j] + m[j * n + i]);
        }
    for (size_t i = 0; i < n && apart < NOISE_TIMES * noise * together; i++)
        for (size_t j = 0; j < i; j++)
            m[i * n + j] = m[j * n + i] = (m[i * n + j] + m[j * n + i]) / 2;
}

void stf_reduce(stf_reduction *r, stf_jacobian *j, size_t most, double *h)
{
    const size_t n = j->length;
    const double unit = j->frequency * j->frequency;
    size_t count = 0;

    for (size_t i = 0; i < (most + 1) * most; i++)
        h[i] = 0;
    scale_to_one(n, r->shapes);
    for (r->left = 1; count < most && r->left > 0; count++) {
        const double *v = r->shapes + count * n;
        double *w = r->shapes + (count + 1) * n, *damped = r->damped ? r->damped_shapes + count * n : NULL;

        stf_jacobian_product(j, v, NULL, w);
        if (damped)
            stf_jacobian_product(j, NULL, v, damped);
        for (size_t i = 0; i < n; i++)
            w[i] = (w[i] + (damped ? r->weight * damped[i] : 0)) / unit;
        const double before = sqrt(stf_dot(n, w, w));
        orthogonalise(n, count, most, r->shapes, w, h);
        if (stf_dot(n, w, w) < CANCELLED * CANCELLED * before * before)
            orthogonalise(n, count, most, r->shapes, w, h);
        r->left = scale_to_one(n, w);
        if (r->left <= EXHAUSTED * before)
            r->left = 0;
        h[(count + 1) * most + count] = r->left;
    }
    r->count = count;
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < count; k++) {
            const double b = r->damped ? stf_dot(n, r->shapes + i * n, r->damped_shapes + k * n) / unit : 0;
            r->b[i * count + k] = b;
            r->a[i * count + k] = h[i * most + k] - r->weight * b;
        }
    symmetrise(count, r->a, j->noise);
    symmetrise(count, r->b, j->noise);
}
