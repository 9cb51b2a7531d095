/* The bytes are a program of calls: first what the two worlds are made of, then operations with their arguments. */
#include "calls/game.h"

/* An operation's number is what the seeds hold: others go behind, or into a place that is empty or there twice. */
#define OPERATIONS 64
static void (*const operations[OPERATIONS])(game *g) = {
    add, add_crowd, set, remove_particle, clear, reserve, add_force, set_force, set_own_records, remove_force, set_gravity,
    set_step, set_substeps, set_integrator, step, leap, fail_next, save, load, revive, snapshot, restore, ask, copy_positions,
    accelerations, measure_stability, create, use_clock, pass_null, step, add, add_force,
    trade, set_guard, freeze,
};

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    static game g;

    g.program = (program){.at = bytes, .left = size};
    if (game_start(&g))
        while (g.program.left > 0 && g.work > 0) {
            void (*operation)(game *) = operations[take(&g.program) % OPERATIONS];

            if (!operation)
                continue;
            operation(&g);
            if (operation != fail_next)
                inspect(&g);
        }
    game_end(&g);
    return 0;
}
