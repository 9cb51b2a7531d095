// Bullet: the nodes of a soft body; the cloth is of its links.
#include <cmath>
#include <cstdio>
#include <vector>

#include <BulletSoftBody/btSoftBody.h>

#include "peer.h"

namespace {

// m. A soft body keeps its nodes in a collision tree, each in a box as much larger than itself: from so wide a box none gets
// out, and the tree is not tended after the first step. With the usual margin free flight costs up to 2,000 ns a node.
const btScalar wide = 1e6f;

// A soft body damps what it has moved by: x' = x + dt (u + g dt), u' = (u + g dt) (1 - k dt). With u = v (1 - k dt) that is the
// motion of v' = v (1 - k dt) + g dt, x' = x + v' dt, as ours.
struct engine {
    const workload *w;
    double step, undamped;
    btSoftBodyWorldInfo info;
    btSoftBody *body;

    engine(const workload *work, double dt) : w(work), step(dt), undamped(1 - work->drag * dt)
    {
        std::vector<btVector3> x(w->count);
        std::vector<btScalar> mass(w->count);
        for (size_t i = 0; i < w->count; i++) {
            x[i] = vector(&w->position[3 * i]);
            mass[i] = w->inverse_mass[i] == 0 ? 0 : btScalar(1 / w->inverse_mass[i]);
        }
        info.m_gravity = btVector3(0, btScalar(-w->gravity), 0);
        body = new btSoftBody(&info, int(w->count), x.data(), mass.data());
        for (size_t i = 0; i < w->count; i++)
            body->m_nodes[int(i)].m_v = vector(&w->velocity[3 * i]) * btScalar(undamped);
        for (size_t i = 0; i < w->tie_count; i++)
            body->appendLink(int(w->ties[i].a), int(w->ties[i].b));
        body->getCollisionShape()->setMargin(wide);
        body->m_cfg.kDP = btScalar(w->drag * dt);
        body->m_cfg.piterations = 1;
        body->m_cfg.m_psequence.clear();
        if (w->tie_count > 0)
            body->m_cfg.m_psequence.push_back(btSoftBody::ePSolver::Linear);
    }
    engine(const engine &) = delete;
    engine &operator=(const engine &) = delete;
    ~engine() { delete body; }

    static btVector3 vector(const double *v) { return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2])); }
};

void *create(const workload *w, const method *, double setting) { return new engine(w, setting); }
void destroy(void *self) { delete static_cast<engine *>(self); }

void advance(void *self, double duration)
{
    engine &e = *static_cast<engine *>(self);
    const long steps = std::lround(duration / e.step);

    for (long i = 0; i < steps; i++) {
        e.body->predictMotion(btScalar(e.step));
        e.body->solveConstraints();
    }
}

void read(const void *self, double *position, double *velocity)
{
    const engine &e = *static_cast<const engine *>(self);

    for (size_t i = 0; i < e.w->count; i++)
        for (int d = 0; d < 3; d++) {
            position[3 * i + size_t(d)] = double(e.body->m_nodes[int(i)].m_x[d]);
            velocity[3 * i + size_t(d)] = double(e.body->m_nodes[int(i)].m_v[d]) / e.undamped;
        }
}

void version(char *text, size_t size)
{
    std::snprintf(text, size, "%d.%02d", BT_BULLET_VERSION / 100, BT_BULLET_VERSION % 100);
}

const method *methods()
{
    static method list[2] = {};
    list[0].name = "soft-body nodes";
    list[0].workloads = DOES_FLIGHT | DOES_CLOTH;
    list[0].dimensions = 3;
    list[0].order = 1;
    list[0].other_cloth = true;
    return list;
}

} // namespace

extern "C" {
extern const peer peer_bullet;
const peer peer_bullet = {
    "Bullet", "libbullet-dev", "float", true,
    "soft-body nodes, stepped without a collision world and its normals, with a margin so wide that the collision tree,\n"
    "which it can't go without, needs no tending. Its cloth is position-based: links of full stiffness, 1 iteration, another\n"
    "motion than springs'",
    version, methods, create, advance, read, destroy};
}
