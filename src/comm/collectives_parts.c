/* collectives_parts.c - the steps that several collectives are made of (collectives_internal.h).
 *
 * Powers of two (fold), halving and doubling, binomial trees, and the four ways to move data: a
 * message, an exchange, a copy that costs time, a copy that does not. The fold of P = 6 into a core
 * of 4:
 *
 *     rank     0   1   2   3   4   5
 *     core         0       1   2   3       0 gives to 1, 2 gives to 3; they get the answer back */
#include "comm/collectives_internal.h"

/* Of the first 2 rest ranks the odd ones work for their left neighbours, so that ranks that combine
 * stay in the order of ranks, which operations that do not commute need. */
struct fold fold_make(int rank, int size)
{
    struct fold f = {.core = 1 << log2_floor(size)};
    f.rest = size - f.core;
    if (rank >= 2 * f.rest) f.rank = rank - f.rest;
    else f.rank = rank % 2 ? rank / 2 : -1;
    return f;
}

/* Where block r begins: as listed, or behind those before it, or all in one place. */
static int64_t place_of(const struct collective_call *k, const int64_t *places,
                        const int64_t *counts, int r)
{
    int64_t place = 0;
    if (k->one_place) return 0;
    if (places) return places[r];
    if (!counts) return k->count * r;
    for (int i = 0; i < r; i++) place += counts[i];
    return place;
}

int64_t block_place(const struct collective_call *k, int r)
{
    return place_of(k, k->places, k->counts, r);
}
int64_t send_block_place(const struct collective_call *k, int r)
{
    return place_of(k, k->send_places, k->send_counts, r);
}

/* The receive is posted first, so that the message finds it; both at a time, so that two ranks that
 * exchange do not wait for each other. */
void exchange(const struct collective_call *k, int phase, int dst, const void *out, int64_t nout,
              int src, void *in, int64_t nin)
{
    struct comm_request request[2] = {{0}};
    comm_irecv(k->comm, src, k->tag + phase, in, nin * k->element, &request[0]);
    comm_isend(k->comm, dst, k->tag + phase, out, nout * k->element, &request[1]);
    comm_waitall(k->comm, 2, request);
}

/* Free: an MPI program would have the data in place (MPI_IN_PLACE) or pay the same everywhere. */
void own_copy(const struct collective_call *k, void *to, const void *from, int64_t n)
{
    if (n > 0 && to != from) memmove(to, from, (size_t)(n * k->element));
}

/* Packing is work of the processor, charged as memory traffic. */
void copy(const struct collective_call *k, void *to, const void *from, int64_t n)
{
    const struct work w = {.bytes = (uint64_t)(n * k->element)};
    own_copy(k, to, from, n);
    if (w.bytes) comm_work(k->comm, &w);
}

/* An operation that counts nothing costs nothing, not even the call. */
void combine(const struct collective_call *k, void *into, const void *with, bool before, int64_t n)
{
    static const struct work none;
    struct work w = {0};
    if (n > 0) k->op->combine(into, with, before, n, k->op->context, &w);
    if (memcmp(&w, &none, sizeof w) != 0) comm_work(k->comm, &w);
}

/* Before the core's rounds: those who sit out give, their neighbours combine. */
void fold_in(const struct collective_call *k, const struct fold *f, int phase, void *acc, void *in,
             int64_t n)
{
    int rank = comm_rank(k->comm);
    if (rank >= 2 * f->rest) return;
    if (f->rank < 0) {
        give(k, phase, rank + 1, acc, n);
        return;
    }
    take(k, phase, rank - 1, in, n);
    combine(k, acc, in, true, n);
}

/* After them, the other way, with the answer. */
void fold_out(const struct collective_call *k, const struct fold *f, int phase, void *acc,
              int64_t n)
{
    int rank = comm_rank(k->comm);
    if (rank >= 2 * f->rest) return;
    if (f->rank < 0) take(k, phase, rank + 1, acc, n);
    else give(k, phase, rank - 1, acc, n);
}

int64_t even_part(const struct collective_call *k, const struct fold *f, int part)
{
    return split(k->count, part, f->core);
}

