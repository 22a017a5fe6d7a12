/* lane_mpi.c - the calls of lane.h by MPI. Part of the module of each MPI (hosts_mpi.c).
 *
 * Each function is one call of MPI and the conversion of its arguments. Handles are kept in the
 * caller's memory as they are: numbers with MPICH, pointers with Open MPI. */
#include "hosts/lane.h"

#include <limits.h>
#include <mpi.h>

#include "hosts/hosts.h"

union kept_lane {
    struct lane outer;
    MPI_Comm inner;
};
union kept_request {
    struct hosts_request outer;
    MPI_Request inner;
};
_Static_assert(sizeof(MPI_Comm) <= sizeof(struct lane), "a communicator fits");
_Static_assert(sizeof(MPI_Request) <= sizeof(struct hosts_request), "a request fits");

/* The handle as MPI knows it. */
static MPI_Comm comm_of(const struct lane *l) { return ((union kept_lane){.outer = *l}).inner; }

/* A copy of the world with its own matching. Errors are returned, as everywhere in the module. */
static bool lane_open(struct lane *l, int *largest_tag)
{
    union kept_lane k = {.outer = {0}};
    int *limit = NULL, known = 0;
    if (MPI_Comm_dup(MPI_COMM_WORLD, &k.inner) != MPI_SUCCESS) return false;
    MPI_Comm_set_errhandler(k.inner, MPI_ERRORS_RETURN);
    *l = k.outer;
    /* The standard promises 32767 where an implementation says nothing. */
    *largest_tag = 32767;
    if (MPI_Comm_get_attr(k.inner, MPI_TAG_UB, &limit, &known) == MPI_SUCCESS && known)
        *largest_tag = *limit;
    return true;
}

/* By all together: freeing a communicator is collective. */
static bool lane_close(struct lane *l)
{
    union kept_lane k = {.outer = *l};
    return MPI_Comm_free(&k.inner) == MPI_SUCCESS;
}

/* A synchronous send is done when its receive has begun, whatever its size. */
static bool lane_send_begin(const struct lane *l, int to, int tag, const void *data, size_t bytes,
                            bool synchronous, struct hosts_request *r)
{
    union kept_request k = {.outer = {{0}}};
    if (bytes > INT_MAX) return false;
    const int n = (int)bytes;
    const int code = synchronous ? MPI_Issend(data, n, MPI_BYTE, to, tag, comm_of(l), &k.inner)
                                 : MPI_Isend(data, n, MPI_BYTE, to, tag, comm_of(l), &k.inner);
    *r = k.outer;
    return code == MPI_SUCCESS;
}

/* Matched by MPI, by sender and tag in the order sent. */
static bool lane_receive_begin(const struct lane *l, int from, int tag, void *data, size_t bytes,
                               struct hosts_request *r)
{
    union kept_request k = {.outer = {{0}}};
    const bool ok = bytes <= INT_MAX && MPI_Irecv(data, (int)bytes, MPI_BYTE, from, tag, comm_of(l),
                                                  &k.inner) == MPI_SUCCESS;
    *r = k.outer;
    return ok;
}

/* The size is asked for only where somebody wants to know: a status costs time. */
static bool lane_wait(struct hosts_request *r, size_t *bytes)
{
    union kept_request k = {.outer = *r};
    MPI_Status status;
    int n = 0;
    if (bytes == NULL) return MPI_Wait(&k.inner, MPI_STATUS_IGNORE) == MPI_SUCCESS;
    if (MPI_Wait(&k.inner, &status) != MPI_SUCCESS) return false;
    if (MPI_Get_count(&status, MPI_BYTE, &n) != MPI_SUCCESS) return false;
    *bytes = (size_t)n;
    return true;
}

static bool lane_test(struct hosts_request *r, bool *done)
{
    union kept_request k = {.outer = *r};
    int flag = 0;
    const bool ok = MPI_Test(&k.inner, &flag, MPI_STATUS_IGNORE) == MPI_SUCCESS;
    *r = k.outer; /* the null request once it is done */
    *done = flag != 0;
    return ok;
}

/* Without waiting: whoever calls has more to look at. */
static bool lane_look(const struct lane *l, bool *there, struct hosts_message *m)
{
    MPI_Status status;
    int flag = 0, n = 0;
    if (MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, comm_of(l), &flag, &status) != MPI_SUCCESS)
        return false;
    *there = flag != 0;
    if (!flag) return true;
    if (MPI_Get_count(&status, MPI_BYTE, &n) != MPI_SUCCESS) return false;
    *m = (struct hosts_message){status.MPI_SOURCE, status.MPI_TAG, (size_t)n};
    return true;
}

/* The very message that was seen: one thread receives, and MPI keeps the order. */
static bool lane_receive(const struct lane *l, const struct hosts_message *m, void *data)
{
    return MPI_Recv(data, (int)m->bytes, MPI_BYTE, m->from, m->tag, comm_of(l),
                    MPI_STATUS_IGNORE) == MPI_SUCCESS;
}

/* MPI's own, to begin at one time and to be measured. */
static bool lane_barrier(const struct lane *l) { return MPI_Barrier(comm_of(l)) == MPI_SUCCESS; }

/* What the table of hosts_mpi.c refers to: the module is one library of two files, of which only
 * these two names matter. */
extern const struct lane_calls mimdsim_lane;
const struct lane_calls mimdsim_lane = {
    .open = lane_open,
    .close = lane_close,
    .send_begin = lane_send_begin,
    .receive_begin = lane_receive_begin,
    .wait = lane_wait,
    .test = lane_test,
    .look = lane_look,
    .receive = lane_receive,
    .barrier = lane_barrier,
};
