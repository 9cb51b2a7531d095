/* What changes a world: particles, forces, settings, time. */
#include <stdlib.h>
#include <string.h>

#include "game.h"

/* ---- particles --------------------------------------------------------------------------------------------------------- */

static stf_particle take_particle(game *g)
{
    program *p = &g->program;
    const unsigned how = take(p), dimensions = (how & 15) == 15 ? 3 : g->model.dimensions;
    stf_particle particle = {.position = take_vector(p, dimensions)};

    if (how & 16)
        particle.velocity = take_vector(p, dimensions);
    if (how & 32)
        particle.inverse_mass = take_real(p);
    else
        particle.inverse_mass = (how & 64) != 0;
    if (how & 128)
        particle.radius = take_real(p);
    return particle;
}

/* As a world keeps it: what it does not keep is 0. */
static struct model_particle kept(const model *m, stf_particle p)
{
    if (m->dimensions < 3)
        p.position.z = p.velocity.z = 0;
    if (m->dimensions < 2)
        p.position.y = p.velocity.y = 0;
    if (!m->keep_radius)
        p.radius = 0;
    return (struct model_particle){.now = p, .previous = p.position};
}

static void add_these(game *g, const char *name, const stf_particle *particles, size_t count, unsigned faults)
{
    model *m = &g->model;
    size_t first = SIZE_MAX;

    begin(g, name, faults);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = count == 1 ? stf_world_add(world, particles, &first) : stf_world_add_many(world, particles, count, &first);
    if (!accepted(g))
        return;
    claim(first == m->count);
    for (size_t i = 0; i < count; i++)
        m->particles[m->count++] = kept(m, particles[i]);
}

void add(game *g)
{
    const size_t count = take(&g->program) % 9;
    stf_particle *particles = exact(count * sizeof *particles);
    unsigned faults = 0;

    for (size_t i = 0; i < count; i++) {
        particles[i] = take_particle(g);
        faults |= particle_faults(&particles[i], g->model.dimensions, g->model.keep_radius);
    }
    if (g->model.count + count <= MODEL_PARTICLES)
        add_these(g, "add", particles, count, faults);
    free(particles);
}

/* Enough for several blocks, and once for several parts of many blocks. */
void add_crowd(game *g)
{
    const unsigned byte = take(&g->program);
    const size_t count = byte < 200 ? 20 : byte < 240 ? 70 : byte < 255 ? 300 : MODEL_PARTICLES - g->model.count;
    uint32_t state = byte;

    if (g->had_crowd || g->model.count + count > MODEL_PARTICLES)
        return;

    stf_particle *particles = exact(count * sizeof *particles);
    for (size_t i = 0; i < count; i++) {
        state = state * 1664525 + 1013904223; /* W. H. Press et al., Numerical Recipes, 3rd ed., 7.1 */
        particles[i] = (stf_particle){.position.x = (stf_real)(state >> 16), .velocity.x = (stf_real)(state >> 28),
                                      .inverse_mass = (stf_real)(state >> 8 & 3)};
    }
    g->had_crowd = true;
    add_these(g, "add_many", particles, count, 0);
    free(particles);
}

void set(game *g)
{
    const size_t index = take_index(g);
    const stf_particle particle = take_particle(g);
    model *m = &g->model;

    begin(g, "set", index >= m->count ? 1U << STF_ERROR_PARTICLE : particle_faults(&particle, m->dimensions, m->keep_radius));
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_set(world, index, &particle);
    if (!accepted(g))
        return;

    const struct model_particle before = m->particles[index], now = kept(m, particle);
    const stf_vector a = before.now.position, b = now.now.position;
    m->particles[index] = now;
    if (a.x == b.x && a.y == b.y && a.z == b.z)
        m->particles[index].previous = before.previous;
}

void remove_particle(game *g)
{
    const size_t index = take_index(g);
    size_t moved = SIZE_MAX;

    begin(g, "remove", index >= g->model.count ? 1U << STF_ERROR_PARTICLE : 0);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_remove(world, index, &moved);
    if (!accepted(g))
        return;
    claim(moved == g->model.count - 1);
    model_remove(&g->model, index);
}

void clear(game *g)
{
    begin(g, "clear", 0);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_clear(world);
    if (accepted(g))
        model_clear(&g->model);
}

void reserve(game *g)
{
    const unsigned byte = take(&g->program);
    const bool is_much = byte >= 250;
    const size_t capacity = is_much ? SIZE_MAX >> (byte - 250) * 4 : byte * 3;

    begin(g, "reserve", is_much ? 1U << STF_ERROR_MEMORY : 0);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_reserve(world, capacity);
    accepted(g);
}

