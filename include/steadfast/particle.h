/*
 * particle: what moves.
 *
 * A particle is handed in and out as an stf_particle. Inside, a world keeps particles in blocks, one array a component:
 *
 *     positions   | x[stride] y[stride] z[stride] | x[stride] y[stride] z[stride] | ...
 *     velocities  | the same
 *     inverse masses, radii | [stride] | [stride] | ...
 *
 * where stride is a power of two: 256 floats or 128 doubles, fewer in a world that never had room for as many particles. A
 * world of two dimensions has no z. Forces see these arrays as an stf_particles.
 */
#ifndef STEADFAST_PARTICLE_H
#define STEADFAST_PARTICLE_H

#include "steadfast/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct stf_particle {
    stf_vector position;   /* m */
    stf_vector velocity;   /* m/s */
    stf_real inverse_mass; /* 1/kg; 0: nothing pushes it, it keeps its velocity, or comes to rest (below) */
    stf_real radius;       /* m; kept only by worlds with keep_radius, and used by no force of the library */
} stf_particle;

/*
 * Coming to rest. Arithmetic below the smallest normal number is slow on most machines, and a particle that drag or a damper
 * slows down would end there and stay. So at every tick whose number (stf_world_ticks) is a multiple of STF_SETTLE_TICKS, each
 * component of a position or velocity that is smaller than STF_AT_REST becomes a 0 of its sign, however it came about: also one
 * that was set so, and that of an immovable particle. With it go its rest and, with a velocity, what the integrator keeps of
 * that component, where they are as small. Nothing depends on modes of the processor: the bits are the same everywhere.
 *
 * STF_AT_REST is 2^7 times the root of the smallest normal number, as forces square distances and speeds, and a step and a
 * coefficient of together 2^-14 come on top. In float it is 0.4 nm a year.
 */
#define STF_SETTLE_TICKS 256
#ifdef STF_DOUBLE
#define STF_AT_REST 1.909335227187253e-152 /* 2^-504 */
#else
#define STF_AT_REST 1.3877787807814457e-17f /* 2^-56 */
#endif

/* The most particles that a block holds, and so the most that a field force is handed at once. */
#define STF_BLOCK_BYTES 1024
#define STF_BLOCK_MAX (STF_BLOCK_BYTES / sizeof(stf_real))

/*
 * What a force is handed: one block (a field force) or the whole world (a link force), at the state and time of one
 * stage of the integrator, which is not always the state that the world holds. Every array is aligned to 64 bytes.
 * In a block, component d of particle i is position[d * stride + i], and i < count. In the whole world particle i is
 * at position[stf_particles_offset(particles, i) + d * stride].
 */
typedef struct stf_particles {
    size_t count;        /* particles here */
    size_t first;        /* the world's index of the first of them: a multiple of stride */
    size_t stride;       /* reals from a component of a particle to its next component; a power of two */
    unsigned shift;      /* stride == 1 << shift */
    unsigned dimensions; /* 1, 2 or 3 */
    const stf_real *position;     /* m */
    const stf_real *velocity;     /* m/s */
    const stf_real *inverse_mass; /* 1/kg, [count], by plain index */
    stf_real *force;              /* N, laid out as position: add to it. NULL where a potential is asked for */
    size_t begin, end;            /* a link force that splits adds to particles begin <= i < end only; else 0 and count */
    size_t round;                 /* of a link force that has rounds, see stf_force; */
    unsigned part, parts;         /* and which part of it, of how many; else 0, 0 and 1 */
} stf_particles;

/* Where the first component of particle i stands in the position, velocity and force of a link force's particles. */
static inline size_t stf_particles_offset(const stf_particles *particles, size_t i)
{
    const size_t block = i >> particles->shift, lane = i & (particles->stride - 1);

    return ((block * particles->dimensions) << particles->shift) + lane;
}

#ifdef __cplusplus
}
#endif

#endif
