#ifndef STEADFAST_SRC_CHECKSUM_H
#define STEADFAST_SRC_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

/*
 * CRC-32C of bytes[count]: finds every error within 32 bits in a row. G. Castagnoli, S. Bräuer, M. Herrmann, IEEE Trans.
 * Commun. 41, 883 (1993); as RFC 3720 uses it, where "123456789" gives 0xe3069283.
 */
uint32_t stf_checksum(const void *bytes, size_t count);

#endif
