/*
 * What the integrators of the library make of x'' = -omega^2 x - k x', where theory gives every number: in units of the step,
 * z = omega dt, q = k dt, u = v dt. Sources: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.2;
 * E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1 and I.5.
 */
#ifndef STEADFAST_TESTS_THEORY_H
#define STEADFAST_TESTS_THEORY_H

/* R(-q): what a step multiplies a velocity by under drag alone. Not of the Verlet methods, which look back at one more. */
double theory_drag_factor(const char *integrator, double q);

/* The largest factor that a step of this integrator can have under drag alone, and that of the amplitude of a spring alone. */
double theory_drag_growth(const char *integrator, double q);
double theory_spring_growth(const char *integrator, double z);

/* What roundings of a step can amount to, in roundings of the state that it starts from: all its terms taken as positive. */
double theory_roundings(const char *integrator, double z);

/* By how much of the spring's own frequency the numerical one is too high, below the integrator's limit. */
double theory_frequency_error(const char *integrator, double z);

/* The motion itself, step by step, in numbers that do not overflow: each is x 2^exponent. */
typedef struct theory {
    const char *integrator;
    double z_square, q;
    double x, u;
    double history; /* of the Verlet methods: the kept acceleration or difference */
    double largest_sum;     /* of the last step: |x|, |u|, accelerations, and sums of stages before they are divided */
    double largest_product; /* x^2 and |x u| where forces were asked about, x 2^(2 exponent): a spring computes both */
    int exponent;
} theory;

theory theory_start(const char *integrator, double z_square, double q, double x, double u);
void theory_step(theory *t);

#endif
