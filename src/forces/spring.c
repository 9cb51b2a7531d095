#include "spring.h"

#include "../sort.h"
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

/*
 * Springs are kept in the order of the block of their lower end, then of the difference of their ends, then of the lower end.
 * Where both ends count up by one (a cloth's rows, columns and diagonals are such runs) vectors are loaded and stored whole.
 * Shorter runs are gathered and scattered.
 */
#define RUN_MIN ((size_t)16)

static uint32_t lower(const stf_spring *s) { return s->a < s->b ? s->a : s->b; }
static uint32_t upper(const stf_spring *s) { return s->a < s->b ? s->b : s->a; }

static int compare_numbers(uint32_t a, uint32_t b) { return (a > b) - (a < b); }

/* By all fields in the end, so that the order never depends on that in which springs were given. */
static int compare_springs(const void *left, const void *right)
{
    const stf_spring *a = left, *b = right;
    int order = compare_numbers(lower(a) / STF_BLOCK_MAX, lower(b) / STF_BLOCK_MAX);

    if (order == 0)
        order = compare_numbers(upper(a) - lower(a), upper(b) - lower(b));
    if (order == 0)
        order = compare_numbers(lower(a), lower(b));
    if (order == 0)
        order = stf_compare_reals(a->stiffness, b->stiffness);
    if (order == 0)
        order = stf_compare_reals(a->damping, b->damping);
    if (order == 0)
        order = stf_compare_reals(a->rest_length, b->rest_length);
    return order;
}

/* Springs that are computed together: a run, within one block at each end, or loose ones. */
typedef struct stretch {
    size_t first, count;
    bool is_run;
} stretch;

/* Between any two runs may be one of loose springs. */
static size_t stretches_max(size_t spring_count) { return 2 * (spring_count / RUN_MIN) + 1; }

/* What stands behind the records: parameters as vectors are loaded, and the stretches. */
typedef struct arrangement {
    size_t stretch_count;
    stretch *stretches;
    stf_real *stiffness, *damping, *rest_length;
} arrangement;

static size_t arranged_size(size_t spring_count)
{
    const size_t each = 3 * sizeof(stf_real) + 2 * sizeof(stretch) / RUN_MIN + 1;

    if (spring_count > SIZE_MAX / 4 / each)
        return SIZE_MAX;
    return sizeof(arrangement) + 3 * spring_count * sizeof(stf_real) + stretches_max(spring_count) * sizeof(stretch);
}

/* How many springs from here on are a run. */
static size_t run_length(const stf_spring *springs, size_t count)
{
    const uint32_t first_lower = lower(springs), first_upper = upper(springs);
    size_t n = 1;

    while (n < count && lower(&springs[n]) == first_lower + n && upper(&springs[n]) == first_upper + n &&
           lower(&springs[n]) % STF_BLOCK_MAX != 0 && upper(&springs[n]) % STF_BLOCK_MAX != 0)
        n++;
    return n;
}

static void find_stretches(const stf_spring *springs, size_t spring_count, arrangement *found)
{
    stretch *last = NULL;
    size_t n;

    found->stretch_count = 0;
    for (size_t first = 0; first < spring_count; first += n) {
        n = run_length(springs + first, spring_count - first);
        if (n >= RUN_MIN || !last || last->is_run) {
            last = &found->stretches[found->stretch_count++];
            *last = (stretch){.first = first, .count = n, .is_run = n >= RUN_MIN};
        } else {
            last->count += n;
        }
    }
}

static void spring_arrange(void *records, size_t record_count)
{
    const stf_spring *springs = records;
    arrangement *arranged = stf_force_arranged(records, record_count, sizeof *springs);

    stf_sort(records, record_count, sizeof *springs, compare_springs);
    arranged->stretches = (stretch *)(arranged + 1);
    arranged->stiffness = (stf_real *)(arranged->stretches + stretches_max(record_count));
    arranged->damping = arranged->stiffness + record_count;
    arranged->rest_length = arranged->damping + record_count;
    find_stretches(springs, record_count, arranged);
    for (size_t s = 0; s < record_count; s++) {
        arranged->stiffness[s] = springs[s].stiffness;
        arranged->damping[s] = springs[s].damping;
        arranged->rest_length[s] = springs[s].rest_length;
    }
}

/* What is done with a stretch of springs: where its parameters start, and the state of the particles. */
typedef struct work {
    const stf_spring *springs;
    const stf_real *stiffness, *damping, *rest_length;
    const stf_particles *all;
} work;

static inline bool is_mine(const stf_particles *all, size_t particle) { return particle >= all->begin && particle < all->end; }

/*
 * newtons = f d of n springs, F = -f d, in rows of STF_BLOCK_MAX; the ends start at the offsets a and b. `dimensions` is a
 * constant at each call, so the compiler makes a loop for each; n is a multiple of RUN_MIN, so it needs none for a rest.
 */
