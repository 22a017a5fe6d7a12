/* test_flit.c - wormhole switching: hand cases and every arrival of the reference router, deadlock,
 * and the two ways (trains, single flits) against each other. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "net/net_flit.h"
#include "net/traffic.h"
#include "study/netcheck_case.h"

#include "reference.h"

static const bool flit_level[LEVELS] = {[LEVEL_FLIT] = true};

static void hand_cases_are_exact(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    int exact = 0, stuck = 0;
    ask(&n, flit_level, DATA "hand_cases.json", " wormhole B", a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_row *row = &n.row[i];
        const struct netcheck_answer *x = &row->answer[LEVEL_FLIT];
        assert_true(x->ran);
        assert_true(x->deadlock == row->expect_deadlock);
        stuck += x->deadlock;
        if (x->deadlock || row->name[0] == 'L') continue;
        if (x->differing > 0) fail_msg("%s differs", row->name);
        exact++;
    }
    assert_int_equal(exact, 36);
    assert_int_equal(stuck, 1);
    arena_destroy(a);
}

/* rows of files whose group says one virtual channel: no arrival may differ */
static int exact_rows(const char *file, const char *filter, int64_t *messages)
{
    struct arena *a = arena_create();
    struct netcheck n;
    int count = 0;
    ask(&n, flit_level, file, filter, a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *x = &n.row[i].answer[LEVEL_FLIT];
        if (!strstr(n.row[i].group, "vc=1")) continue;
        assert_true(n.row[i].compared && x->ran);
        if (x->differing > 0 || x->deadlock)
            fail_msg("%s: %d arrivals differ", n.row[i].name, x->differing);
        *messages += n.row[i].nmessage;
        count++;
    }
    arena_destroy(a);
    return count;
}

static void one_channel_is_exact(void **state)
{
    (void)state;
    int64_t messages = 0;
    assert_int_equal(exact_rows(DATA "makespan.json", "mesh", &messages), 168);
    assert_int_equal(exact_rows(DATA "makespan.json", "hcube", &messages), 264);
    assert_int_equal(exact_rows(DATA "collectives.json", NULL, &messages), 22);
    assert_int_equal(messages, 47232 + 19288);
}

/* routers that compute the route (P4) and allocate the channel (P5) before the switch, up to beyond
 * saturation */
static void stages_are_exact(void **state)
{
    (void)state;
    int64_t messages = 0;
    assert_int_equal(exact_rows(DATA "stages.json", NULL, &messages), 4);
    assert_int_equal(messages, 135 + 154 + 153 + 165);
}

/* the reference's allocators for several channels are its own: bounds, not equality */
static void several_channels_are_close(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    double sum = 0, worst = 0;
    int count = 0;
    ask(&n, flit_level, DATA "makespan.json", "torus", a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *x = &n.row[i].answer[LEVEL_FLIT];
        double error = x->error < 0 ? -x->error : x->error;
        assert_true(x->ran && !x->deadlock);
        sum += error;
        worst = error > worst ? error : worst;
        count++;
    }
    assert_true(count >= 220);
    assert_true(sum / count < 0.01 && worst < 0.15);
    ask(&n, flit_level, DATA "makespan_sensitivity.json", NULL, a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *x = &n.row[i].answer[LEVEL_FLIT];
        assert_true(x->found >= 0.98 * n.row[i].low && x->found <= 1.02 * n.row[i].high);
    }
    arena_destroy(a);
}

/* ---- lists made here ---- */

/* BURSTS: lists with several channels. */
enum { MOST = 600, BURSTS = 1200 };

struct bench {
    struct arena *arena;
    struct topology_spec spec;
    struct machine_spec machine;
    struct topology *topology;
    int count, delivered;
    sim_ps grid; /* ready times are multiples of it; 0: any */
    struct net_message message[MOST];
};

