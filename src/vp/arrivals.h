/* arrivals.h - messages that the network has brought, until their receivers go on. */
#ifndef VP_ARRIVALS_H
#define VP_ARRIVALS_H

#include "vp/vp.h"

/* arrivals_make: from now on messages of w's network wait for their receivers (arrivals_add), where
 * that acts on no result; else false: w->arrivals stays NULL, and each is matched when it comes.
 * After the network, before any message. */
bool arrivals_make(struct world *w);

/* arrivals_foresee: instead, ask for the memory of each receiver shortly before. */
void arrivals_foresee(struct world *w);

/* arrivals_add: keep m, whose arrival is known, from an event. */
void arrivals_add(struct world *w, struct message *m);

/* arrivals_give: match all that are kept, in the order in which they came; receivers go on. */
void arrivals_give(struct world *w);

/* arrivals_step: dispatch an event that no receiver of what is kept could forestall: true; false
 * where there is none, or they must go on first. */
bool arrivals_step(struct world *w);

/* All that a receiver touches lies cold in memory, each behind the one before; a list of messages
 * tells early who is next: how many messages ahead each of the four steps is asked for. */
enum { ARRIVALS_MESSAGE = 12, ARRIVALS_RECEIVER = 9, ARRIVALS_FIBER = 6, ARRIVALS_STACK = 3 };

/* arrivals_warm_message: ask for m. */
static inline void arrivals_warm_message(const struct message *m)
{
    for (int line = 0; line < 3; line++) __builtin_prefetch((const char *)m + 64 * line);
}

/* arrivals_warm_receiver: a little later: for its receiver v. */
static inline void arrivals_warm_receiver(const struct vp *v)
{
    for (int line = 0; line < 3; line++) __builtin_prefetch((const char *)v + 64 * line);
}

/* arrivals_warm_fiber: then: for where its stack and the row of its stage are told. */
static inline void arrivals_warm_fiber(const struct vp *v)
{
    fiber_prefetch(v->fiber);
    const char *row = (const char *)&v->stages[v->stage];
    __builtin_prefetch(row, 1);
    __builtin_prefetch(row + sizeof *v->stages / 2, 1);
    __builtin_prefetch(row + sizeof *v->stages - 1, 1);
}

/* arrivals_warm_stack: then: for what v waits with. */
static inline void arrivals_warm_stack(const struct vp *v)
{
    fiber_prefetch_stack(v->fiber);
    if (!v->posted) return;
    __builtin_prefetch(v->posted);
    __builtin_prefetch((const char *)v->posted + 64);
}

#endif
