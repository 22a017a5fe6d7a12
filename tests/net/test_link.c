/* test_link.c - message-level contention: hand-derived cases, bounds against the reference router,
 * accounts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/arena.h"
#include "base/random.h"
#include "net/traffic.h"
#include "study/netcheck_case.h"

#include "reference.h"

static const bool levels[LEVELS] = {[LEVEL_LOGGP] = true, [LEVEL_LINK] = true};

static void hand_cases_without_blocking_are_exact(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    int exact = 0, blocked = 0;
    ask(&n, levels, DATA "hand_cases.json", "cut-through", a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *x = &n.row[i].answer[LEVEL_LINK];
        assert_true(x->ran);
        if (strchr("CDKL", n.row[i].name[0])) { /* heads of lines block others there, which this
                                                   level leaves out */
            blocked++;
            assert_true(x->error <= 0);
            continue;
        }
        exact++;
        if (x->differing > 0) fail_msg("%s differs", n.row[i].name);
    }
    assert_int_equal(exact, 9);
    assert_int_equal(blocked, 4);
    arena_destroy(a);
}

/* bounds on mean and worst |error| as measured on an independent prototype over more cases */
static void steps_are_bounded_by_reference_and_loggp(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    ask(&n, levels, DATA "makespan.json", NULL, a);
    assert_int_equal(n.nrow, 800);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *link = &n.row[i].answer[LEVEL_LINK],
                                     *loggp = &n.row[i].answer[LEVEL_LOGGP];
        if (link->error > 0.005) fail_msg("%s: %g above the reference", n.row[i].name, link->error);
        if (link->found < loggp->found)
            fail_msg("%s: below the level without contention", n.row[i].name);
    }
    static const struct {
        const char *group;
        double mean, worst;
    } bound[] = {{"mesh vc=1 B=5", 0.12, 0.84},   {"mesh vc=1 B=16", 0.08, 0.79},
                 {"mesh vc=1 B=64", 0.014, 0.30}, {"torus vc=2 B=5", 0.15, 0.73},
                 {"torus vc=2 B=16", 0.12, 0.70}, {"torus vc=2 B=64", 0.08, 0.35},
                 {"hcube vc=1 B=16", 0, 0}};
    for (size_t i = 0; i < sizeof bound / sizeof *bound; i++) {
        struct netcheck_total t = netcheck_total(&n, bound[i].group, LEVEL_LINK);
        struct netcheck_total none = netcheck_total(&n, bound[i].group, LEVEL_LOGGP);
        assert_true(t.cases >= 56);
        assert_true(t.mean <= bound[i].mean && -t.worst <= bound[i].worst);
        assert_true(t.mean <= none.mean / 1.4);
    }
    arena_destroy(a);
}

static void collectives_come_out_between(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    ask(&n, levels, DATA "collectives.json", NULL, a);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *link = &n.row[i].answer[LEVEL_LINK],
                                     *loggp = &n.row[i].answer[LEVEL_LOGGP];
        assert_true(link->found >= loggp->found - 1e-9);
        assert_true(link->error > -0.31 && link->error < 0.03);
    }
    assert_true(netcheck_total(&n, "hcube vc=1 B=32", LEVEL_LINK).mean < 0.002);
    arena_destroy(a);
}

/* ---- random traffic, made here ---- */

struct sample {
    int src[2000], dst[2000];
    int64_t bytes[2000];
    sim_ps time[2000], arrival[2000], injected[2000], uncontended[2000];
    struct traffic_result out;
};

static void replay(struct sample *x, const char *topology, enum network_level level, int count,
                   sim_ps span, struct arena *a, struct topology **t)
{
    struct topology_spec *s = TAKE(a, 1, struct topology_spec);
    struct machine_spec *m = TAKE(a, 1, struct machine_spec);
    struct random r = random_make(5, (uint64_t)count, 0);
    struct err e;
    err_clear(&e);
    assert_true(netcheck_topology(topology, 0, s, &e));
    *m = netcheck_machine(s, 2, 64, 0, 3);
    m->network.level = level;
    *t = topology_create(&m->topology, a, &e);
    assert_non_null(*t);
    for (int i = 0; i < count; i++) {
        x->src[i] = (int)random_below(&r, (uint64_t)(*t)->nnode);
        x->dst[i] = (int)random_below(&r, (uint64_t)(*t)->nnode);
        x->bytes[i] = 16 * (1 + (int64_t)random_below(&r, 40));
        x->time[i] = (sim_ps)random_below(&r, (uint64_t)span) * 1000;
    }
    struct traffic q = {
        .nmessage = count, .src = x->src, .dst = x->dst, .bytes = x->bytes, .time = x->time};
    x->out = (struct traffic_result){
        .arrival = x->arrival, .injected = x->injected, .uncontended = x->uncontended};
    if (!traffic_run(&q, m, *t, a, true, &x->out, &e)) fail_msg("%s", e.text);
    assert_int_equal(x->out.arrived, count);
}

