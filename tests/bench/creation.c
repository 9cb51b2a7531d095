/* Creation of a world of many particles by one call, beside memcpy of the same particles into fresh memory. In float. */
#include <stdlib.h>
#include <string.h>

#include "bodies.h"
#include "rows.h"

typedef struct creation {
    const bench_scene *scene;
    stf_particle *particles;
    stf_world *world;
    void *copy;
} creation;

static void discard(void *context)
{
    creation *c = context;

    stf_world_destroy(c->world);
    free(c->copy);
    c->world = NULL, c->copy = NULL;
}

static void end(void *context)
{
    creation *c = context;

    discard(c);
    free(c->particles);
    free(c);
}

static void *begin(const void *argument)
{
    const bench_scene *scene = argument;
    creation *c = calloc(1, sizeof *c);

    if (!c)
        return NULL;
    c->scene = scene;
    c->particles = malloc(scene->n * sizeof *c->particles);
    for (size_t i = 0; c->particles && i < scene->n; i++)
        c->particles[i] = bench_particle(scene, i);
    if (c->particles)
        return c;
    free(c);
    return NULL;
}

static void create_world(void *context)
{
    creation *c = context;
    const stf_world_def def = {0};

    if (stf_world_create(&def, &c->world) == STF_OK)
        stf_world_add_many(c->world, c->particles, c->scene->n, NULL);
}

static void copy_particles(void *context)
{
    creation *c = context;
    const size_t bytes = c->scene->n * sizeof *c->particles;

    c->copy = malloc(bytes);
    if (c->copy)
        memcpy(c->copy, c->particles, bytes);
}

void bench_creation_group(bench_group *g, size_t n)
{
    static void (*const runs[])(void *context) = {create_world, copy_particles};
    static const char *const names[] = {"creation, stf_world_add_many", "creation, memcpy of the particles"};

    g->plan.rounds = 5;
    for (size_t i = 0; i < 2; i++) {
        g->scenes[i] = (bench_scene){.kind = FREE, .n = n};
        g->cases[i] = (measure_case){.argument = &g->scenes[i], .setup = begin, .prepare = discard, .run = runs[i],
                                     .teardown = end, .items = (double)n};
        g->rows[i] = (bench_row){.precision = &bench_float, .n = n, .unit = "ns/particle", .library = i == 0, .measured = i};
        strcpy(g->rows[i].name, names[i]);
    }
    g->rows[0].comparison = RATIO;
    g->rows[0].first_reference = g->rows[0].last_reference = 1;
    g->rows[0].target = 1.15; /* "at memcpy speed" */
    g->cases_count = g->rows_count = 2;
}
