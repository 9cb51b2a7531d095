/* What only looks at worlds, and what makes others for a moment. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "game.h"

static bool is_same_double(double a, double b) { return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b)); }

static void claim_same_sums(game *g)
{
    stf_energy energy[2];
    double momentum[2][STF_DIMENSIONS_MAX];

    for (unsigned w = 0; w < 2; w++) {
        claim(stf_world_energy(g->worlds[w], &energy[w]) == STF_OK);
        claim(stf_world_momentum(g->worlds[w], momentum[w]) == STF_OK);
    }
    claim(is_same_double(energy[0].kinetic, energy[1].kinetic) && is_same_double(energy[0].potential, energy[1].potential));
    claim(!(energy[0].kinetic < 0));
    for (unsigned d = 0; d < STF_DIMENSIONS_MAX; d++)
        claim(is_same_double(momentum[0][d], momentum[1][d]));
}

static void claim_non_finite(const game *g, const stf_world *world)
{
    size_t first = 0, found = SIZE_MAX;

    while (first < g->model.count && !vector_faults(g->model.particles[first].now.position, 3) &&
           !vector_faults(g->model.particles[first].now.velocity, 3))
        first++;
    claim(stf_world_find_non_finite(world, &found) == (first < g->model.count));
    claim(found == (first < g->model.count ? first : SIZE_MAX));
}

static void claim_view(const game *g, const stf_world *world)
{
    const stf_particles all = stf_world_view(world);

    claim(all.count == g->model.count && all.first == 0 && all.force == NULL && all.dimensions == g->model.dimensions);
    claim(all.stride == (size_t)1 << all.shift && all.stride <= STF_BLOCK_MAX);
    for (size_t i = 0; i < all.count; i++) {
        const stf_particle *p = &g->model.particles[i].now;
        const size_t at = stf_particles_offset(&all, i);

        claim(is_same_real(all.position[at], p->position.x) && is_same_real(all.velocity[at], p->velocity.x));
        claim(is_same_real(all.inverse_mass[i], p->inverse_mass));
        claim(all.dimensions < 3 || is_same_real(all.position[at + 2 * all.stride], p->position.z));
    }
    for (size_t i = all.count; (i & (all.stride - 1)) != 0; i++) { /* what belongs to no particle is 0 */
        const size_t at = stf_particles_offset(&all, i);

        claim(all.position[at] == 0 && all.velocity[at] == 0 && all.inverse_mass[i] == 0);
    }
}

static void claim_description(game *g, const stf_world *world)
{
    const size_t size = (size_t)take(&g->program) * 8;
    char whole[8192], *part = exact(size);
    const size_t length = stf_world_describe(world, whole, sizeof whole);

    claim(length > 0 && length < sizeof whole && strlen(whole) == length);
    claim(stf_world_describe(world, size ? part : NULL, size) == length);
    if (size > 0) {
        const size_t kept = length < size ? length : size - 1;
        claim(strlen(part) == kept && memcmp(part, whole, kept) == 0);
    }
    free(part);
}

void ask(game *g)
{
    for (unsigned w = 0; w < 2; w++) {
        claim(strstr("avx512 avx2 baseline", stf_world_isa(g->worlds[w])));
        claim_non_finite(g, g->worlds[w]);
        claim_view(g, g->worlds[w]);
        claim_description(g, g->worlds[w]);
    }
    if (model_tick_cost(&g->model) > g->work)
        return;
    claim_same_sums(g);
    g->work -= model_tick_cost(&g->model);
}

/* ---- positions ---------------------------------------------------------------------------------------------------------- */

static float component(stf_vector v, unsigned d) { return (float)(d == 0 ? v.x : d == 1 ? v.y : v.z); }

/* What both worlds wrote is the same; at alpha 0 and 1 it is the state before, and now; between the floats nothing was. */
static void claim_positions(const model *m, double alpha, const unsigned char *a, const unsigned char *b, size_t stride)
{
    const size_t row = m->dimensions * sizeof(float), apart = stride ? stride : row;

    for (size_t i = 0; i < m->count; i++) {
        for (unsigned d = 0; d < m->dimensions; d++) {
            const stf_vector previous = m->particles[i].previous, now = m->particles[i].now.position;
            const size_t at = i * apart + d * sizeof(float);
            const float expected = component(alpha > 0 ? now : previous, d);
            float x, y;

            memcpy(&x, a + at, sizeof x);
            memcpy(&y, b + at, sizeof y);
            claim(memcmp(&x, &y, sizeof x) == 0 || (isnan(x) && isnan(y)));
            claim((alpha > 0 && alpha < 1) || (isfinite(expected) ? x == expected : !isfinite(x)));
        }
        for (size_t k = row; k < apart && i + 1 < m->count; k++)
            claim(a[i * apart + k] == 0x77 && b[i * apart + k] == 0x77);
    }
}

