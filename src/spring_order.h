/*
 * The order in which springs stand, in which whole vectors of them are computed at once (forces/spring.c): it never depends on
 * that in which they were given. Where both ends count up by one (a cloth's rows, columns and diagonals are such runs) vectors
 * are loaded and stored whole; what is left over is gathered and scattered.
 */
#ifndef STEADFAST_SRC_SPRING_ORDER_H
#define STEADFAST_SRC_SPRING_ORDER_H

#include "steadfast/force.h"

#ifdef STF_DOUBLE
#define stf_spring_order stf_spring_order_f64
#define stf_springs_arrange stf_springs_arrange_f64
#define stf_springs_arranged_size stf_springs_arranged_size_f64
#endif

#define STF_RUN_MIN STF_ROW_MULTIPLE /* springs of the shortest run */

/* Springs that are computed together: a run, within one block at each end, or the loose ones of a group of blocks. */
typedef struct stf_stretch {
    size_t first, count;   /* of the springs, or of the loose ones */
    uint32_t lower, upper; /* ends of a run's first spring */
    bool is_run;
} stf_stretch;

/* What stands behind the records: stretches in the order of blocks, parameters as vectors are loaded, the loose springs. */
typedef struct stf_spring_order {
    size_t stretch_count, loose_count;
    stf_stretch *stretches;
    stf_real *stiffness, *damping, *rest_length;
    stf_spring *loose;
} stf_spring_order;

/* stf_force.arrange and arranged_size: behind the records stands an stf_spring_order, and what it points at. */
void stf_springs_arrange(void *records, size_t record_count);
size_t stf_springs_arranged_size(size_t spring_count);

#endif
