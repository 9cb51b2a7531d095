/* A pool of one thread beside the caller's, for stf_world_def.parallel: what an engine has already. POSIX threads. */
#define _POSIX_C_SOURCE 200809L
#include "threads.h"

#include <pthread.h>
#include <unistd.h>

#include "measure.h"

#define THREADS 2
#define TASKS (2 * THREADS) /* some to spare, for the thread that is through first */
#define POLLS 100000        /* some tens of us: longer than what a game does between two calls, else the thread sleeps */

static struct {
    pthread_mutex_t lock;
    pthread_cond_t more;
    void (*task)(void *context, unsigned index);
    void *context;
    volatile unsigned tasks, next, done; /* written under the lock; read without it only to see whether to take it */
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .more = PTHREAD_COND_INITIALIZER};

/* Takes tasks until none is left. Called and left with the lock held. */
static void take_tasks(void)
{
    while (pool.next < pool.tasks) {
        const unsigned index = pool.next++;

        pthread_mutex_unlock(&pool.lock);
        pool.task(pool.context, index);
        pthread_mutex_lock(&pool.lock);
        pool.done++;
    }
}

static void *work(void *unused)
{
    (void)unused;
    pthread_mutex_lock(&pool.lock);
    for (;;) {
        take_tasks();
        pthread_mutex_unlock(&pool.lock);
        for (unsigned polls = 0; pool.next >= pool.tasks && polls < POLLS; polls++)
            continue;
        pthread_mutex_lock(&pool.lock);
        while (pool.next >= pool.tasks)
            pthread_cond_wait(&pool.more, &pool.lock);
    }
    return NULL;
}

static void run(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    pthread_mutex_lock(&pool.lock);
    pool.task = task, pool.context = context;
    pool.next = 0, pool.done = 0, pool.tasks = tasks;
    pthread_cond_signal(&pool.more);
    take_tasks();
    while (pool.done < tasks) {
        pthread_mutex_unlock(&pool.lock);
        while (pool.done < tasks)
            continue;
        pthread_mutex_lock(&pool.lock);
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