static void bench_open(struct bench *b, const char *topology, int vcs, int buffer)
{
    struct err e;
    err_clear(&e);
    b->arena = arena_create();
    b->delivered = 0;
    b->grid = 0;
    assert_true(netcheck_topology(topology, 0, &b->spec, &e));
    b->machine = netcheck_machine(&b->spec, vcs, buffer, 0, 3);
    b->machine.network.level = LEVEL_FLIT;
    b->topology = topology_create(&b->machine.topology, b->arena, &e);
    assert_non_null(b->topology);
}

static void ring_deadlock_names_the_cycle(void **state)
{
    (void)state;
    int src[4] = {0, 1, 2, 3}, dst[4] = {2, 3, 0, 1};
    int64_t bytes[4] = {288, 288, 288, 288};
    sim_ps time[4] = {0};
    struct traffic q = {.nmessage = 4, .src = src, .dst = dst, .bytes = bytes, .time = time};
    for (int vcs = 1; vcs <= 2; vcs++) {
        struct traffic_result r = {0};
        struct bench b;
        struct err e;
        err_clear(&e);
        bench_open(&b, "ring4", vcs, 5);
        assert_true(traffic_run(&q, &b.machine, b.topology, b.arena, false, &r, &e));
        assert_true(r.deadlock == (vcs == 1)); /* two channels are two dateline classes */
        assert_int_equal(r.arrived, vcs == 1 ? 0 : 4);
        for (int l = 0; l < 4 && r.deadlock; l++) {
            char name[32];
            snprintf(name, sizeof name, "router %d to %d", l, (l + 1) % 4);
            if (!strstr(r.text, name)) fail_msg("'%s' does not name %s", r.text, name);
        }
        arena_destroy(b.arena);
    }
}

/* 0 -> 3 and 1 -> 3 share two links and the ejection port; route and channel take a cycle each of a
 * hop's five. 1 -> 3 is alone: 5 R + 2 + 17 = 34. Its tail leaves link 1-2 at 22, so that the
 * channel is allocated at 23 and the head of 0 -> 3, there since 10, crosses at 24. It is behind
 * that tail in the buffers, too: at router 2 it is the front from 28 and crosses at 30, at router 3
 * from 33 and crosses at 35; 35 + 17 + 2 = 54. */
static void heads_wait_for_route_and_channel(void **state)
{
    (void)state;
    static const enum network_level levels[] = {LEVEL_FLIT, LEVEL_PACKET, LEVEL_AUTO};
    int src[2] = {0, 1}, dst[2] = {3, 3};
    int64_t bytes[2] = {288, 288};
    sim_ps time[2] = {0}, arrival[2];
    struct traffic q = {.nmessage = 2, .src = src, .dst = dst, .bytes = bytes, .time = time};
    for (int l = 0; l < 3; l++) {
        struct traffic_result r = {.arrival = arrival};
        struct bench b;
        struct err e;
        err_clear(&e);
        bench_open(&b, "mesh1x8", 1, 64);
        b.machine = netcheck_machine(&b.spec, 1, 64, 0, 5);
        b.machine.network.level = levels[l];
        assert_true(traffic_run(&q, &b.machine, b.topology, b.arena, false, &r, &e));
        assert_int_equal(arrival[0], 54000);
        assert_int_equal(arrival[1], 34000);
        b.machine.network.vc_allocation_latency = 4.5e-9; /* with the route more than the hop */
        assert_false(traffic_run(&q, &b.machine, b.topology, b.arena, false, &r, &e));
        assert_non_null(strstr(e.text, "network.vc_allocation_latency 4500 ps"));
        arena_destroy(b.arena);
    }
}

/* level packet has the same gaps: where packets fit, every arrival of the reference's five
 * stages */
static void packets_wait_as_flits_do(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    const bool level[LEVELS] = {[LEVEL_PACKET] = true, [LEVEL_AUTO] = true};
    ask(&n, level, DATA "stages.json", "packets that fit", a);
    assert_int_equal(n.nrow, 1);
    for (int l = LEVEL_PACKET; l < LEVELS; l++)
        if (level[l]) assert_true(n.row[0].answer[l].ran && n.row[0].answer[l].differing == 0);
    arena_destroy(a);
}

