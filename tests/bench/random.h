/* random: numbers that are made from indices alone, so that every form of a scene gets the same. */
#ifndef STEADFAST_TESTS_BENCH_RANDOM_H
#define STEADFAST_TESTS_BENCH_RANDOM_H

#include <stddef.h>
#include <stdint.h>

/* In [0, 1), 24 bits: for item i, its number `which`, below 16. Steele, Lea, Flood, OOPSLA 2014 (splitmix64). */
static inline double random_of(size_t i, unsigned which)
{
    uint64_t z = ((uint64_t)i * 16 + which + 1) * UINT64_C(0x9e3779b97f4a7c15);

    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (double)((z ^ (z >> 31)) >> 40) / 16777216.0;
}

#endif
