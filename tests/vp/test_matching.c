/* test_matching.c - Receives from any source: who takes what, and when; what programs do wrong. */
#include "timed_world.h"

#include <stdlib.h>
#include <string.h>

/* ---- by hand ---- */

/* Rank 1 sends at 5 us, rank 2 at 4 us; rank 0 asks at `context` us. */
struct two {
    int64_t ask_us;
    int source[2];
    int64_t tag[2], now[2];
};

static void two_senders(struct comm *c, void *context)
{
    struct two *t = context;
    char data[1000] = {0};
    if (comm_rank(c) > 0) {
        comm_elapse(c, (6 - comm_rank(c)) * US);
        data[999] = (char)comm_rank(c);
        comm_send(c, 0, 10 + comm_rank(c), data, 1000);
        return;
    }
    comm_elapse(c, t->ask_us * US);
    for (int i = 0; i < 2; i++) {
        struct comm_request r;
        comm_irecv_matching(c, COMM_ANY_SOURCE, 0, 0, data, 1000, &r);
        comm_wait(c, &r);
        t->source[i] = r.peer;
        t->tag[i] = r.tag;
        t->now[i] = comm_now_ps(c);
        assert_int_equal(data[999], r.peer);
        assert_int_equal(r.bytes, 1000);
        assert_false(r.truncated);
    }
}

static void the_first_to_arrive_is_received_first(void **state)
{
    (void)state;
    enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK};
    for (int k = 0; k < 4; k++) {
        struct machine_spec m = crossbar(3);
        m.network.level = level[k % 2];
        struct two t = {.ask_us = k < 2 ? 0 : 50};
        struct outcome o = go(&m, 3, two_senders, &t);
        expect_ok(&o);
        assert_int_equal(t.source[0], 2);
        assert_int_equal(t.source[1], 1);
        assert_int_equal(t.tag[0], 12);
        int64_t first = k < 2 ? 4 * US + trip(1000) : 50 * US;
        assert_int_equal(t.now[0], first + receipt(1000));
        assert_int_equal(t.now[1], first + 2 * receipt(1000));
        arena_destroy(o.arena);
    }
}

/* Rank 1 sends 1, 2, 3 bytes in this order, with tags 1, 2, 3. Rank 0 posts receives of its list,
 * waits in reverse, and notes the sizes. */
struct listed {
    int n, src[3];
    int64_t tag[3], mask[3], bytes[3];
};

static void listed_receives(struct comm *c, void *context)
{
    struct listed *l = context;
    char data[8] = {0};
    if (comm_rank(c) == 1)
        for (int k = 1; k <= 3; k++) comm_send(c, 0, k, data, k);
    if (comm_rank(c) != 0) return;
    struct comm_request r[3];
    for (int i = 0; i < 3; i++)
        comm_irecv_matching(c, l->src[i], l->tag[i], l->mask[i], data, 8, &r[i]);
    for (int i = 2; i >= 0; i--) comm_wait(c, &r[i]);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(r[i].peer, 1);
        l->bytes[i] = r[i].bytes;
        assert_int_equal(r[i].tag, r[i].bytes);
    }
}

static void receives_take_messages_in_the_order_of_posting(void **state)
{
    (void)state;
    const int64_t all = COMM_WHOLE_TAG;
    const int any = COMM_ANY_SOURCE;
    struct listed list[] = {
        {3, {any, any, any}, {0, 0, 0}, {0, 0, 0}, {1, 2, 3}},
        {3, {1, any, any}, {1, 0, 0}, {all, 0, 0}, {1, 2, 3}},
        {3, {1, any, 1}, {2, 0, 0}, {all, 0, 0}, {2, 1, 3}},
        {3, {any, 1, any}, {3, 0, 0}, {all, 0, 0}, {3, 1, 2}},
        {3, {any, 1, 1}, {0, 3, 2}, {0, all, all}, {1, 3, 2}},
        {3, {any, any, 1}, {2, 0, 0}, {2, 0, 0}, {2, 1, 3}}, /* the first wants bit 1: 2 or 3 */
    };
    enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK};
    for (size_t k = 0; k < 2 * sizeof list / sizeof *list; k++) {
        struct machine_spec m = crossbar(2);
        m.network.level = level[k % 2];
        struct listed l = list[k / 2];
        struct outcome o = go(&m, 2, listed_receives, &l);
        expect_ok(&o);
        for (int i = 0; i < 3; i++) assert_int_equal(l.bytes[i], list[k / 2].bytes[i]);
        arena_destroy(o.arena);
    }
}

