/* test_world.c - Virtual processors: exact times, exact accounts, matching, collectives,
 * deadlock. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "comm/collectives.h"
#include "vp/world.h"

#include "crossbar.h"

static const char *const stage_name[] = {"first", "second"};

struct outcome {
    struct arena *arena;
    struct run_result r;
};

static struct outcome go(const struct machine_spec *m, int nrank, world_program *program,
                         void *context)
{
    struct outcome o = {.arena = arena_create()};
    struct record_spec record = {.spans = true, .links = false};
    struct err e;
    err_clear(&e);
    struct world_load load = {.nrank = nrank, .program = program, .context = context, .nstage = 2,
                              .stage_name = stage_name, .largest_message = -1};
    if (!world_run(m, &load, &record, 1, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    return o;
}

static void accounts_close(const struct run_result *r)
{
    for (int i = 0; i < r->nrank; i++) {
        int64_t sum = 0;
        for (int k = 0; k < r->nstage; k++) {
            const struct stage_time *s = &r->stage[i * r->nstage + k];
            sum += s->compute_ps + s->send_ps + s->recv_ps + s->wait_ps + s->contention_ps;
            assert_true(s->contention_ps >= 0 && s->wait_ps >= 0);
        }
        assert_int_equal(sum, r->makespan_ps);
    }
}

static void exchange(struct comm *c, void *context)
{
    (void)context;
    char data[1000] = {0};
    struct work w = {.flop = 5000};
    comm_stage(c, 0);
    comm_work(c, &w);
    comm_stage(c, 1);
    if (comm_rank(c) == 0) {
        comm_send(c, 1, 7, data, 1000);
    } else {
        comm_recv(c, 0, 7, data, 1000);
    }
}

/* 5 us computing, o_s + 1000 x 1 ns, one resource of 100 ns, 300 ns at the ends, 999 B at 1 GB/s
 * behind the first (LogGP counts b - 1), o_r + 1000 x 2 ns. */
static void a_message_takes_what_the_formula_says(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(2);
    struct outcome o = go(&m, 2, exchange, NULL);
    int64_t sent = 5000000 + 2000000 + 1000000, arrived = sent + 100000 + 300000 + 999000;
    assert_int_equal(o.r.finish_ps[1], arrived + 3000000 + 2000000);
    assert_int_equal(o.r.finish_ps[0], sent);
    assert_int_equal(o.r.messages, 1);
    assert_int_equal(o.r.bytes, 1000);
    const struct stage_time *second = &o.r.stage[o.r.nstage + 1];
    assert_int_equal(second->recv_ps, 5000000);
    assert_int_equal(second->contention_ps, 0);
    accounts_close(&o.r);
    arena_destroy(o.arena);
}

/* Up to the limit a message saves its sender 700 ns, and its receiver pays the copy of short ones
 * instead of the eager one, per byte on top of every message's. */
static void short_messages_cost_less_up_to_their_limit(void **state)
{
    (void)state;
    for (int64_t limit = 999; limit <= 1000; limit++) {
        struct machine_spec m = crossbar(2);
        m.software.short_bytes = limit;
        m.software.short_saving = 700e-9;
        m.software.short_copy = 3e-9;
        m.software.eager_copy = 8e-9;
        struct outcome o = go(&m, 2, exchange, NULL);
        bool is_short = limit == 1000;
        const struct stage_time *first = &o.r.stage[1], *second = &o.r.stage[o.r.nstage + 1];
        assert_int_equal(first->send_ps, 2000000 + 1000000 - (is_short ? 700000 : 0));
        assert_int_equal(second->recv_ps, 3000000 + 2000000 + (is_short ? 3000000 : 8000000));
        accounts_close(&o.r);
        arena_destroy(o.arena);
    }
}

