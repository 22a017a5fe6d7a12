/* mpi_collective.c - collective operations: data into blocks of bytes, the machine's algorithm, and
 * back.
 *
 * Operations that move data count bytes; those that combine count elements. Types with gaps are
 * packed before and unpacked after, and the copying is charged. */
#include "mpi/mpi_collective.h"

/* --- blocks of bytes --- */

/* A side of a call: `n` blocks of the program's, as bytes at `at`. */
struct side {
    char *at;              /* the program's memory, or packed */
    void *packed;          /* NULL: the program's own */
    int64_t *size, *place; /* (n) [B]; NULL: regular */
    int64_t each;          /* bytes of a regular block */
};

struct blocks {
    int n;
    void *memory;
    MPI_Count count;
    struct mpi_type *type;
    struct mpi_counts counts, places;
};

/* An array of counts is there for the calls with a v in their names. */
static int64_t block_elements(const struct blocks *b, int i)
{
    return b->counts.at ? mpi_count_at(b->counts, i) : b->count;
}

/* Places count extents of the type, not bytes (sections 6.5 to 6.8). Regular blocks
 * follow each other. */
static char *block_memory(const struct blocks *b, int i)
{
    int64_t place = b->places.at ? mpi_count_at(b->places, i) : i * b->count;
    return (char *)b->memory + place * b->type->extent;
}

/* One block between the program's memory and packed bytes; the copy is charged as memory
 * traffic, as a library's would take time. */
static void block_move(struct mpi_rank *r, const struct blocks *b, struct side *s, int i, bool out)
{
    int64_t n = block_elements(b, i), bytes = n * b->type->size;
    char *packed = s->at + (s->place ? s->place[i] : i * s->each);
    if (out) mpi_unpack_bytes(block_memory(b, i), packed, bytes, n, b->type);
    else mpi_pack_bytes(packed, block_memory(b, i), n, b->type);
    mpi_charge_copy(r, bytes);
}

/* side_make: sizes and places of blocks; packed ones lie one behind the other. `fill`: pack what is
 * there. */
static void side_make(struct mpi_rank *r, const struct blocks *b, struct side *s, bool fill)
{
    /* A dense type's elements are bytes already: the algorithm works in the program's
     * memory, without a copy. Any other is packed into one run, in which places are sums
     * of sizes. */
    bool dense = b->type->dense;
    int64_t total = 0;
    *s = (struct side){.at = b->memory, .each = b->count * b->type->size};
    /* The algorithm wants sizes and places in bytes; the program gave them in elements. */
    if (b->counts.at) {
        s->size = mpi_take(r->world, 2 * (int64_t)sizeof *s->size * (b->n + 1));
        s->place = s->size + b->n;
        for (int i = 0; i < b->n; i++) {
            s->size[i] = block_elements(b, i) * b->type->size;
            s->place[i] = dense ? block_memory(b, i) - (char *)b->memory : total;
            total += s->size[i];
        }
    } else total = s->each * b->n;
    if (dense) return;
    s->at = s->packed = mpi_take(r->world, total + 1);
    for (int i = 0; fill && i < b->n; i++) block_move(r, b, s, i, false);
}

/* side_end: what came in goes to where the program wants it; `but` is a block that stays as it is,
 * -1: none. */
static void side_end(struct mpi_rank *r, const struct blocks *b, struct side *s, bool out, int but)
{
    for (int i = 0; s->packed && out && i < b->n; i++)
        if (i != but) block_move(r, b, s, i, true);
    mpi_give(r->world, s->packed);
    mpi_give(r->world, s->size);
}

/* The cast takes const away for a struct that serves both directions: blocks to send are
 * only read. */
static struct blocks send_blocks(const struct mpi_collective *x, int n)
{
    return (struct blocks){
        n, (void *)(uintptr_t)x->send, x->send_count, x->send_type, x->send_counts, x->send_places};
}
static struct blocks recv_blocks(const struct mpi_collective *x, int n)
{
    return (struct blocks){n, x->recv, x->recv_count, x->recv_type, x->recv_counts, x->recv_places};
}

/* The channel counts ranks of the communicator, so that the algorithm never sees ranks of
 * the world. */
static struct collective_call call_of(const struct mpi_collective *x, enum collective_kind kind,
                                      unsigned sequence)
{
    struct collective_call k = {
        .kind = kind, .comm = &x->comm->channel.comm, .root = x->root, .element = 1};
    k.tag = mpi_collective_tag(sequence);
    return k;
}

