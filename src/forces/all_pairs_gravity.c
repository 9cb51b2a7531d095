/* Gravitation of every particle by every other; sources as in attractor.c. */
#include <string.h>

#include "distance.h"
#include "steadfast/force.h"

static stf_result all_pairs_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_all_pairs_gravity *gravity = record;
    (void)dimensions, (void)particle_count;

    return isfinite(gravity->gravitational_constant) && stf_is_coefficient(gravity->softening) ? STF_OK
                                                                                               : STF_ERROR_PARAMETERS;
}

/*
 * Pairs are taken tile by tile, a tile being the particles of one block, and of two different tiles each pair only once: square
 * root and division are what it costs. In round 0 each tile is taken by itself; in the others each has one other, as in a
 * tournament, so that the order of a tile's sum does not depend on how many threads take the pairs of a round.
 */
typedef struct tile {
    size_t stride;                    /* lanes; those that hold no particle have no strength */
    const stf_real *x;                /* rows */
    const stf_real *inverse_mass;
    stf_real strength[STF_BLOCK_MAX]; /* G m; 0: the immovable */
    stf_real a[STF_DIMENSIONS_MAX * STF_BLOCK_MAX]; /* rows of the accelerations by one other tile */
} tile;

/* Sums over lanes are made in so many places at once, on every machine. */
#define PLACES STF_ROW_MULTIPLE

/* By halves, so that vectors are added as long as there are any. */
STF_INLINE stf_real sum_of(stf_real *sums)
{
    for (size_t half = PLACES / 2; half > 0; half /= 2)
        for (size_t k = 0; k < half; k++)
            sums[k] += sums[k + half];
    return sums[0];
}

/*
 * One particle at p and the lanes of a tile: a = -G m d / (|d|^2 + e^2)^(3/2) of each by the other, with two factors, as the
 * cube of a distance leaves the reals long before the force does. `dimensions` and whose end is wanted are constants at each
 * call, so the compiler makes a loop for each.
 */
STF_INLINE void pull_lanes(unsigned dimensions, bool both, size_t stride, const stf_real *restrict x,
                           const stf_real *restrict strength, stf_real *restrict a, const stf_real *restrict p,
                           stf_real p_strength, stf_real softening_square, stf_real *restrict p_a)
{
    const stf_real px = p[0], py = dimensions > 1 ? p[stride] : 0, pz = dimensions > 2 ? p[2 * stride] : 0;
    stf_real sum_x[PLACES] = {0}, sum_y[PLACES] = {0}, sum_z[PLACES] = {0};

    for (size_t first = 0; first < stride; first += PLACES)
        for (size_t k = 0; k < PLACES; k++) {
            const size_t i = first + k;
            const stf_real dx = px - x[i];
            const stf_real dy = dimensions > 1 ? py - x[stride + i] : 0;
            const stf_real dz = dimensions > 2 ? pz - x[2 * stride + i] : 0;
            const stf_real apart = dx * dx + dy * dy + dz * dz, square = softening_square + apart;
            const stf_real reciprocal = 1 / stf_sqrt(square), inverse = apart > 0 ? reciprocal : 0;
            const stf_real ux = dx * inverse, uy = dy * inverse, uz = dz * inverse;
            /* All lanes of a tile have a strength; NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
            const stf_real by_p = p_strength * inverse * inverse, by_lane = strength[i] * inverse * inverse;

            a[i] += by_p * ux;
            if (dimensions > 1)
                a[STF_BLOCK_MAX + i] += by_p * uy;
            if (dimensions > 2)
                a[2 * STF_BLOCK_MAX + i] += by_p * uz;
            if (both) {
                sum_x[k] += by_lane * ux;
                sum_y[k] += by_lane * uy;
                sum_z[k] += by_lane * uz;
            }
        }
    if (both) {
        p_a[0] -= sum_of(sum_x);
        p_a[STF_BLOCK_MAX] -= sum_of(sum_y);
        p_a[2 * STF_BLOCK_MAX] -= sum_of(sum_z);
    }
}

/* Every particle of `from` and the lanes of `to`; both ends of each pair, or that of the lanes. */
STF_INLINE void pull_tiles(unsigned dimensions, bool both, tile *from, tile *to, stf_real softening_square)
{
    for (size_t j = 0; j < from->stride; j++)
        if (from->inverse_mass[j] > 0)
            pull_lanes(dimensions, both, to->stride, to->x, to->strength, to->a, from->x + j, from->strength[j],
                       softening_square, from->a + j);
}

/* A tile by itself has one end only, each of whose particles pulls all others. */
static void pull(unsigned dimensions, tile *from, tile *to, bool both, stf_real softening_square)
{
    if (dimensions == 1)
        pull_tiles(1, both, from, to, softening_square);
    else if (dimensions == 2)
        pull_tiles(2, both, from, to, softening_square);
    else if (!both)
        pull_tiles(3, false, from, to, softening_square);
    else
        pull_tiles(3, true, from, to, softening_square);
}

static void strengths(size_t n, stf_real *restrict strength, const stf_real *restrict inverse_mass, stf_real constant)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real with_mass = constant / inverse_mass[i];
        strength[i] = inverse_mass[i] > 0 ? with_mass : 0;
    }
}

