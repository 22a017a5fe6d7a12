/* messages.h - what a message costs between two processes of this job, by size: measured.
 *
 * The methods are those of Netgauge and LoOgGP (Hoefler et al., "Netgauge: A Network Performance
 * Measurement Framework", 2007; Martinasso and Mehaut, "LoOgGP", 2006): round trips for the time of
 * one message, an isolated send for o_s, a late receive for o_r, trains of messages for g and G.
 * Each number is the median of the samples that the host did not
 * disturb. */
#ifndef REALITY_MESSAGES_H
#define REALITY_MESSAGES_H

#include <stdint.h>

#include "base/err.h"
#include "host/host_comm.h"

enum { MESSAGES_SIZES = 48 };

/* One size [s]. */
struct message_point {
    int64_t bytes;
    double one_way;  /* half a round trip */
    double send;     /* processor time of a send whose receiver is ready: o_s */
    double recv;     /* processor time of a receive whose message is there: o_r */
    double train;    /* from one message to the next in a train: max(o_s, o_r, g + b G) */
    bool rendezvous; /* the send waits for the receive */
    int samples, disturbed;
};

struct messages {
    int n;
    struct message_point point[MESSAGES_SIZES]; /* (n) by rising size */
    int64_t eager_most; /* largest size that is sent at once [B]; -1: none; INT64_MAX: all tried */
    double barrier;     /* MPI's own, of all processes [s] */
};

/* messages_measure: between processes 0 and 1 of a job of two or more; called by all, `out` is the
 * same on all. samples: of each number.
 *
 *   Returns false with ERR_BUSY when the host disturbs so many samples that too few remain, on all
 * processes alike; ERR_INTERNAL when MPI fails. */
bool messages_measure(const struct hosts *hosts, struct host_comm *comm, int samples,
                      struct messages *out, struct err *e);

#endif
