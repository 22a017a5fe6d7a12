/* test_collectives.c - every algorithm of every collective: results equal to a serial reference,
 * costs to the closed form; any number of ranks, any size, any root. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/many_ranks.h"
#include "base/random.h"
#include "comm/collectives.h"

/* An element, and three operations: a sum, the composition of maps x -> ax + b, and a maximum; all
 * exact. */
struct pair {
    uint64_t a, b;
};

static void sum(void *into, const void *with, bool before, int64_t n, void *context, struct work *w)
{
    struct pair *x = into;
    const struct pair *y = with;
    (void)before, (void)context;
    for (int64_t i = 0; i < n; i++) x[i].a += y[i].a, x[i].b += y[i].b;
    w->flop += (uint64_t)n;
}

static void compose(void *into, const void *with, bool before, int64_t n, void *context,
                    struct work *w)
{
    struct pair *x = into;
    const struct pair *y = with;
    (void)context;
    for (int64_t i = 0; i < n; i++) {
        struct pair f = before ? y[i] : x[i], g = before ? x[i] : y[i];
        x[i] = (struct pair){f.a * g.a, f.a * g.b + f.b};
    }
    w->flop += (uint64_t)n;
}

static void largest(void *into, const void *with, bool before, int64_t n, void *context,
                    struct work *w)
{
    struct pair *x = into;
    const struct pair *y = with;
    (void)before, (void)context;
    for (int64_t i = 0; i < n; i++) {
        if (y[i].a > x[i].a) x[i].a = y[i].a;
        if (y[i].b > x[i].b) x[i].b = y[i].b;
    }
    w->flop += (uint64_t)n;
}

static const struct collective_op operation[] = {
    {sum, NULL, true, false, COMM_OWN},
    {compose, NULL, false, false, COMM_OWN},
    {largest, NULL, true, true, COMM_OWN}};

/* One call on all ranks. Element i of the block that rank r has for rank d is made from (r, d,
 * i). */
struct trial {
    const struct collective_algorithm *algorithm;
    struct collective_shape shape;
    const struct collective_op *op;
    /* irregular: (size x size) elements from r to d, alltoall; its first row: blocks */
    int64_t *matrix;
    /* (size) of the blocks in gather's recv, scatter's send: with gaps */
    int64_t *places;
    int64_t gap;
    bool in_place;
    struct collective_call call; /* of the rank checked last */
};

static struct pair made(int r, int d, int64_t i)
{
    uint64_t x = (uint64_t)r * 0x9e3779b97f4a7c15u ^ (uint64_t)(d + 1) * 0xc2b2ae3d27d4eb4fu ^
                 (uint64_t)(i + 7) * 0x165667b19e3779f9u;
    x ^= x >> 29, x *= 0xbf58476d1ce4e5b9u, x ^= x >> 32;
    return (struct pair){x | 1, x * 31 + 5};
}

static int64_t of_block(const struct trial *t, int r)
{
    return t->matrix ? t->matrix[r] : t->shape.count;
}
static int64_t from_to(const struct trial *t, int r, int d)
{
    return t->matrix ? t->matrix[r * t->shape.size + d] : t->shape.count;
}

/* The vector of rank r has all blocks, element i of block d being made(r, d, i); a plain vector is
 * block 0. */
static struct pair combined(const struct trial *t, int first, int end, int d, int64_t i)
{
    struct pair x = made(first, d, i);
    struct work w = {0};
    for (int r = first + 1; r < end; r++) {
        struct pair y = made(r, d, i);
        t->op->combine(&x, &y, false, 1, NULL, &w);
    }
    return x;
}

static bool same(struct pair x, struct pair y) { return x.a == y.a && x.b == y.b; }

static void expect(const struct trial *t, int rank, struct pair found, struct pair wanted)
{
    if (!same(found, wanted))
        fail_msg("%s %s: P = %d, root %d, %d elements%s: rank %d has another answer",
                 collective_name(t->shape.kind), t->algorithm->name, t->shape.size, t->shape.root,
                 (int)t->shape.count, t->matrix ? " (irregular)" : "", rank);
}

