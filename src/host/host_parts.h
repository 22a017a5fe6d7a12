/* host_parts.h - what the files of room host share: the state of a rank, its pending operations.
 *
 * Private to host_*.c. */
#ifndef HOST_HOST_PARTS_H
#define HOST_HOST_PARTS_H

#include "base/text.h"
#include "host/host_comm.h"
#include "hosts/lane.h"

/* FAR_TAGS: tags from here on belong to barriers and to the collectives of people's own programs
 * (vp/vp_comm.c, guest/guest_comm.c); FAR of them are used. MPI's tags may end below: they become
 * its last ones. */
enum { FAR_TAGS = 1 << 30, FAR = 64 };

/* A message on its way out or in. Nodes are kept for the next messages when they are done. */
struct host_pending {
    struct hosts_request mpi;
    bool send, done;
    bool held;          /* a request of the program refers to it */
    char *copy;         /* (room) data of a send, or a message that no receive has taken */
    size_t room, bytes; /* bytes: of the message */
    int from;           /* of a message that came; COMM_ANY_SOURCE: a receive from any */
    int64_t tag, mask;  /* of a receive here: which tags it takes */
    uint64_t order;     /* of completion; 0: not complete */
    struct comm_request *request; /* of a receive that is posted here */
    struct host_pending *next;
};

/* A list that knows its end, in the order in which things came. */
struct host_list {
    struct host_pending *first, **end; /* end NULL: empty, never used */
};

struct host_comm {
    struct comm comm;          /* first: what the program has */
    const struct hosts *hosts; /* NULL: one rank alone */
    struct lane lane;
    int largest_tag;
    bool one_clock, timed, running;
    uint64_t completed; /* operations so far, to order them */

    int stage, nstage;
    int64_t mark_ns; /* since when the time belongs to `stage` */
    int64_t paused_ns; /* since when the clock stands */
    int64_t switches, faults; /* of this thread when the clock began */
    struct host_times times;

    char *warm; /* data of messages that are sent before the clock runs */

    struct host_list sent;    /* sends that nobody waits for */
    struct host_list posted;  /* timed: receives without a message */
    struct host_list arrived; /* timed: messages without a receive */
    struct host_pending *spare;

    struct text places;  /* of what was published: struct host_place, one after the other */
    struct text numbers; /* of what was published: doubles */
};

/* One publication: `at` is the place of its first number among all. */
struct host_place {
    int64_t output, first, n, at;
};

/* host_pending_new: a node with room for `room` bytes. host_pending_free: for the next one. */
struct host_pending *host_pending_new(struct host_comm *h, size_t room);
void host_pending_free(struct host_comm *h, struct host_pending *p);

/* host_list_add, host_list_remove: at the end; wherever it is (*at is the pointer to it). */
void host_list_add(struct host_list *l, struct host_pending *p);
struct host_pending *host_list_remove(struct host_list *l, struct host_pending **at);

/* host_stop: the program, or MPI, has failed: say why and end all processes. */
_Noreturn void host_stop(struct host_comm *h, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* host_tag: the tag that MPI gets for a program's; host_tag_back: the other way. */
int host_tag(struct host_comm *h, int64_t tag);
int64_t host_tag_back(const struct host_comm *h, int tag);

/* host_test_send: whether a send is done, its order of completion set. */
bool host_test_send(struct host_comm *h, struct host_pending *p);

/* host_finish: the request's operation is done: its facts are told, its node is given back. */
void host_finish(struct host_comm *h, struct comm_request *r);

/* The functions of comm_match.h, and receives of programs that need them (host_match.c). */
void host_match_receive(struct comm *c, int src, int64_t tag, int64_t mask, void *buffer,
                        int64_t capacity, struct comm_request *r);
void host_match_wait(struct host_comm *h, struct comm_request *r);
int host_match_any(struct comm *c, int n, struct comm_request *const *r, int block);
int host_match_probe(struct comm *c, int src, int64_t tag, int64_t mask, int block,
                     struct comm_envelope *out, struct comm_request *take);
void host_match_into(struct comm *c, struct comm_request *r, void *buffer, int64_t capacity);
int host_match_cancel(struct comm *c, struct comm_request *r);

/* host_warm_messages: every process has exchanged messages with every other (of more than 16: with
 * those at distances of powers of two), so many at once and so large that MPI's memory for them is
 * there; by all processes together. False: MPI reports an
 * error. */
bool host_warm_messages(struct host_comm *h);

/* host_warm_caches: every process has just exchanged two messages of 64 KiB with its neighbours, by
 * all together, after host_warm_messages. The first large message after other work takes 40 us
 * more than the next ones. False: MPI reports an error. */
bool host_warm_caches(struct host_comm *h);

/* host_match_drain: throw away what nobody received; whether there was anything. */
bool host_match_drain(struct host_comm *h);

#endif
