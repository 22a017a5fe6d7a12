/* hosts.h - the processes of one job that mpirun started, on one host or many: their messages and
 * reductions.
 *
 * MPI stands behind a table of calls, in a module of its own that is loaded only when a job asks
 * for it: a run without MPI neither needs its libraries nor waits for their start. The same program
 * runs under Open MPI and MPICH: the module of whichever started the process is taken. */
#ifndef HOSTS_HOSTS_H
#define HOSTS_HOSTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/err.h"
#include "hosts/lane.h"

enum { HOSTS_ANY = -1 };  /* any sender, any tag */
enum { HOSTS_TABLE = 2 }; /* to be raised when the table below changes */

enum hosts_reduction { HOSTS_SUM, HOSTS_LEAST, HOSTS_LARGEST };

/* A message that has arrived and waits to be received. */
struct hosts_message {
    int from, tag;
    size_t bytes;
};

/* A message that is being sent; opaque, as large as any MPI's request. */
struct hosts_request {
    uint64_t word[2];
};

/* What a module provides. One thread of a process calls. Each returns false when MPI reports an
 * error, such as a process that has gone; the job's error handler returns instead of aborting. */
struct hosts_calls {
    int table;           /* HOSTS_TABLE of the module */
    const char *library; /* "Open MPI" or "MPICH" */
    /* begin: start MPI in this process; its rank of how many. end: leave in order, all processes
     * together. */
    bool (*begin)(int *rank, int *size);
    void (*end)(void);
    /* send: returns when `data` may be reused; at most INT_MAX bytes. */
    bool (*send)(int to, int tag, const void *data, size_t bytes);
    /* send_begin, send_done: the same in two steps; `data` stays until *done. */
    bool (*send_begin)(int to, int tag, const void *data, size_t bytes, struct hosts_request *r);
    bool (*send_done)(struct hosts_request *r, bool *done);
    /* look: whether a message from `from` with `tag` has arrived (*there), waiting for one when
     * `wait`. MPI waits by spinning: who has nothing to compute looks without waiting, and sleeps
     * between. */
    bool (*look)(int from, int tag, bool wait, bool *there, struct hosts_message *m);
    /* receive: the message that look found, into `data` (m->bytes). */
    bool (*receive)(const struct hosts_message *m, void *data);
    /* reduce: value (n), the same on all processes afterwards. gather: `n` values of each, (size x
     * n), to all. */
    bool (*reduce)(enum hosts_reduction how, int64_t *value, int n);
    bool (*gather)(const int64_t *value, int n, int64_t *all);
    /* abort: end all processes at once with this exit status. */
    void (*abort)(int status);
    const struct lane_calls *lane; /* messages of programs that run for real */
};

struct hosts {
    int rank, size; /* this process: 0 .. size - 1 */
    const struct hosts_calls *call;
};

/* hosts_started: whether a launcher of MPI (mpirun, srun) started this process. */
bool hosts_started(void);

/* hosts_open: join the job; to be called once in a process, and before it starts threads. Returns
 * false with ERR_UNAVAILABLE when this program was built without the MPI that started it,
 * ERR_INTERNAL when MPI does not start. */
bool hosts_open(struct hosts *h, struct err *e);

#endif
