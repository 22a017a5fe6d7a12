/* mailbox.c - messages and receives find each other by (source, tag), in the order sent and the order posted.
 *
 * Used by programs that have promised to do without wildcards and tests (world_load.timed
 * = false): what a receive takes then follows from the order of sends and receives alone,
 * not from time, and no event is needed to match. */
#include <string.h>

#include "base/check.h"
#include "vp/explain.h"
#include "vp/vp.h"

enum { CLASS_BYTES = 64, SMALL_CLASSES = 65, CHUNK_MESSAGES = 64 };

/* Of more than 4 KiB: the class of the next quarter of an octave, whose size *bytes
 * becomes. Quarters of an octave waste at most a quarter of a block, and 160 classes
 * reach as far as 2^52 bytes. */
static int large_class(int64_t *bytes)
{
    const int octave = 63 - __builtin_clzll((uint64_t)*bytes - 1); /* 2^octave <= bytes - 1 */
    const int64_t quarter = (INT64_C(1) << octave) / 4, n = (*bytes + quarter - 1) / quarter; /* 5 .. 8 */
    *bytes = n * quarter;
    return SMALL_CLASSES + (octave - 12) * 4 + (int)n - 5;
}

/* Small messages come 64 at a time from the arena of the run, in 16 bytes' alignment; a
 * chunk is never given back before the run ends. */
static struct message *refill(struct world *w, int class)
{
    size_t size = sizeof(struct message) + (size_t) class * CLASS_BYTES;
    size = (size + 15) / 16 * 16;
    char *chunk = arena_take(w->scratch, size_product(size, CHUNK_MESSAGES));
    struct message *head = NULL;
    for (int k = CHUNK_MESSAGES - 1; k >= 0; k--) {
        struct message *m = (struct message *)(chunk + size * (size_t)k);
        m->next = head;
        head = m;
    }
    return head;
}

/* Large ones come one by one: a chunk of 64 of a megabyte would be a waste. */
static struct message *alone(struct world *w, int64_t bytes)
{
    struct message *m = arena_take(w->scratch, sizeof *m + (size_t)bytes);
    m->next = NULL;
    return m;
}

struct message *message_take(struct world *w, int64_t bytes)
{
    int64_t class = (bytes + CLASS_BYTES - 1) / CLASS_BYTES, room = bytes;
    struct message *m;
    if (class >= SMALL_CLASSES) class = large_class(&room);
    CHECK(class < MESSAGE_CLASSES);
    if (!w->free_message[class])
        w->free_message[class] = class < SMALL_CLASSES ? refill(w, (int)class) : alone(w, room);
    m = w->free_message[class];
    w->free_message[class] = m->next;
    /* Only the head is cleared: the sender writes all of the data, or says that there are
     * none. */
    memset(m, 0, sizeof *m);
    /* The class says where it returns to, wherever it ends. */
    m->size_class = (uint16_t) class;
    m->bytes = bytes;
    return m;
}

void message_give(struct world *w, struct message *m)
{
    m->next = w->free_message[m->size_class];
    w->free_message[m->size_class] = m;
}

static inline bool fits(const struct message *m, const struct comm_request *r)
{
    return message_fits(m, m->from->comm.rank, r);
}

void message_bind(struct vp *v, struct comm_request *r, struct message *m, sim_ps now)
{
    /* Kernels say how much they expect; MPI says how much fits. The first is checked, the
     * second is cut. */
    if (r->kind == RECEIVE_EXACT && m->bytes != r->bytes) size_mismatch(v, r, m);
    r->truncated = m->bytes > r->capacity;
    r->bytes = m->bytes;
    r->tag = m->tag;
    r->peer = m->from->comm.rank;
    r->detail = m;
    /* Nothing has come but a request to send: data follow when both ends know of each
     * other (rendezvous.c). */
    if (m->kind == MESSAGE_REQUEST_TO_SEND) {
        r->active = REQUEST_COMING;
        m->receive = r;
        rendezvous_matched(m, r, now);
        return;
    }
    r->active = REQUEST_MATCHED;
    vp_notify(v, r, m->net.arrival);
}

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

/* Messages stand in the order in which they came. Lists are short in programs that post
 * receives early, so they are searched from the start. */
void mailbox_post(struct vp *v, struct comm_request *r)
{
    for (struct message **p = &v->unexpected; *p; p = &(*p)->next) {
        struct message *m = *p;
        if (!fits(m, r)) continue;
        *p = m->next;
        if (!m->next) v->unexpected_end = p;
        message_bind(v, r, m, later(m->net.arrival, r->posted_ps));
        return;
    }
    r->active = REQUEST_POSTED;
    r->detail = NULL;
    *v->posted_end = r;
    v->posted_end = (struct comm_request **)&r->detail;
}

/* Receives stand in the order of posting, and the first that fits takes the message, as
 * MPI orders it (section 3.5). */
void mailbox_deliver(struct vp *v, struct message *m)
{
    for (struct comm_request **p = &v->posted; *p; p = (struct comm_request **)&(*p)->detail) {
        struct comm_request *r = *p;
        if (!fits(m, r)) continue;
        *p = r->detail;
        if (!r->detail) v->posted_end = p;
        message_bind(v, r, m, later(m->net.arrival, r->posted_ps));
        return;
    }
    m->next = NULL;
    *v->unexpected_end = m;
    v->unexpected_end = &m->next;
}
