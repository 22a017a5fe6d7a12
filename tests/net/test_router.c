/* test_router.c - levels packet and flit where packets have several ways on: the empty network's
 * time, nothing lost at saturation, the same answer every time, and a deadlock that is named. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "net/traffic.h"
#include "study/netcheck_case.h"

#define ONE .nodes_per_router = 1, .processors_per_node = 1

static const int ring_cables[5][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}};

static const struct topology_spec network[] = {
    {.family = TOPOLOGY_MESH, .ndim = 2, .dims = {4, 4}, ONE},
    {.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {4, 3}, ONE},
    {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {4}, ONE},
    {.family = TOPOLOGY_HYPERX,
     .ndim = 2,
     .dims = {3, 3},
     .nodes_per_router = 2,
     .processors_per_node = 1},
    {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {2, 3}, ONE},
    {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {2, 4, 2, 0}, ONE},
};
enum { NETWORKS = sizeof network / sizeof *network, CHANNELS = 8, BUFFER = 8 };

static const enum network_level buffered[] = {LEVEL_FLIT, LEVEL_PACKET, LEVEL_AUTO};

/* The reference's router with a rule. */
static struct machine_spec machine(const struct topology_spec *s, enum routing_rule rule,
                                   enum network_level level, int channels)
{
    struct machine_spec m = netcheck_machine(s, channels, BUFFER, 0, 4);
    m.network.level = level;
    m.network.routing = rule;
    return m;
}

/* Play a list; arrivals into arrival[]. False: the rule is not for the network. */
static bool play(const struct machine_spec *m, const struct traffic *q, sim_ps *arrival,
                 struct traffic_result *r, struct err *e)
{
    struct arena *a = arena_create();
    *r = (struct traffic_result){.arrival = arrival};
    err_clear(e);
    const struct topology *t = topology_create(&m->topology, a, e);
    if (!t) fail_msg("%s", e->text);
    const bool ok = traffic_run(q, m, t, a, false, r, e);
    arena_destroy(a);
    return ok;
}

static int nodes_of(const struct topology_spec *s)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    const int n = topology_create(s, a, &e)->nnode;
    arena_destroy(a);
    return n;
}

/* One message after the other: on every level the closed form of net_zero_load, so that all agree.
 */
static void levels_agree_in_an_empty_network(void **state)
{
    (void)state;
    enum { MESSAGES = 24 };
    int compared = 0;
    for (int i = 0; i < NETWORKS; i++)
        for (int rule = 0; rule < ROUTING_RULES; rule++) {
            const int n = nodes_of(&network[i]);
            int src[MESSAGES], dst[MESSAGES];
            int64_t bytes[MESSAGES];
            sim_ps time[MESSAGES], answer[LEVELS][MESSAGES];
            for (int m = 0; m < MESSAGES; m++) {
                src[m] = 5 * m % n;
                dst[m] = (7 * m + 3) % n;
                bytes[m] = 16 * (1 + m % 6);
                time[m] = (sim_ps)m * 1000000;
            }
            const struct traffic q = {MESSAGES, src, dst, bytes, time, NULL, NULL, NULL, 0, false};
            for (int l = 0; l < LEVELS; l++) {
                struct machine_spec m =
                    machine(&network[i], (enum routing_rule)rule, (enum network_level)l, CHANNELS);
                struct traffic_result r;
                struct err e;
                m.topology.dim_latency[0] = 2e-9;
                m.topology.dim_latency[1] = 5e-9;
                if (!play(&m, &q, answer[l], &r, &e)) {
                    assert_non_null(strstr(e.text, "is not for topology"));
                    break;
                }
                assert_int_equal(r.arrived, MESSAGES);
                for (int k = 0; k < MESSAGES; k++) {
                    if (answer[l][k] == answer[0][k]) continue;
                    fail_msg("%s on network %d, level %d: message %d at %lld, not %lld",
                             routing_rule_name((enum routing_rule)rule), i, l, k,
                             (long long)answer[l][k], (long long)answer[0][k]);
                }
                compared += l > 0 ? MESSAGES : 0;
            }
        }
    assert_int_equal(compared, 4 * 55 * MESSAGES);
}

/* Long cables: T = 4 (links + 1) + 2 + (flits - 1) cycles and what the links take longer. */
static void cables_add_their_latency(void **state)
{
    (void)state;
    int src = 0, dst = 4 + 2;
    int64_t bytes = 3 * 16;
    sim_ps time = 0, arrival;
    struct traffic q = {1, &src, &dst, &bytes, &time, NULL, NULL, NULL, 0, false};
    for (int l = 0; l < LEVELS; l++) {
        struct machine_spec m =
            machine(&network[0], ROUTING_DETERMINISTIC, (enum network_level)l, 1);
        struct traffic_result r;
        struct err e;
        m.topology.dim_latency[0] = 7e-9;
        m.topology.dim_latency[1] = 30e-9;
        assert_true(play(&m, &q, &arrival, &r, &e));
        assert_int_equal(arrival, 1000 * (4 * 4 + 2 + 2 + 2 * 7 + 30));
    }
}

