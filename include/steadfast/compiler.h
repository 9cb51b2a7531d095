/* The one place for what C99 does not say. Everything here has a portable fallback. */
#ifndef STEADFAST_COMPILER_H
#define STEADFAST_COMPILER_H

/*
 * STF_API marks what the shared library exports; all else stays hidden. STF_PRINTF has the compiler check a format's
 * arguments.
 */
#if defined(__GNUC__) || defined(__clang__)
#define STF_API __attribute__((visibility("default")))
#define STF_PRINTF(format_argument, first_argument) __attribute__((format(printf, format_argument, first_argument)))
#else
#define STF_API
#define STF_PRINTF(format_argument, first_argument)
#endif

#endif