static int64_t place(const struct trial *t, int r)
{
    return t->places ? t->places[r] : t->shape.count * r;
}

/* What each collective is given. */
static void fill(const struct trial *t, int rank, struct pair *send, struct pair *recv)
{
    const struct collective_shape *s = &t->shape;
    switch (s->kind) {
    case COLLECTIVE_BROADCAST:
        for (int64_t i = 0; rank == s->root && i < s->count; i++) recv[i] = made(rank, 0, i);
        return;
    case COLLECTIVE_SCATTER:
    case COLLECTIVE_REDUCE_SCATTER:
        for (int d = 0; d < s->size && (s->kind != COLLECTIVE_SCATTER || rank == s->root); d++)
            for (int64_t i = 0; i < of_block(t, d); i++) send[place(t, d) + i] = made(rank, d, i);
        return;
    case COLLECTIVE_ALLTOALL: {
        int64_t at = 0;
        for (int d = 0; d < s->size; d++)
            for (int64_t i = 0; i < from_to(t, rank, d); i++) send[at++] = made(rank, d, i);
        return;
    }
    default:
        for (int64_t i = 0; i < of_block(t, t->matrix ? rank : 0); i++) send[i] = made(rank, 0, i);
        return;
    }
}

static void check_vector(const struct trial *t, int rank, const struct pair *recv)
{
    const struct collective_shape *s = &t->shape;
    bool scan = s->kind == COLLECTIVE_SCAN;
    int end = scan ? rank + !s->exclusive : s->size;
    if (end == 0 || (s->kind == COLLECTIVE_REDUCE && rank != s->root)) return;
    for (int64_t i = 0; i < s->count; i++)
        expect(t, rank, recv[i],
               s->kind == COLLECTIVE_BROADCAST ? made(s->root, 0, i) : combined(t, 0, end, 0, i));
}

static void check_blocks(const struct trial *t, int rank, const struct pair *recv)
{
    const struct collective_shape *s = &t->shape;
    int64_t at = 0;
    if (s->kind == COLLECTIVE_GATHER && rank != s->root) return;
    for (int r = 0; r < s->size; r++) {
        bool all = s->kind == COLLECTIVE_ALLTOALL;
        int64_t n = all ? from_to(t, r, rank) : of_block(t, r);
        for (int64_t i = 0; i < n; i++)
            expect(t, rank, recv[(all ? at : place(t, r)) + i], made(r, all ? rank : 0, i));
        at += n;
    }
}

static void check(const struct trial *t, int rank, const struct pair *recv)
{
    switch (t->shape.kind) {
    case COLLECTIVE_BARRIER:
        return;
    case COLLECTIVE_SCATTER:
        for (int64_t i = 0; i < of_block(t, rank); i++)
            expect(t, rank, recv[i], made(t->shape.root, rank, i));
        return;
    case COLLECTIVE_REDUCE_SCATTER:
        for (int64_t i = 0; i < of_block(t, rank); i++)
            expect(t, rank, recv[i], combined(t, 0, t->shape.size, rank, i));
        return;
    case COLLECTIVE_GATHER:
    case COLLECTIVE_ALLGATHER:
    case COLLECTIVE_ALLTOALL:
        check_blocks(t, rank, recv);
        return;
    default:
        check_vector(t, rank, recv);
    }
}

/* What a rank that is not root has for counts. */
static const int64_t unknown[1] = {INT64_MIN};

/* Row and column of the matrix as alltoall's counts. */
static void irregular(const struct trial *t, struct collective_call *k, int64_t *column)
{
    int rank = comm_rank(k->comm), P = t->shape.size;
    if (!t->matrix) return;
    for (int r = 0; r < P; r++)
        column[r] = t->shape.kind == COLLECTIVE_ALLTOALL ? from_to(t, r, rank) : of_block(t, r);
    k->count = of_block(t, rank);
    k->counts = column;
    if (t->shape.kind == COLLECTIVE_ALLTOALL) k->send_counts = t->matrix + rank * P;
    else if (t->places) k->places = t->places;
    bool root_only = t->shape.kind == COLLECTIVE_GATHER || t->shape.kind == COLLECTIVE_SCATTER;
    if (root_only && rank != t->shape.root) k->counts = unknown;
}