/* --- data --- */

/* Only the root's buffer holds data at the beginning, and only the others' change: each
 * side packs or unpacks what it needs. */
static void broadcast(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    struct collective_call k = call_of(x, COLLECTIVE_BROADCAST, sequence);
    struct blocks b = recv_blocks(x, 1);
    struct side s;
    bool root = x->comm->rank == x->root;
    side_make(r, &b, &s, root);
    k.count = s.each;
    k.recv = s.at;
    mpi_collective_call(r, &k, false);
    side_end(r, &b, &s, !root, -1);
}

/* One block from each; the root has them all. MPI_IN_PLACE: the root's lies where it belongs. */
static void gather(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence,
                   bool everywhere)
{
    struct collective_call k =
        call_of(x, everywhere ? COLLECTIVE_ALLGATHER : COLLECTIVE_GATHER, sequence);
    /* With MPI_IN_PLACE the own block is among those received. In packed form it must be
     * brought there first, and must not be written back over itself. */
    bool all = everywhere || x->comm->rank == x->root, place = x->send == MPI_IN_PLACE;
    struct blocks out = send_blocks(x, 1), in = recv_blocks(x, x->comm->size);
    struct side from = {0}, to = {0};
    if (all) side_make(r, &in, &to, false);
    if (!place) side_make(r, &out, &from, true);
    else if (to.packed) block_move(r, &in, &to, x->comm->rank, false);
    /* Counts and places matter to ranks that receive; `count` is the size of the own
     * block in any case. */
    k.recv = to.at;
    k.counts = to.size;
    k.places = to.place;
    k.count = !place ? from.each : to.size ? to.size[x->comm->rank] : to.each;
    k.send =
        !place ? from.at : to.at + (to.place ? to.place[x->comm->rank] : to.each * x->comm->rank);
    mpi_collective_call(r, &k, x->recv_places.at != NULL);
    if (!place) side_end(r, &out, &from, false, -1);
    if (all) side_end(r, &in, &to, true, place ? x->comm->rank : -1);
}

/* The mirror of a gather: the root's own block stays where it is under MPI_IN_PLACE
 * (section 6.6). */
static void scatter(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    struct collective_call k = call_of(x, COLLECTIVE_SCATTER, sequence);
    bool root = x->comm->rank == x->root, place = x->recv == MPI_IN_PLACE;
    struct blocks out = send_blocks(x, x->comm->size), in = recv_blocks(x, 1);
    struct side from = {0}, to = {0};
    if (root) side_make(r, &out, &from, true);
    if (!place) side_make(r, &in, &to, false);
    k.send = from.at;
    k.counts = from.size;
    k.places = from.place;
    k.count = !place ? to.each : from.size ? from.size[x->root] : from.each;
    k.recv = !place ? to.at : from.at + (from.place ? from.place[x->root] : from.each * x->root);
    mpi_collective_call(r, &k, x->send_places.at != NULL);
    if (root) side_end(r, &out, &from, false, -1);
    if (!place) side_end(r, &in, &to, true, -1);
}

/* Under MPI_IN_PLACE the blocks received replace those sent, count for count (section
 * 6.8), so what is sent needs memory of its own. */
static void alltoall(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    struct collective_call k = call_of(x, COLLECTIVE_ALLTOALL, sequence);
    bool place = x->send == MPI_IN_PLACE;
    struct blocks in = recv_blocks(x, x->comm->size),
                  out = place ? in : send_blocks(x, x->comm->size);
    struct side from, to;
    side_make(r, &in, &to, false);
    side_make(r, &out, &from, true);
    /* in place: what goes out is copied first, packed or as it lies */
    void *copy = NULL;
    if (place && !from.packed) {
        /* Irregular blocks may lie anywhere: the copy reaches to the end of the last one. */
        int64_t end = from.each * out.n;
        for (int i = 0; from.place && i < out.n; i++)
            if (from.place[i] + from.size[i] > end) end = from.place[i] + from.size[i];
        copy = memcpy(mpi_take(r->world, end + 1), from.at, (size_t)end);
        from.at = copy;
        mpi_charge_copy(r, end);
    }
    k.send = from.at;
    k.send_counts = from.size;
    k.send_places = from.place;
    k.recv = to.at;
    k.counts = to.size;
    k.places = to.place;
    k.count = to.each;
    mpi_collective_call(r, &k, false);
    mpi_give(r->world, copy);
    side_end(r, &out, &from, false, -1);
    side_end(r, &in, &to, true, -1);
}

