/* reader: what load reads with. */
#ifndef STEADFAST_SRC_READER_H
#define STEADFAST_SRC_READER_H

#include "format.h"

/* Bytes of a buffer that nothing is known about; what is read behind their end is 0. */
typedef struct stf_reader {
    const unsigned char *at;
    size_t left;
    bool is_short; /* more was asked for than there was */
} stf_reader;

static inline const unsigned char *stf_get_bytes(stf_reader *r, uint64_t count)
{
    const unsigned char *at = r->at;

    if (count > r->left) {
        r->is_short = true;
        return NULL;
    }
    r->at += count;
    r->left -= (size_t)count;
    return at;
}

static inline uint64_t stf_get(stf_reader *r, size_t bytes)
{
    const unsigned char *at = stf_get_bytes(r, bytes);

    return at ? stf_bytes_get(at, bytes) : 0;
}

static inline uint32_t stf_get_word(stf_reader *r) { return (uint32_t)stf_get(r, 4); }
static inline stf_real stf_get_real(stf_reader *r) { return stf_real_of_bits(stf_get(r, sizeof(stf_real))); }

static inline double stf_get_double(stf_reader *r)
{
    const uint64_t bits = stf_get(r, sizeof bits);
    double x;

    memcpy(&x, &bits, sizeof x);
    return x;
}

typedef struct stf_string {
    const unsigned char *at;
    size_t length;
} stf_string;

static inline stf_string stf_get_string(stf_reader *r)
{
    const uint32_t length = stf_get_word(r);
    const unsigned char *at = stf_get_bytes(r, length);

    return (stf_string){.at = at, .length = at ? length : 0};
}

static inline bool stf_is_text(stf_string s, const char *text)
{
    return s.at && s.length == strlen(text) && memcmp(s.at, text, s.length) == 0;
}

#endif
