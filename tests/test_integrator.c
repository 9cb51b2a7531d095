/* Each integrator by itself, without a world: one step against its formula, and the promises of its descriptor. */
#include <math.h>
#include <string.h>

#include "support/check.h"
#include "support/problem.h"

#define LENGTH 5

/* An acceleration that mixes t, x and v, with nothing of it symmetric, and counts how often it is asked for. */
typedef struct probe {
    stf_system system;
    int evaluations;
} probe;

static long double acceleration_at(long double t, long double x, long double v)
{
    return -x + x * v / 4 - v * v / 8 + t * t / 2;
}

static void accelerate(stf_system *system, double time, const stf_real *position, const stf_real *velocity,
                       stf_real *acceleration)
{
    probe *p = (probe *)system;

    p->evaluations++;
    for (size_t i = 0; i < system->length; i++)
        acceleration[i] = (stf_real)acceleration_at((long double)time, (long double)position[i], (long double)velocity[i]);
}

typedef struct arrays {
    stf_real position[LENGTH], velocity[LENGTH], work[STF_WORK_ARRAYS_MAX][LENGTH], history[STF_HISTORY_ARRAYS_MAX][LENGTH];
} arrays;

/* Work and history start as NaN: whoever reads them before writing is found out. */
static probe make_probe(const stf_integrator *integrator, arrays *a)
{
    probe p = {.system = {.length = LENGTH, .time = 0.25, .history_stale = true, .accelerate = accelerate}};

    for (size_t i = 0; i < LENGTH; i++) {
        a->position[i] = (stf_real)(0.5 + 0.25 * (double)i);
        a->velocity[i] = (stf_real)(1.0 - 0.5 * (double)i);
        for (int k = 0; k < STF_WORK_ARRAYS_MAX; k++)
            a->work[k][i] = (stf_real)NAN;
        for (int k = 0; k < STF_HISTORY_ARRAYS_MAX; k++)
            a->history[k][i] = (stf_real)NAN;
    }
    p.system.position = a->position;
    p.system.velocity = a->velocity;
    for (int k = 0; k < integrator->work_arrays; k++)
        p.system.work[k] = a->work[k];
    for (int k = 0; k < integrator->history_arrays; k++)
        p.system.history[k] = a->history[k];
    return p;
}

/* Butcher's tableaux: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, sec. II.1. */
#define STAGES 4
typedef struct tableau {
    const stf_integrator *integrator;
    int stages;
    double a[STAGES][STAGES], b[STAGES], c[STAGES];
} tableau;

static const tableau tableaux[] = {
    {&stf_explicit_euler, 1, {{0}}, {1}, {0}},
    {&stf_midpoint, 2, {{0}, {0.5}}, {0, 1}, {0, 0.5}},
    {&stf_improved_euler, 2, {{0}, {1}}, {0.5, 0.5}, {0, 1}},
    {&stf_rk4, 4, {{0}, {0.5}, {0, 0.5}, {0, 0, 1}}, {1 / 6.0, 1 / 3.0, 1 / 3.0, 1 / 6.0}, {0, 0.5, 0.5, 1}},
};

static void step_by_tableau(const tableau *t, long double time, long double h, long double *x, long double *v)
{
    long double slope_x[STAGES], slope_v[STAGES], end_x = *x, end_v = *v;

    for (int i = 0; i < t->stages; i++) {
        long double stage_x = *x, stage_v = *v;
        for (int j = 0; j < i; j++) {
            stage_x += h * (long double)t->a[i][j] * slope_x[j];
            stage_v += h * (long double)t->a[i][j] * slope_v[j];
        }
        slope_x[i] = stage_v;
        slope_v[i] = acceleration_at(time + h * (long double)t->c[i], stage_x, stage_v);
        end_x += h * (long double)t->b[i] * slope_x[i];
        end_v += h * (long double)t->b[i] * slope_v[i];
    }
    *x = end_x;
    *v = end_v;
}

/* Values stay below 4 and a step takes some ten roundings of them, most of them scaled by h. */
#define ROUND_OFF (4 * 4 * REAL_EPSILON)

static void runge_kutta_steps_are_their_tableaux(void **state)
{
    (void)state;
    const long double h = 0.25L;

    for (size_t k = 0; k < COUNT_OF(tableaux); k++) {
        arrays a;
        probe p = make_probe(tableaux[k].integrator, &a);
        const arrays before = a;

        tableaux[k].integrator->step(&p.system, (stf_real)h);
        for (size_t i = 0; i < LENGTH; i++) {
            long double x = (long double)before.position[i], v = (long double)before.velocity[i];
            step_by_tableau(&tableaux[k], (long double)p.system.time, h, &x, &v);
            assert_close(a.position[i], x, ROUND_OFF);
            assert_close(a.velocity[i], v, ROUND_OFF);
        }
    }
}

static void semi_implicit_euler_moves_with_the_new_velocity(void **state)
{
    (void)state;
    arrays a;
    probe p = make_probe(&stf_semi_implicit_euler, &a);
    const arrays before = a;
    const long double h = 0.25L;

    stf_semi_implicit_euler.step(&p.system, (stf_real)h);
    for (size_t i = 0; i < LENGTH; i++) {
        const long double x = (long double)before.position[i], v = (long double)before.velocity[i];
        const long double new_v = v + h * acceleration_at((long double)p.system.time, x, v);
        assert_close(a.velocity[i], new_v, ROUND_OFF);
        assert_close(a.position[i], x + h * new_v, ROUND_OFF);
    }
}

