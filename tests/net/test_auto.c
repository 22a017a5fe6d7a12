/* test_auto.c - the level auto gives every message the times that packet gives it, bit for bit, and
 * costs a fraction where paths do not meet. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/random.h"
#include "net/traffic.h"
#include "study/netcheck.h"
#include "study/netcheck_case.h"

#define DATA MIMDSIM_SRCDIR "/tests/data/net/"

/* ---- random machines and message lists, by number ---- */

struct sample {
    struct arena *arena;
    struct topology_spec spec;
    struct machine_spec machine;
    struct topology *topology;
    struct traffic q;
};

static int pick(struct random *r, const int *list, int n)
{
    return list[random_below(r, (uint64_t)n)];
}
static bool one_in(struct random *r, int n) { return random_below(r, (uint64_t)n) == 0; }

static void draw_network(struct sample *s, struct random *r)
{
    static const char *const names[] = {"mesh4x4",       "mesh8x8",
                                        "torus4x4",      "torus4x4x8",
                                        "torus5x3",      "ring8",
                                        "ring4",         "hcube4",
                                        "hcube6",        "mesh1x8",
                                        "mesh3x5",       "torus2x3x4",
                                        "fattree_k4_n3", "dragonfly_p2a4h2_72"};
    static const int buffers[] = {5, 6, 8, 12, 16, 22, 64};
    struct err e;
    err_clear(&e);
    const char *name = names[random_below(r, sizeof names / sizeof *names)];
    assert_true(netcheck_topology(name, one_in(r, 2) ? 2 : 0, &s->spec, &e));
    if (one_in(r, 8)) s->spec.nodes_per_router = 1 + (int)random_below(r, 3);
    if (one_in(r, 8)) s->spec.processors_per_node = 2;
    int channels = name[0] == 'd' ? 3 : strchr("tr", name[0]) ? 2 : 1;
    if (one_in(r, 5)) channels += 1 + (int)random_below(r, 2);
    s->machine = netcheck_machine(&s->spec, channels, pick(r, buffers, 7), 0, 3);
    struct network_spec *w = &s->machine.network;
    if (one_in(r, 3)) w->arbitration = ARBITRATION_FIRST_COME;
    if (one_in(r, 2))
        w->packet_bytes = 16 * (1 + (int64_t)random_below(r, (uint64_t)w->buffer_flits));
    if (w->packet_bytes > 0 && w->packet_bytes < 16 * w->buffer_flits && one_in(r, 3))
        w->header_bytes = 16;
}

/* rates and latencies that are not one cycle: everything must hold in picoseconds */
static void draw_times(struct sample *s, struct random *r)
{
    struct network_spec *w = &s->machine.network;
    if (one_in(r, 6)) s->machine.software.gap = 1e-9 * (double)random_below(r, 60);
    if (one_in(r, 6)) w->injection_bandwidth = 16e9 / (double)(1 + random_below(r, 3));
    if (one_in(r, 6)) w->ejection_bandwidth = 16e9 / (double)(1 + random_below(r, 3));
    if (one_in(r, 8)) s->spec.dim_bandwidth[0] = 16e9 / (double)(1 + random_below(r, 4));
    if (one_in(r, 2)) { /* 1 + 1 of 3 cycles; with other latencies they are drawn below */
        w->routing_latency = one_in(r, 2) ? 1e-9 : 0;
        w->vc_allocation_latency = one_in(r, 3) ? 0 : one_in(r, 2) ? 1e-9 : 2e-9;
    }
    if (!one_in(r, 6)) return;
    double setup = w->routing_latency + w->vc_allocation_latency;
    w->hop_latency = 0.25e-9 * (double)(1 + random_below(r, 30));
    if (w->hop_latency < setup) w->hop_latency = setup;
    w->credit_latency = 0.25e-9 * (double)random_below(r, 20);
    w->end_latency = 0.5e-9 * (double)random_below(r, 4);
    double trip = w->hop_latency + (w->credit_latency > 1e-9 ? w->credit_latency : 1e-9);
    if (w->buffer_flits < trip / 1e-9 + 1) w->buffer_flits = (int)(trip / 1e-9) + 1;
}

