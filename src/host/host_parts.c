/* host_parts.c - what matching by MPI and matching here share: nodes of pending operations, lists,
 * tags, and how a rank ends the job.
 *
 * Nodes are never given back to the system while a rank lives: a program that repeats itself finds
 * memory that is mapped already, as it would with buffers of its own. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "host/host_parts.h"

/* --- pending operations ----------------------------------------------------------------------- */

enum { STATUS_FAILED = 1 };

/* The first spare node that is large enough, else the first one, made larger: sizes repeat. */
struct host_pending *host_pending_new(struct host_comm *h, size_t room)
{
    struct host_pending **at = &h->spare;
    while (*at != NULL && (*at)->room < room) at = &(*at)->next;
    if (*at == NULL) at = &h->spare;
    struct host_pending *p = *at;
    if (p != NULL) *at = p->next;
    else p = memory_zeroed(1, sizeof *p);
    char *copy = p->copy;
    size_t has = p->room;
    if (has < room) {
        free(copy);
        copy = memory_zeroed(room, 1);
        has = room;
    }
    /* Everything else of a node begins anew. */
    *p = (struct host_pending){.copy = copy, .room = has};
    return p;
}

/* To the front: the memory that was used last is in the cache. */
void host_pending_free(struct host_comm *h, struct host_pending *p)
{
    p->next = h->spare;
    h->spare = p;
}

/* An empty list may never have been used: its end is set now. */
void host_list_add(struct host_list *l, struct host_pending *p)
{
    if (l->end == NULL) l->end = &l->first;
    p->next = NULL;
    *l->end = p;
    l->end = &p->next;
}

/* The end moves where the last one goes. */
struct host_pending *host_list_remove(struct host_list *l, struct host_pending **at)
{
    struct host_pending *p = *at;
    *at = p->next;
    if (l->end == &p->next) l->end = at;
    return p;
}

/* --- failure ---------------------------------------------------------------------------------- */

/* The others wait for this rank: the whole job ends. */
_Noreturn void host_stop(struct host_comm *h, const char *format, ...)
{
    char text[600];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    fprintf(stderr, "mimdsim: rank %d%s%s: %s\n", h->comm.rank, h->comm.file ? " at " : "",
            h->comm.file ? h->comm.file : "", text);
    fflush(NULL);
    if (h->hosts != NULL) h->hosts->call->abort(STATUS_FAILED);
    _exit(STATUS_FAILED);
}

/* --- tags ------------------------------------------------------------------------------------- */

/* Near tags are the program's own. MPICH has 2^28 of them, Open MPI 2^31; the standard promises
 * 2^15. */
int host_tag(struct host_comm *h, int64_t tag)
{
    const int64_t near = (int64_t)h->largest_tag - FAR;
    if (tag >= FAR_TAGS && tag < FAR_TAGS + FAR) return (int)(near + tag - FAR_TAGS);
    if (tag < 0 || tag >= near)
        host_stop(h, "tag %lld: %s has 0 to %lld", (long long)tag, h->hosts->call->library,
                  (long long)near - 1);
    return (int)tag;
}

int64_t host_tag_back(const struct host_comm *h, int tag)
{
    const int near = h->largest_tag - FAR;
    return tag < near ? tag : FAR_TAGS + (int64_t)(tag - near);
}

/* --- completion ------------------------------------------------------------------------------- */

/* A test that says done spends the request: it is not tested again. */
bool host_test_send(struct host_comm *h, struct host_pending *p)
{
    bool done = p->done;
    if (!done && !h->hosts->call->lane->test(&p->mpi, &done))
        host_stop(h, "%s reports an error in a test", h->hosts->call->library);
    if (done && !p->done) p->order = ++h->completed;
    return p->done = done;
}

/* What the request tells of its message stays in it. */
void host_finish(struct host_comm *h, struct comm_request *r)
{
    struct host_pending *p = r->detail;
    r->active = 0;
    r->detail = NULL;
    host_pending_free(h, p);
}
