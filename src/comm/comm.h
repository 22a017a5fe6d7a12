/* comm.h - the only face of the machine that a kernel sees: ranks, messages, computing, stages.
 *
 * A kernel written against this header runs on virtual processors (room vp), on one rank without
 * any simulator (comm_serial.h), and could run on MPI. Messages match by (source, tag) in the order
 * sent, as MPI's; wildcards, tests and probes are in comm_match.h, which this header includes. What
 * a program does wrong (a peer that does not exist) is a CHECK in a built-in one and ends the run
 * of a foreign one as comm_fail does. */
#ifndef COMM_COMM_H
#define COMM_COMM_H

#include <stddef.h>
#include <stdint.h>

#include "base/work.h"
#include "comm/comm_type.h"

/* comm_rank, comm_size: 0 .. size-1. */
static inline int comm_rank(const struct comm *c) { return c->rank; }
static inline int comm_size(const struct comm *c) { return c->size; }

/* comm_isend: start sending `bytes` bytes of `data` to `dst` with `tag` (>= 0). The data are copied
 * before return; r completes when the sender's software is done with the message. r may be NULL for
 * an eager, forgotten send. data NULL: the message has a size and no content; it takes its time and
 * leaves the receiver's buffer as it was. */
#define comm_isend(c, dst, tag, data, bytes, r)                                                    \
    (COMM_HERE(c), (c)->type->isend((c), (dst), (tag), (data), (bytes), (r)))

/* comm_irecv: post a receive of exactly `bytes` bytes from `src` with `tag` into `buffer`, valid
 * until its wait. */
#define comm_irecv(c, src, tag, buffer, bytes, r)                                                  \
    (COMM_HERE(c), (c)->type->irecv((c), (src), (tag), (buffer), (bytes), (r)))

/* comm_wait: return when r is complete; a receive's data are then in its buffer and o_r is
 * charged. */
#define comm_wait(c, r) (COMM_HERE(c), (c)->type->wait((c), (r)))

/* comm_waitall: wait for n requests in the order given. */
#define comm_waitall(c, n, r)                                                                      \
    do {                                                                                           \
        for (int comm_i_ = 0; comm_i_ < (n); comm_i_++) comm_wait((c), &(r)[comm_i_]);             \
    } while (0)

/* comm_send: a send whose completion nobody waits for. comm_recv: irecv and wait. */
#define comm_send(c, dst, tag, data, bytes) comm_isend((c), (dst), (tag), (data), (bytes), NULL)
#define comm_recv(c, src, tag, buffer, bytes)                                                      \
    do {                                                                                           \
        struct comm_request comm_r_;                                                               \
        comm_irecv((c), (src), (tag), (buffer), (bytes), &comm_r_);                                \
        comm_wait((c), &comm_r_);                                                                  \
    } while (0)

/* comm_barrier: return when every rank has entered; hardware barrier or messages, as the machine
 * has it. */
#define comm_barrier(c) (COMM_HERE(c), (c)->type->barrier((c)))

/* comm_meet: a collective that the network itself does (c->hardware): return on all ranks when
 * every rank has called and the network is done. Ranks that disagree about it end the run. */
#define comm_meet(c, m) (COMM_HERE(c), (c)->type->meet((c), (m)))

/* comm_work: advance this rank's clock by what `w` costs on the node, and count it. */
static inline void comm_work(struct comm *c, const struct work *w) { c->type->work(c, w); }

/* comm_elapse: advance this rank's clock by `ps` >= 0 of computing whose time is known [ps]. */
static inline void comm_elapse(struct comm *c, int64_t ps) { c->type->elapse(c, ps); }

/* comm_fail: this rank's program has failed, `text` says why. The run ends RUN_FAILED with rank,
 * simulated time, stage, call site and text; the call does not return. */
static inline _Noreturn void comm_fail_here(struct comm *c, const char *text)
{
    c->type->end_run(c, text);
    __builtin_unreachable();
}
#define comm_fail(c, text) (COMM_HERE(c), comm_fail_here((c), (text)))

/* comm_stage: the following time belongs to stage number `stage` (index into the kernel's list of
 * stage names). */
static inline void comm_stage(struct comm *c, int stage) { c->type->stage(c, stage); }

/* comm_now_ps: this rank's clock [ps]; 0 where nothing is simulated. For micro-benchmarks. */
static inline int64_t comm_now_ps(struct comm *c) { return c->type->now_ps(c); }

/* comm_publish: hand the elements first .. first + n - 1 of output number `output` (the program's
 * list) to whoever started the program; costs no simulated time. Each element is published by one
 * rank. */
static inline void comm_publish(struct comm *c, int output, int64_t first, int64_t n,
                                const double *data)
{
    c->type->publish(c, output, first, n, data);
}

/* comm_wanted: whether anybody asks for that output; what nobody wants need not be published. */
static inline int comm_wanted(const struct comm *c, int output)
{
    return output < c->noutput && c->output[output].x != NULL;
}

/* comm_publish_here: comm_publish where ranks share the memory of c->output. */
void comm_publish_here(struct comm *c, int output, int64_t first, int64_t n, const double *data);

#include "comm/comm_match.h"

#endif