static void draw_messages(struct sample *s, struct random *r)
{
    /* flits; 1/1000 */
    static const int sizes[] = {1, 3, 8, 20, 64}, loads[] = {1, 10, 50, 100, 300, 1000};
    struct traffic *q = &s->q;
    int n = 20 + (int)random_below(r, 300), nnode = s->topology->nnode, most = pick(r, sizes, 5);
    double span = 500.0 * n * (1 + most) / (pick(r, loads, 6) * 1e-3 * nnode);
    int hot = (int)random_below(r, (uint64_t)nnode),
        shift = 1 + (int)random_below(r, (uint64_t)nnode);
    int pattern = (int)random_below(r, 5), grain = one_in(r, 4) ? 1 : 1000;
    bool depends = one_in(r, 3);
    *q = (struct traffic){n,
                          TAKE(s->arena, n, int),
                          TAKE(s->arena, n, int),
                          TAKE(s->arena, n, int64_t),
                          TAKE(s->arena, n, sim_ps),
                          TAKE(s->arena, n, sim_ps),
                          TAKE(s->arena, n + 1, int),
                          TAKE(s->arena, 2 * n, int),
                          0, false};
    for (int i = 0; i < n; i++) {
        q->src[i] = (int)random_below(r, (uint64_t)nnode);
        q->dst[i] =
            pattern == 1 ? (q->src[i] + shift) % nnode : (int)random_below(r, (uint64_t)nnode);
        if (pattern == 2 && one_in(r, 3)) q->dst[i] = hot;
        q->bytes[i] =
            16 * (1 + (int64_t)random_below(r, (uint64_t)most)) - (int64_t)random_below(r, 16);
        q->time[i] = (sim_ps)random_uniform(r, 0, span) / grain * grain;
        /* bursts */
        if (pattern == 3) q->time[i] = (sim_ps)random_below(r, 1 + (uint64_t)(span / 5e4)) * 50000;
        q->delay[i] = (sim_ps)random_below(r, 30000) / grain * grain;
        q->dep_first[i + 1] = q->dep_first[i];
        for (int k = depends && i > 5 ? (int)random_below(r, 3) : 0; k > 0; k--)
            q->dep[q->dep_first[i + 1]++] = i - 1 - (int)random_below(r, 5);
    }
}

static void sample_draw(struct sample *s, uint64_t seed)
{
    struct random r = random_make(seed, 21, 0);
    struct err e;
    err_clear(&e);
    s->arena = arena_create();
    draw_network(s, &r);
    draw_times(s, &r);
    s->machine.topology = s->spec;
    s->topology = topology_create(&s->machine.topology, s->arena, &e);
    if (!s->topology) fail_msg("%s", e.text);
    draw_messages(s, &r);
}

/* ---- equality ---- */

struct answer {
    sim_ps *arrival, *injected, *uncontended;
    struct traffic_result r;
};

static struct answer answer_of(struct sample *s, enum network_level level, bool want_links)
{
    struct answer x = {TAKE(s->arena, s->q.nmessage, sim_ps), TAKE(s->arena, s->q.nmessage, sim_ps),
                       TAKE(s->arena, s->q.nmessage, sim_ps), {0}};
    struct err e;
    err_clear(&e);
    x.r.arrival = x.arrival;
    x.r.injected = x.injected;
    x.r.uncontended = x.uncontended;
    s->machine.network.level = level;
    if (!traffic_run(&s->q, &s->machine, s->topology, s->arena, want_links, &x.r, &e))
        fail_msg("%s", e.text);
    return x;
}

static void compare(uint64_t seed, const struct sample *s, const struct answer *p,
                    const struct answer *q)
{
    for (int i = 0; i < s->q.nmessage; i++)
        if (p->arrival[i] != q->arrival[i] || p->injected[i] != q->injected[i] ||
            p->uncontended[i] != q->uncontended[i])
            fail_msg("seed %d message %d: packet %lld, auto %lld", (int)seed, i,
                     (long long)p->arrival[i], (long long)q->arrival[i]);
    assert_true(p->r.deadlock == q->r.deadlock);
    for (int i = 0; i < p->r.nlink && !p->r.deadlock; i++) {
        const struct link_load *k = &p->r.link[i], *l = &q->r.link[i];
        if (k->messages != l->messages || k->bytes != l->bytes || k->busy_ps != l->busy_ps ||
            k->queue_ps != l->queue_ps)
            fail_msg("seed %d: load of resource %d differs", (int)seed, i);
    }
}

static void auto_equals_packet(void **state)
{
    (void)state;
    int64_t messages = 0, packet = 0, autos = 0;
    for (uint64_t seed = 0; seed < 1500; seed++) {
        struct sample s = {0};
        sample_draw(&s, seed);
        struct answer p = answer_of(&s, LEVEL_PACKET, true), q = answer_of(&s, LEVEL_AUTO, true);
        compare(seed, &s, &p, &q);
        messages += s.q.nmessage;
        packet += p.r.events;
        autos += q.r.events;
        arena_destroy(s.arena);
    }
    assert_true(messages > 200000);
    assert_true(autos < packet);
}

