/* identity.c - who a rank is among processes: made-up numbers and names, equal in every run;
 * signals that never come. */
#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "guest.h"

enum { FIRST_PID = 1000 };

LIBC(uname);

WEAK pid_t getpid(void) { return FIRST_PID + mimdsim_host->rank; }
WEAK pid_t gettid(void) { return getpid(); }
WEAK pid_t getppid(void) { return 1; }
WEAK pid_t getpgrp(void) { return FIRST_PID; }
WEAK long gethostid(void) { return mimdsim_host->rank; }
WEAK int sched_getcpu(void) { return 0; }
WEAK int sched_yield(void) { return 0; }

WEAK int gethostname(char *name, size_t n)
{
    int length = snprintf(name, n, "rank%d", mimdsim_host->rank);
    if (length >= 0 && (size_t)length < n) return 0;
    errno = ENAMETOOLONG;
    return -1;
}

WEAK int uname(struct utsname *u)
{
    int result = mimdsim_libc_uname(u);
    snprintf(u->nodename, sizeof u->nodename, "rank%d", mimdsim_host->rank);
    return result;
}

/* Handlers are accepted and never called: crashes are the simulator's to report, and nobody sends
 * signals. */
WEAK __sighandler_t signal(int number, __sighandler_t handler)
{
    (void)number, (void)handler;
    return SIG_DFL;
}

WEAK int sigaction(int number, const struct sigaction *restrict action,
                   struct sigaction *restrict before)
{
    (void)number, (void)action;
    if (before) memset(before, 0, sizeof *before);
    return 0;
}

WEAK int sigprocmask(int how, const sigset_t *restrict set, sigset_t *restrict before)
{
    (void)how, (void)set;
    if (before) sigemptyset(before);
    return 0;
}
WEAK int pthread_sigmask(int how, const sigset_t *restrict set, sigset_t *restrict before)
{
    return sigprocmask(how, set, before);
}
WEAK int sigaltstack(const stack_t *restrict s, stack_t *restrict before)
{
    (void)s;
    if (before) *before = (stack_t){.ss_flags = SS_DISABLE};
    return 0;
}
