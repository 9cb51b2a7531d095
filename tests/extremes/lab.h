/* What the cells of a precision share: worlds of particles along a line, and the spacing of reals. */
#ifndef STEADFAST_TESTS_LAB_H
#define STEADFAST_TESTS_LAB_H

#include <math.h>

#include "matrix.h"
#include "steadfast/steadfast.h"
#include "support/real.h"

static inline stf_world *lab_world(const char *integrator, stf_world_def def)
{
    stf_world *world;

    def.integrator = stf_integrator_find(integrator);
    MUST(stf_world_create(&def, &world));
    return world;
}

static inline void lab_add(stf_world *world, double x, double v, double inverse_mass)
{
    const stf_particle particle = {.position = {(stf_real)x, 0, 0}, .velocity = {(stf_real)v, 0, 0},
                                   .inverse_mass = (stf_real)inverse_mass};

    MUST(stf_world_add(world, &particle, NULL));
}

static inline void lab_force(stf_world *world, const stf_force *force, const void *record)
{
    MUST(stf_world_add_force(world, force, record, record ? 1 : 0, NULL));
}

static inline stf_particle lab_particle(const stf_world *world, size_t index)
{
    stf_particle particle;

    MUST(stf_world_get(world, index, &particle));
    return particle;
}

static inline double lab_x(const stf_world *world, size_t index) { return (double)lab_particle(world, index).position.x; }
static inline double lab_v(const stf_world *world, size_t index) { return (double)lab_particle(world, index).velocity.x; }

/* From a real of this size to the next. */
static inline double lab_ulp(double x)
{
    int exponent;

    frexp(x, &exponent);
    return fmax(ldexp(REAL_EPSILON, exponent - 1), (double)REAL_LEAST * REAL_EPSILON);
}

/* What is smaller than this, in m or m/s, may come to rest. */
#ifdef STF_DOUBLE
#define LAB_REST 1e-150
#else
#define LAB_REST 1e-16
#endif

#endif
