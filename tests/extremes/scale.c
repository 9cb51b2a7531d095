/*
 * Lengths from 2^-80 to 2^80 m (double: from 2^-640 to 2^640). A world that is scaled by a power of two does the same with the
 * same digits, for as long as no number on the way is denormal or infinite: squares of lengths are the first.
 */
#include <string.h>

#include "lab.h"

#define TICKS 16
#define STEP (1.0 / 16)
#define PARTICLES 3

#ifdef STF_DOUBLE
#define EXPONENTS 8 /* times those of float: of the range too */
#define LEAST_EXPONENT (-1074)
#define MOST_EXPONENT 1024
#else
#define EXPONENTS 1
#define LEAST_EXPONENT (-149)
#define MOST_EXPONENT 128
#endif

/* A system in a scale of lengths, and of time where velocities keep their size; 0: without its force. */
typedef struct system {
    void (*add_force)(stf_world *world, double scale);
    bool scales_time; /* else velocities are scaled */
    bool flies_apart; /* what squares do that are infinite: no force; else NaN */
} system;

static void add_springs(stf_world *world, double scale)
{
    const stf_real rest = (stf_real)(scale / 2);
    const stf_spring springs[] = {{.a = 0, .b = 1, .stiffness = 3, .damping = (stf_real)0.25, .rest_length = rest},
                                  {.a = 1, .b = 2, .stiffness = 2, .rest_length = rest}};
    const stf_anchored_spring anchored = {.particle = 0, .stiffness = 1, .damping = (stf_real)0.5, .rest_length = rest};

    MUST(stf_world_add_force(world, &stf_force_springs, springs, 2, NULL));
    lab_force(world, &stf_force_anchored_springs, &anchored);
}

static void add_attractor(stf_world *world, double scale)
{
    lab_force(world, &stf_force_attractor, &(stf_attractor){.strength = (stf_real)scale, .softening = (stf_real)(scale / 4)});
}

static void add_all_pairs(stf_world *world, double scale)
{
    lab_force(world, &stf_force_all_pairs_gravity, &(stf_all_pairs_gravity){.gravitational_constant = (stf_real)scale});
}

static void add_quadratic_drag(stf_world *world, double scale)
{
    lab_force(world, &stf_force_quadratic_drag, &(stf_quadratic_drag){.coefficient = (stf_real)(0.5 / scale)});
}

static stf_vector times(double scale, double x, double y, double z)
{
    return (stf_vector){(stf_real)(scale * x), (stf_real)(scale * y), (stf_real)(scale * z)};
}

static stf_world *scaled_world(const char *integrator, const system *sys, double scale, bool with_force)
{
    const double time = sys->scales_time ? scale : 1, v = scale / time;
    const stf_particle particles[PARTICLES] = {
        {.position = times(scale, 1, 0.25, 0), .velocity = times(v, 0.125, 0.75, -0.25), .inverse_mass = 1},
        {.position = times(scale, -0.75, 0.5, 0.5), .velocity = times(v, -0.25, -0.5, 0.5), .inverse_mass = 2},
        {.position = times(scale, 0.5, -1, -0.25), .velocity = times(v, 0.75, 0, 0.25), .inverse_mass = (stf_real)0.5},
    };
    stf_world *world = lab_world(integrator, (stf_world_def){.step = STEP * time});

    MUST(stf_world_add_many(world, particles, PARTICLES, NULL));
    if (with_force)
        sys->add_force(world, scale);
    return world;
}

/* The largest distance of a particle from where it is in the other world, scaled, in lengths of that. */
static double distance_of(const stf_world *world, const stf_world *other, double scale)
{
    double most = 0;

    for (size_t i = 0; i < PARTICLES; i++) {
        const stf_vector a = lab_particle(world, i).position, b = lab_particle(other, i).position;
        const double x[] = {(double)a.x, (double)a.y, (double)a.z}, y[] = {(double)b.x, (double)b.y, (double)b.z};
        for (int d = 0; d < 3; d++)
            most = fmax(most, fabs(x[d] / scale - y[d]));
    }
    return most;
}

/*
 * A square of 2^(2 e) has lost 2^LEAST / 2^(2 e) of itself. Forces that are off by that much, of the order of 1 length / unit
 * of time^2, put particles off by a few of it in the unit of time that the run takes.
 */
