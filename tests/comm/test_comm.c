/* test_comm.c - one rank alone counts its work; collectives reach every rank with the right bits
 * and no message more. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../support/many_ranks.h"
#include "comm/collectives.h"
#include "comm/comm_serial.h"

enum { MOST_RANKS = 17, NUMBERS = 150 };

static int64_t rounds_of(int size)
{
    int64_t rounds = 0;
    while ((1 << rounds) < size) rounds++;
    return rounds;
}

static void one_rank_counts_its_work_by_stage(void **unused)
{
    (void)unused;
    struct comm_serial s = comm_serial_make();
    const struct work first = {.flop = 3, .div = 1}, second = {.flop = 4, .trig = 2, .call = 1};
    double data[2] = {1.5, -2};
    assert_int_equal(comm_size(&s.comm), 1);
    assert_int_equal(comm_rank(&s.comm), 0);
    comm_work(&s.comm, &first);
    comm_stage(&s.comm, 2);
    comm_work(&s.comm, &second);
    comm_work(&s.comm, &second);
    collective_barrier(&s.comm, 0);
    collective_broadcast(&s.comm, 0, 10, data, sizeof data);
    collective_sum(&s.comm, 20, data, 2);
    comm_barrier(&s.comm);
    assert_int_equal(s.work[0].flop, 3);
    assert_int_equal(s.work[0].div, 1);
    assert_int_equal(s.work[1].flop, 0);
    assert_int_equal(s.work[2].flop, 8);
    assert_int_equal(s.work[2].trig, 4);
    assert_int_equal(s.work[2].call, 2);
    assert_int_equal(comm_now_ps(&s.comm), 0);
    assert_true(data[0] == 1.5 && data[1] == -2);
}

struct scene {
    int root, entered, size;
    double sum[MOST_RANKS][NUMBERS];
    char word[MOST_RANKS][32];
    int seen[MOST_RANKS]; /* how many had entered the barrier when this rank left it */
};

static void meet(struct comm *c, void *context)
{
    struct scene *s = context;
    s->entered++;
    collective_barrier(c, 5);
    s->seen[comm_rank(c)] = s->entered;
}

static void a_barrier_holds_until_all_have_entered(void **unused)
{
    (void)unused;
    for (int size = 1; size <= MOST_RANKS; size++) {
        struct scene s = {0};
        struct many_ranks_result r = many_ranks_run(size, meet, &s);
        for (int i = 0; i < size; i++) assert_int_equal(s.seen[i], size);
        assert_int_equal(r.messages, size * rounds_of(size));
        assert_int_equal(r.bytes, 0);
        assert_int_equal(r.blocked + r.unread, 0);
    }
}

static void tell(struct comm *c, void *context)
{
    struct scene *s = context;
    char *word = s->word[comm_rank(c)];
    if (comm_rank(c) == s->root) strcpy(word, "from the root");
    collective_broadcast(c, s->root, 3, word, sizeof s->word[0]);
}

static void a_broadcast_reaches_all_from_every_root(void **unused)
{
    (void)unused;
    for (int size = 1; size <= MOST_RANKS; size++) {
        for (int root = 0; root < size; root++) {
            struct scene s = {.root = root};
            struct many_ranks_result r = many_ranks_run(size, tell, &s);
            for (int i = 0; i < size; i++) assert_string_equal(s.word[i], "from the root");
            assert_int_equal(r.messages, size - 1);
            assert_int_equal(r.blocked + r.unread, 0);
        }
    }
}

static double number(int rank, int k) { return sin(1 + rank * 0.7 + k * 1.3) / (1 + k % 7); }

static void add_up(struct comm *c, void *context)
{
    struct scene *s = context;
    double *x = s->sum[comm_rank(c)];
    for (int k = 0; k < NUMBERS; k++) x[k] = number(comm_rank(c), k);
    collective_sum(c, 40, x, NUMBERS);
}

static void a_sum_is_right_and_the_same_on_every_rank(void **unused)
{
    (void)unused;
    for (int size = 1; size <= MOST_RANKS; size++) {
        struct scene s = {0};
        struct many_ranks_result r = many_ranks_run(size, add_up, &s);
        for (int k = 0; k < NUMBERS; k++) {
            long double expected = 0;
            for (int i = 0; i < size; i++) expected += number(i, k);
            assert_true(fabs((double)(s.sum[0][k] - expected)) < 1e-15 * 2 * size);
        }
        for (int i = 1; i < size; i++) assert_memory_equal(s.sum[i], s.sum[0], sizeof s.sum[0]);
        assert_int_equal(r.blocked + r.unread, 0);
        assert_int_equal(r.stage_work[0].flop, (uint64_t)(size - 1) * NUMBERS);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_rank_counts_its_work_by_stage),
        cmocka_unit_test(a_barrier_holds_until_all_have_entered),
        cmocka_unit_test(a_broadcast_reaches_all_from_every_root),
        cmocka_unit_test(a_sum_is_right_and_the_same_on_every_rank),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
