// consumer.c as a C++11 program: the same scene, owned by a class.
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <vector>

#include <steadfast/steadfast.h>

struct wind {
    stf_real push; // N, along x
};

extern "C" {

static void blow(const void *records, size_t, const stf_particles *particles, double)
{
    const wind *w = static_cast<const wind *>(records);

    for (size_t i = 0; i < particles->count; i++)
        particles->force[i] += w->push;
}

// Semi-implicit Euler.
static void step(stf_system *system, stf_real dt)
{
    stf_real *x = system->position, *v = system->velocity, *a = system->work[0];

    system->accelerate(system, system->time, x, v, a);
    for (size_t i = 0; i < system->length; i++) {
        v[i] += a[i] * dt;
        x[i] += v[i] * dt;
    }
}
}

static stf_force make_wind_force()
{
    stf_force force = stf_force();

    force.name = "wind";
    force.kind = STF_FIELD;
    force.record_size = sizeof(wind);
    force.apply = blow;
    return force;
}

static stf_integrator make_integrator()
{
    stf_integrator integrator = stf_integrator();

    integrator.name = "mine";
    integrator.step = step;
    integrator.order = 1;
    integrator.evaluations = 1;
    integrator.work_arrays = 1;
    return integrator;
}

static const stf_force wind_force = make_wind_force();
static const stf_integrator mine = make_integrator();

static int failures = 0;

static void check(bool holds, const char *what)
{
    if (holds)
        return;
    std::fprintf(stderr, "consumer.cpp: not so: %s\n", what);
    failures++;
}

struct destroy {
    void operator()(stf_world *world) const { stf_world_destroy(world); }
};

class scene {
public:
    scene() : clock_()
    {
        stf_world_def def = stf_world_def();
        stf_clock_def clock_def = stf_clock_def();
        stf_world *world = nullptr;

        def.integrator = &mine;
        def.gravity.y = -10;
        check(stf_world_create(&def, &world) == STF_OK, "a world is created");
        world_.reset(world);
        check(stf_clock_init(&clock_, &clock_def) == STF_OK, "a clock is set up");
    }

    template <typename record> void add_force(const stf_force &force, const record &parameters)
    {
        check(stf_world_add_force(world_.get(), &force, &parameters, 1, nullptr) == STF_OK, "a force is added");
    }

    void add(const std::vector<stf_particle> &particles)
    {
        check(stf_world_add_many(world_.get(), particles.data(), particles.size(), nullptr) == STF_OK, "particles are added");
    }

    void frame(double seconds)
    {
        unsigned ticks;

        check(stf_clock_advance(&clock_, seconds, &ticks) == STF_OK, "a frame is taken");
        check(stf_world_step(world_.get(), ticks) == STF_OK, "the world steps");
    }

    stf_particle operator[](size_t index) const
    {
        stf_particle particle = stf_particle();

        check(stf_world_get(world_.get(), index, &particle) == STF_OK, "a particle is read");
        return particle;
    }

    uint64_t ticks() const { return stf_world_ticks(world_.get()); }

private:
    std::unique_ptr<stf_world, destroy> world_;
    stf_clock clock_;
};

// The bound is explained in consumer.c.
static bool is_near(stf_real actual, double expected)
{
    return std::fabs(static_cast<double>(actual) - expected) <=
           40 * static_cast<double>(std::numeric_limits<stf_real>::epsilon()) * std::fabs(expected);
}

int main()
{
    std::vector<stf_particle> particles(2);
    stf_linear_drag drag = stf_linear_drag();
    wind breeze = wind();
    scene s;

    particles[0].inverse_mass = 1;
    particles[1].inverse_mass = static_cast<stf_real>(0.5);
    drag.coefficient = 12;
    breeze.push = 6;
    s.add(particles);
    s.add_force(stf_force_linear_drag, drag);
    s.add_force(wind_force, breeze);
    for (int frame = 0; frame < 500; frame++)
        s.frame(0.02);

    check(s.ticks() == 600, "ten seconds are 600 ticks");
    check(is_near(s[0].velocity.x, 6 / 12.0) && is_near(s[1].velocity.x, 6 / 12.0), "drag ends up as strong as the wind");
    check(is_near(s[0].velocity.y, -10 * 1 / 12.0), "drag ends up as strong as the weight of 1 kg");
    check(is_near(s[1].velocity.y, -10 * 2 / 12.0), "drag ends up as strong as the weight of 2 kg");
    check(stf_integrator_find("rk4") == &stf_rk4, "the library's integrators are found");
    std::printf("%s\n", stf_version());
    return failures > 0;
}