/* Behind a slow injection port (4 cycles a flit) the last flits would catch up with their head,
 * which takes two cycles more at each router; the message is delivered when it is in an empty
 * network of any level: 4 hops of 5, 17 flits of 4, 2 at the ends. */
static void slow_ports_keep_zero_load(void **state)
{
    (void)state;
    int src[1] = {0}, dst[1] = {3};
    int64_t bytes[1] = {288};
    sim_ps time[1] = {0}, arrival[1];
    struct traffic q = {.nmessage = 1, .src = src, .dst = dst, .bytes = bytes, .time = time};
    for (int vcs = 1; vcs <= 2; vcs++) {
        struct traffic_result r = {.arrival = arrival};
        struct bench b;
        struct err e;
        err_clear(&e);
        bench_open(&b, "mesh1x8", vcs, 64);
        b.machine = netcheck_machine(&b.spec, vcs, 64, 0, 5);
        b.machine.network.level = LEVEL_FLIT;
        b.machine.network.injection_bandwidth = 4e9;
        assert_true(traffic_run(&q, &b.machine, b.topology, b.arena, false, &r, &e));
        assert_int_equal(arrival[0], 20000 + 68000 + 2000);
        arena_destroy(b.arena);
    }
}

static void message_delivered(void *context, struct net_message *m)
{
    struct bench *b = context;
    assert_true(m->arrival > m->ready);
    b->delivered++;
}

/* random messages on b's machine by one of the two ways; arrivals into out[b->count] */
static void replay(struct bench *b, const struct flit_way *way, uint64_t seed, sim_ps *out)
{
    struct random r = random_make(seed, 7, 0);
    struct sim *s = sim_create();
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct net *n = net_create(&b->machine, b->topology, s, a, message_delivered, b, false, &e);
    if (!n) fail_msg("%s", e.text);
    n->state = way->create(n, &e);
    int flits = 1 + (int)random_below(&r, 40);
    double span =
        b->count * flits * 500.0 / b->topology->nnode * (double)(1 + random_below(&r, 20));
    sim_ps at = 0;
    b->delivered = 0;
    for (int i = 0; i < b->count; i++) {
        at += (sim_ps)random_uniform(&r, 0, 2 * span / b->count);
        if (b->grid > 0) at -= at % b->grid;
        b->message[i] = (struct net_message){.id = i, .ready = at};
        b->message[i].src = (int)random_below(&r, (uint64_t)b->topology->nnode);
        b->message[i].dst = (int)random_below(&r, (uint64_t)b->topology->nnode);
        b->message[i].bytes = 1 + (int64_t)random_below(&r, (uint64_t)flits * 16);
        net_send(n, &b->message[i]);
    }
    while (sim_step(s)) continue;
    if (b->delivered != b->count)
        fail_msg("seed %d: %d messages lost", (int)seed, b->count - b->delivered);
    for (int i = 0; i < b->count; i++) out[i] = b->message[i].arrival;
    sim_destroy(s);
    arena_destroy(a);
}

