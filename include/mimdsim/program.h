/* program.h - a parallel program of your own in one file: what it declares, and what it may call.
 *
 * The whole of a program whose ranks add up their numbers, in sum.c, for
 * `mimdsim run sum.c --set n=100000`:
 *
 *     #include <mimdsim/program.h>
 *
 *     static int64_t n = 1000;
 *
 *     static double part(int64_t first, int64_t last)
 *     {
 *         double sum = 0;
 *         for (int64_t i = first; i < last; i++) sum += 1.0 / (double)(i + 1);
 *         return sum;
 *     }
 *
 *     static void run(struct comm *c)
 *     {
 *         const int me = comm_rank(c), p = comm_size(c);
 *         double sum = part(n * me / p, n * (me + 1) / p);
 *         comm_allreduce(c, COMM_SUM, &sum, 1);
 *         if (me == 0) comm_publish(c, 0, 0, 1, &sum);
 *     }
 *
 *     static void serial(struct comm *c)
 *     {
 *         const double sum = part(0, n);
 *         comm_publish(c, 0, 0, 1, &sum);
 *     }
 *
 *     PROGRAM(.title = "sum of 1/i", .parameter = {PROGRAM_WHOLE(n, 1, 1e9, "numbers to add")},
 *             .output = {"sum"}, .run = run, .serial = {{"one loop", serial}}, .tolerance = 1e-12);
 *
 * Every rank has variables of its own, static ones included, and its own copy of the code's data:
 * ranks share nothing, and what one does is seen by another through messages alone. Time is
 * simulated: computing costs what it would take on the machine of the run, sending and waiting what
 * its network makes of them.
 *
 * Wrong calls (a rank that does not exist, a message longer than its buffer, a negative size) end
 * the run as failed, with rank, place in the source and reason. All sizes are bytes unless a line
 * says otherwise. In C++ the members of PROGRAM stand in the order of struct mimdsim_program
 * (program_abi.h), where each is described. */
#ifndef MIMDSIM_PROGRAM_H
#define MIMDSIM_PROGRAM_H

#include <stddef.h>
#include <stdint.h>

#include "mimdsim/program_abi.h"

