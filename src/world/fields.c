#include <string.h>

#include "format.h"

/* Bytes of a number, 0 for a letter that means none. */
static size_t size_of(char letter)
{
    switch (letter) {
    case '1': return 1;
    case '2': return 2;
    case '4': return 4;
    case '8': return 8;
    case 'r': return sizeof(stf_real);
    default: return 0;
    }
}

/* Where a number of 8 bytes may start in a struct is not the same on all machines. */
typedef struct aligned {
    char before;
    uint64_t number;
} aligned;

static size_t alignment_of(size_t size) { return size == 8 ? offsetof(aligned, number) : size; }

/* Of letters that mean a number: the others have been refused. NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
static size_t round_up(size_t at, size_t alignment) { return (at + alignment - 1) / alignment * alignment; }

size_t stf_fields_size(const char *fields)
{
    size_t end = 0, widest = 1;

    for (; *fields; fields++) {
        const size_t size = size_of(*fields), alignment = alignment_of(size);
        if (size == 0)
            return 0;
        end = round_up(end, alignment) + size;
        widest = alignment > widest ? alignment : widest;
    }
    return round_up(end, widest);
}

size_t stf_fields_packed_size(const char *fields)
{
    size_t sum = 0;

    for (; *fields; fields++)
        sum += size_of(*fields);
    return sum;
}

/* A number in this machine's order of bytes. */
static uint64_t load(const void *from, size_t size)
{
    uint8_t one;
    uint16_t two;
    uint32_t four;
    uint64_t eight;

    switch (size) {
    case 1: return memcpy(&one, from, size), one;
    case 2: return memcpy(&two, from, size), two;
    case 4: return memcpy(&four, from, size), four;
    default: return memcpy(&eight, from, sizeof eight), eight;
    }
}

static void store(void *to, uint64_t number, size_t size)
{
    const uint8_t one = (uint8_t)number;
    const uint16_t two = (uint16_t)number;
    const uint32_t four = (uint32_t)number;

    switch (size) {
    case 1: memcpy(to, &one, size); break;
    case 2: memcpy(to, &two, size); break;
    case 4: memcpy(to, &four, size); break;
    default: memcpy(to, &number, sizeof number);
    }
}

void stf_fields_pack(const char *fields, const void *record, unsigned char *packed)
{
    for (size_t at = 0, size; *fields; fields++, at += size, packed += size) {
        size = size_of(*fields);
        at = round_up(at, alignment_of(size));
        stf_bytes_put(packed, load((const char *)record + at, size), size);
    }
}

void stf_fields_unpack(const char *fields, const unsigned char *packed, void *record)
{
    for (size_t at = 0, size; *fields; fields++, at += size, packed += size) {
        size = size_of(*fields);
        at = round_up(at, alignment_of(size));
        store((char *)record + at, stf_bytes_get(packed, size), size);
    }
}
