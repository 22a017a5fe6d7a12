/* mailbox.c - messages and receives find each other by (source, tag), in the order sent and the order posted. */
#include <string.h>

#include "base/check.h"
#include "vp/vp.h"

enum { CLASS_BYTES = 64, CHUNK_MESSAGES = 64 };

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

struct message *message_take(struct world *w, int64_t bytes)
{
    int64_t class = (bytes + CLASS_BYTES - 1) / CLASS_BYTES;
    struct message *m;
    if (class < MESSAGE_CLASSES) {
        if (!w->free_message[class]) w->free_message[class] = refill(w, (int)class);
        m = w->free_message[class];
        w->free_message[class] = m->next;
    } else {
        m = arena_take(w->scratch, sizeof *m + (size_t)bytes);
        class = MESSAGE_CLASSES;
    }
    memset(m, 0, sizeof *m);
    m->size_class = (uint16_t) class;
    m->bytes = bytes;
    return m;
}

void message_give(struct world *w, struct message *m)
{
    if (m->size_class == MESSAGE_CLASSES) return; /* large ones are rare: their memory goes with the run */
    m->next = w->free_message[m->size_class];
    w->free_message[m->size_class] = m;
}

static inline bool fits(const struct message *m, const struct comm_request *r)
{
    return m->from->comm.rank == r->peer && m->tag == r->tag;
}

static void bind(struct vp *v, struct comm_request *r, struct message *m)
{
    CHECK(m->bytes == r->bytes); /* the kernel's two ends disagree about the size */
    r->detail = m;
    if (m->kind == MESSAGE_REQUEST_TO_SEND) {
        r->active = REQUEST_POSTED; /* until the data are here */
        m->receive = r;
        rendezvous_matched(m, r, m->net.arrival > v->clock ? m->net.arrival : v->clock);
        return;
    }
    r->active = REQUEST_MATCHED;
    if (v->waiting == r) vp_wake(v->world, v);
}

void mailbox_post(struct vp *v, struct comm_request *r)
{
    for (struct message **p = &v->unexpected; *p; p = &(*p)->next) {
        struct message *m = *p;
        if (!fits(m, r)) continue;
        *p = m->next;
        if (!m->next) v->unexpected_end = p;
        bind(v, r, m);
        return;
    }
    r->active = REQUEST_POSTED;
    r->detail = NULL;
    *v->posted_end = r;
    v->posted_end = (struct comm_request **)&r->detail;
}

void mailbox_deliver(struct vp *v, struct message *m)
{
    for (struct comm_request **p = &v->posted; *p; p = (struct comm_request **)&(*p)->detail) {
        struct comm_request *r = *p;
        if (!fits(m, r)) continue;
        *p = r->detail;
        if (!r->detail) v->posted_end = p;
        bind(v, r, m);
        return;
    }
    m->next = NULL;
    *v->unexpected_end = m;
    v->unexpected_end = &m->next;
}
