/* interrupt.h - Ctrl-C during a campaign: what is stored, and how to go on. */
#ifndef APP_INTERRUPT_H
#define APP_INTERRUPT_H

#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

/* A thread that waits for SIGINT and SIGTERM while the process works; workers that are forked
 * meanwhile leave these signals to it. */
struct interrupt {
    const char *database;
    int todo;          /* runs that are to be made */
    atomic_int stored; /* those of them that are stored */
    bool on;
    pthread_t thread;
    sem_t waits;     /* posted by the thread, which takes no memory from then on */
    sigset_t before; /* signals that were blocked */
};

/* interrupt_begin: from now on such a signal ends the process with a line on stderr, after which
 * the process ends by that signal as it would have. Where there is no thread to be had, it does so
 * without the line. */
void interrupt_begin(struct interrupt *x, const char *database, int todo);

/* interrupt_end: signals act as before. */
void interrupt_end(struct interrupt *x);

#endif
