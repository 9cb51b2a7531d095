/* Steps of particles that nothing ties together: each integrator as one loop, all stages in registers. */
#include "names.h"

#include <math.h>

#define HALF ((stf_real)0.5)

/* a = g + F w; 0 for the immovable, so long as F is finite. */
static inline stf_real pushed(stf_real g, stf_real force, stf_real w) { return (w > 0 ? g : 0) + force * w; }

/* F = -k v */
static inline stf_real dragged(stf_real g, stf_real k, stf_real v, stf_real w) { return pushed(g, -(k * v), w); }

void reference_semi_implicit_euler(REFERENCE_STEP)
{
    const stf_real dt = law->dt, k = law->drag, gx = law->gravity[0], gy = law->gravity[1], gz = law->gravity[2];
    (void)ax, (void)ay, (void)az;

    for (size_t i = 0; i < n; i++) {
        vx[i] += dragged(gx, k, vx[i], w[i]) * dt;
        vy[i] += dragged(gy, k, vy[i], w[i]) * dt;
        vz[i] += dragged(gz, k, vz[i], w[i]) * dt;
        x[i] += vx[i] * dt;
        y[i] += vy[i] * dt;
        z[i] += vz[i] * dt;
    }
}

static inline void verlet_component(stf_real *x, stf_real *v, stf_real *a, stf_real w, stf_real g, stf_real k, stf_real dt)
{
    const stf_real kick = *a * (HALF * dt), half = *v + kick;

    *x += half * dt;
    *a = dragged(g, k, half + kick, w);
    *v = half + *a * (HALF * dt);
}

void reference_velocity_verlet(REFERENCE_STEP)
{
    const stf_real dt = law->dt, k = law->drag, gx = law->gravity[0], gy = law->gravity[1], gz = law->gravity[2];

    for (size_t i = 0; i < n; i++) {
        verlet_component(&x[i], &vx[i], &ax[i], w[i], gx, k, dt);
        verlet_component(&y[i], &vy[i], &ay[i], w[i], gy, k, dt);
        verlet_component(&z[i], &vz[i], &az[i], w[i], gz, k, dt);
    }
}

/* The acceleration depends on the velocity alone, so no stage needs a position. */
static inline void rk4_component(stf_real *x, stf_real *v, stf_real w, stf_real g, stf_real k, stf_real dt)
{
    const stf_real a1 = dragged(g, k, *v, w), v2 = *v + a1 * (HALF * dt);
    const stf_real a2 = dragged(g, k, v2, w), v3 = *v + a2 * (HALF * dt);
    const stf_real a3 = dragged(g, k, v3, w), v4 = *v + a3 * dt;
    const stf_real a4 = dragged(g, k, v4, w);

    *x += dt * (*v + 2 * v2 + 2 * v3 + v4) / 6;
    *v += dt * (a1 + 2 * a2 + 2 * a3 + a4) / 6;
}

void reference_rk4(REFERENCE_STEP)
{
    const stf_real dt = law->dt, k = law->drag, gx = law->gravity[0], gy = law->gravity[1], gz = law->gravity[2];
    (void)ax, (void)ay, (void)az;

    for (size_t i = 0; i < n; i++) {
        rk4_component(&x[i], &vx[i], w[i], gx, k, dt);
        rk4_component(&y[i], &vy[i], w[i], gy, k, dt);
        rk4_component(&z[i], &vz[i], w[i], gz, k, dt);
    }
}

typedef struct triple {
    stf_real x, y, z;
} triple;

static inline triple along(triple p, triple q, stf_real dt)
{
    return (triple){p.x + q.x * dt, p.y + q.y * dt, p.z + q.z * dt};
}

/* s1 + 2 s2 + 2 s3 + s4 */
static inline stf_real weighted(stf_real s1, stf_real s2, stf_real s3, stf_real s4) { return s1 + 2 * s2 + 2 * s3 + s4; }

