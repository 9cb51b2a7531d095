/* ODE, the Open Dynamics Engine: bodies without geoms; the cloth is of soft double-ball joints. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <ode/ode.h>

#include "peer.h"

typedef struct engine {
    const workload *w;
    dWorldID world;
    dBodyID *bodies; /* 0: held */
    double step, undamped;
} engine;

static dBodyID add_body(const engine *e, size_t i)
{
    const double *x = &e->w->position[3 * i], *v = &e->w->velocity[3 * i], mass = 1 / e->w->inverse_mass[i];
    const dBodyID body = dBodyCreate(e->world);
    dMass m;

    dMassSetSphereTotal(&m, (dReal)mass, 1);
    dBodySetMass(body, &m);
    dBodySetGyroscopicMode(body, 0);
    dBodySetPosition(body, (dReal)x[0], (dReal)x[1], (dReal)x[2]);
    dBodySetLinearVel(body, (dReal)(v[0] * e->undamped), (dReal)(v[1] * e->undamped), (dReal)(v[2] * e->undamped));
    return body;
}

/* As the manual has it: a spring k with a damper c is ERP = dt k / (dt k + c), CFM = 1 / (dt k + c). */
static void add_joint(const engine *e, const tie *l)
{
    const double *a = &e->w->position[3 * l->a], *b = &e->w->position[3 * l->b];
    const double stiff = e->step * e->w->tie_stiffness, sum = stiff + e->w->tie_damping;
    const dJointID joint = dJointCreateDBall(e->world, 0);

    if (e->bodies[l->a])
        dJointAttach(joint, e->bodies[l->a], e->bodies[l->b]);
    else
        dJointAttach(joint, e->bodies[l->b], 0);
    dJointSetDBallAnchor1(joint, (dReal)(e->bodies[l->a] ? a[0] : b[0]), (dReal)(e->bodies[l->a] ? a[1] : b[1]),
                          (dReal)(e->bodies[l->a] ? a[2] : b[2]));
    dJointSetDBallAnchor2(joint, (dReal)(e->bodies[l->a] ? b[0] : a[0]), (dReal)(e->bodies[l->a] ? b[1] : a[1]),
                          (dReal)(e->bodies[l->a] ? b[2] : a[2]));
    dJointSetDBallParam(joint, dParamERP, (dReal)(stiff / sum));
    dJointSetDBallParam(joint, dParamCFM, (dReal)(1 / sum));
}

/* ODE damps what it has moved by, like Bullet's soft bodies: u = v (1 - k dt) moves as v does in ours. */
static void *create(const workload *w, const method *m, double setting)
{
    engine *e = need(sizeof *e);
    (void)m;

    dInitODE2(0);
    *e = (engine){.w = w, .world = dWorldCreate(), .step = setting, .undamped = 1 - w->drag * setting};
    e->bodies = need(w->count * sizeof(dBodyID));
    dWorldSetGravity(e->world, 0, (dReal)-w->gravity, 0);
    dWorldSetQuickStepNumIterations(e->world, 1);
    dWorldSetQuickStepW(e->world, 1); /* 1.3, its default, makes a spring of one iteration as much stiffer */
    dWorldSetLinearDampingThreshold(e->world, 0);
    dWorldSetLinearDamping(e->world, (dReal)(w->drag * setting));
    for (size_t i = 0; i < w->count; i++)
        e->bodies[i] = w->inverse_mass[i] == 0 ? 0 : add_body(e, i);
    for (size_t i = 0; i < w->tie_count; i++)
        add_joint(e, &w->ties[i]);
    return e;
}

static void push(const engine *e)
{
    for (size_t i = 0; i < e->w->count; i++) {
        const dReal *x = dBodyGetPosition(e->bodies[i]);
        double a[3];
        workload_pull(e->w, i, (double[3]){(double)x[0], (double)x[1], 0}, a);
        dBodyAddForce(e->bodies[i], (dReal)a[0], (dReal)a[1], 0);
    }
}

static void advance(void *self, double duration)
{
    const engine *e = self;
    const bool race = e->w->kind == KEPLER || e->w->kind == OSCILLATORS;
    const long steps = lround(duration / e->step);

    for (long i = 0; i < steps; i++) {
        if (race)
            push(e);
        dWorldQuickStep(e->world, (dReal)e->step);
    }
}

static void read(const void *self, double *position, double *velocity)
{
    const engine *e = self;

    for (size_t i = 0; i < e->w->count; i++)
        for (size_t d = 0; d < 3; d++) {
            position[3 * i + d] = e->bodies[i] ? (double)dBodyGetPosition(e->bodies[i])[d] : e->w->position[3 * i + d];
            velocity[3 * i + d] = e->bodies[i] ? (double)dBodyGetLinearVel(e->bodies[i])[d] / e->undamped : 0;
        }
}

static void destroy(void *self)
{
    engine *e = self;

    dWorldDestroy(e->world);
    dCloseODE();
    free(e->bodies);
    free(e);
}

/* ODE's headers and functions have no version: make asks pkg-config. */
static void version(char *text, size_t size) { snprintf(text, size, "%s", PACKAGE_VERSION); }

static const method list[] = {
    {.name = "semi-implicit Euler", .workloads = DOES_FLIGHT | DOES_CLOTH | DOES_RACE, .dimensions = 3, .order = 1}, {0}};

static const method *methods(void) { return list; }

extern const peer peer_ode;
const peer peer_ode = {
    .name = "ODE",
    .package = "libode-dev",
#ifdef dDOUBLE
    .reals = "double",
#else
    .reals = "float",
#endif
    .note = "QuickStep, 1 iteration, no geoms, no gyroscopic term; each body is an island of its own, and turns too.\n"
            "It has no springs: cloth of double-ball joints with ERP and CFM, each an implicit spring, one after another.\n"
            "Debian builds it with its assertions on",
    .version = version,
    .methods = methods,
    .create = create,
    .advance = advance,
    .read = read,
    .destroy = destroy,
};
