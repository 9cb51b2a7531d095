#include "scene.h"

#include <math.h>

/* Mostly from 0 to 1; else an extreme, or any bits. */
static stf_real number(program *p)
{
    const double x = take_double(p), most = (double)REAL_MAX;

    return fabs(x) <= most ? (stf_real)x : x > 0 ? (stf_real)INFINITY : x < 0 ? -(stf_real)INFINITY : (stf_real)NAN;
}

static stf_result add_particle(program *p, unsigned dimensions, stf_world *world)
{
    const unsigned mass = take(p);
    stf_particle particle = {.position.x = number(p), .velocity.x = number(p), .inverse_mass = (stf_real)(mass % 4)};

    if (dimensions > 1)
        particle.position.y = number(p);
    return stf_world_add(world, &particle, NULL);
}

static stf_result add_some_force(program *p, unsigned which, stf_world *world)
{
    const stf_real x = number(p), y = number(p);

    switch (which) {
    case 0: return stf_world_add_force(world, &stf_force_linear_drag, &(stf_linear_drag){x}, 1, NULL);
    case 1: return stf_world_add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){x}, 1, NULL);
    case 2: return stf_world_add_force(world, &stf_force_attractor, &(stf_attractor){.strength = x, .softening = y}, 1, NULL);
    case 3:
        return stf_world_add_force(world, &stf_force_anchored_springs,
                                   &(stf_anchored_spring){.stiffness = 100 * x, .rest_length = y}, 1, NULL);
    case 4:
        return stf_world_add_force(world, &stf_force_springs, &(stf_spring){.a = 1, .stiffness = 100 * x, .damping = y}, 1,
                                   NULL);
    default: return stf_world_add_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){x, y}, 1, NULL);
    }
}

static stf_result populate(const scene *s, program *p, unsigned forces, stf_world *world)
{
    stf_result result = STF_OK;

    for (unsigned i = 0; i < s->particles && !result; i++)
        result = add_particle(p, stf_world_dimensions(world), world);
    for (unsigned i = 0; i < forces && !result; i++)
        result = add_some_force(p, take(p) % 8, world);
    return result;
}

stf_result scene_build(void *user, stf_world **world)
{
    scene *s = user;
    program p = s->program;
    const unsigned shape = take(&p);
    const stf_world_def def = {.dimensions = 1 + (shape + s->more_dimensions) % 3,
                               .keep_previous = (shape & 32) != 0,
                               .compensated = (shape & 64) != 0,
                               .guard.mode = shape & 128 ? (shape & 32 ? STF_GUARD_FREEZE : STF_GUARD_REPORT) : STF_GUARD_OFF,
                               .gravity.x = number(&p),
                               .allocator = ration_allocator(s->ration)};
    stf_world *made;

    s->particles = (shape >> 2) % (SCENE_PARTICLES_MAX + 1) + s->more_particles;
    s->is_compensated = def.compensated;
    s->result = stf_world_create(&def, &made);
    if (s->result)
        return s->result;
    s->result = populate(s, &p, 1 + (shape >> 4 & 1), made);
    if (s->result)
        stf_world_destroy(made);
    else
        *world = made;
    return s->result;
}
