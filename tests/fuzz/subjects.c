/* The forces and integrators that a program can name: the library's, a user's, and some with bad descriptors. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "fuzz.h"

/* ---- forces of a user -------------------------------------------------------------------------------------------------- */

typedef struct gust {
    uint8_t tiny;
    uint64_t large;
    uint16_t small;
    stf_real push; /* N along x */
    uint32_t middle;
    uint8_t last;
} gust;

static void blow(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    const gust *g = records;
    (void)time;

    claim(particles->first % particles->stride == 0 && particles->count <= STF_BLOCK_MAX);
    for (size_t r = 0; r < record_count; r++)
        for (size_t i = 0; i < particles->count; i++)
            particles->force[i] += g[r].push * (stf_real)(g[r].tiny + g[r].small + g[r].last);
}

static const stf_force gusts = {.name = "gusts", .record_size = sizeof(gust), .apply = blow, .fields = "182r41"};
static const stf_force unsaved_gusts = {.name = "gusts", .record_size = sizeof(gust), .apply = blow};

/* A link whose ends add each for themselves; the same struct as `pin`, whose second index stands for nothing. */
typedef struct tether {
    uint32_t a, b;
    stf_real pull; /* N along x */
} tether;

static void haul(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const tether *t = records;
    (void)time;

    claim(all->begin <= all->end && all->end <= all->count);
    for (size_t r = 0; r < record_count; r++) {
        claim(t[r].a < all->count && t[r].b < all->count);
        const size_t a = stf_particles_offset(all, t[r].a), b = stf_particles_offset(all, t[r].b);
        const stf_real pull = all->position[a] < all->position[b] ? t[r].pull : -t[r].pull;

        if (t[r].a >= all->begin && t[r].a < all->end)
            all->force[a] += pull;
        if (t[r].b >= all->begin && t[r].b < all->end)
            all->force[b] -= pull;
    }
}

static double hauled(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const tether *t = records;
    double sum = 0;
    (void)time;

    for (size_t r = 0; r < record_count; r++) {
        const size_t a = stf_particles_offset(all, t[r].a), b = stf_particles_offset(all, t[r].b);
        sum += (double)t[r].pull * fabs((double)(all->position[a] - all->position[b]));
    }
    return sum;
}

static stf_result check_tether(const void *record, unsigned dimensions, size_t particle_count)
{
    const tether *t = record;
    (void)dimensions;

    if (t->a >= particle_count || t->b >= particle_count)
        return STF_ERROR_PARTICLE;
    return t->a == t->b || !isfinite(t->pull) ? STF_ERROR_PARAMETERS : STF_OK;
}

static bool renumber_tether(void *record, size_t removed, size_t last)
{
    tether *t = record;

    if (t->a == removed || t->b == removed)
        return false;
    t->a = t->a == last ? (uint32_t)removed : t->a;
    t->b = t->b == last ? (uint32_t)removed : t->b;
    return true;
}

static const stf_force tethers = {.name = "tethers", .kind = STF_LINK, .splits = true, .record_size = sizeof(tether),
                                  .depends_on = STF_ON_POSITION, .apply = haul, .potential = hauled,
                                  .check = check_tether, .renumber = renumber_tether, .fields = "44r"};
static const stf_force unsplit_tethers = {.name = "unsplit tethers", .kind = STF_LINK, .record_size = sizeof(tether),
                                          .apply = haul, .potential = hauled, .check = check_tether,
                                          .renumber = renumber_tether, .fields = STF_NOT_SAVED};

/* A round a record, in each of which a piece is a particle. */
static size_t rounds_of_swirl(size_t record_count, const stf_particles *all)
{
    (void)all;
    return record_count;
}

static void swirl(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_real *push = records;
    (void)time;

    claim(all->round < record_count && all->part < all->parts);
    for (size_t i = all->part; i < all->count; i += all->parts)
        all->force[stf_particles_offset(all, i)] += push[all->round] * (stf_real)(i + 1);
}

static const stf_force swirls = {.name = "swirls", .kind = STF_LINK, .record_size = sizeof(stf_real), .apply = swirl,
                                 .rounds = rounds_of_swirl, .fields = "r"};

static void sway(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    claim(!records && record_count == 0);
    for (size_t i = 0; i < particles->count; i++)
        particles->force[i] += (stf_real)(time - floor(time));
}

static double swayed(const void *records, size_t record_count, const stf_particles *particles, double time)
{
    (void)records, (void)record_count, (void)particles;
    return time;
}

