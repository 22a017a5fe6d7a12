/* host_load.c - see host_load.h; by the files of proc(5), whose times have steps of 10 ms. */
#include "host/host_load.h"

#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/text.h"
#include "host/host_comm.h"

#define SHORTEST_S 0.3

/* Busy is whatever is not idle, of all processors since the system began.
 *
 * user, nice, system, irq, softirq and steal of all processors; idle and iowait are not busy, and
 * guest times are part of user's already. */
static double busy_seconds(void)
{
    double user, nice, system, idle, wait, irq, soft, steal;
    FILE *f = fopen("/proc/stat", "r");
    if (f == NULL) return NAN;
    const int n = fscanf(f, "cpu %lf %lf %lf %lf %lf %lf %lf %lf", &user, &nice, &system, &idle,
                         &wait, &irq, &soft, &steal);
    fclose(f);
    if (n < 8) return NAN;
    return (user + nice + system + irq + soft + steal) / (double)sysconf(_SC_CLK_TCK);
}

/* The first number of the file; those of 5 and 15 minutes follow. */
static double load_average(void)
{
    double one;
    FILE *f = fopen("/proc/loadavg", "r");
    if (f == NULL) return NAN;
    const int n = fscanf(f, "%lf", &one);
    fclose(f);
    return n == 1 ? one : NAN;
}

/* Counters now; the difference is taken later. */
struct host_load_begin host_load_start(void)
{
    return (struct host_load_begin){busy_seconds(), (double)host_clock_ns() * 1e-9, load_average()};
}

/* The counters' steps may make the difference a little negative. */
struct host_load host_load_read(const struct host_load_begin *begin, double own_s)
{
    const double wall = (double)host_clock_ns() * 1e-9 - begin->wall_s;
    /* Steps of 10 ms on each processor say nothing of a shorter time. */
    const double others = wall < SHORTEST_S ? NAN : (busy_seconds() - begin->busy_s - own_s) / wall;
    return (struct host_load){others < 0 ? 0 : others, begin->average, load_average()};
}

/* Processors 62 and up are one bit: a set that has them is counted by the system instead. */
uint64_t host_processor_set(void)
{
    cpu_set_t set;
    uint64_t bits = 0;
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    for (int i = 0; i < CPU_SETSIZE; i++)
        if (CPU_ISSET(i, &set)) bits |= UINT64_C(1) << (i < 62 ? i : 62);
    return bits;
}

/* Ranks that are bound have a processor each: their sets are joined by whoever asks. */
int host_processors(uint64_t set)
{
    if (set >> 62 != 0) return (int)sysconf(_SC_NPROCESSORS_ONLN);
    return __builtin_popcountll(set);
}

/* The first "model name : ..." line. */
void host_processor_name(char *buffer, int size)
{
    char line[256];
    buffer[0] = '\0';
    FILE *f = fopen("/proc/cpuinfo", "r");
    if (f == NULL) return;
    while (buffer[0] == '\0' && fgets(line, sizeof line, f) != NULL) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || colon == NULL) continue;
        line[strcspn(line, "\n")] = '\0';
        text_copy(buffer, (size_t)size, colon + 1 + (colon[1] == ' '));
    }
    fclose(f);
}

/* Cut where it is too long, and always ended. */
void host_name(char *buffer, int size)
{
    if (gethostname(buffer, (size_t)size) != 0) buffer[0] = '\0';
    buffer[size - 1] = '\0';
}

/* In UTC, as all dates of this project. */
void host_date(char buffer[16])
{
    struct tm utc;
    const time_t now = time(NULL);
    gmtime_r(&now, &utc);
    strftime(buffer, 16, "%Y-%m-%d", &utc);
}
