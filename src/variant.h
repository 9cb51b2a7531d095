/*
 * The hot files (integrators, forces, kernels.c) are compiled once more for each instruction set, with STF_VARIANT defined as
 * its name. What they export then gets that name too and stays inside the library: kernels.h is where the world finds it.
 */
#ifndef STEADFAST_SRC_VARIANT_H
#define STEADFAST_SRC_VARIANT_H

#include "steadfast/compiler.h"
#include "steadfast/precision.h"

#ifdef STF_VARIANT

#undef STF_API
#define STF_API

#define STF_JOIN(a, b, c) a##b##_##c
#define STF_NAME_OF(precision, variant, name) STF_JOIN(precision, variant, name)
#ifdef STF_DOUBLE
#define STF_VARIANT_NAME(name) STF_NAME_OF(stf_f64_, STF_VARIANT, name)
#else
#define STF_VARIANT_NAME(name) STF_NAME_OF(stf_f32_, STF_VARIANT, name)
#endif

#undef stf_explicit_euler
#undef stf_semi_implicit_euler
#undef stf_midpoint
#undef stf_improved_euler
#undef stf_rk4
#undef stf_position_verlet
#undef stf_velocity_verlet
#undef stf_integrators
#undef stf_integrator_find
#undef stf_force_linear_drag
#undef stf_force_quadratic_drag
#undef stf_force_attractor
#undef stf_force_anchored_springs
#undef stf_force_springs
#undef stf_force_all_pairs_gravity

#define stf_explicit_euler STF_VARIANT_NAME(explicit_euler)
#define stf_semi_implicit_euler STF_VARIANT_NAME(semi_implicit_euler)
#define stf_midpoint STF_VARIANT_NAME(midpoint)
#define stf_improved_euler STF_VARIANT_NAME(improved_euler)
#define stf_rk4 STF_VARIANT_NAME(rk4)
#define stf_position_verlet STF_VARIANT_NAME(position_verlet)
#define stf_velocity_verlet STF_VARIANT_NAME(velocity_verlet)
#define stf_integrators STF_VARIANT_NAME(integrators)
#define stf_integrator_find STF_VARIANT_NAME(integrator_find)
#define stf_force_linear_drag STF_VARIANT_NAME(force_linear_drag)
#define stf_force_quadratic_drag STF_VARIANT_NAME(force_quadratic_drag)
#define stf_force_attractor STF_VARIANT_NAME(force_attractor)
#define stf_force_anchored_springs STF_VARIANT_NAME(force_anchored_springs)
#define stf_force_springs STF_VARIANT_NAME(force_springs)
#define stf_force_all_pairs_gravity STF_VARIANT_NAME(force_all_pairs_gravity)

#endif

#endif
