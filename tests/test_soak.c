/*
 * Play: a clock and a world through uneven frames, hitches, pauses, and all that a game does to a world between two frames, in
 * a seeded script. An argument is how many seconds of simulated time to play with each integrator; 60 without one.
 *
 * The scene is stable under every integrator. Each particle has drag of k = DRAG / m >= 1 /s and hangs on an anchored spring, on
 * springs to others and in a softened well, which together make omega^2 < 30 /s^2: explicit Euler wants dt < k / omega^2, the Verlet
 * methods dt < 1 / k, and the longest step is 1/40 s.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/memory.h"
#include "support/saved.h"

#define PARTICLES_LEAST 20
#define PARTICLES_MOST 300 /* more than a block */
#define ADDED_MOST 8 /* at once */
#define SPRINGS_EACH 2     /* that come with a particle */
#define FRAMES_AN_EVENT 4
#define DRAG 2.0           /* kg/s, of masses from 1 to 2 kg */
#define FAR 1e4            /* m: what nothing in this scene can reach */
#define UNIT_ROUND_OFF (DBL_EPSILON / 2)

static const double steps[] = {1.0 / 60, 1.0 / 120, 1.0 / 50, 1.0 / 144, 1.0 / 40};
static const double frame_rates[] = {60, 144, 30, 59.94};
static const double time_scales[] = {1, 1, 1, 1, 0.5, 2, 0};

typedef struct play {
    stf_world *world;
    stf_clock clock;
    counting memory;
    uint64_t random;
    const stf_integrator *integrator;
    stf_force_id anchors, springs, well; /* well 0: there is none */
    double frame_seconds;
    double real;             /* s: the sum of all frames; exact, see whole_units */
    double wanted;           /* s of simulated time that the frames make: exact too, as scales are powers of 2 */
    double set_aside;        /* s of that which snapping held back */
    double single;           /* s that single steps came on top of it */
    double allowed;          /* s: how far round-off may take the clock from the sum of these */
    double step_start_time;  /* s, at step_start_tick: when the step was last set */
    uint64_t step_start_tick, ticks;
    size_t events, most_particles, most_bytes;
} play;

static double between(play *p, double low, double high) { return low + (high - low) * next_random(&p->random); }
static size_t below(play *p, size_t end) { return (size_t)(next_random(&p->random) * (double)end); }

/* Sums of multiples of 2^-34 s are exact below 2^19 s. */
static double whole_units(double seconds) { return ldexp(floor(ldexp(seconds, 34)), -34); }

static stf_particle any_particle(play *p)
{
    stf_particle particle = {.inverse_mass = below(p, 20) == 0 ? 0 : (stf_real)between(p, 0.5, 1)};

    particle.position = (stf_vector){(stf_real)between(p, -10, 10), (stf_real)between(p, -10, 10), (stf_real)between(p, -10, 10)};
    if (particle.inverse_mass > 0)
        particle.velocity = (stf_vector){(stf_real)between(p, -5, 5), (stf_real)between(p, -5, 5), 0};
    return particle;
}

/* ---- what happens between frames ----------------------------------------------------------------------------------------- */

/* A force's records and one more. */
static void append_record(play *p, stf_force_id id, const void *record)
{
    const size_t size = stf_world_force(p->world, id)->record_size;
    size_t count;
    const void *records = stf_world_force_records(p->world, id, &count);
    unsigned char *more = malloc((count + 1) * size);

    assert_non_null(more);
    if (count > 0)
        memcpy(more, records, count * size);
    memcpy(more + count * size, record, size);
    assert_ok(stf_world_set_force(p->world, id, more, count + 1));
    free(more);
}

/* Each spring belongs to the particle that it came with, so there are never more than SPRINGS_EACH for each. */
static void add_one(play *p)
{
    const stf_particle particle = any_particle(p);
    const size_t count = stf_world_count(p->world);
    size_t index;

    if (count == PARTICLES_MOST)
        return;
    assert_ok(stf_world_add(p->world, &particle, &index));
    append_record(p, p->anchors, &(stf_anchored_spring){.particle = (uint32_t)index, .anchor = particle.position, .stiffness = 2,
                                                        .damping = (stf_real)0.5});
    for (unsigned i = 0; count > 0 && i < SPRINGS_EACH; i++)
        append_record(p, p->springs, &(stf_spring){.a = (uint32_t)index, .b = (uint32_t)below(p, count),
                                                   .stiffness = (stf_real)0.25, .damping = (stf_real)0.125, .rest_length = 5});
}

