/* comm_calls.c - the functions of mimdsim/program.h, as they are linked into every program: each
 * hands over the computing time counted so far and calls the simulator.
 *
 * Weak, so that a program that has nothing to do with program.h may use these names for its own
 * functions. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <mimdsim/program.h>

#include "guest.h"

/* The simulator's table, once the clock is right. A program that was not started as one that
 * declares itself, such as one with main, has none. */
static const struct comm_functions *calls(const void *place)
{
    mimdsim_account();
    if (mimdsim_host->comm == NULL)
        guest_fail(place, "calls a function of mimdsim/program.h, but declares no PROGRAM(...)");
    return mimdsim_host->comm;
}
#define CALLS calls(__builtin_return_address(0))

WEAK int comm_rank(const struct comm *c) { return CALLS->rank(c); }
WEAK int comm_size(const struct comm *c) { return CALLS->ranks(c); }
WEAK int comm_run_size(const struct comm *c) { return CALLS->run_ranks(c); }

WEAK void comm_isend_at(struct comm *c, int to, int64_t tag, const void *data, int64_t bytes,
                        int synchronous, struct comm_request *r, const char *file, int line)
{
    CALLS->isend(c, to, tag, data, bytes, synchronous, r, file, line);
}

WEAK void comm_recv_at(struct comm *c, int from, int64_t tag, void *buffer, int64_t bytes,
                       const char *file, int line)
{
    struct comm_request r;
    CALLS->irecv(c, from, tag, buffer, bytes, &r, file, line);
    CALLS->wait(c, &r, file, line);
}

WEAK void comm_irecv_at(struct comm *c, int from, int64_t tag, void *buffer, int64_t bytes,
                        struct comm_request *r, const char *file, int line)
{
    CALLS->irecv(c, from, tag, buffer, bytes, r, file, line);
}

WEAK void comm_irecv_matching_at(struct comm *c, int from, int64_t tag, int64_t mask, void *buffer,
                                 int64_t capacity, struct comm_request *r, const char *file,
                                 int line)
{
    CALLS->irecv_matching(c, from, tag, mask, buffer, capacity, r, file, line);
}

WEAK void comm_wait_at(struct comm *c, struct comm_request *r, const char *file, int line)
{
    CALLS->wait(c, r, file, line);
}

WEAK void comm_waitall_at(struct comm *c, int n, struct comm_request *r, const char *file, int line)
{
    for (int i = 0; i < n; i++) CALLS->wait(c, &r[i], file, line);
}

WEAK int comm_test_at(struct comm *c, struct comm_request *r, const char *file, int line)
{
    return CALLS->test(c, r, file, line);
}

WEAK int comm_wait_any_at(struct comm *c, int n, struct comm_request **r, int block,
                          const char *file, int line)
{
    return CALLS->wait_any(c, n, r, block, file, line);
}

WEAK int comm_probe_at(struct comm *c, int from, int64_t tag, int64_t mask, int block,
                       struct comm_request *out, const char *file, int line)
{
    return CALLS->probe(c, from, tag, mask, block, out, file, line);
}

WEAK int comm_cancel_at(struct comm *c, struct comm_request *r, const char *file, int line)
{
    return CALLS->cancel(c, r, file, line);
}

/* --- collectives --- */

WEAK void comm_barrier_at(struct comm *c, const char *file, int line)
{
    const struct mimdsim_collective k = {.kind = MIMDSIM_BARRIER};
    CALLS->collective(c, &k, file, line);
}

WEAK int comm_search_at(struct comm *c, enum comm_search_state state, const char *file, int line)
{
    int answer = 0;
    const struct mimdsim_collective k = {.kind = MIMDSIM_SEARCH, .op = state, .recv = &answer};
    CALLS->collective(c, &k, file, line);
    return answer;
}

WEAK void comm_broadcast_at(struct comm *c, int root, void *data, int64_t bytes, const char *file,
                            int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_BROADCAST, .root = root, .recv = data, .n = bytes};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_reduce_at(struct comm *c, int root, enum comm_op op, const void *send, void *recv,
                         int64_t n, const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_REDUCE, .root = root, .op = (int)op, .send = send, .recv = recv, .n = n};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_allreduce_at(struct comm *c, enum comm_op op, void *data, int64_t n,
                            const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_ALLREDUCE, .op = (int)op, .send = data, .recv = data, .n = n};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_scan_at(struct comm *c, enum comm_op op, void *data, int64_t n, int exclusive,
                       const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_SCAN, .op = (int)op, .exclusive = exclusive, .send = data, .recv = data,
        .n = n};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_gather_at(struct comm *c, int root, const void *send, int64_t bytes, void *recv,
                         const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_GATHER, .root = root, .send = send, .recv = recv, .n = bytes};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_scatter_at(struct comm *c, int root, const void *send, int64_t bytes, void *recv,
                          const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_SCATTER, .root = root, .send = send, .recv = recv, .n = bytes};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_allgather_at(struct comm *c, const void *send, int64_t bytes, void *recv,
                            const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_ALLGATHER, .send = send, .recv = recv, .n = bytes};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_alltoall_at(struct comm *c, const void *send, int64_t bytes, void *recv,
                           const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_ALLTOALL, .send = send, .recv = recv, .n = bytes};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_alltoallv_at(struct comm *c, const void *send, const int64_t *send_bytes, void *recv,
                            const int64_t *recv_bytes, const char *file, int line)
{
    const struct mimdsim_collective k = {
        .kind = MIMDSIM_ALLTOALL, .send = send, .recv = recv, .send_bytes = send_bytes,
        .recv_bytes = recv_bytes};
    CALLS->collective(c, &k, file, line);
}

WEAK void comm_algorithm_at(struct comm *c, const char *collective, const char *name,
                            const char *file, int line)
{
    CALLS->algorithm(c, collective, name, file, line);
}

/* --- computing, time, stages, results --- */

WEAK void comm_count(struct comm *c, const struct comm_counts *w) { CALLS->count(c, w); }

WEAK void comm_compute(struct comm *c, double flops, double bytes)
{
    const struct comm_counts w = {.flop = flops > 0 ? (uint64_t)flops : 0,
                                  .bytes = bytes > 0 ? (uint64_t)bytes : 0};
    CALLS->count(c, &w);
}

WEAK int64_t comm_now_ps(struct comm *c) { return CALLS->now_ps(c); }
WEAK double comm_time(struct comm *c) { return (double)CALLS->now_ps(c) * 1e-12; }

WEAK void comm_stage_at(struct comm *c, int stage, const char *file, int line)
{
    CALLS->stage(c, stage, file, line);
}

WEAK void *comm_memory_at(struct comm *c, int64_t bytes, const char *file, int line)
{
    return CALLS->memory(c, bytes, file, line);
}

WEAK void comm_publish_at(struct comm *c, int output, int64_t first, int64_t n, const double *data,
                          const char *file, int line)
{
    CALLS->publish(c, output, first, n, data, file, line);
}

WEAK const double *comm_output_at(struct comm *c, int output, int64_t *n, const char *file,
                                  int line)
{
    return CALLS->output(c, output, n, file, line);
}

WEAK void comm_error_at(struct comm *c, const char *quantity, double relative, const char *file,
                        int line)
{
    CALLS->error(c, quantity, relative, file, line);
}

WEAK void comm_fail_at(struct comm *c, const char *file, int line, const char *format, ...)
{
    char text[512];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    guest_flush();
    CALLS->fail(c, text, file, line);
    __builtin_unreachable();
}