/* Two processors of one node: copying 100,000 bytes takes 200 us, so that the small message sent
 * behind arrives first. A receive that fits both takes the large one; one that fits the small one
 * alone does not wait for it. */
static void overtaken(struct comm *c, void *context)
{
    char *data = calloc(100000, 1);
    bool *by_tag = context;
    if (comm_rank(c) == 0) {
        comm_send(c, 1, 1, data, 100000);
        comm_send(c, 1, 2, data, 10);
    } else {
        struct comm_request first, second;
        const int64_t mask = *by_tag ? COMM_WHOLE_TAG : 0;
        comm_irecv_matching(c, COMM_ANY_SOURCE, *by_tag ? 2 : 0, mask, data, 100000, &first);
        comm_irecv_matching(c, COMM_ANY_SOURCE, 0, 0, data, 100000, &second);
        comm_wait(c, &first);
        int64_t now = comm_now_ps(c);
        assert_int_equal(first.bytes, *by_tag ? 10 : 100000);
        if (*by_tag) assert_true(now < 150 * US);
        else assert_true(now > 300 * US);
        comm_wait(c, &second);
        assert_int_equal(second.bytes, *by_tag ? 100000 : 10);
    }
    free(data);
}

static void messages_of_a_sender_do_not_overtake_each_other(void **state)
{
    (void)state;
    for (int by_tag = 0; by_tag < 2; by_tag++) {
        struct machine_spec m = crossbar(1);
        m.topology.processors_per_node = 2;
        m.software.shared_latency = 1e-6;
        m.software.shared_bandwidth = 5e8;
        bool b = by_tag;
        struct outcome o = go(&m, 2, overtaken, &b);
        expect_ok(&o);
        arena_destroy(o.arena);
    }
}

/* The large message is still on its way when a receive, and a probe, want the small one alone: an
 * earlier receive that fits both has the first claim, and is kept for the large one. */
static void claimed(struct comm *c, void *context)
{
    (void)context;
    char *data = calloc(100000, 1);
    if (comm_rank(c) == 0) {
        comm_send(c, 1, 1, data, 100000);
        comm_send(c, 1, 2, data, 10);
    } else {
        struct comm_request both, small;
        struct comm_envelope e;
        comm_irecv_matching(c, COMM_ANY_SOURCE, 0, 0, data, 100000, &both);
        comm_elapse(c, 150 * US);
        assert_false(comm_probe(c, 0, 2, COMM_WHOLE_TAG, 0, &e));
        comm_irecv_matching(c, COMM_ANY_SOURCE, 2, COMM_WHOLE_TAG, data, 10, &small);
        comm_wait(c, &small);
        assert_true(comm_now_ps(c) > 300 * US);
        comm_wait(c, &both);
        assert_int_equal(both.bytes, 100000);
    }
    free(data);
}

static void an_earlier_receive_has_the_first_claim(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(1);
    m.topology.processors_per_node = 2;
    m.software.shared_latency = 1e-6;
    m.software.shared_bandwidth = 5e8;
    struct outcome o = go(&m, 2, claimed, NULL);
    expect_ok(&o);
    arena_destroy(o.arena);
}

/* Rank 0 runs ahead on the host: both receives are posted before anything comes, one of them from a
 * given rank behind one from anybody. */
static void behind_anybody(struct comm *c, void *context)
{
    (void)context;
    char data[8] = {0};
    if (comm_rank(c) > 0) {
        comm_elapse(c, comm_rank(c) * US);
        comm_send(c, 0, 4, data, 8);
        return;
    }
    struct comm_request any, given;
    comm_elapse(c, 50 * US);
    comm_irecv_matching(c, COMM_ANY_SOURCE, 4, COMM_WHOLE_TAG, data, 8, &any);
    comm_irecv(c, 2, 4, data, 8, &given);
    comm_wait(c, &given);
    comm_wait(c, &any);
    assert_int_equal(any.peer, 1);
}

static void a_given_source_behind_any_gets_what_is_left(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(3);
    struct outcome o = go(&m, 3, behind_anybody, NULL);
    expect_ok(&o);
    arena_destroy(o.arena);
}

/* ---- hand-shakes ---- */

struct hand_shake {
    bool wild, synchronous;
    int64_t post_us, sent, received;
};

