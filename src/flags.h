/*
 * The floating-point flags of this thread that arithmetic raises when it makes what is not finite out of what is: overflow,
 * invalid operation, division by zero (C99 7.6). The engine's flags are put back, and what was raised since stays raised, as
 * without anybody who looked.
 */
#ifndef STEADFAST_SRC_FLAGS_H
#define STEADFAST_SRC_FLAGS_H

#include "steadfast/base.h"

#ifdef STF_GET_MXCSR

#define STF_MXCSR_FLAGS 0x0dU /* IE, ZE, OE */

typedef unsigned stf_flags;

/* Clears the flags; returns those that were raised, for stf_flags_put_back. */
static inline stf_flags stf_flags_take(void)
{
    const unsigned word = STF_GET_MXCSR();

    if (word & STF_MXCSR_FLAGS)
        STF_SET_MXCSR(word & ~STF_MXCSR_FLAGS);
    return word & STF_MXCSR_FLAGS;
}

/* Whether any has been raised since. */
static inline bool stf_flags_put_back(stf_flags before)
{
    const unsigned word = STF_GET_MXCSR();

    if (before & ~word)
        STF_SET_MXCSR(word | before);
    return (word & STF_MXCSR_FLAGS) != 0;
}

#else

#include <fenv.h>

#if defined(FE_OVERFLOW) && defined(FE_INVALID) && defined(FE_DIVBYZERO)

#define STF_FENV_FLAGS (FE_OVERFLOW | FE_INVALID | FE_DIVBYZERO)

typedef struct stf_flags {
    int raised;
    fexcept_t state;
} stf_flags;

static inline stf_flags stf_flags_take(void)
{
    stf_flags before = {.raised = fetestexcept(STF_FENV_FLAGS)};

    if (before.raised) {
        fegetexceptflag(&before.state, before.raised);
        feclearexcept(before.raised);
    }
    return before;
}

static inline bool stf_flags_put_back(stf_flags before)
{
    const int raised = fetestexcept(STF_FENV_FLAGS);

    if (before.raised & ~raised)
        fesetexceptflag(&before.state, before.raised & ~raised);
    return raised != 0;
}

#else

typedef int stf_flags;

static inline stf_flags stf_flags_take(void) { return 0; }

static inline bool stf_flags_put_back(stf_flags before) { return before != 0; }

#endif
#endif

#endif
