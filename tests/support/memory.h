/* An allocator for tests: counts what is out, hands out memory full of garbage, and fails on demand. */
#ifndef STEADFAST_TESTS_MEMORY_H
#define STEADFAST_TESTS_MEMORY_H

#include "steadfast/base.h"

typedef struct counting {
    size_t blocks, bytes; /* out now */
    size_t calls;         /* of allocate, so far */
    size_t fail_at;       /* this call returns NULL; 0: none */
    size_t most;          /* calls for more bytes return NULL; 0: none */
} counting;

stf_allocator counting_allocator(counting *c);

#endif
