/* test_slack.c - slack at every place where two times of virtual processors meet, by hand, and
 * computing that lasts as long as a table says. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>

#include "measure/balance.h"
#include "vp/world.h"

#include "crossbar.h"

enum { US = 1000000 };

static const char *const stage_name[] = {"first", "second"};

/* o_s 2 us, o_r 3 us, one resource of 100 ns, 300 ns at the ends; bytes take no time. */
static struct machine_spec free_bytes(int nodes)
{
    struct machine_spec m = crossbar(nodes);
    m.network.link_bandwidth = m.node.copy_bandwidth = 0;
    m.software.send_copy = m.software.recv_copy = 0;
    return m;
}

struct outcome {
    struct arena *arena;
    struct run_result r;
};

static struct outcome go(const struct machine_spec *m, int nrank, world_program *program,
                         const struct balance *balance)
{
    struct outcome o = {.arena = arena_create()};
    const struct record_spec record = {.path = true, .slack = true, .balance = balance};
    struct err e;
    err_clear(&e);
    struct world_load load = {.nrank = nrank,
                              .program = program,
                              .nstage = 2,
                              .stage_name = stage_name,
                              .largest_message = -1};
    if (!world_run(m, &load, &record, 1, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    assert_int_equal(o.r.status, RUN_OK);
    return o;
}

static int64_t slack(const struct outcome *o, int rank, int stage)
{
    return o->r.rank_slack[rank * o->r.nstage + stage];
}

/* `us` of computing at 1 Gflop/s. */
static void compute(struct comm *c, int us)
{
    const struct work w = {.flop = (uint64_t)us * 1000};
    comm_work(c, &w);
}

/* ---- where times meet ---- */

static void meet_at_a_barrier(struct comm *c, void *context)
{
    (void)context;
    comm_stage(c, 0);
    compute(c, 10 * (comm_rank(c) + 1));
    comm_barrier(c);
    comm_stage(c, 1);
    compute(c, 1);
}

/* Who comes early may come later by the lead, whether or not the barrier itself takes time. */
static void at_a_barrier_the_last_has_none(void **state)
{
    (void)state;
    struct machine_spec m = free_bytes(4);
    m.software.barrier = BARRIER_HARDWARE;
    for (int time = 0; time <= 8; time += 8) {
        m.software.barrier_time = time * 1e-6;
        struct outcome o = go(&m, 4, meet_at_a_barrier, NULL);
        assert_int_equal(o.r.makespan_ps, (int64_t)(41 + time) * US);
        for (int i = 0; i < 4; i++) {
            assert_int_equal(slack(&o, i, 0), (int64_t)(3 - i) * 10 * US);
            assert_int_equal(slack(&o, i, 1), 0);
        }
        arena_destroy(o.arena);
    }
}

/* Rank 0 sends at once; rank 1 computes 50 us, then receives. */
static void send_early(struct comm *c, void *context)
{
    (void)context;
    char data[8] = {0};
    comm_stage(c, 0);
    if (comm_rank(c) == 0) comm_send(c, 1, 7, data, 8);
    else {
        compute(c, 50);
        comm_recv(c, 0, 7, data, 8);
    }
}

static void a_message_that_waits_has_the_time_until_it_is_asked_for(void **state)
{
    (void)state;
    const struct machine_spec m = free_bytes(2);
    struct outcome o = go(&m, 2, send_early, NULL);
    /* sent after 2 us, there after 2.4 us, asked for after 50 us */
    assert_int_equal(slack(&o, 0, 0), 50 * US - 2400000);
    assert_int_equal(slack(&o, 1, 0), 0);
    arena_destroy(o.arena);
}

/* Rank 1 posts its receive after 10 us; the request to send comes after 102.4 us. */
static void shake_hands(struct comm *c, void *context)
{
    (void)context;
    char data[8] = {0};
    struct comm_request r;
    comm_stage(c, 0);
    if (comm_rank(c) == 0) {
        compute(c, 100);
        comm_send(c, 1, 7, data, 8);
    } else {
        compute(c, 10);
        comm_irecv(c, 0, 7, data, 8, &r);
        comm_stage(c, 1);
        comm_wait(c, &r);
    }
}

static void a_receive_that_is_posted_early_has_the_time_until_the_request_comes(void **state)
{
    (void)state;
    struct machine_spec m = free_bytes(2);
    m.software.eager_bytes = 0;
    struct outcome o = go(&m, 2, shake_hands, NULL);
    assert_int_equal(slack(&o, 1, 0), 102400000 - 10 * US);
    assert_int_equal(slack(&o, 0, 0), 0);
    arena_destroy(o.arena);
}

/* Rank 0 sends at once, rank 1 after 20 us of computing; rank 2 receives both at its end. */
static void pass_a_server(struct comm *c, void *context)
{
    (void)context;
    char data[8] = {0};
    comm_stage(c, 0);
    if (comm_rank(c) < 2) {
        if (comm_rank(c) == 1) compute(c, 20);
        comm_send(c, 2, 7, data, 8);
        return;
    }
    compute(c, 100);
    comm_recv(c, 0, 7, data, 8);
    comm_recv(c, 1, 7, data, 8);
}

/* Rank 0 holds the server for the first 5 us, rank 1 from 20 to 25 us, rank 2 asks for it at 100
 * us: rank 1 may be 75 us later, and rank 0 that and the 15 us of an idle server between them. */
static void a_free_server_leaves_slack_to_who_passed_it(void **state)
{
    (void)state;
    struct machine_spec m = free_bytes(3);
    m.software.kernel_server = true;
    m.software.kernel_time = 5e-6;
    struct outcome o = go(&m, 3, pass_a_server, NULL);
    assert_int_equal(slack(&o, 1, 0), 75 * US);
    assert_int_equal(slack(&o, 0, 0), 90 * US);
    assert_int_equal(slack(&o, 2, 0), 0);
    arena_destroy(o.arena);
}

/* ---- even shares ---- */

static void unequal(struct comm *c, void *context)
{
    (void)context;
    comm_stage(c, 0);
    for (int i = 0; i < 3; i++) compute(c, comm_rank(c) + 1);
    comm_stage(c, 1);
    if (comm_rank(c) == 0) compute(c, 7);
}

static void computing_lasts_as_the_table_says(void **state)
{
    (void)state;
    const struct machine_spec m = free_bytes(2);
    /* two stages and the end of the run; what is no multiple of anything must still add up */
    const int64_t own[] = {3 * US, 7 * US, 0, 6 * US, 0, 0};
    const int64_t target[] = {4500001, 3500000, 0, 4499999, 3500000, 0};
    const struct balance b = {2, 3, own, target};
    struct outcome o = go(&m, 2, unequal, &b);
    for (int i = 0; i < 6; i++) assert_int_equal(o.r.stage[i].compute_ps, target[i]);
    assert_int_equal(o.r.finish_ps[0], 8000001);
    /* what is counted stays: only its time is another one */
    assert_int_equal(o.r.stage[0].work.flop, 3000);
    arena_destroy(o.arena);
}

static void a_table_of_the_same_times_changes_nothing(void **state)
{
    (void)state;
    const struct machine_spec m = free_bytes(2);
    const int64_t own[] = {3 * US, 7 * US, 0, 6 * US, 0, 0};
    const struct balance b = {2, 3, own, own};
    struct outcome o = go(&m, 2, unequal, &b), plain = go(&m, 2, unequal, NULL);
    assert_true(o.r.digest == plain.r.digest);
    arena_destroy(o.arena);
    arena_destroy(plain.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_a_barrier_the_last_has_none),
        cmocka_unit_test(a_message_that_waits_has_the_time_until_it_is_asked_for),
        cmocka_unit_test(a_receive_that_is_posted_early_has_the_time_until_the_request_comes),
        cmocka_unit_test(a_free_server_leaves_slack_to_who_passed_it),
        cmocka_unit_test(computing_lasts_as_the_table_says),
        cmocka_unit_test(a_table_of_the_same_times_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
