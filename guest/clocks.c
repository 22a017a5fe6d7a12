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

static int64_t now_ps(const void *place)
{
    guest_account(place);
    mimdsim_host->runtime->elapse_ps(mimdsim_host, LOOK);
    return mimdsim_host->runtime->now_ps(mimdsim_host);
}

/* sleep_for: idle for that long; a time out of range is as long as there is. */
static void sleep_for(const void *place, int64_t s, int64_t ns)
{
    const int64_t most = INT64_MAX / SECOND / 2;
    guest_account(place);
    mimdsim_host->runtime->sleep_ps(mimdsim_host, (s > most ? most : s) * SECOND + ns * 1000);
}

static struct timespec spec_of(int64_t ps, int64_t epoch)
{
    return (struct timespec){.tv_sec = epoch + ps / SECOND, .tv_nsec = ps % SECOND / 1000};
}

static int is_of_day(clockid_t id)
{
    return id == CLOCK_REALTIME || id == CLOCK_REALTIME_COARSE || id == CLOCK_TAI;
}

/* Clocks count from different beginnings: those of the day from EPOCH_S, the others from the start
 * of the run. */
WEAK int clock_gettime(clockid_t id, struct timespec *t)
{
    *t = spec_of(now_ps(HERE), is_of_day(id) ? EPOCH_S : 0);
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
    const int64_t ps = now_ps(HERE);
    (void)zone;
    *t = (struct timeval){.tv_sec = EPOCH_S + ps / SECOND, .tv_usec = ps % SECOND / 1000000};
    return 0;
}

WEAK time_t time(time_t *t)
{
    const time_t s = EPOCH_S + now_ps(HERE) / SECOND;
    if (t) *t = s;
    return s;
}

WEAK int timespec_get(struct timespec *t, int base)
{
    if (base != TIME_UTC) return 0;
    *t = spec_of(now_ps(HERE), EPOCH_S);
    return base;
}

WEAK clock_t clock(void) { return now_ps(HERE) / 1000000; } /* CLOCKS_PER_SEC is 10^6 */

WEAK clock_t times(struct tms *t)
{
    const clock_t ticks = now_ps(HERE) / (SECOND / 100);
    if (t) *t = (struct tms){.tms_utime = ticks};
    return ticks;
}

WEAK int getrusage(__rusage_who_t who, struct rusage *r)
{
    const int64_t ps = now_ps(HERE);
    (void)who;
    memset(r, 0, sizeof *r);
    r->ru_utime = (struct timeval){.tv_sec = ps / SECOND, .tv_usec = ps % SECOND / 1000000};
    return 0;
}

WEAK unsigned sleep(unsigned s)
{
    sleep_for(HERE, s, 0);
    return 0;
}

WEAK int usleep(useconds_t us)
{
    sleep_for(HERE, us / 1000000, (int64_t)(us % 1000000) * 1000);
    return 0;
}

static int sleep_spec(const void *place, const struct timespec *t, struct timespec *left)
{
    if (t->tv_sec < 0 || t->tv_nsec < 0 || t->tv_nsec >= 1000000000) return EINVAL;
    sleep_for(place, t->tv_sec, t->tv_nsec);
    if (left) *left = (struct timespec){0};
    return 0;
}

WEAK int nanosleep(const struct timespec *t, struct timespec *left)
{
    errno = sleep_spec(HERE, t, left);
    return errno ? -1 : 0;
}

WEAK int clock_nanosleep(clockid_t id, int flags, const struct timespec *t, struct timespec *left)
{
    if (!(flags & TIMER_ABSTIME)) return sleep_spec(HERE, t, left);
    const int64_t ps = now_ps(HERE);
    const struct timespec now = spec_of(ps, is_of_day(id) ? EPOCH_S : 0);
    int64_t s = t->tv_sec - now.tv_sec, ns = t->tv_nsec - now.tv_nsec;
    if (ns < 0) s--, ns += 1000000000;
    if (s >= 0) sleep_for(HERE, s, ns);
    return 0;
}

/* Waiting for no descriptor at all is an old way of sleeping. */
WEAK int select(int n, fd_set *restrict in, fd_set *restrict out, fd_set *restrict odd,
                struct timeval *restrict t)
{
    if (n > 0 || !t) return mimdsim_libc_select(n, in, out, odd, t);
    sleep_for(HERE, t->tv_sec, t->tv_usec * 1000);
    return 0;
}

WEAK int poll(struct pollfd *p, nfds_t n, int ms)
{
    if (n > 0 || ms < 0) return mimdsim_libc_poll(p, n, ms);
    sleep_for(HERE, ms / 1000, (int64_t)(ms % 1000) * 1000000);
    return 0;
}

/* --- Fortran's clocks, whose library would ask too late: what was counted is told here --- */

void _gfortran_cpu_time_4(float *t);
WEAK void _gfortran_cpu_time_4(float *t) { *t = (float)(1e-12 * (double)now_ps(HERE)); }
void _gfortran_cpu_time_8(double *t);
WEAK void _gfortran_cpu_time_8(double *t) { *t = 1e-12 * (double)now_ps(HERE); }

/* Counts of milliseconds in 32 bits, of nanoseconds in 64; each argument may be missing (gfortran
 * manual, SYSTEM_CLOCK). */
void _gfortran_system_clock_4(int32_t *count, int32_t *rate, int32_t *most);
WEAK void _gfortran_system_clock_4(int32_t *count, int32_t *rate, int32_t *most)
{
    const int64_t ps = now_ps(HERE);
    if (count) *count = (int32_t)(ps / 1000000000 % INT32_MAX);
    if (rate) *rate = 1000;
    if (most) *most = INT32_MAX;
}
void _gfortran_system_clock_8(int64_t *count, int64_t *rate, int64_t *most);
WEAK void _gfortran_system_clock_8(int64_t *count, int64_t *rate, int64_t *most)
{
    const int64_t ps = now_ps(HERE);
    if (count) *count = ps / 1000;
    if (rate) *rate = 1000000000;
    if (most) *most = INT64_MAX;
}

/* --- calendar functions with a result in the C library: here it is the rank's --- */

static struct tm broken_down;
static char calendar[64];

WEAK struct tm *gmtime(const time_t *t) { return gmtime_r(t, &broken_down); }
WEAK struct tm *localtime(const time_t *t) { return localtime_r(t, &broken_down); }
WEAK char *asctime(const struct tm *t) { return asctime_r(t, calendar); }
WEAK char *ctime(const time_t *t) { return ctime_r(t, calendar); }
