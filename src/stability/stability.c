/*
 * The modes of the reduced scene are (lambda^2 - lambda B - A) y = 0. Each is taken by itself, as x'' = alpha x + beta x'
 * with the quotients alpha = y* A y and beta = y* B y, and has a first step at which the integrator makes it grow. For
 * Runge-Kutta methods that is all, since they see eigenvalues only. Others mix modes that are damped unalike: so the
 * reduced scene is run as well, and the limit lowered where that grows before. Source: F. Tisseur, K. Meerbergen, SIAM
 * Rev. 43, 235 (2001).
 */
#include "steadfast/stability.h"

#include <string.h>

#include "../allocator.h"
#include "../real.h"
#include "amplification.h"
#include "eigen.h"
#include "reduction.h"

#define ACCELERATIONS_MIN 25
#define FOR_FORCES 3 /* accelerations kept back for the share of each force */
#define SCRATCH 3    /* vectors beside the shapes */

#define FLOOR_MOST 0.5     /* however rough the forces are */
#define FLOOR 2.0          /* times sqrt(noise): eigenvalues that small a part of the largest are round-off around 0 */
#define GROWING 0.01       /* growth by this part of the eigenvalue is one of the scene itself, less is round-off */
#define ALIKE 1e-6         /* modes whose damping over frequency differs by no more have the same limit, scaled */
#define JUST_BELOW 0.98    /* where the reduced scene has to hold, or the limit is looked for below */
#define BISECTIONS 10

/* In units of the frequency. */
typedef struct mode {
    double complex lambda;
    double complex alpha, beta;
    double limit; /* INFINITY: none, or above that of another */
} mode;

typedef struct search {
    const stf_integrator *integrator;
    stf_allocator allocator;
    stf_jacobian jacobian;
    stf_reduction reduction;
    unsigned accelerations; /* at most */
    void *memory;
    size_t bytes;
    double *scratch[SCRATCH]; /* [jacobian.length] */
    double complex *matrix, *values, *shape;
    double *h;     /* of stf_reduce; then `calm` */
    double *calm;  /* [count][count]: A without what grows by itself */
    double growth; /* of that */
} search;

/* ---- memory -------------------------------------------------------------------------------------------------------------- */

/* All that the call needs: `most` is the larger of the number of shapes and, with damping, twice that number. */
static stf_result take_memory(search *s, size_t most)
{
    stf_jacobian *j = &s->jacobian;
    stf_reduction *r = &s->reduction;
    const size_t matrices = (most * most + 2 * most) * sizeof(double complex) + (3 * most + 1) * most * sizeof(double);
    const size_t each = (2 + SCRATCH + most) * sizeof(double) + 4 * sizeof(stf_real);

    if (j->length > (SIZE_MAX - matrices) / each)
        return STF_ERROR_MEMORY;
    s->bytes = matrices + j->length * each;
    s->memory = stf_allocator_allocate(&s->allocator, s->bytes);
    if (!s->memory)
        return STF_ERROR_MEMORY;

    stf_real *state = s->memory; /* first: forces may want it aligned */
    j->position = state;
    j->velocity = state + j->length;
    j->acceleration = state + 2 * j->length;
    j->base = state + 3 * j->length;
    s->matrix = (double complex *)(void *)(state + 4 * j->length);
    s->values = s->matrix + most * most;
    s->shape = s->values + most;
    s->h = (double *)(void *)(s->shape + most);
    r->a = s->h + (most + 1) * most;
    r->b = r->a + most * most;
    j->root = r->b + most * most;
    for (size_t k = 0; k < SCRATCH; k++)
        s->scratch[k] = j->root + (k + 1) * j->length;
    r->shapes = s->scratch[SCRATCH - 1] + j->length;
    return STF_OK;
}

/* ---- the reduced scene --------------------------------------------------------------------------------------------------- */

/* A vector that no shape is perpendicular to, but by a very odd chance; always the same (splitmix64). */
static void fill_with_noise(const stf_jacobian *j, uint64_t seed, double *u)
{
    for (size_t i = 0; i < j->length; i++) {
        uint64_t z = seed += UINT64_C(0x9e3779b97f4a7c15);
        z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
        z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
        u[i] = j->root[i] > 0 ? (double)(z >> 11) / (double)(UINT64_C(1) << 52) - 1 : 0;
    }
}

