/* test_polls.c - Tests, probes, waits for any and receives taken back: what they see, and when. */
#include "timed_world.h"

enum look {
    LOOK_WAIT,
    LOOK_TEST,
    LOOK_PROBE,
    LOOK_BLOCKING_PROBE,
    LOOK_TAKE,
    LOOK_WAIT_ANY,
    LOOKS
};

struct looking {
    enum look look;
    int64_t send_us, done;
    int polls;
};

static void look_for(struct comm *c, void *context)
{
    struct looking *l = context;
    char data[100] = {0};
    if (comm_rank(c) == 1) {
        comm_elapse(c, l->send_us * US);
        comm_send(c, 0, 9, data, 100);
        return;
    }
    struct comm_request r = {0}, never = {0}, *list[] = {NULL, &never, &r};
    struct comm_envelope e = {0};
    if (l->look == LOOK_WAIT || l->look == LOOK_TEST || l->look == LOOK_WAIT_ANY)
        comm_irecv_matching(c, COMM_ANY_SOURCE, 9, COMM_WHOLE_TAG, data, 100, &r);
    switch (l->look) {
    case LOOK_TEST:
        while (!comm_test(c, &r)) l->polls++;
        break;
    case LOOK_PROBE:
        while (!comm_probe(c, COMM_ANY_SOURCE, 0, 0, 0, &e)) l->polls++;
        break;
    case LOOK_BLOCKING_PROBE:
        assert_true(comm_probe(c, 1, 9, COMM_WHOLE_TAG, 1, &e));
        break;
    case LOOK_TAKE:
        while (!comm_probe_take(c, COMM_ANY_SOURCE, 0, 0, 0, &e, &r)) l->polls++;
        assert_false(comm_probe(c, COMM_ANY_SOURCE, 0, 0, 0, &e));
        comm_receive_into(c, &r, data, 100);
        break;
    case LOOK_WAIT_ANY:
        comm_irecv_matching(c, COMM_ANY_SOURCE, 8, COMM_WHOLE_TAG, data, 100, &never);
        assert_int_equal(comm_wait_any(c, 3, list), 2);
        assert_int_equal(comm_test_any(c, 3, list), -1);
        assert_true(comm_cancel(c, &never));
        assert_int_equal(comm_wait_any(c, 3, list), -1);
        break;
    default:
        break;
    }
    if (e.bytes) {
        assert_int_equal(e.source, 1);
        assert_int_equal(e.tag, 9);
        assert_int_equal(e.bytes, 100);
        if (l->look != LOOK_TAKE)
            comm_irecv_matching(c, e.source, e.tag, COMM_WHOLE_TAG, data, 100, &r);
    }
    comm_wait(c, &r);
    assert_int_equal(r.bytes, 100);
    l->done = comm_now_ps(c);
}

/* A poll takes an eighth of 3 us. Where nothing is looked for before it is there, a look ends with
 * the message, or one poll later; and even a second of looking is a matter of few looks. */
static void looks_see_what_has_arrived_and_nothing_else(void **state)
{
    (void)state;
    const int64_t poll = 375000;
    int64_t send_us[] = {0, 4, 1000000};
    for (int k = 0; k < LOOKS * 3 * 2; k++) {
        struct machine_spec m = crossbar(2);
        m.network.level = k % 2 ? LEVEL_LINK : LEVEL_LOGGP;
        struct looking l = {.look = k / 6, .send_us = send_us[k / 2 % 3]};
        struct outcome o = go(&m, 2, look_for, &l);
        expect_ok(&o);
        int64_t there = l.send_us * US + trip(100) + receipt(100);
        assert_true(l.done >= there);
        int64_t after = l.look == LOOK_WAIT ? 0 : l.look == LOOK_BLOCKING_PROBE ? poll : 3 * poll;
        if (l.look == LOOK_WAIT_ANY) after = 2 * poll;
        if (l.done > there + after)
            fail_msg("look %d, sent at %d us: done %lld ps late", l.look, (int)l.send_us,
                     (long long)(l.done - there));
        assert_true(l.polls < 400);
        if (l.look == LOOK_TEST || l.look == LOOK_PROBE) assert_true(l.polls > 3);
        arena_destroy(o.arena);
    }
}

/* ---- taking back ---- */