static const stf_force sways = {.name = "sway", .depends_on = STF_ON_TIME, .apply = sway, .potential = swayed};

static stf_real thickness(const void *records, size_t record_count) { return record_count ? *(const stf_real *)records : 0; }

static const stf_force syrup = {.name = "syrup", .record_size = sizeof(stf_real), .drag = thickness, .fields = "r"};

static const stf_force nameless = {.apply = sway}, idle = {.name = "idle"},
    both = {.name = "both", .apply = sway, .drag = thickness},
    odd_kind = {.name = "odd", .kind = (stf_force_kind)2, .apply = sway},
    odd_fields = {.name = "odd", .record_size = 4, .apply = sway, .fields = "8"},
    splits_and_rounds = {.name = "odd", .kind = STF_LINK, .splits = true, .rounds = rounds_of_swirl, .apply = swirl};

const subject subjects[SUBJECTS] = {
    {&stf_force_linear_drag, "k"},
    {&stf_force_quadratic_drag, "k"},
    {&stf_force_attractor, "vsk"},
    {&stf_force_anchored_springs, "ivkkk"},
    {&stf_force_springs, "iikkk"},
    {&stf_force_all_pairs_gravity, "sk"},
    {&gusts, "182r41"},
    {&tethers, "iis"},
    {&unsplit_tethers, "iis"},
    {&swirls, "r"},
    {&sways, ""},
    {&syrup, "r"},
    {&unsaved_gusts, "182r41"},
    {&nameless, NULL},
    {&idle, NULL},
    {&both, NULL},
    {&odd_kind, NULL},
    {&odd_fields, NULL},
    {&splits_and_rounds, NULL},
    {&stf_force_springs, "iikkk"},
};

/* ---- records ----------------------------------------------------------------------------------------------------------- */

/* A number of a record: its letter and where it lies. */
typedef struct number {
    char letter;
    size_t at, size;
} number;

/* The number behind `before`, as a compiler lays it out; the first one is behind all zeros. */
static number next_number(number before, char letter)
{
    const bool is_integer = letter >= '1' && letter <= '8', is_vector = letter == 'v';
    const size_t size = letter == 'i' ? sizeof(uint32_t) : is_integer ? (size_t)(letter - '0')
                                                         : is_vector  ? sizeof(stf_vector) : sizeof(stf_real);
    const size_t alignment = is_vector ? sizeof(stf_real) : size, end = before.at + before.size;

    return (number){.letter = letter, .at = (end + alignment - 1) / alignment * alignment, .size = size};
}

static stf_real real_at(const void *record, number n)
{
    stf_real x;

    memcpy(&x, (const char *)record + n.at, sizeof x);
    return x;
}

static uint32_t index_at(const void *record, number n)
{
    uint32_t index;

    memcpy(&index, (const char *)record + n.at, sizeof index);
    return index;
}

static void take_number(program *p, number n, unsigned dimensions, size_t particle_count, char *to)
{
    if (n.letter == 'i') {
        const unsigned byte = take(p);
        const uint32_t index = byte < 250 && particle_count > 0 ? (uint32_t)(byte * 31 % particle_count)
                                                                : (uint32_t)particle_count + (byte & 3);
        memcpy(to, &index, sizeof index);
    } else if (n.letter == 'v') {
        const stf_vector v = take_vector(p, dimensions);
        memcpy(to, &v, sizeof v);
    } else if (n.letter >= '1' && n.letter <= '8') {
        for (size_t i = 0; i < n.size; i++)
            to[i] = (char)take(p);
    } else {
        stf_real x = take_real(p);
        if (n.letter == 'k' && x < 0 && x > -20) /* mostly good */
            x = -x;
        memcpy(to, &x, sizeof x);
    }
}

void take_record(program *p, const subject *s, unsigned dimensions, size_t particle_count, void *record)
{
    number n = {.size = 0};

    memset(record, 0x5a, s->force->record_size); /* pads are garbage, as on any stack */
    for (const char *letter = s->layout; *letter; letter++) {
        n = next_number(n, *letter);
        take_number(p, n, dimensions, particle_count, (char *)record + n.at);
    }
}

