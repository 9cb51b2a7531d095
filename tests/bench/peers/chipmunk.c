/* Chipmunk 7: bodies without shapes in a space; the cloth is of damped springs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <chipmunk/chipmunk.h>

#include "peer.h"

typedef struct engine {
    const workload *w;
    cpSpace *space;
    cpBody **bodies;
    cpConstraint **springs;
    double step, damping, fall; /* s; 1 - k dt; g dt */
} engine;

/*
 * Chipmunk moves first and kicks then: semi-implicit Euler too where forces are of position. Free flight's is of velocity:
 * there the bodies start kicked, so that they move by the velocity after the kick, as ours.
 */
/* In place of cpBodyUpdateVelocity in the race. */
static void kick(cpBody *body, cpVect gravity, cpFloat damping, cpFloat dt)
{
    const engine *e = cpBodyGetUserData(body);
    const cpVect x = cpBodyGetPosition(body), v = cpBodyGetVelocity(body);
    double a[3];
    (void)gravity, (void)damping;

    workload_pull(e->w, (size_t)cpBodyGetMoment(body) - 1, (double[3]){x.x, x.y, 0}, a);
    cpBodySetVelocity(body, cpv(v.x + a[0] * dt, v.y + a[1] * dt));
}

static cpBody *add_body(engine *e, size_t i)
{
    const workload *w = e->w;
    const double *v = &w->velocity[3 * i];
    const bool held = w->inverse_mass[i] == 0;
    cpBody *body = held ? cpBodyNewStatic() : cpBodyNew(1 / w->inverse_mass[i], 1);

    cpBodySetPosition(body, cpv(w->position[3 * i], w->position[3 * i + 1]));
    if (held)
        return body;
    cpBodySetVelocity(body, w->kind == FLIGHT ? cpv(v[0] * e->damping, v[1] * e->damping - e->fall) : cpv(v[0], v[1]));
    if (w->kind == KEPLER || w->kind == OSCILLATORS) {
        cpBodySetMoment(body, (double)i + 1); /* nothing turns: it carries the index */
        cpBodySetUserData(body, e);
        cpBodySetVelocityUpdateFunc(body, kick);
    }
    return cpSpaceAddBody(e->space, body);
}

static void *create(const workload *w, const method *m, double setting)
{
    engine *e = need(sizeof *e);
    (void)m;

    *e = (engine){.w = w, .space = cpSpaceNew(), .step = setting};
    e->damping = 1 - w->drag * setting;
    e->fall = w->gravity * setting;
    e->bodies = need(w->count * sizeof(cpBody *));
    e->springs = need((w->tie_count + 1) * sizeof(cpConstraint *));
    cpSpaceSetIterations(e->space, 1);
    cpSpaceSetGravity(e->space, cpv(0, -w->gravity));
    cpSpaceSetDamping(e->space, pow(e->damping, 1 / setting)); /* v' = v (1 - k dt) + g dt, as ours */
    for (size_t i = 0; i < w->count; i++)
        e->bodies[i] = add_body(e, i);
    for (size_t i = 0; i < w->tie_count; i++) {
        const tie *l = &w->ties[i];
        e->springs[i] = cpSpaceAddConstraint(e->space, cpDampedSpringNew(e->bodies[l->a], e->bodies[l->b], cpvzero, cpvzero,
                                                                         l->rest_length, w->tie_stiffness, w->tie_damping));
    }
    return e;
}

static void advance(void *self, double duration)
{
    const engine *e = self;
    const long steps = lround(duration / e->step);

    for (long i = 0; i < steps; i++)
        cpSpaceStep(e->space, e->step);
}

static void read(const void *self, double *position, double *velocity)
{
    const engine *e = self;

    for (size_t i = 0; i < e->w->count; i++) {
        const cpVect x = cpBodyGetPosition(e->bodies[i]), v = cpBodyGetVelocity(e->bodies[i]);
        position[3 * i] = x.x;
        position[3 * i + 1] = x.y;
        velocity[3 * i] = e->w->kind == FLIGHT ? v.x / e->damping : v.x;
        velocity[3 * i + 1] = e->w->kind == FLIGHT ? (v.y + e->fall) / e->damping : v.y;
    }
}

/* Freed without being taken out one by one, which is slow: the space goes as well. */
static void destroy(void *self)
{
    engine *e = self;

    cpSpaceFree(e->space);
    for (size_t i = 0; i < e->w->tie_count; i++)
        cpConstraintFree(e->springs[i]);
    for (size_t i = 0; i < e->w->count; i++)
        cpBodyFree(e->bodies[i]);
    free(e->springs);
    free(e->bodies);
    free(e);
}

/* A build with assertions says so when the first space is made: here, rather than between the rows of a table. */
static void version(char *text, size_t size)
{
    cpSpaceFree(cpSpaceNew());
    snprintf(text, size, "%s", cpVersionString);
}

static const method list[] = {
    {.name = "semi-implicit Euler", .workloads = DOES_FLIGHT | DOES_CLOTH | DOES_RACE, .dimensions = 2, .order = 1}, {0}};

static const method *methods(void) { return list; }

extern const peer peer_chipmunk;
const peer peer_chipmunk = {
    .name = "Chipmunk",
    .package = "libchipmunk-dev",
    .reals = "double",
    .note = "2D; 1 iteration, no shapes, no sleeping; it turns each body too (a sine and a cosine a step), kicks after it\n"
            "moves, damps its springs one after another. Debian builds it with its assertions on",
    .version = version,
    .methods = methods,
    .create = create,
    .advance = advance,
    .read = read,
    .destroy = destroy,
};
