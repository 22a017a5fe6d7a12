/* comm_match.h - wildcards, tests, probes, synchronous sends: the part of comm.h that depends on
 * time.
 *
 * Which message a receive from any source takes depends on when messages arrive: it takes the first
 * that has arrived, or then arrives, in the order of arrival, then of (sender, count). Messages of
 * one sender do not overtake each other where the same receive fits both, and of two receives that
 * fit a message the one posted first takes it, as in MPI. Programs that use COMM_ANY_SOURCE, tests,
 * cancel or probes say so (`timed` of vp/world.h, rank_program); in others they end the run as
 * comm_fail. Receives from a given source are known without asking for the time.
 *
 * A test or probe without success costs the time of a poll. Polls that follow each other take
 * longer and longer, as if many had been made, but end when what is asked for is there. */
#ifndef COMM_COMM_MATCH_H
#define COMM_COMM_MATCH_H

#include "comm/comm_type.h"

enum { COMM_ANY_SOURCE = -1 };

#define COMM_WHOLE_TAG INT64_MAX /* the mask of receives that want one tag */

/* What a probe tells of a message. */
struct comm_envelope {
    int source;
    int64_t tag, bytes;
};

/* comm_irecv_matching: post a receive of the first message from `src` (COMM_ANY_SOURCE: from any)
 * whose tag t satisfies ((t ^ tag) & mask) == 0, into buffer with room for `capacity` bytes. When
 * it is complete, r->peer, r->tag and r->bytes are the message's; one longer than the room is cut,
 * sets r->truncated, and r->bytes is its full size. */
#define comm_irecv_matching(c, src, tag, mask, buffer, capacity, r)                                \
    (COMM_HERE(c), (c)->type->irecv_matching((c), (src), (tag), (mask), (buffer), (capacity), (r)))

/* comm_isend_synchronous: comm_isend whose request completes when a receive has taken the message,
 * by a hand-shake whatever the size. r not NULL. In programs that are not `timed` only on machines
 * that have hand-shakes anyway. */
#define comm_isend_synchronous(c, dst, tag, data, bytes, r)                                        \
    (COMM_HERE(c), (c)->type->isend_synchronous((c), (dst), (tag), (data), (bytes), (r)))

/* comm_wait_any: wait until one of the n requests *r[i] is complete, finish it as comm_wait and
 * return its index; of several the one complete first, then the lowest. Entries NULL or inactive
 * are passed over; -1 when all are. comm_test_any: the same without waiting, -1: none is complete
 * now. */
#define comm_wait_any(c, n, r) (COMM_HERE(c), (c)->type->complete_any((c), (n), (r), 1))
#define comm_test_any(c, n, r) (COMM_HERE(c), (c)->type->complete_any((c), (n), (r), 0))

/* comm_test: 1 when r is complete (or inactive), finished as by comm_wait; 0 when it is not. */
static inline int comm_test_here(struct comm *c, struct comm_request *r)
{
    return !r->active || c->type->complete_any(c, 1, &r, 0) == 0;
}
#define comm_test(c, r) (COMM_HERE(c), comm_test_here((c), (r)))

/* comm_probe: whether a message that comm_irecv_matching(src, tag, mask) would take is there: 1 and
 * its envelope in *out, or 0. block: wait until there is one. It stays where it is. */
#define comm_probe(c, src, tag, mask, block, out)                                                  \
    (COMM_HERE(c), (c)->type->probe((c), (src), (tag), (mask), (block), (out), NULL))

/* comm_probe_take: comm_probe that binds the message to r: no other receive or probe sees it.
 * comm_receive_into gives r its buffer, with room for `capacity` bytes; then comm_wait, as ever. */
#define comm_probe_take(c, src, tag, mask, block, out, r)                                          \
    (COMM_HERE(c), (c)->type->probe((c), (src), (tag), (mask), (block), (out), (r)))
#define comm_receive_into(c, r, buffer, capacity)                                                  \
    (COMM_HERE(c), (c)->type->receive_into((c), (r), (buffer), (capacity)))

/* comm_watch: r joins the requests that comm_next_complete looks after; it stays in place, and
 * nobody else waits for it. For programs with many requests under way, since neither call goes
 * through all. comm_next_complete: the watched request that is complete first, if it is so by
 * `time_ps`: finished as by comm_wait, and not watched any more. NULL: none, and the clock is at
 * least at `time_ps`; with INT64_MAX: nothing is watched. It costs no poll. */
#define comm_watch(c, r) (COMM_HERE(c), (c)->type->watch((c), (r)))
#define comm_next_complete(c, time_ps) (COMM_HERE(c), (c)->type->next_complete((c), (time_ps)))

/* comm_cancel: take back a receive; 1 when no message had arrived for it by now, and r is inactive
 * then; 0 when one had: r is as before, to be waited for. Sends are never taken back. */
#define comm_cancel(c, r) (COMM_HERE(c), (c)->type->cancel((c), (r)))

#endif