static void call(struct comm *c, void *context)
{
    struct trial *t = context;
    const struct collective_shape *s = &t->shape;
    int rank = comm_rank(c);
    size_t room = (size_t)(s->total + s->count + t->gap * s->size + 1);
    struct pair *send = calloc(room, sizeof *send), *recv = calloc(room, sizeof *recv);
    int64_t *column = calloc((size_t)s->size, sizeof *column);
    struct collective_call k = {
        .kind = s->kind, .comm = c, .tag = 3, .root = s->root, .count = s->count};
    k.element = sizeof(struct pair);
    k.op = t->op;
    k.exclusive = s->exclusive;
    irregular(t, &k, column);
    fill(t, rank, send, recv);
    if (t->in_place) memcpy(recv, send, room * sizeof *recv);
    k.send = t->in_place ? recv : send;
    k.recv = recv;
    int64_t bytes = collective_scratch(t->algorithm, s, rank);
    unsigned char *scratch = malloc((size_t)bytes + 8);
    memset(scratch, 0xa5, (size_t)bytes + 8);
    k.scratch = scratch;
    collective_run(t->algorithm, &k);
    check(t, rank, recv);
    for (int i = 0; i < 8; i++) assert_int_equal(scratch[bytes + i], 0xa5);
    free(scratch), free(column), free(recv), free(send);
}

static void same_count(const struct trial *t, const char *what, int64_t found, int64_t wanted)
{
    if (found != wanted)
        fail_msg("%s %s: P = %d, root %d, %d elements: %lld %s, the closed form says %lld",
                 collective_name(t->shape.kind), t->algorithm->name, t->shape.size, t->shape.root,
                 (int)t->shape.count, (long long)found, what, (long long)wanted);
}

static void run_trial(struct trial *t)
{
    if (!collective_applies(t->algorithm, &t->shape)) return;
    struct many_ranks_result r = many_ranks_run(t->shape.size, call, t);
    same_count(t, "ranks that wait for ever", r.blocked, 0);
    same_count(t, "messages unread", r.unread, 0);
    if (t->matrix) return;
    struct collective_cost cost;
    t->algorithm->cost(&t->shape, &cost);
    same_count(t, "messages", r.messages, cost.messages);
    same_count(t, "bytes", r.bytes, cost.bytes);
    same_count(t, "rounds", r.rounds, cost.rounds);
    if (cost.path >= 0) same_count(t, "bytes one after the other", r.path, cost.path);
    same_count(t, "elements combined", (int64_t)r.stage_work[0].flop, cost.combined);
    same_count(t, "bytes copied", (int64_t)r.stage_work[0].bytes, cost.copied);
}

static const int sizes[] = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18,
                            19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 64, 100};
enum { SIZES = sizeof sizes / sizeof sizes[0] };

/* Every algorithm, every operation, at these numbers. */
static void all_algorithms(enum collective_kind kind, int P, int64_t count, int root,
                           bool exclusive)
{
    int n;
    const struct collective_algorithm *row = collective_algorithms(kind, &n);
    for (int i = 0; i < n; i++)
        for (size_t op = 0; op < sizeof operation / sizeof *operation; op++) {
            struct trial t = {.algorithm = &row[i], .op = &operation[op]};
            t.shape = (struct collective_shape){
                kind,  P,     root,  count,    count * P, sizeof(struct pair),
                false, false, false, exclusive, COMM_OWN, NULL};
            t.shape.commutative = t.op->commutative;
            t.shape.idempotent = t.op->idempotent;
            t.in_place = kind == COLLECTIVE_ALLREDUCE && (count + root) % 2;
            run_trial(&t);
        }
}

