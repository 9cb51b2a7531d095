/*
 * What an engine programmer writes first, built in both precisions against the installed library: two particles under
 * gravity, drag and a wind of their own fall until they no longer speed up. Prints the version of the library.
 */
#include <float.h>
#include <stdio.h>
#include <string.h>

#include <steadfast/steadfast.h>

typedef struct wind {
    stf_real push; /* N, along x */
} wind;

static void blow(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const wind *w = records;

    (void)record_count, (void)time;
    for (size_t i = 0; i < particles->count; i++)
        particles->force[i] += w->push;
}

static const stf_force wind_force = {.name = "wind", .kind = STF_FIELD, .record_size = sizeof(wind), .apply = blow};

/* Semi-implicit Euler. */
static void step(stf_system *system, stf_real dt)
{
    stf_real *x = system->position, *v = system->velocity, *a = system->work[0];

    system->accelerate(system, system->time, x, v, a);
    for (size_t i = 0; i < system->length; i++) {
        v[i] += a[i] * dt;
        x[i] += v[i] * dt;
    }
}

static const stf_integrator mine = {.name = "mine", .step = step, .order = 1, .evaluations = 1, .work_arrays = 1};

static int failures;

static void check(bool holds, const char *what)
{
    if (holds)
        return;
    fprintf(stderr, "consumer.c: not so: %s\n", what);
    failures++;
}

/*
 * Each step shrinks what is missing to the terminal velocity, and the round-off of all steps before, by k dt / m >= 1/10: what
 * stays is below 10 times the round-off of one step, which is a few half ulps.
 */
static bool is_near(stf_real actual, double expected)
{
    const double epsilon = sizeof(stf_real) == sizeof(float) ? (double)FLT_EPSILON : DBL_EPSILON;
    const double error = ((double)actual - expected) / expected;

    return error <= 40 * epsilon && error >= -40 * epsilon;
}

int main(void)
{
    const stf_particle particles[] = {{.inverse_mass = 1}, {.position = {3, 2, 1}, .inverse_mass = (stf_real)0.5}};
    const stf_linear_drag drag = {.coefficient = 12};
    const wind breeze = {.push = 6};
    stf_world_def def = {0};
    stf_clock_def clock_def = {0};
    stf_clock clock;
    stf_world *world;
    stf_particle light, heavy;
    char version[32];

    def.integrator = &mine;
    def.gravity.y = -10;
    check(stf_world_create(&def, &world) == STF_OK, "a world is created");
    check(stf_world_add_many(world, particles, 2, NULL) == STF_OK, "particles are added");
    check(stf_world_add_force(world, &stf_force_linear_drag, &drag, 1, NULL) == STF_OK, "drag is added");
    check(stf_world_add_force(world, &wind_force, &breeze, 1, NULL) == STF_OK, "a force of one's own is added");
    check(stf_clock_init(&clock, &clock_def) == STF_OK, "a clock is set up");

    for (int frame = 0; frame < 500; frame++) {
        unsigned ticks;
        check(stf_clock_advance(&clock, 0.02, &ticks) == STF_OK, "a frame is taken");
        check(stf_world_step(world, ticks) == STF_OK, "the world steps");
    }

    check(clock.ticks == 600 && stf_world_ticks(world) == 600, "ten seconds are 600 ticks");
    check(stf_world_get(world, 0, &light) == STF_OK && stf_world_get(world, 1, &heavy) == STF_OK, "particles are read");
    check(is_near(light.velocity.x, 6 / 12.0) && is_near(heavy.velocity.x, 6 / 12.0), "drag ends up as strong as the wind");
    check(is_near(light.velocity.y, -10 * 1 / 12.0), "drag ends up as strong as the weight of 1 kg");
    check(is_near(heavy.velocity.y, -10 * 2 / 12.0), "drag ends up as strong as the weight of 2 kg");
    check(light.velocity.z == 0 && heavy.position.z == 1, "nothing pushes along z");
    check(stf_integrator_find("rk4") == &stf_rk4 && stf_integrators[0] != NULL, "the library's integrators are found");
    stf_world_destroy(world);

    snprintf(version, sizeof version, "%d.%d.%d", STF_VERSION_MAJOR, STF_VERSION_MINOR, STF_VERSION_PATCH);
    check(strcmp(version, stf_version()) == 0, "headers and library are of one version");
    printf("%s\n", stf_version());
    return failures > 0;
}
