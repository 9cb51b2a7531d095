/*
 * The format of a saved world. Numbers are integers with the low byte first, reals their bits as such an integer; a string is
 * its length (4 bytes) and its characters. In this order, nothing between:
 *
 *     8  "STFWORLD"       4  version        8  bytes in all          4  bytes of a real
 *     4  dimensions       4  STF_SAVE_*     4  substeps              4  history arrays
 *     8  step, double     8  ticks          8  step_start_tick       8  step_start_time, double
 *     3 reals: gravity    string: the integrator's name
 *     4  last force id    8  forces         8  particles
 *     a force: string: name; 4 kind; 4 id; string: fields; 8 records; the records, packed
 *     an array of stf_world_kept: particle by particle, and of each all components
 *     4  CRC-32C of all before
 *
 * A NaN is saved as the one NaN below, as machines do not agree on its bits.
 */
#ifndef STEADFAST_SRC_FORMAT_H
#define STEADFAST_SRC_FORMAT_H

#include <string.h>

#include "world.h"

#define STF_SAVE_MAGIC "STFWORLD"
#define STF_SAVE_MAGIC_BYTES ((size_t)8)
#define STF_SAVE_VERSION 1
#define STF_SAVE_START_BYTES (STF_SAVE_MAGIC_BYTES + 4 + 8) /* magic, version, bytes in all */
#define STF_SAVE_CHECKSUM_BYTES ((size_t)4)

enum { STF_SAVE_PREVIOUS = 1 << 0, STF_SAVE_RADIUS = 1 << 1, STF_SAVE_STALE = 1 << 2, STF_SAVE_COMPENSATED = 1 << 3 };

static inline void stf_bytes_put(unsigned char *to, uint64_t number, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        to[i] = (unsigned char)(number >> (8 * i) & 0xff);
}

static inline uint64_t stf_bytes_get(const unsigned char *from, size_t bytes)
{
    uint64_t number = 0;

    for (size_t i = 0; i < bytes; i++)
        number |= (uint64_t)from[i] << (8 * i);
    return number;
}

#ifdef STF_DOUBLE
typedef uint64_t stf_real_bits;
#define STF_NAN_BITS UINT64_C(0x7ff8000000000000)
#else
typedef uint32_t stf_real_bits;
#define STF_NAN_BITS UINT32_C(0x7fc00000)
#endif

static inline stf_real_bits stf_bits_of_real(stf_real x)
{
    stf_real_bits bits;

    memcpy(&bits, &x, sizeof bits);
    return x == x ? bits : STF_NAN_BITS;
}

static inline stf_real stf_real_of_bits(uint64_t number)
{
    const stf_real_bits bits = (stf_real_bits)number;
    stf_real x;

    memcpy(&x, &bits, sizeof x);
    return x;
}

/* What is saved and loaded is what could have been given to stf_world_add. */
static inline stf_result stf_kept_check(const stf_kept *kept, stf_real x)
{
    switch (kept->rule) {
    case STF_KEPT_FINITE: return isfinite(x) ? STF_OK : STF_ERROR_NOT_FINITE;
    case STF_KEPT_INVERSE_MASS: return stf_is_inverse_mass(x) ? STF_OK : STF_ERROR_MASS;
    case STF_KEPT_RADIUS: return stf_is_coefficient(x) ? STF_OK : STF_ERROR_RADIUS;
    case STF_KEPT_ANYTHING: break;
    }
    return STF_OK;
}

/* What the file says of a force's records: no fields if it has none to save. */
static inline const char *stf_saved_fields(const stf_force *force)
{
    return force->record_size > 0 && force->fields ? force->fields : "";
}

static inline bool stf_saves_records(const stf_force *force) { return strcmp(stf_saved_fields(force), STF_NOT_SAVED) != 0; }

#endif
