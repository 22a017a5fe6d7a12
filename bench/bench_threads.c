/* bench_threads.c - one run of the main scenario on one and on several host threads, side by side.
 *
 *   bench_threads [-r ROUNDS] [-t THREADS] [-l LEVEL] [P...]
 *
 * default 3 rounds, 2 threads, loggp, P = 1024 4096 16384. Each run is made in a process of its
 * own, the kinds in turn; times are the least of the rounds: of the simulation proper (ranks and
 * messages, wall), and the processor time of the whole process. The digests must be the same. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/progress.h"
#include "run/run.h"
#include "torus_plan.h"

struct timing {
    double wall, cpu, total;
    uint64_t digest;
    int64_t messages, peak;
};

/* A run in this process, which ends with it. */
static void measure(int nrank, const char *level, int threads, struct timing *t)
{
    struct err e;
    err_clear(&e);
    struct plan p = {0};
    struct run_result r;
    const struct run_order order = {.threads = threads};
    const double begin = host_seconds();
    if (!torus_plan_read(&p, nrank, level, &e) ||
        !run_sharing(&p.run[0], &order, run_cache_create(), arena_create(), &r, &e)) {
        err_print(&e);
        exit(1);
    }
    struct rusage u;
    getrusage(RUSAGE_SELF, &u);
    *t = (struct timing){.wall = r.host_s,
                         .total = host_seconds() - begin,
                         .cpu = (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
                                1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec),
                         .digest = r.digest,
                         .messages = r.messages,
                         .peak = host_peak_bytes()};
}

static bool measure_apart(int nrank, const char *level, int threads, struct timing *t)
{
    int fd[2];
    if (pipe(fd) != 0) return false;
    const pid_t pid = fork();
    if (pid == 0) {
        struct timing own;
        measure(nrank, level, threads, &own);
        _exit(write(fd[1], &own, sizeof own) == (ssize_t)sizeof own ? 0 : 1);
    }
    close(fd[1]);
    const bool ok = pid > 0 && read(fd[0], t, sizeof *t) == (ssize_t)sizeof *t;
    close(fd[0]);
    if (pid > 0) waitpid(pid, NULL, 0);
    return ok;
}

static void least(struct timing *best, const struct timing *t, bool first)
{
    if (first) *best = *t;
    if (t->wall < best->wall) best->wall = t->wall;
    if (t->cpu < best->cpu) best->cpu = t->cpu;
    if (t->total < best->total) best->total = t->total;
}

static bool compare(int nrank, const char *level, int threads, int rounds)
{
    struct timing one = {0}, many = {0}, t;
    for (int i = 0; i < rounds; i++) {
        if (!measure_apart(nrank, level, 1, &t)) return false;
        least(&one, &t, i == 0);
        if (!measure_apart(nrank, level, threads, &t)) return false;
        least(&many, &t, i == 0);
    }
    printf("%8d %-6s %7d %9.3f %9.3f %6.2f %9.3f %9.3f %6.2f %9.3f %9.3f %8.0f %8.0f %s\n", nrank,
           level, threads, one.wall, many.wall, one.wall / many.wall, one.cpu, many.cpu,
           many.cpu / one.cpu, one.total, many.total, (double)one.peak / 1048576.0,
           (double)many.peak / 1048576.0, one.digest == many.digest ? "same" : "DIFFERENT");
    fflush(stdout);
    return one.digest == many.digest;
}

int main(int argc, char **argv)
{
    int rounds = 3, threads = 2, option;
    const char *level = "loggp";
    while ((option = getopt(argc, argv, "r:t:l:")) != -1) {
        if (option == 'r') rounds = atoi(optarg);
        else if (option == 't') threads = atoi(optarg);
        else if (option == 'l') level = optarg;
        else return 64;
    }
    printf("%8s %-6s %7s %9s %9s %6s %9s %9s %6s %9s %9s %8s %8s digests\n", "P", "level",
           "threads", "wall 1", "wall N", "ratio", "cpu 1", "cpu N", "ratio", "all 1", "all N",
           "MiB 1", "MiB N");
    static char *usual[] = {"1024", "4096", "16384"};
    char **word = optind < argc ? argv + optind : usual;
    const int n = optind < argc ? argc - optind : 3;
    bool ok = true;
    for (int i = 0; i < n; i++) ok = compare(atoi(word[i]), level, threads, rounds) && ok;
    return ok ? 0 : 1;
}