/* Finds how far to displace, whether velocity matters, and about how fast things are. False: nothing depends on anything. */
static bool settle(search *s)
{
    stf_jacobian *j = &s->jacobian;

    fill_with_noise(j, 1, s->scratch[0]);
    const double stiffness = stf_jacobian_settle_displacement(j, s->scratch[0], s->scratch[1], s->scratch[2]);
    j->frequency = stiffness > 0 ? sqrt(stiffness) : 1;
    fill_with_noise(j, 2, s->scratch[0]);
    const double damping = stf_jacobian_settle_speed(j, s->scratch[0], s->scratch[1], s->scratch[2]);
    s->reduction.damped = damping > 0;
    if (!(stiffness > 0) && damping > 0)
        j->frequency = damping;
    s->reduction.weight = 1;
    if (damping > 0 && stf_first_growth(s->integrator, -1, 0, 1) == 0)
        s->reduction.weight = -fmax(1, j->frequency / damping);
    return stiffness > 0 || damping > 0;
}

static void reduce(search *s)
{
    stf_jacobian *j = &s->jacobian;
    const size_t left = (s->accelerations - j->spent - FOR_FORCES) / (s->reduction.damped ? 2 : 1);
    const size_t most = left < j->unknowns ? left : j->unknowns;

    fill_with_noise(j, 3, s->reduction.shapes);
    s->reduction.damped_shapes = s->reduction.shapes + (most + 1) * j->length;
    stf_reduce(&s->reduction, j, most, s->h);
}

/* ---- modes --------------------------------------------------------------------------------------------------------------- */

/* lambda of x'' = A x + B x': of y' = (0 1; A B) y, or where nothing is damped of lambda^2 x = A x. Returns how many. */
static size_t find_eigenvalues(search *s)
{
    const stf_reduction *r = &s->reduction;
    const size_t n = r->count, order = r->damped ? 2 * n : n;

    for (size_t i = 0; i < order * order; i++)
        s->matrix[i] = 0;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++) {
            s->matrix[(order - n + i) * order + k] = r->a[i * n + k];
            if (r->damped)
                s->matrix[(n + i) * order + n + k] = r->b[i * n + k];
        }
    for (size_t i = 0; r->damped && i < n; i++)
        s->matrix[i * order + n + i] = 1;
    stf_eigenvalues(order, s->matrix, s->values);
    for (size_t i = 0; i < order && !r->damped; i++)
        s->values[i] = csqrt(s->values[i]);
    return order;
}

/* y of (lambda^2 - lambda B - A) y = 0, as parts of the shapes, into s->shape. */
static void find_shape(search *s, double complex lambda)
{
    const stf_reduction *r = &s->reduction;
    const size_t n = r->count;

    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            s->matrix[i * n + k] = (i == k ? lambda * lambda : 0) - lambda * r->b[i * n + k] - r->a[i * n + k];
    stf_null_vector(n, s->matrix, s->shape);
}

/* y* M y */
static double complex quotient(const search *s, const double *m)
{
    const size_t n = s->reduction.count;
    double complex sum = 0;

    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            sum += conj(s->shape[i]) * m[i * n + k] * s->shape[k];
    return sum;
}

/* Without an imaginary part that is round-off. */
static double complex tidy(double complex z) { return fabs(cimag(z)) < ALIKE * cabs(z) ? creal(z) : z; }

/* The eigenvalue of x'' = alpha x + beta x' that is the larger, or the one that grows more. */
static double complex root_of(const mode *m, bool growing)
{
    const double complex half = m->beta / 2, away = csqrt(half * half + m->alpha), a = half + away, b = half - away;

    return (growing ? creal(a) > creal(b) : cabs(a) > cabs(b)) ? a : b;
}

