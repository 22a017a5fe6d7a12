/* test_host_comm.c - comm.h on an MPI: messages, tags, matching, clocks and what is published, on a
 * job of one process whose messages come back to it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "comm/collectives.h"
#include "echo.h"
#include "host/host_comm.h"

static struct hosts job;

static struct host_comm *begin(bool timed, struct comm **c)
{
    struct err e;
    err_clear(&e);
    job = echo_hosts(32767);
    struct host_comm *h = host_comm_create(&job, &e);
    assert_non_null(h);
    *c = host_comm_run_begin(h, timed, 3, NULL, 0);
    return h;
}

static bool end(struct host_comm *h, struct host_times *t)
{
    bool left = true;
    assert_true(host_comm_run_end(h, t, &left));
    return left;
}

/* Data may change after the send; requests tell of what came. */
static void messages_arrive(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(false, &c);
    struct comm_request s, r;
    struct host_times t;
    int out = 7, in = 0;
    (void)state;
    comm_irecv(c, 0, 5, &in, sizeof in, &r);
    comm_isend(c, 0, 5, &out, sizeof out, &s);
    out = 8;
    comm_wait(c, &r);
    assert_int_equal(in, 7);
    assert_false(r.active);
    comm_wait(c, &s);
    comm_wait(c, &s); /* a complete one is complete */
    assert_false(end(h, &t));
    assert_int_equal(t.messages, 1);
    assert_int_equal(t.bytes, sizeof out);
    host_comm_destroy(h);
}

/* Sends that nobody waits for use their memory again, also when MPI takes its time with them. */
static void forgotten_sends(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(false, &c);
    struct host_times t;
    (void)state;
    echo_slow(3);
    for (int i = 0; i < 40; i++) {
        char out[300], in[300];
        memset(out, i, sizeof out);
        comm_send(c, 0, i, out, 10 + 5 * i);
        comm_recv(c, 0, i, in, 10 + 5 * i);
        assert_memory_equal(in, out, (size_t)(10 + 5 * i));
    }
    assert_false(end(h, &t));
    assert_int_equal(t.messages, 40);
    host_comm_destroy(h);
}

/* The tags of collectives lie beyond what this MPI has. */
static void far_tags(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(true, &c);
    struct comm_request r;
    struct host_times t;
    int out = 3, in = 0;
    (void)state;
    comm_send(c, 0, (1 << 30) + COLLECTIVE_TAGS - 1, &out, sizeof out);
    comm_irecv_matching(c, COMM_ANY_SOURCE, 0, 0, &in, sizeof in, &r);
    comm_wait(c, &r);
    assert_int_equal(r.tag, (1 << 30) + COLLECTIVE_TAGS - 1);
    assert_int_equal(in, 3);
    assert_false(end(h, &t));
    host_comm_destroy(h);
}

/* What nobody received is found and thrown away before the next run. */
static void leftovers(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(false, &c);
    struct host_times t;
    (void)state;
    comm_send(c, 0, 1, "x", 1);
    assert_true(end(h, &t));
    assert_int_equal(echo_under_way(), 0);
    c = host_comm_run_begin(h, true, 1, NULL, 0);
    comm_send(c, 0, 1, "y", 1);
    struct comm_envelope seen;
    assert_true(comm_probe(c, 0, 1, COMM_WHOLE_TAG, 1, &seen));
    assert_true(end(h, &t));
    host_comm_destroy(h);
}

/* The message that came first, to the receive that was posted first, by the bits of the mask. */
static void matching(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(true, &c);
    struct comm_request r[3];
    struct comm_request *list[3] = {&r[0], NULL, &r[2]};
    struct host_times t;
    int in[3] = {0};
    (void)state;
    comm_irecv_matching(c, 0, 0x10, 0xf0, &in[0], sizeof in[0], &r[0]);
    comm_irecv_matching(c, COMM_ANY_SOURCE, 0, 0, &in[2], sizeof in[2], &r[2]);
    assert_int_equal(comm_test_any(c, 3, list), -1);
    for (int k = 0; k < 2; k++) {
        const int value = 100 + k;
        comm_send(c, 0, k == 0 ? 0x21 : 0x1f, &value, sizeof value);
    }
    /* 0x21 does not fit the first receive, 0x1f fits it by its mask. */
    assert_int_equal(comm_wait_any(c, 3, list), 2);
    assert_int_equal(in[2], 100);
    assert_int_equal(comm_wait_any(c, 3, list), 0);
    assert_int_equal(in[0], 101);
    assert_int_equal(r[0].tag, 0x1f);
    assert_int_equal(comm_wait_any(c, 3, list), -1);
    assert_false(end(h, &t));
    host_comm_destroy(h);
}

/* Too long a message is cut; its full size is told. */
static void cut(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(true, &c);
    struct comm_request r;
    struct host_times t;
    char in[4] = "abc";
    (void)state;
    comm_send(c, 0, 2, "123456", 6);
    comm_irecv_matching(c, 0, 2, COMM_WHOLE_TAG, in, 2, &r);
    comm_wait(c, &r);
    assert_int_equal(r.truncated, 1);
    assert_int_equal(r.bytes, 6);
    assert_string_equal(in, "12c");
    assert_false(end(h, &t));
    host_comm_destroy(h);
}

