/* Settings, and time. */
#include "game.h"

void set_gravity(game *g)
{
    const stf_vector gravity = take_vector(&g->program, take(&g->program) % 8 ? g->model.dimensions : 3);

    begin(g, "set_gravity", vector_faults(gravity, g->model.dimensions));
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_set_gravity(world, gravity);
    if (accepted(g))
        g->model.gravity = gravity;
}

void set_step(game *g)
{
    const double size = take_double(&g->program);
    model *m = &g->model;

    begin(g, "set_step", is_step(size, m->substeps) ? 0 : 1U << STF_ERROR_STEP);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_set_step(world, size);
    if (!accepted(g) || size == m->step)
        return;
    m->step_start_time = model_time(m);
    m->step_start_tick = m->ticks;
    m->step = size;
}

void set_substeps(game *g)
{
    const unsigned byte = take(&g->program), substeps = byte < 250 ? byte % 5 : 0xffffffffU >> (byte - 250);
    model *m = &g->model;
    const bool is_count = substeps > 0 && substeps <= STF_SUBSTEPS_MAX;
    const unsigned faults = !is_count ? 1U << STF_ERROR_SUBSTEPS : is_step(m->step, substeps) ? 0 : 1U << STF_ERROR_STEP;

    begin(g, "set_substeps", faults);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_set_substeps(world, substeps);
    if (accepted(g))
        m->substeps = substeps;
}

void set_integrator(game *g)
{
    const unsigned which = take(&g->program) % INTEGRATORS;

    begin(g, "set_integrator", is_refused(which, g->model.compensated) ? 1U << STF_ERROR_DESCRIPTOR : 0);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_set_integrator(world, integrators[which]);
    if (accepted(g))
        g->model.integrator = integrators[which];
}

static void remember_positions(model *m, const stf_world *world)
{
    for (size_t i = 0; i < m->count; i++) {
        stf_particle p;

        claim(stf_world_get(world, i, &p) == STF_OK);
        m->particles[i].previous = p.position;
    }
}

/* A guard reports what is not finite, or beyond a bound, once, and changes no bit. */
static stf_result step_watched(stf_world *world, unsigned ticks)
{
    const bool was_reported = stf_world_fault(world, NULL);
    const stf_result result = stf_world_step(world, ticks);
    stf_fault fault;

    if (result != STF_ERROR_DIVERGED)
        return result;
    claim(!was_reported && stf_world_fault(world, &fault) && fault.kind != STF_FAULT_NONE);
    claim(fault.kind >= STF_FAULT_VELOCITY_BOUND || stf_world_find_non_finite(world, NULL));
    claim(fault.kind != STF_FAULT_VELOCITY_BOUND || stf_world_guard(world).velocity_bound > 0);
    claim(fault.kind != STF_FAULT_POSITION_BOUND || stf_world_guard(world).position_bound > 0);
    claim(fault.particle < stf_world_count(world) && fault.tick <= stf_world_ticks(world));
    return STF_OK;
}

/* All ticks in one call, or one tick a call: the bits may not tell which. No step allocates. */
void step_both(game *g, unsigned ticks)
{
    g->rations[0].closed = g->rations[1].closed = true;
    begin(g, "step", 0);
    for (stf_world *world; (world = turn(g)) != NULL;) {
        const unsigned calls = g->turns == 2 && g->model.count > 0 && ticks > 0 ? ticks : 1;

        for (unsigned n = 0; n < calls; n++) {
            if (n + 1 == calls && g->turns == 2 && ticks > 0)
                remember_positions(&g->model, world);
            g->result = step_watched(world, calls > 1 ? 1 : ticks);
        }
    }
    g->rations[0].closed = g->rations[1].closed = false;
    g->changed = ticks > 0;
    model_step(&g->model, g->worlds[0], ticks);
}

void step(game *g)
{
    const unsigned ticks = take(&g->program) % 7;
    const double cost = ticks * model_tick_cost(&g->model);

    if (cost > g->work)
        return;
    g->work -= cost;
    step_both(g, ticks);
}

/* Ages pass, where there is nothing to move. */
void leap(game *g)
{
    if (g->model.count == 0)
        step_both(g, 0x7fffffffU + take(&g->program));
}

void fail_next(game *g) { g->fail_next = 1 + take(&g->program) % 8; }
