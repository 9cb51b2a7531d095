#include "bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "random.h"
#include "threads.h"

#define CACHE_LINE 64
/* Lines between two arrays: arrays of 2^n bytes apart would share the same few places of a cache. */
#define STAGGER 5
#define PACKED_REALS 9 /* a particle: its state and its force */

#define CLOTH_SPACING 0.05 /* m */
#define CLOTH_MASS 0.002   /* kg */
#define HELD 8             /* every such mass of the first row */

/* What drag leaves of 1 m/s and 1 m in the end, and how many ticks later it is measured. */
#ifdef STF_DOUBLE
#define SLOWED 1e-306
#else
#define SLOWED 1e-36
#endif
#define SLOWED_TICKS STF_SETTLE_TICKS

/* Gravity in every dimension but where it is about rest: no velocity decays to a denormal number, however long a scene runs. */
reference_law bench_law(const bench_scene *scene)
{
    reference_law law = {.dt = (stf_real)(1.0 / 60), .gravity = {(stf_real)0.3, (stf_real)-9.81, (stf_real)0.2}};

    if (scene->kind == FREE || scene->kind == SLOWING)
        law.drag = (stf_real)0.1;
    if (scene->kind == FIELD)
        law.drag = (stf_real)0.01, law.strength = 5, law.softening = (stf_real)0.1;
    if (scene->kind == CLOTH)
        law.dt = (stf_real)(1.0 / 3000); /* 2 for 12 springs of 500 N/m at 0.002 kg is 1 / 1225 s */
    if (scene->kind == GRAPH || scene->kind == PAIRS || scene->kind == SLOWING || scene->kind == HUNG)
        memset(law.gravity, 0, sizeof law.gravity);
    if (scene->kind == PAIRS)
        law.strength = (stf_real)(1.0 / (double)(scene->n + 1)), law.softening = (stf_real)0.05;
    if (scene->kind == MACHINE)
        law.drag = (stf_real)0.5;
    return law;
}

static stf_vector vector(size_t i, unsigned which, double low, double high)
{
    const double range = high - low;

    return (stf_vector){(stf_real)(low + range * random_of(i, which)), (stf_real)(low + range * random_of(i, which + 1)),
                        (stf_real)(low + range * random_of(i, which + 2))};
}

/* On a lattice, and in motion, so that no spring stays at its rest length. */
static stf_particle cloth_particle(const bench_scene *scene, size_t i)
{
    const size_t side = (size_t)(sqrt((double)scene->n) + 0.5);
    const bool held = i < side && i % HELD == 0;

    return (stf_particle){
        .position = {(stf_real)(CLOTH_SPACING * (double)(i % side)), 0, (stf_real)(CLOTH_SPACING * (double)(i / side))},
        .velocity = held ? (stf_vector){0, 0, 0} : vector(i, 3, -0.5, 0.5),
        .inverse_mass = held ? 0 : (stf_real)(1 / CLOTH_MASS)};
}

stf_particle bench_particle(const bench_scene *scene, size_t i)
{
    const double speed = scene->form == LIBRARY_AT_REST ? SLOWED : 1;
    const double size = scene->kind == FIELD ? 5 : scene->kind == HUNG ? speed : 1;

    if (scene->kind == CLOTH)
        return cloth_particle(scene, i);
    return (stf_particle){.position = vector(i, 0, -size, size),
                          .velocity = vector(i, 3, -speed, speed),
                          .inverse_mass = (stf_real)(i % 97 == 96 ? 0 : 0.5 + 1.5 * random_of(i, 6))};
}

static stf_real *align(stf_real *memory)
{
    const uintptr_t at = (uintptr_t)memory, up = (at + CACHE_LINE - 1) & ~(uintptr_t)(CACHE_LINE - 1);

    return memory + (up - at) / sizeof *memory;
}

bool bench_bodies_create(const bench_scene *scene, reference_bodies *bodies)
{
    const size_t line = CACHE_LINE / sizeof(stf_real), n = scene->n;
    const size_t padded = (n + REFERENCE_LANES - 1) / REFERENCE_LANES * REFERENCE_LANES + STAGGER * line;
    const size_t packed = scene->kind == GRAPH || scene->kind == CLOTH || scene->kind == PAIRS ? PACKED_REALS * padded : 0;

    *bodies = (reference_bodies){.n = n};
    bodies->memory = calloc(10 * padded + packed + line, sizeof(stf_real)); /* what is never used is never touched */
    if (!bodies->memory)
        return false;

    stf_real *at = align(bodies->memory);
    for (int d = 0; d < 3; d++)
        bodies->x[d] = at + (size_t)d * padded, bodies->v[d] = at + (size_t)(3 + d) * padded,
        bodies->a[d] = at + (size_t)(7 + d) * padded;
    bodies->w = at + 6 * padded;
    bodies->packed = at + 10 * padded;
    for (size_t i = 0; i < n; i++) {
        const stf_particle p = bench_particle(scene, i);
        bodies->x[0][i] = p.position.x, bodies->x[1][i] = p.position.y, bodies->x[2][i] = p.position.z;
        bodies->v[0][i] = p.velocity.x, bodies->v[1][i] = p.velocity.y, bodies->v[2][i] = p.velocity.z;
        bodies->w[i] = p.inverse_mass;
    }
    if (scene->kind == CLOTH && scene->form == REFERENCE)
        return bench_cloth_runs(scene, bodies);
    bodies->edge_count = bench_springs(scene);
    bodies->edges = bench_edges(scene);
    return bodies->edge_count == 0 || bodies->edges;
}

