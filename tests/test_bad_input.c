/*
 * Every public function with every bad argument is refused with its own error, and changes nothing.
 *
 * A table says of each function how it is called and what kinds of arguments it has, members of structs and records included; a
 * kind says which values are bad and what error each brings. The rows that are run are made from the two: each bad value
 * alone, and each pair of bad values of two arguments. tests/bad_input/check.sh sees that no function is missing.
 */
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/check.h"
#include "support/memory.h"
#include "support/problem.h"
#include "support/saved.h"
#include "support/trade_scene.h"

/* ---- bad values ---------------------------------------------------------------------------------------------------------- */

/* In place of a result, of functions that return a plain value: 0, NULL, false, or what else means that there is nothing. */
#define NOTHING STF_RESULT_COUNT

typedef struct bad {
    const char *text;
    stf_result expected;
    double number;
    size_t size;
    bool is_less;   /* the size is the good one less this */
    bool cures;     /* two such values in one call may be good again: nothing in place of half, fields of no record, a world
                       and its own snapshot */
    const void *at; /* where the pointer is kept; NULL: the pointer is NULL */
} bad;

typedef enum type { POINTER, SIZE, UNSIGNED, INT, WORD, REAL, DOUBLE } type;

typedef struct kind {
    type type;
    const bad *values;
    size_t count;
} kind;