static void scale(cell *c, const char *integrator, const row *at, const system *sys)
{
    const int exponent = EXPONENTS * (int)at->value;
    const double by = ldexp(1, exponent), lost = ldexp(16, LEAST_EXPONENT - 2 * exponent);
    const bool too_large = 2 * exponent > MOST_EXPONENT, too_small = 2 * exponent + 2 < LEAST_EXPONENT;
    stf_world *world = scaled_world(integrator, sys, by, true), *unit = scaled_world(integrator, sys, 1, true);
    stf_world *free_flight = scaled_world(integrator, sys, by, false);
    size_t index = PARTICLES;

    MUST(stf_world_step(world, 1));
    EXPECT(c, stf_world_find_non_finite(world, &index) == (too_large && !sys->flies_apart));
    MUST(stf_world_step(world, TICKS - 1));
    MUST(stf_world_step(unit, TICKS));
    MUST(stf_world_step(free_flight, TICKS));
    if (too_large && !sys->flies_apart) {
        EXPECT(c, index == 0);
        cell_tick(c, "non-finite", 1);
    } else if (too_large || too_small) {
        EXPECT(c, distance_of(world, free_flight, 1) == 0);
        cell_word(c, "no force");
    } else if (lost < REAL_EPSILON * REAL_EPSILON * REAL_EPSILON) {
        EXPECT(c, distance_of(world, unit, by) == 0);
        cell_word(c, "exact");
    } else {
        EXPECT_CLOSE(c, distance_of(world, unit, by), 0, TICKS * REAL_EPSILON + lost);
        if (distance_of(world, unit, by) > 0)
            cell_number(c, "off ", distance_of(world, unit, by), "");
        else
            cell_word(c, "exact");
    }
    stf_world_destroy(free_flight);
    stf_world_destroy(unit);
    stf_world_destroy(world);
}

static const row scales[] = {
    {"2^-80, 2^-640", -80, false}, {"2^-66, 2^-528", -66, false}, {"2^-60, 2^-480", -60, false},
    {"2^-30, 2^-240", -30, false}, {"1", 0, false},               {"2^30, 2^240", 30, false},
    {"2^60, 2^480", 60, false},    {"2^66, 2^528", 66, false},    {"2^80, 2^640", 80, false},
};

#define HOLDS                                                                                                      \
    "2^e times as large, it moves with the same digits, exactly, for as long as squares are normal numbers; off by\n" \
    "what they lose where they are denormal (the number: in lengths); "

static void scale_springs(cell *c, const char *integrator, const row *at)
{
    scale(c, integrator, at, &(system){.add_force = add_springs});
}

AXIS(axis_scale_springs) = {
    .title = "Three masses on damped springs, by their scale in m (float, double)",
    .holds = HOLDS "no force where they are 0, non-finite at\n"
                   "once where they are infinite.",
    ROWS(scales),
    .run = scale_springs,
};

static void scale_attractor(cell *c, const char *integrator, const row *at)
{
    scale(c, integrator, at, &(system){.add_force = add_attractor, .scales_time = true, .flies_apart = true});
}

AXIS(axis_scale_attractor) = {
    .title = "Three orbits of a softened attractor, by their scale in m (float, double)",
    .holds = HOLDS "no force where they are 0 or infinite.\n"
                   "The header promises 1e-18 to 1e18 m (2^-60 to 2^60) in float.",
    ROWS(scales),
    .run = scale_attractor,
};

static void scale_all_pairs(cell *c, const char *integrator, const row *at)
{
    scale(c, integrator, at, &(system){.add_force = add_all_pairs, .scales_time = true, .flies_apart = true});
}

AXIS(axis_scale_all_pairs) = {
    .title = "Three bodies that pull each other, by their scale in m (float, double)",
    .holds = HOLDS "no force where they are 0 or infinite.",
    ROWS(scales),
    .run = scale_all_pairs,
};

static void scale_drag(cell *c, const char *integrator, const row *at)
{
    scale(c, integrator, at, &(system){.add_force = add_quadratic_drag});
}

AXIS(axis_scale_drag) = {
    .title = "Quadratic drag, by the scale of speeds in m/s (float, double)",
    .holds = HOLDS "no force where they are 0, non-finite at\n"
                   "once where they are infinite.",
    ROWS(scales),
    .run = scale_drag,
};
