/* test_jumps.c - sizes at which made-up times leave their line: found where they are, and nowhere
 * else. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "reality/jumps.h"

static void add(struct messages *m, int64_t bytes, double one_way)
{
    m->point[m->n++] = (struct message_point){.bytes = bytes, .one_way = one_way};
}

/* 0.2 us + 0.1 ns/B; from `jump` on 0.5 us more. */
static double time_of(int64_t bytes, int64_t jump)
{
    return 2e-7 + 1e-10 * (double)bytes + (bytes >= jump ? 5e-7 : 0);
}

static struct messages made(int64_t jump, double noise)
{
    struct messages m = {.eager_most = INT64_MAX};
    add(&m, 0, 2e-7);
    for (int64_t b = 8; b <= 1 << 20; b *= 2)
        add(&m, b, time_of(b, jump) * (1 + (m.n % 2 ? noise : -noise)));
    return m;
}

static void one_line_is_one_piece(void **state)
{
    (void)state;
    int first[SOFTWARE_MAX_SEGMENTS];
    const struct messages m = made(INT64_MAX, 0.02);
    assert_int_equal(jumps_find(&m, first), 1);
    assert_int_equal(first[0], 0);
    assert_int_equal(jumps_open(&m), -1);
    const struct messages alone = {.n = 1, .point = {{.bytes = 8, .one_way = 1e-6}}};
    assert_int_equal(jumps_find(&alone, first), 1);
    assert_int_equal(jumps_open(&alone), -1);
}

static void a_jump_is_found_and_closed_in(void **state)
{
    (void)state;
    int first[SOFTWARE_MAX_SEGMENTS];
    const int64_t jump = 6000;
    struct messages m = made(jump, 0.01);
    assert_int_equal(jumps_find(&m, first), 2);
    assert_int_equal(m.point[first[1]].bytes, 8192);
    assert_true(fabs(jumps_height(&m, first[1]) - 5e-7 / time_of(8192, INT64_MAX)) < 0.1);
    /* As messages.c does it: halving ends near the jump, on both sides of it. */
    for (int64_t size; (size = jumps_open(&m)) >= 0;) {
        assert_true(size > 4096 && size < 8192);
        assert_true(m.n < MESSAGES_SIZES);
        int i = m.n++;
        for (; m.point[i - 1].bytes > size; i--) m.point[i] = m.point[i - 1];
        m.point[i] = (struct message_point){.bytes = size, .one_way = time_of(size, jump)};
    }
    assert_int_equal(jumps_find(&m, first), 2);
    const int64_t below = m.point[first[1] - 1].bytes, from = m.point[first[1]].bytes;
    assert_true(below < jump && from >= jump);
    assert_true(from - below <= from / 8 + 1);
}

/* A hand-shake divides, although its times would lie on the line of the others. */
static void the_switch_divides_whatever_the_times(void **state)
{
    (void)state;
    int first[SOFTWARE_MAX_SEGMENTS];
    struct messages m = made(INT64_MAX, 0);
    for (int i = 0; i < m.n; i++) m.point[i].rendezvous = m.point[i].bytes >= 16384;
    assert_int_equal(jumps_find(&m, first), 2);
    assert_int_equal(m.point[first[1]].bytes, 16384);
    assert_int_equal(jumps_open(&m), -1);
}

static void there_are_no_more_pieces_than_segments(void **state)
{
    (void)state;
    int first[SOFTWARE_MAX_SEGMENTS];
    struct messages m = {.eager_most = INT64_MAX};
    for (int i = 0; i < MESSAGES_SIZES; i++)
        add(&m, 64 * i, (i / 2) % 2 ? 1e-6 : 3e-6); /* no line at all */
    const int n = jumps_find(&m, first);
    assert_int_equal(n, SOFTWARE_MAX_SEGMENTS);
    for (int k = 1; k < n; k++) assert_true(first[k] > first[k - 1] && first[k] < m.n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_line_is_one_piece),
        cmocka_unit_test(a_jump_is_found_and_closed_in),
        cmocka_unit_test(the_switch_divides_whatever_the_times),
        cmocka_unit_test(there_are_no_more_pieces_than_segments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
