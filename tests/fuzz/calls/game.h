/*
 * game: two worlds that go through the same calls and always have to be the same, and what they should be.
 *
 * They are made differently: other loops, another room, other garbage in their memory, and the second one's steps are split into
 * parts that run backwards, and maybe a guard watches them. Allocations are made to fail in the first only; what has failed
 * there is not done to the second.
 */
#ifndef STEADFAST_TESTS_FUZZ_GAME_H
#define STEADFAST_TESTS_FUZZ_GAME_H

#include "../model.h"

/* Bytes of a world that were kept, of each of the two, and what they are bytes of. */
typedef struct slot {
    bool is_taken;
    unsigned char *bytes[2];
    size_t size[2];
    model then;
} slot;

enum { SNAPSHOT_SLOTS = 2 };

typedef struct game {
    program program;
    stf_world *worlds[2];
    ration rations[2];
    model model;
    stf_world_def def;
    double work; /* particles that may still be looked at */

    /* the call that is being made */
    unsigned turns, faults, fail_next;
    stf_result result, results[2];
    bool changed;

    /* what the worlds are as bytes, if they can be saved */
    stf_result save_result;
    unsigned char *save;
    size_t save_size;

    slot saved, snapshots[SNAPSHOT_SLOTS];
    bool had_crowd, had_stability, had_trade;
    stf_clock clock;
} game;

/* False: the program asks for worlds that can't be made, which was claimed. */
bool game_start(game *g);
void game_end(game *g);

/*
 *     begin(g, "set_step", faults);
 *     for (stf_world *world; (world = turn(g)) != NULL;)
 *         g->result = stf_world_set_step(world, step);
 *     if (accepted(g))
 *         ...the model's step
 *
 * `faults` are the results, as bits, one of which it has to be; 0: STF_OK. STF_ERROR_MEMORY it has to be, and may be only,
 * where an allocation has failed.
 */
void begin(game *g, const char *name, unsigned faults);
stf_world *turn(game *g);
bool accepted(game *g);

/* After every operation: claims that both worlds are what they should be, and unchanged if nothing was to change. */
void inspect(game *g);

/* An index, mostly of a particle that is there. */
size_t take_index(game *g);

void slot_clear(slot *s);

/* Memory of exactly this size, also of 0 bytes; for free. */
void *exact(size_t size);

/* Steps both, one in one call and one tick by tick. */
void step_both(game *g, unsigned ticks);

/* Another world like the two, made with other loops and room: where they can be saved, and with all that they have. */
bool can_be_copied(const game *g);
stf_world *copy_of_both(game *g, ration *r);

/* What a program can do; the table is in calls.c. */
void add(game *g);
void add_crowd(game *g);
void set(game *g);
void remove_particle(game *g);
void clear(game *g);
void reserve(game *g);
void add_force(game *g);
void set_force(game *g);
void set_own_records(game *g);
void remove_force(game *g);
void set_gravity(game *g);
void set_step(game *g);
void set_substeps(game *g);
void set_integrator(game *g);
void step(game *g);
void leap(game *g);
void fail_next(game *g);
void save(game *g);
void load(game *g);
void revive(game *g);
void snapshot(game *g);
void restore(game *g);
void ask(game *g);
void copy_positions(game *g);
void accelerations(game *g);
void measure_stability(game *g);
void create(game *g);
void use_clock(game *g);
void pass_null(game *g);
void trade(game *g);
void set_guard(game *g);
void freeze(game *g);

#endif
