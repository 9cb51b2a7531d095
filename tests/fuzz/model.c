#include "model.h"

#include <math.h>
#include <string.h>

/* To save and read a particle costs as much as so many of its ticks. */
#define TICKS_A_LOOK 4

double model_time(const model *m)
{
    return m->step_start_time + (double)(m->ticks - m->step_start_tick) * m->step;
}

model_force *model_find(model *m, stf_force_id id)
{
    for (size_t i = 0; i < m->force_count; i++)
        if (m->forces[i].id == id)
            return &m->forces[i];
    return NULL;
}

void model_copy(model *to, const model *from)
{
    memcpy(to, from, offsetof(model, particles) + from->count * sizeof *from->particles);
}

/* ---- forces ------------------------------------------------------------------------------------------------------------ */

void model_set_records(model_force *force, const unsigned char *records, size_t count)
{
    const size_t size = force->subject->force->record_size;

    force->count = count;
    force->room = count > force->room ? count : force->room;
    for (size_t i = 0; i < count; i++)
        memcpy(force->records[i], records + i * size, size);
}

void model_add_force(model *m, const subject *s, const unsigned char *records, size_t count)
{
    model_force *force = &m->forces[m->force_count++];

    *force = (model_force){.subject = s, .id = ++m->last_id};
    model_set_records(force, records, count);
}

void model_remove_force(model *m, stf_force_id id)
{
    model_force *force = model_find(m, id);

    m->force_count--;
    memmove(force, force + 1, (size_t)(m->forces + m->force_count - force) * sizeof *force);
}

/* ---- particles --------------------------------------------------------------------------------------------------------- */

void model_remove(model *m, size_t index)
{
    const size_t last = m->count - 1;

    for (size_t f = 0; f < m->force_count; f++) {
        model_force *force = &m->forces[f];
        size_t kept = 0;

        for (size_t i = 0; i < force->count; i++)
            if (record_renumber(force->subject, force->records[i], index, last))
                memmove(force->records[kept++], force->records[i], sizeof *force->records);
        force->count = kept;
    }
    m->particles[index] = m->particles[last];
    m->count = last;
}

void model_clear(model *m)
{
    for (size_t f = 0; f < m->force_count; f++)
        if (m->forces[f].subject->layout[0] == 'i')
            m->forces[f].count = 0;
    m->count = 0;
}

/* But for what is so small that it comes to rest. */
static bool is_kept(stf_real after, stf_real before)
{
    return after == before || (after == 0 && before < STF_AT_REST && before > -STF_AT_REST);
}

/* Position Verlet keeps the distance of a step, and so a velocity but for round-off. */
static bool is_same_velocity(const model *m, stf_vector after, stf_vector before)
{
    return (is_kept(after.x, before.x) && is_kept(after.y, before.y) && is_kept(after.z, before.z)) ||
           m->integrator == &stf_position_verlet;
}

void model_step(model *m, const stf_world *world, unsigned ticks)
{
    m->ticks += ticks;
    for (size_t i = 0; i < m->count; i++) {
        const stf_particle before = m->particles[i].now;
        stf_particle after;

        claim(stf_world_get(world, i, &after) == STF_OK);
        claim(is_same_real(after.inverse_mass, before.inverse_mass) && is_same_real(after.radius, before.radius));
        claim(before.inverse_mass > 0 || is_same_velocity(m, after.velocity, before.velocity));
        m->particles[i].now = after;
    }
}

/* ---- save, load, snapshot, restore --------------------------------------------------------------------------------------- */

stf_result model_save_result(const model *m)
{
    for (size_t f = 0; f < m->force_count; f++)
        if (m->forces[f].count > 0 && !m->forces[f].subject->force->fields)
            return STF_ERROR_UNSAVABLE;
    if (!isfinite(m->step_start_time))
        return STF_ERROR_NOT_FINITE;
    for (size_t i = 0; i < m->count; i++) {
        const struct model_particle *p = &m->particles[i];
        const unsigned faults = vector_faults(p->now.position, 3) | vector_faults(p->now.velocity, 3) |
                                (m->keep_previous ? vector_faults(p->previous, 3) : 0);
        if (faults)
            return STF_ERROR_NOT_FINITE;
    }
    return STF_OK;
}

static const char *fields_of(const stf_force *force) { return force->record_size > 0 && force->fields ? force->fields : ""; }

static bool stays_here(const stf_force *force) { return strcmp(fields_of(force), STF_NOT_SAVED) == 0; }

static bool is_like(const stf_force *a, const stf_force *b)
{
    return strcmp(a->name, b->name) == 0 && a->kind == b->kind && strcmp(fields_of(a), fields_of(b)) == 0;
}