/* Random but matching traffic: each pair (i, i + d) exchanges in both directions. */
static void traffic(struct comm *c, void *context)
{
    (void)context;
    int rank = comm_rank(c), size = comm_size(c);
    struct random r = random_make(3, (uint64_t)rank, 0);
    for (int d = 1; d < size; d *= 2) {
        struct work w = {.flop = random_below(&r, 4000), .div = 3};
        comm_work(c, &w);
        comm_stage(c, d > 2);
        double out[40], in[40];
        for (int k = 0; k < 40; k++) out[k] = rank * 1000 + d * 40 + k;
        int to = (rank + d) % size, from = (rank - d + size) % size;
        comm_send(c, to, d, out, sizeof out);
        comm_recv(c, from, d, in, sizeof in);
        for (int k = 0; k < 40; k++) assert_true(in[k] == from * 1000 + d * 40 + k);
    }
}

static void parts_add_up_to_the_makespan_at_every_level(void **state)
{
    (void)state;
    enum network_level level[] = {LEVEL_LOGGP, LEVEL_LINK};
    for (int k = 0; k < 2; k++) {
        struct machine_spec m = crossbar(13);
        m.network.level = level[k];
        m.topology.family = TOPOLOGY_MESH;
        struct outcome o = go(&m, 13, traffic, NULL);
        assert_int_equal(o.r.status, RUN_OK);
        assert_int_equal(o.r.messages, 13 * 4);
        accounts_close(&o.r);
        arena_destroy(o.arena);
    }
}

static void the_same_run_has_the_same_digest(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(9);
    m.network.level = LEVEL_LINK;
    struct outcome a = go(&m, 9, traffic, NULL), b = go(&m, 9, traffic, NULL);
    assert_int_equal(a.r.digest, b.r.digest);
    m.software.recv_overhead += 1e-12;
    struct outcome c = go(&m, 9, traffic, NULL);
    assert_int_not_equal(a.r.digest, c.r.digest);
    arena_destroy(a.arena);
    arena_destroy(b.arena);
    arena_destroy(c.arena);
}

/* Two receives of one source and tag are filled in the order posted, other tags are overtaken. */
static void order(struct comm *c, void *context)
{
    (void)context;
    int value[3] = {10, 20, 30}, got[3] = {0};
    if (comm_rank(c) == 0) {
        comm_send(c, 1, 5, &value[0], sizeof(int));
        comm_send(c, 1, 6, &value[1], sizeof(int));
        comm_send(c, 1, 5, &value[2], sizeof(int));
        return;
    }
    struct comm_request r[3];
    comm_irecv(c, 0, 6, &got[1], sizeof(int), &r[0]);
    comm_irecv(c, 0, 5, &got[0], sizeof(int), &r[1]);
    comm_irecv(c, 0, 5, &got[2], sizeof(int), &r[2]);
    comm_wait(c, &r[2]);
    comm_wait(c, &r[0]);
    comm_wait(c, &r[1]);
    for (int k = 0; k < 3; k++) assert_int_equal(got[k], value[k]);
}

static void messages_match_in_the_order_sent(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(2);
    arena_destroy(go(&m, 2, order, NULL).arena);
    m.network.level = LEVEL_LINK;
    arena_destroy(go(&m, 2, order, NULL).arena);
}

static void sums_and_broadcasts(struct comm *c, void *context)
{
    (void)context;
    int rank = comm_rank(c), size = comm_size(c);
    double x[70];
    for (int k = 0; k < 70; k++) x[k] = rank + k;
    collective_sum(c, 100, x, 70);
    for (int k = 0; k < 70; k++) assert_true(x[k] == size * (size - 1) / 2.0 + size * k);
    int word = rank == size / 2 ? 4711 : 0;
    collective_broadcast(c, size / 2, 200, &word, sizeof word);
    assert_int_equal(word, 4711);
    collective_barrier(c, 300);
}

static void collectives_are_right_for_every_size(void **state)
{
    (void)state;
    for (int size = 1; size <= 17; size++) {
        struct machine_spec m = crossbar(size);
        struct outcome o = go(&m, size, sums_and_broadcasts, NULL);
        assert_int_equal(o.r.status, RUN_OK);
        accounts_close(&o.r);
        arena_destroy(o.arena);
    }
}

