// Box2D 2.4: bodies without fixtures; the cloth is of soft distance joints.
#include <cmath>
#include <cstdio>
#include <vector>

#include <box2d/box2d.h>

#include "peer.h"

namespace {

struct engine {
    const workload *w;
    float step;
    b2World world;
    std::vector<b2Body *> bodies;

    // Box2D damps by v' = (v + g dt) / (1 + d dt). These make it v' = v (1 - k dt) + g dt, as ours.
    engine(const workload *work, double dt)
        : w(work), step(float(dt)), world(b2Vec2(0, float(-work->gravity / (1 - work->drag * dt)))), bodies(work->count)
    {
        world.SetAllowSleeping(false);
        world.SetContinuousPhysics(false);
        world.SetWarmStarting(false);
        for (size_t i = 0; i < w->count; i++)
            bodies[i] = add_body(i, float(w->drag / (1 - w->drag * dt)));
        for (size_t i = 0; i < w->tie_count; i++)
            add_joint(w->ties[i]);
    }

    b2Body *add_body(size_t i, float damping)
    {
        b2BodyDef def;
        def.type = w->inverse_mass[i] == 0 ? b2_staticBody : b2_dynamicBody;
        def.position.Set(float(w->position[3 * i]), float(w->position[3 * i + 1]));
        def.linearVelocity.Set(float(w->velocity[3 * i]), float(w->velocity[3 * i + 1]));
        def.linearDamping = damping;
        def.fixedRotation = true;
        b2Body *body = world.CreateBody(&def);
        b2MassData mass;
        mass.center.SetZero();
        mass.I = 0;
        mass.mass = w->inverse_mass[i] == 0 ? 0 : float(1 / w->inverse_mass[i]);
        body->SetMassData(&mass);
        return body;
    }

    void add_joint(const tie &l)
    {
        b2DistanceJointDef def;
        def.bodyA = bodies[l.a];
        def.bodyB = bodies[l.b];
        def.length = float(l.rest_length);
        def.stiffness = float(w->tie_stiffness);
        def.damping = float(w->tie_damping);
        world.CreateJoint(&def);
    }

    void push()
    {
        for (size_t i = 0; i < w->count; i++) {
            const b2Vec2 &x = bodies[i]->GetPosition();
            const double position[3] = {double(x.x), double(x.y), 0};
            double a[3];
            workload_pull(w, i, position, a);
            bodies[i]->ApplyForceToCenter(b2Vec2(float(a[0]), float(a[1])), false);
        }
    }
};

void *create(const workload *w, const method *, double setting) { return new engine(w, setting); }
void destroy(void *self) { delete static_cast<engine *>(self); }

void advance(void *self, double duration)
{
    engine &e = *static_cast<engine *>(self);
    const bool race = e.w->kind == KEPLER || e.w->kind == OSCILLATORS;
    const long steps = std::lround(duration / double(e.step));

    for (long i = 0; i < steps; i++) {
        if (race)
            e.push();
        e.world.Step(e.step, e.w->kind == CLOTH ? 1 : 0, 0);
    }
}

void read(const void *self, double *position, double *velocity)
{
    const engine &e = *static_cast<const engine *>(self);

    for (size_t i = 0; i < e.w->count; i++) {
        const b2Vec2 &x = e.bodies[i]->GetPosition(), &v = e.bodies[i]->GetLinearVelocity();
        position[3 * i] = double(x.x);
        position[3 * i + 1] = double(x.y);
        velocity[3 * i] = double(v.x);
        velocity[3 * i + 1] = double(v.y);
    }
}

// The b2_version of 2.4.1 says 2.4.0: make asks pkg-config.
void version(char *text, size_t size) { std::snprintf(text, size, "%s", PACKAGE_VERSION); }

const method *methods()
{
    static method list[2] = {};
    list[0].name = "semi-implicit Euler";
    list[0].workloads = DOES_FLIGHT | DOES_CLOTH | DOES_RACE;
    list[0].dimensions = 2;
    list[0].order = 1;
    return list;
}

} // namespace

extern "C" {
extern const peer peer_box2d;
const peer peer_box2d = {
    "Box2D", "libbox2d-dev", "float", false,
    "2D; no fixtures, no sleeping, no continuous collision; each body is an island of its own, gathered and solved\n"
    "alone; cloth of soft joints, each solved implicitly, one after another, 1 iteration, no warm start.\n"
    "Debian builds it with its assertions on",
    version, methods, create, advance, read, destroy};
}
