/* The GNU Scientific Library: its ODE steppers, in double. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>

#include "ode_state.h"

typedef struct solver {
    const workload *w;
    const method *m;
    double *y, *error, setting;
    size_t first, group; /* bodies of the state that is being solved */
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver; /* of the race */
    gsl_odeiv2_step *stepper;  /* of FLIGHT */
} solver;

static int rates_of(double t, const double y[], double rates[], void *self)
{
    const solver *s = self;
    (void)t;

    ode_rates(s->w, s->w->kind, s->first, s->group, y, rates);
    return 0;
}

enum { RK4, RKF45, RKCK, RK8PD, MSADAMS };

/* In one state all bodies step alike; one by one each has steps of its own. */
static const method list[] = {
    {.name = "rk4", .workloads = DOES_FLIGHT, .dimensions = 3, .order = 4, .variant = RK4},
    {.name = "rk4, 1,000 a state", .workloads = DOES_FLIGHT, .dimensions = 3, .order = 4, .group = 1000, .variant = RK4},
    {.name = "rkf45, 1,000 a state", .workloads = DOES_FLIGHT, .dimensions = 3, .order = 4, .group = 1000, .variant = RKF45},
    {.name = "rkf45, all in one", .workloads = DOES_RACE, .adaptive = true, .variant = RKF45},
    {.name = "rkf45, one by one", .workloads = DOES_RACE, .adaptive = true, .group = 1, .variant = RKF45},
    {.name = "rkck, all in one", .workloads = DOES_RACE, .adaptive = true, .variant = RKCK},
    {.name = "rkck, one by one", .workloads = DOES_RACE, .adaptive = true, .group = 1, .variant = RKCK},
    {.name = "rk8pd, all in one", .workloads = DOES_RACE, .adaptive = true, .variant = RK8PD},
    {.name = "rk8pd, one by one", .workloads = DOES_RACE, .adaptive = true, .group = 1, .variant = RK8PD},
    {.name = "msadams, all in one", .workloads = DOES_RACE, .adaptive = true, .variant = MSADAMS},
    {.name = "msadams, one by one", .workloads = DOES_RACE, .adaptive = true, .group = 1, .variant = MSADAMS},
    {0}};

static const method *methods(void) { return list; }

static const gsl_odeiv2_step_type *type_of(const method *m)
{
    return m->variant == RK4     ? gsl_odeiv2_step_rk4
           : m->variant == RKF45 ? gsl_odeiv2_step_rkf45
           : m->variant == RKCK  ? gsl_odeiv2_step_rkck
           : m->variant == RK8PD ? gsl_odeiv2_step_rk8pd
                                 : gsl_odeiv2_step_msadams;
}

#define FIRST_STEP 0.01 /* s: where an adaptive method starts */

static void *create(const workload *w, const method *m, double setting)
{
    solver *s = need(sizeof *s);

    *s = (solver){.w = w, .m = m, .setting = setting};
    gsl_set_error_handler_off(); /* a tolerance out of reach shows as an error out of bounds */
    s->y = need(2 * w->dimensions * w->count * sizeof(double));
    ode_load(w, m, s->y);
    s->error = need(2 * w->dimensions * ode_group(w, m, 0) * sizeof(double));
    s->system.function = rates_of;
    s->system.dimension = 2 * w->dimensions * ode_group(w, m, 0);
    s->system.params = s;
    if (m->adaptive)
        s->driver = gsl_odeiv2_driver_alloc_y_new(&s->system, type_of(m), FIRST_STEP, setting, setting);
    else
        s->stepper = gsl_odeiv2_step_alloc(type_of(m), s->system.dimension);
    return s;
}

/* Groups are of one size: counts are multiples of it. */
static void advance(void *self, double duration)
{
    solver *s = self;

    for (s->first = 0; s->first < s->w->count; s->first += s->group) {
        double *y = s->y + 2 * s->w->dimensions * s->first, t = 0;
        s->group = ode_group(s->w, s->m, s->first);
        if (s->driver) {
            gsl_odeiv2_driver_reset_hstart(s->driver, FIRST_STEP);
            gsl_odeiv2_driver_apply(s->driver, &t, duration, y);
            continue;
        }
        for (long i = lround(duration / s->setting); i > 0; i--)
            gsl_odeiv2_step_apply(s->stepper, t, s->setting, y, s->error, NULL, NULL, &s->system);
    }
}

static void read(const void *self, double *position, double *velocity)
{
    const solver *s = self;

    ode_store(s->w, s->m, s->y, position, velocity);
}

static void destroy(void *self)
{
    solver *s = self;

    if (s->driver)
        gsl_odeiv2_driver_free(s->driver);
    if (s->stepper)
        gsl_odeiv2_step_free(s->stepper);
    free(s->error);
    free(s->y);
    free(s);
}

static void version(char *text, size_t size) { snprintf(text, size, "%s", gsl_version); }

extern const peer peer_gsl;
const peer peer_gsl = {
    .name = "GSL",
    .package = "libgsl-dev",
    .reals = "double",
    .note = "fixed steps by step_apply, the race by the driver, absolute and relative tolerance alike. Its rk4 always\n"
            "estimates its error by two half steps (11 evaluations a step); rkf45 takes 6",
    .version = version,
    .methods = methods,
    .create = create,
    .advance = advance,
    .read = read,
    .destroy = destroy,
};
