/* The loops of this instruction set and precision, for chosen.c. */
#include "names.h"

#define TEXT(name) #name
#define TEXT_EXPANDED(name) TEXT(name)

extern const reference NAME(reference);
const reference NAME(reference) = {
    .isa = TEXT_EXPANDED(REFERENCE_ISA),
    .semi_implicit_euler = reference_semi_implicit_euler,
    .velocity_verlet = reference_velocity_verlet,
    .rk4 = reference_rk4,
    .rk4_field = reference_rk4_field,
    .push = reference_push,
    .update = reference_update,
    .add_multiply = reference_add_multiply,
    .copy = reference_copy,
    .run_forces = reference_run_forces,
    .edge_forces = reference_edge_forces,
    .all_pairs = reference_all_pairs,
};
