#define _POSIX_C_SOURCE 200809L
#include "pool.h"

#include <pthread.h>

#include "bench/random.h"
#include "cell.h"

#define PARTS_MAX 1024

static struct {
    pthread_mutex_t lock;
    pthread_cond_t more, all_done;
    void (*task)(void *context, unsigned index);
    void *context;
    unsigned tasks, next, done;
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .more = PTHREAD_COND_INITIALIZER, .all_done = PTHREAD_COND_INITIALIZER};

/* Takes tasks until none is left. Called and left with the lock held. */
static void take_tasks(void)
{
    while (pool.next < pool.tasks) {
        const unsigned index = pool.next++;

        pthread_mutex_unlock(&pool.lock);
        pool.task(pool.context, index);
        pthread_mutex_lock(&pool.lock);
        if (++pool.done == pool.tasks)
            pthread_cond_signal(&pool.all_done);
    }
}

static void *work(void *unused)
{
    (void)unused;
    pthread_mutex_lock(&pool.lock);
    for (;;) {
        take_tasks();
        pthread_cond_wait(&pool.more, &pool.lock);
    }
    return NULL;
}

static void run_on_threads(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    (void)user;
    pthread_mutex_lock(&pool.lock);
    pool.task = task, pool.context = context;
    pool.next = 0, pool.done = 0, pool.tasks = tasks;
    pthread_cond_broadcast(&pool.more);
    take_tasks();
    while (pool.done < tasks)
        pthread_cond_wait(&pool.all_done, &pool.lock);
    pthread_mutex_unlock(&pool.lock);
}

stf_parallel pool_threads(unsigned threads)
{
    pthread_t thread;

    for (unsigned i = 1; i < threads; i++)
        if (pthread_create(&thread, NULL, work, NULL) != 0)
            fail("threads", "they can't be started");
    return (stf_parallel){.run = run_on_threads, .tasks = threads};
}

/* Fisher and Yates (1938), as R. Durstenfeld, Commun. ACM 7, 420 (1964), has it. */
static void run_shuffled(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    unsigned order[PARTS_MAX];
    size_t *calls = user;

    (*calls)++;
    for (unsigned i = 0; i < tasks; i++) {
        const unsigned other = (unsigned)(random_of(*calls * PARTS_MAX + i, 0) * (i + 1));

        order[i] = order[other];
        order[other] = i;
    }
    for (unsigned i = 0; i < tasks; i++)
        task(context, order[i]);
}

stf_parallel pool_shuffled(void)
{
    static size_t calls;

    return (stf_parallel){.run = run_shuffled, .tasks = PARTS_MAX, .user = &calls};
}