static void open_tile(tile *t, const stf_particles *all, size_t first, stf_real constant)
{
    t->stride = all->stride;
    t->x = all->position + stf_particles_offset(all, first);
    t->inverse_mass = all->inverse_mass + first;
    memset(t->a, 0, sizeof t->a);
    strengths(t->stride, t->strength, all->inverse_mass + first, constant);
}

/* F = m a, where the particle has a mass. */
static void add_row(size_t n, stf_real *restrict force, const stf_real *restrict a, const stf_real *restrict inverse_mass)
{
    for (size_t i = 0; i < n; i++) {
        const stf_real newtons = a[i] / inverse_mass[i];
        force[i] += inverse_mass[i] > 0 ? newtons : 0;
    }
}

static void add_forces(const stf_particles *all, size_t first, const tile *t)
{
    for (unsigned d = 0; d < all->dimensions; d++)
        add_row(t->stride, all->force + stf_particles_offset(all, first) + d * t->stride, t->a + d * STF_BLOCK_MAX,
                all->inverse_mass + first);
}

static void pull_pair(const stf_particles *all, size_t first, size_t second, stf_all_pairs_gravity gravity)
{
    const bool both = first != second;
    tile from, to;

    open_tile(&from, all, first, gravity.gravitational_constant);
    open_tile(&to, all, second, gravity.gravitational_constant);
    pull(all->dimensions, &from, &to, both, gravity.softening * gravity.softening);
    if (both)
        add_forces(all, first, &from);
    add_forces(all, second, &to);
}

static size_t tile_count(const stf_particles *all) { return (all->count + all->stride - 1) >> all->shift; }

/* An odd number of tiles plays with one that is not there. */
static size_t players(const stf_particles *all) { return (tile_count(all) + 1) / 2 * 2; }

/* A record's rounds are each tile by itself and then the circle method (E. Lucas, Recreations mathematiques 2, 1883). */
static size_t all_pairs_rounds(size_t record_count, const stf_particles *all) { return record_count * players(all); }

/* The pair of this number in the circle's rounds: one player stays, the others go round. */
static void find_pair(size_t circle, size_t round, size_t number, size_t *first, size_t *second)
{
    *first = number == 0 ? circle : (round + number) % circle;
    *second = (round + circle - number) % circle;
}

static void all_pairs_apply(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_all_pairs_gravity *gravity = records;
    const size_t tiles = tile_count(all), most = players(all), round = all->round % most;
    (void)record_count, (void)time;

    for (size_t number = all->part; number < (round == 0 ? tiles : most / 2); number += all->parts) {
        size_t first = number, second = number;

        if (round > 0)
            find_pair(most - 1, round - 1, number, &first, &second);
        if (first < tiles && second < tiles)
            pull_pair(all, first << all->shift, second << all->shift, gravity[all->round / most]);
    }
}

static double pair_potential(const stf_particles *all, size_t i, size_t j, stf_all_pairs_gravity gravity)
{
    const stf_real *xi = all->position + stf_particles_offset(all, i), *xj = all->position + stf_particles_offset(all, j);
    const double softening = (double)gravity.softening;
    const double square = softening * softening + stf_square_between(xi, all->stride, xj, all->stride, all->dimensions);

    if (!(square > 0))
        return 0;
    return -(double)gravity.gravitational_constant /
           ((double)all->inverse_mass[i] * (double)all->inverse_mass[j] * sqrt(square));
}

static double all_pairs_potential(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_all_pairs_gravity *gravity = records;
    double sum = 0;
    (void)time;

    for (size_t r = 0; r < record_count; r++)
        for (size_t i = 0; i < all->count; i++)
            for (size_t j = 0; j < i; j++)
                if (all->inverse_mass[i] > 0 && all->inverse_mass[j] > 0)
                    sum += pair_potential(all, i, j, gravity[r]);
    return sum;
}

const stf_force stf_force_all_pairs_gravity = {
    .name = "all_pairs_gravity",
    .kind = STF_LINK,
    .depends_on = STF_ON_POSITION,
    .record_size = sizeof(stf_all_pairs_gravity),
    .fields = "rr",
    .rounds = all_pairs_rounds,
    .apply = all_pairs_apply,
    .potential = all_pairs_potential,
    .check = all_pairs_check,
};
