/* cpu_seconds.c - user and system seconds of one command and its children, as the system accounts
 * for them, on stream 3. A shell's `time` adds what it takes to make a copy of the shell first,
 * which shows beside a small run.
 *
 *   cpu_seconds LIMIT COMMAND [ARGUMENT...] 3>FILE
 *
 * LIMIT: of processor time [s], or unlimited. */
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>

extern char **environ;

int main(int argc, char **argv)
{
    if (argc < 3) return 64;
    const rlim_t limit = strtoul(argv[1], NULL, 10);
    if (limit > 0) setrlimit(RLIMIT_CPU, &(struct rlimit){limit, limit});
    pid_t child;
    int status;
    struct rusage used;
    if (posix_spawnp(&child, argv[2], NULL, NULL, argv + 2, environ) != 0) return 127;
    if (wait4(child, &status, 0, &used) != child) return 71;
    dprintf(3, "%.4f\n",
            (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec));
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
