/* message.h - messages between virtual processors: their states, the pool, matching, and the hand-shake of large ones.
 */
#ifndef VP_MESSAGE_H
#define VP_MESSAGE_H

#include <stdint.h>

#include "comm/comm.h"
#include "net/net.h"
#include "sim/sim.h"

struct vp;
struct world;

/* States of comm_request.active. */
enum { REQUEST_DONE, REQUEST_POSTED, REQUEST_MATCHED, REQUEST_SENDING, REQUEST_SENT, REQUEST_DELIVERED };

enum message_kind { MESSAGE_EAGER, MESSAGE_REQUEST_TO_SEND, MESSAGE_CLEAR_TO_SEND, MESSAGE_DATA };

struct message {
    struct net_message net; /* first */
    struct message *next;
    struct vp *from, *to;
    struct comm_request *send, *receive; /* rendezvous: both ends' requests */
    int64_t bytes;                       /* of the kernel's data */
    sim_ps sent;                         /* when the send began; for spans */
    sim_ps delay;                        /* rendezvous: contention of the hand-shake */
    int tag;
    uint16_t size_class;
    uint16_t kind;
    char data[];
};

enum { MESSAGE_CLASSES = 65 };

/* --- mailbox.c --- */

/* message_take: a message with room for `bytes` bytes, zeroed head; message_give: back to the pool. */
struct message *message_take(struct world *w, int64_t bytes);
void message_give(struct world *w, struct message *m);

/* mailbox_post: bind `r` to the first message that matches, or append it to the posted receives. */
void mailbox_post(struct vp *v, struct comm_request *r);

/* mailbox_deliver: bind `m` to the first posted receive that matches, or keep it as unexpected. */
void mailbox_deliver(struct vp *v, struct message *m);

/* --- rendezvous.c --- */

/* rendezvous_send: the first step of a message too large to be sent eagerly. */
void rendezvous_send(struct vp *v, struct message *m, struct comm_request *r);

/* rendezvous_matched: the receiver has bound a request to send. `now`: the later of posting and arrival. */
void rendezvous_matched(struct message *m, struct comm_request *r, sim_ps now);

/* rendezvous_deliver: a clear-to-send or the data have arrived. */
void rendezvous_deliver(struct message *m);

#endif