/* without dateline classes a torus may lock up; both levels must come to the same standstill */
static void auto_locks_up_like_packet(void **state)
{
    (void)state;
    int locked = 0;
    for (uint64_t seed = 0; seed < 300; seed++) {
        struct sample s = {0};
        sample_draw(&s, seed + 5000);
        if (s.spec.family == TOPOLOGY_TORUS) {
            s.machine.network.virtual_channels = 1;
            struct answer p = answer_of(&s, LEVEL_PACKET, false),
                          q = answer_of(&s, LEVEL_AUTO, false);
            compare(seed, &s, &p, &q);
            locked += p.r.deadlock;
            if (p.r.deadlock) assert_non_null(strstr(q.r.text, "waits for"));
        }
        arena_destroy(s.arena);
    }
    assert_true(locked > 0);
}

static void auto_equals_packet_on_the_reference_cases(void **state)
{
    (void)state;
    static const char *const file[] = {DATA "makespan.json", DATA "collectives.json",
                                       DATA "makespan_sensitivity.json"};
    bool level[LEVELS] = {[LEVEL_PACKET] = true, [LEVEL_AUTO] = true};
    int ran = 0;
    for (int f = 0; f < 3; f++) {
        struct arena *a = arena_create();
        struct netcheck n;
        struct err e;
        err_clear(&e);
        assert_true(netcheck_run(&n, file[f], level, NULL, true, a, &e));
        for (int i = 0; i < n.nrow; i++) {
            const struct netcheck_answer *p = &n.row[i].answer[LEVEL_PACKET],
                                         *q = &n.row[i].answer[LEVEL_AUTO];
            assert_true(p->ran == q->ran);
            ran += p->ran;
            assert_true(p->found == q->found && p->differing == q->differing &&
                        p->message_error == q->message_error);
        }
        arena_destroy(a);
    }
    assert_true(ran > 390);
}

/* ---- others' traffic on the links ---- */

struct shared {
    struct net *net;
    struct sim *sim;
    struct random random;
    int left, nlink;
    sim_ps gap, busy;
};

static void others_pass(void *subject, uint64_t argument, sim_ps now)
{
    struct shared *h = subject;
    (void)argument;
    if (h->left == 0) return;
    int link = (int)random_below(&h->random, (uint64_t)h->nlink);
    assert_true(
        net_occupy(h->net, link, now, 1 + (sim_ps)random_below(&h->random, (uint64_t)h->busy)));
    sim_at(h->sim, now + 1 + (sim_ps)random_below(&h->random, (uint64_t)h->gap), 1000, 0,
           others_pass, h, 0);
}

static void count_down(void *context, struct net_message *m)
{
    struct shared *h = context;
    h->left--;
    assert_true(m->arrival >= m->uncontended);
}

static void start(void *subject, uint64_t argument, sim_ps now)
{
    (void)now;
    net_send(subject, (struct net_message *)(uintptr_t)argument);
}

static int64_t shared_replay(struct sample *s, enum network_level level, uint64_t seed,
                             sim_ps *arrival)
{
    struct shared h = {
        .sim = sim_create(), .random = random_make(seed, 31, 0), .left = s->q.nmessage};
    struct arena *a = arena_create();
    struct net_message *m = TAKE(a, s->q.nmessage, struct net_message);
    struct err e;
    err_clear(&e);
    s->machine.network.level = level;
    h.net = net_create(&s->machine, s->topology, h.sim, a, count_down, &h, false, &e);
    if (!h.net) fail_msg("%s", e.text);
    h.nlink = s->topology->nlink;
    h.busy = 1 + (sim_ps)random_below(&h.random, 60000);
    h.gap = (1 + 4 * h.busy / (h.nlink + 1)) *
            (1 + (sim_ps)random_below(&h.random, 20)); /* a fourth or less of its time */
    for (int i = 0; i < s->q.nmessage; i++) {
        m[i] = (struct net_message){.id = i,
                                    .src = s->q.src[i],
                                    .dst = s->q.dst[i],
                                    .bytes = s->q.bytes[i],
                                    .ready = s->q.time[i]};
        sim_at(h.sim, m[i].ready, NET_LANE_START, (uint64_t)i, start, h.net, (uintptr_t)&m[i]);
    }
    sim_at(h.sim, 0, 1000, 0, others_pass, &h, 0);
    while (h.left > 0 && sim_step(h.sim)) continue;
    for (int i = 0; i < s->q.nmessage; i++) arrival[i] = m[i].arrival;
    int64_t events = h.left == 0 ? sim_events(h.sim) : -1;
    sim_destroy(h.sim);
    arena_destroy(a);
    return events;
}