STF_INLINE void run_forces(unsigned dimensions, size_t n, size_t stride, const stf_real *restrict x,
                              const stf_real *restrict v, size_t a, size_t b, const stf_real *restrict stiffness,
                              const stf_real *restrict damping, const stf_real *restrict rest_length,
                              stf_real *restrict newtons)
{
    for (size_t i = 0; i < n / RUN_MIN * RUN_MIN; i++) {
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
static void run_part(size_t n, size_t at, const work *w, stf_real *newtons)
{
    const stf_particles *all = w->all;
    const size_t a = stf_particles_offset(all, lower(w->springs)) + at, b = stf_particles_offset(all, upper(w->springs)) + at;
    const stf_real *stiffness = w->stiffness + at, *damping = w->damping + at, *rest_length = w->rest_length + at;
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
        force[i] += newtons[i];
}

static void subtract(size_t n, stf_real *restrict force, const stf_real *restrict newtons)
{
    for (size_t i = 0; i < n; i++)
        force[i] -= newtons[i];
}

/* The ends of a run may overlap (a chain), so its forces are computed first and then added, end by end. */
static void apply_run(size_t n, const work *w)
{
    const stf_particles *all = w->all;
    const size_t a = stf_particles_offset(all, lower(w->springs)), b = stf_particles_offset(all, upper(w->springs));
    const bool a_is_mine = is_mine(all, lower(w->springs)), b_is_mine = is_mine(all, upper(w->springs));
    const size_t whole = n / RUN_MIN * RUN_MIN;
    stf_real newtons[STF_DIMENSIONS_MAX * STF_BLOCK_MAX];

    if (!a_is_mine && !b_is_mine)
        return;
    run_part(whole, 0, w, newtons);
    if (whole < n)
        run_part(RUN_MIN, n - RUN_MIN, w, newtons); /* some twice: cheaper than one by one */
    for (unsigned d = 0; d < all->dimensions && a_is_mine; d++)
        subtract(n, all->force + a + d * all->stride, newtons + d * STF_BLOCK_MAX);
    for (unsigned d = 0; d < all->dimensions && b_is_mine; d++)
        add(n, all->force + b + d * all->stride, newtons + d * STF_BLOCK_MAX);
}

/* Loose springs that are gathered, computed and scattered at a time. */
#define BATCH ((size_t)64)

static void batch_factors(size_t n, stf_real *restrict factor, const stf_real *restrict square,
                          const stf_real *restrict w_dot_d, const stf_real *restrict stiffness,
                          const stf_real *restrict damping, const stf_real *restrict rest_length)
{
    for (size_t i = 0; i < n; i++)
        factor[i] = stf_spring_factor(square[i], w_dot_d[i], stiffness[i], damping[i], rest_length[i]);
}

STF_INLINE void apply_batch(unsigned dimensions, size_t n, const work *w)
{
    const stf_particles *all = w->all;
    const stf_real *x = all->position, *v = all->velocity;
    stf_real d[BATCH][STF_DIMENSIONS_MAX], square[BATCH], w_dot_d[BATCH], factor[BATCH];

    for (size_t s = 0; s < n; s++) {
        const size_t a = stf_particles_offset(all, w->springs[s].a), b = stf_particles_offset(all, w->springs[s].b);
        square[s] = w_dot_d[s] = 0;
        for (unsigned k = 0; k < dimensions; k++) {
            const size_t row = k * all->stride;
            d[s][k] = x[a + row] - x[b + row];
            square[s] += d[s][k] * d[s][k];
            w_dot_d[s] += (v[a + row] - v[b + row]) * d[s][k];
        }
    }
    batch_factors(n, factor, square, w_dot_d, w->stiffness, w->damping, w->rest_length);
    for (size_t s = 0; s < n; s++) {
        const size_t a = stf_particles_offset(all, w->springs[s].a), b = stf_particles_offset(all, w->springs[s].b);
        const bool a_is_mine = is_mine(all, w->springs[s].a), b_is_mine = is_mine(all, w->springs[s].b);
        for (unsigned k = 0; k < dimensions; k++) {
            const stf_real newtons = factor[s] * d[s][k];
            if (a_is_mine)
                all->force[a + k * all->stride] -= newtons;
            if (b_is_mine)
                all->force[b + k * all->stride] += newtons;
        }
    }
}

static void spring_apply(const void *records, size_t record_count, const stf_particles *all, double time)
{
    const stf_spring *springs = records;
    const arrangement *arranged = stf_force_arranged(records, record_count, sizeof *springs);
    (void)time;

    for (const stretch *s = arranged->stretches; s < arranged->stretches + arranged->stretch_count; s++)
        for (size_t done = 0, n; done < s->count; done += n) {
            const size_t first = s->first + done, left = s->count - done;
            const work w = {springs + first, arranged->stiffness + first, arranged->damping + first,
                            arranged->rest_length + first, all};

            n = s->is_run || left < BATCH ? left : BATCH;
            if (s->is_run)
                apply_run(n, &w);
            else if (all->dimensions == 1)
                apply_batch(1, n, &w);
            else if (all->dimensions == 2)
                apply_batch(2, n, &w);
            else
                apply_batch(3, n, &w);
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
    .apply = spring_apply,
    .potential = spring_potential,
    .check = spring_check,
    .renumber = spring_renumber,
    .arrange = spring_arrange,
    .arranged_size = arranged_size,
};
