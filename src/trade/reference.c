/* References exist once, whatever the precision of what they judge: they are computed in double. */
#define STF_DOUBLE
#include <float.h>
#include <limits.h>
#include <math.h>

#include "../allocator.h"
#include "reference.h"

#define DEFAULT_SAMPLES 256
#define DEFAULT_ACCELERATIONS 1000000
#define EXACT_ULPS 64

/* Halving the step gains a factor of 256, or 2 at least where forces are not smooth. A run that gains less, and differs by so
   small a part of the reach, is at its round-off. */
#define LEAST_GAIN 2
#define ROUND_OFF 1e-9

/* The scene without its guard, which is no part of what it models. */
static stf_result build(const stf_trade_reference_def *def, stf_world **world)
{
    const stf_result result = def->build(def->user, world);

    return result ? result : stf_world_set_guard(*world, (stf_guard){.mode = STF_GUARD_OFF}); /* allocates nothing */
}

/* ---- the exact solution ---------------------------------------------------------------------------------------------- */

/* *known: whether it is there for every particle. */
static stf_result place_exactly(const stf_trade_reference_def *def, stf_world *world, double time, bool *known)
{
    stf_result result = STF_OK;

    *known = true;
    for (size_t i = 0; i < stf_world_count(world) && *known && !result; i++) {
        double x[STF_DIMENSIONS_MAX] = {0}, v[STF_DIMENSIONS_MAX] = {0};
        stf_particle p;

        *known = def->exact(def->user, i, time, x, v);
        result = stf_world_get(world, i, &p);
        p.position = (stf_vector){x[0], x[1], x[2]};
        p.velocity = (stf_vector){v[0], v[1], v[2]};
        if (*known && !result)
            result = stf_world_set(world, i, &p);
    }
    return result;
}

static stf_result follow_exactly(stf_trade_reference *r, const stf_trade_reference_def *def, stf_world *world, bool *known)
{
    stf_result result = stf_world_set_step(world, r->duration / r->samples);

    *known = true;
    for (unsigned k = 0; k <= r->samples && *known && !result; k++) {
        /* A tick moves the world's time on, for potentials that depend on it; where it leaves the particles does not matter. */
        result = k > 0 ? stf_world_step(world, 1) : STF_OK;
        if (!result)
            result = place_exactly(def, world, r->duration * ((double)k / r->samples), known);
        if (!result)
            stf_trade_path_record(r, &r->path, k, world);
    }
    return result;
}

/* A position that is off by d has a force, and within the reach an energy, that is off by some d / reach of all energy. */
static void state_round_off(stf_trade_reference *r)
{
    double energy = 0, momentum = 0;
    const double still[STF_DIMENSIONS_MAX] = {0}, ulps = EXACT_ULPS * DBL_EPSILON;

    for (unsigned k = 0; k <= r->samples; k++) {
        energy = fmax(energy, fabs(r->path.energy[k]));
        momentum = fmax(momentum, stf_trade_distance(r->path.momentum + (size_t)k * STF_DIMENSIONS_MAX, still));
    }
    r->accuracy = (stf_trade_accuracy){.error = ulps * (r->accuracy.reach + stf_trade_distance(r->middle, still)),
                                       .energy = ulps * energy,
                                       .momentum = ulps * momentum,
                                       .exact = true,
                                       .reach = r->accuracy.reach};
}

/* ---- a run ----------------------------------------------------------------------------------------------------------- */

static stf_result run(const stf_trade_reference *r, const stf_trade_reference_def *def, unsigned steps, stf_trade_path *path)
{
    stf_world *world;
    stf_result result = build(def, &world);
    if (result)
        return result;

    result = stf_world_set_integrator(world, &stf_trade_extrapolation);
    if (!result)
        result = stf_world_set_substeps(world, 1);
    if (!result)
        result = stf_world_set_step(world, r->duration / steps);
    for (unsigned k = 0; k <= r->samples && !result; k++) {
        stf_world_step(world, k > 0 ? steps / r->samples : 0);
        stf_trade_path_record(r, path, k, world);
    }
    stf_world_destroy(world);
    return result;
}

