#include <stdlib.h>
#include <string.h>

#include "kernels.h"

static bool always(void) { return true; }

#ifdef STF_HAS_AVX2
static bool has_avx2(void) { return STF_CPU_HAS("avx2"); }
#endif

#ifdef STF_HAS_AVX512
static bool has_avx512(void)
{
    return STF_CPU_HAS("avx512f") && STF_CPU_HAS("avx512vl") && STF_CPU_HAS("avx512bw") && STF_CPU_HAS("avx512dq");
}
#endif

/* The sets that were built, the widest first; the last runs everywhere. */
static const struct {
    const stf_kernels *kernels;
    bool (*runs_here)(void);
} sets[] = {
#ifdef STF_HAS_AVX512
    {&stf_kernels_avx512, has_avx512},
#endif
#ifdef STF_HAS_AVX2
    {&stf_kernels_avx2, has_avx2},
#endif
    {&stf_kernels_baseline, always},
};

#define SET_COUNT (sizeof sets / sizeof *sets)

const stf_kernels *stf_kernels_choose(void)
{
    const char *wanted = getenv("STEADFAST_ISA"); /* only read here; NOLINT(concurrency-mt-unsafe) */

    for (size_t i = 0; wanted && i < SET_COUNT; i++)
        if (strcmp(wanted, sets[i].kernels->name) == 0 && sets[i].runs_here())
            return sets[i].kernels;

    size_t widest = 0;
    while (!sets[widest].runs_here())
        widest++;
    return sets[widest].kernels;
}

const stf_integrator *stf_kernels_integrator(const stf_kernels *kernels, const stf_integrator *integrator)
{
    for (size_t i = 0; kernels->integrators[i]; i++)
        if (stf_kernels_baseline.integrators[i] == integrator)
            return kernels->integrators[i];
    return integrator;
}

const stf_force *stf_kernels_force(const stf_kernels *kernels, const stf_force *force)
{
    for (size_t i = 0; kernels->forces[i]; i++)
        if (stf_kernels_baseline.forces[i] == force)
            return kernels->forces[i];
    return force;
}
