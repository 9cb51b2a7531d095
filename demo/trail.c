#include "trail.h"

#include <stdlib.h>

static stf_result record(trail *t, const stf_world *world)
{
    stf_vector *row = t->points + t->recorded % t->capacity * t->particles;

    for (size_t i = 0; i < t->particles; i++) {
        stf_particle particle;
        const stf_result bad = stf_world_get(world, i, &particle);
        if (bad)
            return bad;
        row[i] = particle.position;
    }
    t->recorded++;
    if (t->length < t->capacity)
        t->length++;
    return STF_OK;
}

stf_result trail_open(trail *t, const stf_world *world, double ticks)
{
    const size_t particles = stf_world_count(world);

    *t = (trail){0};
    if (particles == 0 || particles > TRAIL_PARTICLES_MAX)
        return STF_OK;
    t->capacity = TRAIL_POINTS_IN_ALL / particles < TRAIL_POINTS_MAX ? TRAIL_POINTS_IN_ALL / particles : TRAIL_POINTS_MAX;
    t->points = malloc(t->capacity * particles * sizeof *t->points);
    if (!t->points)
        return STF_ERROR_MEMORY;
    t->particles = particles;
    t->stride = 1;
    if (ticks > (double)t->capacity && ticks < UINT32_MAX)
        t->stride = (unsigned)(ticks / (double)t->capacity) + 1;
    return record(t, world);
}

void trail_close(trail *t)
{
    free(t->points);
    *t = (trail){0};
}

stf_result trail_record(trail *t, const stf_world *world)
{
    return t->particles > 0 && stf_world_ticks(world) % t->stride == 0 ? record(t, world) : STF_OK;
}

stf_vector trail_point(const trail *t, size_t particle, size_t age)
{
    return t->points[(t->recorded - 1 - age) % t->capacity * t->particles + particle];
}