/* Far more than the network can carry, all at once: a list of `count` messages of up to 12 flits.
 */
static void crowd(const struct topology_spec *s, int count, uint64_t seed, struct arena *a,
                  struct traffic *q)
{
    const int n = nodes_of(s);
    struct random r = random_make(seed, 1, 2);
    *q = (struct traffic){.nmessage = count,
                          .src = TAKE(a, count, int),
                          .dst = TAKE(a, count, int),
                          .bytes = TAKE(a, count, int64_t),
                          .time = TAKE(a, count, sim_ps)};
    for (int m = 0; m < count; m++) {
        q->src[m] = (int)random_below(&r, (uint64_t)n);
        q->dst[m] = (int)random_below(&r, (uint64_t)n);
        q->bytes[m] = 16 * (int64_t)(1 + random_below(&r, 12));
        q->time[m] = (sim_ps)random_below(&r, 1000) * 1000;
    }
}

/* Nothing is lost and nothing stands still; the same list twice gives the same events. */
static void nothing_is_lost_at_saturation(void **state)
{
    (void)state;
    enum { MESSAGES = 1200 };
    int played = 0;
    for (int i = 0; i < NETWORKS; i++)
        for (int rule = 0; rule < ROUTING_RULES; rule++)
            for (size_t l = 0; l < 2; l++) {
                struct arena *a = arena_create();
                struct machine_spec m =
                    machine(&network[i], (enum routing_rule)rule, buffered[l], CHANNELS);
                struct traffic q;
                struct traffic_result r, again;
                struct err e;
                /* Routers of their own only by a rule or by cables. */
                m.topology.dim_latency[0] = rule == 0 ? 1e-9 : 0;
                m.network.vc_allocator = rule % 2 ? ALLOCATOR_ISLIP : ALLOCATOR_SELECT;
                crowd(&network[i], MESSAGES, (uint64_t)rule, a, &q);
                sim_ps *arrival = TAKE(a, MESSAGES, sim_ps);
                if (play(&m, &q, arrival, &r, &e)) {
                    if (r.deadlock)
                        fail_msg("%s on network %d: %s", routing_rule_name(m.network.routing), i,
                                 r.text);
                    assert_int_equal(r.arrived, MESSAGES);
                    assert_true(play(&m, &q, arrival, &again, &e));
                    assert_true(again.digest == r.digest && again.makespan == r.makespan);
                    played++;
                }
                arena_destroy(a);
            }
    assert_int_equal(played, 2 * 55);
}

/* A ring of routers with any channel for everybody: all wait for the next. */
static void a_deadlock_is_named(void **state)
{
    (void)state;
    struct topology_spec ring = {.family = TOPOLOGY_GRAPH,
                                 .ndim = 1,
                                 .dims = {5},
                                 ONE,
                                 .nlink = 5,
                                 .link = (int(*)[2])ring_cables};
    int src[5], dst[5];
    int64_t bytes[5];
    sim_ps time[5] = {0}, arrival[5];
    for (int i = 0; i < 5; i++) {
        src[i] = i;
        dst[i] = (i + 2) % 5;
        bytes[i] = 18 * 16;
    }
    const struct traffic q = {5, src, dst, bytes, time, NULL, NULL, NULL, 0, false};
    struct machine_spec m = machine(&ring, ROUTING_BOOKSIM_MIN, LEVEL_FLIT, 1);
    struct traffic_result r;
    struct err e;
    assert_true(play(&m, &q, arrival, &r, &e));
    assert_true(r.deadlock);
    assert_non_null(strstr(r.text, "waits for link"));
    /* With a class for each hop the same messages get through. */
    m = machine(&ring, ROUTING_VALIANT, LEVEL_FLIT, 4);
    assert_true(play(&m, &q, arrival, &r, &e));
    assert_int_equal(r.arrived, 5);
}

/* A ring of four whose FIFOs hold the tail of one packet and the head of the next: BookSim's rule
 * for tori lets nobody out who stands behind another. The program's own gives a channel only to a
 * packet that fits. */
