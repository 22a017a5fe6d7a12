/* published.c - which elements of outputs the ranks of a process published, to be sent when the run
 * has ended (shared.h). */
#include <stdlib.h>

#include "vp/shared.h"

/* Under a lock: threads of one process keep one list. Publishing is rare beside messages. */
void shared_published(struct world *w, int output, int64_t first, int64_t n)
{
    struct published *p = w->published;
    pthread_mutex_lock(&p->lock);
    struct interval *last = p->n > 0 ? &p->interval[p->n - 1] : NULL;
    /* Neighbours in a row publish neighbouring elements, mostly. */
    if (last && last->output == output && last->first + last->count == first) {
        last->count += n;
    } else {
        if (p->n == p->room) {
            p->room = p->room ? 2 * p->room : 1024;
            p->interval = realloc(p->interval, (size_t)p->room * sizeof *p->interval);
            CHECK(p->interval);
        }
        p->interval[p->n++] = (struct interval){output, first, n};
    }
    pthread_mutex_unlock(&p->lock);
}