void copy_positions(game *g)
{
    static const double alphas[] = {0, 1, 0.5, 0.25, -0.0, -1e-9, 1.0000001, 0.999};
    const unsigned byte = take(&g->program), extra = take(&g->program);
    const double alpha = byte < 250 ? alphas[byte % COUNT_OF(alphas)] : take_double(&g->program);
    const size_t row = g->model.dimensions * sizeof(float);
    const size_t stride = extra < 10 ? 0 : extra < 15 ? extra % row : row + extra % 40;
    const size_t size = g->model.count ? (g->model.count - 1) * (stride ? stride : row) + row : 0;
    unsigned char *copies[2] = {exact(size), exact(size)};
    unsigned faults = alpha >= 0 && alpha <= 1 ? 0 : 1U << STF_ERROR_ALPHA;

    if (alpha < 1 && !g->model.keep_previous)
        faults |= 1U << STF_ERROR_NO_PREVIOUS;
    if (stride > 0 && stride < row)
        faults |= 1U << STF_ERROR_STRIDE;
    begin(g, "copy_positions", faults);
    for (stf_world *world; (world = turn(g)) != NULL;) {
        unsigned char *to = copies[g->turns - 1];
        if (size > 0)
            memset(to, 0x77, size);
        g->result = stf_world_copy_positions(world, alpha, to, stride);
    }
    if (g->result == STF_OK)
        claim_positions(&g->model, alpha, copies[0], copies[1], stride);
    free(copies[0]);
    free(copies[1]);
}

/* ---- accelerations ------------------------------------------------------------------------------------------------------ */

/* Both worlds' accelerations where they stand, but up to 16 s later; the immovable have none. */
void accelerations(game *g)
{
    const double time = model_time(&g->model) + take(&g->program) / 16.0, cost = model_tick_cost(&g->model);
    const bool is_time = isfinite(time); /* ticks may have gone past all doubles */
    stf_particles views[2];
    stf_real *found[2];

    if (cost > g->work)
        return;
    g->work -= cost;
    begin(g, "accelerations", is_time ? 0 : 1U << STF_ERROR_NOT_FINITE);
    g->rations[0].closed = g->rations[1].closed = true;
    for (stf_world *world; (world = turn(g)) != NULL;) {
        const unsigned w = g->turns - 1;
        const stf_particles *v = &views[w];

        views[w] = stf_world_view(world);
        const size_t blocks = (v->count + v->stride - 1) >> v->shift, reals = blocks * v->stride * v->dimensions;
        found[w] = exact(reals * sizeof(stf_real));
        g->result = stf_world_accelerations(world, time, v->position, v->velocity, found[w]);
    }
    g->rations[0].closed = g->rations[1].closed = false;
    for (size_t i = 0; i < g->model.count && is_time; i++)
        for (unsigned d = 0; d < g->model.dimensions; d++) {
            const stf_real a = found[0][stf_particles_offset(&views[0], i) + d * views[0].stride];
            claim(is_same_real(a, found[1][stf_particles_offset(&views[1], i) + d * views[1].stride]));
            claim(g->model.particles[i].now.inverse_mass > 0 || a == 0);
        }
    free(found[0]);
    free(found[1]);
}

/*
 * Once a program: it is dear. The same world twice: another room moves the noise that it starts from, and with it the last
 * digits.
 */
