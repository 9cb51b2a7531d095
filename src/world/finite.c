#include "world.h"

bool stf_world_find_non_finite(const stf_world *world, size_t *index)
{
    for (size_t i = 0; i < stf_world_count(world); i++) {
        const size_t at = stf_world_offset(world, i);
        for (unsigned d = 0; d < world->dimensions; d++) {
            const size_t component = at + d * world->storage.stride;
            if (isfinite(world->storage.position[component]) && isfinite(world->storage.velocity[component]))
                continue;
            if (index)
                *index = i;
            return true;
        }
    }
    return false;
}
