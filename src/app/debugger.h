/* debugger.h - one rank of a program under gdb: mimdsim mpirun --debug RANK. */
#ifndef APP_DEBUGGER_H
#define APP_DEBUGGER_H

#include "base/err.h"

/* debugger_wanted: place of "--debug" among the first `n` words, 0: it is not there. */
int debugger_wanted(int n, char **argv);

/* debugger_run: become gdb, which runs this command without the words at `place` and behind it,
 * stops where the rank's program begins, and knows its symbols. Returns only when that fails, with
 * ERR_USAGE or ERR_UNAVAILABLE in *e. */
void debugger_run(int argc, char **argv, int place, struct err *e);

#endif
