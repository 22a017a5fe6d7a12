/* mpi_window_serve.c - the target's side of one-sided communication: operations applied one at a
 * time.
 *
 * One operation after the other is more than the standard promises (section 12.7: atomic
 * by element for accumulates), so programs that rely on chance see the same result in
 * every run. Serving takes the target's time only for copies with gaps and for combining. */
#include <stdio.h>

#include "mpi/mpi_window.h"

/* An answer is as long as what comes back. Its content is never read, but must be memory
 * of that length: `back`, or the window where the length is 0. */
static void answer(struct mpi_rank *r, struct mpi_window *w, const struct mpi_rma *x)
{
    int world = mpi_group_world(w->comm->group, x->origin);
    int64_t tag = mpi_tag(w->comm->context, PLANE_WINDOW, x->answer_tag);
    comm_isend(r->comm, world, tag, x->back ? x->back : (char *)w, x->nback, NULL);
}

/* --- memory --- */

/* memory_of: where an operation acts; the run ends when that is not within the window.
 * Origins know neither size nor unit of a window, so the target checks, as a library with
 * bounds checks would. Displacements count the target's unit (section 12.3). */
static char *memory_of(struct mpi_rank *r, const struct mpi_window *w, const struct mpi_rma *x)
{
    /* Of a dynamic window the displacement is an address of the target. */
    if (w->flavor == MPI_WIN_FLAVOR_DYNAMIC) return (char *)(uintptr_t)x->displacement;
    int64_t at = mpi_type_bytes(x->displacement, w->unit), low = at + x->type->true_lb;
    int64_t last = mpi_type_bytes(x->count - 1, x->type->extent), high = low + x->type->true_extent;
    char text[200];
    /* An extent may be negative: then the last element is the lowest. */
    if (last < 0) low += last;
    else high += last;
    if (x->count == 0 || (low >= 0 && high <= w->size)) return w->base + at;
    snprintf(text, sizeof text, "rank %d accesses bytes %lld .. %lld of a window of %lld bytes",
             x->origin, (long long)low, (long long)high - 1, (long long)w->size);
    mpi_fail(r, text);
}

/* element_of: the basic type that a type is made of. Section 12.3.4: all basic elements
 * of the type must be the same, so the first tells. */
static struct mpi_type *element_of(struct mpi_type *t)
{
    while (!mpi_type_is_basic(t) && t->npiece) t = t->piece[0].of;
    return t;
}

/* combine: memory = memory op data. Pairs with gaps are combined as they lie, all others packed. */
static void combine(struct mpi_rank *r, struct mpi_window *w, const struct mpi_rma *x, char *memory)
{
    struct mpi_type *element = element_of(x->type);
    struct mpi_reduction op;
    struct work work = {0};
    /* MPI_REPLACE and MPI_NO_OP are operations of one-sided calls alone. */
    if (x->op == mpi_op_of(r, MPI_NO_OP)) return;
    int64_t bytes = x->count * x->type->size;
    if (bytes == 0) return;
    int64_t n = bytes / element->size;
    if (x->op == mpi_op_of(r, MPI_REPLACE)) {
        mpi_unpack_bytes(memory, x->data, bytes, x->count, x->type);
        return;
    }
    if (mpi_reduction_make(r, &op, x->op, element, w->comm) != MPI_SUCCESS)
        mpi_fail(r, "the operation is not defined on the type");
    /* Built-in operations work on elements as C lays them out, so data come out of the
     * type, are combined, and go back into it. */
    int64_t each = element->extent;
    char *there = mpi_take(r->world, 2 * n * each + 1), *with = there + n * each, *packed = NULL;
    if (!element->dense) packed = mpi_take(r->world, bytes);
    /* what is there, as elements one behind the other */
    mpi_pack_bytes(packed ? packed : there, memory, x->count, x->type);
    if (packed) mpi_unpack_bytes(there, packed, bytes, n, element);
    mpi_unpack_bytes(with, x->data, bytes, n, element);
    op.work.combine(there, with, true, n, op.work.context, &work);
    if (packed) mpi_pack_bytes(packed, there, n, element);
    mpi_unpack_bytes(memory, packed ? packed : there, bytes, x->count, x->type);
    comm_work(r->comm, &work);
    mpi_give(r->world, packed);
    mpi_give(r->world, there);
}

/* What comes back is what was there before (section 12.3.4), so it is packed first. */
static void apply(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x)
{
    char *memory = memory_of(r, w, x);
    int64_t bytes = x->count * x->type->size;
    if (x->back) mpi_pack_bytes(x->back, memory, x->count, x->type);
    if (x->kind == RMA_PUT) mpi_unpack_bytes(memory, x->data, bytes, x->count, x->type);
    if (x->kind == RMA_ACCUMULATE || x->kind == RMA_GET_ACCUMULATE) combine(r, w, x, memory);
    /* data: the new value, then the one to compare with */
    if (x->kind == RMA_COMPARE_AND_SWAP && memcmp(x->back, x->data + bytes, (size_t)bytes) == 0)
        mpi_unpack_bytes(memory, x->data, bytes, x->count, x->type);
    if (!x->type->dense) mpi_charge_copy(r, bytes);
}

/* --- locks: granted in the order of asking --- */

/* A shared lock is refused only by an exclusive one; fairness is the queue's. */
static bool grant(struct mpi_window *w, const struct mpi_rma *x)
{
    bool alone = x->lock_type == MPI_LOCK_EXCLUSIVE;
    if (w->exclusive || (alone && w->shared)) return false;
    if (alone) w->exclusive++;
    else w->shared++;
    return true;
}

/* Whoever asks while others wait goes behind them, even if it could share: else writers
 * starve. No answer means to wait. */
static void lock(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x)
{
    x->queued = NULL;
    if (!w->waiting && grant(w, x)) {
        answer(r, w, x);
        return;
    }
    *w->waiting_end = x;
    w->waiting_end = &x->queued;
}

/* The next in the queue gets it; readers behind each other get it together. */
static void unlock(struct mpi_rank *r, struct mpi_window *w, struct mpi_rma *x)
{
    if (x->lock_type == MPI_LOCK_EXCLUSIVE) w->exclusive--;
    else w->shared--;
    answer(r, w, x);
    while (w->waiting && grant(w, w->waiting)) {
        struct mpi_rma *next = w->waiting->queued;
        answer(r, w, w->waiting);
        w->waiting = next;
    }
    if (!w->waiting) w->waiting_end = &w->waiting;
}

void mpi_window_serve(struct mpi_rank *r, void *window)
{
    struct mpi_window *w = window;
    /* Requests from anybody, in the order of arrival. The receive is posted again only
     * after an operation is done, so that one follows the other. */
    int64_t tag = mpi_tag(w->comm->context, PLANE_WINDOW, TAG_OPERATION);
    while (!w->closing) {
        struct mpi_rma *x = NULL;
        /* only the address is taken; the rest of the message is what it costs */
        comm_irecv_matching(r->comm, COMM_ANY_SOURCE, tag, COMM_WHOLE_TAG, &x, sizeof x,
                            &w->served);
        mpi_wait_request(r, &w->served);
        if (w->closing) break;
        if (x->kind == RMA_LOCK) lock(r, w, x);
        else if (x->kind == RMA_UNLOCK) unlock(r, w, x);
        else {
            apply(r, w, x);
            answer(r, w, x);
        }
    }
}
