/* clocks.c - the time of day, clocks and sleeping: all of them are the rank's simulated clock.
 *
 * Simulated time begins on 1 January 2000, 0:00 UTC. Looking at a clock takes 20 ns, about what it
 * takes on today's hosts, so that a program that waits by looking at the clock goes on. */
#include <errno.h>
#include <poll.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/time.h>
#include <sys/timeb.h>
#include <sys/times.h>
#include <time.h>
#include <unistd.h>

#include "guest.h"

LIBC(poll);
LIBC(select);

static const int64_t EPOCH_S = 946684800;    /* [s] from 1970 to 2000 */
static const int64_t SECOND = 1000000000000; /* [ps] */
static const int64_t LOOK = 20000;           /* [ps] */

static int64_t now_ps(void)
{
    mimdsim_account();
    mimdsim_host->runtime->elapse_ps(mimdsim_host, LOOK);
    return mimdsim_host->runtime->now_ps(mimdsim_host);
}

/* sleep_for: idle for that long; a time out of range is as long as there is. */
static void sleep_for(int64_t s, int64_t ns)
{
    const int64_t most = INT64_MAX / SECOND / 2;
    mimdsim_account();
    mimdsim_host->runtime->sleep_ps(mimdsim_host, (s > most ? most : s) * SECOND + ns * 1000);
}

static struct timespec spec_of(int64_t ps, int64_t epoch)
{
    return (struct timespec){.tv_sec = epoch + ps / SECOND, .tv_nsec = ps % SECOND / 1000};
}

/* Clocks count from different beginnings: those of the day from EPOCH_S, the others from the start
 * of the run. */
WEAK int clock_gettime(clockid_t id, struct timespec *t)
{
    const int of_day = id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE || id == CLOCK_TAI;
    *t = spec_of(now_ps(), of_day ? EPOCH_S : 0);
    return 0;
}

WEAK int clock_getres(clockid_t id, struct timespec *t)
{
    (void)id;
    if (t) *t = (struct timespec){.tv_nsec = 1};
    return 0;
}

WEAK int gettimeofday(struct timeval *restrict t, void *restrict zone)
{
    const int64_t ps = now_ps();
    (void)zone;
    *t = (struct timeval){.tv_sec = EPOCH_S + ps / SECOND, .tv_usec = ps % SECOND / 1000000};
    return 0;
}

WEAK time_t time(time_t *t)
{
    const time_t s = EPOCH_S + now_ps() / SECOND;
    if (t) *t = s;
    return s;
}

WEAK int timespec_get(struct timespec *t, int base)
{
    if (base != TIME_UTC) return 0;
    *t = spec_of(now_ps(), EPOCH_S);
    return base;
}

WEAK clock_t clock(void) { return now_ps() / 1000000; } /* CLOCKS_PER_SEC is 10^6 */

WEAK clock_t times(struct tms *t)
{
    const clock_t ticks = now_ps() / (SECOND / 100);
    if (t) *t = (struct tms){.tms_utime = ticks};
    return ticks;
}

WEAK int getrusage(__rusage_who_t who, struct rusage *r)
{
    const int64_t ps = now_ps();
    (void)who;
    memset(r, 0, sizeof *r);
    r->ru_utime = (struct timeval){.tv_sec = ps / SECOND, .tv_usec = ps % SECOND / 1000000};
    return 0;
}

WEAK unsigned sleep(unsigned s)
{
    sleep_for(s, 0);
    return 0;
}

WEAK int usleep(useconds_t us)
{
    sleep_for(us / 1000000, (int64_t)(us % 1000000) * 1000);
    return 0;
}

static int sleep_spec(const struct timespec *t, struct timespec *left)
{
    if (t->tv_sec < 0 || t->tv_nsec < 0 || t->tv_nsec >= 1000000000) return EINVAL;
    sleep_for(t->tv_sec, t->tv_nsec);
    if (left) *left = (struct timespec){0};
    return 0;
}

WEAK int nanosleep(const struct timespec *t, struct timespec *left)
{
    errno = sleep_spec(t, left);
    return errno ? -1 : 0;
}

WEAK int clock_nanosleep(clockid_t id, int flags, const struct timespec *t, struct timespec *left)
{
    if (!(flags & TIMER_ABSTIME)) return sleep_spec(t, left);
    struct timespec now;
    clock_gettime(id, &now);
    int64_t s = t->tv_sec - now.tv_sec, ns = t->tv_nsec - now.tv_nsec;
    if (ns < 0) s--, ns += 1000000000;
    if (s >= 0) sleep_for(s, ns);
    return 0;
}

/* Waiting for no descriptor at all is an old way of sleeping. */
WEAK int select(int n, fd_set *restrict in, fd_set *restrict out, fd_set *restrict odd,
                struct timeval *restrict t)
{
    if (n > 0 || !t) return mimdsim_libc_select(n, in, out, odd, t);
    sleep_for(t->tv_sec, t->tv_usec * 1000);
    return 0;
}

WEAK int poll(struct pollfd *p, nfds_t n, int ms)
{
    if (n > 0 || ms < 0) return mimdsim_libc_poll(p, n, ms);
    sleep_for(ms / 1000, (int64_t)(ms % 1000) * 1000000);
    return 0;
}

/* --- calendar functions with a result in the C library: here it is the rank's --- */

static struct tm broken_down;
static char calendar[64];

WEAK struct tm *gmtime(const time_t *t) { return gmtime_r(t, &broken_down); }
WEAK struct tm *localtime(const time_t *t) { return localtime_r(t, &broken_down); }
WEAK char *asctime(const struct tm *t) { return asctime_r(t, calendar); }
WEAK char *ctime(const time_t *t) { return ctime_r(t, calendar); }
