/* The world's side of stability: products of its Jacobian with vectors, by differences of accelerations. */
#ifndef STEADFAST_SRC_JACOBIAN_H
#define STEADFAST_SRC_JACOBIAN_H

#include "steadfast/world.h"

#ifdef STF_DOUBLE
#define stf_jacobian stf_jacobian_f64
#define stf_jacobian_begin stf_jacobian_begin_f64
#define stf_jacobian_product stf_jacobian_product_f64
#define stf_jacobian_settle_displacement stf_jacobian_settle_displacement_f64
#define stf_jacobian_settle_speed stf_jacobian_settle_speed_f64
#define stf_jacobian_force_share stf_jacobian_force_share_f64
#endif

/*
 * Vectors are in mass-weighted coordinates, u = sqrt(m) dx: forces that have a potential make A = da/dx symmetric there.
 * They are laid out as the world's own arrays, and 0 where nothing moves: in spare lanes, and for the immovable.
 */
typedef struct stf_jacobian {
    const stf_world *world;
    stf_particles at;   /* the world as it stands */
    double time;        /* s */
    size_t length;      /* of every vector */
    size_t unknowns;    /* elements that move */
    double *root;       /* [length], kg^(-1/2): square roots of the inverse masses */
    stf_real *position, *velocity, *acceleration, *base; /* [length]; base: the accelerations of the world as it stands */
    double frequency;   /* rad/s: the unit of velocities is that of positions times this */
    double displacement, speed; /* m, m/s: the largest element of a difference; 0: nothing depends on that */
    double noise;       /* of products, relative: round-off and curvature together */
    unsigned spent;     /* accelerations */
    bool finite;        /* every product was */
} stf_jacobian;

/* world, at, length and the arrays are given; fills in the rest. Cost: one acceleration. */
void stf_jacobian_begin(stf_jacobian *j);

/* out = A p + B (frequency q); p or q may be NULL for 0. Cost: one acceleration. */
void stf_jacobian_product(stf_jacobian *j, const double *p, const double *q, double *out);

/*
 * Finds displacement or, after it, speed by products with `direction`, which they return the norm of, over that of the
 * direction: 0 where nothing depends on it. out and other are scratch. Cost: 1 to 7 accelerations.
 */
double stf_jacobian_settle_displacement(stf_jacobian *j, const double *direction, double *out, double *other);
double stf_jacobian_settle_speed(stf_jacobian *j, const double *direction, double *out, double *other);

/* |u^T A u| and |u^T B u| of one force alone, at |u| = 1. Cost: three calls of that force. */
void stf_jacobian_force_share(stf_jacobian *j, stf_force_id id, const double *u, double *of_position, double *of_velocity);

#endif
