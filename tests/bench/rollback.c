/* Snapshot and restore of a world, beside memcpy of the same bytes. In float. */
#include <stdlib.h>
#include <string.h>

#include "bodies.h"
#include "rows.h"

/* Bytes from memory to memory: of a snapshot, or of the copy. */
typedef struct rollback {
    stf_world *world;
    size_t bytes;
    void *from, *to;
} rollback;

static void end(void *context)
{
    rollback *r = context;

    stf_world_destroy(r->world);
    free(r->from);
    free(r->to);
    free(r);
}

static stf_world *world_of(const bench_scene *scene)
{
    const stf_world_def def = {.integrator = stf_integrator_find(scene->integrator), .capacity = scene->n};
    stf_world *world = NULL;
    stf_result bad = stf_world_create(&def, &world);

    for (size_t i = 0; i < scene->n && !bad; i++) {
        const stf_particle particle = bench_particle(scene, i);
        bad = stf_world_add(world, &particle, NULL);
    }
    return world;
}

static void *begin(const void *argument)
{
    const bench_scene *scene = argument;
    rollback *r = calloc(1, sizeof *r);

    if (!r)
        return NULL;
    r->world = world_of(scene);
    r->bytes = stf_world_snapshot_size(r->world);
    r->from = calloc(1, r->bytes);
    r->to = malloc(r->bytes);
    if (r->world && r->from && r->to && stf_world_count(r->world) == scene->n)
        return r;
    end(r);
    return NULL;
}

static void go_back(void *context)
{
    rollback *r = context;

    stf_world_snapshot(r->world, r->to, r->bytes);
    stf_world_restore(r->world, r->to, r->bytes);
}

static void copy(void *context)
{
    rollback *r = context;

    memcpy(r->to, r->from, r->bytes);
}

void bench_rollback_group(bench_group *g, const char *integrator, size_t n)
{
    static void (*const runs[])(void *context) = {go_back, copy};
    static const char *const names[] = {"snapshot and restore", "memcpy of the same bytes"};

    for (size_t i = 0; i < 2; i++) {
        g->scenes[i] = (bench_scene){.kind = FREE, .integrator = integrator, .n = n};
        g->cases[i] = (measure_case){.argument = &g->scenes[i], .setup = begin, .run = runs[i], .teardown = end,
                                     .items = (double)n};
        g->rows[i] = (bench_row){.precision = &bench_float, .n = n, .unit = "ns/particle", .library = i == 0, .measured = i};
        strcpy(g->rows[i].name, names[i]);
    }
    g->rows[0].comparison = RATIO;
    g->rows[0].first_reference = g->rows[0].last_reference = 1;
    g->rows[0].target = 3;
    g->cases_count = g->rows_count = 2;
}
