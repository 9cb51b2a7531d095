/*
 * J u = (a(x + e u) - a(x)) / e. The difference has to be long enough for round-off and short enough for curvature; the
 * best length depends on forces that are not known here. It is found by trying: lengths go down by a factor of 8 while
 * products of two lengths after one another get closer. Source: D. A. Knoll, D. E. Keyes, J. Comput. Phys. 193, 357
 * (2004), sec. 2.3; P. E. Gill, W. Murray, M. A. Saunders, M. H. Wright, SIAM J. Sci. Stat. Comput. 4, 310 (1983).
 */
#include "jacobian.h"

#include <string.h>

#include "../real.h"
#include "eigen.h"

#ifdef STF_DOUBLE
#define ROOT_EPSILON 1.5e-8
#else
#define ROOT_EPSILON 3.5e-4
#endif

/* Lengths that are tried, from LONGEST x sqrt(epsilon) x (size of the scene) down by FACTOR each. */
#define LONGEST 64
#define FACTOR 8
#define TRIES 7
#define LEAST_NOISE (ROOT_EPSILON / FACTOR) /* two products may agree by luck */
#define GOOD_ENOUGH 0.05 /* two products as close as this have left the curvature behind: worse from here on is round-off */

static double largest_of(size_t n, const stf_real *values)
{
    double largest = 0;

    for (size_t i = 0; i < n; i++) {
        const double size = fabs((double)values[i]);
        largest = size > largest ? size : largest; /* with fmax gcc 12 fails to compile it for aarch64: an internal error */
    }
    return largest;
}

/* Half the widest extent of the scene, or where it has none its distance from the origin, or 1. */
static double size_of_scene(const stf_jacobian *j)
{
    const stf_particles *at = &j->at;
    double extent = 0;

    for (unsigned d = 0; d < at->dimensions; d++) {
        double least = (double)INFINITY, most = -(double)INFINITY;
        for (size_t i = 0; i < at->count; i++) {
            const double x = (double)at->position[stf_particles_offset(at, i) + d * at->stride];
            least = fmin(least, x), most = fmax(most, x);
        }
        extent = fmax(extent, (most - least) / 2);
    }
    if (extent > 0)
        return extent;
    extent = largest_of(j->length, at->position);
    return extent > 0 ? extent : 1;
}

static void accelerate(stf_jacobian *j, stf_real *out)
{
    j->spent++;
    j->finite = stf_world_accelerations(j->world, j->time, j->position, j->velocity, out) == STF_OK && j->finite;
}

void stf_jacobian_begin(stf_jacobian *j)
{
    const stf_particles *at = &j->at;
    const size_t bytes = j->length * sizeof(stf_real);

    memset(j->root, 0, j->length * sizeof(double));
    for (size_t i = 0; i < at->count; i++)
        for (unsigned d = 0; d < at->dimensions; d++)
            j->root[stf_particles_offset(at, i) + d * at->stride] = sqrt((double)at->inverse_mass[i]);
    j->unknowns = 0;
    for (size_t i = 0; i < j->length; i++)
        j->unknowns += j->root[i] > 0;
    j->time = stf_world_time(j->world);
    j->displacement = j->speed = 0;
    j->noise = LEAST_NOISE;
    j->frequency = 1;
    j->spent = 0;
    j->finite = true;
    memcpy(j->position, at->position, bytes);
    memcpy(j->velocity, at->velocity, bytes);
    accelerate(j, j->base);
    for (size_t i = 0; i < j->length; i++)
        j->finite = j->finite && isfinite(j->position[i]) && isfinite(j->velocity[i]) && isfinite(j->base[i]);
}

/* What u has to be multiplied by so that no element of dx = u / sqrt(m) is beyond `most`. */
static double scale_to(const stf_jacobian *j, const double *u, double most)
{
    double largest = 0;

    for (size_t i = 0; u && i < j->length; i++)
        largest = fmax(largest, fabs(j->root[i] * u[i]));
    return largest > 0 ? most / largest : (double)INFINITY;
}

static void displace(const stf_jacobian *j, stf_real *to, const stf_real *from, const double *u, double scale)
{
    for (size_t i = 0; i < j->length; i++)
        to[i] = u ? (stf_real)((double)from[i] + scale * j->root[i] * u[i]) : from[i];
}

void stf_jacobian_product(stf_jacobian *j, const double *p, const double *q, double *out)
{
    const double *moved = j->displacement > 0 ? p : NULL, *sped = j->speed > 0 ? q : NULL;
    const double scale = fmin(scale_to(j, moved, j->displacement), scale_to(j, sped, j->speed / j->frequency));

    memset(out, 0, j->length * sizeof *out);
    if (!isfinite(scale))
        return;
    displace(j, j->position, j->at.position, moved, scale);
    displace(j, j->velocity, j->at.velocity, sped, scale * j->frequency);
    accelerate(j, j->acceleration);
    for (size_t i = 0; i < j->length; i++) {
        if (j->root[i] > 0)
            out[i] = ((double)j->acceleration[i] - (double)j->base[i]) / (scale * j->root[i]);
        j->finite = j->finite && isfinite(out[i]);
    }
}

