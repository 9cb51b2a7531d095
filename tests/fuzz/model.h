/* model: what a world should be, by what its headers promise, in the plainest data there are. */
#ifndef STEADFAST_TESTS_FUZZ_MODEL_H
#define STEADFAST_TESTS_FUZZ_MODEL_H

#include "fuzz.h"

enum { MODEL_FORCES = 6, MODEL_RECORDS = 40, MODEL_PARTICLES = 2400 };

typedef struct model_force {
    const subject *subject;
    stf_force_id id;
    size_t count;
    size_t room; /* records that it has room for, at least */
    unsigned char records[MODEL_RECORDS][RECORD_BYTES_MAX]; /* in any order */
} model_force;

typedef struct model {
    unsigned dimensions, substeps;
    bool keep_previous, keep_radius, compensated;
    const stf_integrator *integrator;
    double step, step_start_time;
    uint64_t ticks, step_start_tick;
    stf_vector gravity;
    stf_force_id last_id;
    size_t force_count, count;
    model_force forces[MODEL_FORCES];
    struct model_particle {
        stf_particle now;
        stf_vector previous; /* position */
    } particles[MODEL_PARTICLES]; /* last, so that a copy takes those that are there */
} model;

double model_time(const model *m);
model_force *model_find(model *m, stf_force_id id); /* NULL: there is none */
void model_copy(model *to, const model *from);

/* What stf_world_add_force, _remove and _clear do. */
void model_add_force(model *m, const subject *s, const unsigned char *records, size_t count);
void model_set_records(model_force *force, const unsigned char *records, size_t count);
void model_remove_force(model *m, stf_force_id id);
void model_remove(model *m, size_t index);
void model_clear(model *m);

/* The particles move: they are read from the world. What no step changes is claimed. */
void model_step(model *m, const stf_world *world, unsigned ticks);

/* Whether stf_world_save has to work, and if not why. */
stf_result model_save_result(const model *m);

/* What stf_world_load of `saved` may return, as bits; and what it does when it returns STF_OK. */
unsigned model_load_faults(const model *m, const model *saved);
void model_load(model *m, const model *saved);

/* Likewise of stf_world_restore; *unsure is set where it may return STF_OK as well. */
unsigned model_restore_faults(const model *m, const model *then, bool *unsure);
void model_restore(model *m, const model *then);

/* How much work a tick is, in particles that are saved and read; 0 particles: 0. */
double model_tick_cost(const model *m);

/* Claims that the world is this. */
void model_check(const model *m, const stf_world *world);

#endif