/* x(1) = x(0) + v(0) h + a(0) h^2 / 2; velocity Verlet's v(1) = v(0) + (a(0) + a(1)) h / 2, at the predicted v(0) + a(0) h. */
static void verlet_methods_start_of_second_order(void **state)
{
    (void)state;
    const stf_integrator *const both[] = {&stf_position_verlet, &stf_velocity_verlet};
    const long double h = 0.25L;

    for (size_t k = 0; k < COUNT_OF(both); k++) {
        arrays a;
        probe p = make_probe(both[k], &a);
        const arrays before = a;

        both[k]->step(&p.system, (stf_real)h);
        for (size_t i = 0; i < LENGTH; i++) {
            const long double t = (long double)p.system.time, x = (long double)before.position[i];
            const long double v = (long double)before.velocity[i], a0 = acceleration_at(t, x, v);
            const long double x1 = x + v * h + a0 * h * h / 2, a1 = acceleration_at(t + h, x1, v + a0 * h);

            assert_close(a.position[i], x1, ROUND_OFF);
            assert_close(a.velocity[i], k == 0 ? v + a0 * h : v + (a0 + a1) * h / 2, ROUND_OFF);
        }
    }
}

/* Störmer: x(n+1) - 2 x(n) + x(n-1) = a(n) h^2, with a(n) at the velocity that the step before reported. */
static void position_verlet_is_stormers_recursion(void **state)
{
    (void)state;
    arrays a;
    probe p = make_probe(&stf_position_verlet, &a);
    const long double h = 0.25L;
    arrays before = a, now;

    stf_position_verlet.step(&p.system, (stf_real)h);
    p.system.history_stale = false;
    for (int n = 1; n < 4; n++) {
        now = a;
        p.system.time += (double)h;
        stf_position_verlet.step(&p.system, (stf_real)h);
        for (size_t i = 0; i < LENGTH; i++) {
            const long double x = (long double)now.position[i];
            const long double a_n = acceleration_at((long double)p.system.time, x, (long double)now.velocity[i]);
            assert_close(a.position[i], 2 * x - (long double)before.position[i] + a_n * h * h, 2 * ROUND_OFF);
        }
        before = now;
    }
}

static void evaluations_a_step_are_as_the_descriptor_says(void **state)
{
    (void)state;
    const int steps = 10;

    for (int k = 0; stf_integrators[k]; k++) {
        arrays a;
        probe p = make_probe(stf_integrators[k], &a);

        stf_integrators[k]->step(&p.system, (stf_real)0.125);
        p.system.history_stale = false;
        p.evaluations = 0;
        for (int n = 0; n < steps; n++)
            stf_integrators[k]->step(&p.system, (stf_real)0.125);
        assert_int_equal(p.evaluations, steps * stf_integrators[k]->evaluations);
    }
}

/* Without a call in between, the history of a step has to be the last step's: it is used, and rebuilt only if stale. */
static void history_is_used_unless_it_is_stale(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++) {
        const stf_integrator *integrator = stf_integrators[k];
        arrays a, b;
        probe p = make_probe(integrator, &a), q = make_probe(integrator, &b);

        integrator->step(&p.system, (stf_real)0.125);
        integrator->step(&q.system, (stf_real)0.125);
        for (size_t i = 0; i < LENGTH; i++)
            b.history[0][i] = (stf_real)NAN;

        q.system.history_stale = true;
        integrator->step(&q.system, (stf_real)0.125);
        assert_true(isfinite(b.position[0]) && isfinite(b.velocity[0]));
        p.system.history_stale = false;
        for (size_t i = 0; i < LENGTH; i++)
            a.history[0][i] = (stf_real)NAN;
        integrator->step(&p.system, (stf_real)0.125);
        assert_int_equal(isfinite(a.position[0]) && isfinite(a.velocity[0]), integrator->history_arrays == 0);
    }
}

static void list_is_found_by_name_and_complete(void **state)
{
    (void)state;
    const stf_integrator *const expected[] = {&stf_explicit_euler, &stf_semi_implicit_euler, &stf_midpoint,
                                              &stf_improved_euler, &stf_rk4, &stf_position_verlet,
                                              &stf_velocity_verlet};
    size_t count = 0;

    while (stf_integrators[count])
        count++;
    assert_int_equal(count, COUNT_OF(expected));
    for (size_t k = 0; k < count; k++) {
        assert_ptr_equal(stf_integrators[k], expected[k]);
        assert_ptr_equal(stf_integrator_find(expected[k]->name), expected[k]);
    }
    assert_null(stf_integrator_find("rk"));
    assert_null(stf_integrator_find("rk44"));
    assert_null(stf_integrator_find(""));
    assert_null(stf_integrator_find(NULL));
}

/* Else its free flight would be the slow kind, with the same bits. */
static void every_integrator_of_the_library_has_a_flight(void **state)
{
    (void)state;
    for (int k = 0; stf_integrators[k]; k++)
        assert_true(stf_integrators[k]->step_flight != NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runge_kutta_steps_are_their_tableaux),
        cmocka_unit_test(semi_implicit_euler_moves_with_the_new_velocity),
        cmocka_unit_test(verlet_methods_start_of_second_order),
        cmocka_unit_test(position_verlet_is_stormers_recursion),
        cmocka_unit_test(evaluations_a_step_are_as_the_descriptor_says),
        cmocka_unit_test(history_is_used_unless_it_is_stale),
        cmocka_unit_test(every_integrator_of_the_library_has_a_flight),
        cmocka_unit_test(list_is_found_by_name_and_complete),
    };

    return cmocka_run_group_tests_name("integrator, " REAL_NAME, tests, NULL, NULL);
}
