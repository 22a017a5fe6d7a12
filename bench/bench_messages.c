/* bench_messages.c - simulated messages per second of the main scenario with growing machines.
 *
 *   bench_messages [P...]      default 128 1024 4096 16384; each at the levels loggp and link, each in a process of
 *                              its own so that the peak memory is its own. n = P, inverse and forward dynamics. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/progress.h"
#include "plan/plan.h"
#include "run/run.h"
#include "torus_plan.h"

/* Whole-process seconds of SimGrid/SMPI 3.32 (its fastest flags) with the same messages and the same arithmetic on a
 * torus, and of LogGOPSim without arithmetic and topology; 0: not measured. A machine of the same kind. */
static const struct peer {
    int nrank;
    double smpi_s, loggopsim_s;
} peers[] = {{128, 0.07, 0}, {1024, 0.9, 0.05}, {4096, 6, 0.39}, {16384, 44, 2.6}, {65536, 0, 19}};

static const struct peer *peer_of(int nrank)
{
    for (size_t i = 0; i < sizeof peers / sizeof *peers; i++)
        if (peers[i].nrank == nrank) return &peers[i];
    return NULL;
}

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
    const struct peer *peer = peer_of(nrank);
    double total = host_seconds() - begin;
    printf("%8d %-6s %10lld %9.3f %9.3f %8.2f %9.1f %7.1f", nrank, level, (long long)r.messages, r.host_s, total,
           (double)r.messages / r.host_s / 1e6, (double)host_peak_bytes() / 1048576.0,
           (double)r.stack_peak_bytes / 1024.0);
    if (peer && peer->smpi_s > 0) printf(" %10.1f", peer->smpi_s / total);
    else printf(" %10s", "-");
    if (peer && peer->loggopsim_s > 0) printf(" %12.1f", peer->loggopsim_s / total);
    printf("\n");
    fflush(stdout);
    return r.status == RUN_OK ? 0 : 1;
}

static int measure_apart(int nrank, const char *level)
{
    fflush(stdout);
    pid_t pid = fork();
    if (pid == 0) _exit(measure(nrank, level));
    int status = 1;
    waitpid(pid, &status, 0);
    return status != 0;
}

int main(int argc, char **argv)
{
    static const int standard[] = {128, 1024, 4096, 16384};
    int n = argc > 1 ? argc - 1 : 4, failed = 0;
    printf("%8s %-6s %10s %9s %9s %8s %9s %7s %10s %12s\n", "P", "level", "messages", "sim s", "all s", "Mmsg/s",
           "peak MiB", "stack K", "SMPI/this", "LogGOPSim/this");
    for (int i = 0; i < n; i++) {
        int nrank = argc > 1 ? atoi(argv[i + 1]) : standard[i];
        failed += measure_apart(nrank, "loggp");
        failed += measure_apart(nrank, "link");
    }
    return failed != 0;
}
