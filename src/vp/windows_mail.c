/* windows_mail.c - what goes between the network and the shares of ranks: turns, and messages in
 * their order (windows_parts.h). */
#include "base/memory.h"
#include "vp/windows_parts.h"

/* As many turns as messages of a window; memory is kept for the next ones. */
int windows_turn(struct window *w, int share)
{
    if (w->nturn == w->capacity) {
        w->capacity = w->capacity > 0 ? 2 * w->capacity : 256;
        w->share = memory_resize(w->share, (size_t)w->capacity, sizeof *w->share);
    }
    w->share[w->nturn] = share;
    return w->nturn++;
}

/* From the heap: a share is run by one thread now and by another one later. */
void windows_add(struct mail *b, struct message *m, int turn)
{
    if (b->n == b->capacity) {
        b->capacity = b->capacity > 0 ? 2 * b->capacity : 64;
        b->entry = memory_resize(b->entry, (size_t)b->capacity, sizeof *b->entry);
    }
    b->entry[b->n++] = (struct entry){m, turn};
}

/* In the turn in progress, on the fiber of the rank that sends. */
void windows_post(struct world *w, struct message *m)
{
    const struct side *side = &w->windows->side[windows_share_of(w)];
    windows_add(side->out, m, side->turn);
}