static void shake_hands(struct comm *c, void *context)
{
    struct hand_shake *h = context;
    char data[1000] = {0};
    struct comm_request r = {0};
    if (comm_rank(c) == 0) {
        if (h->synchronous) comm_isend_synchronous(c, 1, 5, data, 1000, &r);
        else comm_isend(c, 1, 5, data, 1000, &r);
        comm_wait(c, &r);
        h->sent = comm_now_ps(c);
        return;
    }
    comm_elapse(c, h->post_us * US);
    comm_irecv_matching(c, h->wild ? COMM_ANY_SOURCE : 0, 5, COMM_WHOLE_TAG, data, 1000, &r);
    comm_wait(c, &r);
    h->received = comm_now_ps(c);
}

/* The request to send is there at 3.4 us. Answered then or when the receive is posted, it lets the
 * sender go 400 ns later; the data take 400 + 999 ns more. */
static void hand_shakes_begin_when_a_receive_takes_the_message(void **state)
{
    (void)state;
    for (int k = 0; k < 16; k++) {
        struct machine_spec m = crossbar(2);
        struct hand_shake h = {.wild = k & 1, .synchronous = k & 2, .post_us = k & 4 ? 50 : 0};
        m.network.level = k & 8 ? LEVEL_LINK : LEVEL_LOGGP;
        m.software.eager_bytes = h.synchronous ? -1 : 100;
        struct outcome o = go(&m, 2, shake_hands, &h);
        expect_ok(&o);
        int64_t taken = h.post_us ? 50 * US : 3400000;
        assert_int_equal(h.sent, taken + 400000);
        assert_int_equal(h.received, taken + 400000 + 400000 + 999000 + receipt(1000));
        arena_destroy(o.arena);
    }
}

/* A receive posted at once, behind which its rank computes for 50 us: the request is answered when
 * it comes. */
static void answered_meanwhile(struct comm *c, void *context)
{
    int64_t *sent = context;
    char data[1000] = {0};
    struct comm_request r = {0};
    if (comm_rank(c) == 0) {
        comm_isend(c, 1, 5, data, 1000, &r);
        comm_wait(c, &r);
        *sent = comm_now_ps(c);
        return;
    }
    comm_irecv(c, 0, 5, data, 1000, &r);
    comm_elapse(c, 50 * US);
    comm_wait(c, &r);
    assert_int_equal(comm_now_ps(c), 50 * US + receipt(1000));
}

static void hand_shakes_need_no_waiting_receiver(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        struct machine_spec m = crossbar(2);
        int64_t sent = 0;
        int order[] = {1, 0};
        m.network.level = k & 1 ? LEVEL_LINK : LEVEL_LOGGP;
        m.software.eager_bytes = 100;
        struct outcome o = run_load(&m, (struct world_load){.nrank = 2,
                                                            .program = answered_meanwhile,
                                                            .context = &sent,
                                                            .timed = k & 2,
                                                            .order = k & 4 ? order : NULL});
        expect_ok(&o);
        assert_int_equal(sent, 3400000 + 400000);
        arena_destroy(o.arena);
    }
}

/* ---- what programs do wrong ---- */

enum wrong {
    WRONG_RANK,
    WRONG_SIZE,
    WRONG_SAID,
    WRONG_LEFT,
    WRONG_WAIT,
    WRONG_STAGE,
    WRONG_ELAPSE,
    WRONG_WILD,
    WRONGS
};

static const char *const wrong_text[WRONGS] = {
    "a message to rank 7: there are 0 .. 1",
    "a receive of exactly 10 bytes from rank 1, tag 3, meets a message of 8 bytes",
    "rank 1 in work at 7e-06 s (test_matching.c:",
    "it has ended without receiving the message of 8 bytes, tag 3, that rank 1 sent it at 7e-06 s",
    "a wait for a request that was never started",
    "stage 4: there are 0 .. 0",
    "computing for -1 ps",
    "a receive from any source in a program that has promised to do without it",
};

