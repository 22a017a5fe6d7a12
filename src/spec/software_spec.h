/* software_spec.h - message software, separate from the wire: constant, by kinds of message, or by
 * segments.
 *
 * LogGP's o and g live here; as in LoOgGP and SMPI they may be piecewise linear in the size. */
#ifndef SPEC_SOFTWARE_SPEC_H
#define SPEC_SOFTWARE_SPEC_H

#include <stdbool.h>
#include <stdint.h>

enum barrier_kind { BARRIER_SOFTWARE, BARRIER_HARDWARE };

enum message_protocol {
    PROTOCOL_EAGER,      /* sent at once; the sender goes on */
    PROTOCOL_RENDEZVOUS, /* request and answer first; the sender goes on when the answer is there */
    PROTOCOL_SYNCHRONOUS /* the same, but who waits for the send is held until the data have arrived
                          */
};

/* Who makes what of a message (vp/offload.h). */
enum offload {
    OFFLOAD_HANDSHAKES, /* large messages shake hands whatever the processors do */
    OFFLOAD_NONE,       /* only while a processor is in message software */
    OFFLOAD_COPIES      /* an engine also makes the copies */
};

enum { SOFTWARE_MAX_SEGMENTS = 8 };

/* Message software of one range of sizes, up to the next segment. In a list of software_spec a time
 * below 0 is not given: it is that of the whole (software_segments). */
struct software_segment {
    int64_t from;                /* smallest message [B] */
    double send_overhead;        /* o_s [s] */
    double send_copy;            /* per byte [s/B] */
    double recv_overhead;        /* o_r [s] */
    double recv_copy;            /* per byte [s/B] */
    double latency;              /* of the interfaces, beside network.end_latency [s] */
    double gap;                  /* g [s] */
    double gap_per_byte;         /* G [s/B] */
    double rendezvous_latency;   /* [s] */
    /* part of o_s that is not paid [s]; not in lists: of short messages */
    double send_saving;
    /* beside recv_copy [s/B]; not in lists: of short and eager messages */
    double recv_extra;
    enum message_protocol protocol;
};

/* Message software, separate from the wire (LogGP's o and g live here). */
struct software_spec {
    double send_overhead;      /* o_s: processor time to send [s] */
    double recv_overhead;      /* o_r: processor time to receive [s] */
    double send_copy;          /* processor time per byte sent [s/B] */
    double recv_copy;          /* processor time per byte received [s/B] */
    /* bytes that a copied byte moves through the memory that ranks share; 0: through none. Acts
     * with the roofline model of nodes */
    double copy_traffic;
    double gap;                /* g: least time between two injections of one node [s] */
    /* G of the network interface [s/B]; the slower of this and the wire rules */
    double gap_per_byte;
    int64_t eager_bytes;       /* larger messages use rendezvous [B]; -1: all eager */
    double rendezvous_latency; /* software time added per hand-shake [s] */
    /* receiver's time per byte of a message that came eagerly, beside recv_copy [s/B] */
    double eager_copy;
    int64_t short_bytes;       /* messages up to this size are short [B]; 0: none is */
    double short_saving;       /* short: part of send_overhead that is not paid [s] */
    double short_copy;         /* short: as eager_copy and in its place [s/B] */
    /* 0: the numbers above hold for all sizes, short and eager ones as said */
    int nsegment;
    /* by rising `from`, the first from 0 B */
    struct software_segment segment[SOFTWARE_MAX_SEGMENTS];
    enum offload offload;
    /* one shared server per machine handles every message (TCP loopback) */
    bool kernel_server;
    double kernel_time;        /* its service time per message end [s] */
    double kernel_per_byte;    /* and per byte [s/B] */
    char collectives[512];     /* rules of comm/collective_rules.h */
    enum barrier_kind barrier;
    double barrier_time;       /* hardware barrier, last arrival to release [s] */
    /* one-sided: what a put costs beside the wire [s]; 0: the machine has none */
    double put_overhead;
    double get_overhead;       /* and a get, beside request and answer [s]; 0: none */
    double shared_latency;     /* channel within a node: latency [s] */
    /* and rate [B/s]; 0: messages within a node use the network's software path */
    double shared_bandwidth;
};

/* software_segments: the segments of `s` by rising size into out[SOFTWARE_MAX_SEGMENTS], every
 * number given, the first from 0 B. A list (`software.segments`) as it is, with software's own
 * numbers where it gives none; else what short, eager and rendezvous messages make: one to three.
 * Returns how many. */
int software_segments(const struct software_spec *s, struct software_segment *out);

/* software_segment_of: that of a message of `bytes` among n of software_segments. */
const struct software_segment *software_segment_of(const struct software_segment *segment, int n,
                                                   int64_t bytes);

/* software_eager_most: the size up to which every message is sent at once [B]: -1: none is;
 * INT64_MAX: all are. */
int64_t software_eager_most(const struct software_spec *s);

/* software_all_eager: whether all messages are when none is larger than `largest` [B]; -1: any
 * size. */
bool software_all_eager(const struct software_spec *s, int64_t largest);

#endif
