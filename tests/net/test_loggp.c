/* test_loggp.c - the level without contention against LogGP's recursions and closed forms, in
 * integers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/arena.h"
#include "base/random.h"
#include "net/traffic.h"

/* LogGP parameters and operation time, whole picoseconds, g >= G so that a message of one byte
 * obeys g */
struct loggp {
    sim_ps o, g, G, L, tf;
};

/* A row of processors that talk over a net as the model says. */
struct row {
    struct loggp p;
    int nrank;
    struct arena *arena;
    struct sim *sim;
    struct net *net;
    sim_ps *clock;          /* (nrank) */
    struct net_message *in; /* (2 nrank) last message from the left (0) and the right (1) */
    int64_t sent;
};

static void note_nothing(void *context, struct net_message *m)
{
    (void)context;
    (void)m;
}

static struct machine_spec crossbar(const struct loggp *p, int nrank)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {nrank}, .nodes_per_router = 1,
        .processors_per_node = 1};
    m.network = (struct network_spec){.level = LEVEL_LOGGP,
                                      .link_bandwidth = 1e12 / (double)p->G,
                                      .hop_latency = (double)(p->L / 3) * 1e-12,
                                      .end_latency = (double)(p->L - p->L / 3) * 1e-12};
    m.software.gap = (double)p->g * 1e-12;
    m.software.eager_bytes = -1;
    return m;
}

static void row_make(struct row *w, const struct machine_spec *m, const struct loggp *p, int nrank)
{
    struct err e;
    err_clear(&e);
    *w = (struct row){.p = *p, .nrank = nrank, .arena = arena_create(), .sim = sim_create()};
    struct topology *t = topology_create(&m->topology, w->arena, &e);
    w->net = net_create(m, t, w->sim, w->arena, note_nothing, w, false, &e);
    if (!w->net) fail_msg("%s", e.text);
    w->clock = TAKE(w->arena, nrank, sim_ps);
    w->in = TAKE(w->arena, 2 * nrank, struct net_message);
}

static void row_end(struct row *w)
{
    sim_destroy(w->sim);
    arena_destroy(w->arena);
}

/* send b bytes to `to`, if it is there; the receiver will know it as from its left (side 0) or
 * right (1) */
static void row_send(struct row *w, int from, int to, int side, int64_t b)
{
    if (to < 0 || to >= w->nrank) return;
    struct net_message *m = &w->in[2 * to + side];
    w->clock[from] += w->p.o;
    *m = (struct net_message){
        .src = from, .dst = to, .bytes = b, .id = w->sent++, .ready = w->clock[from]};
    net_send(w->net, m);
}

static void row_receive(struct row *w, int rank, int from, int side)
{
    if (from < 0 || from >= w->nrank) return;
    sim_ps arrival = w->in[2 * rank + side].arrival;
    w->clock[rank] = (w->clock[rank] > arrival ? w->clock[rank] : arrival) + w->p.o;
}

static sim_ps row_time(const struct row *w)
{
    sim_ps last = 0;
    for (int i = 0; i < w->nrank; i++)
        if (w->clock[i] > last) last = w->clock[i];
    return last;
}

static struct loggp random_parameters(struct random *r)
{
    struct loggp p = {.G = 100 + (sim_ps)random_below(r, 5000)};
    p.g = p.G + (sim_ps)random_below(r, 1000000);
    p.o = p.g + (sim_ps)random_below(r, 10000000);
    p.L = p.o + (sim_ps)random_below(r, 10000000);
    p.tf = 1 + (sim_ps)random_below(r, 50000);
    return p;
}

/* one(b) = 2 o + (b-1) G + L */
static sim_ps one(const struct loggp *p, int64_t b) { return 2 * p->o + (b - 1) * p->G + p->L; }

static sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

/* symmetric exchange: b1 to one side first, b2 to the other, receive and work w flops, receive and
 * work w */
static sim_ps two(const struct loggp *p, int64_t b1, int64_t b2, int64_t w)
{
    sim_ps a1 = p->o + (b1 - 1) * p->G + p->L;
    sim_ps a2 = later(2 * p->o, p->o + (b1 - 1) * p->G + p->g) + (b2 - 1) * p->G + p->L;
    sim_ps r1 = later(2 * p->o, a1) + p->o + w * p->tf;
    return later(r1, a2) + p->o + w * p->tf;
}

static void a_scan_takes_lg_messages_and_combinations(void **state)
{
    (void)state;
    struct random r = random_make(1, 0, 0);
    for (int trial = 0; trial < 40; trial++) {
        struct loggp p = random_parameters(&r);
        for (int lg = 1; lg <= 6; lg++) {
            struct row w;
            struct machine_spec m = crossbar(&p, 1 << lg);
            row_make(&w, &m, &p, 1 << lg);
            for (int j = 0; j < lg; j++) {
                for (int i = 0; i < w.nrank; i++) row_send(&w, i, i + (1 << j), 0, 48);
                for (int i = 1 << j; i < w.nrank; i++) {
                    row_receive(&w, i, i - (1 << j), 0);
                    w.clock[i] += (42 + 6) * p.tf;
                }
            }
            assert_int_equal(row_time(&w), lg * (one(&p, 48) + (42 + 6) * p.tf));
            row_end(&w);
        }
    }
}

