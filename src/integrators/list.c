#include <string.h>

#include "../real.h"
#include "steadfast/integrator.h"

const stf_integrator *const stf_integrators[] = {
    &stf_explicit_euler, &stf_semi_implicit_euler, &stf_midpoint,        &stf_improved_euler,
    &stf_rk4,            &stf_position_verlet,     &stf_velocity_verlet, NULL,
};

const stf_integrator *stf_integrator_find(const char *name)
{
    for (const stf_integrator *const *each = stf_integrators; name && *each; each++)
        if (strcmp((*each)->name, name) == 0)
            return *each;
    return NULL;
}