static void results_and_costs(void **state)
{
    (void)state;
    struct random s = random_make(11, 0, 0);
    for (int i = 0; i < SIZES; i++) {
        int P = sizes[i];
        int few = P > 33 ? 2 : P > 9 ? 4 : 8;
        const int64_t count[] = {1 + (int64_t)random_below(&s, 70), P, 1, 0, 2, 5, 3 * P, 1200};
        for (int kind = 0; kind < COLLECTIVE_KINDS; kind++)
            for (int c = 0; c < few; c++) {
                int root = c % 3 == 0 ? (int)random_below(&s, (uint64_t)P) : c % 3 == 1 ? P - 1 : 0;
                all_algorithms((enum collective_kind)kind, P, count[c], root, (c + P) % 2);
            }
    }
}

/* Blocks of any sizes, none among them, with and without gaps between them. */
static void irregular_trial(enum collective_kind kind, int P, struct random *s)
{
    int n;
    const struct collective_algorithm *row = collective_algorithms(kind, &n);
    int64_t *matrix = calloc((size_t)P * (size_t)P, sizeof *matrix),
            *places = calloc((size_t)P, sizeof *places);
    for (int i = 0; i < P * P; i++)
        matrix[i] = random_below(s, 3) == 0 ? 0 : (int64_t)random_below(s, 10);
    struct trial t = {.matrix = matrix, .places = places, .gap = 1};
    t.shape = (struct collective_shape){
        kind,  P,    (int)random_below(s, (uint64_t)P), 9, 0, sizeof(struct pair), true, true,
        false, false, COMM_OWN, NULL};
    int64_t at = 0;
    bool gaps = kind == COLLECTIVE_GATHER || kind == COLLECTIVE_SCATTER || random_below(s, 2);
    for (int r = 0; r < P; r++) {
        places[r] = at;
        at += matrix[r] + gaps;
        t.shape.total += kind == COLLECTIVE_ALLTOALL ? 9 : matrix[r];
    }
    for (int i = 0; i < n; i++)
        for (size_t op = 0; op < sizeof operation / sizeof *operation; op++) {
            t.algorithm = &row[i];
            t.op = &operation[op];
            t.shape.commutative = t.op->commutative;
            run_trial(&t);
        }
    free(places), free(matrix);
}

static void blocks_of_different_sizes(void **state)
{
    (void)state;
    static const enum collective_kind kinds[] = {COLLECTIVE_GATHER, COLLECTIVE_SCATTER,
                                                 COLLECTIVE_ALLGATHER, COLLECTIVE_ALLTOALL,
                                                 COLLECTIVE_REDUCE_SCATTER};
    struct random s = random_make(5, 0, 0);
    for (int i = 0; i < SIZES; i++)
        for (int repeat = 0; repeat < (sizes[i] > 9 ? 1 : 4); repeat++)
            for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
                irregular_trial(kinds[k], sizes[i], &s);
}

/* Each row applies somewhere, names itself once, and is found. */
static void tables_are_whole(void **state)
{
    (void)state;
    for (int kind = 0; kind < COLLECTIVE_KINDS; kind++) {
        int n;
        const struct collective_algorithm *row =
            collective_algorithms((enum collective_kind)kind, &n);
        assert_int_equal(collective_find(collective_name((enum collective_kind)kind)), kind);
        assert_true(n >= 2);
        for (int i = 0; i < n; i++) {
            assert_ptr_equal(collective_algorithm_find((enum collective_kind)kind, row[i].name),
                             &row[i]);
            assert_true(row[i].run && row[i].cost && row[i].source);
            assert_int_equal(row[i].needs != NULL, row[i].applies != NULL);
        }
    }
    assert_int_equal(collective_find("broadcasts"), COLLECTIVE_KINDS);
    assert_null(collective_algorithm_find(COLLECTIVE_SCAN, "bruck"));
}

static const char *chosen(enum collective_kind kind, int P, int64_t count, bool commutative)
{
    struct collective_shape s = {kind, P, 0, count, count * P, 1, false, commutative, false, false,
                                 COMM_OWN, NULL};
    return collective_choose(&s, NULL, 0)->name;
}

