#include "checksum.h"

/* The polynomial's powers from the highest, without x^32, low bit first. */
#define POLYNOMIAL UINT32_C(0x82f63b78)

#define BYTES 256

uint32_t stf_checksum(const void *bytes, size_t count)
{
    const unsigned char *at = bytes;
    uint32_t table[BYTES], sum = UINT32_MAX;

    for (uint32_t byte = 0; byte < BYTES; byte++) {
        table[byte] = byte;
        for (int bit = 0; bit < 8; bit++)
            table[byte] = table[byte] >> 1 ^ (table[byte] & 1 ? POLYNOMIAL : 0);
    }
    for (size_t i = 0; i < count; i++)
        sum = sum >> 8 ^ table[(sum ^ at[i]) & (BYTES - 1)];
    return ~sum;
}