/* Packets, latencies, rates, gap and arbitration by chance. */
static void draw(struct bench *b, struct random *r)
{
    struct network_spec *w = &b->machine.network;
    b->count = 20 + (int)random_below(r, MOST / 3);
    if (random_below(r, 2)) w->packet_bytes = 16 * (1 + (int64_t)random_below(r, 30));
    if (random_below(r, 2)) w->hop_latency = 1e-10 * (double)(1 + random_below(r, 60));
    if (random_below(r, 2)) w->credit_latency = 1e-10 * (double)random_below(r, 60);
    if (random_below(r, 2)) {
        sim_ps tau = sim_from_seconds(w->hop_latency);
        sim_ps setup = (sim_ps)random_below(r, (uint64_t)tau + 1);
        w->routing_latency = 1e-12 * (double)random_below(r, (uint64_t)setup + 1);
        w->vc_allocation_latency = 1e-12 * (double)setup - w->routing_latency;
    }
    if (random_below(r, 3) == 0) w->injection_bandwidth = 16e9 / (double)(1 + random_below(r, 4));
    if (random_below(r, 3) == 0) w->ejection_bandwidth = 16e9 / (double)(1 + random_below(r, 4));
    if (random_below(r, 3) == 0) b->machine.software.gap = 1e-9 * (double)random_below(r, 50);
    if (random_below(r, 3) == 0) w->arbitration = ARBITRATION_FIRST_COME;
}

static void must_be_equal(const struct bench *b, uint64_t seed, const sim_ps *one,
                          const sim_ps *other, const char *what)
{
    for (int i = 0; i < b->count; i++)
        if (one[i] != other[i])
            fail_msg("seed %d message %d: %lld, %lld by %s", (int)seed, i, (long long)one[i],
                     (long long)other[i], what);
}

/* Trains work out piecewise linear times far ahead, events move single flits; they share no
 * arithmetic. With one channel they must agree, whatever the rates, latencies, buffers and
 * packets. */
static void trains_equal_single_flits(void **state)
{
    (void)state;
    static const char *const topologies[] = {"mesh4x4", "mesh1x8", "hcube4", "mesh2x3x4"};
    static sim_ps train[MOST], flit[MOST];
    for (uint64_t seed = 0; seed < 120; seed++) {
        struct random r = random_make(seed, 8, 0);
        struct bench b;
        bench_open(&b, topologies[seed % 4], 1, 1 + (int)random_below(&r, 24));
        draw(&b, &r);
        replay(&b, &flit_train, seed, train);
        replay(&b, &flit_event, seed, flit);
        must_be_equal(&b, seed, train, flit, "flits");
        arena_destroy(b.arena);
    }
}

/* With several channels, flits that nobody can meet cross in one event. Where others' traffic may
 * come between them, each has its own, as if there were some. Lists on a grid of flit times have
 * many events at one instant. */
static void bursts_equal_single_flits(void **state)
{
    (void)state;
    static const char *const topologies[] = {"torus4x4", "torus8",  "torus4x4x2", "hcube4",
                                             "mesh4x4",  "torus16", "mesh2x3x4"};
    static sim_ps burst[MOST], flit[MOST];
    for (int i = 0; i <= BURSTS; i++) {
        /* The last one: a node that looks for room while a burst is on its way. */
        const uint64_t seed = i < BURSTS ? (uint64_t)i : 2813;
        struct random r = random_make(seed, 9, 0);
        struct bench b;
        bench_open(&b, topologies[seed % 7], 2 + (int)random_below(&r, 3),
                   1 + (int)random_below(&r, 24));
        draw(&b, &r);
        if (random_below(&r, 2)) b.grid = 1000;
        b.machine.network.hop_latency += 1e-9 * (double)random_below(&r, 9);
        replay(&b, &flit_event, seed, burst);
        b.machine.noise.background_load = 1e-9;
        replay(&b, &flit_event, seed, flit);
        must_be_equal(&b, seed, burst, flit, "single flits");
        arena_destroy(b.arena);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hand_cases_are_exact),
        cmocka_unit_test(one_channel_is_exact),
        cmocka_unit_test(stages_are_exact),
        cmocka_unit_test(heads_wait_for_route_and_channel),
        cmocka_unit_test(packets_wait_as_flits_do),
        cmocka_unit_test(slow_ports_keep_zero_load),
        cmocka_unit_test(several_channels_are_close),
        cmocka_unit_test(ring_deadlock_names_the_cycle),
        cmocka_unit_test(trains_equal_single_flits),
        cmocka_unit_test(bursts_equal_single_flits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