static void late_barrier(struct comm *c, void *context)
{
    (void)context;
    for (int round = 0; round < 3; round++) {
        struct work w = {.flop = (uint64_t)(comm_rank(c) + 1) * 1000};
        comm_work(c, &w);
        comm_barrier(c);
    }
}

static void a_hardware_barrier_releases_all_at_once(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(6);
    m.software.barrier = BARRIER_HARDWARE;
    m.software.barrier_time = 2e-6;
    struct outcome o = go(&m, 6, late_barrier, NULL);
    for (int i = 0; i < 6; i++) assert_int_equal(o.r.finish_ps[i], 3 * (6 * 1000000 + 2000000));
    accounts_close(&o.r);
    arena_destroy(o.arena);
}

static void software_barrier_only(struct comm *c, void *context)
{
    (void)context;
    comm_barrier(c);
}

static void a_software_barrier_takes_log2_rounds(void **state)
{
    (void)state;
    for (int size = 2; size <= 32; size *= 2) {
        struct machine_spec m = crossbar(size);
        m.network.hop_latency = 0;
        struct outcome o = go(&m, size, software_barrier_only, NULL);
        int rounds = 0;
        while (1 << rounds < size) rounds++;
        assert_int_equal(o.r.makespan_ps, rounds * (2000000 + 300000 + 3000000));
        arena_destroy(o.arena);
    }
}

static void large_message(struct comm *c, void *context)
{
    int64_t late = *(int64_t *)context;
    static const char data[5000] = {1, 2, 3};
    char in[5000];
    struct comm_request r;
    if (comm_rank(c) == 0) {
        comm_isend(c, 1, 1, data, sizeof data, &r);
        comm_wait(c, &r);
        return;
    }
    struct work w = {.flop = (uint64_t)late};
    comm_work(c, &w);
    comm_recv(c, 0, 1, in, sizeof in);
    assert_memory_equal(in, data, sizeof in);
}

/* Request and clearance each take one zero-byte trip of 300 ns (hop latency 0), then 1 us of
 * software, then the data. */
static void a_large_message_shakes_hands_first(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(2);
    m.network.hop_latency = 0;
    m.software.eager_bytes = 4096;
    m.software.rendezvous_latency = 1e-6;
    for (int64_t late = 0; late <= 50000; late += 50000) {
        struct outcome o = go(&m, 2, large_message, &late);
        int64_t sent = 2000000 + 5000000, asked = sent + 300000,
                matched = asked > late * 1000 ? asked : late * 1000;
        int64_t cleared = matched + 1000000 + 300000, arrived = cleared + 300000 + 4999000;
        assert_int_equal(o.r.finish_ps[0], cleared);
        assert_int_equal(o.r.finish_ps[1], arrived + 3000000 + 10000000);
        accounts_close(&o.r);
        arena_destroy(o.arena);
    }
}

static void all_to_zero(struct comm *c, void *context)
{
    (void)context;
    char b[8] = {0};
    if (comm_rank(c) > 0) comm_send(c, 0, 1, b, 8);
    else
        for (int i = 1; i < comm_size(c); i++) comm_recv(c, i, 1, b, 8);
}

/* Four senders at once: the server takes 10 us for each end, so the last send is done after 40 us
 * at the least. */
static void the_kernel_server_serves_one_at_a_time(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(5);
    m.software.kernel_server = true;
    m.software.kernel_time = 10e-6;
    struct outcome o = go(&m, 5, all_to_zero, NULL);
    int64_t latest_send = 0, contention = 0;
    for (int i = 1; i < 5; i++)
        latest_send = o.r.finish_ps[i] > latest_send ? o.r.finish_ps[i] : latest_send;
    for (int i = 0; i < 5 * o.r.nstage; i++) contention += o.r.stage[i].contention_ps;
    assert_true(latest_send >= 40000000);
    assert_true(contention >= 60000000);
    accounts_close(&o.r);
    arena_destroy(o.arena);
}

static void everybody_waits_for_the_left(struct comm *c, void *context)
{
    (void)context;
    char b[8];
    comm_stage(c, 1);
    comm_recv(c, (comm_rank(c) + 2) % comm_size(c), 42, b, 8);
}

