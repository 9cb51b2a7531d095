#include "world.h"

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

/* A number, of which a buffer has the low byte first and a record what the machine has first. The same both ways. */
static void copy_number(void *to, const void *from, size_t size)
{
    const uint16_t one = 1;
    const bool is_low_first = *(const unsigned char *)&one == 1;

    for (size_t i = 0; i < size; i++)
        ((unsigned char *)to)[i] = ((const unsigned char *)from)[is_low_first ? i : size - 1 - i];
}

void stf_fields_pack(const char *fields, const void *record, unsigned char *packed)
{
    for (size_t at = 0, size; *fields; fields++, at += size, packed += size) {
        size = size_of(*fields);
        at = round_up(at, alignment_of(size));
        copy_number(packed, (const char *)record + at, size);
    }
}

void stf_fields_unpack(const char *fields, const unsigned char *packed, void *record)
{
    for (size_t at = 0, size; *fields; fields++, at += size, packed += size) {
        size = size_of(*fields);
        at = round_up(at, alignment_of(size));
        copy_number((char *)record + at, packed, size);
    }
}
