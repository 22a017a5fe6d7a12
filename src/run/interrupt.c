/* interrupt.c - see interrupt.h.
 *
 * A thread may print, a signal handler may not; and a handler would need a global variable. What
 * was committed is whole whenever the process ends (store.c). The thread is ended by a signal of
 * its own: to cancel it would load the library that unwinds stacks, which takes as long as a small
 * run.
 *
 * Of a single run there is nothing to be counted, and the sentence is a constant: a handler writes
 * it. A thread would take a thirtieth of a small run, and more where it waits for a processor. */
#include "run/interrupt.h"

#include <errno.h>
#include <stdio.h>
#include <unistd.h>

#include "base/whole.h"

/* What interrupt_end sends to the thread alone. */
enum { ENOUGH = SIGUSR2 };

static const int interrupts[INTERRUPTS] = {SIGINT, SIGTERM};

/* The signals of a terminal and of kill, but for those that are ignored: a signal that is blocked
 * reaches whoever waits for it, ignored or not. */
static void fill(sigset_t *set)
{
    sigemptyset(set);
    for (int i = 0; i < INTERRUPTS; i++) {
        struct sigaction now;
        if (sigaction(interrupts[i], NULL, &now) == 0 && now.sa_handler != SIG_IGN)
            sigaddset(set, interrupts[i]);
    }
}

#define GOES_ON                                                                                    \
    "\nmimdsim: interrupted: what is stored stays, and the same command goes on from there"

static void say(struct interrupt *x)
{
    if (x->database == NULL) fprintf(stderr, GOES_ON "\n");
    else
        fprintf(stderr, GOES_ON " (%d of %d runs were made, into %s)\n", atomic_load(&x->stored),
                x->todo, x->database);
}

/* The signal is blocked until this returns, and then does what it does by itself. */
static void say_in_handler(int number)
{
    static const char line[] = GOES_ON "\n";
    write_whole(STDERR_FILENO, line, sizeof line - 1); /* whether or not there is a reader */
    signal(number, SIG_DFL);
    raise(number);
}

/* Whether the handler waits for one of these. */
static bool is_handled(const sigset_t *set)
{
    bool handled = false;
    for (int i = 0; i < INTERRUPTS; i++) {
        struct sigaction now;
        handled = handled || (sigismember(set, interrupts[i]) &&
                              sigaction(interrupts[i], NULL, &now) == 0 &&
                              now.sa_handler == say_in_handler);
    }
    return handled;
}

/* Waits, says, and lets the signal do what it does by itself: shells look at how a process ended.
 */
static void *wait_for_signal(void *context)
{
    struct interrupt *x = context;
    sigset_t set = x->wanted;
    int number = 0;
    sigaddset(&set, ENOUGH);
    sem_post(&x->waits);
    /* A signal of the user that waits, too, has a lower number and is the first one. */
    if (sigwait(&set, &number) != 0 || number == ENOUGH) return NULL;
    say(x);
    signal(number, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &x->wanted, NULL);
    raise(number);
    return NULL;
}

/* Blocked in this thread and all that it makes, processes included: a worker that died of the same
 * Ctrl-C would be stored as a failed run. */
void interrupt_begin(struct interrupt *x, const char *database, int todo)
{
    sigset_t enough, all;
    *x = (struct interrupt){.database = database, .todo = todo};
    fill(&x->wanted);
    /* Blocked by then: somebody waits for it already. */
    pthread_sigmask(SIG_SETMASK, NULL, &x->before);
    const bool waited = sigismember(&x->before, SIGINT) || sigismember(&x->before, SIGTERM) ||
                        is_handled(&x->wanted);
    if (todo == 0 || waited) return;
    sigemptyset(&enough);
    sigaddset(&enough, ENOUGH);
    sigorset(&all, &x->wanted, &enough);
    if (pthread_sigmask(SIG_BLOCK, &all, &x->before) != 0) return;
    sem_init(&x->waits, 0, 0);
    x->on = pthread_create(&x->thread, NULL, wait_for_signal, x) == 0;
    /* A thread takes memory when it begins. Were a worker forked meanwhile, the lock of an
     * allocator that does not mind forks, as the address sanitizer's, would be held in it for ever.
     */
    while (x->on && sem_wait(&x->waits) != 0 && errno == EINTR) continue;
    /* The thread has begun with all of them blocked; here the one that ends it acts as before. The
     * others stay blocked without a break: one that waits already is the thread's. */
    if (x->on && !sigismember(&x->before, ENOUGH)) pthread_sigmask(SIG_UNBLOCK, &enough, NULL);
    if (!x->on) pthread_sigmask(SIG_SETMASK, &x->before, NULL);
}

/* On a stack of its own where the thread has one: that of a virtual processor may be full. */
void interrupt_begin_single(struct interrupt *x)
{
    struct sigaction say_it = {.sa_handler = say_in_handler, .sa_flags = SA_ONSTACK | SA_RESTART};
    *x = (struct interrupt){.todo = 1};
    fill(&x->wanted);
    if (is_handled(&x->wanted)) return;
    x->handled = true;
    for (int i = 0; i < INTERRUPTS; i++)
        if (sigismember(&x->wanted, interrupts[i]))
            sigaction(interrupts[i], &say_it, &x->action[i]);
}

void interrupt_end(struct interrupt *x)
{
    for (int i = 0; x->handled && i < INTERRUPTS; i++)
        if (sigismember(&x->wanted, interrupts[i])) sigaction(interrupts[i], &x->action[i], NULL);
    x->handled = false;
    if (!x->on) return;
    pthread_kill(x->thread, ENOUGH);
    pthread_join(x->thread, NULL);
    sem_destroy(&x->waits);
    pthread_sigmask(SIG_SETMASK, &x->before, NULL);
    x->on = false;
}
