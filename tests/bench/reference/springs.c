/* Springs: F_a = -f d, F_b = f d, f = (k (l - l0) + c (w . d) / l) / l, d = x_a - x_b, w = v_a - v_b; 0 where l is 0. */
#include "names.h"

#include <math.h>
#include <string.h>

/* Springs at once: their forces stay in the first-level cache between the passes. */
#define CHUNK 256
#define EDGES 64

static inline stf_real factor(stf_real square, stf_real w_dot_d, stf_real k, stf_real c, stf_real rest)
{
    const stf_real length = SQRT(square), f = (k * (length - rest) + c * (w_dot_d / length)) / length;

    return length > 0 ? f : 0;
}

/* The forces on the second ends of a run. p and q: positions and velocities of the first and of the second ends. */
static void run_chunk(size_t n, stf_real *restrict fx, stf_real *restrict fy, stf_real *restrict fz,
                      const stf_real *const p[6], const stf_real *const q[6], const stf_real *restrict k,
                     const stf_real *restrict c, const stf_real *restrict rest)
{
    const stf_real *restrict px = p[0], *restrict py = p[1], *restrict pz = p[2];
    const stf_real *restrict pu = p[3], *restrict pv = p[4], *restrict pw = p[5];
    const stf_real *restrict qx = q[0], *restrict qy = q[1], *restrict qz = q[2];
    const stf_real *restrict qu = q[3], *restrict qv = q[4], *restrict qw = q[5];

    for (size_t i = 0; i < n; i++) {
        const stf_real dx = px[i] - qx[i], dy = py[i] - qy[i], dz = pz[i] - qz[i];
        const stf_real w_dot_d = (pu[i] - qu[i]) * dx + (pv[i] - qv[i]) * dy + (pw[i] - qw[i]) * dz;
        const stf_real f = factor(dx * dx + dy * dy + dz * dz, w_dot_d, k[i], c[i], rest[i]);

        fx[i] = f * dx;
        fy[i] = f * dy;
        fz[i] = f * dz;
    }
}

static void add(size_t n, stf_real *restrict to, const stf_real *restrict f)
{
    for (size_t i = 0; i < n; i++)
        to[i] += f[i];
}

static void subtract(size_t n, stf_real *restrict to, const stf_real *restrict f)
{
    for (size_t i = 0; i < n; i++)
        to[i] -= f[i];
}

static void clear(const reference_bodies *bodies)
{
    for (int d = 0; d < 3; d++)
        memset(bodies->a[d], 0, bodies->n * sizeof(stf_real));
}

void reference_run_forces(const reference_bodies *bodies)
{
    stf_real f[3][CHUNK];

    clear(bodies);
    for (size_t r = 0; r < bodies->run_count; r++) {
        const reference_run *run = &bodies->runs[r];
        for (size_t at = 0; at < run->count; at += CHUNK) {
            const size_t n = run->count - at < CHUNK ? run->count - at : CHUNK, s = run->first + at;
            const size_t a = run->a + at, b = run->b + at;
            const stf_real *const p[6] = {bodies->x[0] + a, bodies->x[1] + a, bodies->x[2] + a,
                                          bodies->v[0] + a, bodies->v[1] + a, bodies->v[2] + a};
            const stf_real *const q[6] = {bodies->x[0] + b, bodies->x[1] + b, bodies->x[2] + b,
                                          bodies->v[0] + b, bodies->v[1] + b, bodies->v[2] + b};

            run_chunk(n, f[0], f[1], f[2], p, q, bodies->stiffness + s, bodies->damping + s, bodies->rest_length + s);
            for (int d = 0; d < 3; d++) {
                subtract(n, bodies->a[d] + a, f[d]);
                add(n, bodies->a[d] + b, f[d]);
            }
        }
    }
}

/* What a chunk of edges is gathered into. */
typedef struct gathered {
    stf_real d[3][EDGES], w_dot_d[EDGES], square[EDGES], k[EDGES], c[EDGES], rest[EDGES], f[EDGES];
} gathered;

static void factors(gathered *g)
{
    for (size_t i = 0; i < EDGES; i++)
        g->f[i] = factor(g->square[i], g->w_dot_d[i], g->k[i], g->c[i], g->rest[i]);
}

static inline void gather(gathered *g, size_t i, const reference_edge *e, const stf_real d[3], const stf_real w[3])
{
    for (int axis = 0; axis < 3; axis++)
        g->d[axis][i] = d[axis];
    g->square[i] = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    g->w_dot_d[i] = w[0] * d[0] + w[1] * d[1] + w[2] * d[2];
    g->k[i] = e->stiffness, g->c[i] = e->damping, g->rest[i] = e->rest_length;
}

/*
 * Position and velocity of a particle side by side, and its force: a random end is then in a line or two of the cache, and
 * not in nine. They are copied in every step, as the rest of it wants an array a component. Measured against arrays a
 * component, rows of 16 reals with all three, and coefficients in arrays of their own: the best or within a tenth.
 */
#define STATE 6
#define FORCE 3

static void pack(const reference_bodies *bodies, stf_real *restrict state)
{
    for (size_t i = 0; i < bodies->n; i++)
        for (size_t d = 0; d < 3; d++) {
            state[STATE * i + d] = bodies->x[d][i];
            state[STATE * i + 3 + d] = bodies->v[d][i];
        }
}

static void unpack(const reference_bodies *bodies, const stf_real *restrict force)
{
    for (size_t i = 0; i < bodies->n; i++)
        for (size_t d = 0; d < 3; d++)
            bodies->a[d][i] = force[FORCE * i + d];
}

void reference_edge_forces(const reference_bodies *bodies)
{
    stf_real *state = bodies->packed, *force = state + STATE * bodies->n;
    gathered g = {.f = {0}};

    pack(bodies, state);
    memset(force, 0, FORCE * bodies->n * sizeof *force);
    for (size_t s = 0; s < bodies->edge_count; s += EDGES) {
        const reference_edge *e = bodies->edges + s;
        const size_t n = bodies->edge_count - s < EDGES ? bodies->edge_count - s : EDGES;

        for (size_t i = 0; i < n; i++) {
            const stf_real *a = state + STATE * (size_t)e[i].a, *b = state + STATE * (size_t)e[i].b;
            const stf_real d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
            const stf_real w[3] = {a[3] - b[3], a[4] - b[4], a[5] - b[5]};
            gather(&g, i, &e[i], d, w);
        }
        factors(&g);
        for (size_t i = 0; i < n; i++) {
            stf_real *a = force + FORCE * (size_t)e[i].a, *b = force + FORCE * (size_t)e[i].b;
            const stf_real px = g.f[i] * g.d[0][i], py = g.f[i] * g.d[1][i], pz = g.f[i] * g.d[2][i];
            a[0] -= px, a[1] -= py, a[2] -= pz;
            b[0] += px, b[1] += py, b[2] += pz;
        }
    }
    unpack(bodies, force);
}
