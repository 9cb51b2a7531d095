/* Positions, blended, as floats for a vertex buffer. */
#include <string.h>

#include "world.h"

/* before + alpha (now - before), as floats that lie `bytes` apart. */
static void copy_row(size_t n, char *to, size_t bytes, const stf_real *before, const stf_real *now, stf_real alpha)
{
    for (size_t i = 0; i < n; i++) {
        const float blended = (float)(before[i] + alpha * (now[i] - before[i]));
        memcpy(to + i * bytes, &blended, sizeof blended);
    }
}

stf_result stf_world_copy_positions(const stf_world *world, double alpha, void *positions, size_t stride_bytes)
{
    if (!world || (!positions && world->count > 0))
        return STF_ERROR_NULL;
    if (!(alpha >= 0 && alpha <= 1))
        return STF_ERROR_ALPHA;
    if (alpha < 1 && !world->keep_previous)
        return STF_ERROR_NO_PREVIOUS;
    if (stride_bytes > 0 && stride_bytes < world->dimensions * sizeof(float))
        return STF_ERROR_STRIDE;
    if (world->count > 0 && stride_bytes > SIZE_MAX / 2 / world->count)
        return STF_ERROR_STRIDE;

    const size_t bytes = stride_bytes ? stride_bytes : world->dimensions * sizeof(float);
    const size_t stride = world->storage.stride;
    const stf_real *before = alpha < 1 ? world->storage.previous : world->storage.position;
    const stf_real *now = alpha > 0 ? world->storage.position : before; /* 0 x infinity is none of a finite past */

    for (size_t first = 0; first < world->count; first += stride) {
        const size_t n = world->count - first < stride ? world->count - first : stride;
        for (unsigned d = 0; d < world->dimensions; d++) {
            const size_t row = stf_world_offset(world, first) + d * stride;
            copy_row(n, (char *)positions + first * bytes + d * sizeof(float), bytes, before + row, now + row,
                     (stf_real)alpha);
        }
    }
    return STF_OK;
}
