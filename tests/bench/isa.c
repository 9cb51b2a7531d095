#include <stdlib.h>
#include <string.h>

#include "workload.h"

#if defined(BENCH_X86_SETS) && (defined(__GNUC__) || defined(__clang__))
static int has_avx512(void)
{
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512bw");
}

static const char *best(void) { return has_avx512() ? "avx512" : __builtin_cpu_supports("avx2") ? "avx2" : "baseline"; }
#else
static const char *best(void) { return "baseline"; }
#endif

/* From the least to the most: a processor that has one has those before it. */
static const char *const sets[] = {"baseline", "avx2", "avx512"};

static size_t rank(const char *name)
{
    size_t r = sizeof sets / sizeof *sets;

    while (r-- > 0)
        if (strcmp(sets[r], name) == 0)
            return r;
    return 0;
}

const char *bench_isa(void)
{
    const char *wanted = getenv("STEADFAST_ISA"), *most = best();

    if (!wanted || (rank(wanted) == 0 && strcmp(wanted, sets[0]) != 0))
        return most;
    return rank(wanted) < rank(most) ? sets[rank(wanted)] : most;
}