static void take_back(struct comm *c, void *context)
{
    (void)context;
    char data[10] = {0};
    struct comm_request r, s;
    if (comm_rank(c) == 1) {
        comm_elapse(c, 20 * US);
        comm_send(c, 0, 1, data, 10); /* arrives at 22.419 us */
        return;
    }
    /* the sender has run ahead on the host by the time of the second cancel: what it sent is still
     * to come */
    for (int from = COMM_ANY_SOURCE; from <= 1; from += 2) {
        comm_irecv_matching(c, from, 1, COMM_WHOLE_TAG, data, 10, &r);
        comm_elapse(c, 5 * US);
        assert_int_equal(comm_cancel(c, &r), 1);
        assert_false(r.active);
    }
    comm_irecv(c, 1, 1, data, 10, &r);
    comm_irecv_matching(c, COMM_ANY_SOURCE, 1, COMM_WHOLE_TAG, data, 10, &s);
    assert_false(comm_test(c, &r));
    comm_elapse(c, 22200000 - comm_now_ps(c)); /* the message is on its way, and bound */
    assert_int_equal(comm_cancel(c, &r), 1);
    comm_elapse(c, 20 * US);
    assert_int_equal(comm_cancel(c, &s), 0);
    comm_wait(c, &s);
    assert_int_equal(s.peer, 1);
}

static void receives_are_taken_back_until_their_message_is_there(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct machine_spec m = crossbar(2);
        m.network.level = k % 2 ? LEVEL_LINK : LEVEL_LOGGP;
        int order[] = {1, 0};
        struct outcome o = run_load(&m, (struct world_load){.nrank = 2,
                                                            .program = take_back,
                                                            .timed = true,
                                                            .foreign = true,
                                                            .order = k < 2 ? NULL : order});
        expect_ok(&o);
        arena_destroy(o.arena);
    }
}

/* ---- many requests ---- */

/* Ranks 3, 2, 1 send in this order, rank 1 a hollow message; the receive from 4 gets nothing. */
static void watch_many(struct comm *c, void *context)
{
    (void)context;
    char data[4][8] = {"", "", "", ""};
    struct comm_request r[5];
    if (comm_rank(c) > 0) {
        comm_elapse(c, (4 - comm_rank(c)) * 10 * US);
        if (comm_rank(c) < 4) comm_send(c, 0, 1, comm_rank(c) == 1 ? NULL : "abcdefg", 8);
        return;
    }
    assert_null(comm_next_complete(c, INT64_MAX));
    assert_null(comm_next_complete(c, 5 * US));
    assert_int_equal(comm_now_ps(c), 5 * US);
    for (int i = 1; i < 5; i++) {
        comm_irecv_matching(c, i, 1, COMM_WHOLE_TAG, data[i - 1], 8, &r[i]);
        if (i < 4) comm_watch(c, &r[i]);
    }
    assert_null(comm_next_complete(c, 11 * US));
    assert_int_equal(comm_now_ps(c), 11 * US);
    assert_ptr_equal(comm_next_complete(c, INT64_MAX), &r[3]);
    assert_int_equal(comm_now_ps(c), 10 * US + trip(8) + receipt(8));
    comm_elapse(c, 100 * US);
    /* both are there: in the order of arrival, and none by a time at which none was */
    assert_null(comm_next_complete(c, 20 * US));
    assert_ptr_equal(comm_next_complete(c, 21 * US + trip(8)), &r[2]);
    assert_ptr_equal(comm_next_complete(c, comm_now_ps(c)), &r[1]);
    assert_null(comm_next_complete(c, INT64_MAX));
    assert_string_equal(data[2], "abcdefg");
    assert_string_equal(data[0], "");
    assert_true(comm_cancel(c, &r[4]));
}

static void watched_requests_come_in_the_order_of_completion(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        struct machine_spec m = crossbar(5);
        m.network.level = k & 1 ? LEVEL_LINK : LEVEL_LOGGP;
        m.software.eager_bytes = -1;
        int order[] = {4, 3, 2, 1, 0};
        struct world_load load = {
            .nrank = 5, .program = watch_many, .timed = true, .foreign = true};
        if (k & 2) load.order = order;
        struct outcome o = run_load(&m, load);
        expect_ok(&o);
        arena_destroy(o.arena);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(looks_see_what_has_arrived_and_nothing_else),
        cmocka_unit_test(receives_are_taken_back_until_their_message_is_there),
        cmocka_unit_test(watched_requests_come_in_the_order_of_completion),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
