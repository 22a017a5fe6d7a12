/* host_clock.c - the host's clock, and how often the system interrupted this thread
 * (host_comm.h). */
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
static struct rusage own_usage(void)
{
    struct rusage u = {0};
    getrusage(RUSAGE_THREAD, &u);
    return u;
}

int64_t host_switches(void) { return own_usage().ru_nivcsw; }

int64_t host_faults(void)
{
    const struct rusage u = own_usage();
    return u.ru_minflt + u.ru_majflt;
}

int64_t host_interruptions(void)
{
    const struct rusage u = own_usage();
    return u.ru_nivcsw + u.ru_minflt + u.ru_majflt;
}
