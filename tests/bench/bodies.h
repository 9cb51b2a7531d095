/* bodies: the particles and springs of a scene, made from their indices, for the library and for the references. */
#ifndef STEADFAST_TESTS_BODIES_H
#define STEADFAST_TESTS_BODIES_H

#include "reference.h"
#include "steadfast/steadfast.h"
#include "workload.h"

#ifdef STF_DOUBLE
#define bench_particle bench_particle_f64
#define bench_law bench_law_f64
#define bench_edges bench_edges_f64
#define bench_cloth_runs bench_cloth_runs_f64
#define bench_bodies_create bench_bodies_create_f64
#define bench_bodies_destroy bench_bodies_destroy_f64
#define bench_world_create bench_world_create_f64
#endif

reference_law bench_law(const bench_scene *scene);
stf_particle bench_particle(const bench_scene *scene, size_t i);

/* The springs, as the scene's form orders them, to be freed; NULL if there are none or no memory. */
reference_edge *bench_edges(const bench_scene *scene);

/* All arrays in one piece of memory; false: no memory. */
/* The runs of a cloth, into bodies; false: no memory. */
bool bench_cloth_runs(const bench_scene *scene, reference_bodies *bodies);

bool bench_bodies_create(const bench_scene *scene, reference_bodies *bodies);
void bench_bodies_destroy(reference_bodies *bodies);

/* NULL: no memory; or no second thread, where the scene's form wants it. */
stf_world *bench_world_create(const bench_scene *scene, stf_allocator allocator);

#endif
