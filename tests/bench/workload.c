#include "workload.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bodies.h"
#include "threads.h"

typedef struct subject {
    void (*run)(struct subject *subject);
    stf_world *world;
    reference_bodies bodies;
    reference_law law;
    reference_step *step;
    void (*forces)(const reference_bodies *bodies); /* before the step; NULL: none */
} subject;

static void run_world(subject *s) { stf_world_step(s->world, 1); }

static void run_step(subject *s)
{
    stf_real *const *x = s->bodies.x, *const *v = s->bodies.v, *const *a = s->bodies.a;

    s->step(s->bodies.n, x[0], x[1], x[2], v[0], v[1], v[2], a[0], a[1], a[2], s->bodies.w, &s->law);
}

static void run_half(void *context, unsigned half)
{
    const subject *s = context;
    stf_real *const *x = s->bodies.x, *const *v = s->bodies.v, *const *a = s->bodies.a;
    const size_t n = s->bodies.n / 2, at = half * n;

    s->step(n, x[0] + at, x[1] + at, x[2] + at, v[0] + at, v[1] + at, v[2] + at, a[0] + at, a[1] + at, a[2] + at,
            s->bodies.w + at, &s->law);
}

static void run_halves(subject *s)
{
    const stf_parallel threads = bench_threads();

    threads.run(threads.user, 2, run_half, s);
}

static void run_springs(subject *s)
{
    s->forces(&s->bodies);
    run_step(s);
}

static void run_pairs(subject *s)
{
    reference_chosen()->all_pairs(&s->bodies, &s->law);
    run_step(s);
}

static reference_step *step_of(const bench_scene *scene)
{
    const reference *r = reference_chosen();
    const stf_integrator *integrator = stf_integrator_find(scene->integrator);

    if (scene->kind == MACHINE)
        return scene->form == COPY ? r->copy : r->add_multiply;
    if (scene->kind == FIELD)
        return r->rk4_field;
    if (scene->kind != FREE)
        return r->push;
    if (scene->form == UPDATE)
        return r->update;
    return integrator == &stf_rk4 ? r->rk4 : integrator == &stf_velocity_verlet ? r->velocity_verlet : r->semi_implicit_euler;
}

static void choose_loops(subject *s, const bench_scene *scene)
{
    const reference *r = reference_chosen();

    s->step = step_of(scene);
    s->run = run_step;
    if (scene->kind == PAIRS)
        s->run = run_pairs;
    if (scene->form == ADD_MULTIPLY_THREADS)
        s->run = run_halves;
    if (scene->kind == CLOTH || scene->kind == GRAPH) {
        s->run = run_springs;
        s->forces = scene->form == REFERENCE ? r->run_forces : r->edge_forces;
    }
}

/* Velocity Verlet's first acceleration, from where the scene starts. */
static void start_accelerations(subject *s)
{
    for (int d = 0; d < 3; d++)
        for (size_t i = 0; i < s->bodies.n; i++) {
            const stf_real w = s->bodies.w[i];
            s->bodies.a[d][i] = w > 0 ? s->law.gravity[d] + -(s->law.drag * s->bodies.v[d][i]) * w : 0;
        }
}

static void teardown(void *context)
{
    subject *s = context;

    if (!s)
        return;
    stf_world_destroy(s->world);
    bench_bodies_destroy(&s->bodies);
    free(s);
}

static void *setup(const void *argument)
{
    const bench_scene *scene = argument;
    subject *s = calloc(1, sizeof *s);
    bool made;

    if (!s)
        return NULL;
    s->law = bench_law(scene);
    if (bench_is_library(scene)) {
        s->run = run_world;
        s->world = bench_world_create(scene, (stf_allocator){0});
        made = s->world != NULL;
    } else {
        choose_loops(s, scene);
        made = bench_bodies_create(scene, &s->bodies) && (scene->form != ADD_MULTIPLY_THREADS || bench_threads().run);
        if (made && s->step == reference_chosen()->velocity_verlet)
            start_accelerations(s);
    }
    if (made)
        return s;
    teardown(s);
    return NULL;
}

static void run(void *context)
{
    subject *s = context;

    s->run(s);
}

static void run_interval(void *context)
{
    for (int step = 0; step < BENCH_INTERVAL; step++)
        run(context);
}

/* ---- the check ----------------------------------------------------------------------------------------------------------- */

#define CHECKED_STEPS 20

#ifdef STF_DOUBLE
#define EPSILON 2.220446049250313e-16
#else
#define EPSILON 1.1920928955078125e-07
#endif

/*
 * The largest difference that round-off explains after s steps: an ulp of a position in each, and what the sum of n
 * accelerations of size A in another order makes of it, n^2 A eps, over s^2 dt^2 / 2 (Higham, Accuracy and Stability of
 * Numerical Algorithms (2002), 4.2). n and A: the cloth has 12 springs of 500 N/m stretched by 5 mm; the graph 24 or so of
 * 10 N/m by 0.3 m; of the pairs, the sum of all G m / e^2 is what counts. Particles by themselves have two terms.
 */
