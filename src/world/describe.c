#include <stdarg.h>
#include <stdio.h>

#include "world.h"

/* Text that is written as far as there is room, and measured beyond. */
typedef struct text {
    char *at;
    size_t size, length;
} text;

STF_PRINTF(2, 3) static void append(text *t, const char *format, ...)
{
    const size_t room = t->length < t->size ? t->size - t->length : 0;
    va_list arguments;

    va_start(arguments, format);
    const int written = vsnprintf(room ? t->at + t->length : NULL, room, format, arguments);
    va_end(arguments);
    if (written > 0)
        t->length += (size_t)written;
}

static const char *plural(unsigned long long n) { return n == 1 ? "" : "s"; }

/* A row of the table; 0 passes or bytes are a dash. */
static void append_row(text *t, const char *name, unsigned long long passes, double bytes, const char *remark)
{
    char pass_text[32] = "-", byte_text[32] = "-";

    if (passes > 0)
        (void)snprintf(pass_text, sizeof pass_text, "%llu", passes);
    if (bytes > 0)
        (void)snprintf(byte_text, sizeof byte_text, "%.1f", bytes);
    append(t, "  %-32s %13s %16s%s%s\n", name, pass_text, byte_text, remark[0] ? "   " : "", remark);
}

static bool in_flight(const stf_world *world) { return stf_world_is_free(world) && world->stepper->step_flight; }

static void append_head(text *t, const stf_world *world)
{
    const stf_integrator *integrator = world->integrator;
    const unsigned long long particles = world->count, blocks = stf_world_blocks(world);
    const unsigned parts = stf_world_parts(world, SIZE_MAX);

    append(t, "world of %u dimension%s in %s: %llu particle%s in %llu block%s of %zu\n", world->dimensions,
           plural(world->dimensions), STF_REAL_NAME, particles, plural(particles), blocks, plural(blocks),
           world->storage.stride);
    append(t, "tick of %.6g s: %u step%s of %s (order %d, %d evaluation%s)\n", world->step, world->substeps,
           plural(world->substeps), integrator->name, integrator->order, integrator->evaluations,
           plural((unsigned long long)integrator->evaluations));
    append(t, "loops compiled for %s; a step in %s%u part%s\n", world->kernels->name, parts > 1 ? "up to " : "", parts,
           plural(parts));
    if (stf_world_is_tied(world))
        append(t, "links tie particles together: every pass runs over the whole world\n");
    else if (in_flight(world))
        append(t, "free flight: one pass a step, memory is read and written once a tick\n");
    else
        append(t, "block by block: every pass runs in cache, memory is read and written once a tick\n");
}

static void append_guard(text *t, const stf_world *world)
{
    const stf_guard *guard = &world->guard;
    const bool freezes = guard->mode == STF_GUARD_FREEZE;

    if (guard->mode == STF_GUARD_OFF)
        return;
    append(t, "guard: %s; a look at every particle each %u tick%s", freezes ? "freezes" : "reports", stf_guard_interval(world),
           plural(stf_guard_interval(world)));
    if (guard->position_bound > 0)
        append(t, "; within %.6g m", guard->position_bound);
    if (guard->velocity_bound > 0)
        append(t, "; up to %.6g m/s", guard->velocity_bound);
    if (world->fault.kind != STF_FAULT_NONE)
        append(t, "; found particle %llu at tick %llu", (unsigned long long)world->fault.particle,
               (unsigned long long)world->fault.tick);
    append(t, "\n");
}

static void append_state(text *t, const stf_world *world)
{
    const double vector = (double)(world->dimensions * sizeof(stf_real)), real = (double)sizeof(stf_real);
    const stf_integrator *integrator = world->integrator;
    const unsigned long long evaluations = in_flight(world) ? 1 : (unsigned long long)integrator->evaluations;
    const double work = world->storage.whole ? integrator->work_arrays * vector : 0;

    append(t, "  %-32s %13s %16s\n", "", "passes a step", "bytes a particle");
    append_row(t, "position, velocity, inverse mass", 0, 2 * vector + real, "");
    if (world->keep_previous)
        append_row(t, "previous position", 0, vector, "one pass a tick");
    if (world->keep_radius)
        append_row(t, "radius", 0, real, "");
    if (world->compensated)
        append_row(t, "rests of position and velocity", 0, 2 * vector, "");
    if (world->storage.guarded) {
        stf_real *arrays[STF_CHANGING_MAX];
        append_row(t, "checkpoint", 0, (double)stf_storage_changing(&world->storage, arrays) * vector, "two passes a look");
    }
    append_row(t, integrator->name, evaluations, integrator->history_arrays * vector + work, "");
    append_row(t, "gravity, linear drag", 0, 0, "in flight part of the integrator's pass, else of F / m");
}

static void append_force(text *t, const stf_world *world, const stf_added_force *added)
{
    const stf_force *force = added->force;
    const unsigned long long evaluations = (unsigned long long)world->integrator->evaluations;
    const unsigned long long passes = stf_force_acts(added) && force->apply ? evaluations : 0;
    const double bytes = world->count ? (double)added->bytes / (double)world->count : 0;
    char remark[96];

    (void)snprintf(remark, sizeof remark, "%s, %zu record%s%s%s%s%s%s", force->kind == STF_LINK ? "link" : "field",
             added->record_count, plural(added->record_count), force->depends_on ? ", of" : "",
             force->depends_on & STF_ON_POSITION ? " x" : "",
             force->depends_on & STF_ON_VELOCITY ? " v" : "", force->depends_on & STF_ON_TIME ? " t" : "",
             force->potential ? ", with potential" : "");
    append_row(t, force->name, passes, bytes, remark);
}

size_t stf_world_describe(const stf_world *world, char *at, size_t size)
{
    text t = {.at = at, .size = at ? size : 0};

    if (t.size > 0)
        at[0] = '\0';
    if (!world)
        return 0;

    append_head(&t, world);
    append_guard(&t, world);
    append_state(&t, world);
    for (size_t i = 0; i < world->force_count; i++)
        append_force(&t, world, &world->forces[i]);
    return t.length;
}