static void add(play *p)
{
    for (size_t i = below(p, ADDED_MOST) + 1; i > 0; i--)
        add_one(p);
}

static void take_away(play *p)
{
    if (stf_world_count(p->world) > PARTICLES_LEAST)
        assert_ok(stf_world_remove(p->world, below(p, stf_world_count(p->world)), NULL));
}

/* Now and then all are gone, and a few come anew. */
static void start_over(play *p)
{
    if (below(p, 40) > 0)
        return;
    assert_ok(stf_world_clear(p->world));
    while (stf_world_count(p->world) < PARTICLES_LEAST)
        add_one(p);
}

static void teleport(play *p)
{
    const stf_particle particle = any_particle(p);

    assert_ok(stf_world_set(p->world, below(p, stf_world_count(p->world)), &particle));
}

static void change_gravity(play *p)
{
    assert_ok(stf_world_set_gravity(p->world, (stf_vector){0, (stf_real)between(p, -20, 5), 0}));
}

/* The well comes, changes or goes. */
static void change_well(play *p)
{
    const stf_attractor well = {.strength = (stf_real)between(p, -4, 4), .softening = 1};

    if (p->well == 0)
        assert_ok(stf_world_add_force(p->world, &stf_force_attractor, &well, 1, &p->well));
    else if (below(p, 2) == 0)
        assert_ok(stf_world_set_force(p->world, p->well, &well, 1));
    else {
        assert_ok(stf_world_remove_force(p->world, p->well));
        p->well = 0;
    }
}

/* The clock's time is rounded twice when the step changes, and not when it is set to what it is. */
static void change_step(play *p)
{
    const double step = steps[below(p, COUNT_OF(steps))];

    if (step != p->clock.step) {
        p->allowed += 2 * UNIT_ROUND_OFF * stf_clock_time(&p->clock);
        p->step_start_time = stf_world_time(p->world);
        p->step_start_tick = p->ticks;
    }
    assert_ok(stf_clock_set_step(&p->clock, step));
    assert_ok(stf_world_set_step(p->world, step));
}

static void change_substeps(play *p) { assert_ok(stf_world_set_substeps(p->world, 1 + (unsigned)below(p, 4))); }

/* Another one every now and then, for a while. */
static void change_integrator(play *p)
{
    const stf_integrator *other = stf_integrators[below(p, 7)];

    assert_ok(stf_world_set_integrator(p->world, below(p, 4) == 0 ? other : p->integrator));
}

static void change_frame_rate(play *p)
{
    const double rate = frame_rates[below(p, COUNT_OF(frame_rates))];

    p->frame_seconds = 1 / rate;
    assert_ok(stf_clock_set_display_period(&p->clock, below(p, 2) == 0 ? 0 : 1 / rate));
}

/* A scale of 0 is a pause; now and then one tick is run in it. */
static void change_time_scale(play *p)
{
    assert_ok(stf_clock_set_time_scale(&p->clock, time_scales[below(p, COUNT_OF(time_scales))]));
    if (below(p, 4) == 0)
        assert_ok(stf_clock_single_step(&p->clock));
}

/* A guess at what the other player does, played and taken back. */
static void roll_back(play *p)
{
    static void (*const guesses[])(play *) = {add, take_away, teleport, change_gravity, change_substeps};
    const size_t size = stf_world_snapshot_size(p->world);
    void *snapshot = malloc(size);
    saved before = save_of(p->world);

    assert_non_null(snapshot);
    assert_ok(stf_world_snapshot(p->world, snapshot, size));
    for (int tick = 0; tick < 8; tick++) {
        guesses[below(p, COUNT_OF(guesses))](p);
        assert_ok(stf_world_step(p->world, 1));
    }
    assert_ok(stf_world_restore(p->world, snapshot, size));
    assert_true(saved_is(before, p->world));
    saved_free(&before);
    free(snapshot);
}

