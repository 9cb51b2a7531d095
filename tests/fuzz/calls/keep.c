/* Saves and snapshots, into the same worlds, into each other, and into another that is made for it. */
#include <stdlib.h>
#include <string.h>

#include "game.h"

/* A part of a size, in eighths: mostly all; 7 is all but a byte. */
static unsigned take_eighths(game *g)
{
    const unsigned byte = take(&g->program);

    return byte < 248 ? 8 : byte - 248;
}

static size_t part_of(size_t size, unsigned eighths) { return eighths == 7 ? size - 1 : size * eighths / 8; }

void save(game *g)
{
    slot *s = &g->saved;
    const unsigned eighths = take_eighths(g);
    const unsigned faults = (g->save_result ? 1U << g->save_result : 0) | (eighths < 8 ? 1U << STF_ERROR_BUFFER : 0);

    slot_clear(s);
    begin(g, "save", faults);
    for (stf_world *world; (world = turn(g)) != NULL;) {
        const unsigned w = g->turns - 1;

        s->size[w] = part_of(stf_world_save_size(world), eighths);
        s->bytes[w] = exact(s->size[w]);
        g->result = stf_world_save(world, s->bytes[w], s->size[w]);
    }
    s->is_taken = g->result == STF_OK;
    if (s->is_taken)
        model_copy(&s->then, &g->model);
}

void load(game *g)
{
    slot *s = &g->saved;
    stf_mismatch mismatch;

    if (!s->is_taken)
        return;

    const unsigned from = take(&g->program) & 1, faults = model_load_faults(&g->model, &s->then);
    begin(g, "load", faults);
    for (stf_world *world; (world = turn(g)) != NULL;) {
        g->result = stf_world_load(world, s->bytes[from], s->size[from], &mismatch);
        claim((g->result == STF_ERROR_MISMATCH) == (mismatch.what != NULL));
    }
    if (accepted(g))
        model_load(&g->model, &s->then);
}

/* ---- a third world, made for what was saved ------------------------------------------------------------------------------ */

static stf_world *make_like(game *g, const model *m, ration *r)
{
    const unsigned how = take(&g->program);
    const stf_world_def def = {.dimensions = m->dimensions, .keep_previous = m->keep_previous, .keep_radius = m->keep_radius,
                               .compensated = m->compensated,
                               .integrator = m->integrator, .capacity = how & 63, .allocator = ration_allocator(r)};
    stf_world *world = NULL;

    choose_instructions(how >> 6);
    claim(stf_world_create(&def, &world) == STF_OK);
    for (size_t f = 0; f < m->force_count; f++)
        claim(stf_world_add_force(world, m->forces[f].subject->force, NULL, 0, NULL) == STF_OK);
    return world;
}

static bool has_force_that_stays(const model *m)
{
    for (size_t f = 0; f < m->force_count; f++)
        if (m->forces[f].count > 0 && strcmp(m->forces[f].subject->force->fields, STF_NOT_SAVED) == 0)
            return true;
    return false;
}

bool can_be_copied(const game *g) { return !g->save_result && !has_force_that_stays(&g->model); }

stf_world *copy_of_both(game *g, ration *r)
{
    stf_world *copy = make_like(g, &g->model, r);

    claim(stf_world_load(copy, g->save, g->save_size, NULL) == STF_OK);
    model_check(&g->model, copy);
    return copy;
}

static void claim_saves_as(const stf_world *world, const unsigned char *bytes, size_t size)
{
    unsigned char *own = exact(size);

    claim(stf_world_save_size(world) == size);
    claim(stf_world_save(world, own, size) == STF_OK);
    claim(memcmp(own, bytes, size) == 0);
    free(own);
}

/*
 * The worlds as they stand, saved and loaded into a third that was made like them: it saves as they do, and after some ticks
 * of all three it still does.
 */
void revive(game *g)
{
    const unsigned ticks = 1 + take(&g->program) % 3;
    const double cost = ticks * model_tick_cost(&g->model);
    ration r = {.garbage = 0x5a};

    if (!can_be_copied(g) || cost > g->work)
        return;

    stf_world *third = copy_of_both(g, &r);
    claim_saves_as(third, g->save, g->save_size);
    claim(stf_world_step(third, ticks) == STF_OK);
    step_both(g, ticks);
    inspect(g);
    model_check(&g->model, third);
    if (!g->save_result)
        claim_saves_as(third, g->save, g->save_size);
    stf_world_destroy(third);
    claim(r.blocks == 0);
    g->work -= cost;
}

/* ---- snapshots ----------------------------------------------------------------------------------------------------------- */

/* Taken and restored from an odd address: no alignment is asked for. */
void snapshot(game *g)
{
    slot *s = &g->snapshots[take(&g->program) % SNAPSHOT_SLOTS];
    const unsigned eighths = take_eighths(g);

    slot_clear(s);
    g->rations[0].closed = g->rations[1].closed = true;
    begin(g, "snapshot", eighths < 8 ? 1U << STF_ERROR_BUFFER : 0);
    for (stf_world *world; (world = turn(g)) != NULL;) {
        const unsigned w = g->turns - 1;

        s->size[w] = part_of(stf_world_snapshot_size(world), eighths);
        s->bytes[w] = exact(s->size[w] + 1);
        g->result = stf_world_snapshot(world, s->bytes[w] + 1, s->size[w]);
    }
    g->rations[0].closed = g->rations[1].closed = false;
    s->is_taken = g->result == STF_OK;
    if (s->is_taken)
        model_copy(&s->then, &g->model);
}

/* Each its own, or each the other's. */
void restore(game *g)
{
    slot *s = &g->snapshots[take(&g->program) % SNAPSHOT_SLOTS];
    const unsigned eighths = take_eighths(g), from = take(&g->program) & 1;
    bool unsure;

    if (!s->is_taken)
        return;

    const unsigned refused = 1U << STF_ERROR_SNAPSHOT, faults = model_restore_faults(&g->model, &s->then, &unsure);
    g->rations[0].closed = g->rations[1].closed = true;
    begin(g, "restore", eighths < 8 ? refused : unsure ? refused | 1U << STF_OK : faults);
    for (stf_world *world; (world = turn(g)) != NULL;) {
        const unsigned w = (g->turns - 1) ^ from;
        g->result = stf_world_restore(world, s->bytes[w] + 1, part_of(s->size[w], eighths));
    }
    g->rations[0].closed = g->rations[1].closed = false;
    if (accepted(g))
        model_restore(&g->model, &s->then);
}