/* ---- forces ------------------------------------------------------------------------------------------------------------ */

static stf_force_id take_id(game *g)
{
    const unsigned byte = take(&g->program);

    return byte < 240 && g->model.force_count > 0 ? g->model.forces[byte % g->model.force_count].id : byte & 15;
}

/* In memory of exactly their size. */
static unsigned char *take_records(game *g, const subject *s, size_t count, unsigned *faults)
{
    const size_t size = s->force->record_size;
    unsigned char *records = exact(count * size);

    *faults = size == 0 && count > 0 ? 1U << STF_ERROR_PARAMETERS : 0;
    for (size_t i = 0; i < count && size > 0; i++) {
        take_record(&g->program, s, g->model.dimensions, g->model.count, records + i * size);
        *faults |= record_faults(s, records + i * size, g->model.dimensions, g->model.count);
    }
    return records;
}

/* So many that runs of springs come about: from one record, each next one's indices are one higher. */
static void spread_records(game *g, const subject *s, unsigned char *records, size_t count, unsigned *faults)
{
    const size_t size = s->force->record_size, indices = strspn(s->layout, "i");

    for (size_t i = 1; i < count; i++) {
        memcpy(records + i * size, records, size);
        for (size_t k = 0; k < indices; k++) {
            uint32_t index;
            memcpy(&index, records + k * sizeof index, sizeof index);
            index += (uint32_t)i;
            memcpy(records + i * size + k * sizeof index, &index, sizeof index);
        }
        *faults |= record_faults(s, records + i * size, g->model.dimensions, g->model.count);
    }
}

/* Records for a force, and how many; *faults is what may be said against them. */
static unsigned char *take_many_records(game *g, const subject *s, size_t *count, unsigned *faults)
{
    const unsigned byte = take(&g->program);
    const bool spread = byte >= 200 && s->force->record_size > 0;
    unsigned char *records = take_records(g, s, spread ? 1 : byte % 5, faults);

    *count = spread ? byte - 200 < MODEL_RECORDS ? byte - 200 + 1 : MODEL_RECORDS : byte % 5;
    if (!spread)
        return records;

    unsigned char *many = exact(*count * s->force->record_size);
    memcpy(many, records, s->force->record_size);
    spread_records(g, s, many, *count, faults);
    free(records);
    return many;
}

void add_force(game *g)
{
    const subject *s = &subjects[take(&g->program) % SUBJECTS];
    unsigned faults = 1U << STF_ERROR_DESCRIPTOR;
    size_t count = 0;
    unsigned char *records = s->layout ? take_many_records(g, s, &count, &faults) : NULL;
    stf_force_id id = 0;

    if (g->model.force_count < MODEL_FORCES) {
        begin(g, s->force->name ? s->force->name : "nameless", faults);
        for (stf_world *world; (world = turn(g)) != NULL;)
            g->result = stf_world_add_force(world, s->force, count ? records : NULL, count, &id);
        if (accepted(g)) {
            model_add_force(&g->model, s, records, count);
            claim(id == g->model.last_id);
        }
    }
    free(records);
}

void set_force(game *g)
{
    const stf_force_id id = take_id(g);
    model_force *force = model_find(&g->model, id);
    unsigned faults = 1U << STF_ERROR_FORCE;
    size_t count = 0;
    unsigned char *records = force ? take_many_records(g, force->subject, &count, &faults) : NULL;

    begin(g, "set_force", faults);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_set_force(world, id, count ? records : NULL, count);
    if (accepted(g))
        model_set_records(force, records, count);
    free(records);
}

static const char *own_records(const stf_world *world, stf_force_id id) { return stf_world_force_records(world, id, NULL); }

/* Some of the records that the world itself has. */
void set_own_records(game *g)
{
    const stf_force_id id = take_id(g);
    model_force *force = model_find(&g->model, id);
    const size_t size = force ? force->subject->force->record_size : 0;

    if (!force || force->count == 0)
        return;

    const size_t first = take(&g->program) % force->count, count = force->count - first;
    unsigned char *records = exact(count * size);

    memcpy(records, own_records(g->worlds[0], id) + first * size, count * size);
    begin(g, "set_own_records", 0);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_set_force(world, id, own_records(world, id) + first * size, count);
    if (accepted(g))
        model_set_records(force, records, count);
    free(records);
}

void remove_force(game *g)
{
    const stf_force_id id = take_id(g);

    begin(g, "remove_force", model_find(&g->model, id) ? 0 : 1U << STF_ERROR_FORCE);
    for (stf_world *world; (world = turn(g)) != NULL;)
        g->result = stf_world_remove_force(world, id);
    if (accepted(g))
        model_remove_force(&g->model, id);
}
