/* The workloads: the same numbers for every peer. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "peer.h"

#define ECCENTRICITY 0.5
#define SPREAD 0.1 /* semi-major axes and frequencies lie within 1 - SPREAD and 1 + SPREAD */
#define SPACING 0.05 /* m: this and the next four are those of demo/scenes/cloth.c */
#define MASS 0.002
#define STIFFNESS 500
#define DAMPING 0.05
#define AIR_DRAG 0.006
#define HELD_EVERY 8 /* columns */

static const double pi = 3.14159265358979323846;

void *need(size_t size)
{
    void *memory = malloc(size);

    if (!memory) {
        fprintf(stderr, "peers: %zu bytes of memory are not to be had: run fewer rows\n", size);
        exit(1);
    }
    return memory;
}

/* Numbers in [0, 1) that fill it evenly, however many are taken (Weyl's sequence); a sequence a seed. */
static double spread(size_t i, unsigned seed)
{
    static const double steps[] = {0.6180339887498949, 0.4142135623730951, 0.7320508075688772};

    return fmod(((double)i + 1) * steps[seed], 1);
}

static workload *create(workload_kind kind, unsigned dimensions, size_t count)
{
    workload *w = need(sizeof *w);

    *w = (workload){.kind = kind, .dimensions = dimensions, .count = count};
    w->position = need(3 * count * sizeof(double));
    w->velocity = need(3 * count * sizeof(double));
    w->inverse_mass = need(count * sizeof(double));
    for (size_t i = 0; i < 3 * count; i++)
        w->position[i] = w->velocity[i] = 0;
    for (size_t i = 0; i < count; i++)
        w->inverse_mass[i] = 1;
    return w;
}

void workload_free(workload *w)
{
    free(w->position);
    free(w->velocity);
    free(w->inverse_mass);
    free(w->stiffness);
    free(w->ties);
    free(w);
}

workload *workload_flight(size_t count, unsigned dimensions)
{
    workload *w = create(FLIGHT, dimensions, count);

    w->gravity = 9.81;
    w->drag = 0.1;
    w->step = 1.0 / 60;
    for (size_t i = 0; i < count; i++)
        for (unsigned d = 0; d < dimensions; d++) {
            w->position[3 * i + d] = 10 * spread(i, d);
            w->velocity[3 * i + d] = 20 * spread(i, (d + 1) % 3) - 10;
        }
    return w;
}

/* In three dimensions it lies flat and swings down, as in the demo; in two it hangs, and gravity stretches it. */
workload *workload_cloth(size_t side, unsigned dimensions)
{
    workload *w = create(CLOTH, dimensions, side * side);
    const double diagonal = SPACING * sqrt(2);

    w->gravity = 9.81;
    w->drag = AIR_DRAG / MASS;
    w->step = 1.0 / 1200;
    w->tie_stiffness = STIFFNESS;
    w->tie_damping = DAMPING;
    w->ties = need(4 * side * side * sizeof *w->ties);
    for (uint32_t row = 0; row < side; row++)
        for (uint32_t column = 0; column < side; column++) {
            const uint32_t i = row * (uint32_t)side + column, below = i + (uint32_t)side;
            const bool right = column + 1 < side, down = row + 1 < side;

            w->position[3 * i] = SPACING * column;
            w->position[3 * i + (dimensions == 3 ? 2 : 1)] = dimensions == 3 ? SPACING * row : -SPACING * row;
            w->inverse_mass[i] = row == 0 && (column % HELD_EVERY == 0 || !right) ? 0 : 1 / MASS;
            if (right)
                w->ties[w->tie_count++] = (tie){i, i + 1, SPACING};
            if (down)
                w->ties[w->tie_count++] = (tie){i, below, SPACING};
            if (right && down) {
                w->ties[w->tie_count++] = (tie){i, below + 1, diagonal};
                w->ties[w->tie_count++] = (tie){i + 1, below, diagonal};
            }
        }
    return w;
}

/* Sizes and phases differ, so that no method profits from ending on the very state it started from. */
workload *workload_race(workload_kind kind, size_t count)
{
    workload *w = create(kind, kind == KEPLER ? 2 : 1, count);

    w->duration = 2 * pi * (kind == KEPLER ? 1 : 10);
    w->stiffness = need(count * sizeof(double));
    for (size_t i = 0; i < count; i++) {
        const double omega = 1 - SPREAD + 2 * SPREAD * spread(i, 0);
        w->stiffness[i] = omega * omega;
    }
    workload_exact(w, 0, w->position, w->velocity);
    return w;
}

/* Kepler's equation E - e sin E = M by Newton's method; x = a (cos E - e), y = a sqrt(1 - e^2) sin E, turned by an angle.
   Source: C. D. Murray, S. F. Dermott, Solar System Dynamics (1999), ch. 2. */
static void orbit(size_t i, double time, double position[3], double velocity[3])
{
    const double a = 1 - SPREAD + 2 * SPREAD * spread(i, 0), rate = 1 / (a * sqrt(a)), e = ECCENTRICITY;
    const double mean = 2 * pi * spread(i, 1) + rate * time, angle = 2 * pi * spread(i, 2);
    double anomaly = mean;

    for (int n = 0; n < 50; n++)
        anomaly -= (anomaly - e * sin(anomaly) - mean) / (1 - e * cos(anomaly));

    const double minor = sqrt(1 - e * e), dot = rate / (1 - e * cos(anomaly)), c = cos(angle), s = sin(angle);
    const double x = a * (cos(anomaly) - e), y = a * minor * sin(anomaly);
    const double vx = -a * sin(anomaly) * dot, vy = a * minor * cos(anomaly) * dot;
    position[0] = c * x - s * y;
    position[1] = s * x + c * y;
    velocity[0] = c * vx - s * vy;
    velocity[1] = s * vx + c * vy;
}

/* v' = g - k v: v = u + (v0 - u) exp(-k t) and x = x0 + u t + (v0 - u) (1 - exp(-k t)) / k, u = g / k. */
static void flight(const workload *w, double time, double *position, double *velocity)
{
    const double decay = exp(-w->drag * time);

    for (size_t i = 0; i < w->count; i++)
        for (unsigned d = 0; d < w->dimensions; d++) {
            const double u = d == 1 ? -w->gravity / w->drag : 0, relative = w->velocity[3 * i + d] - u;
            velocity[3 * i + d] = u + relative * decay;
            position[3 * i + d] = w->position[3 * i + d] + u * time + relative * (1 - decay) / w->drag;
        }
}

void workload_exact(const workload *w, double time, double *position, double *velocity)
{
    if (w->kind == FLIGHT)
        flight(w, time, position, velocity);
    for (size_t i = 0; i < w->count; i++)
        if (w->kind == KEPLER) {
            orbit(i, time, &position[3 * i], &velocity[3 * i]);
        } else if (w->kind == OSCILLATORS) {
            const double omega = sqrt(w->stiffness[i]), phase = 2 * pi * spread(i, 1) + omega * time;
            position[3 * i] = cos(phase);
            velocity[3 * i] = -omega * sin(phase);
        }
}

void workload_pull(const workload *w, size_t i, const double position[3], double acceleration[3])
{
    if (w->kind == KEPLER) {
        const double r_squared = position[0] * position[0] + position[1] * position[1];
        const double pull = -1 / (r_squared * sqrt(r_squared));
        acceleration[0] = pull * position[0];
        acceleration[1] = pull * position[1];
    } else {
        acceleration[0] = -w->stiffness[i] * position[0];
        acceleration[1] = 0;
    }
    acceleration[2] = 0;
}
