#include "grab.h"

#include <math.h>

/*
 * How fast the hand pulls, as omega of the spring: quick to the eye, unless that is too quick for the step. Critically
 * damped at omega dt = 1/4 it has k dt = 1/2 as drag, which every integrator of the library survives twice over.
 */
#define QUICK 400.0 /* rad a second of the demo at the scene's own time scale */
#define MOST_OMEGA_DT 0.25

#define FOLLOW_SECONDS 0.06 /* that the handle lags behind the cursor: a leap of the mouse is no blow to a rope */

/* F = -k (x - anchor) - c v. Unlike the library's springs it damps motion across as well: nothing orbits the cursor. */
static void pull(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const grab_handle *handles = records;
    (void)time;

    for (size_t n = 0; n < record_count; n++) {
        const grab_handle *h = &handles[n];
        const stf_real anchor[STF_DIMENSIONS_MAX] = {h->anchor.x, h->anchor.y, h->anchor.z};

        if (h->particle < particles->first || h->particle - particles->first >= particles->count)
            continue;
        for (unsigned d = 0; d < particles->dimensions; d++) {
            const size_t i = d * particles->stride + (h->particle - particles->first);
            particles->force[i] -=
                h->stiffness * (particles->position[i] - anchor[d]) + h->damping * particles->velocity[i];
        }
    }
}

static stf_result check(const void *record, unsigned dimensions, size_t particle_count)
{
    const grab_handle *h = record;
    (void)dimensions;

    if (h->particle >= particle_count)
        return STF_ERROR_PARTICLE;
    if (!isfinite(h->anchor.x) || !isfinite(h->anchor.y) || !isfinite(h->anchor.z))
        return STF_ERROR_NOT_FINITE;
    return isfinite(h->stiffness) && isfinite(h->damping) ? STF_OK : STF_ERROR_PARAMETERS;
}

static bool renumber(void *record, size_t removed, size_t last)
{
    grab_handle *h = record;

    if (h->particle == removed)
        return false;
    if (h->particle == last)
        h->particle = (uint32_t)removed;
    return true;
}

static const stf_force grab_force = {
    .name = "grab",
    .kind = STF_FIELD,
    .depends_on = STF_ON_POSITION | STF_ON_VELOCITY,
    .record_size = sizeof(grab_handle),
    .apply = pull,
    .check = check,
    .renumber = renumber,
};

stf_result grab_start(grab *g, session *s, size_t particle)
{
    const double substep = s->settings.step / s->settings.substeps;
    const double omega = fmin(MOST_OMEGA_DT / substep, QUICK / s->settings.scene->time_scale);
    stf_particle p;
    stf_result bad = stf_world_get(s->main.world, particle, &p);

    if (bad)
        return bad;
    *g = (grab){.active = true, .movable = p.inverse_mass > 0};
    g->handle = (grab_handle){.particle = (uint32_t)particle, .anchor = p.position};
    g->target = p.position;
    s->by_hand = true;
    if (!g->movable)
        return STF_OK;

    const double mass = 1 / (double)p.inverse_mass;
    g->handle.stiffness = (stf_real)(mass * omega * omega);
    g->handle.damping = (stf_real)(2 * mass * omega);
    bad = stf_world_add_force(s->main.world, &grab_force, &g->handle, 1, &g->main_force);
    if (!bad && s->ghost.world)
        bad = stf_world_add_force(s->ghost.world, &grab_force, &g->handle, 1, &g->ghost_force);
    return bad;
}

static stf_result teleport(stf_world *world, size_t particle, stf_vector to)
{
    stf_particle p;
    const stf_result bad = stf_world_get(world, particle, &p);

    p.position = to;
    return bad ? bad : stf_world_set(world, particle, &p);
}

stf_result grab_follow(grab *g, session *s, double seconds)
{
    const stf_real part = (stf_real)(1 - exp(-seconds / FOLLOW_SECONDS));
    stf_vector *anchor = &g->handle.anchor;
    stf_result bad = STF_OK;

    if (!g->active)
        return STF_OK;
    anchor->x += part * (g->target.x - anchor->x);
    anchor->y += part * (g->target.y - anchor->y);
    anchor->z += part * (g->target.z - anchor->z);
    if (!g->movable) {
        bad = teleport(s->main.world, g->handle.particle, *anchor);
        return bad || !s->ghost.world ? bad : teleport(s->ghost.world, g->handle.particle, *anchor);
    }
    if (g->main_force)
        bad = stf_world_set_force(s->main.world, g->main_force, &g->handle, 1);
    if (!bad && g->ghost_force)
        bad = stf_world_set_force(s->ghost.world, g->ghost_force, &g->handle, 1);
    return bad;
}

stf_result grab_end(grab *g, session *s)
{
    const grab held = *g;
    stf_result bad = STF_OK;

    *g = (grab){0};
    if (!held.active)
        return STF_OK;
    if (held.main_force)
        bad = stf_world_remove_force(s->main.world, held.main_force);
    if (held.ghost_force) {
        const stf_result ghost_bad = stf_world_remove_force(s->ghost.world, held.ghost_force);
        bad = bad ? bad : ghost_bad;
    }
    return bad;
}
