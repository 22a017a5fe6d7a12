/* host_clock.c - the host's clock, and how often the host took the processor away (host_comm.h). */
#include <sys/resource.h>
#include <time.h>

#include "host/host_comm.h"

/* Monotonic: steps of the wall clock would be measured as computing. */
int64_t host_clock_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

/* Of this thread: MPI has threads of its own, which sleep and wake. */
int64_t host_switches(void)
{
    struct rusage u;
    return getrusage(RUSAGE_THREAD, &u) == 0 ? u.ru_nivcsw : 0;
}