static void parallel_cyclic_reduction_takes_its_closed_form(void **state)
{
    (void)state;
    /* conventional form: the same bytes both ways, the same work per side */
    enum { BYTES = 8 * (75 + 5), WORK = 700 };
    struct random r = random_make(2, 0, 0);
    for (int trial = 0; trial < 40; trial++) {
        struct loggp p = random_parameters(&r);
        for (int lg = 2; lg <= 6; lg++) {
            struct row w;
            struct machine_spec m = crossbar(&p, 1 << lg);
            row_make(&w, &m, &p, 1 << lg);
            for (int j = 0; j < lg; j++) {
                int d = 1 << j;
                for (int i = 0; i < w.nrank; i++) {
                    row_send(&w, i, i + d, 0, BYTES);
                    row_send(&w, i, i - d, 1, BYTES);
                }
                for (int i = 0; i < w.nrank; i++)
                    for (int side = 0; side < 2; side++) {
                        int from = side == 0 ? i - d : i + d;
                        if (from < 0 || from >= w.nrank) continue;
                        row_receive(&w, i, from, side);
                        w.clock[i] += WORK * p.tf;
                    }
            }
            assert_int_equal(row_time(&w),
                             (lg - 1) * two(&p, BYTES, BYTES, WORK) + one(&p, BYTES) + WORK * p.tf);
            row_end(&w);
        }
    }
}

/* the array recursion: a clock and an interface per node, the latency by the number of hops */
static void random_programs_follow_the_recursion_on_a_torus(void **state)
{
    (void)state;
    enum { NODES = 60, MESSAGES = 3000 };
    struct random r = random_make(3, 0, 0);
    struct loggp p = random_parameters(&r);
    struct machine_spec m = crossbar(&p, NODES);
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_TORUS, .ndim = 3, .dims = {5, 4, 3}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct row w;
    row_make(&w, &m, &p, NODES);
    struct topology *t = topology_create(&m.topology, w.arena, &(struct err){0});
    sim_ps clock[NODES] = {0}, nic[NODES] = {0};
    sim_ps tau = p.L / 3, end = p.L - p.L / 3;
    for (int k = 0; k < MESSAGES; k++) {
        int src = (int)random_below(&r, NODES), dst = (int)random_below(&r, NODES);
        int64_t b = 1 + (int64_t)random_below(&r, 2000), flops = (int64_t)random_below(&r, 3000);
        w.clock[src] += flops * p.tf;
        row_send(&w, src, dst, 0, b);
        row_receive(&w, dst, src, 0);
        clock[src] += flops * p.tf + p.o;
        sim_ps injection = later(clock[src], nic[src]);
        nic[src] = injection + (b - 1) * p.G + p.g;
        sim_ps latency = (topology_distance(t, src, dst) + 1) * tau + end;
        clock[dst] = later(clock[dst], injection + (b - 1) * p.G + latency) + p.o;
    }
    assert_memory_equal(clock, w.clock, sizeof clock);
    row_end(&w);
}

/* ---- ports ---- */