/* Halves the step until that changes nothing any more, or too little to matter, or all that may be spent is. */
static stf_result refine(stf_trade_reference *r, const stf_trade_reference_def *def)
{
    const uint64_t most = def->accelerations > 0 ? def->accelerations : DEFAULT_ACCELERATIONS;
    const uint64_t a_step = (uint64_t)stf_trade_extrapolation.evaluations;
    stf_trade_path coarse;
    uint64_t spent = 0;
    double before = HUGE_VAL;

    stf_result result = stf_trade_path_allocate(r, &coarse);
    if (result)
        return result;
    r->accuracy = (stf_trade_accuracy){.error = HUGE_VAL, .energy = HUGE_VAL, .momentum = HUGE_VAL};
    for (unsigned steps = r->samples; !result; steps *= 2) {
        const stf_trade_path finer = coarse;

        coarse = r->path;
        r->path = finer;
        result = run(r, def, steps, &r->path);
        spent += a_step * steps;
        r->accuracy.steps = steps;
        stf_trade_path_reach(r);
        if (!result && steps > r->samples) {
            before = r->accuracy.error;
            stf_trade_path_compare(r, &coarse, &r->path, &r->accuracy);
        }
        const bool settled = before < ROUND_OFF * r->accuracy.reach && r->accuracy.error > before / LEAST_GAIN;
        if (settled)
            r->accuracy.error = fmax(r->accuracy.error, before);
        if (settled || r->accuracy.error <= def->error || steps > UINT_MAX / 2 || spent + 2 * a_step * steps > most)
            break;
    }
    stf_trade_path_release(r, &coarse);
    return result;
}

/* ---- both ------------------------------------------------------------------------------------------------------------ */

static size_t count_movable(const stf_world *world)
{
    const stf_particles all = stf_world_view(world);
    size_t movable = 0;

    for (size_t i = 0; i < all.count; i++)
        movable += all.inverse_mass[i] > 0;
    return movable;
}

static stf_result fill(stf_trade_reference *r, const stf_trade_reference_def *def, stf_world *world)
{
    bool known = false;
    const stf_result bad = def->exact ? follow_exactly(r, def, world, &known) : STF_OK;

    if (bad)
        return bad;
    if (!known)
        return refine(r, def);
    stf_trade_path_reach(r);
    state_round_off(r);
    return STF_OK;
}

stf_result stf_trade_reference_create(const stf_trade_reference_def *def, stf_trade_reference **reference)
{
    stf_trade_reference *r = NULL;
    stf_allocator allocator;
    stf_world *world;

    if (!def || !reference || !def->build)
        return STF_ERROR_NULL;
    if (!(def->duration > 0 && def->duration <= DBL_MAX) || !(def->error >= 0))
        return STF_ERROR_STEP;
    if (!stf_allocator_complete(def->allocator, &allocator))
        return STF_ERROR_DESCRIPTOR;

    stf_result result = build(def, &world);
    if (result)
        return result;
    r = stf_allocator_allocate(&allocator, sizeof *r);
    if (r) {
        *r = (stf_trade_reference){.allocator = allocator,
                                   .particles = stf_world_count(world),
                                   .movable = count_movable(world),
                                   .dimensions = stf_world_dimensions(world),
                                   .samples = def->samples > 0 ? def->samples : DEFAULT_SAMPLES,
                                   .duration = def->duration};
        result = stf_trade_path_allocate(r, &r->path);
        if (!result)
            result = fill(r, def, world);
    } else
        result = STF_ERROR_MEMORY;
    stf_world_destroy(world);
    if (result)
        stf_trade_reference_destroy(r);
    else
        *reference = r;
    return result;
}

void stf_trade_reference_destroy(stf_trade_reference *reference)
{
    if (!reference)
        return;

    const stf_allocator allocator = reference->allocator;

    stf_trade_path_release(reference, &reference->path);
    stf_allocator_release(&allocator, reference, sizeof *reference);
}

stf_trade_accuracy stf_trade_reference_accuracy(const stf_trade_reference *reference)
{
    return reference ? reference->accuracy : (stf_trade_accuracy){0};
}
