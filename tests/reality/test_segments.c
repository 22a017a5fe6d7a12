/* test_segments.c - segments out of points whose parameters are known: they come out again, and the
 * time of a message is kept whatever the split. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "reality/segments.h"

/* o_s = 100 ns + 0.1 ns/B, o_r = 80 ns + 0.2 ns/B, latency 50 ns, G = 0.05 ns/B. */
static void add(struct messages *m, int64_t bytes)
{
    struct message_point *p = &m->point[m->n++];
    const double b = (double)bytes;
    *p = (struct message_point){.bytes = bytes, .send = 1e-7 + 1e-10 * b, .recv = 8e-8 + 2e-10 * b};
    p->one_way = p->send + p->recv + 5e-8 + 0.5e-10 * b;
    p->train = p->send;
}

static void near(double x, double y) { assert_true(fabs(x - y) <= 1e-6 * fabs(y)); }

static void eager(void **state)
{
    struct messages m = {.eager_most = INT64_MAX};
    struct fitted_segment s[SOFTWARE_MAX_SEGMENTS];
    (void)state;
    for (int64_t b = 0; b <= 512; b += 128) add(&m, b);
    add(&m, 1024);
    add(&m, 4096);
    assert_int_equal(segments_of(&m, s), 1);
    for (int i = 0; i < 1; i++) {
        near(s[i].segment.send_overhead, 1e-7);
        near(s[i].segment.send_copy, 1e-10);
        near(s[i].segment.recv_overhead, 8e-8);
        near(s[i].segment.recv_copy, 2e-10);
        near(s[i].segment.latency, 5e-8);
        near(s[i].segment.gap_per_byte, 0.5e-10);
        assert_true(s[i].segment.gap == 0 && s[i].one_way < 1e-6);
        assert_int_equal(s[i].segment.protocol, PROTOCOL_EAGER);
    }
}

/* Trains that are slower than either end ask for a gap. */
static void gaps(void **state)
{
    struct messages m = {.eager_most = INT64_MAX};
    struct fitted_segment s[SOFTWARE_MAX_SEGMENTS];
    (void)state;
    add(&m, 0);
    add(&m, 64);
    for (int i = 0; i < m.n; i++) m.point[i].train = 5e-7 + 0.5e-10 * (double)m.point[i].bytes;
    assert_int_equal(segments_of(&m, s), 1);
    near(s[0].segment.gap, 5e-7);
}

/* A receive that is slower alone than in a round trip: nothing is negative, the sum stays. */
static void slow_alone(void **state)
{
    struct messages m = {.eager_most = INT64_MAX};
    struct fitted_segment s[SOFTWARE_MAX_SEGMENTS];
    (void)state;
    add(&m, 0);
    add(&m, 512);
    for (int i = 0; i < m.n; i++) m.point[i].recv *= 10;
    assert_int_equal(segments_of(&m, s), 1);
    assert_true(s[0].segment.latency == 0 || s[0].segment.latency < 1e-12);
    near(s[0].segment.send_overhead + s[0].segment.recv_overhead, m.point[0].one_way);
    assert_true(s[0].one_way < 1e-6);
}

/* Behind the switch: hand-shakes of two short messages, then the rate. */
static void rendezvous(void **state)
{
    struct messages m = {.eager_most = 1024};
    struct fitted_segment s[SOFTWARE_MAX_SEGMENTS];
    (void)state;
    add(&m, 0);
    add(&m, 512);
    for (int64_t b = 2048; b <= 8000; b += 2048) {
        add(&m, b);
        m.point[m.n - 1].rendezvous = true;
        m.point[m.n - 1].one_way =
            m.point[m.n - 1].send + 8e-8 + 2 * 5e-8 + 1e-6 + 3e-10 * (double)b;
    }
    assert_int_equal(segments_of(&m, s), 2);
    assert_int_equal(s[1].segment.protocol, PROTOCOL_RENDEZVOUS);
    assert_int_equal(s[1].segment.from, 2048);
    near(s[1].segment.rendezvous_latency, 1e-6);
    near(s[1].segment.gap_per_byte, 3e-10);
    assert_true(s[1].one_way < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(eager), cmocka_unit_test(gaps),
                                       cmocka_unit_test(slow_alone), cmocka_unit_test(rendezvous)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