/* Whose half is kept follows from the rank's bits, highest first, so that rank r ends with part r.
 *
 * Each round halves what is still worked on: lg alpha + (P-1)/P n (beta + gamma). The upper rank
 * combines with the lower one's data in front: the order of ranks is kept within pairs, but parts
 * cross it, so that the operation must commute. */
void halve(const struct collective_call *k, const struct fold *f, int phase, void *acc, void *in,
           part_place_fn *place)
{
    int low = 0, high = f->core;
    for (int mask = f->core / 2; mask > 0; mask /= 2) {
        int middle = (low + high) / 2, peer = fold_actual(f, f->rank ^ mask);
        bool upper = f->rank & mask;
        int64_t begin = place(k, f, low), half = place(k, f, middle), end = place(k, f, high);
        /* The half that goes on here, and the one that the partner works on. */
        int64_t keep = upper ? half : begin, nkeep = upper ? end - half : half - begin;
        int64_t pass = upper ? begin : half, npass = upper ? half - begin : end - half;
        exchange(k, phase, peer, at(k, acc, pass), npass, peer, in, nkeep);
        combine(k, at(k, acc, keep), in, upper, nkeep);
        if (upper) low = middle;
        else high = middle;
    }
}

/* halve backwards without combining: after round j a rank has 2^(j+1) parts. */
void regrow(const struct collective_call *k, const struct fold *f, int phase, void *acc,
            part_place_fn *place)
{
    for (int mask = 1; mask < f->core; mask *= 2) {
        int mine = f->rank & ~(mask - 1), other = mine ^ mask,
            peer = fold_actual(f, f->rank ^ mask);
        int64_t a = place(k, f, mine), b = place(k, f, other);
        exchange(k, phase, peer, at(k, acc, a), place(k, f, mine + mask) - a, peer, at(k, acc, b),
                 place(k, f, other + mask) - b);
    }
}

/* Rank r gets its subtree's parts in one message: r to the end of the subtree. */
int64_t binomial_part_bytes(int64_t count, int size, int64_t element)
{
    int64_t sum = 0;
    for (int r = 1; r < size; r++) {
        int end = r + (r & -r) < size ? r + (r & -r) : size;
        sum += split(count, end, size) - split(count, r, size);
    }
    return sum * element;
}

/* The same in blocks: the sizes of all subtrees but the root's. */
int64_t binomial_block_count(int size)
{
    int64_t sum = 0;
    for (int r = 1; r < size; r++) sum += r + (r & -r) < size ? r & -r : size - r;
    return sum;
}

/* Conditions: what an algorithm cannot do it must not be chosen for. */
bool needs_power_of_two(const struct collective_shape *s) { return is_power_of_two(s->size); }
bool needs_commutative(const struct collective_shape *s) { return s->commutative; }
bool needs_regular(const struct collective_shape *s) { return !s->irregular; }
bool needs_regular_power_of_two(const struct collective_shape *s)
{
    return !s->irregular && is_power_of_two(s->size);
}

/* Blocks of different sizes: the sum of all and the largest, where every rank knows the list; else
 * what one rank knows is nobody's shape. */
struct collective_shape collective_shape(const struct collective_call *k)
{
    struct collective_shape s = {.kind = k->kind,
                                 .size = comm_size(k->comm),
                                 .root = k->root,
                                 .count = k->count,
                                 .element = k->element};
    s.total = s.count * s.size;
    s.exclusive = k->exclusive;
    s.commutative = !k->op || k->op->commutative;
    s.idempotent = k->op && k->op->idempotent;
    s.operation = k->op ? k->op->operation : COMM_OWN;
    s.hardware = k->comm->hardware;
    s.irregular = k->counts || k->send_counts;
    if (!s.irregular || (k->kind != COLLECTIVE_ALLGATHER && k->kind != COLLECTIVE_REDUCE_SCATTER))
        return s;
    s.total = s.count = 0;
    for (int r = 0; r < s.size; r++) {
        s.total += k->counts[r];
        if (k->counts[r] > s.count) s.count = k->counts[r];
    }
    return s;
}

/* A handful of rows: searched from the front. */
const struct collective_algorithm *collective_in_table(const struct collective_table *t,
                                                       const char *name)
{
    for (int i = 0; i < t->n; i++)
        if (strcmp(t->row[i].name, name) == 0) return &t->row[i];
    return NULL;
}
