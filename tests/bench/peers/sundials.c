/* SUNDIALS: ARKODE's explicit Runge-Kutta methods and CVODE's Adams methods, in double. */
#include <stdio.h>
#include <stdlib.h>

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "ode_state.h"

typedef struct solver {
    const workload *w;
    const method *m;
    double *y, setting;
    size_t first, group; /* bodies of the state that is being solved */
    SUNContext context;
    N_Vector state; /* a window on y */
    void *erk, *cvode;
    SUNNonlinearSolver fixed_point;
} solver;

static int rates_of(realtype t, N_Vector y, N_Vector rates, void *self)
{
    const solver *s = self;
    (void)t;

    ode_rates(s->w, s->w->kind, s->first, s->group, N_VGetArrayPointer(y), N_VGetArrayPointer(rates));
    return 0;
}

enum { ADAMS = -1 }; /* else a number of ARKODE's tables */

#define BOTH_WAYS(title, number) \
    {.name = title ", all in one", .workloads = DOES_RACE, .adaptive = true, .variant = number}, \
    {.name = title ", one by one", .workloads = DOES_RACE, .adaptive = true, .group = 1, .variant = number}

static const method list[] = {
    {.name = "ERK Zonneveld 4", .workloads = DOES_FLIGHT, .dimensions = 3, .order = 4, .variant = ARKODE_ZONNEVELD_5_3_4},
    {.name = "ERK Zonneveld 4, 1,000 a state", .workloads = DOES_FLIGHT, .dimensions = 3, .order = 4, .group = 1000,
     .variant = ARKODE_ZONNEVELD_5_3_4},
    BOTH_WAYS("CVODE Adams", ADAMS),
    BOTH_WAYS("ERK Fehlberg 8", ARKODE_FEHLBERG_13_7_8),
    BOTH_WAYS("ERK Verner 6", ARKODE_VERNER_8_5_6),
    BOTH_WAYS("ERK Dormand-Prince 5", ARKODE_DORMAND_PRINCE_7_4_5),
    BOTH_WAYS("ERK Zonneveld 4", ARKODE_ZONNEVELD_5_3_4),
    BOTH_WAYS("ERK Bogacki-Shampine 3", ARKODE_BOGACKI_SHAMPINE_4_2_3),
    {0}};

static const method *methods(void) { return list; }

static void create_erk(solver *s)
{
    s->erk = ERKStepCreate(rates_of, 0, s->state, s->context);
    ERKStepSetUserData(s->erk, s);
    ERKStepSetMaxNumSteps(s->erk, -1);
    ERKStepSetErrFile(s->erk, NULL); /* a tolerance out of reach shows as an error out of bounds */
    ERKStepSetTableNum(s->erk, (ARKODE_ERKTableID)s->m->variant);
    if (s->m->adaptive)
        ERKStepSStolerances(s->erk, s->setting, s->setting);
    else
        ERKStepSetFixedStep(s->erk, s->setting);
}

static void create_cvode(solver *s)
{
    s->cvode = CVodeCreate(CV_ADAMS, s->context);
    s->fixed_point = SUNNonlinSol_FixedPoint(s->state, 0, s->context);
    CVodeInit(s->cvode, rates_of, 0, s->state);
    CVodeSetUserData(s->cvode, s);
    CVodeSStolerances(s->cvode, s->setting, s->setting);
    CVodeSetNonlinearSolver(s->cvode, s->fixed_point);
    CVodeSetMaxNumSteps(s->cvode, -1);
    CVodeSetErrFile(s->cvode, NULL);
}

static void *create(const workload *w, const method *m, double setting)
{
    solver *s = need(sizeof *s);

    *s = (solver){.w = w, .m = m, .setting = setting, .group = ode_group(w, m, 0)};
    s->y = need(2 * w->dimensions * w->count * sizeof(double));
    ode_load(w, m, s->y);
    SUNContext_Create(NULL, &s->context);
    s->state = N_VMake_Serial((sunindextype)(2 * w->dimensions * s->group), s->y, s->context);
    N_VEnableFusedOps_Serial(s->state, SUNTRUE); /* its clones have them too: fewer passes over the vectors */
    if (m->variant == ADAMS)
        create_cvode(s);
    else
        create_erk(s);
    return s;
}

/* Groups are of one size: counts are multiples of it. Fixed steps are taken one a call. */
static void advance(void *self, double duration)
{
    solver *s = self;
    realtype t = 0;

    for (s->first = 0; s->first < s->w->count; s->first += s->group) {
        N_VSetArrayPointer(s->y + 2 * s->w->dimensions * s->first, s->state);
        if (s->cvode) {
            CVodeReInit(s->cvode, 0, s->state);
            CVodeSetStopTime(s->cvode, duration);
            CVode(s->cvode, duration, s->state, &t, CV_NORMAL);
        } else if (s->m->adaptive) {
            ERKStepReInit(s->erk, rates_of, 0, s->state);
            ERKStepSetStopTime(s->erk, duration);
            ERKStepEvolve(s->erk, duration, s->state, &t, ARK_NORMAL);
        } else {
            if (s->group < s->w->count)
                ERKStepReset(s->erk, 0, s->state);
            for (t = 0; t < duration - s->setting / 2; t += s->setting) {
                realtype reached;
                ERKStepEvolve(s->erk, duration, s->state, &reached, ARK_ONE_STEP);
            }
        }
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

    if (s->erk)
        ERKStepFree(&s->erk);
    if (s->cvode) {
        CVodeFree(&s->cvode);
        SUNNonlinSolFree(s->fixed_point);
    }
    N_VDestroy(s->state);
    SUNContext_Free(&s->context);
    free(s->y);
    free(s);
}

static void version(char *text, size_t size) { SUNDIALSGetVersion(text, (int)size); }

extern const peer peer_sundials;
const peer peer_sundials = {
    .name = "SUNDIALS",
    .package = "libsundials-dev",
    .reals = "double",
    .note = "serial vectors, absolute and relative tolerance alike. Zonneveld 4 is RK4 and a stage for an error estimate;\n"
            "RK4 itself ERKStep 6.4 gets wrong (it takes the last stage for the next step's first); SPRK came with 6.6.\n"
            "Debian builds it without optimisation (-O0): its figures are the package's, not the library's",
    .version = version,
    .methods = methods,
    .create = create,
    .advance = advance,
    .read = read,
    .destroy = destroy,
};