static void probes(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(true, &c);
    struct comm_envelope seen = {0};
    struct comm_request taken, other;
    struct host_times t;
    char in[8] = "";
    (void)state;
    assert_false(comm_probe(c, COMM_ANY_SOURCE, 0, 0, 0, &seen));
    comm_send(c, 0, 4, "first", 6);
    comm_send(c, 0, 4, "second", 7);
    assert_true(comm_probe_take(c, 0, 4, COMM_WHOLE_TAG, 1, &seen, &taken));
    assert_int_equal(seen.bytes, 6);
    /* The probed message is bound: the next receive gets the other one. */
    comm_irecv_matching(c, 0, 4, COMM_WHOLE_TAG, in, sizeof in, &other);
    comm_wait(c, &other);
    assert_string_equal(in, "second");
    comm_receive_into(c, &taken, in, 6);
    comm_wait(c, &taken);
    assert_string_equal(in, "first");
    assert_false(end(h, &t));
    host_comm_destroy(h);
}

static void cancels(void **state)
{
    struct comm *c;
    struct host_comm *h = begin(true, &c);
    struct comm_request r;
    struct host_times t;
    int in = 0, out = 9;
    (void)state;
    comm_irecv_matching(c, 0, 6, COMM_WHOLE_TAG, &in, sizeof in, &r);
    assert_int_equal(comm_cancel(c, &r), 1);
    assert_false(r.active);
    comm_irecv_matching(c, 0, 6, COMM_WHOLE_TAG, &in, sizeof in, &r);
    comm_send(c, 0, 6, &out, sizeof out);
    assert_int_equal(comm_cancel(c, &r), 0);
    comm_wait(c, &r);
    assert_int_equal(in, 9);
    struct comm_request s;
    echo_slow(2);
    comm_isend_synchronous(c, 0, 7, &out, sizeof out, &s);
    assert_int_equal(comm_test(c, &s), 0);
    assert_int_equal(comm_test(c, &s), 0);
    assert_int_equal(comm_test(c, &s), 1);
    assert_true(end(h, &t));
    host_comm_destroy(h);
}

static void spin(int64_t ns)
{
    const int64_t until = host_clock_ns() + ns;
    while (host_clock_ns() < until) continue;
}

/* Stages add up to the time from begin to end, without what publishing took. */
static void clocks(void **state)
{
    struct host_comm *h = host_comm_create(NULL, NULL);
    const double x[3] = {1, 2, 3};
    struct comm *c = host_comm_run_begin(h, false, 2, NULL, 0);
    struct host_times t;
    struct host_published p;
    (void)state;
    assert_int_equal(comm_now_ps(c), 0);
    spin(1000000); /* before the mark: nobody's time */
    c->type->mark(c, 1);
    comm_elapse(c, 2000000000); /* 2 ms */
    comm_stage(c, 1);
    spin(1000000);
    assert_true(comm_now_ps(c) >= 3000000000);
    comm_publish(c, 4, 10, 3, x);
    comm_publish(c, 5, 0, 0, x);
    comm_barrier(c);
    c->type->mark(c, 0);
    assert_false(end(h, &t));
    assert_true(t.stage_ns[0] >= 2000000);
    assert_true(t.stage_ns[1] >= 1000000);
    assert_true(t.published_ns > 0);
    assert_int_equal(t.stage_ns[0] + t.stage_ns[1] + t.published_ns, t.end_ns - t.begin_ns);
    assert_true(host_comm_published(h, 0, &p));
    assert_int_equal(p.output, 4);
    assert_int_equal(p.first, 10);
    assert_memory_equal(p.x, x, sizeof x);
    assert_true(host_comm_published(h, 1, &p));
    assert_int_equal(p.n, 0);
    assert_false(host_comm_published(h, 2, &p));
    assert_true(host_comm_one_clock(h));
    host_comm_destroy(h);
}

/* Another number, another place, another order: another fingerprint. */
static void digests(void **state)
{
    struct host_comm *h = host_comm_create(NULL, NULL);
    const double x[2] = {1, 2}, y[2] = {1, 3};
    uint64_t seen[4];
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct comm *c = host_comm_run_begin(h, false, 1, NULL, 0);
        comm_publish(c, 0, i == 2, 2, i == 1 ? y : x);
        seen[i] = host_comm_digest(h);
    }
    assert_true(seen[0] != seen[1]);
    assert_true(seen[0] != seen[2]);
    assert_true(seen[0] == seen[3]);
    host_comm_destroy(h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(messages_arrive), cmocka_unit_test(forgotten_sends),
        cmocka_unit_test(far_tags),        cmocka_unit_test(leftovers),
        cmocka_unit_test(matching),        cmocka_unit_test(cut),
        cmocka_unit_test(probes),          cmocka_unit_test(cancels),
        cmocka_unit_test(clocks),          cmocka_unit_test(digests)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
