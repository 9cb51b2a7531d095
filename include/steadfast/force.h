/*
 * force: what pushes.
 *
 * A force is a const descriptor, the library's or your own, and an array of parameter records, which the world copies.
 * It is called once a block, never once a particle, and adds newtons:
 *
 *     typedef struct wind { stf_real push; } wind;                          // N
 *     static void blow(const void *records, size_t record_count, const stf_particles *particles, double time)
 *     {
 *         const wind *winds = records;
 *         (void)time;
 *         for (size_t r = 0; r < record_count; r++)
 *             for (size_t i = 0; i < particles->count; i++)
 *                 particles->force[i] += winds[r].push;                     // along x
 *     }
 *     const stf_force wind_force = {.name = "wind", .kind = STF_FIELD, .record_size = sizeof(wind), .apply = blow};
 *     ...
 *     stf_world_add_force(world, &wind_force, &(wind){.push = 2}, 1, NULL);
 *
 * A field force looks at each particle by itself and is handed one block at a time. A link force (STF_LINK) ties particles
 * together and is handed the whole world, where stf_particles_offset finds a particle:
 *
 *     typedef struct tether { uint32_t a, b; stf_real pull; } tether;       // N, whatever the distance, in one dimension
 *     static void haul(const void *records, size_t record_count, const stf_particles *all, double time)
 *     {
 *         const tether *t = records;
 *         (void)time;
 *         for (size_t r = 0; r < record_count; r++) {
 *             const size_t a = stf_particles_offset(all, t[r].a), b = stf_particles_offset(all, t[r].b);
 *             const stf_real pull = all->position[a] < all->position[b] ? t[r].pull : -t[r].pull;
 *             all->force[a] += pull;
 *             all->force[b] -= pull;
 *         }
 *     }
 *     static double hauled(const void *records, size_t record_count, const stf_particles *all, double time)
 *     {
 *         ...sum of t[r].pull * fabs(distance), in J: the potential
 *     }
 *     const stf_force tether_force = {.name = "tether", .kind = STF_LINK, .record_size = sizeof(tether), .apply = haul,
 *                                     .potential = hauled, .depends_on = STF_ON_POSITION};
 *
 * A link force that splits may use all of the engine's threads. It is called once for each range of whole blocks, with all
 * records each time, and adds to particles begin <= i < end only: force outside of that is another thread's, and not even to be
 * read. Each particle's sum has to be in an order that does not depend on the range. haul splits so:
 *
 *             if (t[r].a >= all->begin && t[r].a < all->end)
 *                 all->force[a] += pull;
 *             if (t[r].b >= all->begin && t[r].b < all->end)
 *                 all->force[b] -= pull;
 *
 * A link that neither splits nor has rounds runs on one thread.
 *
 * A world with no link force, or none that has records, steps block by block, all stages of a block in cache; one link force
 * makes it pass over all particles for each stage.
 *
 * Uniform gravity is no force but a part of the world (stf_world_def.gravity): it costs no loop.
 */
#ifndef STEADFAST_FORCE_H
#define STEADFAST_FORCE_H

#include "steadfast/particle.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum stf_force_kind { STF_FIELD, STF_LINK } stf_force_kind;

/* What a force depends on, so that instruments can ask. */
enum { STF_ON_POSITION = 1 << 0, STF_ON_VELOCITY = 1 << 1, STF_ON_TIME = 1 << 2 };

typedef struct stf_force {
    const char *name; /* required */
    stf_force_kind kind; /* 0: STF_FIELD */
    unsigned depends_on; /* STF_ON_POSITION | STF_ON_VELOCITY | STF_ON_TIME */
    bool splits;         /* a link force whose apply may be called for several ranges of particles at once; see above */

    /*
     * Instead of splits, never beside it, for a link force whose sums at two ends come out of one computation: how many rounds
     * it takes. apply is then called for each round from 0 on, for all parts of a round before the next; in part p of n it does
     * piece p, p + n, p + 2 n, ... of the round's work. No two pieces of a round may touch the same particle. NULL: none.
     */
    size_t (*rounds)(size_t record_count, const stf_particles *all);

    size_t record_size;  /* bytes of one parameter record; 0: the force has no parameters */

    /* Adds newtons to particles->force. records: [record_count], the world's copy. time in s. Required, but for a linear drag.
       A force that has parameters is not called while it has no records. */
    void (*apply)(const void *records, size_t record_count, const stf_particles *particles, double time);

    /*
     * Instead of apply, never beside it: the k, kg/s, of a force that is F = -k v on every particle. Like gravity it then
     * costs no loop: the world writes it into a = gravity - (k / m) v + F / m. Depends on the records alone, and may be called
     * often, on any thread.
     */
    stf_real (*drag)(const void *records, size_t record_count);

    /* The potential energy of these particles in J, at the same arguments. NULL: none, and energies go without it. */
    double (*potential)(const void *records, size_t record_count, const stf_particles *particles, double time);

    /* Whether one record suits a world of this many dimensions and particles. NULL: any does. */
    stf_result (*check)(const void *record, unsigned dimensions, size_t particle_count);

    /*
     * For records that name particles, else NULL: particle `removed` is gone and particle `last` (which may be the same) has
     * got its index. Changes the record, or returns false to have it dropped.
     */
    bool (*renumber)(void *record, size_t removed, size_t last);

    /* Called on the world's copy, which is aligned to 64 bytes, whenever the records change or become fewer, to put them into
       the order that apply wants; those that are in it stay as they are. NULL: as given. */
    void (*arrange)(void *records, size_t record_count);

    /* Bytes that arrange may fill, for apply to read, at stf_force_arranged(records, record_count, record_size): never more for
       fewer records; SIZE_MAX: too many records. NULL: 0. */
    size_t (*arranged_size)(size_t record_count);

    /*
     * What a record is made of, so that a world with records can be saved (save.h): a letter for each number in it, in order:
     * '1', '2', '4' or '8' is an integer (or a float or double, whatever the precision) of so many bytes, 'r' a stf_real;
     * "44rrr" is struct {uint32_t a, b; stf_real x, y, z;}. They lie where the compiler puts them; pads are not saved.
     * STF_NOT_SAVED: the records hold pointers, or what else means nothing to another process; they are set again by the user.
     * NULL: a world with such records is not saved.
     */
    const char *fields;
} stf_force;