static double tolerance(const bench_scene *scene, double farthest)
{
    static const double summed[KINDS] = {
        [FREE] = 4 * 10, [FIELD] = 4 * 10, [CLOTH] = 12 * 12 * 500 * 0.005 / 0.002, [GRAPH] = 24 * 24 * 10 * 0.3 * 2,
        [PAIRS] = 2 / (0.05 * 0.05)};
    const double dt = (double)bench_law(scene).dt, s = CHECKED_STEPS;

    return EPSILON * (s * farthest + s * s * dt * dt / 2 * summed[scene->kind]);
}

/* The largest |x_library - x_reference| of any component; *farthest: |x|; *moved: the distance from the start. */
static double difference(const bench_scene *scene, const stf_world *world, const reference_bodies *bodies, double *farthest,
                         double *moved)
{
    double largest = 0;

    for (size_t i = 0; i < scene->n; i++) {
        const stf_vector start = bench_particle(scene, i).position;
        const stf_real from[3] = {start.x, start.y, start.z};
        stf_particle p;

        stf_world_get(world, i, &p);
        const stf_real x[3] = {p.position.x, p.position.y, p.position.z};
        for (int d = 0; d < 3; d++) {
            const double apart = fabs((double)x[d] - (double)bodies->x[d][i]);
            largest = apart <= largest ? largest : apart; /* a NaN is largest, and stays so */
            *farthest = fmax(*farthest, fabs((double)x[d]));
            *moved = fmax(*moved, fabs((double)x[d] - (double)from[d]));
        }
    }
    return largest;
}

static bool same_bits(const stf_world *world, const stf_world *other)
{
    bool same = stf_world_count(world) == stf_world_count(other);

    for (size_t i = 0; same && i < stf_world_count(world); i++) {
        stf_particle p, q;
        stf_world_get(world, i, &p);
        stf_world_get(other, i, &q);
        same = memcmp(&p, &q, sizeof p) == 0; /* reals alone: no padding */
    }
    return same;
}

static bool check_same(const bench_scene *scene)
{
    const bench_scene ours = {scene->kind, LIBRARY, scene->integrator, scene->n};
    subject *one = setup(&ours), *two = setup(scene);
    bool same = one && (!two || !two->world);

    for (int step = 0; one && two && step < CHECKED_STEPS; step++)
        run(one), run(two);
    if (one && two)
        same = same_bits(one->world, two->world);
    if (!same)
        fprintf(stderr, "bench: scene %d: %s: mend the library\n", (int)scene->kind,
                scene->form == LIBRARY_THREADS ? "two threads give other bits than one" : "the guard changes bits");
    teardown(one);
    teardown(two);
    return same;
}

static bool check(const bench_scene *scene)
{
    if (bench_is_library(scene))
        return check_same(scene);

    const bench_scene ours = {scene->kind, LIBRARY, scene->integrator, scene->n};
    subject *library = setup(&ours), *other = setup(scene);
    double farthest = 0, moved = 0, apart = 0, most = 0;
    bool same = false;

    if (library && other) {
        for (int step = 0; step < CHECKED_STEPS; step++)
            run(library), run(other);
        apart = difference(scene, library->world, &other->bodies, &farthest, &moved);
        most = tolerance(scene, farthest);
        same = apart <= most && moved > 100 * most;
    }
    if (!same)
        fprintf(stderr,
                "bench: scene %d, form %d, %s: after %d steps and %g m the reference is %g m from the library, where round-off "
                "allows %g: it is no reference; mend one of them\n",
                (int)scene->kind, (int)scene->form, reference_chosen()->isa, CHECKED_STEPS, moved, apart, most);
    teardown(library);
    teardown(other);
    return same;
}

/* ---- memory -------------------------------------------------------------------------------------------------------------- */

static void *count_allocate(void *user, size_t size, size_t alignment)
{
    void **piece = malloc(size + 2 * alignment);
    char *aligned;

    if (!piece)
        return NULL;
    *(size_t *)user += size;
    aligned = (char *)piece + 2 * alignment - (uintptr_t)piece % alignment;
    ((void **)(void *)aligned)[-1] = piece;
    return aligned;
}

static void count_release(void *user, void *memory, size_t size)
{
    *(size_t *)user -= size;
    free(((void **)memory)[-1]);
}

static size_t world_bytes(const bench_scene *scene)
{
    size_t bytes = 0;
    stf_world *world = bench_world_create(scene, (stf_allocator){count_allocate, count_release, &bytes});
    const size_t held = bytes;

    stf_world_destroy(world);
    return held;
}

#ifdef STF_DOUBLE
const bench_precision bench_double =
#else
const bench_precision bench_float =
#endif
    {
#ifdef STF_DOUBLE
        .name = "double",
#else
        .name = "float",
#endif
        .real_bytes = sizeof(stf_real),
        .setup = setup,
        .run = run,
        .run_interval = run_interval,
        .teardown = teardown,
        .check = check,
        .world_bytes = world_bytes,
};