static void only_the_own_port_delays(void **state)
{
    (void)state;
    /* three messages from node 0, three to node 3: the first wait for the port, the others for
     * nothing */
    int src[] = {0, 0, 0, 1, 2}, dst[] = {3, 2, 3, 3, 3};
    int64_t bytes[] = {160, 16, 320, 1600, 1600};
    sim_ps time[] = {5000, 5000, 5000, 0, 0}, arrival[5], uncontended[5];
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){
        .family = TOPOLOGY_MESH, .ndim = 1, .dims = {4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    m.network = (struct network_spec){
        .level = LEVEL_LOGGP, .link_bandwidth = 16e9, .hop_latency = 3e-9, .end_latency = 2e-9,
        .flit_bytes = 16};
    m.software.eager_bytes = -1;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(&m.topology, a, &e);
    struct traffic q = {.nmessage = 5, .src = src, .dst = dst, .bytes = bytes, .time = time};
    struct traffic_result out = {.arrival = arrival, .uncontended = uncontended};
    assert_true(traffic_run(&q, &m, t, a, true, &out, &e));
    assert_int_equal(arrival[0], 5000 + 12000 + 9000 + 2000);
    assert_int_equal(arrival[1], 15000 + 9000 + 2000);
    assert_int_equal(arrival[2], 16000 + 12000 + 19000 + 2000);
    assert_int_equal(arrival[3], 9000 + 99000 + 2000);
    assert_int_equal(arrival[4], 6000 + 99000 + 2000);
    assert_memory_equal(arrival, uncontended, sizeof arrival);
    assert_int_equal(out.link[0].messages, 3);
    assert_int_equal(out.link[0].busy_ps, 31000);
    assert_int_equal(out.link[0].queue_ps, 10000 + 11000);
    arena_destroy(a);
}

struct arrivals {
    int n;
};

static void count_arrival(void *context, struct net_message *m)
{
    (void)m;
    ((struct arrivals *)context)->n++;
}

static void processors_of_a_node_share_its_port(void **state)
{
    (void)state;
    for (int level = LEVEL_LOGGP; level <= LEVEL_LINK; level++) {
        struct machine_spec m = {.name = "test"};
        m.topology = (struct topology_spec){
            .family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {2}, .nodes_per_router = 1,
            .processors_per_node = 2};
        m.network = (struct network_spec){
            .level = (enum network_level)level, .link_bandwidth = 1e9, .hop_latency = 3e-9,
            .end_latency = 2e-9};
        m.software.eager_bytes = -1;
        struct arena *a = arena_create();
        struct sim *s = sim_create();
        struct err e;
        struct arrivals seen = {0};
        err_clear(&e);
        struct topology *t = topology_create(&m.topology, a, &e);
        struct net *n = net_create(&m, t, s, a, count_arrival, &seen, false, &e);
        assert_non_null(n);
        /* handed over out of order: processor 1 has run ahead; its two messages are its own
         * affair */
        struct net_message x[] = {
            {.src = 0, .dst = 1, .processor = 1, .bytes = 10, .id = 0, .ready = 4000},
            {.src = 0, .dst = 1, .processor = 1, .bytes = 10, .id = 1, .ready = 5000},
            {.src = 0, .dst = 1, .processor = 0, .bytes = 20, .id = 2, .ready = 1000}};
        for (int i = 0; i < 3; i++) net_send(n, &x[i]);
        while (sim_step(s)) continue;
        assert_int_equal(seen.n, 3);
        assert_int_equal(x[2].injected, 1000);
        assert_int_equal(x[0].injected, 21000);
        assert_int_equal(x[1].injected, 31000);
        for (int i = 0; i < 3; i++)
            assert_int_equal(x[i].arrival, x[i].injected + 3000 + (x[i].bytes - 1) * 1000 + 2000);
        assert_int_equal(x[2].uncontended, x[2].arrival);
        assert_int_equal(x[0].uncontended, 4000 + 3000 + 9000 + 2000);
        assert_int_equal(x[1].uncontended, 14000 + 3000 + 9000 + 2000);
        sim_destroy(s);
        arena_destroy(a);
    }
}

static void starts_in_order_need_no_events(void **state)
{
    (void)state;
    for (int level = LEVEL_LOGGP; level <= LEVEL_LINK; level++)
        for (int in_order = 0; in_order < 2; in_order++) {
            struct loggp p = {.o = 1000, .g = 500, .G = 10, .L = 3000};
            struct machine_spec m = crossbar(&p, 4);
            m.network.level = (enum network_level)level;
            m.software.eager_bytes = 4096;
            struct arena *a = arena_create();
            struct sim *s = sim_create();
            struct err e;
            struct arrivals seen = {0};
            err_clear(&e);
            struct topology *t = topology_create(&m.topology, a, &e);
            struct net *n = net_create(&m, t, s, a, count_arrival, &seen, false, &e);
            assert_non_null(n);
            net_set_in_order(n, in_order);
            struct net_message x[] = {{.src = 0, .dst = 1, .bytes = 51, .id = 0, .ready = 2000},
                                      {.src = 0, .dst = 2, .bytes = 51, .id = 1, .ready = 2100}};
            for (int i = 0; i < 2; i++) net_send(n, &x[i]);
            assert_int_equal(seen.n, in_order && level == LEVEL_LOGGP ? 2 : 0);
            while (sim_step(s)) continue;
            assert_int_equal(seen.n, 2);
            assert_int_equal(x[0].arrival, 2000 + 500 + 3000);
            assert_int_equal(x[1].arrival, 2000 + 500 + 500 + 500 + 3000);
            assert_int_equal(sim_events(s), (in_order ? 0 : 2) + (level == LEVEL_LINK ? 2 : 0));
            sim_destroy(s);
            arena_destroy(a);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scan_takes_lg_messages_and_combinations),
        cmocka_unit_test(parallel_cyclic_reduction_takes_its_closed_form),
        cmocka_unit_test(random_programs_follow_the_recursion_on_a_torus),
        cmocka_unit_test(only_the_own_port_delays),
        cmocka_unit_test(processors_of_a_node_share_its_port),
        cmocka_unit_test(starts_in_order_need_no_events),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