/* Play goes on in another world, which has loaded this one. */
static void save_and_load(play *p)
{
    saved before = save_of(p->world);
    stf_world *loaded = make_world((stf_world_def){.integrator = stf_world_integrator(p->world), .keep_previous = true,
                                                   .allocator = counting_allocator(&p->memory)});

    for (size_t n = 0; stf_world_force_at(p->world, n); n++)
        add_force(loaded, stf_world_force(p->world, stf_world_force_at(p->world, n)), NULL);
    assert_ok(stf_world_load(loaded, before.bytes, before.size, NULL));
    assert_true(saved_is(before, loaded));
    saved_free(&before);
    stf_world_destroy(p->world);
    p->world = loaded;
}

static void (*const events[])(play *) = {add, add, take_away, take_away, teleport, teleport, start_over, change_gravity, change_well,
                                         change_step, change_substeps, change_integrator, change_frame_rate,
                                         change_time_scale, roll_back, save_and_load};

/* ---- frames -------------------------------------------------------------------------------------------------------------- */

/* Mostly as the display has it, with a timer's jitter; now and then a hitch of 0.1 to 3 s. */
static double next_frame(play *p)
{
    return whole_units(below(p, 150) == 0 ? between(p, 0.1, 3) : p->frame_seconds + between(p, -0.0005, 0.0005));
}

/*
 * The sums of the identity in the clock's header, and the round-off of a frame: four half ulps, as in test_clock.c, and one for
 * each of the sums that are not exact.
 */
static void advance(play *p)
{
    const stf_clock before = p->clock;
    const double seconds = next_frame(p);
    unsigned ticks;

    assert_ok(stf_clock_advance(&p->clock, seconds, &ticks));
    assert_ok(stf_world_step(p->world, ticks));
    p->ticks += ticks;
    p->real += seconds;
    p->wanted += before.time_scale * seconds;
    p->set_aside += before.time_scale * (p->clock.set_aside - before.set_aside);
    p->allowed += 4 * UNIT_ROUND_OFF * (before.time_scale * seconds + fabs(before.remainder) + before.step);
    p->allowed += 4 * UNIT_ROUND_OFF * (fabs(p->set_aside) + fabs(before.set_aside) + fabs(p->clock.set_aside));
    if (p->clock.dropped_this_frame > 0)
        p->allowed += UNIT_ROUND_OFF * p->clock.dropped;
    if (before.single_steps > p->clock.single_steps) {
        p->single += before.step;
        p->allowed += UNIT_ROUND_OFF * p->single;
    }
}

static double time_off(const play *p)
{
    return stf_clock_time(&p->clock) + p->clock.remainder + p->clock.dropped - p->wanted - p->single + p->set_aside;
}

/* That sum has five half ulps of its own, and time a product's and a sum's. */
static double time_off_allowed(const play *p) { return p->allowed + 7 * UNIT_ROUND_OFF * (p->wanted + p->single); }

static void check_frame(play *p)
{
    const double time = p->step_start_time + (double)(p->ticks - p->step_start_tick) * stf_world_step_size(p->world);
    const stf_particles all = stf_world_view(p->world);
    float positions[PARTICLES_MOST * STF_DIMENSIONS_MAX];

    assert_true(p->clock.ticks == p->ticks && stf_world_ticks(p->world) == p->ticks);
    assert_true(stf_world_time(p->world) == time && stf_clock_time(&p->clock) == time);
    assert_close(time_off(p), 0, time_off_allowed(p));
    assert_false(stf_world_find_non_finite(p->world, NULL));
    assert_ok(stf_world_copy_positions(p->world, stf_clock_alpha(&p->clock), positions, 0));
    for (size_t i = 0; i < all.count * STF_DIMENSIONS_MAX; i++)
        assert_below(fabs((double)positions[i]), FAR);
    p->most_particles = all.count > p->most_particles ? all.count : p->most_particles;
    p->most_bytes = p->memory.bytes > p->most_bytes ? p->memory.bytes : p->most_bytes;
}

/* ---- memory -------------------------------------------------------------------------------------------------------------- */

