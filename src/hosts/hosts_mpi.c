/* hosts_mpi.c - the calls of hosts.h by MPI. Compiled once for each MPI that was found, into a
 * module of its own.
 *
 * Errors are returned, not fatal: a process that has gone must not take the others along. */
#include "hosts/hosts.h"

#include <limits.h>
#include <mpi.h>

static bool begin(int *rank, int *size)
{
    int provided;
    /* One thread of the process calls MPI, which may have others beside it. */
    if (MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS) return false;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    return MPI_Comm_rank(MPI_COMM_WORLD, rank) == MPI_SUCCESS &&
           MPI_Comm_size(MPI_COMM_WORLD, size) == MPI_SUCCESS;
}

/* Collective: a process that has gone would keep the others waiting here. */
static void end(void) { MPI_Finalize(); }

/* Small messages are buffered by MPI, large ones wait for their receiver. */
static bool send(int to, int tag, const void *data, size_t bytes)
{
    return bytes <= INT_MAX &&
           MPI_Send(data, (int)bytes, MPI_BYTE, to, tag, MPI_COMM_WORLD) == MPI_SUCCESS;
}

/* The request is kept in the caller's memory as it is: a number with MPICH, a pointer with Open
 * MPI. */
union kept {
    struct hosts_request outer;
    MPI_Request inner;
};
_Static_assert(sizeof(MPI_Request) <= sizeof(struct hosts_request), "a request fits");

static bool send_begin(int to, int tag, const void *data, size_t bytes, struct hosts_request *r)
{
    union kept k = {.outer = {{0}}};
    const bool ok = bytes <= INT_MAX && MPI_Isend(data, (int)bytes, MPI_BYTE, to, tag,
                                                  MPI_COMM_WORLD, &k.inner) == MPI_SUCCESS;
    *r = k.outer;
    return ok;
}

static bool send_done(struct hosts_request *r, bool *done)
{
    union kept k = {.outer = *r};
    int flag = 0;
    const bool ok = MPI_Test(&k.inner, &flag, MPI_STATUS_IGNORE) == MPI_SUCCESS;
    *r = k.outer; /* the null request once it is done */
    *done = flag != 0;
    return ok;
}

/* Whoever receives learns the size first, so that its memory fits. */
static bool look(int from, int tag, bool wait, bool *there, struct hosts_message *m)
{
    MPI_Status status;
    int flag = 1, n = 0;
    if (from == HOSTS_ANY) from = MPI_ANY_SOURCE;
    if (tag == HOSTS_ANY) tag = MPI_ANY_TAG;
    const int code = wait ? MPI_Probe(from, tag, MPI_COMM_WORLD, &status)
                          : MPI_Iprobe(from, tag, MPI_COMM_WORLD, &flag, &status);
    *there = code == MPI_SUCCESS && flag;
    if (!*there) return code == MPI_SUCCESS;
    if (MPI_Get_count(&status, MPI_BYTE, &n) != MPI_SUCCESS) return false;
    *m = (struct hosts_message){status.MPI_SOURCE, status.MPI_TAG, (size_t)n};
    return true;
}

static bool receive(const struct hosts_message *m, void *data)
{
    return MPI_Recv(data, (int)m->bytes, MPI_BYTE, m->from, m->tag, MPI_COMM_WORLD,
                    MPI_STATUS_IGNORE) == MPI_SUCCESS;
}

/* In place: every process gives and gets the same array. */
static bool reduce(enum hosts_reduction how, int64_t *value, int n)
{
    const MPI_Op op = how == HOSTS_SUM ? MPI_SUM : how == HOSTS_LEAST ? MPI_MIN : MPI_MAX;
    return MPI_Allreduce(MPI_IN_PLACE, value, n, MPI_INT64_T, op, MPI_COMM_WORLD) == MPI_SUCCESS;
}

static bool gather(const int64_t *value, int n, int64_t *all)
{
    return MPI_Allgather(value, n, MPI_INT64_T, all, n, MPI_INT64_T, MPI_COMM_WORLD) == MPI_SUCCESS;
}

static void abort_all(int status) { MPI_Abort(MPI_COMM_WORLD, status); }

#ifdef OPEN_MPI
#define LIBRARY "Open MPI"
#else
#define LIBRARY "MPICH"
#endif

/* What hosts.c looks for. */
extern const struct lane_calls mimdsim_lane;
extern const struct hosts_calls mimdsim_hosts;
const struct hosts_calls mimdsim_hosts = {
    HOSTS_TABLE, LIBRARY, begin,   end,    send,   send_begin, send_done,
    look,        receive, reduce,  gather, abort_all, &mimdsim_lane,
};
