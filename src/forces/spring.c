#include "spring.h"

#include "../spring_order.h"
#include "steadfast/force.h"

static stf_result spring_check(const void *record, unsigned dimensions, size_t particle_count)
{
    const stf_spring *spring = record;
    (void)dimensions;

    if (spring->a >= particle_count || spring->b >= particle_count)
        return STF_ERROR_PARTICLE;
    if (spring->a == spring->b || !stf_is_spring(spring->stiffness, spring->damping, spring->rest_length))
        return STF_ERROR_PARAMETERS;
    return STF_OK;
}

static bool spring_renumber(void *record, size_t removed, size_t last)
{
    stf_spring *spring = record;

    if (spring->a == removed || spring->b == removed)
        return false;
    if (spring->a == last)
        spring->a = (uint32_t)removed;
    if (spring->b == last)
        spring->b = (uint32_t)removed;
    return true;
}

/* A run: the ends of its first spring, where their parameters start, and the state of the particles. */
typedef struct run {
    uint32_t lower, upper;
    const stf_real *stiffness, *damping, *rest_length;
    const stf_particles *all;
} run;

static inline bool is_mine(const stf_particles *all, size_t particle) { return particle >= all->begin && particle < all->end; }

/*
 * newtons = f d of n springs, F = -f d, in rows of STF_BLOCK_MAX; the ends start at the offsets a and b. `dimensions` is a
 * constant at each call, so the compiler makes a loop for each; n is a multiple of STF_RUN_MIN, so it needs none for a rest.
 */
STF_INLINE void run_forces(unsigned dimensions, size_t n, size_t stride, const stf_real *restrict x,
                              const stf_real *restrict v, size_t a, size_t b, const stf_real *restrict stiffness,
                              const stf_real *restrict damping, const stf_real *restrict rest_length,
                              stf_real *restrict newtons)
{
    for (size_t i = 0; i < n / STF_RUN_MIN * STF_RUN_MIN; i++) {
        const size_t ai = a + i, bi = b + i;
        const stf_real dx = x[ai] - x[bi], wx = v[ai] - v[bi];
        const stf_real dy = dimensions > 1 ? x[ai + stride] - x[bi + stride] : 0;
        const stf_real wy = dimensions > 1 ? v[ai + stride] - v[bi + stride] : 0;
        const stf_real dz = dimensions > 2 ? x[ai + 2 * stride] - x[bi + 2 * stride] : 0;
        const stf_real wz = dimensions > 2 ? v[ai + 2 * stride] - v[bi + 2 * stride] : 0;
        const stf_real factor = stf_spring_factor(dx * dx + dy * dy + dz * dz, wx * dx + wy * dy + wz * dz, stiffness[i],
                                                  damping[i], rest_length[i]);

        newtons[i] = factor * dx;
        if (dimensions > 1)
            newtons[STF_BLOCK_MAX + i] = factor * dy;
        if (dimensions > 2)
            newtons[2 * STF_BLOCK_MAX + i] = factor * dz;
    }
}

/* Springs at to at + n of a run. */
static void run_part(size_t n, size_t at, const run *r, stf_real *newtons)
{
    const stf_particles *all = r->all;
    const size_t a = stf_particles_offset(all, r->lower) + at, b = stf_particles_offset(all, r->upper) + at;
    const stf_real *stiffness = r->stiffness + at, *damping = r->damping + at, *rest_length = r->rest_length + at;
    const stf_real *x = all->position, *v = all->velocity;

    newtons += at;
    if (all->dimensions == 1)
        run_forces(1, n, all->stride, x, v, a, b, stiffness, damping, rest_length, newtons);
    else if (all->dimensions == 2)
        run_forces(2, n, all->stride, x, v, a, b, stiffness, damping, rest_length, newtons);
    else
        run_forces(3, n, all->stride, x, v, a, b, stiffness, damping, rest_length, newtons);
}

static void add(size_t n, stf_real *restrict force, const stf_real *restrict newtons)
{
    for (size_t i = 0; i < n; i++)
        force[i] += newtons[i]; /* run_part filled them; NOLINT(clang-analyzer-core.uninitialized.Assign) */
}

static void subtract(size_t n, stf_real *restrict force, const stf_real *restrict newtons)
{
    for (size_t i = 0; i < n; i++)
        force[i] -= newtons[i];
}

/* The ends of a run may overlap (a chain), so its forces are computed first and then added, end by end. */
static void apply_run(size_t n, const run *r)
{
    const stf_particles *all = r->all;
    const size_t a = stf_particles_offset(all, r->lower), b = stf_particles_offset(all, r->upper);
    const bool a_is_mine = is_mine(all, r->lower), b_is_mine = is_mine(all, r->upper);
    const size_t whole = n / STF_RUN_MIN * STF_RUN_MIN;
    stf_real newtons[STF_DIMENSIONS_MAX * STF_BLOCK_MAX];

    if (!a_is_mine && !b_is_mine)
        return;
    run_part(whole, 0, r, newtons);
    if (whole < n)
        run_part(STF_RUN_MIN, n - STF_RUN_MIN, r, newtons); /* some twice: cheaper than one by one */
    for (unsigned d = 0; d < all->dimensions && a_is_mine; d++)
        subtract(n, all->force + a + d * all->stride, newtons + d * STF_BLOCK_MAX);
    for (unsigned d = 0; d < all->dimensions && b_is_mine; d++)
        add(n, all->force + b + d * all->stride, newtons + d * STF_BLOCK_MAX);
}