static void others_traffic_delays_both_alike(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 300; seed++) {
        struct sample s = {0};
        sample_draw(&s, seed + 9000);
        sim_ps *p = TAKE(s.arena, s.q.nmessage, sim_ps), *q = TAKE(s.arena, s.q.nmessage, sim_ps);
        assert_true(shared_replay(&s, LEVEL_PACKET, seed, p) > 0);
        assert_true(shared_replay(&s, LEVEL_AUTO, seed, q) > 0);
        for (int i = 0; i < s.q.nmessage; i++)
            if (p[i] != q[i])
                fail_msg("seed %d message %d: packet %lld, auto %lld", (int)seed, i,
                         (long long)p[i], (long long)q[i]);
        assert_true(shared_replay(&s, LEVEL_FLIT, seed, q) > 0);
        arena_destroy(s.arena);
    }
}

/* ---- cost ---- */

static void hypercube_steps_cost_two_events(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    bool level[LEVELS] = {[LEVEL_AUTO] = true};
    struct netcheck n;
    struct err e;
    err_clear(&e);
    assert_true(netcheck_run(&n, DATA "makespan.json", level, "hcube", true, a, &e));
    for (int i = 0; i < n.nrow; i++)
        assert_true((double)n.row[i].answer[LEVEL_AUTO].events <= 2.3 * n.row[i].nmessage);
    arena_destroy(a);
}

static double events_per_message(const char *topology, int vcs, double load)
{
    struct sample s = {.arena = arena_create()};
    struct err e;
    err_clear(&e);
    assert_true(netcheck_topology(topology, 0, &s.spec, &e));
    s.machine = netcheck_machine(&s.spec, vcs, 22, 0, 3);
    s.topology = topology_create(&s.machine.topology, s.arena, &e);
    assert_true(netcheck_load("uniform", s.topology, 20, load, 400000 / s.topology->nnode + 100000,
                              3, s.arena, &s.q, &e));
    assert_true(s.q.nmessage > 200);
    struct answer p = answer_of(&s, LEVEL_PACKET, false), q = answer_of(&s, LEVEL_AUTO, false);
    compare(0, &s, &p, &q);
    double events = (double)q.r.events / s.q.nmessage;
    arena_destroy(s.arena);
    return events;
}

static void random_messages_at_low_load_cost_two_events(void **state)
{
    (void)state;
    assert_true(events_per_message("mesh8x8", 1, 0.001) <= 2.3);
    assert_true(events_per_message("torus4x4x8", 2, 0.001) <= 2.3);
    assert_true(events_per_message("hcube7", 1, 0.001) <= 2.3);
    assert_true(events_per_message("mesh16x16", 1, 0.001) <= 2.3);
    assert_true(events_per_message("torus4x4x8", 2, 0.02) <= 4);
}

/* a message of many packets is still one claim per resource */
static void packets_of_a_message_are_one_claim(void **state)
{
    (void)state;
    struct sample s = {.arena = arena_create()};
    struct err e;
    int src[1] = {0}, dst[1] = {63};
    int64_t bytes[1] = {1 << 20};
    sim_ps time[1] = {0};
    err_clear(&e);
    assert_true(netcheck_topology("torus4x4x8", 0, &s.spec, &e));
    s.machine = netcheck_machine(&s.spec, 2, 22, 10, 3);
    s.machine.network.header_bytes = 16;
    s.topology = topology_create(&s.machine.topology, s.arena, &e);
    s.q = (struct traffic){.nmessage = 1, .src = src, .dst = dst, .bytes = bytes, .time = time};
    struct answer p = answer_of(&s, LEVEL_PACKET, true), q = answer_of(&s, LEVEL_AUTO, true);
    compare(0, &s, &p, &q);
    assert_true(p.r.events > 6554 * 3);
    assert_int_equal(q.r.events, 2);
    arena_destroy(s.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(auto_equals_packet),
        cmocka_unit_test(auto_locks_up_like_packet),
        cmocka_unit_test(auto_equals_packet_on_the_reference_cases),
        cmocka_unit_test(others_traffic_delays_both_alike),
        cmocka_unit_test(hypercube_steps_cost_two_events),
        cmocka_unit_test(random_messages_at_low_load_cost_two_events),
        cmocka_unit_test(packets_of_a_message_are_one_claim),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
