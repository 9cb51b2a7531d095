#include "support/check.h"

#include <math.h>
#include <string.h>

bool is_close(double actual, double expected, double tolerance)
{
    return fabs(actual - expected) <= tolerance || (isinf(actual) && actual == expected);
}

bool is_below(double actual, double bound) { return actual < bound; }

void check_close(double actual, double expected, double tolerance, const char *what, const char *file, int line)
{
    if (is_close(actual, expected, tolerance))
        return;
    print_error("%s = %.17g, expected %.17g within %.3g (off by %.3g)\n", what, actual, expected, tolerance,
                actual - expected);
    _fail(file, line);
}

void check_below(double actual, double bound, const char *what, const char *file, int line)
{
    if (is_below(actual, bound))
        return;
    print_error("%s = %.17g, expected less than %.17g\n", what, actual, bound);
    _fail(file, line);
}

void check_result(stf_result result, stf_result expected, const char *what, const char *file, int line)
{
    if (result == expected)
        return;
    print_error("%s: got \"%s\", expected \"%s\"\n", what, stf_result_text(result), stf_result_text(expected));
    _fail(file, line);
}

uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const unsigned char *at = bytes;

    for (size_t i = 0; i < count; i++)
        hash = (hash ^ at[i]) * UINT64_C(0x100000001b3);
    return hash;
}

static uint64_t hash_particles(uint64_t hash, const stf_world *world)
{
    for (size_t i = 0; i < stf_world_count(world); i++) {
        const stf_particle particle = particle_of(world, i);
        const stf_real reals[] = {particle.position.x, particle.position.y, particle.position.z, particle.velocity.x,
                                  particle.velocity.y, particle.velocity.z, particle.inverse_mass, particle.radius};
        hash = hash_bytes(hash, reals, sizeof reals);
    }
    return hash;
}

static uint64_t hash_forces(uint64_t hash, const stf_world *world)
{
    stf_force_id id;

    for (size_t n = 0; (id = stf_world_force_at(world, n)) != 0; n++) {
        const stf_force *force = stf_world_force(world, id);
        size_t count = 0;
        const void *records = stf_world_force_records(world, id, &count);

        hash = hash_bytes(hash, &id, sizeof id);
        hash = hash_bytes(hash, &force, sizeof force);
        hash = hash_bytes(hash, &count, sizeof count);
        if (records)
            hash = hash_bytes(hash, records, count * force->record_size);
    }
    return hash;
}

uint64_t hash_of(const stf_world *world)
{
    const size_t count = stf_world_count(world);
    const uint64_t ticks = stf_world_ticks(world);
    const double times[] = {stf_world_time(world), stf_world_step_size(world)};
    const unsigned numbers[] = {stf_world_substeps(world), stf_world_dimensions(world)};
    const stf_vector gravity = stf_world_gravity(world);
    const stf_integrator *integrator = stf_world_integrator(world);
    uint64_t hash = HASH_START;

    hash = hash_bytes(hash, &count, sizeof count);
    hash = hash_bytes(hash, &ticks, sizeof ticks);
    hash = hash_bytes(hash, times, sizeof times);
    hash = hash_bytes(hash, numbers, sizeof numbers);
    hash = hash_bytes(hash, &gravity, sizeof gravity);
    hash = hash_bytes(hash, &integrator, sizeof integrator);
    return hash_forces(hash_particles(hash, world), world);
}

double next_random(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    z ^= z >> 31;
    return (double)(z >> 40) / (double)(UINT64_C(1) << 24);
}

stf_world *make_world(stf_world_def def)
{
    stf_world *world = NULL;

    assert_ok(stf_world_create(&def, &world));
    return world;
}

void add_force(stf_world *world, const stf_force *force, const void *record)
{
    assert_ok(stf_world_add_force(world, force, record, record ? 1 : 0, NULL));
}

stf_particle particle_of(const stf_world *world, size_t index)
{
    stf_particle particle = {.inverse_mass = 0};

    assert_ok(stf_world_get(world, index, &particle));
    return particle;
}