void measure_stability(game *g)
{
    const unsigned fail_in = take(&g->program) % 16, most = take(&g->program);
    stf_stability found[2];
    stf_result results[2];

    if (g->had_stability || g->model.count > 6)
        return;
    g->had_stability = true;
    for (unsigned k = 0; k < 2; k++) {
        ration r = {.garbage = k ? 0xff : 0x41, .fail_in = fail_in};
        const stf_stability_def def = {.allocator = ration_allocator(&r), .accelerations = most};

        results[k] = stf_stability_measure(g->worlds[0], &def, &found[k]);
        claim(r.refused ? results[k] == STF_ERROR_MEMORY : results[k] == STF_OK || results[k] == STF_ERROR_NOT_FINITE);
        claim(r.blocks == 0);
    }
    claim(results[0] == results[1]);
    if (results[0])
        return;
    claim(is_same_double(found[0].limit, found[1].limit) && found[0].limit >= 0);
    claim(is_same_double(found[0].load, found[1].load) && found[0].substeps == found[1].substeps);
    claim(found[0].accelerations <= STF_STABILITY_ACCELERATIONS_MAX);
    claim(found[0].particle < g->model.count || found[0].particle == SIZE_MAX);
    claim(found[0].force == 0 || model_find(&g->model, found[0].force));
}

/* ---- other worlds ------------------------------------------------------------------------------------------------------- */

/* A def of any kind: what is wrong with it is said, and an allocation that fails leaves nothing behind. */
void create(game *g)
{
    program *p = &g->program;
    const unsigned bits = take(p), which = take(p) % INTEGRATORS, substeps = take(p);
    ration r = {.garbage = 0x41, .fail_in = take(p) % 4};
    stf_world_def def = {.dimensions = bits & 7, .integrator = integrators[which], .substeps = substeps % 4,
                         .step = take_double(p), .gravity = take_vector(p, 3), .capacity = take(p),
                         .allocator = ration_allocator(&r), .keep_previous = (bits & 8) != 0,
                         .compensated = (bits & 64) != 0, .guard.mode = (stf_guard_mode)(substeps >> 2 & 3)};
    unsigned faults = is_refused(which, def.compensated) ? 1U << STF_ERROR_DESCRIPTOR : 0;
    stf_world *world = NULL;

    if (bits >= 248)
        def.allocator.release = NULL, faults |= 1U << STF_ERROR_DESCRIPTOR;
    if ((bits & 0x30) == 0x30)
        def.parallel.tasks = 2, faults |= 1U << STF_ERROR_DESCRIPTOR;
    if (def.dimensions > 3)
        faults |= 1U << STF_ERROR_DIMENSIONS;
    if (def.guard.mode > STF_GUARD_FREEZE)
        faults |= 1U << STF_ERROR_PARAMETERS;
    faults |= vector_faults(def.gravity, def.dimensions ? def.dimensions : 3);
    if (def.step != 0 && !is_step(def.step, def.substeps ? def.substeps : 1))
        faults |= 1U << STF_ERROR_STEP;

    const stf_result result = stf_world_create(&def, &world);
    claim(faults ? (faults >> result & 1) != 0 : result == (r.refused ? STF_ERROR_MEMORY : STF_OK));
    claim((result == STF_OK) == (world != NULL));
    stf_world_destroy(world);
    claim(r.blocks == 0);
}

void pass_null(game *g)
{
    stf_world *world = g->worlds[0];
    stf_particle particle;

    claim(stf_world_step(NULL, 1) == STF_ERROR_NULL && stf_world_add(world, NULL, NULL) == STF_ERROR_NULL);
    claim(stf_world_load(world, NULL, 8, NULL) == STF_ERROR_NULL && stf_world_get(NULL, 0, &particle) == STF_ERROR_NULL);
    claim(stf_world_set_integrator(world, NULL) == STF_ERROR_NULL && stf_world_count(NULL) == 0);
    claim(stf_world_add_force(world, NULL, NULL, 0, NULL) == STF_ERROR_NULL && stf_world_force_at(NULL, 0) == 0);
    claim(stf_world_restore(world, NULL, 64) == STF_ERROR_NULL && stf_world_save(world, NULL, 64) == STF_ERROR_NULL);
    claim(stf_result_text((stf_result)take(&g->program)) != NULL);
    claim(stf_integrator_find(NULL) == NULL && stf_world_isa(NULL) == NULL && !stf_world_fault(NULL, NULL));
    claim(stf_integrator_find(stf_rk4.name) == &stf_rk4 && stf_world_clear_fault(NULL) == STF_ERROR_NULL);
    claim(stf_version()[0] != 0 && stf_world_guard(NULL).mode == STF_GUARD_OFF);
}
