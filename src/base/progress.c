/* progress.c - one line of progress on stderr, and the host's clock and memory.
 *
 *     cases: 42 % (21 of 50, 3.1/s), 9 s left; twist_n0064
 *
 * On a terminal the line is written over itself; into a file a new one comes every ten seconds. */
#include "base/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "base/escape.h"

/* Short work says nothing at all; a log file gets a line now and then. */
static const double PATIENCE = 1.0;        /* s without a word */
static const double TTY_INTERVAL = 0.1;    /* s between lines on a terminal */
static const double FILE_INTERVAL = 10.0;  /* s between lines elsewhere */

/* A monotonic clock does not jump when the computer's time is set. */
static double clock_seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Host time is for people only: no result depends on it. */
double host_seconds(void) { return clock_seconds(CLOCK_MONOTONIC); }

double host_processor_seconds(void) { return clock_seconds(CLOCK_PROCESS_CPUTIME_ID); }

long host_peak_bytes(void)
{
    /* VmHWM is this program's own; ru_maxrss would include what the parent held before exec. */
    char line[128];
    long kib = -1;
    FILE *in = fopen("/proc/self/status", "r");
    while (in && kib < 0 && fgets(line, sizeof line, in))
        if (strncmp(line, "VmHWM:", 6) == 0) kib = strtol(line + 6, NULL, 10);
    if (in) fclose(in);
    if (kib >= 0) return kib * 1024;
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    return use.ru_maxrss * 1024;
}

/* quiet and tty are asked once: they do not change while a program runs. */
struct progress progress_make(const char *what, double total, bool quiet)
{
    struct progress p = {
        .what = what, .total = total, .quiet = quiet, .tty = isatty(STDERR_FILENO)};
    p.start = host_seconds();
    p.last = p.start;
    return p;
}

/* span_text: a host time for people: "42 s", "3 min 20 s", "2 h 5 min". */
static void span_text(double s, char buffer[32])
{
    long n = s < 1e9 ? (long)(s + 0.5) : 1000000000;
    if (n < 60) snprintf(buffer, 32, "%ld s", n);
    else if (n < 3600) snprintf(buffer, 32, "%ld min %ld s", n / 60, n % 60);
    else snprintf(buffer, 32, "%ld h %ld min", n / 3600, n / 60 % 60);
}

bool progress_due(const struct progress *p)
{
    if (p->quiet) return false;
    /* On a terminal the first line waits for PATIENCE, then the line is redrawn. */
    double due = !p->tty    ? p->last + FILE_INTERVAL
                 : p->shown ? p->last + TTY_INTERVAL
                            : p->start + PATIENCE;
    return host_seconds() >= due;
}

void progress_show(struct progress *p, double done)
{
    if (!progress_due(p)) return;
    /* The rest at the mean rate so far. */
    double now = host_seconds(), rate = done / (now - p->start);
    char left[32], state[96];
    /* Before the first result there is no rate to tell. */
    if (rate > 0) {
        span_text((p->total - done) / rate, left);
        snprintf(state, sizeof state, "%.0f %% (%.10g of %.10g, %.3g/s), %s left",
                 100 * done / p->total, done, p->total, rate, left);
    } else snprintf(state, sizeof state, "0 of %.10g", p->total);
    /* On a terminal the line begins again and is cleared behind its end. */
    if (p->tty) escape_raw(STDERR_FILENO, "\r", 1);
    fprintf(stderr, "%s: %s%s%s%s", p->what, state, p->detail ? "; " : "",
            p->detail ? p->detail : "", p->tty ? "" : "\n");
    fflush(stderr);
    if (p->tty) escape_raw(STDERR_FILENO, "\033[K", 3);
    p->last = now;
    p->shown = true;
}

/* The line is wiped out, so that what follows begins at the margin. */
void progress_end(struct progress *p)
{
    if (p->shown && p->tty) escape_raw(STDERR_FILENO, "\r\033[K", 4);
    p->shown = false;
}
