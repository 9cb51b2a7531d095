#include "world.h"

typedef struct sums {
    double kinetic, gravity_potential;
    double momentum[STF_DIMENSIONS_MAX];
} sums;

/* In double and in the order of indices, so that the result depends on nothing but the state. */
static sums sum_particles(const stf_world *world)
{
    const stf_storage *storage = &world->storage;
    sums sum = {0};

    for (size_t i = 0; i < world->count; i++) {
        if (!(storage->inverse_mass[i] > 0))
            continue;
        const double mass = 1 / (double)storage->inverse_mass[i];
        const size_t at = stf_world_offset(world, i);
        for (unsigned d = 0; d < world->dimensions; d++) {
            const double x = (double)storage->position[at + d * storage->stride];
            const double v = (double)storage->velocity[at + d * storage->stride];
            sum.kinetic += mass * v * v / 2;
            sum.gravity_potential -= mass * (double)world->gravity[d] * x;
            sum.momentum[d] += mass * v;
        }
    }
    return sum;
}

static double potential_of(const stf_world *world, const stf_added_force *added)
{
    const stf_storage *storage = &world->storage;
    const size_t blocks = stf_world_blocks(world);
    const size_t range_blocks = added->force->kind == STF_LINK ? blocks : 1;
    double sum = 0;

    for (size_t first = 0; first < blocks; first += range_blocks) {
        const size_t at = first * stf_world_block_length(world);
        const stf_particles particles =
            stf_world_particles(world, first, range_blocks, storage->position + at, storage->velocity + at, NULL);
        sum += added->force->potential(added->records, added->record_count, &particles, stf_world_time(world));
    }
    return sum;
}

stf_result stf_world_energy(const stf_world *world, stf_energy *energy)
{
    if (!world || !energy)
        return STF_ERROR_NULL;

    const sums sum = sum_particles(world);

    *energy = (stf_energy){.kinetic = sum.kinetic, .potential = sum.gravity_potential};
    for (size_t i = 0; i < world->force_count; i++)
        if (world->forces[i].force->potential && stf_force_acts(&world->forces[i]))
            energy->potential += potential_of(world, &world->forces[i]);
    return STF_OK;
}

stf_result stf_world_momentum(const stf_world *world, double momentum[STF_DIMENSIONS_MAX])
{
    if (!world || !momentum)
        return STF_ERROR_NULL;

    const sums sum = sum_particles(world);

    for (unsigned d = 0; d < STF_DIMENSIONS_MAX; d++)
        momentum[d] = sum.momentum[d];
    return STF_OK;
}