/* --- combining --- */

/* Elements cannot be cut: the algorithm moves whole ones of `element` bytes, from the
 * type's first byte on (true lower bound). They are not packed, because the operation
 * expects them as they lie; types with gaps go through copies, so that gaps stay as they
 * are. */
static void reduce(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence,
                   enum collective_kind kind, bool exclusive)
{
    struct collective_call k = call_of(x, kind, sequence);
    struct mpi_reduction op;
    mpi_reduction_make(r, &op, x->op, x->recv_type, x->comm);
    k.count = x->recv_count;
    k.element = op.element;
    k.op = &op.work;
    k.exclusive = exclusive;
    k.recv = x->recv ? (char *)x->recv + op.offset : NULL;
    k.send = x->send == MPI_IN_PLACE ? k.recv : (const char *)x->send + op.offset;
    void *in = NULL, *out = NULL;
    if (op.copied) {
        bool place = x->send == MPI_IN_PLACE;
        k.send = in = mpi_reduction_copy(r, &op, place ? x->recv : x->send, k.count);
        k.recv = out = place ? in : mpi_reduction_copy(r, &op, NULL, k.count);
    }
    mpi_collective_call(r, &k, false);
    /* An exclusive scan tells the first rank nothing. */
    bool told = exclusive ? x->comm->rank > 0
                          : kind != COLLECTIVE_REDUCE || x->comm->rank == x->root;
    if (out && told) mpi_reduction_back(r, &op, x->recv, out, k.count);
    if (out != in) mpi_give(r->world, out);
    mpi_give(r->world, in);
}

/* Each rank receives the reduction of its own block (section 6.10). Both calls end here:
 * with counts and without. */
static void reduce_scatter(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    struct collective_call k = call_of(x, COLLECTIVE_REDUCE_SCATTER, sequence);
    struct mpi_reduction op;
    int size = x->comm->size;
    int64_t total = x->recv_count * size, *counts = NULL;
    mpi_reduction_make(r, &op, x->op, x->recv_type, x->comm);
    if (x->recv_counts.at) {
        counts = mpi_take(r->world, 2 * (int64_t)sizeof *counts * (size + 1));
        /* Blocks follow each other in the order of ranks; there are no displacements in
         * this call. */
        int64_t *places = counts + size;
        total = 0;
        for (int i = 0; i < size; i++) {
            counts[i] = mpi_count_at(x->recv_counts, i);
            places[i] = total;
            total += counts[i];
        }
        k.counts = counts;
        k.places = places;
    }
    k.count = counts ? counts[x->comm->rank] : x->recv_count;
    k.element = op.element;
    k.op = &op.work;
    k.recv = (char *)x->recv + op.offset;
    k.send = (const char *)x->send + op.offset;
    /* in place: the result would overwrite what is still to be combined */
    void *copy = NULL, *out = NULL;
    if (op.copied) {
        k.send = copy =
            mpi_reduction_copy(r, &op, x->send == MPI_IN_PLACE ? x->recv : x->send, total);
        k.recv = out = mpi_reduction_copy(r, &op, NULL, k.count);
    } else if (x->send == MPI_IN_PLACE) {
        copy =
            memcpy(mpi_take(r->world, total * k.element + 1), k.recv, (size_t)(total * k.element));
        k.send = copy;
        mpi_charge_copy(r, total * k.element);
    }
    mpi_collective_call(r, &k, false);
    if (out) mpi_reduction_back(r, &op, x->recv, out, k.count);
    mpi_give(r->world, out);
    mpi_give(r->world, copy);
    mpi_give(r->world, counts);
}

/* --- without an algorithm --- */

/* The call has checked the handle. A persistent operation may begin long after, and its
 * types may be gone by then. Programs give no handle where there is nothing to send. */
struct mpi_type *mpi_block_type(struct mpi_rank *r, MPI_Datatype handle, int64_t count)
{
    struct mpi_type *t = count == 0 ? mpi_type_basic(MPI_BYTE) : mpi_type_of(r, handle);
    if (!t) mpi_fail(r, "a datatype was freed before the operation began");
    return t;
}

