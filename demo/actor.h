/* actor: a world that takes part in a session, and what has to be noted of it while it runs. */
#ifndef STEADFAST_DEMO_ACTOR_H
#define STEADFAST_DEMO_ACTOR_H

#include <SDL.h>

#include "scenes/scene.h"
#include "trail.h"

/* J. What happens between two samples is not seen. */
typedef struct energy_samples {
    double start, now;
    double largest_change; /* of |now - start| so far */
    double scale;          /* largest kinetic + |potential| so far */
} energy_samples;

typedef struct actor {
    stf_world *world; /* NULL: takes no part */
    trail trail;
    float *drawn;     /* [count][3]: positions to draw, set by session_place */
    energy_samples energy;
    bool lost;        /* not finite any more since its last tick: it is stepped no further */
    size_t lost_particle;
} actor;

/* Makes the scene's world. On an error *a is all zero, which is valid and takes no part. */
stf_result actor_open(actor *a, const scene *of, const stf_world_def *overrides);
void actor_close(actor *a);

/* One tick, unless it is lost or takes no part; *counts grows by what the step took, in counts of SDL's performance counter. */
stf_result actor_tick(actor *a, Uint64 *counts);

/* Looks at the energy, unless it is lost or takes no part. Cost: that of stf_world_energy. */
stf_result actor_sample_energy(actor *a);

/* Root mean square of the distance between each particle and the one of the same index, length units. */
double actor_distance(const actor *a, const actor *b);

#endif
