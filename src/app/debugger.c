/* debugger.c - gdb around a run: it follows into the worker process and loads the symbols of the
 * rank's copy.
 *
 * The loader calls loader_debug_stop for each rank before any of its code runs: rank, file and base
 * address are its arguments, in registers rdi, rsi, rdx (psABI 3.2.3), so that gdb needs no debug
 * information of the simulator. */
#include "app/debugger.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"

int debugger_wanted(int n, char **argv)
{
    for (int i = 1; i < n; i++)
        if (strcmp(argv[i], "--debug") == 0) return i;
    return 0;
}

void debugger_run(int argc, char **argv, int place, struct err *e)
{
    char stop[96], self[4096], *end = NULL;
    const long rank = place + 1 < argc ? strtol(argv[place + 1], &end, 10) : -1;
    if (rank < 0 || !end || *end != '\0' || end == argv[place + 1]) {
        err_set(e, ERR_USAGE, "--debug: expected the number of a rank, as in --debug 3");
        return;
    }
    const ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    if (n < 0) snprintf(self, sizeof self, "mimdsim");
    else self[n] = '\0';
    snprintf(stop, sizeof stop, "tbreak *loader_debug_stop if (int)$rdi == %ld", rank);

    /* The simulator has a main, too, which it has long entered: only the one of the program is
     * met. */
    const char *const before[] = {
        "gdb",    "-q",
        "-ex",    "set confirm off",
        "-ex",    "set breakpoint pending on",
        "-ex",    "set follow-fork-mode child",
        "-ex",    "handle SIGPROF nostop noprint pass",
        "-ex",    stop,
        "-ex",    "run",
        "-ex",    "eval \"add-symbol-file '%s' -o 0x%lx\", (char *)$rsi, (long)$rdx",
        "-ex",    "tbreak main",
        "-ex",    "continue",
        "--args", self, "mpirun"};
    const size_t nbefore = sizeof before / sizeof *before;
    const char **word = memory_zeroed(nbefore + (size_t)argc + 1, sizeof *word);
    memcpy(word, before, sizeof before);
    size_t k = nbefore;
    for (int i = 1; i < argc; i++)
        if (i != place && i != place + 1) word[k++] = argv[i];
    execvp(word[0], (char *const *)word);
    free(word);
    err_set(e, ERR_UNAVAILABLE, "--debug needs gdb, which is not there");
}
