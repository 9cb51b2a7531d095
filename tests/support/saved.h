/* What the tests of save and snapshot share: saved worlds, and a world in which everything happens that a save has to keep. */
#ifndef STEADFAST_TESTS_SAVED_H
#define STEADFAST_TESTS_SAVED_H

#include "steadfast/steadfast.h"

/* A world's state as stf_world_save writes it, in memory of exactly this size. */
typedef struct saved {
    unsigned char *bytes;
    size_t size;
} saved;

saved save_of(const stf_world *world);
saved copy_of(saved s);
void saved_free(saved *s);
bool saved_is(saved s, const stf_world *world);

/* The k-th real from the end of what was saved, the last being the last particle's last history. */
stf_real saved_from_end(saved s, size_t k);

/* Two steps of history: x += v dt; v += (23 a(n) - 16 a(n-1) + 5 a(n-2)) dt / 12 (Adams and Bashforth, 1883). */
extern const stf_integrator remembering;

/* stf_integrators, and `remembering`; NULL-terminated. */
#define SAVED_INTEGRATORS 8
extern const stf_integrator *const saved_integrators[SAVED_INTEGRATORS + 1];

/* A user's force whose records have numbers of every size, pads between them, and one behind. */
typedef struct mixed {
    uint8_t tiny;
    uint64_t large;
    uint16_t small;
    stf_real push; /* N along x */
    uint32_t middle;
    uint8_t last;
} mixed;
extern const stf_force mixed_force;

/* In two dimensions, with previous positions, radii, springs, anchored springs, linear drag and mixed_force; ids 1, 3, 4, 5. */
stf_world *busy_world(const stf_integrator *integrator, size_t capacity, stf_allocator allocator);

/* What happens to it before tick n: particles come, go and are set; records, gravity, substeps and the step change. */
void busy_event(stf_world *world, unsigned n);

#endif
