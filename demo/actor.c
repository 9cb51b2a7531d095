#include "actor.h"

#include <math.h>
#include <stdlib.h>

#define TRAIL_SECONDS 5.0 /* that a trail reaches back, at the scene's own time scale */
#define TRAIL_SECONDS_OF_MANY 0.5
#define MANY_TRAILS 8

void actor_close(actor *a)
{
    stf_world_destroy(a->world);
    trail_close(&a->trail);
    free(a->drawn);
    *a = (actor){0};
}

stf_result actor_sample_energy(actor *a)
{
    energy_samples *e = &a->energy;
    stf_energy parts;

    if (!a->world || a->lost)
        return STF_OK;

    const stf_result bad = stf_world_energy(a->world, &parts);
    if (bad)
        return bad;
    e->now = parts.kinetic + parts.potential;
    if (stf_world_ticks(a->world) == 0)
        e->start = e->now;
    e->largest_change = fmax(e->largest_change, fabs(e->now - e->start));
    e->scale = fmax(e->scale, parts.kinetic + fabs(parts.potential));
    return STF_OK;
}

stf_result actor_open(actor *a, const scene *of, const stf_world_def *overrides)
{
    *a = (actor){0};
    stf_result bad = scene_create(of, overrides, &a->world);

    if (!bad) {
        const double seconds = stf_world_count(a->world) > MANY_TRAILS ? TRAIL_SECONDS_OF_MANY : TRAIL_SECONDS;
        bad = trail_open(&a->trail, a->world, seconds * of->time_scale / stf_world_step_size(a->world));
    }
    if (!bad)
        bad = actor_sample_energy(a);
    if (!bad) {
        a->drawn = calloc(stf_world_count(a->world), STF_DIMENSIONS_MAX * sizeof *a->drawn);
        bad = a->drawn ? STF_OK : STF_ERROR_MEMORY;
    }
    if (bad)
        actor_close(a);
    return bad;
}

stf_result actor_tick(actor *a, Uint64 *counts)
{
    if (!a->world || a->lost)
        return STF_OK;

    const Uint64 start = SDL_GetPerformanceCounter();
    const stf_result bad = stf_world_step(a->world, 1);
    *counts += SDL_GetPerformanceCounter() - start;
    if (bad)
        return bad;
    a->lost = stf_world_find_non_finite(a->world, &a->lost_particle);
    return trail_record(&a->trail, a->world);
}

double actor_distance(const actor *a, const actor *b)
{
    const size_t count = stf_world_count(a->world);
    double sum = 0;

    for (size_t i = 0; i < count; i++) {
        stf_particle p, q;
        if (stf_world_get(a->world, i, &p) || stf_world_get(b->world, i, &q))
            return (double)NAN;
        const double dx = (double)p.position.x - (double)q.position.x, dy = (double)p.position.y - (double)q.position.y;
        const double dz = (double)p.position.z - (double)q.position.z;
        sum += dx * dx + dy * dy + dz * dz;
    }
    return count > 0 ? sqrt(sum / (double)count) : (double)NAN;
}
