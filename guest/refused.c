/* refused.c - what a program on the simulator cannot do, each by its name: it ends the run with
 * rank and place.
 *
 * All ranks are one process, which is not theirs to copy, replace or stop, and a simulated machine
 * has no other network than the simulated one. No headers: their declarations differ, and these
 * functions never return. */
#include <stddef.h>

#include "guest.h"

#define REFUSE(name, why)                                                                          \
    WEAK int name(void);                                                                           \
    int name(void) { guest_refuse(HERE, #name, why); }

static const char processes[] = "the ranks are not processes of their own";
static const char threads[] = "a virtual processor has one thread";
static const char network[] = "the only network is the simulated one";
static const char timers[] = "time is simulated, and signals do not come";
static const char callbacks[] =
    "the C library would call the program back, which is not supported for this function";

REFUSE(fork, processes)
REFUSE(_Fork, processes)
REFUSE(vfork, processes)
REFUSE(clone, processes)
REFUSE(execl, processes)
REFUSE(execle, processes)
REFUSE(execlp, processes)
REFUSE(execv, processes)
REFUSE(execve, processes)
REFUSE(execvp, processes)
REFUSE(execvpe, processes)
REFUSE(fexecve, processes)
REFUSE(posix_spawn, processes)
REFUSE(posix_spawnp, processes)
REFUSE(system, processes)
REFUSE(popen, processes)
REFUSE(daemon, processes)
REFUSE(wait, processes)
REFUSE(waitpid, processes)
REFUSE(kill, processes)
REFUSE(chdir, "the working directory belongs to all ranks")
REFUSE(fchdir, "the working directory belongs to all ranks")
REFUSE(chroot, processes)
REFUSE(setrlimit, processes)
REFUSE(dlopen, "link what the program needs with `mimdsim cc`")
REFUSE(dlmopen, "link what the program needs with `mimdsim cc`")

REFUSE(pthread_create, threads)
REFUSE(thrd_create, threads)

REFUSE(socket, network)
REFUSE(socketpair, network)
REFUSE(shm_open, network)
REFUSE(shmget, network)
REFUSE(sem_open, network)
REFUSE(msgget, network)
REFUSE(mq_open, network)

REFUSE(alarm, timers)
REFUSE(ualarm, timers)
REFUSE(setitimer, timers)
REFUSE(timer_create, timers)
REFUSE(pause, timers)
REFUSE(sigsuspend, timers)
REFUSE(sigwait, timers)

REFUSE(tsearch, callbacks)
REFUSE(tfind, callbacks)
REFUSE(tdelete, callbacks)
REFUSE(twalk, callbacks)
REFUSE(ftw, callbacks)
REFUSE(nftw, callbacks)
REFUSE(scandir, callbacks)
REFUSE(argp_parse, callbacks)
