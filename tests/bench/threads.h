/* threads: two, for worlds that step on both. */
#ifndef STEADFAST_TESTS_BENCH_THREADS_H
#define STEADFAST_TESTS_BENCH_THREADS_H

#include "steadfast/base.h"

/* Starts the second thread once; all zero where there is no second core or thread. */
stf_parallel bench_threads(void);

#endif
