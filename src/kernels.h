/* The hot loops, compiled for several instruction sets from the same source, with the same bits. */
#ifndef STEADFAST_SRC_KERNELS_H
#define STEADFAST_SRC_KERNELS_H

#include "real.h"
#include "steadfast/force.h"
#include "steadfast/integrator.h"

#ifdef STF_DOUBLE
#define stf_kernels stf_kernels_f64
#define stf_kernels_baseline stf_kernels_baseline_f64
#define stf_kernels_avx2 stf_kernels_avx2_f64
#define stf_kernels_avx512 stf_kernels_avx512_f64
#define stf_kernels_choose stf_kernels_choose_f64
#define stf_kernels_integrator stf_kernels_integrator_f64
#define stf_kernels_force stf_kernels_force_f64
#endif

/* What one instruction set has. The same place in two sets is the same integrator or force; the baseline's are public. */
typedef struct stf_kernels {
    const char *name;
    const stf_integrator *const *integrators; /* NULL-terminated, as stf_integrators */
    const stf_force *const *forces;           /* NULL-terminated */

    /* a = gravity - (drag / m) v + F / m, 0 for the immovable, of so many blocks. `a` holds F and gets a. */
    void (*accelerate)(const stf_flight *flight, size_t blocks, const stf_real *inverse_mass, const stf_real *velocity,
                       stf_real *a);

    /* What is smaller than STF_AT_REST becomes 0, whatever acts on these blocks. */
    void (*settle)(const stf_flight *flight);

    /* Whether the magnitude of any x[i] is over `most` or a NaN's; raises no floating-point flag. `length`: whole rows. */
    bool (*exceeds)(const stf_real *x, size_t length, stf_real most);
} stf_kernels;

extern const stf_kernels stf_kernels_baseline, stf_kernels_avx2, stf_kernels_avx512;

/* The widest set that this machine runs, or the one that the environment variable STEADFAST_ISA names. */
const stf_kernels *stf_kernels_choose(void);

/* The same integrator or force from this set; one that is not the library's is its own. */
const stf_integrator *stf_kernels_integrator(const stf_kernels *kernels, const stf_integrator *integrator);
const stf_force *stf_kernels_force(const stf_kernels *kernels, const stf_force *force);

#endif
