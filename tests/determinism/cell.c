#include "cell.h"

#include <stdio.h>
#include <stdlib.h>

#include "crowds.h"

#ifdef STF_DOUBLE
#define PRECISION "double"
#define cell_run_here cell_run_f64
#else
#define PRECISION "float"
#define cell_run_here cell_run_f32
#endif

#define STRIDE 100 /* ticks between two looks for what is not finite */
#define PATH_MAX_BYTES 4096

typedef struct bytes {
    unsigned char *data;
    size_t size;
} bytes;

static void require(stf_result result, const char *what)
{
    if (result)
        fail(what, stf_result_text(result));
}

static bytes take(size_t size)
{
    const bytes taken = {.data = malloc(size), .size = size};

    if (!taken.data)
        fail("no memory", PRECISION);
    return taken;
}

static size_t count_of(const scene *const list[])
{
    size_t count = 0;

    while (list[count])
        count++;
    return count;
}

static void step(stf_world *world, unsigned ticks) { require(stf_world_step(world, ticks), "step"); }

/* Steps by `stride` ticks until the world has run `ticks`, or the next stride would make it non-finite. */
static void step_by(stf_world *world, unsigned ticks, unsigned stride)
{
    const bytes before = take(stf_world_snapshot_size(world));
    bool is_finite = true;

    while (is_finite && stf_world_ticks(world) < ticks) {
        const unsigned left = ticks - (unsigned)stf_world_ticks(world);

        require(stf_world_snapshot(world, before.data, before.size), "snapshot");
        step(world, left < stride ? left : stride);
        is_finite = !stf_world_find_non_finite(world, NULL);
    }
    if (!is_finite)
        require(stf_world_restore(world, before.data, before.size), "restore");
    free(before.data);
}

/* Steps to `ticks`, or to the last tick after which all is finite. */
static void step_while_finite(stf_world *world, unsigned ticks)
{
    step_by(world, ticks, STRIDE);
    step_by(world, ticks, 1);
}

static bytes save(const stf_world *world)
{
    const bytes saved = take(stf_world_save_size(world));

    require(stf_world_save(world, saved.data, saved.size), "save");
    return saved;
}

/* FNV-1a. */
static uint64_t hash_of_save(const stf_world *world)
{
    const bytes saved = save(world);
    uint64_t hash = UINT64_C(0xcbf29ce484222325);

    for (size_t i = 0; i < saved.size; i++)
        hash = (hash ^ saved.data[i]) * UINT64_C(0x100000001b3);
    free(saved.data);
    return hash;
}

static FILE *open_save(const char *directory, const cell *c, const char *mode)
{
    char path[PATH_MAX_BYTES];

    snprintf(path, sizeof path, "%s/%s-%s-%s", directory, c->scene_name, c->integrator_name, c->precision);
    FILE *file = fopen(path, mode);
    if (!file)
        fail("cannot open", path);
    return file;
}

static void write_save(const char *directory, const cell *c, const stf_world *world)
{
    const bytes saved = save(world);
    FILE *file = open_save(directory, c, "wb");

    if (fwrite(saved.data, 1, saved.size, file) != saved.size || fclose(file) != 0)
        fail("cannot write to", directory);
    free(saved.data);
}

static void read_save(const char *directory, const cell *c, stf_world *world)
{
    const bytes saved = take(stf_world_save_size(world)); /* of the same particles and forces */
    FILE *file = open_save(directory, c, "rb");

    if (fread(saved.data, 1, saved.size, file) != saved.size || fgetc(file) != EOF)
        fail("not of the size that the world's save has: a save in", directory);
    require(stf_world_load(world, saved.data, saved.size, NULL), "load");
    fclose(file);
    free(saved.data);
}

cell cell_run_here(const cell_run *run, size_t index, size_t integrator)
{
    const size_t demos = count_of(scenes);
    const scene *s = index < demos ? scenes[index] : crowds[index - demos];
    const stf_world_def def = {.integrator = stf_integrators[integrator], .keep_previous = true,
                               .compensated = crowd_is_compensated(s), .parallel = run->parallel};
    cell made = {.scene_name = s->name, .integrator_name = def.integrator->name, .precision = PRECISION,
                 .ticks = index < demos ? run->ticks : run->ticks / CROWD_SHARE};
    stf_world *world;

    require(scene_create(s, &def, &world), s->name);
    if (run->read)
        read_save(run->read, &made, world);
    step_while_finite(world, made.ticks / 10);
    if (run->write)
        write_save(run->write, &made, world);
    step_while_finite(world, made.ticks);
    made.finite = (unsigned)stf_world_ticks(world);
    made.hash = hash_of_save(world);
    stf_world_destroy(world);
    return made;
}

#ifndef STF_DOUBLE
size_t cell_scenes(void) { return count_of(scenes) + count_of(crowds); }

const char *cell_isa(void)
{
    stf_world *world;

    require(stf_world_create(&(stf_world_def){.step = 1}, &world), "world");
    const char *isa = stf_world_isa(world);
    stf_world_destroy(world);
    return isa;
}
#endif
