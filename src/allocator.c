#include "allocator.h"

#include <stdlib.h>

/* C99 has no aligned malloc: take more, and keep what malloc gave just below what is handed out. */
static void *default_allocate(void *user, size_t size, size_t alignment)
{
    const size_t extra = alignment + sizeof(void *);
    (void)user;

    if (size > SIZE_MAX - extra)
        return NULL;

    void *taken = malloc(size + extra);
    if (!taken)
        return NULL;

    char *lowest = (char *)taken + sizeof(void *);
    void **handed_out = (void **)(void *)(lowest + (-(uintptr_t)lowest & (alignment - 1)));

    handed_out[-1] = taken;
    return handed_out;
}

static void default_release(void *user, void *memory, size_t size)
{
    (void)user, (void)size;

    if (memory)
        free(((void **)memory)[-1]);
}

bool stf_allocator_complete(stf_allocator given, stf_allocator *complete)
{
    if (!given.allocate && !given.release) {
        given.allocate = default_allocate;
        given.release = default_release;
    }
    *complete = given;
    return given.allocate && given.release;
}

void *stf_allocator_allocate(const stf_allocator *allocator, size_t size)
{
    return allocator->allocate(allocator->user, size, STF_ALIGNMENT);
}

void stf_allocator_release(const stf_allocator *allocator, void *memory, size_t size)
{
    if (memory)
        allocator->release(allocator->user, memory, size);
}
