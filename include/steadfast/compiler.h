/* The one place for what C99 does not say. Everything here has a portable fallback. */
#ifndef STEADFAST_COMPILER_H
#define STEADFAST_COMPILER_H

/*
 * STF_API marks what the shared library exports; all else stays hidden. STF_PRINTF has the compiler check a format's
 * arguments. STF_INLINE: written into its callers at any size, so that arguments that are constant there make a loop of its
 * own. STF_CPU_HAS asks this machine for an x86 feature, such as "avx2". STF_GET_MXCSR and STF_SET_MXCSR, where there are any,
 * are the register that holds the floating-point flags of SSE: <fenv.h> takes up to ten times as long.
 */
#if defined(__GNUC__) || defined(__clang__)
#define STF_API __attribute__((visibility("default")))
#define STF_PRINTF(format_argument, first_argument) __attribute__((format(printf, format_argument, first_argument)))
#define STF_INLINE static inline __attribute__((always_inline))
#else
#define STF_API
#define STF_PRINTF(format_argument, first_argument)
#define STF_INLINE static inline
#endif

#if (defined(__GNUC__) || defined(__clang__)) && (defined(__x86_64__) || defined(__i386__))
#define STF_CPU_HAS(feature) (__builtin_cpu_supports(feature) != 0)
#else
#define STF_CPU_HAS(feature) false
#endif

#if (defined(__GNUC__) || defined(__clang__)) && defined(__SSE2_MATH__)
#define STF_GET_MXCSR() __builtin_ia32_stmxcsr()
#define STF_SET_MXCSR(word) __builtin_ia32_ldmxcsr(word)
#endif

#endif
