/*
 * Eigenvalues of a small complex matrix: reduced to Hessenberg form by elimination, then QR iterations with Wilkinson's
 * shift and Givens rotations. Sources: G. H. Golub, C. F. Van Loan, Matrix Computations (2013), sec. 7.4 and 7.5;
 * EISPACK's comhes and comqr (B. T. Smith et al., 1976).
 */
#include "eigen.h"

#include <float.h>
#include <math.h>

#define LANES 8            /* partial sums of a dot product, which a compiler makes a vector of without reordering */
#define SWEEPS_MAX 60      /* for one eigenvalue: it usually takes two or three */
#define SWEEPS_OF_SHIFT 10 /* without success; then an exceptional shift breaks a cycle */
#define INVERSE_ITERATIONS 3
#define LEAST 1e-100 /* a matrix of smaller elements is 0 */

double stf_dot(size_t n, const double *a, const double *b)
{
    double sums[LANES] = {0}, sum = 0;

    for (size_t i = 0; i < n; i += LANES)
        for (size_t lane = 0; lane < LANES; lane++)
            sums[lane] += a[i + lane] * b[i + lane];
    for (size_t lane = 0; lane < LANES; lane++)
        sum += sums[lane];
    return sum;
}

static void swap(double complex *a, double complex *b)
{
    const double complex kept = *a;

    *a = *b;
    *b = kept;
}

/* The row from `first` on that has the largest element in this column. */
static size_t find_pivot(size_t n, const double complex *m, size_t first, size_t column)
{
    size_t pivot = first;

    for (size_t i = first; i < n; i++)
        if (cabs(m[i * n + column]) > cabs(m[pivot * n + column]))
            pivot = i;
    return pivot;
}

/* A similar matrix with zeros below the first subdiagonal. */
static void reduce_to_hessenberg(size_t n, double complex *m)
{
    for (size_t k = 1; k + 1 < n; k++) {
        const size_t pivot = find_pivot(n, m, k, k - 1);
        for (size_t j = 0; j < n; j++)
            swap(&m[k * n + j], &m[pivot * n + j]);
        for (size_t i = 0; i < n; i++)
            swap(&m[i * n + k], &m[i * n + pivot]);
        if (cabs(m[k * n + k - 1]) == 0)
            continue;
        for (size_t i = k + 1; i < n; i++) {
            const double complex factor = m[i * n + k - 1] / m[k * n + k - 1];
            for (size_t j = 0; j < n; j++)
                m[i * n + j] -= factor * m[k * n + j];
            for (size_t j = 0; j < n; j++)
                m[j * n + k] += factor * m[j * n + i];
        }
    }
}

/* The eigenvalue of the 2 x 2 matrix (a b; c d) that is closer to d. */
static double complex wilkinson_shift(double complex a, double complex b, double complex c, double complex d)
{
    const double complex half = (a - d) / 2, root = csqrt(half * half + b * c);
    const double complex away = cabs(half + root) > cabs(half - root) ? half + root : half - root;

    return cabs(away) > 0 ? d - b * c / away : d;
}

/* H - s = Q R, then H = R Q + s, for rows and columns lo to hi. */
static void sweep(size_t n, size_t lo, size_t hi, double complex *h, double complex s)
{
    double complex c_before = 0, s_before = 0;

    for (size_t i = lo; i <= hi; i++)
        h[i * n + i] -= s;
    for (size_t k = lo; k <= hi; k++) {
        double complex *row = h + k * n, *next = row + n, c_now = 0, s_now = 0;
        const double r = k < hi ? hypot(cabs(row[k]), cabs(next[k])) : 0;
        if (k < hi) {
            c_now = r > 0 ? row[k] / r : 1, s_now = r > 0 ? next[k] / r : 0;
            for (size_t j = k; j <= hi; j++) {
                const double complex a = row[j], b = next[j];
                row[j] = conj(c_now) * a + conj(s_now) * b;
                next[j] = c_now * b - s_now * a;
            }
        }
        /* The rotation before this one, from the right: from the left its two columns are done with. */
        for (size_t i = lo; k > lo && i <= k; i++) {
            double complex *at = h + i * n + k - 1;
            const double complex a = at[0], b = at[1];
            at[0] = a * c_before + b * s_before;
            at[1] = b * conj(c_before) - a * conj(s_before);
        }
        c_before = c_now, s_before = s_now;
    }
    for (size_t i = lo; i <= hi; i++)
        h[i * n + i] += s;
}

/* Whether the element below the diagonal in column k is round-off beside its neighbours. */
static bool is_split(size_t n, const double complex *h, size_t k)
{
    return cabs(h[(k + 1) * n + k]) <= DBL_EPSILON * (cabs(h[k * n + k]) + cabs(h[(k + 1) * n + k + 1]));
}

void stf_eigenvalues(size_t n, double complex *m, double complex *values)
{
    reduce_to_hessenberg(n, m);
    for (size_t hi = n; hi-- > 0;) {
        for (int tries = 1; hi > 0 && !is_split(n, m, hi - 1) && tries <= SWEEPS_MAX; tries++) {
            const double complex *at = m + (hi - 1) * n + hi - 1;
            const double complex shift = tries % SWEEPS_OF_SHIFT == 0 ? at[n + 1] + cabs(at[n])
                                                                      : wilkinson_shift(at[0], at[1], at[n], at[n + 1]);
            size_t lo = hi - 1;
            while (lo > 0 && !is_split(n, m, lo - 1))
                lo--;
            sweep(n, lo, hi, m, shift);
        }
        values[hi] = m[hi * n + hi];
    }
}

static void scale_to_one(size_t n, double complex *x)
{
    double norm = 0;

    for (size_t i = 0; i < n; i++)
        norm = hypot(norm, cabs(x[i]));
    for (size_t i = 0; i < n; i++)
        x[i] /= norm;
}

/* U of m = P L U, in place; a pivot of 0 becomes `tiny`. */
static void eliminate(size_t n, double complex *m, double tiny)
{
    for (size_t k = 0; k < n; k++) {
        const size_t pivot = find_pivot(n, m, k, k);
        for (size_t j = 0; j < n; j++)
            swap(&m[k * n + j], &m[pivot * n + j]);
        if (cabs(m[k * n + k]) < tiny)
            m[k * n + k] = tiny;
        for (size_t i = k + 1; i < n; i++) {
            const double complex factor = m[i * n + k] / m[k * n + k];
            for (size_t j = k; j < n; j++)
                m[i * n + j] -= factor * m[k * n + j];
        }
    }
}

/* U^H U x = x, a few times: inverse iteration for the smallest singular value of m, which P and L, of norms about 1, change
   little. */
void stf_null_vector(size_t n, double complex *m, double complex *x)
{
    double largest = LEAST;

    for (size_t i = 0; i < n * n; i++)
        largest = fmax(largest, cabs(m[i]));
    eliminate(n, m, DBL_EPSILON * largest);
    for (size_t i = 0; i < n; i++)
        x[i] = 1;
    for (int times = 0; times < INVERSE_ITERATIONS; times++) {
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j < i; j++)
                x[i] -= conj(m[j * n + i]) * x[j];
            x[i] /= conj(m[i * n + i]);
        }
        scale_to_one(n, x);
        for (size_t i = n; i-- > 0;) {
            for (size_t j = i + 1; j < n; j++)
                x[i] -= m[i * n + j] * x[j];
            x[i] /= m[i * n + i];
        }
        scale_to_one(n, x);
    }
}
