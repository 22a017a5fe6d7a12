/* mpi_comm_split.c - new communicators out of the ranks of old ones.
 *
 * A context is given by the first rank of those who agree on it, and no rank gives one twice: its
 * number in the world, and how many it has given. So it is unique in the run. */
#include <stdlib.h>

#include "mpi/mpi_internal.h"

int mpi_context_of(struct mpi_rank *r, int given, int rank)
{
    int64_t context = FIRST_CONTEXT + (int64_t)given * r->size + rank;
    /* Contexts are never used again: that a message of a freed communicator is still
     * under way need not be known. 2^29 of them last for 8,000 communicators at each of
     * 65,536 ranks. */
    if (context >= LAST_CONTEXT) mpi_fail(r, "too many communicators were made");
    return (int)context;
}

int mpi_context_give(struct mpi_rank *r) { return mpi_context_of(r, r->given++, r->rank); }

/* Ranks other than the first wait for a message: making a communicator synchronizes as it
 * does in a real library. */
int mpi_context_agree(struct mpi_rank *r, struct mpi_channel *k, unsigned sequence)
{
    int context = k->comm.rank == 0 ? mpi_context_give(r) : 0;
    mpi_collective_tell(r, k, sequence, &context);
    return context;
}

/* What each rank tells the others of a split. */
struct choice {
    int color, key, given, rank;
};

static int by_key(const void *a, const void *b)
{
    const struct choice *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return x->rank - y->rank;
}

/* Everybody's color and key are gathered by all, with what each could give as a context.
 * Every rank sorts the same list, which takes no message more; O(P log P) on each rank,
 * and P entries of 16 bytes in memory while it lasts (section 7.4.2 has the rule of
 * order). */
struct mpi_comm *mpi_comm_split_of(struct mpi_rank *r, struct mpi_comm *c, int color, int key)
{
    struct choice own = {.color = color, .key = key, .given = r->given, .rank = c->rank};
    struct choice *all = mpi_take(r->world, c->size * (int64_t)sizeof *all);
    /* `given` is the promise of each rank in case that its part's first rank is this one.
     * Nothing gives contexts away on this rank before the promise is kept: an operation
     * in progress has taken its own at its start. */
    int n = 0;
    mpi_collective_allgather(r, &c->channel, c->sequence++, &own, all, sizeof own);
    /* Parts are compacted in place: the n-th entry is never written before it was read. */
    for (int i = 0; i < c->size; i++) {
        if (color != MPI_UNDEFINED && all[i].color == color) all[n++] = all[i];
    }
    qsort(all, (size_t)n, sizeof *all, by_key);
    struct mpi_comm *made = NULL;
    if (n) {
        int *list = mpi_take(r->world, n * (int64_t)sizeof *list);
        for (int i = 0; i < n; i++) list[i] = mpi_group_world(c->group, all[i].rank);
        /* All ranks of a part compute the same number out of the promise of its first
         * rank, which alone counts it as given. */
        int context = mpi_context_of(r, all[0].given, list[0]);
        if (list[0] == r->rank) r->given++;
        made = mpi_comm_make(r, mpi_group_make(r, list, n), context, c);
        mpi_give(r->world, list);
    }
    mpi_give(r->world, all);
    return made;
}

/* first_ranks: a communicator of the first n; those behind get none. All agree on its
 * context, also those left out, because only the old communicator connects them. */
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