/* Fills in what the mode of m->lambda is, and its limit where that is below `lowest`. `before`: one that may be alike. */
static void look_at(search *s, mode *m, const mode *before, double lowest)
{
    m->alpha = tidy(m->lambda * m->lambda);
    m->beta = 0;
    m->limit = (double)INFINITY;
    if (s->reduction.damped) {
        find_shape(s, m->lambda);
        m->alpha = tidy(quotient(s, s->reduction.a));
        m->beta = tidy(quotient(s, s->reduction.b));
    }

    const double size = cabs(root_of(m, false)), growth = creal(root_of(m, true)), noise = s->jacobian.noise;
    if (growth > GROWING * size) {
        s->growth = fmax(s->growth, growth);
        return;
    }
    if (creal(m->alpha) > 0)
        m->alpha -= creal(m->alpha); /* no force that drives it apart */
    if (creal(m->beta) > -noise * size)
        m->beta -= creal(m->beta); /* no damping, and no growth */

    const double old = cabs(root_of(before, false));
    const double complex alpha = m->alpha / (size * size), beta = m->beta / size;
    if (before->limit < (double)INFINITY && cabs(alpha - before->alpha / (old * old)) < ALIKE &&
        cabs(beta - before->beta / old) < ALIKE)
        m->limit = before->limit * old / size;
    else
        m->limit = stf_first_growth(s->integrator, alpha, beta, lowest * size) / size;
}

/* A -= alpha y y^T: of a mode that grows by itself nothing is left that drives it. */
static void calm_down(search *s, double complex lambda)
{
    const size_t n = s->reduction.count;

    find_shape(s, lambda);
    const double alpha = creal(quotient(s, s->reduction.a));
    for (size_t i = 0; i < n && alpha > 0; i++)
        for (size_t k = 0; k < n; k++)
            s->calm[i * n + k] -= alpha * creal(s->shape[i] * conj(s->shape[k]));
}

/* The mode of the lowest limit; of several at 0 the fastest. Its limit is INFINITY where none has one. */
static mode find_limiting(search *s)
{
    const size_t count = find_eigenvalues(s);
    const double floor_part = fmin(FLOOR * sqrt(s->jacobian.noise), FLOOR_MOST);
    mode limiting = {.limit = (double)INFINITY}, before = limiting;
    double fastest = 0;

    s->calm = s->h;
    memcpy(s->calm, s->reduction.a, s->reduction.count * s->reduction.count * sizeof *s->calm);
    for (size_t i = 0; i < count; i++)
        fastest = fmax(fastest, cabs(s->values[i]));
    for (size_t i = 0; i < count; i++) {
        mode now = {.lambda = s->values[i]};
        const double size = cabs(now.lambda);
        if (s->reduction.damped && creal(now.lambda) > 0)
            calm_down(s, now.lambda);
        if (!(size > 0) || size < floor_part * fastest || cimag(now.lambda) < -ALIKE * size)
            continue;
        look_at(s, &now, &before, limiting.limit);
        before = now;
        if (now.limit < limiting.limit || (now.limit == limiting.limit && size > cabs(limiting.lambda)))
            limiting = now;
    }
    return limiting;
}

/* Lowers the limit to where the reduced scene as a whole, but for what grows by itself, stops to grow. */
static void lower(const search *s, mode *m)
{
    const stf_reduction *r = &s->reduction;
    double below = 0, above = JUST_BELOW * m->limit;

    if (!r->damped || !(m->limit > 0) || !(m->limit < (double)INFINITY) ||
        !stf_run_grows(s->integrator, r->count, s->calm, r->b, above))
        return;
    for (int i = 0; i < BISECTIONS; i++) {
        const double middle = (below + above) / 2;
        *(stf_run_grows(s->integrator, r->count, s->calm, r->b, middle) ? &above : &below) = middle;
    }
    m->limit = below;
}

/* ---- the report ---------------------------------------------------------------------------------------------------------- */

/* The shape of the mode in the world: its real part, when its largest element is real. */
static void find_world_shape(search *s, const mode *m, double *u)
{
    const size_t n = s->jacobian.length;
    double complex largest = 0;

    find_shape(s, m->lambda);
    for (size_t k = 0; k < s->reduction.count; k++)
        largest = cabs(s->shape[k]) > cabs(largest) ? s->shape[k] : largest;
    memset(u, 0, n * sizeof *u);
    for (size_t k = 0; k < s->reduction.count; k++) {
        const double part = creal(s->shape[k] * conj(largest)) / cabs(largest);
        for (size_t i = 0; i < n; i++)
            u[i] += part * s->reduction.shapes[k * n + i];
    }
}