/* g + (F_drag + F_attractor) w, rounded where the library rounds. */
static inline triple field(triple p, triple v, stf_real w, stf_real mu, stf_real softening, stf_real c, triple centre, triple g)
{
    const stf_real c_speed = c * SQRT(v.x * v.x + v.y * v.y + v.z * v.z);
    const triple d = {p.x - centre.x, p.y - centre.y, p.z - centre.z};
    const stf_real square = softening * softening + d.x * d.x + d.y * d.y + d.z * d.z;
    const stf_real reciprocal = 1 / SQRT(square), far = mu * reciprocal * reciprocal / w;
    const stf_real pull = square > 0 && w > 0 ? far : 0, inverse = square > 0 ? reciprocal : 0;

    return (triple){pushed(g.x, -(c_speed * v.x) - pull * (d.x * inverse), w),
                    pushed(g.y, -(c_speed * v.y) - pull * (d.y * inverse), w),
                    pushed(g.z, -(c_speed * v.z) - pull * (d.z * inverse), w)};
}

void reference_rk4_field(REFERENCE_STEP)
{
    const stf_real dt = law->dt, half = HALF * dt, c = law->drag, mu = law->strength, e = law->softening;
    const triple g = {law->gravity[0], law->gravity[1], law->gravity[2]};
    const triple centre = {law->centre[0], law->centre[1], law->centre[2]};
    (void)ax, (void)ay, (void)az;

    for (size_t i = 0; i < n; i++) {
        const triple p = {x[i], y[i], z[i]}, v1 = {vx[i], vy[i], vz[i]};
        const triple a1 = field(p, v1, w[i], mu, e, c, centre, g), v2 = along(v1, a1, half);
        const triple a2 = field(along(p, v1, half), v2, w[i], mu, e, c, centre, g), v3 = along(v1, a2, half);
        const triple a3 = field(along(p, v2, half), v3, w[i], mu, e, c, centre, g), v4 = along(v1, a3, dt);
        const triple a4 = field(along(p, v3, dt), v4, w[i], mu, e, c, centre, g);

        x[i] = p.x + dt * weighted(v1.x, v2.x, v3.x, v4.x) / 6;
        y[i] = p.y + dt * weighted(v1.y, v2.y, v3.y, v4.y) / 6;
        z[i] = p.z + dt * weighted(v1.z, v2.z, v3.z, v4.z) / 6;
        vx[i] = v1.x + dt * weighted(a1.x, a2.x, a3.x, a4.x) / 6;
        vy[i] = v1.y + dt * weighted(a1.y, a2.y, a3.y, a4.y) / 6;
        vz[i] = v1.z + dt * weighted(a1.z, a2.z, a3.z, a4.z) / 6;
    }
}

void reference_push(REFERENCE_STEP)
{
    const stf_real dt = law->dt, gx = law->gravity[0], gy = law->gravity[1], gz = law->gravity[2];

    for (size_t i = 0; i < n; i++) {
        vx[i] += pushed(gx, ax[i], w[i]) * dt;
        vy[i] += pushed(gy, ay[i], w[i]) * dt;
        vz[i] += pushed(gz, az[i], w[i]) * dt;
        x[i] += vx[i] * dt;
        y[i] += vy[i] * dt;
        z[i] += vz[i] * dt;
    }
}

void reference_update(REFERENCE_STEP)
{
    (void)ax, (void)ay, (void)az, (void)law;

    for (size_t i = 0; i < n; i++) {
        x[i] += w[i], y[i] += w[i], z[i] += w[i];
        vx[i] += w[i], vy[i] += w[i], vz[i] += w[i];
    }
}

/* With the sign turned: what is a plain copy, compilers make a call of memcpy, which is another measurement. */
void reference_copy(REFERENCE_STEP)
{
    (void)vx, (void)vy, (void)vz, (void)w, (void)law;

    for (size_t i = 0; i < n; i++)
        ax[i] = -x[i], ay[i] = -y[i], az[i] = -z[i];
}

/* REFERENCE_CHAIN multiplications and additions, each waiting for the one before. */
static inline stf_real chain(stf_real x, stf_real c, stf_real d)
{
    for (int i = 0; i < REFERENCE_CHAIN; i++)
        x = x * c + d;
    return x;
}

void reference_add_multiply(REFERENCE_STEP)
{
    const stf_real c = law->drag, d = law->dt;
    (void)w;

    for (size_t i = 0; i < n; i++) {
        x[i] = chain(x[i], c, d), y[i] = chain(y[i], c, d), z[i] = chain(z[i], c, d);
        vx[i] = chain(vx[i], c, d), vy[i] = chain(vy[i], c, d), vz[i] = chain(vz[i], c, d);
        ax[i] = chain(ax[i], c, d), ay[i] = chain(ay[i], c, d), az[i] = chain(az[i], c, d);
    }
}