unsigned model_load_faults(const model *m, const model *saved)
{
    const unsigned mismatch = 1U << STF_ERROR_MISMATCH;
    unsigned faults = 0;

    if (m->dimensions != saved->dimensions || m->keep_previous != saved->keep_previous ||
        m->keep_radius != saved->keep_radius || m->force_count != saved->force_count ||
        strcmp(m->integrator->name, saved->integrator->name) != 0 ||
        m->integrator->history_arrays != saved->integrator->history_arrays)
        return mismatch;
    for (size_t f = 0; f < m->force_count; f++) {
        const model_force *force = &m->forces[f];

        if (!is_like(force->subject->force, saved->forces[f].subject->force))
            return mismatch | faults;
        for (size_t i = 0; i < force->count && stays_here(force->subject->force); i++)
            faults |= record_faults(force->subject, force->records[i], m->dimensions, saved->count);
    }
    return faults;
}

void model_load(model *m, const model *saved)
{
    const stf_integrator *integrator = m->integrator;
    model_force own[MODEL_FORCES];

    memcpy(own, m->forces, sizeof own);
    model_copy(m, saved);
    m->integrator = integrator;
    for (size_t f = 0; f < m->force_count; f++)
        if (stays_here(own[f].subject->force)) {
            m->forces[f] = own[f];
            m->forces[f].id = saved->forces[f].id;
        } else {
            m->forces[f].subject = own[f].subject;
            m->forces[f].room = m->forces[f].count;
        }
}

unsigned model_restore_faults(const model *m, const model *then, bool *unsure)
{
    size_t found = 0;

    *unsure = false;
    for (size_t f = 0; f < m->force_count && found < then->force_count; f++) {
        const model_force *here = &m->forces[f], *there = &then->forces[found];

        if (here->id != there->id || here->subject->force != there->subject->force)
            continue;
        *unsure = *unsure || there->count > here->room;
        found++;
    }
    *unsure = *unsure && found == then->force_count;
    return *unsure || found < then->force_count ? 1U << STF_ERROR_SNAPSHOT : 0;
}

void model_restore(model *m, const model *then)
{
    size_t room[MODEL_FORCES];

    for (size_t f = 0; f < then->force_count; f++)
        room[f] = model_find(m, then->forces[f].id)->room;
    model_copy(m, then);
    for (size_t f = 0; f < m->force_count; f++)
        m->forces[f].room = room[f] > m->forces[f].count ? room[f] : m->forces[f].count;
}

/* ---- what it costs, what it is ------------------------------------------------------------------------------------------- */

double model_tick_cost(const model *m)
{
    const double count = (double)m->count;
    double cost = count;

    for (size_t f = 0; f < m->force_count; f++) {
        const subject *s = m->forces[f].subject;
        const double records = (double)m->forces[f].count;
        const bool has_pairs = s->force == &stf_force_all_pairs_gravity, names_particles = s->layout[0] == 'i';

        cost += names_particles ? records + count : (records + 1) * count * (has_pairs ? 1 + count / 8 : 1);
    }
    return count > 0 ? m->substeps * cost / TICKS_A_LOOK : 0;
}

static void check_force(const model_force *force, const stf_world *world)
{
    const stf_force *descriptor = force->subject->force;
    size_t count = SIZE_MAX;
    const char *records = stf_world_force_records(world, force->id, &count);
    uint64_t expected = 0, found = 0;

    claim(stf_world_force(world, force->id) == descriptor);
    claim(count == force->count && (count == 0) == !records);
    for (size_t i = 0; i < count; i++) {
        expected += record_hash(force->subject, force->records[i]);
        found += record_hash(force->subject, records + i * descriptor->record_size);
    }
    claim(expected == found); /* the same records, in any order */
}

static void check_settings(const model *m, const stf_world *world)
{
    const double time = stf_world_time(world), expected = model_time(m);

    claim(stf_world_ticks(world) == m->ticks);
    claim(time == expected || (isnan(time) && isnan(expected)));
    claim(stf_world_step_size(world) == m->step && stf_world_substeps(world) == m->substeps);
    claim(stf_world_integrator(world) == m->integrator);
    claim(stf_world_dimensions(world) == m->dimensions);
    const stf_vector g = stf_world_gravity(world);
    claim(g.x == m->gravity.x && g.y == m->gravity.y && g.z == m->gravity.z);
}

void model_check(const model *m, const stf_world *world)
{
    check_settings(m, world);
    for (size_t f = 0; f < m->force_count; f++) {
        claim(stf_world_force_at(world, f) == m->forces[f].id);
        check_force(&m->forces[f], world);
    }
    claim(stf_world_force_at(world, m->force_count) == 0);
    claim(stf_world_count(world) == m->count);
    for (size_t i = 0; i < m->count; i++) {
        const stf_particle *expected = &m->particles[i].now;
        stf_particle found;

        claim(stf_world_get(world, i, &found) == STF_OK);
        claim(is_same_vector(found.position, expected->position) && is_same_vector(found.velocity, expected->velocity));
        claim(is_same_real(found.inverse_mass, expected->inverse_mass) && is_same_real(found.radius, expected->radius));
    }
}
