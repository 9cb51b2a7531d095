/*
 * precision: what stf_real is, and the names of the second set of symbols.
 *
 * The library holds every function and type of reals twice: for float under its plain name, for double under that name
 * with _f64 behind it. `#define STF_DOUBLE` before the first Steadfast include (best: -DSTF_DOUBLE for the whole file)
 * gives stf_real and all names below their double meaning, so that code is written once. A program may have files of
 * both kinds. What was compiled for one can't link with the other, and C++ sees two types. What holds no reals (results, the
 * version, the allocator, the clock, references and rows of trade) exists once and goes with both.
 */
#ifndef STEADFAST_PRECISION_H
#define STEADFAST_PRECISION_H

#ifndef STF_DOUBLE

typedef float stf_real;

#else

typedef double stf_real;

/* particle */
#define stf_vector                  stf_vector_f64
#define stf_particle                stf_particle_f64
#define stf_particles               stf_particles_f64
#define stf_particles_offset        stf_particles_offset_f64
/* integrator */
#define stf_system                  stf_system_f64
#define stf_flight                  stf_flight_f64
#define stf_system_each             stf_system_each_f64
#define stf_integrator              stf_integrator_f64
#define stf_explicit_euler          stf_explicit_euler_f64
#define stf_semi_implicit_euler     stf_semi_implicit_euler_f64
#define stf_midpoint                stf_midpoint_f64
#define stf_improved_euler          stf_improved_euler_f64
#define stf_rk4                     stf_rk4_f64
#define stf_position_verlet         stf_position_verlet_f64
#define stf_velocity_verlet         stf_velocity_verlet_f64
#define stf_integrators             stf_integrators_f64
#define stf_integrator_find         stf_integrator_find_f64
/* force */
#define stf_force                   stf_force_f64
#define stf_linear_drag             stf_linear_drag_f64
#define stf_quadratic_drag          stf_quadratic_drag_f64
#define stf_attractor               stf_attractor_f64
#define stf_anchored_spring         stf_anchored_spring_f64
#define stf_spring                  stf_spring_f64
#define stf_all_pairs_gravity       stf_all_pairs_gravity_f64
/* force descriptors */
#define stf_force_linear_drag       stf_force_linear_drag_f64
#define stf_force_quadratic_drag    stf_force_quadratic_drag_f64
#define stf_force_attractor         stf_force_attractor_f64
#define stf_force_anchored_springs  stf_force_anchored_springs_f64
#define stf_force_springs           stf_force_springs_f64
#define stf_force_all_pairs_gravity stf_force_all_pairs_gravity_f64
/* world */
#define stf_world                   stf_world_f64
#define stf_world_def               stf_world_def_f64
#define stf_world_create            stf_world_create_f64
#define stf_world_destroy           stf_world_destroy_f64
#define stf_world_count             stf_world_count_f64
#define stf_world_reserve           stf_world_reserve_f64
#define stf_world_add               stf_world_add_f64
#define stf_world_add_many          stf_world_add_many_f64
#define stf_world_get               stf_world_get_f64
#define stf_world_set               stf_world_set_f64
#define stf_world_remove            stf_world_remove_f64
#define stf_world_clear             stf_world_clear_f64
#define stf_world_copy_positions    stf_world_copy_positions_f64
#define stf_world_add_force         stf_world_add_force_f64
#define stf_world_set_force         stf_world_set_force_f64
#define stf_world_force_records     stf_world_force_records_f64
#define stf_world_force_at          stf_world_force_at_f64
#define stf_world_force             stf_world_force_f64
#define stf_world_remove_force      stf_world_remove_force_f64
#define stf_world_set_gravity       stf_world_set_gravity_f64
#define stf_world_gravity           stf_world_gravity_f64
#define stf_world_step              stf_world_step_f64
#define stf_world_ticks             stf_world_ticks_f64
#define stf_world_time              stf_world_time_f64
#define stf_world_set_step          stf_world_set_step_f64
#define stf_world_step_size         stf_world_step_size_f64
#define stf_world_set_substeps      stf_world_set_substeps_f64
#define stf_world_substeps          stf_world_substeps_f64
#define stf_world_set_integrator    stf_world_set_integrator_f64
#define stf_world_integrator        stf_world_integrator_f64
#define stf_world_isa               stf_world_isa_f64
#define stf_world_dimensions        stf_world_dimensions_f64
#define stf_world_energy            stf_world_energy_f64
#define stf_world_momentum          stf_world_momentum_f64
#define stf_world_view              stf_world_view_f64
#define stf_world_accelerations     stf_world_accelerations_f64
#define stf_world_find_non_finite   stf_world_find_non_finite_f64
#define stf_world_set_guard         stf_world_set_guard_f64
#define stf_world_guard             stf_world_guard_f64
#define stf_world_fault             stf_world_fault_f64
#define stf_world_clear_fault       stf_world_clear_fault_f64
#define stf_world_describe          stf_world_describe_f64
/* save */
#define stf_world_save_size         stf_world_save_size_f64
#define stf_world_save              stf_world_save_f64
#define stf_world_load              stf_world_load_f64
#define stf_world_snapshot_size     stf_world_snapshot_size_f64
#define stf_world_snapshot          stf_world_snapshot_f64
#define stf_world_restore           stf_world_restore_f64
/* stability */
#define stf_stability_measure       stf_stability_measure_f64
/* trade */
#define stf_trade                   stf_trade_f64
#define stf_trade_def               stf_trade_def_f64
#define stf_trade_begin             stf_trade_begin_f64

#endif

#endif
