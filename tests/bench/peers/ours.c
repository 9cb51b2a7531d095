/* Steadfast itself, in both precisions: this file is compiled twice. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "steadfast/steadfast.h"

#include "peer.h"

#ifdef STF_DOUBLE
#define peer_ours peer_ours_double
#define REALS "double"
#else
#define peer_ours peer_ours_float
#define REALS "float"
#endif

enum { SPRINGS_OF_THE_LIBRARY = 1 }; /* variant of the race */

typedef struct ours {
    stf_world *world;
    double step;
} ours;

/* F = -x. A force as a user writes it, like the right-hand sides of the other peers; with masses of 1 / omega^2 it makes
   x'' = -omega^2 x. */
static void pull_back(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const stf_real *restrict x = particles->position;
    stf_real *restrict force = particles->force;
    const size_t count = particles->count;
    (void)records, (void)record_count, (void)time;

    for (size_t i = 0; i < count; i++)
        force[i] -= x[i];
}

static const stf_force unit_springs = {
    .name = "unit_springs", .kind = STF_FIELD, .depends_on = STF_ON_POSITION, .apply = pull_back};

static void must(stf_result result)
{
    if (result) {
        fprintf(stderr, "peers: Steadfast refused a workload: %s\n", stf_result_text(result));
        exit(1);
    }
}

static void add_particles(stf_world *world, const workload *w, bool unit_springs_pull)
{
    stf_particle *particles = need(w->count * sizeof *particles);

    for (size_t i = 0; i < w->count; i++) {
        const double *x = &w->position[3 * i], *v = &w->velocity[3 * i];
        particles[i] = (stf_particle){
            .position = {(stf_real)x[0], (stf_real)x[1], (stf_real)x[2]},
            .velocity = {(stf_real)v[0], (stf_real)v[1], (stf_real)v[2]},
            .inverse_mass = (stf_real)(unit_springs_pull ? w->stiffness[i] : w->inverse_mass[i]),
        };
    }
    must(stf_world_add_many(world, particles, w->count, NULL));
    free(particles);
}

static void add_springs(stf_world *world, const workload *w)
{
    stf_spring *springs = need(w->tie_count * sizeof *springs);

    for (size_t i = 0; i < w->tie_count; i++)
        springs[i] = (stf_spring){.a = w->ties[i].a,
                                  .b = w->ties[i].b,
                                  .stiffness = (stf_real)w->tie_stiffness,
                                  .damping = (stf_real)w->tie_damping,
                                  .rest_length = (stf_real)w->ties[i].rest_length};
    must(stf_world_add_force(world, &stf_force_springs, springs, w->tie_count, NULL));
    free(springs);
}

static void add_anchored_springs(stf_world *world, const workload *w)
{
    stf_anchored_spring *springs = need(w->count * sizeof *springs);

    for (size_t i = 0; i < w->count; i++)
        springs[i] = (stf_anchored_spring){.particle = (uint32_t)i, .stiffness = (stf_real)w->stiffness[i]};
    must(stf_world_add_force(world, &stf_force_anchored_springs, springs, w->count, NULL));
    free(springs);
}

static void add_forces(stf_world *world, const workload *w, const method *m)
{
    const double inverse_mass = w->inverse_mass[w->count - 1];
    const stf_linear_drag drag = {.coefficient = (stf_real)(w->drag / inverse_mass)};
    const stf_attractor sun = {.strength = 1};

    if (w->kind == CLOTH)
        add_springs(world, w);
    if (w->kind == FLIGHT || w->kind == CLOTH)
        must(stf_world_add_force(world, &stf_force_linear_drag, &drag, 1, NULL));
    else if (w->kind == KEPLER)
        must(stf_world_add_force(world, &stf_force_attractor, &sun, 1, NULL));
    else if (m->variant == SPRINGS_OF_THE_LIBRARY)
        add_anchored_springs(world, w);
    else
        must(stf_world_add_force(world, &unit_springs, NULL, 0, NULL));
}

static void *create(const workload *w, const method *m, double setting)
{
    const char *end = strchr(m->name, ','); /* what stands behind a comma says with which forces */
    char name[64];
    ours *o = need(sizeof *o);

    snprintf(name, sizeof name, "%.*s", (int)(end ? (size_t)(end - m->name) : strlen(m->name)), m->name);
    o->step = setting;
    must(stf_world_create(&(stf_world_def){.dimensions = w->dimensions,
                                           .integrator = stf_integrator_find(name),
                                           .step = setting,
                                           .gravity = {0, (stf_real)-w->gravity, 0},
                                           .capacity = w->count},
                          &o->world));
    add_particles(o->world, w, w->kind == OSCILLATORS && m->variant != SPRINGS_OF_THE_LIBRARY);
    add_forces(o->world, w, m);
    return o;
}

static void advance(void *self, double duration)
{
    ours *o = self;

    must(stf_world_step(o->world, (unsigned)lround(duration / o->step)));
}

static void read(const void *self, double *position, double *velocity)
{
    const ours *o = self;

    for (size_t i = 0; i < stf_world_count(o->world); i++) {
        stf_particle p;
        must(stf_world_get(o->world, i, &p));
        position[3 * i] = (double)p.position.x;
        position[3 * i + 1] = (double)p.position.y;
        position[3 * i + 2] = (double)p.position.z;
        velocity[3 * i] = (double)p.velocity.x;
        velocity[3 * i + 1] = (double)p.velocity.y;
        velocity[3 * i + 2] = (double)p.velocity.z;
    }
}

static void destroy(void *self)
{
    ours *o = self;

    stf_world_destroy(o->world);
    free(o);
}

static void version(char *text, size_t size) { snprintf(text, size, "%s", stf_version()); }

#define METHODS_MAX 64

/* The race is run by every integrator that the library has. */
static const method *methods(void)
{
    static method all[METHODS_MAX] = {
        {.name = "semi_implicit_euler", .workloads = DOES_FLIGHT | DOES_CLOTH, .dimensions = 2, .order = 1},
        {.name = "semi_implicit_euler", .workloads = DOES_FLIGHT | DOES_CLOTH, .dimensions = 3, .order = 1},
        {.name = "rk4", .workloads = DOES_FLIGHT, .dimensions = 2, .order = 4},
        {.name = "rk4", .workloads = DOES_FLIGHT, .dimensions = 3, .order = 4},
    };
#ifdef STF_DOUBLE
    static char with_springs[METHODS_MAX][64];
    size_t i = 0, n = 0;
    while (all[n].name)
        n++;
    while (!all[n - 1].variant && stf_integrators[i]) /* else they are there already */
        i++;
    while (i-- > 0 && n + 2 < METHODS_MAX) { /* from the last: the better ones come sooner, and the rest is given up sooner */
        snprintf(with_springs[n], sizeof with_springs[n], "%s, library's springs", stf_integrators[i]->name);
        all[n] = (method){.name = stf_integrators[i]->name, .workloads = DOES_RACE};
        all[n + 1] = (method){.name = with_springs[n], .workloads = 1 << OSCILLATORS, .variant = SPRINGS_OF_THE_LIBRARY};
        n += 2;
    }
#endif
    return all;
}

extern const peer peer_ours;
const peer peer_ours = {
    .name = "Steadfast",
    .reals = REALS,
    .note = "its forces; but the race's oscillators by a force of the user's own, three lines, if that is cheaper",
    .version = version,
    .methods = methods,
    .create = create,
    .advance = advance,
    .read = read,
    .destroy = destroy,
};
