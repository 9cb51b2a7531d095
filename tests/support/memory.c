#include "support/memory.h"

#include <stdlib.h>
#include <string.h>

#include "support/check.h"

#define GARBAGE 0x41 /* as a float 12.08: neither 0 nor a NaN */

static void *allocate(void *user, size_t size, size_t alignment)
{
    counting *c = user;

    assert_int_equal(alignment, 64);
    if (++c->calls == c->fail_at || (c->most > 0 && size > c->most))
        return NULL;

    unsigned char *taken = malloc(size + 2 * alignment);
    assert_non_null(taken);
    unsigned char *aligned = taken + 2 * alignment - (uintptr_t)taken % alignment;
    memcpy(aligned - sizeof taken, &taken, sizeof taken);
    memset(aligned, GARBAGE, size);
    c->blocks++;
    c->bytes += size;
    return aligned;
}

static void release(void *user, void *memory, size_t size)
{
    counting *c = user;
    unsigned char *taken;

    assert_non_null(memory);
    memcpy(&taken, (unsigned char *)memory - sizeof taken, sizeof taken);
    free(taken);
    c->blocks--;
    c->bytes -= size;
}

stf_allocator counting_allocator(counting *c)
{
    return (stf_allocator){.allocate = allocate, .release = release, .user = c};
}
