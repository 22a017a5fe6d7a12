/* bench_messages.c - simulated messages per second of the main scenario with growing machines.
 *
 *   bench_messages [P...]      default 128 1024 4096 16384; each at the levels loggp and link, each
 * in a process of its own so that the peak memory is its own. n = P, inverse and forward dynamics.
 *
 * Other simulators are timed beside it by bench/compare-peers.sh, where they are installed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/large_pages.h"
#include "base/progress.h"
#include "plan/plan.h"
#include "run/run.h"
#include "torus_plan.h"

static int measure(int nrank, const char *level)
{
    double begin = host_seconds();
    struct err e;
    err_clear(&e);
    struct plan p = {0};
    if (!torus_plan_read(&p, nrank, level, &e)) {
        err_print(&e);
        return 1;
    }
    struct arena *a = arena_create();
    struct run_result r;
    if (!run_one(&p.run[0], a, &r, &e)) {
        err_print(&e);
        return 1;
    }
    double total = host_seconds() - begin;
    printf("%8d %-6s %10lld %9.3f %9.3f %8.2f %9.1f %7.1f\n", nrank, level, (long long)r.messages,
           r.host_s, total, (double)r.messages / r.host_s / 1e6,
           (double)host_peak_bytes() / 1048576.0, (double)r.stack_peak_bytes / 1024.0);
    fflush(stdout);
    return r.status == RUN_OK ? 0 : 1;
}

static int measure_apart(int nrank, const char *level)
{
    fflush(stdout);
    pid_t pid = fork();
    if (pid == 0) {
        large_pages_for_heap(); /* as the program does */
        _exit(measure(nrank, level));
    }
    int status = 1;
    waitpid(pid, &status, 0);
    return status != 0;
}

int main(int argc, char **argv)
{
    static const int standard[] = {128, 1024, 4096, 16384};
    int n = argc > 1 ? argc - 1 : 4, failed = 0;
    printf("%8s %-6s %10s %9s %9s %8s %9s %7s\n", "P", "level", "messages", "sim s", "all s",
           "Mmsg/s", "peak MiB", "stack K");
    for (int i = 0; i < n; i++) {
        int nrank = argc > 1 ? atoi(argv[i + 1]) : standard[i];
        failed += measure_apart(nrank, "loggp");
        failed += measure_apart(nrank, "link");
    }
    return failed != 0;
}
