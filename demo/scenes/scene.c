#include "scene.h"

#include <math.h>
#include <string.h>

const scene *const scenes[] = {
    &scene_drag, &scene_volley, &scene_oscillator,   &scene_kepler,
    &scene_rope, &scene_cloth,  &scene_solar_system, NULL,
};

const scene *scene_find(const char *name)
{
    for (const scene *const *each = scenes; name && *each; each++)
        if (strcmp((*each)->name, name) == 0)
            return *each;
    return NULL;
}

stf_result scene_create(const scene *s, const stf_world_def *overrides, stf_world **world)
{
    stf_world_def def = overrides ? *overrides : (stf_world_def){0};

    def.dimensions = s->dimensions;
    def.gravity = s->gravity;
    if (!def.integrator)
        def.integrator = s->integrator;
    if (def.step == 0)
        def.step = s->step;

    stf_world *made;
    stf_result result = stf_world_create(&def, &made);
    if (result)
        return result;

    result = s->populate(made);
    if (result) {
        stf_world_destroy(made);
        return result;
    }
    *world = made;
    return STF_OK;
}

double scene_error(const scene *s, const stf_world *world)
{
    const double time = stf_world_time(world);
    double sum = 0, position[3] = {0}, velocity[3] = {0};
    size_t known = 0;

    for (size_t i = 0; s->exact && i < stf_world_count(world); i++) {
        stf_particle particle;

        if (stf_world_get(world, i, &particle) || !s->exact(i, time, position, velocity))
            continue;
        const double dx = (double)particle.position.x - position[0], dy = (double)particle.position.y - position[1];
        const double dz = (double)particle.position.z - position[2];
        sum += dx * dx + dy * dy + dz * dz;
        known++;
    }
    return known > 0 ? sqrt(sum / (double)known) : (double)NAN;
}