/* Where dx = u / sqrt(m) is largest. */
static size_t find_particle(const stf_jacobian *j, const double *u)
{
    double largest = -1;
    size_t found = SIZE_MAX;

    for (size_t i = 0; i < j->at.count; i++) {
        double square = 0;
        for (unsigned d = 0; d < j->at.dimensions; d++) {
            const size_t k = stf_particles_offset(&j->at, i) + d * j->at.stride;
            square += j->root[k] * j->root[k] * u[k] * u[k];
        }
        if (square > largest)
            largest = square, found = i;
    }
    return found;
}

static stf_force_id find_force(stf_jacobian *j, const double *u, double size)
{
    double largest = 0;
    stf_force_id found = 0, id;

    for (size_t n = 0; (id = stf_world_force_at(j->world, n)) != 0; n++) {
        double of_position, of_velocity;
        stf_jacobian_force_share(j, id, u, &of_position, &of_velocity);
        const double share = of_position + size * of_velocity;
        if (share > largest)
            largest = share, found = id;
    }
    j->spent += FOR_FORCES;
    return found;
}

static unsigned count_substeps(double tick, double limit)
{
    const double needed = fmax(1, ceil(tick / (STF_STABILITY_SAFETY * limit)));

    return limit > 0 && needed <= STF_SUBSTEPS_MAX ? (unsigned)needed : 0;
}

static void describe(search *s, const mode *m, stf_stability *found)
{
    const double unit = s->jacobian.frequency, size = cabs(root_of(m, false));
    double *u = s->scratch[0];

    find_world_shape(s, m, u);
    found->limit = m->limit / unit;
    found->load = found->step / found->limit;
    found->omega = unit * fmax(sqrt(cabs(m->alpha)), fabs(cimag(root_of(m, false))));
    found->damping = unit * fmax(-creal(m->beta), 0);
    found->omega_dt = found->omega * found->step;
    found->k_dt = found->damping * found->step;
    found->particle = find_particle(&s->jacobian, u);
    found->force = find_force(&s->jacobian, u, unit * size);
    found->substeps = count_substeps(stf_world_step_size(s->jacobian.world), found->limit);
    const double residual = s->reduction.left * cabs(s->shape[s->reduction.count - 1]) / (2 * size * size);
    found->residual = fmax(residual, s->jacobian.noise);
}

static void measure(search *s, stf_stability *found)
{
    stf_jacobian *j = &s->jacobian;

    stf_jacobian_begin(j);
    if (!j->finite || j->unknowns == 0 || !settle(s))
        return;
    reduce(s);
    if (!j->finite)
        return;
    mode limiting = find_limiting(s);
    lower(s, &limiting);
    found->growth = s->growth * j->frequency;
    if (limiting.limit < (double)INFINITY)
        describe(s, &limiting, found);
}

stf_result stf_stability_measure(const stf_world *world, const stf_stability_def *def, stf_stability *stability)
{
    if (!world || !stability)
        return STF_ERROR_NULL;

    const stf_stability_def given = def ? *def : (stf_stability_def){.accelerations = 0};
    const unsigned most = given.accelerations ? given.accelerations : STF_STABILITY_ACCELERATIONS_MAX;
    const stf_particles at = stf_world_view(world);
    search s = {.integrator = stf_world_integrator(world), .jacobian = {.world = world, .at = at, .finite = true}};
    stf_stability found = {.limit = (double)INFINITY,
                           .step = stf_world_step_size(world) / stf_world_substeps(world),
                           .particle = SIZE_MAX,
                           .substeps = 1};

    if (!stf_allocator_complete(given.allocator, &s.allocator))
        return STF_ERROR_DESCRIPTOR;
    s.accelerations = most < ACCELERATIONS_MIN                 ? ACCELERATIONS_MIN
                      : most > STF_STABILITY_ACCELERATIONS_MAX ? STF_STABILITY_ACCELERATIONS_MAX
                                                               : most;
    if (at.count > 0) {
        s.jacobian.length = (at.count + at.stride - 1) / at.stride * at.stride * at.dimensions;
        const stf_result bad = take_memory(&s, s.accelerations);
        if (bad)
            return bad;
        measure(&s, &found);
        stf_allocator_release(&s.allocator, s.memory, s.bytes);
    }
    if (!s.jacobian.finite)
        return STF_ERROR_NOT_FINITE;
    found.accelerations = s.jacobian.spent;
    *stability = found;
    return STF_OK;
}
