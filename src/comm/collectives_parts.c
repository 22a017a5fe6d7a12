/* collectives_parts.c - the steps that several collectives are made of (collectives_internal.h). */
#include "comm/collectives_internal.h"

struct fold fold_make(int rank, int size)
{
    struct fold f = {.core = 1 << log2_floor(size)};
    f.rest = size - f.core;
    if (rank >= 2 * f.rest) f.rank = rank - f.rest;
    else f.rank = rank % 2 ? rank / 2 : -1;
    return f;
}

static int64_t place_of(const struct collective_call *k, const int64_t *places, const int64_t *counts, int r)
{
    int64_t place = 0;
    if (k->one_place) return 0;
    if (places) return places[r];
    if (!counts) return k->count * r;
    for (int i = 0; i < r; i++) place += counts[i];
    return place;
}

int64_t block_place(const struct collective_call *k, int r) { return place_of(k, k->places, k->counts, r); }
int64_t send_block_place(const struct collective_call *k, int r)
{
    return place_of(k, k->send_places, k->send_counts, r);
}

void exchange(const struct collective_call *k, int phase, int dst, const void *out, int64_t nout, int src, void *in,
              int64_t nin)
{
    struct comm_request request[2] = {{0}};
    comm_irecv(k->comm, src, k->tag + phase, in, nin * k->element, &request[0]);
    comm_isend(k->comm, dst, k->tag + phase, out, nout * k->element, &request[1]);
    comm_waitall(k->comm, 2, request);
}

void own_copy(const struct collective_call *k, void *to, const void *from, int64_t n)
{
    if (n > 0 && to != from) memmove(to, from, (size_t)(n * k->element));
}

void copy(const struct collective_call *k, void *to, const void *from, int64_t n)
{
    const struct work w = {.bytes = (uint64_t)(n * k->element)};
    own_copy(k, to, from, n);
    if (w.bytes) comm_work(k->comm, &w);
}

void combine(const struct collective_call *k, void *into, const void *with, bool before, int64_t n)
{
    static const struct work none;
    struct work w = {0};
    if (n > 0) k->op->combine(into, with, before, n, k->op->context, &w);
    if (memcmp(&w, &none, sizeof w) != 0) comm_work(k->comm, &w);
}

void fold_in(const struct collective_call *k, const struct fold *f, int phase, void *acc, void *in, int64_t n)
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

void fold_out(const struct collective_call *k, const struct fold *f, int phase, void *acc, int64_t n)
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

/* Whose half is kept follows from the rank's bits, highest first, so that rank r ends with part r. */
void halve(const struct collective_call *k, const struct fold *f, int phase, void *acc, void *in, part_place_fn *place)
{
    int low = 0, high = f->core;
    for (int mask = f->core / 2; mask > 0; mask /= 2) {
        int middle = (low + high) / 2, peer = fold_actual(f, f->rank ^ mask);
        bool upper = f->rank & mask;
        int64_t begin = place(k, f, low), half = place(k, f, middle), end = place(k, f, high);
        int64_t keep = upper ? half : begin, nkeep = upper ? end - half : half - begin;
        int64_t pass = upper ? begin : half, npass = upper ? half - begin : end - half;
        exchange(k, phase, peer, at(k, acc, pass), npass, peer, in, nkeep);
        combine(k, at(k, acc, keep), in, upper, nkeep);
        if (upper) low = middle;
        else high = middle;
    }
}

void regrow(const struct collective_call *k, const struct fold *f, int phase, void *acc, part_place_fn *place)
{
    for (int mask = 1; mask < f->core; mask *= 2) {
        int mine = f->rank & ~(mask - 1), other = mine ^ mask, peer = fold_actual(f, f->rank ^ mask);
        int64_t a = place(k, f, mine), b = place(k, f, other);
        exchange(k, phase, peer, at(k, acc, a), place(k, f, mine + mask) - a, peer, at(k, acc, b),
                 place(k, f, other + mask) - b);
    }
}

int64_t binomial_part_bytes(int64_t count, int size, int64_t element)
{
    int64_t sum = 0;
    for (int r = 1; r < size; r++) {
        int end = r + (r & -r) < size ? r + (r & -r) : size;
        sum += split(count, end, size) - split(count, r, size);
    }
    return sum * element;
}

int64_t binomial_block_count(int size)
{
    int64_t sum = 0;
    for (int r = 1; r < size; r++) sum += r + (r & -r) < size ? r & -r : size - r;
    return sum;
}

bool needs_power_of_two(const struct collective_shape *s) { return is_power_of_two(s->size); }
bool needs_commutative(const struct collective_shape *s) { return s->commutative; }
bool needs_regular(const struct collective_shape *s) { return !s->irregular; }
bool needs_regular_power_of_two(const struct collective_shape *s) { return !s->irregular && is_power_of_two(s->size); }

struct collective_shape collective_shape(const struct collective_call *k)
{
    struct collective_shape s = {
        .kind = k->kind, .size = comm_size(k->comm), .root = k->root, .count = k->count, .element = k->element};
    s.total = s.count * s.size;
    s.exclusive = k->exclusive;
    s.commutative = !k->op || k->op->commutative;
    s.idempotent = k->op && k->op->idempotent;
    s.irregular = k->counts || k->send_counts;
    if (!s.irregular || (k->kind != COLLECTIVE_ALLGATHER && k->kind != COLLECTIVE_REDUCE_SCATTER)) return s;
    s.total = s.count = 0;
    for (int r = 0; r < s.size; r++) {
        s.total += k->counts[r];
        if (k->counts[r] > s.count) s.count = k->counts[r];
    }
    return s;
}

const struct collective_algorithm *collective_in_table(const struct collective_table *t, const char *name)
{
    for (int i = 0; i < t->n; i++)
        if (strcmp(t->row[i].name, name) == 0) return &t->row[i];
    return NULL;
}
