#include "game.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WORK 8000          /* particles that are saved and read: a few ms at most */
#define OPERATION_WORK 16  /* of an operation beside its particles */

void *exact(size_t size)
{
    void *memory = malloc(size);

    claim(memory || size == 0);
    return memory;
}

size_t take_index(game *g)
{
    const unsigned byte = take(&g->program);

    if (byte < 250 && g->model.count > 0)
        return byte * 31 % g->model.count;
    return byte == 255 ? SIZE_MAX : g->model.count + (byte & 1);
}

/* ---- two worlds -------------------------------------------------------------------------------------------------------- */

static unsigned def_faults(const stf_world_def *def)
{
    const bool is_plain = def->compensated && !(def->integrator->flags & STF_COMPENSATES);

    return (is_step(def->step, def->substeps) ? 0 : 1U << STF_ERROR_STEP) | (is_plain ? 1U << STF_ERROR_DESCRIPTOR : 0) |
           vector_faults(def->gravity, def->dimensions);
}

static void take_def(game *g)
{
    static const double steps[] = {1.0 / 60, 1.0 / 64, 0.01, 0.25};
    const unsigned shape = take(&g->program), step = take(&g->program);

    g->def = (stf_world_def){.dimensions = 1 + shape % 3,
                             .compensated = (shape & 32) != 0,
                             .keep_previous = (shape & 64) != 0,
                             .keep_radius = (shape & 128) != 0,
                             .integrator = integrators[take(&g->program) % GOOD_INTEGRATORS],
                             .step = step < 200 ? steps[step % COUNT_OF(steps)] : take_double(&g->program),
                             .substeps = 1 + step / COUNT_OF(steps) % 3};
    if (g->def.step == 0)
        g->def.step = STF_DEFAULT_STEP;
    g->def.gravity = take_vector(&g->program, g->def.dimensions);
}

static stf_result make(game *g, unsigned which, unsigned how)
{
    static const size_t room[] = {0, 1, 16, 300};
    stf_world_def def = g->def;

    g->rations[which] = (ration){.garbage = which ? 0xff : 0x41};
    def.capacity = room[how >> 2 & 3];
    def.allocator = ration_allocator(&g->rations[which]);
    if (which)
        def.parallel = (stf_parallel){.run = run_backwards, .tasks = how >> 4};
    if (which && (how & 64) != 0)
        def.guard = (stf_guard){.mode = STF_GUARD_REPORT, .interval = how >> 2 & 3};
    choose_instructions(how & 3);
    return stf_world_create(&def, &g->worlds[which]);
}

/* Not by a memset: it would cost more than most programs. */
static void reset(game *g)
{
    g->worlds[0] = g->worlds[1] = NULL;
    g->save = NULL;
    g->fail_next = 0;
    g->had_crowd = g->had_stability = g->had_trade = false;
    g->clock = (stf_clock){.step = 0};
    g->work = WORK;
}

bool game_start(game *g)
{
    reset(g);
    take_def(g);

    const unsigned faults = def_faults(&g->def);
    for (unsigned w = 0; w < 2; w++) {
        const stf_result result = make(g, w, take(&g->program));
        claim(faults ? (faults >> result & 1) != 0 : result == STF_OK);
    }
    if (faults)
        return false;

    model *m = &g->model;
    m->dimensions = g->def.dimensions, m->substeps = g->def.substeps, m->step = g->def.step;
    m->keep_previous = g->def.keep_previous, m->keep_radius = g->def.keep_radius, m->compensated = g->def.compensated;
    m->integrator = g->def.integrator;
    m->gravity = g->def.gravity;
    m->ticks = m->step_start_tick = m->count = m->force_count = 0;
    m->step_start_time = 0;
    m->last_id = 0;
    g->changed = true;
    inspect(g);
    return true;
}

void slot_clear(slot *s)
{
    for (unsigned w = 0; w < 2; w++) {
        free(s->bytes[w]);
        s->bytes[w] = NULL;
    }
    s->is_taken = false;
}

void game_end(game *g)
{
    for (unsigned w = 0; w < 2; w++) {
        stf_world_destroy(g->worlds[w]);
        claim(g->rations[w].blocks == 0);
    }
    slot_clear(&g->saved);
    for (unsigned s = 0; s < SNAPSHOT_SLOTS; s++)
        slot_clear(&g->snapshots[s]);
    free(g->save);
}

/* ---- a call of both ---------------------------------------------------------------------------------------------------- */

void begin(game *g, const char *name, unsigned faults)
{
    if (fuzz_verbose)
        printf("%-20s", name);
    g->turns = 0;
    g->faults = faults;
    g->rations[0].refused = g->rations[1].refused = false;
    g->rations[0].fail_in = g->fail_next;
    g->fail_next = 0;
}

static bool is_expected(const game *g, unsigned which)
{
    const bool is_fault = (g->faults >> g->result & 1) != 0;

    if (g->rations[which].refused)
        return g->result == STF_ERROR_MEMORY || is_fault;
    return g->faults ? is_fault : g->result == STF_OK;
}

stf_world *turn(game *g)
{
    if (g->turns > 0) {
        g->rations[0].fail_in = 0;
        g->results[g->turns - 1] = g->result;
        if (fuzz_verbose && g->turns == 1)
            printf("%s\n", stf_result_text(g->result));
        claim(is_expected(g, g->turns - 1));
        claim(g->turns == 1 || g->results[1] == g->results[0]);
    }
    if (g->turns == 2 || (g->turns == 1 && g->result == STF_ERROR_MEMORY))
        return NULL;
    return g->worlds[g->turns++];
}

bool accepted(game *g)
{
    g->changed = g->result == STF_OK;
    return g->changed;
}

/* ---- whether they are what they should be ------------------------------------------------------------------------------ */

/* NULL where it can't be saved, as was expected. */
static unsigned char *save_of(const stf_world *world, stf_result expected, size_t *size)
{
    *size = stf_world_save_size(world);

    unsigned char *bytes = exact(*size);
    claim(stf_world_save(world, bytes, *size) == expected);
    if (expected == STF_OK)
        return bytes;
    free(bytes);
    return NULL;
}

static void claim_saves_as_kept(const game *g, const stf_world *world)
{
    size_t size;
    unsigned char *bytes = save_of(world, g->save_result, &size);

    claim(!bytes || (size == g->save_size && memcmp(bytes, g->save, size) == 0));
    free(bytes);
}

void inspect(game *g)
{
    const stf_result result = model_save_result(&g->model);

    model_check(&g->model, g->worlds[0]);
    model_check(&g->model, g->worlds[1]);
    if (g->changed) {
        free(g->save);
        g->save = save_of(g->worlds[0], result, &g->save_size);
        g->save_result = result;
    }
    claim(g->save_result == result);
    claim_saves_as_kept(g, g->worlds[g->changed]);
    g->work -= (double)(g->model.count + OPERATION_WORK);
    g->changed = false;
}