static void a_deadlock_names_its_cycle(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(6);
    struct outcome o = go(&m, 6, everybody_waits_for_the_left, NULL);
    assert_int_equal(o.r.status, RUN_DEADLOCK);
    assert_non_null(strstr(o.r.text, "a cycle of 3"));
    assert_non_null(strstr(o.r.text, "tag 42"));
    assert_non_null(strstr(o.r.text, "in second"));
    assert_non_null(strstr(o.r.text, "test_world.c:"));
    arena_destroy(o.arena);
}

static void one_rank_misses_the_barrier(struct comm *c, void *context)
{
    (void)context;
    if (comm_rank(c) != 2) comm_barrier(c);
}

static void a_forgotten_barrier_is_explained(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(4);
    m.software.barrier = BARRIER_HARDWARE;
    struct outcome o = go(&m, 4, one_rank_misses_the_barrier, NULL);
    assert_int_equal(o.r.status, RUN_DEADLOCK);
    assert_non_null(strstr(o.r.text, "3 of 4 ranks"));
    arena_destroy(o.arena);
}

static void noise_is_seeded_and_off_by_default(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(4);
    struct outcome quiet = go(&m, 4, late_barrier, NULL);
    m.noise.compute_cv = 0.1;
    struct outcome a = go(&m, 4, late_barrier, NULL), b = go(&m, 4, late_barrier, NULL);
    assert_int_equal(a.r.makespan_ps, b.r.makespan_ps);
    assert_int_not_equal(a.r.makespan_ps, quiet.r.makespan_ps);
    accounts_close(&a.r);
    arena_destroy(quiet.arena);
    arena_destroy(a.arena);
    arena_destroy(b.arena);
}

static void background_traffic_slows_but_never_breaks(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(16);
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_TORUS, .ndim = 2, .dims = {4, 4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    m.network.level = LEVEL_LINK;
    struct outcome quiet = go(&m, 16, traffic, NULL);
    m.noise.background_load = 0.5;
    m.noise.background_bytes = 4096;
    struct outcome busy = go(&m, 16, traffic, NULL);
    assert_int_equal(busy.r.status, RUN_OK);
    assert_true(busy.r.makespan_ps > quiet.r.makespan_ps);
    accounts_close(&busy.r);
    arena_destroy(quiet.arena);
    arena_destroy(busy.arena);
}

static void a_deadlock_is_seen_under_background_traffic(void **state)
{
    (void)state;
    struct machine_spec m = crossbar(6);
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_TORUS, .ndim = 1, .dims = {6}, .nodes_per_router = 1,
        .processors_per_node = 1};
    m.network.level = LEVEL_LINK;
    m.noise.background_load = 0.3;
    m.noise.background_bytes = 1000;
    struct outcome o = go(&m, 6, everybody_waits_for_the_left, NULL);
    assert_int_equal(o.r.status, RUN_DEADLOCK);
    arena_destroy(o.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_message_takes_what_the_formula_says),
        cmocka_unit_test(short_messages_cost_less_up_to_their_limit),
        cmocka_unit_test(parts_add_up_to_the_makespan_at_every_level),
        cmocka_unit_test(the_same_run_has_the_same_digest),
        cmocka_unit_test(messages_match_in_the_order_sent),
        cmocka_unit_test(collectives_are_right_for_every_size),
        cmocka_unit_test(a_hardware_barrier_releases_all_at_once),
        cmocka_unit_test(a_software_barrier_takes_log2_rounds),
        cmocka_unit_test(a_large_message_shakes_hands_first),
        cmocka_unit_test(the_kernel_server_serves_one_at_a_time),
        cmocka_unit_test(a_deadlock_names_its_cycle),
        cmocka_unit_test(a_forgotten_barrier_is_explained),
        cmocka_unit_test(noise_is_seeded_and_off_by_default),
        cmocka_unit_test(background_traffic_slows_but_never_breaks),
        cmocka_unit_test(a_deadlock_is_seen_under_background_traffic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
