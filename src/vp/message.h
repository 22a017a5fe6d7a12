/* message.h - messages between virtual processors: their states, the pool, matching, and the
 * hand-shake of large ones. */
#ifndef VP_MESSAGE_H
#define VP_MESSAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "comm/comm.h"
#include "net/net.h"
#include "sim/sim.h"

struct vp;
struct world;

struct unmatched;

/* States of comm_request.active. COMING: a request to send is bound, its data are not here; TAKEN:
 * bound by a probe and still without a buffer. */
enum {
    REQUEST_DONE,
    REQUEST_POSTED,
    REQUEST_COMING,
    REQUEST_MATCHED,
    REQUEST_SENDING,
    REQUEST_SENT,
    REQUEST_DELIVERED,
    REQUEST_TAKEN
};

/* comm_request.kind of receives: any size up to the room, exactly that size, or a look that takes
 * nothing. */
enum { RECEIVE_MATCHING, RECEIVE_EXACT, RECEIVE_PROBE };

enum message_kind { MESSAGE_EAGER, MESSAGE_REQUEST_TO_SEND, MESSAGE_CLEAR_TO_SEND, MESSAGE_DATA };

struct message {
    struct net_message net; /* first */
    union {
        struct message *next;        /* in the mailbox, or in the pool */
        struct unmatched *unmatched; /* timed programs, until a receive has taken it */
    };
    struct vp *from, *to;
    struct comm_request *send, *receive; /* rendezvous: both ends' requests */
    int64_t bytes;                       /* of the kernel's data */
    sim_ps sent;                         /* when the send began; for spans */
    sim_ps delay;                        /* rendezvous: contention of the hand-shake */
    sim_ps copied;        /* when the sender's engine has copied it; 0: there is none */
    int64_t tag;
    uint32_t copied_path; /* node of `copied` */
    uint16_t size_class;
    uint8_t kind;
    bool synchronous : 1; /* its sender waits until it is taken, whatever its size */
    bool hollow : 1;      /* it has a size and no content */
    char data[];
};
_Static_assert(sizeof(struct message) <= 152, "several for each rank wait to be received");

/* by 16 bytes up to 4 KiB, by quarters of an octave up to 4 PiB */
enum { MESSAGE_CLASSES = 257 + 4 * 40 };

/* message_key: orders events of messages at one time by sender, then by count. */
static inline uint64_t message_key(const struct message *m)
{
    return (uint64_t)(m->net.id >> 32 & 0xffffff) << 24 | (uint64_t)(m->net.id & 0xffffff);
}

/* message_source: the rank of its job that sent m, which its number tells without a look at the
 * sender. */
static inline int message_source(const struct message *m)
{
    return (int)(m->net.id >> 32 & NET_ID_RANKS);
}

/* --- pool.c --- */

struct message_depot;

/* Messages that nobody uses. Each host thread has a pool of its own; `depot` joins those of a run
 * with several. */
struct message_pool {
    struct arena *arena; /* where new ones come from; borrowed */
    struct message *free[MESSAGE_CLASSES];
    struct message_depot *depot; /* borrowed; NULL: one thread. The rest is for several: */
    struct message *full[MESSAGE_CLASSES]; /* one more list, of a fixed length, or NULL */
    int count[MESSAGE_CLASSES];            /* length of `free` */
};

/* message_take: a message with room for `bytes` bytes, all zero but for its size; message_give:
 * back to the pool. */
struct message *message_take(struct message_pool *p, int64_t bytes);
void message_give(struct message_pool *p, struct message *m);

/* message_depot_create, message_depot_destroy: where threads that receive more than they send leave
 * messages for the others. The caller owns it; destroy accepts NULL. */
struct message_depot *message_depot_create(void);
void message_depot_destroy(struct message_depot *d);

/* --- mailbox.c --- */

/* message_fits: whether the receive r may take m. */
static inline bool message_fits(const struct message *m, int source, const struct comm_request *r)
{
    return (source == r->peer || r->peer < 0) && ((m->tag ^ r->tag) & r->mask) == 0;
}

/* message_bind: r has found m at `now`, the later of posting and arrival; wakes its owner v. */
void message_bind(struct vp *v, struct comm_request *r, struct message *m, sim_ps now);

/* mailbox_post: bind `r` to the first message that matches, or append it to the posted receives. */
void mailbox_post(struct vp *v, struct comm_request *r);

/* mailbox_deliver: bind `m` to the first posted receive that matches, or keep it as unexpected. */
void mailbox_deliver(struct vp *v, struct message *m);

/* --- rendezvous.c --- */

/* rendezvous_send: the first step of a message too large to be sent eagerly. */
void rendezvous_send(struct vp *v, struct message *m, struct comm_request *r);

/* rendezvous_matched: the receiver has bound a request to send. `now`: the later of posting and
 * arrival. */
void rendezvous_matched(struct message *m, struct comm_request *r, sim_ps now);

/* rendezvous_deliver: a clear-to-send or the data have arrived. */
void rendezvous_deliver(struct message *m);

#endif
