/* mpi_comm_split.c - new communicators out of the ranks of old ones.
 *
 * A context is agreed upon by those who will use it: one more than the largest that any of them has
 * used. So the same number may stand for communicators without a common rank, which no message can
 * confuse. */
#include <stdlib.h>

#include "mpi/mpi_internal.h"

int mpi_context_new(struct mpi_rank *r, int agreed)
{
    r->next_context = agreed + 1;
    return agreed;
}

int mpi_context_agree(struct mpi_rank *r, struct mpi_channel *k, unsigned sequence)
{
    int largest = mpi_collective_max(r, k, sequence, r->next_context);
    return mpi_context_new(r, largest);
}

/* What each rank tells the others of a split. */
struct choice {
    int color, key, context, rank;
};

static int by_key(const void *a, const void *b)
{
    const struct choice *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return x->rank - y->rank;
}

/* split: everybody's color and key are gathered by all, together with the largest context. */
struct mpi_comm *mpi_comm_split_of(struct mpi_rank *r, struct mpi_comm *c, int color, int key)
{
    struct choice own = {.color = color, .key = key, .context = r->next_context, .rank = c->rank};
    struct choice *all = mpi_take(r->world, c->size * (int64_t)sizeof *all);
    int n = 0, largest = 0;
    mpi_collective_allgather(r, &c->channel, c->sequence++, &own, all, sizeof own);
    for (int i = 0; i < c->size; i++) {
        if (all[i].context > largest) largest = all[i].context;
        if (color != MPI_UNDEFINED && all[i].color == color) all[n++] = all[i];
    }
    int context = mpi_context_new(r, largest);
    qsort(all, (size_t)n, sizeof *all, by_key);
    struct mpi_comm *made = NULL;
    if (n) {
        int *list = mpi_take(r->world, n * (int64_t)sizeof *list);
        for (int i = 0; i < n; i++) list[i] = mpi_group_world(c->group, all[i].rank);
        made = mpi_comm_make(r, mpi_group_make(r, list, n), context, c);
        mpi_give(r->world, list);
    }
    mpi_give(r->world, all);
    return made;
}

/* first_ranks: a communicator of the first n; those behind get none. All agree on its context. */
struct mpi_comm *mpi_comm_first(struct mpi_rank *r, struct mpi_comm *c, int n)
{
    int context = mpi_context_agree(r, &c->channel, c->sequence++);
    if (c->rank >= n) return NULL;
    if (n == c->size) {
        c->group->o.uses++;
        return mpi_comm_make(r, c->group, context, c);
    }
    int *list = mpi_take(r->world, n * (int64_t)sizeof *list);
    for (int i = 0; i < n; i++) list[i] = mpi_group_world(c->group, i);
    struct mpi_comm *made = mpi_comm_make(r, mpi_group_make(r, list, n), context, c);
    mpi_give(r->world, list);
    return made;
}
