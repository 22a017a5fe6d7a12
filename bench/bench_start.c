/* bench_start.c - what whole processes cost: start, plan, runs, database.
 *
 *   bench_start MIMDSIM [ROUNDS]      default 15 rounds
 *
 * Each row is `MIMDSIM run speedup-t3e` into a new database, by one worker: processor time and time
 * by the clock, the least of some rounds, since other programs only add to both. Rows of many seeds
 * tell what one more run of a campaign costs beside the process. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/progress.h"
#include "base/text.h"

static const char *const database[] = {"bench_start.db", "bench_start.db-wal",
                                       "bench_start.db-shm"};

/* One process: *cpu and *clock [s]; false when it fails. */
static bool once(const char *program, int n, int runs, double *cpu, double *clock)
{
    char size[16];
    struct text seeds = {0};
    for (int i = 0; i < 3; i++) unlink(database[i]);
    snprintf(size, sizeof size, "n=%d", n);
    text_add(&seeds, "seed=1");
    for (int i = 2; i <= runs; i++) text_add(&seeds, ",%d", i);
    const double begin = host_seconds();
    const pid_t child = fork();
    if (child == 0) {
        const int quiet = open("/dev/null", O_WRONLY);
        dup2(quiet, STDOUT_FILENO);
        execlp(program, program, "run", "speedup-t3e", "-q", "-j1", "-o", database[0], "--set",
               size, "--set", "level=loggp", "--set", "record.links=false", "--set", seeds.s,
               (char *)NULL);
        _exit(127);
    }
    int status = 1;
    struct rusage used;
    const bool ended = child > 0 && wait4(child, &status, 0, &used) == child;
    *clock = host_seconds() - begin;
    text_free(&seeds);
    if (!ended || status != 0) return false;
    *cpu = (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
    return true;
}

int main(int argc, char **argv)
{
    static const struct {
        int n, runs;
    } row[] = {{16, 1}, {128, 1}, {16, 100}, {128, 100}};
    const int rounds = argc > 2 ? atoi(argv[2]) : 15;
    if (argc < 2) {
        fprintf(stderr, "usage: bench_start MIMDSIM [ROUNDS]\n");
        return 64;
    }
    printf("%6s %6s %12s %12s %14s\n", "n = P", "runs", "cpu ms", "clock ms", "cpu ms a run");
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        double least_cpu = 1e9, least_clock = 1e9;
        for (int k = 0; k < rounds; k++) {
            double cpu, clock;
            if (!once(argv[1], row[i].n, row[i].runs, &cpu, &clock)) {
                fprintf(stderr, "bench_start: %s failed\n", argv[1]);
                return 1;
            }
            least_cpu = cpu < least_cpu ? cpu : least_cpu;
            least_clock = clock < least_clock ? clock : least_clock;
        }
        printf("%6d %6d %12.2f %12.2f %14.3f\n", row[i].n, row[i].runs, 1e3 * least_cpu,
               1e3 * least_clock, 1e3 * least_cpu / row[i].runs);
        fflush(stdout);
    }
    for (int i = 0; i < 3; i++) unlink(database[i]);
    return 0;
}