static void default_choice_is_mpichs(void **state)
{
    (void)state;
    assert_string_equal(chosen(COLLECTIVE_BROADCAST, 64, 12287, true), "binomial");
    assert_string_equal(chosen(COLLECTIVE_BROADCAST, 64, 12288, true),
                        "scatter-recursive-doubling");
    assert_string_equal(chosen(COLLECTIVE_BROADCAST, 60, 12288, true), "scatter-allgather");
    assert_string_equal(chosen(COLLECTIVE_BROADCAST, 64, 524288, true), "scatter-allgather");
    assert_string_equal(chosen(COLLECTIVE_BROADCAST, 7, 524288, true), "binomial");
    assert_string_equal(chosen(COLLECTIVE_REDUCE, 64, 2048, true), "binomial");
    assert_string_equal(chosen(COLLECTIVE_REDUCE, 64, 2049, true), "rabenseifner");
    assert_string_equal(chosen(COLLECTIVE_REDUCE, 64, 2049, false), "binomial");
    assert_string_equal(chosen(COLLECTIVE_ALLREDUCE, 64, 2048, true), "recursive-doubling");
    assert_string_equal(chosen(COLLECTIVE_ALLREDUCE, 5000, 4095, true), "recursive-doubling");
    assert_string_equal(chosen(COLLECTIVE_ALLREDUCE, 5000, 4096, true), "rabenseifner");
    assert_string_equal(chosen(COLLECTIVE_ALLGATHER, 64, 8191, true), "recursive-doubling");
    assert_string_equal(chosen(COLLECTIVE_ALLGATHER, 64, 8192, true), "ring");
    assert_string_equal(chosen(COLLECTIVE_ALLGATHER, 10, 8191, true), "bruck");
    assert_string_equal(chosen(COLLECTIVE_ALLGATHER, 10, 8192, true), "ring");
    assert_string_equal(chosen(COLLECTIVE_ALLTOALL, 8, 256, true), "bruck");
    assert_string_equal(chosen(COLLECTIVE_ALLTOALL, 7, 256, true), "linear");
    assert_string_equal(chosen(COLLECTIVE_ALLTOALL, 8, 32769, true), "xor");
    assert_string_equal(chosen(COLLECTIVE_ALLTOALL, 9, 32769, true), "pairwise");
    assert_string_equal(chosen(COLLECTIVE_REDUCE_SCATTER, 8, 65535, true), "recursive-halving");
    assert_string_equal(chosen(COLLECTIVE_REDUCE_SCATTER, 8, 65536, true), "pairwise");
    assert_string_equal(chosen(COLLECTIVE_REDUCE_SCATTER, 8, 65536, false), "reduce-then-scatter");
}

static void rules_come_before_the_default(void **state)
{
    (void)state;
    const struct collective_algorithm *ring =
        collective_algorithm_find(COLLECTIVE_ALLREDUCE, "ring");
    const struct collective_algorithm *trees =
        collective_algorithm_find(COLLECTIVE_ALLREDUCE, "reduce-broadcast");
    const struct collective_rule rule[] = {{COLLECTIVE_ALLREDUCE, trees, 0, 0},
                                           {COLLECTIVE_ALLREDUCE, ring, 1000, 16}};
    struct collective_shape s = {
        COLLECTIVE_ALLREDUCE, 16, 0, 1000, 16000, 1, false, true, false, false, COMM_OWN, NULL};
    assert_ptr_equal(collective_choose(&s, rule, 2), ring);
    s.count = 999;
    assert_ptr_equal(collective_choose(&s, rule, 2), trees);
    s.count = 1000, s.size = 15;
    assert_ptr_equal(collective_choose(&s, rule, 2), trees);
    s.size = 16, s.commutative = false; /* the ring cannot do it */
    assert_ptr_equal(collective_choose(&s, rule, 2), trees);
    s.kind = COLLECTIVE_REDUCE;
    assert_string_equal(collective_choose(&s, rule, 2)->name, "binomial");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_are_whole),          cmocka_unit_test(results_and_costs),
        cmocka_unit_test(blocks_of_different_sizes), cmocka_unit_test(default_choice_is_mpichs),
        cmocka_unit_test(rules_come_before_the_default),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