void bench_bodies_destroy(reference_bodies *bodies)
{
    free(bodies->memory);
    free(bodies->runs);
    free(bodies->stiffness);
    free(bodies->edges);
    *bodies = (reference_bodies){0};
}

static stf_result add_particles(const bench_scene *scene, stf_world *world)
{
    enum { LOT = 1024 };
    stf_particle lot[LOT];
    stf_result result = stf_world_reserve(world, scene->n);

    for (size_t first = 0; !result && first < scene->n; first += LOT) {
        const size_t count = scene->n - first < LOT ? scene->n - first : LOT;
        for (size_t i = 0; i < count; i++)
            lot[i] = bench_particle(scene, first + i);
        result = stf_world_add_many(world, lot, count, NULL);
    }
    return result;
}

static stf_result add_springs(const bench_scene *scene, stf_world *world)
{
    const size_t count = bench_springs(scene);
    reference_edge *edges = bench_edges(scene);
    stf_spring *springs = malloc(count * sizeof *springs);
    stf_result result = STF_ERROR_MEMORY;

    for (size_t i = 0; edges && springs && i < count; i++)
        springs[i] = (stf_spring){edges[i].a, edges[i].b, edges[i].stiffness, edges[i].damping, edges[i].rest_length};
    if (edges && springs)
        result = stf_world_add_force(world, &stf_force_springs, springs, count, NULL);
    free(springs);
    free(edges);
    return result;
}

static stf_result hang(const bench_scene *scene, stf_world *world)
{
    stf_anchored_spring *springs = malloc(scene->n * sizeof *springs);
    stf_result result = STF_ERROR_MEMORY;

    for (size_t i = 0; springs && i < scene->n; i++)
        springs[i] = (stf_anchored_spring){.particle = (uint32_t)i, .stiffness = 1, .damping = (stf_real)0.1};
    if (springs)
        result = stf_world_add_force(world, &stf_force_anchored_springs, springs, scene->n, NULL);
    free(springs);
    return result;
}

static stf_result add_forces(const bench_scene *scene, stf_world *world)
{
    const reference_law law = bench_law(scene);
    const stf_linear_drag linear = {.coefficient = law.drag};
    const stf_quadratic_drag quadratic = {.coefficient = law.drag};
    const stf_attractor attractor = {.strength = law.strength, .softening = law.softening};
    const stf_all_pairs_gravity pairs = {.gravitational_constant = law.strength, .softening = law.softening};

    if (scene->kind == FREE || scene->kind == SLOWING)
        return stf_world_add_force(world, &stf_force_linear_drag, &linear, 1, NULL);
    if (scene->kind == HUNG)
        return hang(scene, world);
    if (scene->kind == PAIRS)
        return stf_world_add_force(world, &stf_force_all_pairs_gravity, &pairs, 1, NULL);
    if (scene->kind == CLOTH || scene->kind == GRAPH)
        return add_springs(scene, world);

    const stf_result result = stf_world_add_force(world, &stf_force_quadratic_drag, &quadratic, 1, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_attractor, &attractor, 1, NULL);
}

stf_world *bench_world_create(const bench_scene *scene, stf_allocator allocator)
{
    const reference_law law = bench_law(scene);
    const stf_world_def def = {.integrator = stf_integrator_find(scene->integrator),
                               .step = (double)law.dt,
                               .gravity = {law.gravity[0], law.gravity[1], law.gravity[2]},
                               .compensated = scene->form == LIBRARY_COMPENSATED,
                               .guard.mode = scene->form == LIBRARY_GUARDED ? STF_GUARD_FREEZE : STF_GUARD_OFF,
                               .allocator = allocator,
                               .parallel = scene->form == LIBRARY_THREADS ? bench_threads() : (stf_parallel){0}};
    stf_world *world = NULL;

    if (scene->form == LIBRARY_THREADS && !def.parallel.run)
        return NULL;
    if (stf_world_create(&def, &world) || add_particles(scene, world) || add_forces(scene, world)) {
        stf_world_destroy(world);
        return NULL;
    }
    if (scene->form == LIBRARY_AT_REST)
        stf_world_step(world, SLOWED_TICKS);
    return world;
}
