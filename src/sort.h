/* Sorting in place: qsort may allocate behind the engine's allocator, and may leave equals in any order. */
#ifndef STEADFAST_SRC_SORT_H
#define STEADFAST_SRC_SORT_H

#include <stddef.h>

/* The largest record that can be sorted. */
#define STF_SORT_BYTES_MAX 64

/* As qsort. Cost: one pass where all but a few are in order, else n log n. */
void stf_sort(void *records, size_t count, size_t size, int (*compare)(const void *a, const void *b));

#endif