static void uncontended_is_what_loggp_says(void **state)
{
    (void)state;
    static const char *const topologies[] = {"torus4x4x8", "mesh8x8", "hcube7", "fattree_k4_n3",
                                             "dragonfly_p2a4h2"};
    struct sample *link = calloc(1, sizeof *link), *loggp = calloc(1, sizeof *loggp);
    for (size_t i = 0; i < sizeof topologies / sizeof *topologies; i++) {
        struct arena *a = arena_create();
        struct topology *t;
        int delayed = 0;
        replay(link, topologies[i], LEVEL_LINK, 2000, 2000, a, &t);
        replay(loggp, topologies[i], LEVEL_LOGGP, 2000, 2000, a, &t);
        assert_memory_equal(link->uncontended, loggp->arrival, sizeof link->arrival);
        assert_memory_equal(link->injected, loggp->injected, sizeof link->injected);
        for (int m = 0; m < 2000; m++) {
            assert_true(link->arrival[m] >= link->uncontended[m]);
            delayed += link->arrival[m] > link->uncontended[m];
        }
        assert_true(delayed > 200);
        arena_destroy(a);
    }
    free(link);
    free(loggp);
}

static void loads_are_those_of_the_routes(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct sample *x = calloc(1, sizeof *x);
    struct topology *t;
    struct hop route[16];
    replay(x, "torus4x4x8", LEVEL_LINK, 2000, 4000, a, &t);
    assert_int_equal(x->out.nlink, 2 * t->nnode + t->nlink);
    int64_t *bytes = TAKE(a, t->nlink, int64_t), waited = 0, late = 0;
    for (int m = 0; m < 2000; m++) {
        int n = topology_route(t, x->src[m], x->dst[m], 0, route);
        for (int i = 0; i < n; i++) bytes[route[i].link] += x->bytes[m];
        late += x->arrival[m] - x->uncontended[m] + x->injected[m] - x->time[m];
    }
    for (int i = 0; i < x->out.nlink; i++) {
        const struct link_load *l = &x->out.link[i];
        waited += l->queue_ps;
        assert_int_equal(l->busy_ps, l->bytes / 16 * 1000);
        if (i < t->nnode || i >= t->nnode + t->nlink) {
            assert_int_equal(l->node, i % (t->nnode + t->nlink));
            continue;
        }
        int from, to, port;
        topology_link_ends(t, i - t->nnode, &from, &to, &port);
        assert_int_equal(l->bytes, bytes[i - t->nnode]);
        assert_int_equal(l->from, from);
        assert_int_equal(l->to, to);
    }
    assert_int_equal(waited, late); /* every wait is somebody's delay, and the other way round */
    free(x);
    arena_destroy(a);
}

static void the_same_traffic_gives_the_same_digest(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct sample *x = calloc(1, sizeof *x), *y = calloc(1, sizeof *y);
    struct topology *t;
    replay(x, "mesh8x8", LEVEL_LINK, 1500, 500, a, &t);
    replay(y, "mesh8x8", LEVEL_LINK, 1500, 500, a, &t);
    assert_true(x->out.digest == y->out.digest);
    assert_memory_equal(x->arrival, y->arrival, sizeof x->arrival);
    replay(y, "mesh8x8", LEVEL_LINK, 1499, 500, a, &t);
    assert_true(x->out.digest != y->out.digest);
    free(x);
    free(y);
    arena_destroy(a);
}

static void a_message_costs_an_event_per_link_and_two(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct sample *x = calloc(1, sizeof *x);
    struct topology *t;
    int64_t links = 0;
    replay(x, "torus4x4x8", LEVEL_LINK, 2000, 4000, a, &t);
    for (int m = 0; m < 2000; m++) links += topology_distance(t, x->src[m], x->dst[m]);
    /* the start is the replay's, the last the ejection port's */
    assert_int_equal(x->out.events, links + 2 * 2000);
    free(x);
    arena_destroy(a);
}

/* ---- particulars ---- */

static void replay_list(const struct topology_spec *s, enum network_level level, struct traffic *q,
                        sim_ps *arrival, struct machine_spec *m)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    m->topology = *s;
    m->network.level = level;
    struct topology *t = topology_create(&m->topology, a, &e);
    struct traffic_result out = {.arrival = arrival};
    if (!t || !traffic_run(q, m, t, a, false, &out, &e)) fail_msg("%s", e.text);
    arena_destroy(a);
}