#define STF_NOT_SAVED "*"

/* Where the bytes of arranged_size start: at the first multiple of 64 bytes behind the records. */
static inline void *stf_force_arranged(const void *records, size_t record_count, size_t record_size)
{
    return (char *)(uintptr_t)records + /* drops const; NOLINT(performance-no-int-to-ptr) */
           (record_count * record_size + 63) / 64 * 64;
}

/* F = -k v. The lecture's drag; Stokes drag on a sphere of radius r has k = 6 pi eta r. Of several the sum acts, at most the
   largest real. Cost: no loop. No potential. */
typedef struct stf_linear_drag {
    stf_real coefficient; /* k, kg/s, 0 or more */
} stf_linear_drag;
STF_API extern const stf_force stf_force_linear_drag;

/* F = -c |v| v. Rayleigh's drag equation: c = rho C_d A / 2. Cost: one pass with a square root. No potential. In float, speeds
   from 1e-18 to 1e18 m/s work: |v|^2 has to be a float. */
typedef struct stf_quadratic_drag {
    stf_real coefficient; /* c, kg/m, 0 or more */
} stf_quadratic_drag;
STF_API extern const stf_force stf_force_quadratic_drag;

/*
 * Every record pulls every particle towards a point: F = -m mu d / (|d|^2 + e^2)^(3/2), d = x - position; potential -m mu /
 * sqrt(|d|^2 + e^2). Newton's law of gravitation with Plummer's softening (Plummer 1911). At the very point the force is 0.
 * Cost: one pass a record, with a square root and two divisions. An immovable particle feels nothing. In float,
 * distances r from 1e-18 to 1e18 m work, as long as mu / r, mu / r^2 and the newtons are floats; further away it lets go.
 */
typedef struct stf_attractor {
    stf_vector position; /* m */
    stf_real strength;   /* mu = G M, m^3/s^2; negative repels */
    stf_real softening;  /* e, m, 0 or more */
} stf_attractor;
STF_API extern const stf_force stf_force_attractor;

/*
 * A damped spring from a particle to a fixed point: F = -(k (l - l0) + c (v . u)) u, d = x - anchor, l = |d|, u = d / l;
 * potential k (l - l0)^2 / 2. Hooke's law (De potentia restitutiva, 1678) with a damper along the spring (Witkin and Baraff,
 * Physically Based Modeling, 1997). Where l = 0 the spring has no direction and the force is 0. A field force: it ties no two
 * particles. The records are kept sorted. Cost: some ten operations a record; adding or setting n records sorts them. In float,
 * lengths from 1e-18 to 1e18 m work, as long as speed x length is a float; what is longer makes the state non-finite.
 */
typedef struct stf_anchored_spring {
    uint32_t particle;    /* index */
    stf_vector anchor;    /* m */
    stf_real stiffness;   /* k, N/m, 0 or more */
    stf_real damping;     /* c, N s/m, 0 or more */
    stf_real rest_length; /* l0, m, 0 or more */
} stf_anchored_spring;
STF_API extern const stf_force stf_force_anchored_springs;

/*
 * A damped spring between two particles: on a F = -(k (l - l0) + c ((v_a - v_b) . u)) u, d = x_a - x_b, l = |d|, u = d / l,
 * on b the opposite; potential k (l - l0)^2 / 2; sources as above. Where l = 0 the force is 0. A link force. Removing a
 * particle drops its springs. Springs that are not compressed swing no faster than omega = sqrt(2 K / m), K the sum of the
 * stiffnesses at a particle and m its mass, where that is largest (Gershgorin's bound; in a chain 2 sqrt(k / m)): omega dt
 * has to stay below the integrator's limit. The records are kept in an order of their own: where both ends of 16 or more
 * count up (the rows and columns of a cloth), whole vectors of them are computed at once, some four times as fast as one by
 * one. Adding or setting n springs sorts them: n log n, or one pass if they come in that order. Range as above.
 */
typedef struct stf_spring {
    uint32_t a, b;        /* indices; not the same */
    stf_real stiffness;   /* k, N/m, 0 or more */
    stf_real damping;     /* c, N s/m, 0 or more */
    stf_real rest_length; /* l0, m, 0 or more */
} stf_spring;
STF_API extern const stf_force stf_force_springs;

/*
 * Every particle pulls every other: F_i = -G m_i sum_j m_j d / (|d|^2 + e^2)^(3/2), d = x_i - x_j; potential
 * -G sum over pairs m_i m_j / sqrt(|d|^2 + e^2). Newton's law, Plummer's softening. Coincident particles do not pull
 * each other. An immovable particle has no finite mass and neither pulls nor feels: put an attractor there. Range as above.
 * A link force. Cost: n^2 / 2 square roots and divisions, each pair once for both ends; no memory beyond the state.
 * One record.
 */
typedef struct stf_all_pairs_gravity {
    stf_real gravitational_constant; /* G, m^3/(kg s^2) */
    stf_real softening;              /* e, m, 0 or more */
} stf_all_pairs_gravity;
STF_API extern const stf_force stf_force_all_pairs_gravity;

#ifdef __cplusplus
}
#endif

#endif