static void do_wrong(struct comm *c, void *context)
{
    enum wrong wrong = *(enum wrong *)context;
    char data[10] = {0};
    struct comm_request r = {.active = 99};
    comm_elapse(c, 7 * US);
    if (wrong == WRONG_SIZE && comm_rank(c) == 0) comm_recv(c, 1, 3, data, 10);
    if (wrong == WRONG_WILD && comm_rank(c) == 0)
        comm_irecv_matching(c, COMM_ANY_SOURCE, 3, 0, data, 10, &r);
    if (comm_rank(c) == 0) return;
    switch (wrong) {
    case WRONG_RANK:
        comm_send(c, 7, 3, data, 8);
        break;
    case WRONG_SAID:
        comm_fail(c, "said so");
        break;
    case WRONG_WAIT:
        comm_wait(c, &r);
        break;
    case WRONG_STAGE:
        comm_stage(c, 4);
        break;
    case WRONG_ELAPSE:
        comm_elapse(c, -1);
        break;
    default:
        comm_send(c, 0, 3, data, 8);
    }
}

static void mistakes_end_the_run_with_rank_time_and_place(void **state)
{
    (void)state;
    for (int wrong = 0; wrong < WRONGS; wrong++) {
        struct machine_spec m = crossbar(2);
        enum wrong w = wrong;
        struct outcome o = run_load(&m, (struct world_load){.nrank = 2,
                                                            .program = do_wrong,
                                                            .context = &w,
                                                            .timed = wrong % 2 == 0,
                                                            .foreign = true});
        assert_int_equal(o.r.status, RUN_FAILED);
        if (!strstr(o.r.text, wrong_text[wrong])) fail_msg("\"%s\"", o.r.text);
        const bool placed = wrong != WRONG_LEFT && wrong != WRONG_STAGE && wrong != WRONG_ELAPSE;
        if (placed) assert_non_null(strstr(o.r.text, "(test_matching.c:"));
        assert_null(o.r.stage);
        arena_destroy(o.arena);
    }
}

static void wait_for_ever(struct comm *c, void *context)
{
    (void)context;
    char data[10];
    struct comm_request r, *list = &r;
    comm_irecv_matching(c, comm_rank(c) ? COMM_ANY_SOURCE : 1, 3, COMM_WHOLE_TAG, data, 10, &r);
    if (comm_rank(c) == 2) comm_wait_any(c, 1, &list);
    else if (comm_rank(c) < 2) comm_wait(c, &r);
    else comm_cancel(c, &r);
}

static void waiting_for_anybody_in_vain_is_explained(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(4);
    struct outcome o = go(&m, 4, wait_for_ever, NULL);
    assert_int_equal(o.r.status, RUN_DEADLOCK);
    const char *expected[] = {
        "rank 0 in work waits to receive at most 10 bytes, tag 3, from rank 1 (test_matching.c:",
        "rank 1 in work waits to receive at most 10 bytes, tag 3, from any rank (test_matching.c:",
        "of the others 1 have finished and 2 wait: rank 0",
        "rank 2 in work waits for any of several requests",
    };
    for (int k = 0; k < 4; k++)
        if (!strstr(o.r.text, expected[k])) fail_msg("no \"%s\" in \"%s\"", expected[k], o.r.text);
    arena_destroy(o.arena);
}

static void cut_short(struct comm *c, void *context)
{
    (void)context;
    char data[10] = "........";
    struct comm_request r;
    if (comm_rank(c) == 1) {
        comm_send(c, 0, 3, "123456789", 10);
        return;
    }
    comm_irecv_matching(c, 1, 0, 0, data, 4, &r);
    comm_wait(c, &r);
    assert_true(r.truncated);
    assert_int_equal(r.bytes, 10);
    assert_string_equal(data, "1234....");
}

static void longer_messages_are_cut(void **state)
{
    (void)state;
    for (int timed = 0; timed < 2; timed++) {
        struct machine_spec m = crossbar(2);
        struct outcome o =
            run_load(&m, (struct world_load){.nrank = 2, .program = cut_short, .timed = timed});
        expect_ok(&o);
        arena_destroy(o.arena);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_to_arrive_is_received_first),
        cmocka_unit_test(receives_take_messages_in_the_order_of_posting),
        cmocka_unit_test(messages_of_a_sender_do_not_overtake_each_other),
        cmocka_unit_test(an_earlier_receive_has_the_first_claim),
        cmocka_unit_test(a_given_source_behind_any_gets_what_is_left),
        cmocka_unit_test(hand_shakes_begin_when_a_receive_takes_the_message),
        cmocka_unit_test(hand_shakes_need_no_waiting_receiver),
        cmocka_unit_test(mistakes_end_the_run_with_rank_time_and_place),
        cmocka_unit_test(waiting_for_anybody_in_vain_is_explained),
        cmocka_unit_test(longer_messages_are_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