/* Loose springs that are gathered, computed and scattered at a time. */
#define BATCH ((size_t)64)

typedef struct batch {
    size_t a[BATCH], b[BATCH]; /* where their ends stand */
    stf_real d[STF_DIMENSIONS_MAX][BATCH], square[BATCH], w_dot_d[BATCH];
    stf_real stiffness[BATCH], damping[BATCH], rest_length[BATCH], factor[BATCH];
} batch;

static void batch_factors(size_t n, batch *g)
{
    for (size_t i = 0; i < n; i++)
        g->factor[i] = stf_spring_factor(g->square[i], g->w_dot_d[i], g->stiffness[i], g->damping[i], g->rest_length[i]);
}

/* `all_mine` is a constant at each call as well: of a world that is not split every end is. */
STF_INLINE void apply_batch(unsigned dimensions, bool all_mine, size_t n, const stf_spring *loose, const stf_particles *all)
{
    const stf_real *x = all->position, *v = all->velocity;
    const size_t stride = all->stride;
    batch g;

    for (size_t i = 0; i < n; i++) {
        const stf_spring *s = &loose[i];
        const size_t a = stf_particles_offset(all, s->a), b = stf_particles_offset(all, s->b);
        stf_real square = 0, w_dot_d = 0;

        for (unsigned k = 0; k < dimensions; k++) {
            const stf_real d = x[a + k * stride] - x[b + k * stride];
            g.d[k][i] = d;
            square += d * d;
            w_dot_d += (v[a + k * stride] - v[b + k * stride]) * d;
        }
        g.a[i] = a, g.b[i] = b, g.square[i] = square, g.w_dot_d[i] = w_dot_d;
        g.stiffness[i] = s->stiffness, g.damping[i] = s->damping, g.rest_length[i] = s->rest_length;
    }
    batch_factors(n, &g);
    for (size_t i = 0; i < n; i++) {
        const bool a_is_mine = all_mine || is_mine(all, loose[i].a), b_is_mine = all_mine || is_mine(all, loose[i].b);

        for (unsigned k = 0; k < dimensions && a_is_mine; k++)
            all->force[g.a[i] + k * stride] -= g.factor[i] * g.d[k][i];
        for (unsigned k = 0; k < dimensions && b_is_mine; k++)
            all->force[g.b[i] + k * stride] += g.factor[i] * g.d[k][i];
    }
}

static bool any_is_mine(const stf_particles *all, size_t n, const stf_spring *loose)
{
    bool any = false;

    for (size_t i = 0; i < n; i++)
        any = any || is_mine(all, loose[i].a) || is_mine(all, loose[i].b);
    return any;
}

static void apply_loose(size_t n, const stf_spring *loose, const stf_particles *all)
{
    const bool all_mine = all->begin == 0 && all->end == all->count;

    if (!all_mine && !any_is_mine(all, n, loose))
        return;
    if (all->dimensions == 1)
        apply_batch(1, false, n, loose, all);
    else if (all->dimensions == 2)
        apply_batch(2, false, n, loose, all);
    else if (!all_mine)
        apply_batch(3, false, n, loose, all);
    else
        apply_batch(3, true, n, loose, all);
}

static void spring_apply(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_spring *springs = records;
    const stf_spring_order *arranged = stf_force_arranged(records, record_count, sizeof *springs);
    (void)time;

    for (const stf_stretch *s = arranged->stretches; s < arranged->stretches + arranged->stretch_count; s++) {
        const run r = {s->lower, s->upper, arranged->stiffness + s->first, arranged->damping + s->first,
                       arranged->rest_length + s->first, all};

        if (s->is_run)
            apply_run(s->count, &r);
        for (size_t done = 0; done < s->count && !s->is_run; done += BATCH)
            apply_loose(s->count - done < BATCH ? s->count - done : BATCH, arranged->loose + s->first + done, all);
    }
}

static double spring_potential(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_spring *springs = records;
    double sum = 0;
    (void)time;

    for (size_t s = 0; s < record_count; s++) {
        const stf_real *a = all->position + stf_particles_offset(all, springs[s].a);
        const stf_real *b = all->position + stf_particles_offset(all, springs[s].b);
        sum += stf_spring_energy(stf_square_between(a, all->stride, b, all->stride, all->dimensions), springs[s].stiffness,
                             springs[s].rest_length);
    }
    return sum;
}

const stf_force stf_force_springs = {
    .name = "springs",
    .kind = STF_LINK,
    .splits = true,
    .depends_on = STF_ON_POSITION | STF_ON_VELOCITY,
    .record_size = sizeof(stf_spring),
    .fields = "44rrr",
    .apply = spring_apply,
    .potential = spring_potential,
    .check = spring_check,
    .renumber = spring_renumber,
    .arrange = stf_springs_arrange,
    .arranged_size = stf_springs_arranged_size,
};
