/* All pairs: a_i = -sum_j G m_j d / (|d|^2 + e^2)^(3/2), d = x_i - x_j; square root and division correctly rounded. */
#include "names.h"

#include <math.h>
#include <string.h>

#define TILE 256 /* particles: the arrays of two tiles stay in the first-level cache */

/*
 * Both ends of the pairs of one particle, p and its strength, with the n of a tile. The tile's particles are pulled each in
 * its own place; the particle itself gets REFERENCE_LANES sums, put together at the end. n: a multiple of REFERENCE_LANES.
 */
static void pull_both(size_t n, const stf_real *restrict x, const stf_real *restrict y, const stf_real *restrict z,
                      const stf_real *restrict strength, stf_real *restrict ax, stf_real *restrict ay, stf_real *restrict az,
                      const stf_real p[4], stf_real softening_square, stf_real pulled[3])
{
    const stf_real px = p[0], py = p[1], pz = p[2], ps = p[3];
    stf_real sx[REFERENCE_LANES] = {0}, sy[REFERENCE_LANES] = {0}, sz[REFERENCE_LANES] = {0};

    for (size_t j = 0; j < n; j += REFERENCE_LANES)
        for (size_t l = 0; l < REFERENCE_LANES; l++) {
            const size_t i = j + l;
            const stf_real dx = px - x[i], dy = py - y[i], dz = pz - z[i];
            const stf_real square = softening_square + dx * dx + dy * dy + dz * dz, reciprocal = 1 / SQRT(square);
            const stf_real inverse = square > 0 ? reciprocal : 0;
            const stf_real ux = dx * inverse, uy = dy * inverse, uz = dz * inverse;
            const stf_real from = strength[i] * inverse * inverse, to = ps * inverse * inverse;

            sx[l] += from * ux, sy[l] += from * uy, sz[l] += from * uz;
            ax[i] += to * ux, ay[i] += to * uy, az[i] += to * uz;
        }
    for (size_t l = 0; l < REFERENCE_LANES; l++)
        pulled[0] -= sx[l], pulled[1] -= sy[l], pulled[2] -= sz[l];
}

/* One end: what p does to the n of its own tile, itself among them. */
static void pull_one(size_t n, const stf_real *restrict x, const stf_real *restrict y, const stf_real *restrict z,
                     stf_real *restrict ax, stf_real *restrict ay, stf_real *restrict az, const stf_real p[4],
                     stf_real softening_square)
{
    const stf_real px = p[0], py = p[1], pz = p[2], ps = p[3];

    for (size_t i = 0; i < n; i++) {
        const stf_real dx = px - x[i], dy = py - y[i], dz = pz - z[i];
        const stf_real square = softening_square + dx * dx + dy * dy + dz * dz, reciprocal = 1 / SQRT(square);
        const stf_real inverse = square > 0 ? reciprocal : 0, to = ps * inverse * inverse;

        ax[i] += to * (dx * inverse), ay[i] += to * (dy * inverse), az[i] += to * (dz * inverse);
    }
}

/* G m, 0 for those who do not pull; in: 1 / m. */
static void strengths(size_t n, stf_real *restrict strength, const stf_real *restrict w, stf_real constant)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real s = constant / w[i];
        strength[i] = w[i] > 0 ? s : 0;
    }
}

/* a -> F, in place */
static void forces(size_t n, stf_real *restrict a, const stf_real *restrict w)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real f = a[i] / w[i];
        a[i] = w[i] > 0 ? f : 0;
    }
}

void reference_all_pairs(const reference_bodies *b, const reference_law *law)
{
    stf_real *const *x = b->x, *const *a = b->a, *strength = b->packed;
    const stf_real softening_square = law->softening * law->softening;
    const size_t padded = (b->n + REFERENCE_LANES - 1) / REFERENCE_LANES * REFERENCE_LANES;

    strengths(padded, strength, b->w, law->strength);
    for (int d = 0; d < 3; d++)
        memset(a[d], 0, padded * sizeof(stf_real));
    for (size_t first = 0; first < padded; first += TILE)
        for (size_t i = 0; i < b->n; i++) {
            const size_t n = padded - first < TILE ? padded - first : TILE;
            const stf_real p[4] = {x[0][i], x[1][i], x[2][i], strength[i]};
            stf_real pulled[3] = {a[0][i], a[1][i], a[2][i]};

            if (i >= first + TILE)
                break;
            if (i >= first) {
                pull_one(n, x[0] + first, x[1] + first, x[2] + first, a[0] + first, a[1] + first, a[2] + first, p,
                         softening_square);
                continue;
            }
            pull_both(n, x[0] + first, x[1] + first, x[2] + first, strength + first, a[0] + first, a[1] + first, a[2] + first,
                      p, softening_square, pulled);
            for (int d = 0; d < 3; d++)
                a[d][i] = pulled[d];
        }
    for (int d = 0; d < 3; d++)
        forces(b->n, a[d], b->w);
}
