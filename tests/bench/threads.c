/* A pool of one thread beside the caller's, for stf_world_def.parallel: what an engine has already. POSIX threads. */
#define _POSIX_C_SOURCE 200809L
#ifdef __APPLE__
#define _DARWIN_C_SOURCE /* there _SC_NPROCESSORS_ONLN is beyond POSIX */
#endif
#include "threads.h"

#include <pthread.h>
#include <unistd.h>

#include "measure.h"

#define THREADS 2
#define TASKS THREADS
#define POLLS 100000        /* some tens of us: longer than what a game does between two calls, else the thread sleeps */

static struct {
    pthread_mutex_t lock;
    pthread_cond_t more;
    void (*task)(void *context, unsigned index);
    void *context;
    /* Written under the lock, and read without it only to see whether to take it. */
    volatile unsigned next, end; /* tasks that nobody has taken */
    volatile unsigned running;   /* tasks that are not done */
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .more = PTHREAD_COND_INITIALIZER};

/* A thread that sleeps for a lock wakes up microseconds after it is free. */
static void take_lock(void)
{
    while (pthread_mutex_trylock(&pool.lock) != 0)
        continue;
}

/* Takes tasks until none is left, each thread from its own end, so that it has the same ones at each call, in its own cache.
   Called and left with the lock held. */
static void take_tasks(bool from_front)
{
    while (pool.next < pool.end) {
        const unsigned index = from_front ? pool.next++ : --pool.end;

        pthread_mutex_unlock(&pool.lock);
        pool.task(pool.context, index);
        take_lock();
        pool.running--;
    }
}

static void *work(void *unused)
{
    (void)unused;
    take_lock();
    for (;;) {
        take_tasks(false);
        pthread_mutex_unlock(&pool.lock);
        for (unsigned polls = 0; pool.next >= pool.end && polls < POLLS; polls++)
            continue;
        take_lock();
        while (pool.next >= pool.end)
            pthread_cond_wait(&pool.more, &pool.lock);
    }
    return NULL;
}

static void run(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    take_lock();
    pool.task = task, pool.context = context;
    pool.next = 0, pool.end = pool.running = tasks;
    pthread_cond_signal(&pool.more);
    take_tasks(true);
    while (pool.running > 0) {
        pthread_mutex_unlock(&pool.lock);
        while (pool.running > 0)
            continue;
        take_lock();
    }
    pthread_mutex_unlock(&pool.lock);
}

stf_parallel bench_threads(void)
{
    static bool started;
    pthread_t thread;

    if (!started && sysconf(_SC_NPROCESSORS_ONLN) >= THREADS) {
        const bool was_pinned = measure_unpin(); /* a thread may run where the one that starts it may */
        started = pthread_create(&thread, NULL, work, NULL) == 0;
        if (was_pinned)
            measure_pin();
    }
    return started ? (stf_parallel){.run = run, .tasks = TASKS} : (stf_parallel){0};
}