static void an_escape_needs_packets_that_fit(void **state)
{
    (void)state;
    enum { MESSAGES = 2000 };
    const struct topology_spec ring = {.family = TOPOLOGY_TORUS, .ndim = 1, .dims = {4}, ONE};
    struct arena *a = arena_create();
    struct random r = random_make(8, 1, 2);
    struct traffic q = {.nmessage = MESSAGES,
                        .src = TAKE(a, MESSAGES, int),
                        .dst = TAKE(a, MESSAGES, int),
                        .bytes = TAKE(a, MESSAGES, int64_t),
                        .time = TAKE(a, MESSAGES, sim_ps)};
    for (int m = 0; m < MESSAGES; m++) {
        q.src[m] = (int)random_below(&r, 4);
        q.dst[m] = (q.src[m] + 1 + (int)random_below(&r, 2)) % 4;
        q.bytes[m] = 16 * (int64_t)(1 + random_below(&r, 6));
    }
    sim_ps *arrival = TAKE(a, MESSAGES, sim_ps);
    struct machine_spec shared = machine(&ring, ROUTING_BOOKSIM_MIN_ADAPT, LEVEL_FLIT, 4),
                        fitting = machine(&ring, ROUTING_ADAPTIVE, LEVEL_FLIT, 4);
    struct traffic_result x;
    struct err e;
    assert_true(play(&shared, &q, arrival, &x, &e));
    assert_true(x.deadlock && x.arrived < MESSAGES);
    assert_true(play(&fitting, &q, arrival, &x, &e));
    assert_true(!x.deadlock && x.arrived == MESSAGES);
    arena_destroy(a);
}

/* What adaptive rules are for: in a pattern that crowds one link they are far faster. */
static void adaptive_rules_go_around(void **state)
{
    (void)state;
    enum { PER_NODE = 40, NODES = 16 };
    const struct topology_spec *mesh = &network[0];
    struct arena *a = arena_create();
    struct traffic q = {.nmessage = PER_NODE * NODES,
                        .src = TAKE(a, PER_NODE * NODES, int),
                        .dst = TAKE(a, PER_NODE * NODES, int),
                        .bytes = TAKE(a, PER_NODE * NODES, int64_t),
                        .time = TAKE(a, PER_NODE * NODES, sim_ps)};
    for (int m = 0; m < q.nmessage; m++) {
        const int i = m % NODES;
        q.src[m] = i;
        q.dst[m] = i % 4 * 4 + i / 4; /* transpose */
        q.bytes[m] = 64;
    }
    sim_ps *arrival = TAKE(a, q.nmessage, sim_ps);
    for (size_t l = 0; l < 2; l++) {
        struct machine_spec fixed = machine(mesh, ROUTING_BOOKSIM_DIM_ORDER, buffered[l], 4),
                            free = machine(mesh, ROUTING_ADAPTIVE, buffered[l], 4);
        struct traffic_result slow, fast;
        struct err e;
        assert_true(play(&fixed, &q, arrival, &slow, &e) && play(&free, &q, arrival, &fast, &e));
        assert_true((double)fast.makespan < 0.75 * (double)slow.makespan);
    }
    arena_destroy(a);
}

/* What a round of offers leaves unmatched, further rounds match: a crowd on routers of many ports
 * is through sooner. */
static void more_rounds_give_more(void **state)
{
    (void)state;
    enum { MESSAGES = 4000 };
    struct arena *a = arena_create();
    struct traffic q;
    sim_ps took[2];
    crowd(&network[3], MESSAGES, 5, a, &q);
    sim_ps *arrival = TAKE(a, MESSAGES, sim_ps);
    for (int i = 0; i < 2; i++) {
        struct machine_spec m = machine(&network[3], ROUTING_BOOKSIM_DIM_ORDER, LEVEL_FLIT, 4);
        struct traffic_result r;
        struct err e;
        m.network.allocator_iterations = 1 + 2 * i;
        assert_true(play(&m, &q, arrival, &r, &e));
        assert_int_equal(r.arrived, MESSAGES);
        took[i] = r.makespan;
    }
    assert_true((double)took[1] < 0.97 * (double)took[0]);
    arena_destroy(a);
}

static void what_cannot_run_is_refused(void **state)
{
    (void)state;
    int node = 0;
    int64_t bytes = 16;
    sim_ps time = 0, arrival;
    const struct traffic q = {1, &node, &node, &bytes, &time, NULL, NULL, NULL, 0, false};
    struct traffic_result r;
    struct err e;
    struct machine_spec m = machine(&network[1], ROUTING_VALIANT, LEVEL_FLIT, 3);
    assert_false(play(&m, &q, &arrival, &r, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "needs at least 4"));
    /* A level without channels does not need them. */
    m.network.level = LEVEL_LINK;
    assert_true(play(&m, &q, &arrival, &r, &e));
    struct topology_spec bus = {.family = TOPOLOGY_BUS, .ndim = 1, .dims = {4}, ONE};
    m = machine(&bus, ROUTING_ADAPTIVE, LEVEL_LINK, 3);
    assert_false(play(&m, &q, &arrival, &r, &e));
    assert_non_null(strstr(e.text, "is not for topology 'bus'"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_agree_in_an_empty_network),
        cmocka_unit_test(cables_add_their_latency),
        cmocka_unit_test(nothing_is_lost_at_saturation),
        cmocka_unit_test(a_deadlock_is_named),
        cmocka_unit_test(an_escape_needs_packets_that_fit),
        cmocka_unit_test(adaptive_rules_go_around),
        cmocka_unit_test(more_rounds_give_more),
        cmocka_unit_test(what_cannot_run_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