/* A type for each block: linear, the next ranks first so that not all send to one. In place: from
 * copies. */
static void alltoallw(struct mpi_rank *r, const struct mpi_collective *x, unsigned sequence)
{
    /* At distance d each rank sends to the d-th behind it and receives from the d-th
     * before it, so every rank is the target of one message at each distance. Bytes count
     * as displacements here, not elements: each block has a type of its own (section
     * 6.8). */
    int size = x->comm->size, rank = x->comm->rank;
    bool place = x->send == MPI_IN_PLACE;
    struct mpi_part *in = mpi_take(r->world, 2 * size * (int64_t)sizeof *in), *out = in + size;
    void **copy = mpi_take_zero(r->world, size * (int64_t)sizeof *copy);
    for (int d = 0; d < size; d++) {
        int from = (rank - d + size) % size, to = (rank + d) % size;
        in[d] = (struct mpi_part){from, (char *)x->recv + mpi_count_at(x->recv_places, from),
                                  mpi_count_at(x->recv_counts, from), NULL};
        in[d].type = mpi_block_type(r, x->recv_types[from], in[d].count);
        if (!place) {
            out[d] = (struct mpi_part){
                to, (char *)(uintptr_t)x->send + mpi_count_at(x->send_places, to),
                mpi_count_at(x->send_counts, to),
                mpi_block_type(r, x->send_types[to], mpi_count_at(x->send_counts, to))};
            continue;
        }
        /* In place: the block for `to` is what the program has in the place of what comes
         * from it. Receives would overwrite it, so it goes out of a packed copy. */
        int64_t n = mpi_count_at(x->recv_counts, to);
        struct mpi_type *t = mpi_block_type(r, x->recv_types[to], n);
        int64_t bytes = n * t->size;
        copy[d] = mpi_take(r->world, bytes + 1);
        mpi_pack_bytes(copy[d], (char *)x->recv + mpi_count_at(x->recv_places, to), n, t);
        out[d] = (struct mpi_part){to, copy[d], bytes, mpi_type_basic(MPI_BYTE)};
    }
    /* The own block is at distance 0 and needs no message. */
    mpi_copy_typed(r, in[0].buffer, in[0].count, in[0].type, out[0].buffer, out[0].count,
                   out[0].type);
    mpi_exchange(r, x->comm, sequence, size - 1, in + 1, size - 1, out + 1);
    for (int d = 0; d < size; d++) mpi_give(r->world, copy[d]);
    mpi_give(r->world, copy);
    mpi_give(r->world, in);
}

/* Written once for blocking, non-blocking and persistent calls: it runs on the rank's
 * stack or on that of an operation in progress, and does not know which. */
void mpi_collective_run(struct mpi_rank *r, const struct mpi_collective *x)
{
    const unsigned sequence = x->sequence;
    if (x->what == WHAT_BARRIER) {
        mpi_collective_barrier(r, x->comm, sequence);
        return;
    }
    if (x->what == WHAT_BCAST) broadcast(r, x, sequence);
    else if (x->what == WHAT_GATHER) gather(r, x, sequence, false);
    else if (x->what == WHAT_ALLGATHER) gather(r, x, sequence, true);
    else if (x->what == WHAT_SCATTER) scatter(r, x, sequence);
    else if (x->what == WHAT_ALLTOALL) alltoall(r, x, sequence);
    else if (x->what == WHAT_ALLTOALLW) alltoallw(r, x, sequence);
    else if (x->what == WHAT_REDUCE) reduce(r, x, sequence, COLLECTIVE_REDUCE, false);
    else if (x->what == WHAT_ALLREDUCE) reduce(r, x, sequence, COLLECTIVE_ALLREDUCE, false);
    else if (x->what == WHAT_SCAN) reduce(r, x, sequence, COLLECTIVE_SCAN, false);
    else if (x->what == WHAT_EXSCAN) reduce(r, x, sequence, COLLECTIVE_SCAN, true);
    else reduce_scatter(r, x, sequence);
}

/* Sequences keep operations apart that are in progress on one communicator at the same
 * time. All ranks call collectives of a communicator in the same order (section 6.14), so
 * they count alike. */
void mpi_collective_now(struct mpi_rank *r, struct mpi_collective *x)
{
    x->sequence = x->comm->sequence++;
    mpi_collective_run(r, x);
}
