#include "steadfast/world.h"
#include "workload.h"

const char *bench_isa(void)
{
    static const char *isa;
    const stf_world_def def = {0};
    stf_world *world;

    if (!isa && stf_world_create(&def, &world) == STF_OK) {
        isa = stf_world_isa(world);
        stf_world_destroy(world);
    }
    return isa ? isa : "baseline";
}
