/* collectives_internal.h - what the algorithms of the collectives share: blocks, exchanges,
 * operations, powers of two.
 *
 * A new algorithm is a function, its cost and a row in its collective's table. */
#ifndef COMM_COLLECTIVES_INTERNAL_H
#define COMM_COLLECTIVES_INTERNAL_H

#include <string.h>

#include "comm/collectives.h"

struct collective_table {
    const struct collective_algorithm *row;
    int n;
};

/* One per collective, at the end of its file. */
extern const struct collective_table barrier_algorithms, broadcast_algorithms, reduce_algorithms,
    allreduce_algorithms, gather_algorithms, scatter_algorithms, allgather_algorithms,
    alltoall_algorithms, scan_algorithms, reduce_scatter_algorithms;

#define COLLECTIVE_TABLE(name, rows)                                                               \
    const struct collective_table name = {rows, (int)(sizeof rows / sizeof rows[0])}

/* log2_floor, log2_ceil: of n >= 1. */
static inline int log2_floor(int n) { return 31 - __builtin_clz((unsigned)n); }
static inline int log2_ceil(int n) { return n > 1 ? log2_floor(n - 1) + 1 : 0; }
static inline bool is_power_of_two(int n) { return (n & (n - 1)) == 0; }

/* split: where part i of n begins when `count` elements are dealt out evenly. */
static inline int64_t split(int64_t count, int i, int n)
{
    return count / n * i + count % n * i / n;
}

/* ranks `distance` up or down the ring. */
static inline int ring_up(int rank, int distance, int size)
{
    return (rank + distance % size) % size;
}
static inline int ring_down(int rank, int distance, int size)
{
    return (rank - distance % size + size) % size;
}

/* Ranks beyond the largest power of two sit out: of the first 2 rest ranks the even ones, whose
 * right neighbours work for them. Order is kept (Thakur, Rabenseifner, Gropp 2005). */
struct fold {
    int core, rest; /* core: a power of two; core + rest = size */
    int rank;       /* within the core; -1: sits out */
};
struct fold fold_make(int rank, int size);
static inline int fold_actual(const struct fold *f, int r)
{
    return r < f->rest ? 2 * r + 1 : r + f->rest;
}

/* block_count, block_place: elements of block r of recv (or of the blocks that gather, scatter and
 * reduce-scatter have one list of), and where it begins. send_block_*: of alltoall's send. */
static inline int64_t block_count(const struct collective_call *k, int r)
{
    return k->counts ? k->counts[r] : k->count;
}
int64_t block_place(const struct collective_call *k, int r);
static inline int64_t send_block_count(const struct collective_call *k, int r)
{
    return k->send_counts ? k->send_counts[r] : k->count;
}
int64_t send_block_place(const struct collective_call *k, int r);

/* at: element `place` of a buffer. */
static inline void *at(const struct collective_call *k, void *buffer, int64_t place)
{
    return buffer ? (char *)buffer + place * k->element : NULL;
}
static inline const void *at_const(const struct collective_call *k, const void *buffer,
                                   int64_t place)
{
    return buffer ? (const char *)buffer + place * k->element : NULL;
}

/* give, take: a message of n elements; `phase` is added to the tag. exchange: both at a time, waits
 * for both. */
static inline void give(const struct collective_call *k, int phase, int dst, const void *data,
                        int64_t n)
{
    comm_send(k->comm, dst, k->tag + phase, data, n * k->element);
}
static inline void take(const struct collective_call *k, int phase, int src, void *data, int64_t n)
{
    comm_recv(k->comm, src, k->tag + phase, data, n * k->element);
}
void exchange(const struct collective_call *k, int phase, int dst, const void *out, int64_t nout,
              int src, void *in, int64_t nin);

/* own_copy: the own block from send to recv, which costs no time. copy: any other, which does. */
void own_copy(const struct collective_call *k, void *to, const void *from, int64_t n);
void copy(const struct collective_call *k, void *to, const void *from, int64_t n);

/* combine: into = into op with, or with op into when `before`. */
void combine(const struct collective_call *k, void *into, const void *with, bool before, int64_t n);

/* fold_in: the ranks that sit out hand acc (n elements) to their neighbours, which add it.
 * fold_out: and get the answer back in acc. `in` has room for n elements. */
void fold_in(const struct collective_call *k, const struct fold *f, int phase, void *acc, void *in,
             int64_t n);
void fold_out(const struct collective_call *k, const struct fold *f, int phase, void *acc,
              int64_t n);

/* Recursive halving and doubling within the core over parts first .. first[core] (elements of acc):
 * after halve rank r of the core has part r combined; regrow gives everybody all parts. place:
 * where part p begins. */
typedef int64_t part_place_fn(const struct collective_call *k, const struct fold *f, int part);
void halve(const struct collective_call *k, const struct fold *f, int phase, void *acc, void *in,
           part_place_fn *place);
void regrow(const struct collective_call *k, const struct fold *f, int phase, void *acc,
            part_place_fn *place);
int64_t even_part(const struct collective_call *k, const struct fold *f, int part);

/* What the messages of a binomial tree carry when each has its receiver's whole subtree: bytes of a
 * vector dealt out evenly over the ranks; blocks, one a rank. */
int64_t binomial_part_bytes(int64_t count, int size, int64_t element);
int64_t binomial_block_count(int size);

/* The algorithm "hardware" of each collective that a network may do (collectives_hardware.c), and
 * what it needs in words. */
extern const char collective_hardware_needs[];
bool needs_hardware(const struct collective_shape *s);
int64_t hardware_scratch(const struct collective_shape *s, int rank);
void hardware_run(const struct collective_call *k);
void hardware_cost(const struct collective_shape *s, struct collective_cost *out);
#define HARDWARE_ROW                                                                               \
    {"hardware", collective_hardware_needs, "the machine's file", needs_hardware,                  \
     hardware_scratch, hardware_run, hardware_cost}

/* Conditions for tables. */
bool needs_power_of_two(const struct collective_shape *s);
bool needs_commutative(const struct collective_shape *s);
bool needs_regular(const struct collective_shape *s);
bool needs_regular_power_of_two(const struct collective_shape *s);

/* collective_in_table: the algorithm of that name, NULL when the table has none. */
const struct collective_algorithm *collective_in_table(const struct collective_table *t,
                                                       const char *name);

#endif