#define DBL_SUBNORMAL (DBL_MIN * DBL_EPSILON)
#define IS_NULL(error) {.text = "NULL", .expected = error}
#define IS(value, error) {.text = #value, .expected = error, .number = (double)(value)}
#define IS_SIZE(value, error) {.text = #value, .expected = error, .size = value}
#define IS_LESS(error) {.text = "one less", .expected = error, .size = 1, .is_less = true}
#define IS_AT(pointer, error) {.text = #pointer, .expected = error, .at = &(pointer)}
#define IS_NOT_FINITE(error) IS(NAN, error), IS(INFINITY, error), IS(-INFINITY, error)
#define KIND(name, type, ...)                                                                                                  \
    static const bad name##_values[] = {__VA_ARGS__};                                                                          \
    static const kind name = {type, name##_values, COUNT_OF(name##_values)}

/* Of a world of two dimensions that keeps previous positions and radii, and how the others differ. */
static stf_world *world, *bare /* keeps none, in three */, *exploded, *unsavable, *hasty /* has the least step */;

static unsigned char foreign[8192], altered[4096], newer[4096], of_bare[8192];
static const void *const at_foreign = foreign, *const at_altered = altered, *const at_newer = newer;
static const void *const at_of_bare = of_bare;

static stf_real drag_too(const void *records, size_t record_count)
{
    (void)records;
    return (stf_real)record_count;
}

/* Its records are of something that it does not say. */
static const stf_force speechless = {.name = "speechless", .record_size = sizeof(stf_linear_drag), .drag = drag_too};

static const stf_integrator stepless = {.name = "stepless"};
static const stf_integrator *const at_stepless = &stepless;

static stf_real (*const at_drag)(const void *, size_t) = drag_too;

static const stf_force *const at_idle = &idle_link;

static size_t rounds_too(size_t record_count, const stf_particles *all)
{
    (void)all;
    return record_count;
}
static size_t (*const at_rounds)(size_t, const stf_particles *) = rounds_too;

static const char *const no_fields = "44x", *const short_fields = "44rr", *const unknown = "rk5", *const empty = "";

static stf_result build_nothing(void *user, stf_world **made)
{
    (void)user, (void)made;
    return STF_ERROR_UNSAVABLE;
}

static stf_result build_another(void *user, stf_world **made)
{
    trade_scene other = TRADE_PENDULUM;
    (void)user;
    return trade_scene_build(&other, made);
}

static stf_result build_in_space(void *user, stf_world **made)
{
    const stf_particle particles[2] = {{.inverse_mass = 1}, {.inverse_mass = 1}};
    (void)user;
    *made = make_world((stf_world_def){.dimensions = 3});
    return stf_world_add_many(*made, particles, 2, NULL);
}

static stf_result build_no_reference(void *user, struct stf_world_f64 **made)
{
    (void)user, (void)made;
    return STF_ERROR_UNSAVABLE;
}
static stf_result (*const at_nothing)(void *, stf_world **) = build_nothing;
static stf_result (*const at_another)(void *, stf_world **) = build_another;
static stf_result (*const at_space)(void *, stf_world **) = build_in_space;
static stf_result (*const at_no_reference)(void *, struct stf_world_f64 **) = build_no_reference;

#define PARTICLES 4 /* of busy_world; its forces have the ids 1, 3, 4 and 5 */

/* Pointers. */
KIND(required, POINTER, IS_NULL(STF_ERROR_NULL));
KIND(asked, POINTER, IS_NULL(NOTHING)); /* by a function that returns a plain value */
KIND(with_radii, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(bare, STF_ERROR_RADIUS));
KIND(with_previous, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(bare, STF_ERROR_NO_PREVIOUS));
KIND(savable, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(exploded, STF_ERROR_NOT_FINITE), IS_AT(unsavable, STF_ERROR_UNSAVABLE));
KIND(like_the_saved, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(bare, STF_ERROR_MISMATCH));
KIND(like_the_snapshot, POINTER, IS_NULL(STF_ERROR_NULL),
     {.text = "bare", .expected = STF_ERROR_SNAPSHOT, .at = &bare, .cures = true});
KIND(finite_world, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(exploded, STF_ERROR_NOT_FINITE));
KIND(unhurried, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(hasty, STF_ERROR_STEP));
KIND(saved_bytes, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(at_foreign, STF_ERROR_FOREIGN), IS_AT(at_altered, STF_ERROR_ALTERED),
     IS_AT(at_newer, STF_ERROR_VERSION));
KIND(snapshot_bytes, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(at_foreign, STF_ERROR_SNAPSHOT),
     {.text = "of bare", .expected = STF_ERROR_SNAPSHOT, .at = &at_of_bare, .cures = true});
KIND(with_records, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(at_idle, STF_ERROR_PARAMETERS));
KIND(name_of_one, POINTER, IS_NULL(NOTHING), IS_AT(unknown, NOTHING), IS_AT(empty, NOTHING));

/* Members of descriptors. */
KIND(member, POINTER, IS_NULL(STF_ERROR_DESCRIPTOR));
KIND(half, POINTER, {.text = "NULL", .expected = STF_ERROR_DESCRIPTOR, .cures = true});
KIND(no_drag, POINTER, {.text = "set", .expected = STF_ERROR_DESCRIPTOR, .at = &at_drag, .cures = true});
KIND(no_rounds, POINTER, IS_AT(at_rounds, STF_ERROR_DESCRIPTOR));
KIND(fields_of_record, POINTER, IS_AT(short_fields, STF_ERROR_DESCRIPTOR),
     {.text = "44x", .expected = STF_ERROR_DESCRIPTOR, .at = &no_fields, .cures = true},
     {.text = "none", .expected = STF_ERROR_DESCRIPTOR, .at = &empty, .cures = true});
KIND(record_size, SIZE, {.text = "0", .expected = STF_ERROR_DESCRIPTOR, .cures = true}, IS_SIZE(1, STF_ERROR_DESCRIPTOR),
     IS_SIZE(SIZE_MAX, STF_ERROR_DESCRIPTOR));
KIND(force_kind, UNSIGNED, IS(2, STF_ERROR_DESCRIPTOR), IS(UINT_MAX, STF_ERROR_DESCRIPTOR));
KIND(work_arrays, INT, IS(-1, STF_ERROR_DESCRIPTOR), IS(INT_MIN, STF_ERROR_DESCRIPTOR),
     IS(STF_WORK_ARRAYS_MAX + 1, STF_ERROR_DESCRIPTOR), IS(INT_MAX, STF_ERROR_DESCRIPTOR));
KIND(history_arrays, INT, IS(-1, STF_ERROR_DESCRIPTOR), IS(INT_MIN, STF_ERROR_DESCRIPTOR),
     IS(STF_HISTORY_ARRAYS_MAX + 1, STF_ERROR_DESCRIPTOR), IS(INT_MAX, STF_ERROR_DESCRIPTOR));
KIND(tasks_without_run, UNSIGNED, IS(2, STF_ERROR_DESCRIPTOR), IS(UINT_MAX, STF_ERROR_DESCRIPTOR));
KIND(listed_integrator, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(at_stepless, STF_ERROR_DESCRIPTOR));
KIND(world_builder, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(at_nothing, STF_ERROR_UNSAVABLE),
     IS_AT(at_another, STF_ERROR_PARTICLE), IS_AT(at_space, STF_ERROR_DIMENSIONS));
KIND(reference_builder, POINTER, IS_NULL(STF_ERROR_NULL), IS_AT(at_no_reference, STF_ERROR_UNSAVABLE));

/* Reals of vectors, particles and records. */
KIND(finite, REAL, IS_NOT_FINITE(STF_ERROR_NOT_FINITE));
KIND(lacking, REAL, IS_NOT_FINITE(STF_ERROR_NOT_FINITE), IS(1, STF_ERROR_DIMENSIONS), IS(-REAL_LEAST, STF_ERROR_DIMENSIONS));
KIND(inverse_mass, REAL, IS_NOT_FINITE(STF_ERROR_MASS), IS(-1, STF_ERROR_MASS), IS(REAL_LEAST / 2, STF_ERROR_MASS));
KIND(radius, REAL, IS_NOT_FINITE(STF_ERROR_RADIUS), IS(-1, STF_ERROR_RADIUS), IS(-REAL_LEAST, STF_ERROR_RADIUS));
KIND(coefficient, REAL, IS_NOT_FINITE(STF_ERROR_PARAMETERS), IS(-1, STF_ERROR_PARAMETERS),
     IS(-REAL_LEAST, STF_ERROR_PARAMETERS));
KIND(strength, REAL, IS_NOT_FINITE(STF_ERROR_PARAMETERS));

/* Times and factors. */
KIND(step_or_0, DOUBLE, IS_NOT_FINITE(STF_ERROR_STEP), IS(-1, STF_ERROR_STEP), IS(REAL_LEAST / 64, STF_ERROR_STEP));
KIND(step, DOUBLE, IS_NOT_FINITE(STF_ERROR_STEP), IS(-1, STF_ERROR_STEP), IS(REAL_LEAST / 64, STF_ERROR_STEP),
     IS(0, STF_ERROR_STEP),
     IS((double)REAL_MAX * 64, STF_ERROR_STEP));
KIND(clock_step_or_0, DOUBLE, IS_NOT_FINITE(STF_ERROR_STEP), IS(-1, STF_ERROR_STEP), IS(-DBL_SUBNORMAL, STF_ERROR_STEP));
KIND(clock_step, DOUBLE, IS_NOT_FINITE(STF_ERROR_STEP), IS(-1, STF_ERROR_STEP), IS(-DBL_SUBNORMAL, STF_ERROR_STEP),
     IS(0, STF_ERROR_STEP));
KIND(duration, DOUBLE, IS_NOT_FINITE(STF_ERROR_STEP), IS(-1, STF_ERROR_STEP), IS(0, STF_ERROR_STEP));
KIND(at_most, DOUBLE, IS(NAN, STF_ERROR_STEP), IS(-INFINITY, STF_ERROR_STEP), IS(-1, STF_ERROR_STEP));
KIND(period, DOUBLE, IS_NOT_FINITE(STF_ERROR_FRAME_TIME), IS(-1, STF_ERROR_FRAME_TIME),
     IS(-DBL_SUBNORMAL, STF_ERROR_FRAME_TIME));
KIND(frame_time, DOUBLE, IS_NOT_FINITE(STF_ERROR_FRAME_TIME), IS(-1, STF_ERROR_FRAME_TIME), IS(DBL_MAX, STF_ERROR_FRAME_TIME));
KIND(moment, DOUBLE, IS_NOT_FINITE(STF_ERROR_NOT_FINITE));
KIND(blend, DOUBLE, IS_NOT_FINITE(STF_ERROR_ALPHA), IS(-DBL_MIN, STF_ERROR_ALPHA), IS(1 + DBL_EPSILON, STF_ERROR_ALPHA));
KIND(wish, DOUBLE, IS(NAN, NOTHING), IS(-INFINITY, NOTHING), IS(-1, NOTHING)); /* no row is as good as that */

/* A guard. */
KIND(guard_mode, UNSIGNED, IS(STF_GUARD_FREEZE + 1, STF_ERROR_PARAMETERS), IS(UINT_MAX, STF_ERROR_PARAMETERS));
KIND(bound, DOUBLE, IS_NOT_FINITE(STF_ERROR_PARAMETERS), IS(-1, STF_ERROR_PARAMETERS), IS(-DBL_MIN, STF_ERROR_PARAMETERS));

/* Counts, indices, sizes. */
KIND(dimensions, UNSIGNED, IS(1, STF_ERROR_DIMENSIONS) /* too few for the gravity */,
     IS(4, STF_ERROR_DIMENSIONS), IS(UINT_MAX, STF_ERROR_DIMENSIONS));
KIND(substeps_or_0, UNSIGNED, IS(STF_SUBSTEPS_MAX + 1, STF_ERROR_SUBSTEPS), IS(UINT_MAX, STF_ERROR_SUBSTEPS));
KIND(substeps, UNSIGNED, IS(0, STF_ERROR_SUBSTEPS), IS(STF_SUBSTEPS_MAX + 1, STF_ERROR_SUBSTEPS),
     IS(UINT_MAX, STF_ERROR_SUBSTEPS));
KIND(capacity, SIZE, IS_SIZE(SIZE_MAX, STF_ERROR_MEMORY), IS_SIZE(SIZE_MAX / 2, STF_ERROR_MEMORY),
     IS_SIZE(SIZE_MAX / sizeof(stf_real) / 32, STF_ERROR_MEMORY), /* whose bytes would wrap round */
     IS_SIZE((size_t)1 << 30, STF_ERROR_MEMORY)); /* more than the allocator gives */
KIND(lot, SIZE, IS_SIZE(SIZE_MAX, STF_ERROR_MEMORY), IS_SIZE(SIZE_MAX - 1, STF_ERROR_MEMORY),
     IS_SIZE(SIZE_MAX / 2, STF_ERROR_MEMORY));
KIND(record_count, SIZE, IS_SIZE(SIZE_MAX, STF_ERROR_MEMORY), IS_SIZE(SIZE_MAX / sizeof(stf_spring) + 2, STF_ERROR_MEMORY));
KIND(index_of_particle, SIZE, IS_SIZE(PARTICLES, STF_ERROR_PARTICLE), IS_SIZE(SIZE_MAX, STF_ERROR_PARTICLE));
KIND(end, WORD, IS(PARTICLES, STF_ERROR_PARTICLE), IS(UINT32_MAX, STF_ERROR_PARTICLE));
KIND(other_end, WORD, IS(PARTICLES, STF_ERROR_PARTICLE), IS(UINT32_MAX, STF_ERROR_PARTICLE), IS(1, STF_ERROR_PARAMETERS));
KIND(id, WORD, IS(0, STF_ERROR_FORCE), IS(2, STF_ERROR_FORCE) /* removed */, IS(6, STF_ERROR_FORCE),
     IS(UINT32_MAX, STF_ERROR_FORCE));
KIND(asked_id, WORD, IS(0, NOTHING), IS(2, NOTHING), IS(6, NOTHING), IS(UINT32_MAX, NOTHING));
KIND(place_of_force, SIZE, IS_SIZE(4, NOTHING), IS_SIZE(SIZE_MAX, NOTHING));
KIND(stride, SIZE, IS_SIZE(1, STF_ERROR_STRIDE), IS_SIZE(2 * sizeof(float) - 1, STF_ERROR_STRIDE),
     IS_SIZE(SIZE_MAX, STF_ERROR_STRIDE),
     IS_SIZE(SIZE_MAX / PARTICLES, STF_ERROR_STRIDE));
KIND(buffer_size, SIZE, IS_SIZE(0, STF_ERROR_BUFFER), IS_LESS(STF_ERROR_BUFFER));
KIND(saved_size, SIZE, IS_SIZE(0, STF_ERROR_TRUNCATED), IS_LESS(STF_ERROR_TRUNCATED),
     IS_SIZE(sizeof altered, STF_ERROR_ALTERED));
KIND(snapshot_size, SIZE, IS_SIZE(0, STF_ERROR_SNAPSHOT), IS_LESS(STF_ERROR_SNAPSHOT));
KIND(samples, UNSIGNED, IS(UINT_MAX, STF_ERROR_MEMORY));
KIND(repeats, UNSIGNED, IS(UINT_MAX, STF_ERROR_MEMORY));
KIND(list_length, SIZE, IS_SIZE(SIZE_MAX, STF_ERROR_MEMORY), IS_SIZE(SIZE_MAX / sizeof(double) + 1, STF_ERROR_MEMORY));
KIND(step_count, UNSIGNED, IS(0, STF_ERROR_STEP), IS(5, STF_ERROR_STEP), IS(UINT_MAX, STF_ERROR_STEP));
KIND(result_code, INT, IS(-1, NOTHING), IS(STF_RESULT_COUNT, NOTHING), IS(INT_MAX, NOTHING));

/* ---- what functions are called with -------------------------------------------------------------------------------------- */

#define SAMPLES 4u
#define MEMORY_MOST ((size_t)1 << 20)

/* Room for any result. */
typedef union room {
    double number;
    void *pointer;
    unsigned char bytes[8192];
} room;

/* What can be given; pointers point at the members below them, whose values are good. */
typedef struct arguments {
    stf_world *world;
    void *out;
    const void *saved, *snapshot;
    size_t saved_size, snapshot_size, capacity, index, count, lot_count, place, stride;
    double time, alpha;
    unsigned substeps;
    stf_force_id id;
    int result;
    const char *name;
    const stf_real *position, *velocity;
    stf_vector vector;
    stf_guard guard;

    const stf_world_def *def;
    stf_world_def the_def;
    const stf_particle *particle;
    stf_particle the_particle;
    const stf_particle *lot;
    stf_particle lots[2];
    const stf_integrator *integrator;
    stf_integrator the_integrator;
    const stf_force *force;
    stf_force the_force;
    const stf_spring *springs;
    stf_spring spring;
    stf_anchored_spring anchored;
    stf_linear_drag linear;
    stf_quadratic_drag quadratic;
    stf_attractor attractor;
    stf_all_pairs_gravity all_pairs;

    stf_clock *clock;
    stf_clock the_clock;
    const stf_clock_def *clock_def;
    stf_clock_def the_clock_def;
    double seconds;

    const stf_stability_def *stability_def;
    stf_stability_def the_stability_def;

    const stf_trade_reference_def *reference_def;
    stf_trade_reference_def the_reference_def;
    stf_trade_reference *reference;
    const stf_trade_def *trade_def;
    stf_trade_def the_trade_def;
    stf_trade_row *rows;
    const stf_integrator *integrators[1];
    unsigned steps[1];
    stf_trade_run *const *runs;
    stf_trade_run *the_run;
    double error;
} arguments;

static arguments a, good; /* the pointers of both point into a */
static room out, saved_world, snapshot_of_world;
static stf_trade_row row;
static counting memory;
static trade_scene trade_scene_of_all = TRADE_FALL;

/* ---- how each function is called ----------------------------------------------------------------------------------------- */

#define CALL(function, expression) \
    static stf_result call_##function(void) { return expression; }
#define ASK(function, expression) \
    static stf_result call_##function(void) { return (expression) ? STF_OK : NOTHING; }

/* What a good call made goes again. */
static stf_result create_and_destroy(void)
{
    const stf_result result = stf_world_create(a.def, a.out);

    if (!result)
        stf_world_destroy(*(stf_world **)a.out);
    return result;
}

static stf_result refer_and_destroy(void)
{
    const stf_result result = stf_trade_reference_create(a.reference_def, a.out);

    if (!result)
        stf_trade_reference_destroy(*(stf_trade_reference **)a.out);
    return result;
}

static stf_result begin_and_end(void)
{
    const stf_result result = stf_trade_begin(a.trade_def, a.rows, a.out);

    if (!result)
        stf_trade_end(*(stf_trade_run **)a.out);
    return result;
}

/* Functions that return nothing are only called with what is bad: the good things are those of the test. */
static bool destroy(void) { return a.world ? true : (stf_world_destroy(NULL), false); }
static bool destroy_reference(void) { return a.reference ? true : (stf_trade_reference_destroy(NULL), false); }
static bool end_run(void) { return a.the_run ? true : (stf_trade_end(NULL), false); }
static bool mark_front(void) { return stf_trade_front(a.rows, 1), a.rows != NULL; }

static stf_result find_non_finite(void)
{
    return stf_world_find_non_finite(a.world, a.out) ? STF_ERROR_NOT_FINITE : a.world ? STF_OK : NOTHING;
}

CALL(stf_result_text, stf_result_text((stf_result)a.result) == stf_result_text(STF_RESULT_COUNT) ? NOTHING : STF_OK)
ASK(stf_version, stf_version())

CALL(stf_clock_init, stf_clock_init(a.clock, a.clock_def))
CALL(stf_clock_advance, stf_clock_advance(a.clock, a.seconds, a.out))
ASK(stf_clock_alpha, stf_clock_alpha(a.clock) > 0)
ASK(stf_clock_time, stf_clock_time(a.clock) > 0)
CALL(stf_clock_set_time_scale, stf_clock_set_time_scale(a.clock, a.seconds))
CALL(stf_clock_set_step, stf_clock_set_step(a.clock, a.seconds))
CALL(stf_clock_set_display_period, stf_clock_set_display_period(a.clock, a.seconds))
CALL(stf_clock_set_max_ticks, stf_clock_set_max_ticks(a.clock, 5))
CALL(stf_clock_single_step, stf_clock_single_step(a.clock))

ASK(stf_integrator_find, stf_integrator_find(a.name))

CALL(stf_world_create, create_and_destroy())
ASK(stf_world_destroy, destroy())
ASK(stf_world_count, stf_world_count(a.world))
CALL(stf_world_reserve, stf_world_reserve(a.world, a.capacity))
CALL(stf_world_add, stf_world_add(a.world, a.particle, a.out))
CALL(stf_world_add_many, stf_world_add_many(a.world, a.lot, a.lot_count, a.out))
CALL(stf_world_get, stf_world_get(a.world, a.index, a.out))
CALL(stf_world_set, stf_world_set(a.world, a.index, a.particle))
CALL(stf_world_remove, stf_world_remove(a.world, a.index, a.out))
CALL(stf_world_clear, stf_world_clear(a.world))
CALL(stf_world_copy_positions, stf_world_copy_positions(a.world, a.alpha, a.out, a.stride))
CALL(stf_world_add_force, stf_world_add_force(a.world, a.force, a.springs, a.count, a.out))
CALL(add_spring, stf_world_add_force(a.world, &stf_force_springs, &a.spring, 1, a.out))
CALL(add_anchored, stf_world_add_force(a.world, &stf_force_anchored_springs, &a.anchored, 1, a.out))
CALL(add_linear, stf_world_add_force(a.world, &stf_force_linear_drag, &a.linear, 1, a.out))
CALL(add_quadratic, stf_world_add_force(a.world, &stf_force_quadratic_drag, &a.quadratic, 1, a.out))
CALL(add_attractor, stf_world_add_force(a.world, &stf_force_attractor, &a.attractor, 1, a.out))
CALL(add_all_pairs, stf_world_add_force(a.world, &stf_force_all_pairs_gravity, &a.all_pairs, 1, a.out))
CALL(stf_world_set_force, stf_world_set_force(a.world, a.id, a.springs, a.count))
ASK(stf_world_force_records, stf_world_force_records(a.world, a.id, a.out))
CALL(stf_world_remove_force, stf_world_remove_force(a.world, a.id))
ASK(stf_world_force_at, stf_world_force_at(a.world, a.place))
ASK(stf_world_force, stf_world_force(a.world, a.id))
CALL(stf_world_set_gravity, stf_world_set_gravity(a.world, a.vector))
ASK(stf_world_gravity, stf_world_gravity(a.world).y < 0)
CALL(stf_world_step, stf_world_step(a.world, 1))
ASK(stf_world_ticks, stf_world_ticks(a.world))
ASK(stf_world_time, stf_world_time(a.world) > 0)
CALL(stf_world_set_step, stf_world_set_step(a.world, a.time))
ASK(stf_world_step_size, stf_world_step_size(a.world) > 0)
CALL(stf_world_set_substeps, stf_world_set_substeps(a.world, a.substeps))
ASK(stf_world_substeps, stf_world_substeps(a.world))
CALL(stf_world_set_integrator, stf_world_set_integrator(a.world, a.integrator))
ASK(stf_world_integrator, stf_world_integrator(a.world))
ASK(stf_world_dimensions, stf_world_dimensions(a.world))
ASK(stf_world_isa, stf_world_isa(a.world))
CALL(stf_world_energy, stf_world_energy(a.world, a.out))
CALL(stf_world_momentum, stf_world_momentum(a.world, a.out))
ASK(stf_world_view, stf_world_view(a.world).position)
CALL(stf_world_accelerations, stf_world_accelerations(a.world, a.time, a.position, a.velocity, a.out))
CALL(stf_world_find_non_finite, find_non_finite())
CALL(stf_world_set_guard, stf_world_set_guard(a.world, a.guard))
ASK(stf_world_guard, stf_world_guard(a.world).mode)
ASK(stf_world_fault, !stf_world_fault(a.world, a.out) && a.world)
CALL(stf_world_clear_fault, stf_world_clear_fault(a.world))
ASK(stf_world_describe, stf_world_describe(a.world, a.out, sizeof out))

ASK(stf_world_save_size, stf_world_save_size(a.world))
CALL(stf_world_save, stf_world_save(a.world, a.out, a.saved_size))
CALL(stf_world_load, stf_world_load(a.world, a.saved, a.saved_size, a.out))
ASK(stf_world_snapshot_size, stf_world_snapshot_size(a.world))
CALL(stf_world_snapshot, stf_world_snapshot(a.world, a.out, a.snapshot_size))
CALL(stf_world_restore, stf_world_restore(a.world, a.snapshot, a.snapshot_size))

CALL(stf_stability_measure, stf_stability_measure(a.world, a.stability_def, a.out))

CALL(stf_trade_reference_create, refer_and_destroy())
ASK(stf_trade_reference_destroy, destroy_reference())
ASK(stf_trade_reference_accuracy, stf_trade_reference_accuracy(a.reference).reach > 0)
CALL(stf_trade, stf_trade(a.trade_def, a.rows))
CALL(stf_trade_begin, begin_and_end())
CALL(stf_trade_time, stf_trade_time(a.runs, 1))
ASK(stf_trade_end, end_run())
ASK(stf_trade_error_is_known, stf_trade_error_is_known(a.rows))
ASK(stf_trade_error_bound, stf_trade_error_bound(a.rows) < HUGE_VAL)
ASK(stf_trade_front, mark_front())
ASK(stf_trade_cheapest, stf_trade_cheapest(a.rows, 1, a.error))
ASK(stf_trade_most_accurate, stf_trade_most_accurate(a.rows, 1, a.error))

/* ---- the table ----------------------------------------------------------------------------------------------------------- */

#define ARGUMENTS_MAX 24

typedef struct argument {
    const char *name;
    size_t offset;
    const kind *kind;
} argument;

typedef struct function {
    const char *name;
    stf_result (*call)(void);
    bool says; /* in its out-parameter, where it refuses too */
    argument arguments[ARGUMENTS_MAX];
} function;

#define ARG(member, of_kind) {#member, offsetof(arguments, member), &of_kind}
#define VECTOR_OF(of) ARG(of.x, finite), ARG(of.y, finite), ARG(of.z, lacking)
#define PARTICLE_OF(of) \
    VECTOR_OF(of.position), VECTOR_OF(of.velocity), ARG(of.inverse_mass, inverse_mass), ARG(of.radius, radius)
#define SPRING_OF(of) ARG(of.stiffness, coefficient), ARG(of.damping, coefficient), ARG(of.rest_length, coefficient)
#define INTEGRATOR_OF(of) \
    ARG(of.name, member), ARG(of.step, member), ARG(of.work_arrays, work_arrays), ARG(of.history_arrays, history_arrays)
#define ALLOCATOR_OF(of) ARG(of.allocate, half), ARG(of.release, half)
#define GUARD_OF(of) ARG(of.mode, guard_mode), ARG(of.position_bound, bound), ARG(of.velocity_bound, bound)
#define WORLD ARG(world, required)
#define OUT ARG(out, required)
#define TRADE                                                                                                                  \
    ARG(trade_def, required), ARG(rows, required), ARG(the_trade_def.build, world_builder),                                    \
        ARG(the_trade_def.reference, required), ARG(the_trade_def.integrators, required),                                      \
        ARG(the_trade_def.integrator_count, list_length), ARG(integrators, listed_integrator),                                 \
        ARG(the_trade_def.steps, required), ARG(the_trade_def.steps_count, list_length), ARG(steps, step_count),               \
        ARG(the_trade_def.repeats, repeats), ARG(the_trade_def.repeat_seconds, at_most), ALLOCATOR_OF(the_trade_def.allocator)

#define ON(of, ...) {.name = #of, .call = call_##of, .arguments = {__VA_ARGS__}}
#define ON_BY(of, by, ...) {.name = #of, .call = call_##by, .arguments = {__VA_ARGS__}}
#define SAYING(of, ...) {.name = #of, .call = call_##of, .says = true, .arguments = {__VA_ARGS__}}

static const function functions[] = {
    ON(stf_result_text, ARG(result, result_code)),
    {.name = "stf_version", .call = call_stf_version},

    ON(stf_clock_init, ARG(clock, required), ARG(clock_def, required), ARG(the_clock_def.step, clock_step_or_0),
       ARG(the_clock_def.display_period, period), ARG(the_clock_def.time_scale, period)),
    SAYING(stf_clock_advance, ARG(clock, required), ARG(seconds, frame_time), OUT),
    ON(stf_clock_alpha, ARG(clock, asked)),
    ON(stf_clock_time, ARG(clock, asked)),
    ON(stf_clock_set_time_scale, ARG(clock, required), ARG(seconds, period)),
    ON(stf_clock_set_step, ARG(clock, required), ARG(seconds, clock_step)),
    ON(stf_clock_set_display_period, ARG(clock, required), ARG(seconds, period)),
    ON(stf_clock_set_max_ticks, ARG(clock, required)),
    ON(stf_clock_single_step, ARG(clock, required)),

    ON(stf_integrator_find, ARG(name, name_of_one)),

    ON(stf_world_create, ARG(def, required), OUT, ARG(the_def.dimensions, dimensions), ARG(the_def.step, step_or_0),
       ARG(the_def.substeps, substeps_or_0), VECTOR_OF(the_def.gravity), ARG(the_def.capacity, capacity),
       ARG(the_def.parallel.tasks, tasks_without_run), ALLOCATOR_OF(the_def.allocator), INTEGRATOR_OF(the_integrator),
       GUARD_OF(the_def.guard)),
    ON(stf_world_destroy, ARG(world, asked)),
    ON(stf_world_count, ARG(world, asked)),
    ON(stf_world_reserve, WORLD, ARG(capacity, capacity)),
    ON(stf_world_add, ARG(world, with_radii), ARG(particle, required), PARTICLE_OF(the_particle)),
    ON(stf_world_add_many, ARG(world, with_radii), ARG(lot, required), ARG(lot_count, lot), PARTICLE_OF(lots[1])),
    ON(stf_world_get, WORLD, ARG(index, index_of_particle), OUT),
    ON(stf_world_set, ARG(world, with_radii), ARG(index, index_of_particle), ARG(particle, required),
       PARTICLE_OF(the_particle)),
    ON(stf_world_remove, WORLD, ARG(index, index_of_particle)),
    ON(stf_world_clear, WORLD),
    ON(stf_world_copy_positions, ARG(world, with_previous), ARG(alpha, blend), OUT, ARG(stride, stride)),
    ON(stf_world_add_force, WORLD, ARG(force, with_records), ARG(springs, required), ARG(count, record_count),
       ARG(the_force.name, member), ARG(the_force.kind, force_kind), ARG(the_force.rounds, no_rounds),
       ARG(the_force.record_size, record_size), ARG(the_force.apply, half), ARG(the_force.drag, no_drag),
       ARG(the_force.fields, fields_of_record)),
    ON_BY(stf_world_add_force, add_spring, ARG(spring.a, other_end), ARG(spring.b, end), SPRING_OF(spring)),
    ON_BY(stf_world_add_force, add_anchored, ARG(anchored.particle, end), VECTOR_OF(anchored.anchor), SPRING_OF(anchored)),
    ON_BY(stf_world_add_force, add_linear, ARG(linear.coefficient, coefficient)),
    ON_BY(stf_world_add_force, add_quadratic, ARG(quadratic.coefficient, coefficient)),
    ON_BY(stf_world_add_force, add_attractor, VECTOR_OF(attractor.position), ARG(attractor.strength, strength),
       ARG(attractor.softening, coefficient)),
    ON_BY(stf_world_add_force, add_all_pairs, ARG(all_pairs.gravitational_constant, strength),
       ARG(all_pairs.softening, coefficient)),
    ON(stf_world_set_force, WORLD, ARG(id, id), ARG(springs, required), ARG(count, record_count), ARG(spring.a, other_end),
       ARG(spring.b, end), SPRING_OF(spring)),
    SAYING(stf_world_force_records, ARG(world, asked), ARG(id, asked_id)),
    ON(stf_world_remove_force, WORLD, ARG(id, id)),
    ON(stf_world_force_at, ARG(world, asked), ARG(place, place_of_force)),
    ON(stf_world_force, ARG(world, asked), ARG(id, asked_id)),
    ON(stf_world_set_gravity, WORLD, VECTOR_OF(vector)),
    ON(stf_world_gravity, ARG(world, asked)),
    ON(stf_world_step, WORLD),
    ON(stf_world_ticks, ARG(world, asked)),
    ON(stf_world_time, ARG(world, asked)),
    ON(stf_world_set_step, WORLD, ARG(time, step)),
    ON(stf_world_step_size, ARG(world, asked)),
    ON(stf_world_set_substeps, ARG(world, unhurried), ARG(substeps, substeps)),
    ON(stf_world_substeps, ARG(world, asked)),
    ON(stf_world_set_integrator, WORLD, ARG(integrator, required), INTEGRATOR_OF(the_integrator)),
    ON(stf_world_integrator, ARG(world, asked)),
    ON(stf_world_dimensions, ARG(world, asked)),
    ON(stf_world_isa, ARG(world, asked)),
    ON(stf_world_energy, WORLD, OUT),
    ON(stf_world_momentum, WORLD, OUT),
    ON(stf_world_view, ARG(world, asked)),
    ON(stf_world_accelerations, WORLD, ARG(time, moment), ARG(position, required), ARG(velocity, required), OUT),
    ON(stf_world_find_non_finite, ARG(world, asked)),
    ON(stf_world_set_guard, WORLD, GUARD_OF(guard)),
    ON(stf_world_guard, ARG(world, asked)),
    ON(stf_world_fault, ARG(world, asked)),
    ON(stf_world_clear_fault, WORLD),
    SAYING(stf_world_describe, ARG(world, asked)),

    ON(stf_world_save_size, ARG(world, asked)),
    ON(stf_world_save, ARG(world, savable), OUT, ARG(saved_size, buffer_size)),
    SAYING(stf_world_load, ARG(world, like_the_saved), ARG(saved, saved_bytes), ARG(saved_size, saved_size)),
    ON(stf_world_snapshot_size, ARG(world, asked)),
    ON(stf_world_snapshot, WORLD, OUT, ARG(snapshot_size, buffer_size)),
    ON(stf_world_restore, ARG(world, like_the_snapshot), ARG(snapshot, snapshot_bytes), ARG(snapshot_size, snapshot_size)),

    ON(stf_stability_measure, ARG(world, finite_world), OUT, ALLOCATOR_OF(the_stability_def.allocator)),

    ON(stf_trade_reference_create, ARG(reference_def, required), OUT, ARG(the_reference_def.build, reference_builder),
       ARG(the_reference_def.duration, duration), ARG(the_reference_def.samples, samples),
       ARG(the_reference_def.error, at_most),
       ALLOCATOR_OF(the_reference_def.allocator)),
    ON(stf_trade_reference_destroy, ARG(reference, asked)),
    ON(stf_trade_reference_accuracy, ARG(reference, asked)),
    SAYING(stf_trade, TRADE),
    SAYING(stf_trade_begin, OUT, TRADE),
    ON(stf_trade_time, ARG(runs, required), ARG(the_run, required)),
    ON(stf_trade_end, ARG(the_run, asked)),
    ON(stf_trade_error_is_known, ARG(rows, asked)),
    ON(stf_trade_error_bound, ARG(rows, asked)),
    ON(stf_trade_front, ARG(rows, asked)),
    ON(stf_trade_cheapest, ARG(rows, asked), ARG(error, wish)),
    ON(stf_trade_most_accurate, ARG(rows, asked), ARG(error, wish)),
};

/* ---- what is there before and after -------------------------------------------------------------------------------------- */

static void make_worlds(void)
{
    const stf_allocator allocator = counting_allocator(&memory);
    const stf_particle resting[PARTICLES] = {{.inverse_mass = 1}};

    memory = (counting){.most = MEMORY_MOST};
    world = busy_world(&remembering, 0, allocator);
    assert_ok(stf_world_set_guard(world, (stf_guard){.mode = STF_GUARD_REPORT, .position_bound = 1e6}));
    assert_ok(stf_world_step(world, 7));
    bare = make_world((stf_world_def){.allocator = allocator});
    assert_ok(stf_world_add_many(bare, resting, PARTICLES, NULL));
    exploded = busy_world(&stf_explicit_euler, 0, allocator);
    assert_ok(stf_world_set_step(exploded, 1e9));
    assert_ok(stf_world_step(exploded, 100));
    assert_true(stf_world_find_non_finite(exploded, NULL));
    unsavable = make_world((stf_world_def){.dimensions = 2, .allocator = allocator});
    add_force(unsavable, &speechless, &(stf_linear_drag){1});
    hasty = make_world((stf_world_def){.step = (double)REAL_LEAST, .allocator = allocator});
}

static void destroy_worlds(void)
{
    stf_world *const worlds[] = {world, bare, exploded, unsavable, hasty};

    for (size_t i = 0; i < COUNT_OF(worlds); i++)
        stf_world_destroy(worlds[i]);
    assert_int_equal(memory.blocks, 0);
    assert_int_equal(memory.bytes, 0);
}

static void make_buffers(void)
{
    const size_t size = stf_world_save_size(world);

    assert_true(size < sizeof altered && stf_world_snapshot_size(world) < sizeof out && sizeof out < MEMORY_MOST);
    assert_ok(stf_world_save(world, saved_world.bytes, size));
    assert_ok(stf_world_snapshot(world, snapshot_of_world.bytes, sizeof snapshot_of_world));
    assert_ok(stf_world_snapshot(bare, of_bare, sizeof of_bare));
    memcpy(altered, saved_world.bytes, size);
    altered[size / 2] ^= 1;
    memcpy(newer, saved_world.bytes, size);
    newer[8]++; /* the version, see src/world/format.h */
}

/* A clock none of whose members is 0. */
static void make_used_clock(stf_clock *clock)
{
    unsigned ticks;

    assert_ok(stf_clock_init(clock, &(stf_clock_def){.step = 0.01, .display_period = 0.025, .time_scale = 0.5}));
    assert_ok(stf_clock_single_step(clock));
    assert_ok(stf_clock_single_step(clock));
    assert_ok(stf_clock_advance(clock, 0.0251, &ticks));
    assert_ok(stf_clock_set_step(clock, 0.011));
    assert_ok(stf_clock_advance(clock, 2.001, &ticks));
    assert_ok(stf_clock_single_step(clock));
    assert_true(clock->remainder > 0 && clock->set_aside > 0 && clock->dropped_this_frame > 0 && clock->ticks > 0);
}

static void make_arguments(void)
{
    const stf_particles view = stf_world_view(world);
    const stf_allocator allocator = counting_allocator(&memory);

    a = (arguments){
        .world = world, .out = &out, .saved = saved_world.bytes, .saved_size = stf_world_save_size(world),
        .snapshot = snapshot_of_world.bytes, .snapshot_size = stf_world_snapshot_size(world), .capacity = 100, .index = 1,
        .count = 1, .place = 1, .stride = 2 * sizeof(float), .time = 1.0 / 32, .alpha = 0.5, .substeps = 2, .id = 1,
        .result = STF_ERROR_MASS, .name = "rk4", .position = view.position, .velocity = view.velocity, .vector = {1, 2, 0},
        .guard = {.mode = STF_GUARD_FREEZE, .position_bound = 2e6},
        .def = &a.the_def,
        .the_def = {.dimensions = 2, .integrator = &a.the_integrator, .step = 1, .gravity = {1, 2, 0}, .allocator = allocator},
        .particle = &a.the_particle, .the_particle = {{1, 2, 0}, {3, 4, 0}, 1, 2},
        .lot = a.lots, .lots = {{{1, 2, 0}, {3, 4, 0}, 1, 2}, {{5, 6, 0}, {7, 8, 0}, 1, 2}}, .lot_count = 2,
        .integrator = &a.the_integrator, .the_integrator = stf_rk4,
        .force = &a.the_force, .the_force = stf_force_springs,
        .springs = &a.spring, .spring = {0, 1, 1, 1, 1}, .anchored = {0, {1, 2, 0}, 1, 1, 1}, .linear = {1}, .quadratic = {1},
        .attractor = {{1, 2, 0}, 1, 1}, .all_pairs = {1, 1},
        .clock = &a.the_clock, .clock_def = &a.the_clock_def, .seconds = 0.04,
        .stability_def = &a.the_stability_def, .the_stability_def = {.allocator = allocator},
        .reference_def = &a.the_reference_def,
        .the_reference_def = {.build = trade_scene_build_f64, .exact = trade_scene_exact_fall, .user = &trade_scene_of_all,
                              .duration = 1, .samples = SAMPLES, .allocator = allocator},
        .trade_def = &a.the_trade_def,
        .the_trade_def = {.build = trade_scene_build, .user = &trade_scene_of_all, .integrators = a.integrators,
                          .integrator_count = 1, .steps = a.steps, .steps_count = 1, .repeats = 1, .allocator = allocator},
        .rows = &row, .integrators = {&stf_rk4}, .steps = {SAMPLES}, .runs = &a.the_run, .error = 1e9,
    };
    make_used_clock(a.clock);
    assert_ok(stf_trade_reference_create(a.reference_def, &a.reference));
    a.the_trade_def.reference = a.reference;
    assert_ok(stf_trade_begin(a.trade_def, a.rows, &a.the_run));
    memset(&out, 0x5a, sizeof out);
    good = a;
}

static void set_up(void)
{
    make_worlds();
    make_buffers();
    make_arguments();
}

static void tear_down(void)
{
    a = good;
    stf_trade_end(a.the_run);
    stf_trade_reference_destroy(a.reference);
    destroy_worlds();
}

/* Lanes of no particle too, where anything stands and how much memory there is. */
static uint64_t hash_world(uint64_t hash, const stf_world *of)
{
    static unsigned char bytes[sizeof altered];
    const uint64_t seen = hash_of(of);
    const stf_particles view = stf_world_view(of);
    const size_t lanes = (view.count + view.stride - 1) / view.stride * view.stride;
    const size_t sizes[] = {stf_world_save_size(of), stf_world_snapshot_size(of), memory.blocks, memory.bytes};
    const stf_guard guard = stf_world_guard(of);
    const double watched[] = {guard.mode, guard.interval, guard.position_bound, guard.velocity_bound};

    hash = hash_bytes(hash, &seen, sizeof seen);
    hash = hash_bytes(hash, &view.position, sizeof view.position);
    hash = hash_bytes(hash, view.position, lanes * view.dimensions * sizeof(stf_real));
    hash = hash_bytes(hash, view.velocity, lanes * view.dimensions * sizeof(stf_real));
    hash = hash_bytes(hash, view.inverse_mass, lanes * sizeof(stf_real));
    hash = hash_bytes(hash, sizes, sizeof sizes);
    hash = hash_bytes(hash, watched, sizeof watched);
    return stf_world_save(of, bytes, sizeof bytes) ? hash : hash_bytes(hash, bytes, sizes[0]);
}

/* By its members: between them anything may stand. */
static uint64_t hash_clock(uint64_t hash, const stf_clock *c)
{
    const double members[] = {c->step, c->display_period, c->time_scale, c->max_ticks, c->max_ticks_by_time, c->single_steps,
                              (double)c->ticks, (double)c->step_start_tick, c->step_start_time, c->remainder, c->dropped,
                              c->dropped_this_frame, c->set_aside};

    return hash_bytes(hash, members, sizeof members);
}

static uint64_t hash_of_all(bool out_too)
{
    const stf_world *const worlds[] = {world, bare, exploded, unsavable, hasty};
    const double accuracy = stf_trade_reference_accuracy(good.reference).reach;
    uint64_t hash = hash_clock(HASH_START, &a.the_clock);

    for (size_t i = 0; i < COUNT_OF(worlds); i++)
        hash = hash_world(hash, worlds[i]);
    hash = hash_bytes(hash, &accuracy, sizeof accuracy);
    if (out_too)
        hash = hash_bytes(hash_bytes(hash, &out, sizeof out), &row.nanoseconds, sizeof row.nanoseconds);
    return hash;
}

/* ---- the rows ------------------------------------------------------------------------------------------------------------ */

static void put(const argument *to, const bad *value)
{
    char *at = (char *)&a + to->offset;
    void *none = NULL;
    size_t size = value->size;

    switch (to->kind->type) {
    case POINTER: memcpy(at, value->at ? value->at : &none, sizeof none); break;
    case SIZE:
        if (value->is_less)
            size = *(size_t *)(void *)((char *)&good + to->offset) - size;
        *(size_t *)(void *)at = size;
        break;
    case UNSIGNED: *(unsigned *)(void *)at = (unsigned)value->number; break;
    case INT: *(int *)(void *)at = (int)value->number; break;
    case WORD: *(uint32_t *)(void *)at = (uint32_t)value->number; break;
    case REAL: *(stf_real *)(void *)at = (stf_real)value->number; break;
    case DOUBLE: *(double *)(void *)at = value->number; break;
    }
}

/* Calls with this value, and another one unless that is NULL. */
static void check_row(const function *f, const argument *first, const bad *value, const argument *second, const bad *other,
                      uint64_t before)
{
    put(first, value);
    if (other)
        put(second, other);

    const stf_result result = f->call();
    const bool is_refused = result == value->expected || (other && result == other->expected);

    const bool is_as_before = hash_of_all(!f->says) == before;

    a = good;
    if (is_refused && is_as_before)
        return;
    print_error("%s with %s = %s", f->name, first->name, value->text);
    if (other)
        print_error(", %s = %s", second->name, other->text);
    print_error(": %s\n", is_refused ? "refused, but something has changed" : stf_result_text(result));
    fail();
}

static size_t check_function(const function *f)
{
    const uint64_t before = hash_of_all(!f->says);
    size_t rows = 0;

    for (const argument *x = f->arguments; x->name; x++)
        for (const bad *v = x->kind->values; v < x->kind->values + x->kind->count; v++, rows++) {
            check_row(f, x, v, NULL, NULL, before);
            for (const argument *y = x + 1; y->name; y++)
                for (const bad *w = y->kind->values; w < y->kind->values + y->kind->count; w++)
                    if (!(v->cures && w->cures)) {
                        check_row(f, x, v, y, w, before);
                        rows++;
                    }
        }
    return rows;
}

static void every_bad_argument_is_refused_and_changes_nothing(void **state)
{
    (void)state;
    size_t rows = 0;

    for (const function *f = functions; f < functions + COUNT_OF(functions); f++) {
        set_up();
        rows += check_function(f);
        const stf_result result = f->call(); /* what was refused was what was bad */
        if (result)
            print_error("%s with good arguments: %s\n", f->name, stf_result_text(result));
        assert_int_equal(result, STF_OK);
        tear_down();
    }
    print_message("%zu calls\n", rows);
}

/* Functions that say something where they refuse. */
static void what_is_not_there_is_said_to_be_nothing(void **state)
{
    (void)state;
    stf_mismatch mismatch = {.what = "garbage", .force = 7};
    char text[] = "garbage";
    unsigned ticks = 7;
    size_t count = 7;

    set_up();
    assert_refused(stf_clock_advance(a.clock, -1, &ticks), STF_ERROR_FRAME_TIME);
    assert_int_equal(ticks, 0);
    assert_null(stf_world_force_records(world, 2, &count));
    assert_int_equal(count, 0);
    assert_refused(stf_world_load(world, foreign, sizeof foreign, &mismatch), STF_ERROR_FOREIGN);
    assert_null(mismatch.what);
    assert_int_equal(stf_world_describe(NULL, text, sizeof text), 0);
    assert_string_equal(text, "");
    tear_down();
}

int main(int argument_count, char **arguments_given)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_bad_argument_is_refused_and_changes_nothing),
        cmocka_unit_test(what_is_not_there_is_said_to_be_nothing),
    };

    if (argument_count > 1 && strcmp(arguments_given[1], "--list") == 0) {
        for (size_t i = 0; i < COUNT_OF(functions); i++)
            puts(functions[i].name);
        return 0;
    }
    return cmocka_run_group_tests_name("bad input, " REAL_NAME, tests, NULL, NULL);
}
