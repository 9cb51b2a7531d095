/* Names of the references' loops, each compiled for several instruction sets and both precisions. */
#ifndef STEADFAST_TESTS_REFERENCE_NAMES_H
#define STEADFAST_TESTS_REFERENCE_NAMES_H

#include "../reference.h"

#ifndef REFERENCE_ISA
#define REFERENCE_ISA baseline
#endif

#define JOIN(name, isa, precision) name##_##isa##_##precision
#define JOIN_EXPANDED(name, isa, precision) JOIN(name, isa, precision)
#ifdef STF_DOUBLE
#define NAME(name) JOIN_EXPANDED(name, REFERENCE_ISA, f64)
#define SQRT sqrt
#else
#define NAME(name) JOIN_EXPANDED(name, REFERENCE_ISA, f32)
#define SQRT sqrtf
#endif

#define reference_semi_implicit_euler NAME(reference_semi_implicit_euler)
#define reference_velocity_verlet NAME(reference_velocity_verlet)
#define reference_rk4 NAME(reference_rk4)
#define reference_rk4_field NAME(reference_rk4_field)
#define reference_push NAME(reference_push)
#define reference_update NAME(reference_update)
#define reference_copy NAME(reference_copy)
#define reference_add_multiply NAME(reference_add_multiply)
#define reference_run_forces NAME(reference_run_forces)
#define reference_edge_forces NAME(reference_edge_forces)
#define reference_all_pairs NAME(reference_all_pairs)

extern reference_step reference_semi_implicit_euler, reference_velocity_verlet, reference_rk4, reference_rk4_field,
    reference_push, reference_update, reference_copy, reference_add_multiply;
void reference_run_forces(const reference_bodies *bodies);
void reference_edge_forces(const reference_bodies *bodies);
void reference_all_pairs(const reference_bodies *bodies, const reference_law *law);

#endif
