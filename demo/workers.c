#include "workers.h"

#include <SDL.h>
#include <stdlib.h>

struct workers {
    SDL_Thread *threads[WORKERS_MAX];
    unsigned thread_count; /* beside the caller's */
    SDL_mutex *mutex; /* of all that is not atomic, and of the two conditions */
    SDL_cond *work_came, *work_done;
    void (*task)(void *context, unsigned index);
    void *context;
    unsigned tasks;
    bool stop;
    SDL_atomic_t round; /* counts calls of run */
    SDL_atomic_t busy;  /* threads that have not finished this round */
    SDL_atomic_t numbers; /* threads that have asked for theirs; the caller has 0 */
    SDL_atomic_t taken[WORKERS_MAX + 1]; /* tasks of this round: 1 when a thread has it */
};

/* A thread that sleeps takes longer to wake than most steps to run, so both sides look again and again before they sleep. */
#define LOOKS 20000

#ifndef SDL_CPUPauseInstruction
#define SDL_CPUPauseInstruction() ((void)0)
#endif

static void look_for_change(SDL_atomic_t *number, int from)
{
    for (int i = 0; i < LOOKS && SDL_AtomicGet(number) == from; i++)
        SDL_CPUPauseInstruction();
}

/* First the task of its own number, the same at each call, so that its particles stay in the cache of one core; then what the
   others have not come to yet. */
static void take_tasks(workers *w, unsigned number)
{
    for (unsigned i = 0; i < w->tasks; i++) {
        const unsigned task = (number + i) % w->tasks;

        if (SDL_AtomicCAS(&w->taken[task], 0, 1))
            w->task(w->context, task);
    }
}

static int work(void *user)
{
    workers *w = user;
    const unsigned number = (unsigned)SDL_AtomicAdd(&w->numbers, 1) + 1;

    for (int seen = 0;;) {
        look_for_change(&w->round, seen);
        SDL_LockMutex(w->mutex);
        while (SDL_AtomicGet(&w->round) == seen && !w->stop)
            SDL_CondWait(w->work_came, w->mutex);
        const bool stop = w->stop;
        seen = SDL_AtomicGet(&w->round);
        SDL_UnlockMutex(w->mutex);
        if (stop)
            return 0;
        take_tasks(w, number);
        if (SDL_AtomicAdd(&w->busy, -1) == 1) {
            SDL_LockMutex(w->mutex); /* or the caller may miss it between its last look and its sleep */
            SDL_CondSignal(w->work_done);
            SDL_UnlockMutex(w->mutex);
        }
    }
}

static void run(void *user, unsigned tasks, void (*task)(void *context, unsigned index), void *context)
{
    workers *w = user;

    w->task = task;
    w->context = context;
    w->tasks = tasks;
    SDL_AtomicSet(&w->busy, (int)w->thread_count);
    for (unsigned i = 0; i < tasks; i++)
        SDL_AtomicSet(&w->taken[i], 0);
    SDL_LockMutex(w->mutex);
    SDL_AtomicAdd(&w->round, 1);
    SDL_CondBroadcast(w->work_came);
    SDL_UnlockMutex(w->mutex);
    take_tasks(w, 0);
    for (int i = 0; i < LOOKS && SDL_AtomicGet(&w->busy) > 0; i++)
        SDL_CPUPauseInstruction();
    SDL_LockMutex(w->mutex);
    while (SDL_AtomicGet(&w->busy) > 0)
        SDL_CondWait(w->work_done, w->mutex);
    SDL_UnlockMutex(w->mutex);
}

workers *workers_start(unsigned threads)
{
    workers *w = calloc(1, sizeof *w);

    if (!w)
        return NULL;
    w->mutex = SDL_CreateMutex();
    w->work_came = SDL_CreateCond();
    w->work_done = SDL_CreateCond();
    bool made = w->mutex && w->work_came && w->work_done;
    while (made && w->thread_count + 1 < threads && w->thread_count < WORKERS_MAX) {
        w->threads[w->thread_count] = SDL_CreateThread(work, "physics", w);
        made = w->threads[w->thread_count] != NULL;
        w->thread_count += made;
    }
    if (made)
        return w;
    workers_stop(w);
    return NULL;
}

void workers_stop(workers *w)
{
    if (!w)
        return;
    if (w->mutex) {
        SDL_LockMutex(w->mutex);
        w->stop = true;
        SDL_CondBroadcast(w->work_came);
        SDL_UnlockMutex(w->mutex);
    }
    for (unsigned i = 0; i < w->thread_count; i++)
        SDL_WaitThread(w->threads[i], NULL);
    SDL_DestroyCond(w->work_came);
    SDL_DestroyCond(w->work_done);
    SDL_DestroyMutex(w->mutex);
    free(w);
}

stf_parallel workers_parallel(workers *w)
{
    return w ? (stf_parallel){.run = run, .tasks = w->thread_count + 1, .user = w} : (stf_parallel){.tasks = 0};
}
