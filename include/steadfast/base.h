/*
 * base: the real type, vectors, results, the allocator, the version.
 *
 * Units are SI wherever a unit is named. Any other consistent set (astronomical units, days, solar masses) works
 * as well: the library holds no physical constant.
 *
 * Precision: stf_real is float. `#define STF_DOUBLE` before the first Steadfast include makes it double and picks the
 * second set of symbols of the same library; see precision.h.
 */
#ifndef STEADFAST_BASE_H
#define STEADFAST_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "steadfast/compiler.h"
#include "steadfast/precision.h"

#ifdef __cplusplus
extern "C" {
#endif

#define STF_VERSION_MAJOR 0
#define STF_VERSION_MINOR 1
#define STF_VERSION_PATCH 0

/* What a step of 0 stands for in the defs of worlds and clocks, s. */
#define STF_DEFAULT_STEP (1.0 / 60.0)

/* The largest number of dimensions of a world. */
#define STF_DIMENSIONS_MAX 3

/* Three components. A world of fewer dimensions wants 0 in those that it does not have. */
typedef struct stf_vector {
    stf_real x, y, z;
} stf_vector;

/* What a function that can fail returns. Anything but STF_OK means that nothing has changed, but for STF_ERROR_DIVERGED. */
typedef enum stf_result {
    STF_OK = 0,
    STF_ERROR_NULL,       /* a pointer that has to point somewhere is NULL */
    STF_ERROR_MEMORY,     /* the allocator returned NULL, or the size asked for does not fit size_t */
    STF_ERROR_NOT_FINITE, /* a NaN or an infinity */
    STF_ERROR_DIMENSIONS, /* dimensions over 3, or a component other than 0 in a dimension that the world lacks */
    STF_ERROR_STEP,       /* a step that is negative, not finite, or over its substeps no normal number of stf_real */
    STF_ERROR_SUBSTEPS,   /* 0 substeps, or more than STF_SUBSTEPS_MAX */
    STF_ERROR_MASS,       /* an inverse mass that is negative, infinite, NaN or subnormal (its mass may be no stf_real) */
    STF_ERROR_RADIUS,     /* a radius that is negative, infinite or NaN, or not 0 in a world that does not keep radii */
    STF_ERROR_PARTICLE,   /* no particle has this index */
    STF_ERROR_FORCE,      /* no force has this id */
    STF_ERROR_PARAMETERS, /* a negative or non-finite coefficient, a spring from a particle to itself, records
                             for a force that has none */
    STF_ERROR_DESCRIPTOR, /* an integrator or force whose descriptor is incomplete or asks for too many arrays; an integrator
                             that does not compensate, for a world that does */
    STF_ERROR_FRAME_TIME, /* a frame time, time scale or display period that is negative or not finite */
    STF_ERROR_ALPHA,      /* a blending factor outside [0, 1] */
    STF_ERROR_STRIDE,     /* a stride that is smaller than what it steps over, or beyond memory */
    STF_ERROR_NO_PREVIOUS, /* blending was asked of a world that does not keep previous positions */
    STF_ERROR_BUFFER,      /* a buffer that is smaller than what has to go into it */
    STF_ERROR_UNSAVABLE,   /* a force has records and does not say what they are made of (stf_force.fields) */
    STF_ERROR_FOREIGN,     /* bytes that are no saved world */
    STF_ERROR_VERSION,     /* a world saved in a format that this library does not read */
    STF_ERROR_PRECISION,   /* a world saved by the other precision */
    STF_ERROR_TRUNCATED,   /* a saved world whose end is missing */
    STF_ERROR_ALTERED,     /* a saved world whose checksum does not fit, or that contradicts itself */
    STF_ERROR_MISMATCH,    /* a world that was not made like the saved one: see stf_mismatch */
    STF_ERROR_SNAPSHOT,    /* no snapshot, or one of a world that had other forces or more room */
    STF_ERROR_DIVERGED,    /* the guard found a state that is not finite or out of bounds: see stf_world_fault */
    STF_RESULT_COUNT
} stf_result;

/* One English sentence about `result`, without a full stop. Never NULL; static storage. */
STF_API const char *stf_result_text(stf_result result);

/* The version of the library that is linked, "0.1.0"; that of these headers is STF_VERSION_MAJOR, _MINOR and _PATCH. */
STF_API const char *stf_version(void);

/*
 * Where a world gets its memory. `allocate` returns `size` bytes aligned to `alignment` (a power of two), or NULL;
 * `release` gets the same size back. Both get `user`. All zero means malloc and free. A world calls them only from create,
 * destroy, reserve, load, and functions that add particles or add, set or remove a force or set an integrator or a guard:
 * never in a step. stf_world_restore may release, and never allocates. A step of a world that is larger than the caches
 * takes up to a third less time on huge pages, which `allocate` can ask its system for (of malloc:
 * GLIBC_TUNABLES=glibc.malloc.hugetlb=1).
 */
typedef struct stf_allocator {
    void *(*allocate)(void *user, size_t size, size_t alignment);
    void (*release)(void *user, void *memory, size_t size);
    void *user;
} stf_allocator;

/*
 * The engine's threads. `run` calls task(context, index) once for every index below `tasks`, on any threads and in any order,
 * and returns when all are done. All zero: the caller's thread does all. The bits never depend on it, as long as all threads
 * have the same floating-point mode. Only stf_world_step calls it, from the thread that called that: once a call where no link
 * force acts; else for each acceleration, each round of a link in it, each loop of the integrator, and every
 * STF_SETTLE_TICKS ticks; and for the looks of a guard. What is too small to gain stays on the caller's thread: a world of
 * one block, and without links one of fewer than eight (some 2,000 particles in float, 1,000 in double). Rounds and looks
 * apart, an index has the same particles in every call: where it stays on one thread, it finds them in that core's cache. A
 * task wants some 16 KiB of stack.
 */
typedef struct stf_parallel {
    void (*run)(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context);
    unsigned tasks; /* into how many a step is split at most: as many as there are threads, or a few times that; to 1,024 */
    void *user;     /* outlives the world */
} stf_parallel;

#ifdef __cplusplus
}
#endif

#endif