#ifdef __cplusplus
extern "C" {
#endif

/* --- the declaration --- */

/* PROGRAM: declares the program, once in a file; the arguments are members of struct
 * mimdsim_program. */
extern const struct mimdsim_program mimdsim_program __attribute__((visibility("default")));
#define PROGRAM(...)                                                                               \
    const struct mimdsim_program mimdsim_program = {.magic = MIMDSIM_PROGRAM_MAGIC,                \
                                                    .abi = MIMDSIM_PROGRAM_ABI,                    \
                                                    .size = sizeof(struct mimdsim_program),        \
                                                    __VA_ARGS__}

/* Parameters, for the list .parameter. Each is a static variable; what it is initialised with is
 * the default. The bounds are inclusive. `--set NAME=...`, `NAME: [...]` in a scenario and
 * `program.NAME` set it.
 *
 * PROGRAM_WHOLE: an int64_t. PROGRAM_SIZE: an int64_t in bytes, given as 8 KiB. PROGRAM_REAL: a
 * double with a unit of struct mimdsim_parameter; the variable holds SI units. PROGRAM_FLAG: an
 * int, 0 or 1, given as true or false. PROGRAM_CHOICE: an int that is the place of the word in
 * `choices`, such as "ring|doubling". */
#define PROGRAM_WHOLE(variable, least, most, doc)                                                  \
    MIMDSIM_PARAMETER_(variable, MIMDSIM_WHOLE, int64_t, "", NULL, least, most, doc)
#define PROGRAM_SIZE(variable, least, most, doc)                                                   \
    MIMDSIM_PARAMETER_(variable, MIMDSIM_WHOLE, int64_t, "B", NULL, least, most, doc)
#define PROGRAM_REAL(variable, unit, least, most, doc)                                             \
    MIMDSIM_PARAMETER_(variable, MIMDSIM_REAL, double, unit, NULL, least, most, doc)
#define PROGRAM_FLAG(variable, doc)                                                                \
    MIMDSIM_PARAMETER_(variable, MIMDSIM_FLAG, int, "", NULL, 0, 1, doc)
#define PROGRAM_CHOICE(variable, choices, doc)                                                     \
    MIMDSIM_PARAMETER_(variable, MIMDSIM_CHOICE, int, "", choices, 0, 0, doc)

/* A variable of another type than the kind's is a warning in C and an error in C++. */
#define MIMDSIM_PARAMETER_(variable, kind, type, unit, choices, least, most, doc)                  \
    {#variable, kind, 0, 1 ? &variable : (type *)0, unit, choices, least, most, doc}

/* --- who and where --- */

/* comm_rank, comm_size: this rank's number, 0 .. size - 1, and how many ranks there are. In a
 * serial code and in check 0 and 1. comm_run_size: how many ranks the run has, there as well. */
int comm_rank(const struct comm *c);
int comm_size(const struct comm *c);
int comm_run_size(const struct comm *c);

/* --- messages --- */

/* A pending operation: source, tag, bytes and truncated tell of a message that was received. Start
 * from {0}; it must stay in place until its wait. */
#define comm_request mimdsim_request

enum { COMM_ANY_SOURCE = -1 };

/* comm_send: send `bytes` bytes of `data` to rank `to` with `tag` (0 .. 2^30 - 1). The data are
 * copied before return, and the rank goes on whatever the receiver does: two ranks that send to
 * each other first do not deadlock. */
#define comm_send(c, to, tag, data, bytes)                                                         \
    comm_isend_at((c), (to), (tag), (data), (bytes), 0, NULL, __FILE__, __LINE__)

/* comm_isend: the same, and *r is complete when the software of the sender is done with the
 * message: of one that is too large to be sent eagerly when the receiver has asked for it.
 * comm_issend: complete when its receive has begun; for programs that declare .wildcards = 1. */
#define comm_isend(c, to, tag, data, bytes, r)                                                     \
    comm_isend_at((c), (to), (tag), (data), (bytes), 0, (r), __FILE__, __LINE__)
#define comm_issend(c, to, tag, data, bytes, r)                                                    \
    comm_isend_at((c), (to), (tag), (data), (bytes), 1, (r), __FILE__, __LINE__)

/* comm_recv: wait for the message of exactly `bytes` bytes from rank `from` with `tag`, into
 * `buffer`. Messages of one sender with one tag arrive in the order in which they were sent.
 * comm_irecv: the same in two parts; the buffer is filled when the wait for *r returns. */
#define comm_recv(c, from, tag, buffer, bytes)                                                     \
    comm_recv_at((c), (from), (tag), (buffer), (bytes), __FILE__, __LINE__)
#define comm_irecv(c, from, tag, buffer, bytes, r)                                                 \
    comm_irecv_at((c), (from), (tag), (buffer), (bytes), (r), __FILE__, __LINE__)

/* comm_irecv_matching: of the messages from rank `from`, or from all with COMM_ANY_SOURCE, the
 * first whose tag agrees with `tag` in the bits of `mask` (-1: the same tag, 0: any), of up to
 * `capacity` bytes; r->source, tag and bytes say after the wait which it was. For programs that
 * declare .wildcards = 1, as all below up to comm_cancel. */
#define comm_irecv_matching(c, from, tag, mask, buffer, capacity, r)                               \
    comm_irecv_matching_at((c), (from), (tag), (mask), (buffer), (capacity), (r), __FILE__,        \
                           __LINE__)

/* comm_wait: return when *r is complete. comm_waitall: when all n of the array r are. */
#define comm_wait(c, r) comm_wait_at((c), (r), __FILE__, __LINE__)
#define comm_waitall(c, n, r) comm_waitall_at((c), (n), (r), __FILE__, __LINE__)

/* comm_test: 1 when *r is complete now, else 0; asking takes simulated time, so that a loop of
 * tests ends. */
#define comm_test(c, r) comm_test_at((c), (r), __FILE__, __LINE__)

/* comm_wait_any: wait until one of the n requests that r points to is complete, and return its
 * place; NULL and complete ones are passed over; -1 when there is nothing to wait for.
 * comm_test_any: the same without waiting; -1: none now. */
#define comm_wait_any(c, n, r) comm_wait_any_at((c), (n), (r), 1, __FILE__, __LINE__)
#define comm_test_any(c, n, r) comm_wait_any_at((c), (n), (r), 0, __FILE__, __LINE__)

/* comm_probe: wait until a message is there that comm_irecv_matching would receive, and tell of it
 * in *out without receiving it. comm_iprobe: do not wait; 1 when one is there, else 0. */
#define comm_probe(c, from, tag, mask, out)                                                        \
    comm_probe_at((c), (from), (tag), (mask), 1, (out), __FILE__, __LINE__)
#define comm_iprobe(c, from, tag, mask, out)                                                       \
    comm_probe_at((c), (from), (tag), (mask), 0, (out), __FILE__, __LINE__)

/* comm_cancel: take back a receive that no message has matched yet; 1 when it was taken back. */
#define comm_cancel(c, r) comm_cancel_at((c), (r), __FILE__, __LINE__)

/* --- collectives: every rank calls, in the same order --- */

/* How numbers are combined: doubles, or int64_t where the name says so. */
enum comm_op {
    COMM_SUM,
    COMM_PRODUCT,
    COMM_MIN,
    COMM_MAX,
    COMM_SUM_INT64,
    COMM_PRODUCT_INT64,
    COMM_MIN_INT64,
    COMM_MAX_INT64
};

/* comm_barrier: return when every rank has entered, by hardware or messages as the machine has
 * it. */
#define comm_barrier(c) comm_barrier_at((c), __FILE__, __LINE__)

/* comm_broadcast: `bytes` bytes of `data`, in on rank `root`, out on all others. */
#define comm_broadcast(c, root, data, bytes)                                                       \
    comm_broadcast_at((c), (root), (data), (bytes), __FILE__, __LINE__)

/* comm_reduce: recv[i] on rank `root` = send[i] of all ranks combined, i < n numbers; recv is NULL
 * elsewhere. comm_allreduce: data[i] = data[i] of all ranks combined, the same bits on all.
 * comm_scan: of ranks 0 .. own; comm_exscan: of ranks 0 .. own - 1, and rank 0's data stay as they
 * are. */
#define comm_reduce(c, root, op, send, recv, n)                                                    \
    comm_reduce_at((c), (root), (op), (send), (recv), (n), __FILE__, __LINE__)
#define comm_allreduce(c, op, data, n) comm_allreduce_at((c), (op), (data), (n), __FILE__, __LINE__)
#define comm_scan(c, op, data, n) comm_scan_at((c), (op), (data), (n), 0, __FILE__, __LINE__)
#define comm_exscan(c, op, data, n) comm_scan_at((c), (op), (data), (n), 1, __FILE__, __LINE__)

/* comm_gather: recv on rank `root` = the blocks `send` of all ranks, each `bytes` long, in the
 * order of ranks; NULL elsewhere. comm_scatter: recv = the own block of those that `send` holds on
 * rank `root`. comm_allgather: as comm_gather, on all ranks. comm_alltoall: block i of recv = block
 * `own rank` of rank i's send. */
#define comm_gather(c, root, send, bytes, recv)                                                    \
    comm_gather_at((c), (root), (send), (bytes), (recv), __FILE__, __LINE__)
#define comm_scatter(c, root, send, bytes, recv)                                                   \
    comm_scatter_at((c), (root), (send), (bytes), (recv), __FILE__, __LINE__)
#define comm_allgather(c, send, bytes, recv)                                                       \
    comm_allgather_at((c), (send), (bytes), (recv), __FILE__, __LINE__)
#define comm_alltoall(c, send, bytes, recv)                                                        \
    comm_alltoall_at((c), (send), (bytes), (recv), __FILE__, __LINE__)

/* comm_alltoallv: blocks of different sizes, one behind the other: send_bytes[i] to rank i,
 * recv_bytes[i] from it. */
#define comm_alltoallv(c, send, send_bytes, recv, recv_bytes)                                      \
    comm_alltoallv_at((c), (send), (send_bytes), (recv), (recv_bytes), __FILE__, __LINE__)

/* What a rank says at the end of a step of a search. */
enum comm_search_state {
    COMM_SEARCH_GOES_ON,   /* nothing found yet, more to look at */
    COMM_SEARCH_FOUND,     /* this rank has found what all look for */
    COMM_SEARCH_EXHAUSTED, /* nothing left to look at */
    COMM_SEARCH_BEGIN
};

/* comm_search_begin: all ranks begin to search, each for itself. comm_search: this rank is at the
 * end of a step; 0: go on; 2: found, by this rank and perhaps by others; 1: found by others alone;
 * -1: nobody has found anything and nobody has anything left. Every rank calls until it gets
 * something else than 0. For programs that declare .wildcards = 1.
 *
 * On a machine with an eureka (docs/collectives.md) the first rank that finds something interrupts
 * all others: a step that was not over then takes time until the signal only, and what it found
 * does not count. On all other machines the ranks ask each other after each step. */
#define comm_search_begin(c) ((void)comm_search((c), COMM_SEARCH_BEGIN))
#define comm_search(c, state) comm_search_at((c), (state), __FILE__, __LINE__)

/* comm_algorithm: from now on this rank's collectives called `collective` ("allreduce",
 * "broadcast", ...) run by the algorithm `name` of docs/collectives.md; "auto": as the machine
 * states. The same on every rank. */
#define comm_algorithm(c, collective, name)                                                        \
    comm_algorithm_at((c), (collective), (name), __FILE__, __LINE__)

/* --- computing, time, stages --- */

/* For programs that declare .cost = MIMDSIM_COST_AUTHOR: what the computing that was just done, or
 * is about to be done, costs. comm_compute: `flops` additions and multiplications, and `bytes`
 * bytes moved between memory and processor. comm_count: operations by class. Others need neither:
 * their computing is counted by the compiler, and these calls then cost nothing. */
void comm_compute(struct comm *c, double flops, double bytes);
#define comm_counts mimdsim_counts
void comm_count(struct comm *c, const struct comm_counts *w);

/* comm_time: this rank's simulated time since the run began [s]. comm_now_ps: the same, exactly
 * [ps]. */
double comm_time(struct comm *c);
int64_t comm_now_ps(struct comm *c);

/* comm_stage: what follows belongs to stage number `stage` of the list .stage. */
#define comm_stage(c, stage) comm_stage_at((c), (stage), __FILE__, __LINE__)

/* --- memory, results, failure --- */

/* comm_memory: `bytes` bytes, zeroed, aligned to 64, given back when the run is over. Takes no
 * simulated time. Never NULL: a run that wants more than there is has failed. */
#define comm_memory(c, bytes) comm_memory_at((c), (bytes), __FILE__, __LINE__)

/* comm_publish: the elements first .. first + n - 1 of result number `output` of the list .output.
 * Takes no simulated time. Each element is published by one rank; a result is as long as its last
 * element's place says, and an element that nobody published makes the run invalid. */
#define comm_publish(c, output, first, n, data)                                                    \
    comm_publish_at((c), (output), (first), (n), (data), __FILE__, __LINE__)

/* comm_output: for check: the *n numbers of result number `output`, as the ranks published them;
 * NULL and 0 when none did. */
#define comm_output(c, output, n) comm_output_at((c), (output), (n), __FILE__, __LINE__)

/* comm_error: for check: the relative error of a result, or of whatever `quantity` (at most 23
 * letters) calls it. Above the program's tolerance, or not a number, it makes the run invalid. */
#define comm_error(c, quantity, relative)                                                          \
    comm_error_at((c), (quantity), (relative), __FILE__, __LINE__)

/* comm_fail: end the run as failed, with a text as printf makes it. Does not return. */
#define comm_fail(c, ...) comm_fail_at((c), __FILE__, __LINE__, __VA_ARGS__)

/* --- the functions behind the macros --- */

void comm_isend_at(struct comm *c, int to, int64_t tag, const void *data, int64_t bytes,
                   int synchronous, struct comm_request *r, const char *file, int line);
void comm_recv_at(struct comm *c, int from, int64_t tag, void *buffer, int64_t bytes,
                  const char *file, int line);
void comm_irecv_at(struct comm *c, int from, int64_t tag, void *buffer, int64_t bytes,
                   struct comm_request *r, const char *file, int line);
void comm_irecv_matching_at(struct comm *c, int from, int64_t tag, int64_t mask, void *buffer,
                            int64_t capacity, struct comm_request *r, const char *file, int line);
void comm_wait_at(struct comm *c, struct comm_request *r, const char *file, int line);
void comm_waitall_at(struct comm *c, int n, struct comm_request *r, const char *file, int line);
int comm_test_at(struct comm *c, struct comm_request *r, const char *file, int line);
int comm_wait_any_at(struct comm *c, int n, struct comm_request **r, int block, const char *file,
                     int line);
int comm_probe_at(struct comm *c, int from, int64_t tag, int64_t mask, int block,
                  struct comm_request *out, const char *file, int line);
int comm_cancel_at(struct comm *c, struct comm_request *r, const char *file, int line);
void comm_barrier_at(struct comm *c, const char *file, int line);
void comm_broadcast_at(struct comm *c, int root, void *data, int64_t bytes, const char *file,
                       int line);
void comm_reduce_at(struct comm *c, int root, enum comm_op op, const void *send, void *recv,
                    int64_t n, const char *file, int line);
void comm_allreduce_at(struct comm *c, enum comm_op op, void *data, int64_t n, const char *file,
                       int line);
void comm_scan_at(struct comm *c, enum comm_op op, void *data, int64_t n, int exclusive,
                  const char *file, int line);
void comm_gather_at(struct comm *c, int root, const void *send, int64_t bytes, void *recv,
                    const char *file, int line);
void comm_scatter_at(struct comm *c, int root, const void *send, int64_t bytes, void *recv,
                     const char *file, int line);
void comm_allgather_at(struct comm *c, const void *send, int64_t bytes, void *recv,
                       const char *file, int line);
void comm_alltoall_at(struct comm *c, const void *send, int64_t bytes, void *recv, const char *file,
                      int line);
void comm_alltoallv_at(struct comm *c, const void *send, const int64_t *send_bytes, void *recv,
                       const int64_t *recv_bytes, const char *file, int line);
int comm_search_at(struct comm *c, enum comm_search_state state, const char *file, int line);
void comm_algorithm_at(struct comm *c, const char *collective, const char *name, const char *file,
                       int line);
void comm_stage_at(struct comm *c, int stage, const char *file, int line);
void *comm_memory_at(struct comm *c, int64_t bytes, const char *file, int line);
void comm_publish_at(struct comm *c, int output, int64_t first, int64_t n, const double *data,
                     const char *file, int line);
const double *comm_output_at(struct comm *c, int output, int64_t *n, const char *file, int line);
void comm_error_at(struct comm *c, const char *quantity, double relative, const char *file,
                   int line);
__attribute__((noreturn, format(printf, 4, 5))) void
comm_fail_at(struct comm *c, const char *file, int line, const char *format, ...);

#ifdef __cplusplus
}
#endif

#endif
