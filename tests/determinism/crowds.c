#include "crowds.h"

#include "bench/random.h"

#define CROWD 7300 /* particles in free flight: seven parts of four blocks of floats, and some more */
#define NET 1900   /* eight blocks of floats */
#define SPRINGS (3 * NET)
#define CLUSTER 520 /* three tiles of floats, five of doubles */
#define BOX 10.0 /* m */

static stf_real between(double low, double high, size_t i, unsigned which)
{
    return (stf_real)(low + (high - low) * random_of(i, which));
}

static stf_vector vector(double low, double high, size_t i, unsigned which, unsigned dimensions)
{
    return (stf_vector){between(low, high, i, which), between(low, high, i, which + 1),
                        dimensions > 2 ? between(low, high, i, which + 2) : 0};
}

/* Every eleventh is immovable. */
static stf_result add_particles(stf_world *world, size_t count)
{
    const unsigned dimensions = stf_world_dimensions(world);
    stf_result result = stf_world_reserve(world, count);

    for (size_t i = 0; i < count && !result; i++)
        result = stf_world_add(world, &(stf_particle){.position = vector(-BOX, BOX, i, 0, dimensions),
                                                      .velocity = vector(-1, 1, i, 3, dimensions),
                                                      .inverse_mass = i % 11 == 0 ? 0 : between(0.25, 1.25, i, 6)}, NULL);
    return result;
}

static stf_result flight(stf_world *world)
{
    const stf_linear_drag drag = {.coefficient = (stf_real)0.3};
    const stf_result result = add_particles(world, CROWD);

    return result ? result : stf_world_add_force(world, &stf_force_linear_drag, &drag, 1, NULL);
}

static stf_result fields(stf_world *world)
{
    const stf_quadratic_drag drag = {.coefficient = (stf_real)0.05};
    const stf_attractor wells[] = {{.position = {3, 1, 0}, .strength = 20, .softening = 1}, {.strength = -5, .softening = 1}};
    stf_anchored_spring springs[CROWD / 7];
    stf_result result = add_particles(world, CROWD);

    for (uint32_t i = 0; i < CROWD / 7; i++)
        springs[i] = (stf_anchored_spring){.particle = CROWD - 1 - 7 * i, .stiffness = 4, .damping = between(0, 1, i, 7)};
    if (!result)
        result = stf_world_add_force(world, &stf_force_quadratic_drag, &drag, 1, NULL);
    if (!result)
        result = stf_world_add_force(world, &stf_force_attractor, wells, 2, NULL);
    return result ? result : stf_world_add_force(world, &stf_force_anchored_springs, springs, CROWD / 7, NULL);
}

/* A third of the springs tie neighbours, and so make runs; the others tie any two. */
static stf_result net(stf_world *world)
{
    stf_spring springs[SPRINGS];
    const stf_result result = add_particles(world, NET);

    for (size_t i = 0; i < SPRINGS; i++) {
        const bool row = i % 3 == 0;
        const uint32_t a = row ? (uint32_t)(i / 3) : (uint32_t)(random_of(i, 8) * NET);
        const uint32_t b = row ? (a + 1) % NET : (a + 1 + (uint32_t)(random_of(i, 9) * (NET - 1))) % NET;
        springs[i] = (stf_spring){.a = a, .b = b, .stiffness = between(1, 3, i, 10), .damping = between(0, 1, i, 11),
                                  .rest_length = between(0, BOX, i, 12)};
    }
    return result ? result : stf_world_add_force(world, &stf_force_springs, springs, SPRINGS, NULL);
}

static stf_result cluster(stf_world *world)
{
    const stf_all_pairs_gravity gravity = {.gravitational_constant = (stf_real)0.05, .softening = (stf_real)0.25};
    const stf_result result = add_particles(world, CLUSTER);

    return result ? result : stf_world_add_force(world, &stf_force_all_pairs_gravity, &gravity, 1, NULL);
}

static const scene crowd_flight = {.name = "flight", .dimensions = 3, .gravity = {0, -9, 1}, .step = 1.0 / 60, .populate = flight};
static const scene crowd_fields = {.name = "fields", .dimensions = 2, .gravity = {0, -9, 0}, .step = 1.0 / 60, .populate = fields};
static const scene crowd_net = {.name = "net", .dimensions = 3, .step = 1.0 / 60, .populate = net};
static const scene crowd_cluster = {.name = "cluster", .dimensions = 3, .step = 1.0 / 60, .populate = cluster};

static const scene crowd_flight_rests = {.name = "flight_rests", .dimensions = 3, .gravity = {0, -9, 1}, .step = 1.0 / 60,
                                         .populate = flight};
static const scene crowd_net_rests = {.name = "net_rests", .dimensions = 3, .step = 1.0 / 60, .populate = net};

const scene *const crowds[] = {&crowd_flight, &crowd_fields, &crowd_net, &crowd_cluster, &crowd_flight_rests, &crowd_net_rests,
                               NULL};

bool crowd_is_compensated(const scene *crowd) { return crowd == &crowd_flight_rests || crowd == &crowd_net_rests; }