static unsigned number_faults(number n, const void *record, unsigned dimensions, size_t particle_count)
{
    stf_vector v;

    switch (n.letter) {
    case 'i': return index_at(record, n) >= particle_count ? 1U << STF_ERROR_PARTICLE : 0;
    case 'v': return memcpy(&v, (const char *)record + n.at, sizeof v), vector_faults(v, dimensions);
    case 'k': return isfinite(real_at(record, n)) && real_at(record, n) >= 0 ? 0 : 1U << STF_ERROR_PARAMETERS;
    case 's': return isfinite(real_at(record, n)) ? 0 : 1U << STF_ERROR_PARAMETERS;
    default: return 0;
    }
}

unsigned record_faults(const subject *s, const void *record, unsigned dimensions, size_t particle_count)
{
    unsigned faults = 0;
    uint32_t first = UINT32_MAX;
    number n = {.size = 0};

    for (const char *letter = s->layout; *letter; letter++) {
        n = next_number(n, *letter);
        faults |= number_faults(n, record, dimensions, particle_count);
        if (*letter != 'i')
            continue;
        if (n.at > 0 && index_at(record, n) == first)
            faults |= 1U << STF_ERROR_PARAMETERS;
        first = index_at(record, n);
    }
    return faults;
}

uint64_t record_hash(const subject *s, const void *record)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    number n = {.size = 0};

    for (const char *letter = s->layout; *letter; letter++) {
        n = next_number(n, *letter);
        for (size_t i = 0; i < n.size; i++)
            hash = (hash ^ ((const unsigned char *)record)[n.at + i]) * UINT64_C(0x100000001b3);
    }
    return hash ^ hash >> 29;
}

bool record_renumber(const subject *s, void *record, size_t removed, size_t last)
{
    const uint32_t to = (uint32_t)removed;
    number n = {.size = 0};

    for (const char *letter = s->layout; *letter == 'i'; letter++) {
        n = next_number(n, *letter);
        if (index_at(record, n) == removed)
            return false;
        if (index_at(record, n) == last)
            memcpy((char *)record + n.at, &to, sizeof to);
    }
    return true;
}

/* ---- integrators ------------------------------------------------------------------------------------------------------- */

/* Two steps of history: x += v dt; v += (23 a(n) - 16 a(n-1) + 5 a(n-2)) dt / 12 (Adams and Bashforth, 1883). */
static void remembering_step(stf_system *system, stf_real dt)
{
    stf_real *x = system->position, *v = system->velocity, *a = system->work[7];
    stf_real *one_ago = system->history[0], *two_ago = system->history[3];

    system->accelerate(system, system->time, x, v, a);
    for (size_t i = 0; i < system->length; i++) {
        if (one_ago[i] != one_ago[i])
            one_ago[i] = two_ago[i] = a[i];
        x[i] += v[i] * dt;
        v[i] += (23 * a[i] - 16 * one_ago[i] + 5 * two_ago[i]) * dt / 12;
        two_ago[i] = one_ago[i];
        one_ago[i] = system->history[1][i] = system->history[2][i] = a[i];
    }
}

/* Semi-implicit Euler, in loops that may run on several threads, under the name of a method that has no history. */
static void plain_loop(stf_system *part, stf_real dt)
{
    for (size_t i = 0; i < part->length; i++) {
        part->velocity[i] += part->work[0][i] * dt;
        part->position[i] += part->velocity[i] * dt;
    }
}

static void plain_step(stf_system *system, stf_real dt)
{
    system->accelerate(system, system->time, system->position, system->velocity, system->work[0]);
    stf_system_each(system, plain_loop, dt);
}

static const stf_integrator remembering = {.name = "rk4", .step = remembering_step, .work_arrays = STF_WORK_ARRAYS_MAX,
                                           .history_arrays = STF_HISTORY_ARRAYS_MAX},
                            plain = {.name = "rk4", .step = plain_step, .work_arrays = 1},
                            unnamed = {.step = plain_step}, unable = {.name = "unable"},
                            greedy = {.name = "greedy", .step = plain_step, .work_arrays = STF_WORK_ARRAYS_MAX + 1},
                            clinging = {.name = "clinging", .step = plain_step, .history_arrays = -1};

const stf_integrator *const integrators[INTEGRATORS] = {
    &stf_explicit_euler, &stf_semi_implicit_euler, &stf_midpoint, &stf_improved_euler, &stf_rk4, &stf_position_verlet,
    &stf_velocity_verlet, &remembering, &plain, &stf_rk4, &unnamed, &unable, &greedy, &clinging,
};

bool is_refused(unsigned integrator, bool compensated)
{
    return integrator >= GOOD_INTEGRATORS || (compensated && !(integrators[integrator]->flags & STF_COMPENSATES));
}