static void transactions_of_a_bus_follow_one_another(void **state)
{
    (void)state;
    enum { N = 6, BYTES = 320 };
    int src[N], dst[N];
    int64_t bytes[N];
    sim_ps time[N] = {0}, arrival[N];
    struct topology_spec s = {
        .family = TOPOLOGY_BUS, .ndim = 1, .dims = {N}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct machine_spec m = netcheck_machine(&s, 1, 64, 0, 0);
    m.network.end_latency = 0;
    for (int i = 0; i < N; i++) {
        src[i] = i;
        dst[i] = (i * 5 + 1) % N;
        bytes[i] = BYTES;
    }
    struct traffic q = {.nmessage = N, .src = src, .dst = dst, .bytes = bytes, .time = time};
    for (int level = LEVEL_LOGGP; level <= LEVEL_AUTO; level++) {
        replay_list(&s, (enum network_level)level, &q, arrival, &m);
        for (int i = 0; i < N; i++) assert_int_equal(arrival[i], (i + 1) * 20 * 1000 - 1000);
    }
}

static void a_slow_dimension_holds_its_links_longer(void **state)
{
    (void)state;
    int src[] = {0, 1}, dst[] = {13, 13}; /* on 4 x 4: both go up column 1 */
    int64_t bytes[] = {320, 320};
    sim_ps time[] = {0, 0}, arrival[2];
    struct topology_spec s = {.family = TOPOLOGY_MESH,
                              .ndim = 2,
                              .dims = {4, 4},
                              .dim_bandwidth = {0, 4e9},
                              .nodes_per_router = 1,
                              .processors_per_node = 1};
    struct machine_spec m = netcheck_machine(&s, 1, 64, 0, 3);
    struct traffic q = {.nmessage = 2, .src = src, .dst = dst, .bytes = bytes, .time = time};
    replay_list(&s, LEVEL_LINK, &q, arrival, &m);
    /* 20 flits, one in 4 cycles */
    assert_int_equal(arrival[1], (4 * 3 + 19 * 4 + 2) * 1000);
    /* from when the first frees the column */
    assert_int_equal(arrival[0], (3 + 80 + 3 * 3 + 19 * 4 + 2) * 1000);
}

/* Others' messages, one every `period` on each link, asked for or as events. */
struct others {
    struct net *net;
    struct sim *sim;
    sim_ps next[256], period, busy;
    int left;
};

static sim_ps others_before(void *context, int link, sim_ps now, sim_ps free)
{
    struct others *o = context;
    for (; o->next[link] <= now; o->next[link] += o->period)
        free = (o->next[link] > free ? o->next[link] : free) + o->busy;
    return free;
}

static void others_pass(void *subject, uint64_t link, sim_ps now)
{
    struct others *o = subject;
    if (o->left == 0) return;
    assert_true(net_occupy(o->net, (int)link, now, o->busy));
    sim_at(o->sim, now + o->period, NET_LANE_START - 1, link, others_pass, o, link);
}

static void one_less(void *context, struct net_message *m)
{
    (void)m;
    ((struct others *)context)->left--;
}

static void send_now(void *subject, uint64_t argument, sim_ps now)
{
    (void)now;
    net_send(subject, (struct net_message *)(uintptr_t)argument);
}

enum { SHARED_MESSAGES = 400, ALONE = 0, EVENTS, ASKED };

static void post_messages(struct others *o, struct net_message *message)
{
    for (int i = 0; i < SHARED_MESSAGES; i++) {
        struct net_message *x = &message[i];
        *x = (struct net_message){
            .id = i, .src = i % 16, .dst = (i * 7 + 3) % 16, .bytes = 16 * (1 + i % 20)};
        x->ready = 1000 * (i % 7 + 4 * i);
        if (x->dst == x->src) x->dst = (x->src + 5) % 16;
        sim_at(o->sim, x->ready, NET_LANE_START, (uint64_t)i, send_now, o->net, (uintptr_t)x);
    }
}

static int64_t replay_shared(int how, sim_ps *arrival)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct topology_spec s = {
        .family = TOPOLOGY_TORUS, .ndim = 2, .dims = {4, 4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct machine_spec m = netcheck_machine(&s, 1, 64, 0, 3);
    struct others o = {
        .sim = sim_create(), .period = 40000, .busy = 13000, .left = SHARED_MESSAGES};
    m.network.level = LEVEL_LINK;
    struct topology *t = topology_create(&m.topology, a, &e);
    o.net = t ? net_create(&m, t, o.sim, a, one_less, &o, false, &e) : NULL;
    if (!o.net) fail_msg("%s", e.text);
    assert_true(t->nlink <= 256);
    /* All times are whole cycles, so that many heads come at the instant of another's message. */
    for (int i = 0; how != ALONE && i < t->nlink; i++) {
        o.next[i] = 1000 * (i % 37);
        if (how == EVENTS)
            sim_at(o.sim, o.next[i], NET_LANE_START - 1, (uint64_t)i, others_pass, &o, (uint64_t)i);
    }
    if (how == ASKED) assert_true(net_ask_others(o.net, others_before, &o));
    struct net_message *message = TAKE(a, SHARED_MESSAGES, struct net_message);
    post_messages(&o, message);
    while (o.left > 0) assert_true(sim_step(o.sim));
    for (int i = 0; i < SHARED_MESSAGES; i++) arrival[i] = message[i].arrival;
    int64_t events = sim_events(o.sim);
    sim_destroy(o.sim);
    arena_destroy(a);
    return events;
}

static void others_asked_for_delay_as_their_events_do(void **state)
{
    (void)state;
    sim_ps alone[SHARED_MESSAGES], events[SHARED_MESSAGES], asked[SHARED_MESSAGES];
    int delayed = 0;
    const int64_t quiet = replay_shared(ALONE, alone);
    assert_true(replay_shared(EVENTS, events) > quiet);
    assert_int_equal(replay_shared(ASKED, asked), quiet);
    for (int i = 0; i < SHARED_MESSAGES; i++) {
        assert_int_equal(asked[i], events[i]);
        delayed += asked[i] > alone[i];
    }
    assert_true(delayed > SHARED_MESSAGES / 4);
}

static void wrong_lists_are_refused(void **state)
{
    (void)state;
    int node[] = {0, 1}, beyond[] = {0, 9}, first[] = {0, 1, 2}, self[] = {1, 1},
        missing[] = {1, 7};
    int64_t bytes[] = {16, 16}, negative[] = {16, -1};
    sim_ps time[] = {0, 0};
    struct topology_spec s = {
        .family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct machine_spec m = netcheck_machine(&s, 1, 64, 0, 3);
    struct traffic bad[] = {
        {.nmessage = 2, .src = node, .dst = beyond, .bytes = bytes, .time = time},
        {.nmessage = 2, .src = node, .dst = node, .bytes = negative, .time = time},
        {.nmessage = 2,
         .src = node,
         .dst = node,
         .bytes = bytes,
         .time = time,
         .delay = time,
         .dep_first = first,
         .dep = self},
        {.nmessage = 2,
         .src = node,
         .dst = node,
         .bytes = bytes,
         .time = time,
         .delay = time,
         .dep_first = first,
         .dep = missing},
    };
    struct arena *a = arena_create();
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err e;
        struct traffic_result out = {0};
        err_clear(&e);
        struct topology *t = topology_create(&m.topology, a, &e);
        assert_false(traffic_run(&bad[i], &m, t, a, false, &out, &e));
        assert_int_equal(e.kind, ERR_DATA);
    }
    arena_destroy(a);
}

static void messages_that_wait_for_each_other_are_reported(void **state)
{
    (void)state;
    int src[] = {0, 1, 2}, dst[] = {1, 2, 0}, first[] = {0, 0, 1, 2}, dep[] = {2, 1};
    int64_t bytes[] = {16, 16, 16};
    sim_ps zero[] = {0, 0, 0}, arrival[3];
    struct topology_spec s = {
        .family = TOPOLOGY_CROSSBAR, .ndim = 1, .dims = {4}, .nodes_per_router = 1,
        .processors_per_node = 1};
    struct machine_spec m = netcheck_machine(&s, 1, 64, 0, 3);
    struct traffic q = {.nmessage = 3, .src = src, .dst = dst, .bytes = bytes,
                        .time = zero, .delay = zero, .dep_first = first, .dep = dep};
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(&m.topology, a, &e);
    struct traffic_result out = {.arrival = arrival};
    assert_true(traffic_run(&q, &m, t, a, false, &out, &e));
    assert_true(out.deadlock);
    assert_int_equal(out.arrived, 1);
    assert_true(arrival[2] == SIM_NEVER && arrival[0] == 3000 + 2000);
    assert_true(strlen(out.text) > 0);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hand_cases_without_blocking_are_exact),
        cmocka_unit_test(steps_are_bounded_by_reference_and_loggp),
        cmocka_unit_test(collectives_come_out_between),
        cmocka_unit_test(uncontended_is_what_loggp_says),
        cmocka_unit_test(loads_are_those_of_the_routes),
        cmocka_unit_test(the_same_traffic_gives_the_same_digest),
        cmocka_unit_test(a_message_costs_an_event_per_link_and_two),
        cmocka_unit_test(transactions_of_a_bus_follow_one_another),
        cmocka_unit_test(a_slow_dimension_holds_its_links_longer),
        cmocka_unit_test(others_asked_for_delay_as_their_events_do),
        cmocka_unit_test(wrong_lists_are_refused),
        cmocka_unit_test(messages_that_wait_for_each_other_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
