/* The allocator that a def gives, or malloc and free. */
#ifndef STEADFAST_SRC_ALLOCATOR_H
#define STEADFAST_SRC_ALLOCATOR_H

#include "steadfast/base.h"

/* Every array of a world starts on a cache line, which is also the widest vector. */
#define STF_ALIGNMENT 64

/* `given` with both functions, or the default where it has neither. false: it has only one. */
bool stf_allocator_complete(stf_allocator given, stf_allocator *complete);

void *stf_allocator_allocate(const stf_allocator *allocator, size_t size);
void stf_allocator_release(const stf_allocator *allocator, void *memory, size_t size);

#endif
