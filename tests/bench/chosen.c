#include <string.h>

#include "reference.h"
#include "workload.h"

#ifdef STF_DOUBLE
#define IN_PRECISION(name) name##_f64
#else
#define IN_PRECISION(name) name##_f32
#endif

extern const reference IN_PRECISION(reference_baseline), IN_PRECISION(reference_avx2), IN_PRECISION(reference_avx512);

static const reference *const all[] = {
#ifdef STF_HAS_AVX512
    &IN_PRECISION(reference_avx512),
#endif
#ifdef STF_HAS_AVX2
    &IN_PRECISION(reference_avx2),
#endif
    &IN_PRECISION(reference_baseline),
};

const reference *reference_chosen(void)
{
    static const reference *chosen;

    for (size_t i = 0; !chosen && i < sizeof all / sizeof *all; i++)
        if (strcmp(all[i]->isa, bench_isa()) == 0)
            chosen = all[i];
    return chosen;
}