/* A world that has room for all that there can be at once, under each integrator in turn. */
static size_t bytes_of_the_largest_world(void)
{
    counting memory = {.blocks = 0};
    stf_world *world = make_world((stf_world_def){.keep_previous = true, .capacity = PARTICLES_MOST,
                                                  .allocator = counting_allocator(&memory)});
    stf_anchored_spring anchors[PARTICLES_MOST];
    stf_spring springs[SPRINGS_EACH * PARTICLES_MOST];

    for (uint32_t i = 0; i < PARTICLES_MOST; i++) {
        assert_ok(stf_world_add(world, &(stf_particle){.inverse_mass = 1}, NULL));
        anchors[i] = (stf_anchored_spring){.particle = i};
    }
    for (uint32_t i = 0; i < SPRINGS_EACH * PARTICLES_MOST; i++)
        springs[i] = (stf_spring){.a = i % PARTICLES_MOST, .b = (i + 1) % PARTICLES_MOST};
    assert_ok(stf_world_add_force(world, &stf_force_anchored_springs, anchors, COUNT_OF(anchors), NULL));
    assert_ok(stf_world_add_force(world, &stf_force_springs, springs, COUNT_OF(springs), NULL));
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){1});
    add_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){1});
    add_force(world, &stf_force_attractor, &(stf_attractor){.strength = 1});
    for (int k = 0; stf_integrators[k]; k++)
        assert_ok(stf_world_set_integrator(world, stf_integrators[k]));
    const size_t bytes = memory.bytes;
    stf_world_destroy(world);
    return bytes;
}

/* ---- the play ------------------------------------------------------------------------------------------------------------ */

static void start(play *p, const stf_integrator *integrator)
{
    *p = (play){.integrator = integrator, .random = 1, .frame_seconds = 1.0 / 60};
    assert_ok(stf_clock_init(&p->clock, &(stf_clock_def){.step = steps[0]}));
    p->world = make_world((stf_world_def){.integrator = integrator, .step = steps[0], .keep_previous = true,
                                          .gravity = {0, -10, 0}, .allocator = counting_allocator(&p->memory)});
    assert_ok(stf_world_add_force(p->world, &stf_force_anchored_springs, NULL, 0, &p->anchors));
    assert_ok(stf_world_add_force(p->world, &stf_force_springs, NULL, 0, &p->springs));
    add_force(p->world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)DRAG});
    add_force(p->world, &stf_force_quadratic_drag, &(stf_quadratic_drag){(stf_real)0.01});
    for (unsigned i = 0; i < PARTICLES_LEAST; i++)
        add_one(p);
}

static void report(const play *p, size_t bytes_allowed)
{
    printf("%-20s %-7s %8.0f %8.0f %8.0f %8llu %7zu %9.1e %9.1e %9zu %8zu %8zu\n", p->integrator->name, REAL_NAME, p->real,
           stf_clock_time(&p->clock), p->clock.dropped, (unsigned long long)p->ticks, p->events, time_off(p), time_off_allowed(p),
           p->most_particles, p->most_bytes, bytes_allowed);
}

/* A world that grows takes up to twice the room. */
static void play_loses_no_time_no_memory_and_no_particle(void **state)
{
    const double *seconds = *state;
    const size_t bytes_allowed = 2 * bytes_of_the_largest_world();

    printf("%-20s %-7s %8s %8s %8s %8s %7s %9s %9s %9s %8s %8s\n", "integrator", "", "real, s", "play, s", "drop, s", "ticks",
           "events", "off, s", "allowed", "particles", "bytes", "allowed");
    for (int k = 0; stf_integrators[k]; k++) {
        play p;

        start(&p, stf_integrators[k]);
        while (stf_clock_time(&p.clock) < *seconds) {
            if (below(&p, FRAMES_AN_EVENT) == 0) {
                events[below(&p, COUNT_OF(events))](&p);
                p.events++;
            }
            advance(&p);
            check_frame(&p);
        }
        report(&p, bytes_allowed);
        assert_true(p.most_bytes <= bytes_allowed);
        stf_world_destroy(p.world);
        assert_int_equal(p.memory.blocks, 0);
        assert_int_equal(p.memory.bytes, 0);
    }
}

int main(int argc, char **argv)
{
    char *end = NULL;
    double seconds = argc > 1 ? strtod(argv[1], &end) : 60;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate(play_loses_no_time_no_memory_and_no_particle, &seconds),
    };

    if (argc > 1 && (*end || !(seconds > 0))) {
        fprintf(stderr, "soak: wants seconds of play, above 0, and not \"%s\"\n", argv[1]);
        return 2;
    }
    return cmocka_run_group_tests_name("soak, " REAL_NAME, tests, NULL, NULL);
}
