#include "support/saved.h"

#include <stdlib.h>
#include <string.h>

#include "support/check.h"

#define CHECKSUM_BYTES 4 /* behind all else, see src/world/format.h */

saved save_of(const stf_world *world)
{
    saved s = {.size = stf_world_save_size(world)};

    s.bytes = malloc(s.size);
    assert_non_null(s.bytes);
    assert_ok(stf_world_save(world, s.bytes, s.size));
    return s;
}

saved copy_of(saved s)
{
    saved copy = {.bytes = malloc(s.size), .size = s.size};

    assert_non_null(copy.bytes);
    memcpy(copy.bytes, s.bytes, s.size);
    return copy;
}

void saved_free(saved *s)
{
    free(s->bytes);
    *s = (saved){.bytes = NULL};
}

bool saved_is(saved s, const stf_world *world)
{
    saved now = save_of(world);
    const bool same = now.size == s.size && memcmp(now.bytes, s.bytes, s.size) == 0;

    saved_free(&now);
    return same;
}

stf_real saved_from_end(saved s, size_t k)
{
    const unsigned char *at = s.bytes + s.size - CHECKSUM_BYTES - (k + 1) * sizeof(stf_real);
#ifdef STF_DOUBLE
    uint64_t bits = 0;
#else
    uint32_t bits = 0;
#endif
    stf_real x;

    for (size_t i = sizeof x; i-- > 0;)
        bits = bits << 8 | at[i];
    memcpy(&x, &bits, sizeof x);
    return x;
}

static void remembering_step(stf_system *system, stf_real dt)
{
    stf_real *x = system->position, *v = system->velocity, *a = system->work[0];
    stf_real *one_ago = system->history[0], *two_ago = system->history[1];

    system->accelerate(system, system->time, x, v, a);
    for (size_t i = 0; i < system->length; i++) {
        if (one_ago[i] != one_ago[i])
            one_ago[i] = two_ago[i] = a[i];
        x[i] += v[i] * dt;
        v[i] += (23 * a[i] - 16 * one_ago[i] + 5 * two_ago[i]) * dt / 12;
        two_ago[i] = one_ago[i];
        one_ago[i] = a[i];
    }
}

const stf_integrator remembering = {.name = "remembering", .step = remembering_step, .order = 1, .evaluations = 1,
                                    .work_arrays = 1, .history_arrays = 2};

const stf_integrator *const saved_integrators[SAVED_INTEGRATORS + 1] = {
    &stf_explicit_euler, &stf_semi_implicit_euler, &stf_midpoint,        &stf_improved_euler, &stf_rk4,
    &stf_position_verlet, &stf_velocity_verlet,     &remembering,         NULL,
};

static void push(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const mixed *m = records;
    (void)time;

    for (size_t r = 0; r < record_count; r++)
        for (size_t i = 0; i < particles->count; i++)
            particles->force[i] += m[r].push * (stf_real)(m[r].tiny + m[r].small + m[r].last);
}

const stf_force mixed_force = {.name = "mixed", .kind = STF_FIELD, .record_size = sizeof(mixed), .apply = push,
                               .fields = "182r41"};

static const mixed mixed_record = {.tiny = 3, .large = UINT64_C(0x0123456789abcdef), .small = 0x1234, .push = (stf_real)0.001,
                                   .middle = 0x89abcdef, .last = 0xfe};

stf_world *busy_world(const stf_integrator *integrator, size_t capacity, stf_allocator allocator)
{
    stf_world *world = make_world((stf_world_def){.dimensions = 2, .integrator = integrator, .step = 1.0 / 64,
                                                  .gravity = {0, -10, 0}, .capacity = capacity, .keep_previous = true,
                                                  .keep_radius = true, .allocator = allocator});
    stf_anchored_spring anchor;
    stf_spring spring;

    for (int i = 0; i < 4; i++)
        assert_ok(stf_world_add(world, &(stf_particle){.position = {(stf_real)i, 0, 0}, .velocity = {0, (stf_real)i, 0},
                                                       .inverse_mass = (stf_real)i, .radius = (stf_real)0.5}, NULL));
    /* pads are garbage, as on any stack */
    memset(&spring, 0x5a, sizeof spring);
    spring.a = 2, spring.b = 1, spring.stiffness = 8, spring.damping = 1, spring.rest_length = 1;
    memset(&anchor, 0x5a, sizeof anchor);
    anchor.particle = 3, anchor.anchor.x = 3, anchor.anchor.y = anchor.anchor.z = 0;
    anchor.stiffness = 4, anchor.damping = 1, anchor.rest_length = 0;
    add_force(world, &stf_force_springs, &spring);
    add_force(world, &stf_force_attractor, NULL);
    assert_ok(stf_world_remove_force(world, 2));
    add_force(world, &stf_force_anchored_springs, &anchor);
    add_force(world, &stf_force_linear_drag, &(stf_linear_drag){(stf_real)0.25});
    add_force(world, &mixed_force, &mixed_record);
    return world;
}

void busy_event(stf_world *world, unsigned n)
{
    const stf_particle particle = {.position = {(stf_real)n, 1, 0}, .velocity = {1, (stf_real)n, 0}, .inverse_mass = 1};
    const stf_spring springs[] = {{3, 1, 9, 0, 1}, {1, 2, 9, 0, 1}, {0, 1, 7, 1, 1}};

    switch (n % 12) {
    case 1: assert_ok(stf_world_add(world, &particle, NULL)); break;
    case 2: assert_ok(stf_world_set(world, 1, &particle)); break;
    case 4: assert_ok(stf_world_remove(world, 0, NULL)); break;
    case 5: assert_ok(stf_world_set_force(world, 1, springs, 3)); break;
    case 6: assert_ok(stf_world_set_gravity(world, (stf_vector){(stf_real)n, -9, 0})); break;
    case 8: assert_ok(stf_world_set_substeps(world, 3)); break;
    case 9: assert_ok(stf_world_set_step(world, 1.0 / 48)); break;
    case 10: assert_ok(stf_world_set_force(world, 5, NULL, 0)); break;
    case 11: assert_ok(stf_world_set_force(world, 5, &mixed_record, 1)); break;
    default: break;
    }
}