static double distance(size_t n, const double *a, const double *b)
{
    double square = 0;

    for (size_t i = 0; i < n; i++)
        square += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(square);
}

/* *scale starts as the longest. */
static double settle(stf_jacobian *j, double *scale, const double *p, const double *q, double *out, double *other)
{
    const double *direction = p ? p : q;
    double best = 0, least = 1, norm = 0;

    for (int tries = 0; tries < TRIES; tries++, *scale /= FACTOR) {
        double *now = tries % 2 ? other : out, *before = tries % 2 ? out : other;

        stf_jacobian_product(j, p, q, now);
        const double length = sqrt(stf_dot(j->length, now, now));
        if (!(length > 0))
            break;
        const double apart = tries > 0 ? distance(j->length, now, before) / length : 1;
        if (apart >= least && least < GOOD_ENOUGH)
            break;
        if (tries == 0 || apart < least) {
            norm = length / sqrt(stf_dot(j->length, direction, direction));
            best = *scale, least = apart;
        }
    }
    *scale = best;
    if (best > 0)
        j->noise = fmax(j->noise, least);
    return norm;
}

double stf_jacobian_settle_displacement(stf_jacobian *j, const double *direction, double *out, double *other)
{
    j->displacement = LONGEST * ROOT_EPSILON * size_of_scene(j);
    return settle(j, &j->displacement, direction, NULL, out, other);
}

double stf_jacobian_settle_speed(stf_jacobian *j, const double *direction, double *out, double *other)
{
    const double swinging = FACTOR * j->frequency * j->displacement;

    j->speed = fmax(LONGEST * ROOT_EPSILON * largest_of(j->length, j->at.velocity), swinging);
    if (!(j->speed > 0))
        j->speed = LONGEST * ROOT_EPSILON;
    return settle(j, &j->speed, NULL, direction, out, other) / j->frequency;
}

/* The newtons of one force alone, at the displaced state, into acceleration. A field force gets block after block. */
static void apply_alone(stf_jacobian *j, stf_force_id id)
{
    const stf_force *force = stf_world_force(j->world, id);
    const size_t block_length = j->at.stride * j->at.dimensions;
    size_t record_count;
    const void *records = stf_world_force_records(j->world, id, &record_count);
    stf_particles seen = j->at;

    memset(j->acceleration, 0, j->length * sizeof(stf_real));
    if (force->record_size > 0 && record_count == 0)
        return;
    if (force->drag) {
        const stf_real drag = force->drag(records, record_count);
        for (size_t i = 0; i < j->length; i++)
            j->acceleration[i] = -drag * j->velocity[i];
        return;
    }
    seen.position = j->position, seen.velocity = j->velocity, seen.force = j->acceleration;
    if (force->kind == STF_LINK) {
        const size_t rounds = force->rounds ? force->rounds(record_count, &seen) : 1;
        for (seen.round = 0; seen.round < rounds; seen.round++)
            force->apply(records, record_count, &seen, j->time);
        return;
    }
    for (size_t first = 0; first < j->at.count; first += seen.stride) {
        seen.first = first;
        seen.count = j->at.count - first < seen.stride ? j->at.count - first : seen.stride;
        seen.end = seen.count;
        seen.inverse_mass = j->at.inverse_mass + first;
        force->apply(records, record_count, &seen, j->time);
        seen.position += block_length, seen.velocity += block_length, seen.force += block_length;
    }
}

/* sum of dx F: the work of that force. */
static double work_of(stf_jacobian *j, stf_force_id id, const double *u)
{
    double work = 0;

    apply_alone(j, id);
    for (size_t i = 0; i < j->length; i++)
        work += j->root[i] * u[i] * (double)j->acceleration[i];
    return work;
}

void stf_jacobian_force_share(stf_jacobian *j, stf_force_id id, const double *u, double *of_position, double *of_velocity)
{
    const double displacement = scale_to(j, u, j->displacement), speed = scale_to(j, u, j->speed);

    displace(j, j->position, j->at.position, NULL, 0);
    displace(j, j->velocity, j->at.velocity, NULL, 0);
    const double base = work_of(j, id, u);
    displace(j, j->position, j->at.position, u, displacement);
    *of_position = j->displacement > 0 ? fabs(work_of(j, id, u) - base) / displacement : 0;
    displace(j, j->position, j->at.position, NULL, 0);
    displace(j, j->velocity, j->at.velocity, u, speed);
    *of_velocity = j->speed > 0 ? fabs(work_of(j, id, u) - base) / speed : 0;
}
