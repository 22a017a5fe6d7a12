/* interrupt.h - Ctrl-C during a campaign: what is stored, and how to go on. */
#ifndef RUN_INTERRUPT_H
#define RUN_INTERRUPT_H

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

enum { INTERRUPTS = 2 }; /* SIGINT and SIGTERM */

/* A thread that waits for SIGINT and SIGTERM while the process works; workers that are forked
 * meanwhile leave these signals to it. Or, of a single run, a handler of them. */
struct interrupt {
    const char *database; /* NULL: not known here */
    int todo;             /* runs that are to be made */
    atomic_int stored;    /* those of them that are stored */
    bool on;
    pthread_t thread;
    sem_t waits;     /* posted by the thread, which takes no memory from then on */
    sigset_t wanted; /* signals that it waits for */
    sigset_t before; /* signals that were blocked */
    bool handled;    /* by a handler */
    struct sigaction action[INTERRUPTS]; /* what was to be done of them */
};

/* interrupt_begin: from now on such a signal ends the process with a line on stderr, after which
 * the process ends by that signal as it would have. Signals that are ignored, as in the background
 * of a script, stay so. Where there is no thread to be had, the process ends without the line.
 * Nothing happens where nothing is to be done, and where one has begun already: whoever began
 * first knows most. */
void interrupt_begin(struct interrupt *x, const char *database, int todo);

/* interrupt_begin_single: the same for one run that this process makes itself, without workers: the
 * line does not tell how many of them were made. */
void interrupt_begin_single(struct interrupt *x);

/* interrupt_end: signals act as before. */
void interrupt_end(struct interrupt *x);

#endif
