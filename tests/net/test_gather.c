/* test_gather.c - one event for all of an instant gives the times of an event for everything, and
 * so do lists that are played in cycles: random networks, rules, routers, loads, sizes and times,
 * every result bit for bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/digest.h"
#include "base/random.h"
#include "net/traffic.h"
#include "study/netcheck_case.h"

#include "play.h"

/* A small network of any family that routing rules know. */
static struct topology_spec draw_network(struct random *r)
{
    struct topology_spec s = {.nodes_per_router = 1, .processors_per_node = 1, .tie = TIE_RANDOM};
    switch (below(r, 7)) {
    case 0:
        s.family = TOPOLOGY_MESH;
        s.ndim = 2;
        s.dims[0] = 2 + below(r, 5);
        s.dims[1] = 2 + below(r, 4);
        break;
    case 1:
        s.family = TOPOLOGY_TORUS;
        s.ndim = 2 + below(r, 2);
        for (int d = 0; d < s.ndim; d++) s.dims[d] = 2 + below(r, 4);
        break;
    case 2:
        s.family = TOPOLOGY_HYPERCUBE;
        s.ndim = 1;
        s.dims[0] = 2 + below(r, 3);
        break;
    case 3:
        s.family = TOPOLOGY_HYPERX;
        s.ndim = 2;
        s.dims[0] = 2 + below(r, 3);
        s.dims[1] = 2 + below(r, 3);
        s.nodes_per_router = 1 + below(r, 4);
        break;
    case 4:
        s.family = TOPOLOGY_FAT_TREE;
        s.ndim = 2;
        s.dims[0] = 2 + below(r, 2);
        s.dims[1] = 2 + below(r, 2);
        break;
    case 5:
        s.family = TOPOLOGY_DRAGONFLY;
        s.ndim = 4;
        s.dims[0] = 1 + below(r, 2);
        s.dims[1] = 4;
        s.dims[2] = 2;
        break;
    default:
        s.family = TOPOLOGY_RANDOM_REGULAR;
        s.ndim = 2;
        s.dims[0] = 12;
        s.dims[1] = 3;
        s.seed = random_below(r, 99);
    }
    return s;
}

/* Cables of no length, of whole cycles, of other lengths; some longer than the wheel of instants.
 */
static void draw_cables(struct random *r, struct topology_spec *s)
{
    static const double length[] = {1e-9, 9e-9, 99e-9, 300e-9, 2.5e-9, 0.7e-9};
    if (below(r, 4) == 0) {
        const double rate = below(r, 2) ? 8e9 : 5e9;
        s->dim_bandwidth[below(r, 2)] = rate;
    }
    if (below(r, 2)) return;
    for (int d = 0; d < s->ndim && d < 2; d++) s->dim_latency[d] = length[below(r, 6)];
}

static struct machine_spec draw_machine(struct random *r, const struct topology_spec *s)
{
    static const int buffer[] = {8, 16, 64, 256};
    /* One draw after the other: compilers differ in the order of arguments. */
    const int stages = 3 + below(r, 3), flits = below(r, 2) ? 4 : 0, places = buffer[below(r, 4)];
    struct machine_spec m = netcheck_machine(s, 1 + below(r, 8), places, flits, stages);
    m.network.routing = (enum routing_rule)below(r, ROUTING_RULES);
    m.network.level = below(r, 2) ? LEVEL_FLIT : LEVEL_PACKET;
    m.network.vc_allocator = below(r, 2) ? ALLOCATOR_ISLIP : ALLOCATOR_SELECT;
    m.network.allocator_iterations = 1 + 2 * below(r, 2);
    /* Credits and ends at once, so that much happens again at the same instant. */
    if (below(r, 6) == 0) m.network.credit_latency = 0;
    if (below(r, 6) == 0) m.network.end_latency = 0;
    if (below(r, 6) == 0) m.network.hop_latency = 5.5e-9;
    return m;
}

/* A list of messages; times on the cycle, or anywhere; some wait for others. */
static void draw_list(struct random *r, int nnode, struct arena *a, struct traffic *q)
{
    const int n = 40 + below(r, 400), span = 1 << (4 + below(r, 12)),
              cycle = below(r, 4) ? 1000 : 1;
    const bool waits = below(r, 3) == 0;
    const int longest = 1 + below(r, 20);
    *q = list_of(n, a);
    if (waits) q->dep_first = TAKE(a, n + 1, int);
    q->dep = TAKE(a, n, int);
    int ndep = 0;
    for (int m = 0; m < n; m++) {
        q->src[m] = below(r, nnode);
        q->dst[m] = below(r, nnode);
        q->bytes[m] = 16 * below(r, longest + 1);
        q->time[m] = (sim_ps)below(r, span) * 1000 / cycle * cycle;
        if (cycle == 1) q->time[m] += below(r, 7);
        q->delay[m] = (sim_ps)below(r, 30) * 500;
        if (!waits) continue;
        q->dep_first[m] = ndep;
        if (m > 0 && below(r, 2)) q->dep[ndep++] = below(r, m);
        q->dep_first[m + 1] = ndep;
    }
    if (below(r, 4) == 0) q->stop = (sim_ps)span * 500;
}

/* A machine of any network, and a list of messages for it. */
struct drawn {
    struct machine_spec machine;
    struct traffic list;
};

static struct drawn draw(struct random *r, struct arena *a)
{
    struct drawn d;
    struct topology_spec s = draw_network(r);
    struct err e;
    err_clear(&e);
    draw_cables(r, &s);
    d.machine = draw_machine(r, &s);
    const struct topology *t = topology_create(&d.machine.topology, a, &e);
    assert_non_null(t);
    draw_list(r, t->nnode, a, &d.list);
    return d;
}

static void same(const struct traffic_result *x, const struct traffic_result *y, int n, int trial)
{
    for (int m = 0; m < n; m++)
        if (x->arrival[m] != y->arrival[m] || x->uncontended[m] != y->uncontended[m])
            fail_msg("trial %d, message %d of %d: %lld and %lld", trial, m, n,
                     (long long)x->arrival[m], (long long)y->arrival[m]);
    assert_memory_equal(x->arrival, y->arrival, (size_t)n * sizeof *x->arrival);
    assert_memory_equal(x->uncontended, y->uncontended, (size_t)n * sizeof *x->arrival);
    assert_int_equal(x->makespan, y->makespan);
    assert_int_equal(x->arrived, y->arrived);
    assert_int_equal(x->deadlock, y->deadlock);
    assert_string_equal(x->text, y->text);
    assert_int_equal(x->nlink, y->nlink);
    assert_memory_equal(x->link, y->link, (size_t)x->nlink * sizeof *x->link);
}

/* All times, in one number: what both ways of playing have in common, as how a lane moves on that
 * is alone at its router, cannot be seen by comparing them. */
static const uint64_t TIMES = 0xebb56516815ececd;

static uint64_t times_mix(uint64_t digest, const struct traffic_result *x, int n)
{
    for (int m = 0; m < n; m++)
        digest = digest_mix(digest_mix(digest, (uint64_t)x->arrival[m]), (uint64_t)x->injected[m]);
    return digest;
}

static void gathered_and_single_events_give_the_same(void **state)
{
    (void)state;
    enum { TRIALS = 800 };
    struct random r = random_make(5, 6, 7);
    int played = 0, fewer = 0, locked = 0, clocked = 0;
    uint64_t times = DIGEST_START;
    for (int trial = 0; trial < TRIALS; trial++) {
        struct arena *a = arena_create();
        const struct drawn d = draw(&r, a);
        const int n = d.list.nmessage;
        struct traffic_result x, y;
        struct err e;
        err_clear(&e);
        /* Rules for other families, buffers that are too small: the same refusal. */
        if (play(&d.machine, &d.list, true, a, &x, &e)) {
            assert_true(play(&d.machine, &d.list, false, a, &y, &e));
            same(&x, &y, n, trial);
            if (trial % 4 == 0) play_in_cycles(&d.machine, &d.list, a, &x, trial, &clocked);
            times = times_mix(times, &x, n);
            played++;
            fewer += y.events < x.events;
            locked += x.deadlock;
        }
        arena_destroy(a);
    }
    print_message("%d lists played, %d with fewer events, %d in cycles, %d to a deadlock\n", played,
                  fewer, clocked, locked);
    assert_true(played > TRIALS / 4 && fewer > played / 3);
    assert_int_equal(times, TIMES);
}

/* A list by single and by gathered events. */
static void both_agree(const struct machine_spec *m, const struct traffic *q, int trial,
                       struct arena *a)
{
    struct traffic_result x, y;
    struct err e;
    err_clear(&e);
    assert_true(play(m, q, true, a, &x, &e) && play(m, q, false, a, &y, &e));
    same(&x, &y, q->nmessage, trial);
}

/* The list that is drawn from `trial` for the nodes of m, both ways. */
static void lists_agree(const struct machine_spec *m, int nnode, int trial)
{
    struct arena *a = arena_create();
    struct random r = random_make((uint64_t)trial, 0, 0);
    struct traffic q;
    draw_list(&r, nnode, a, &q);
    both_agree(m, &q, trial, a);
    arena_destroy(a);
}

/* A sender that waits for places learns of them when they are given away, not when it happens to
 * look: on this network one of some hundred lists showed the difference. */
static void places_are_found_without_a_look_by_chance(void **state)
{
    (void)state;
    const struct topology_spec s = {.family = TOPOLOGY_HYPERCUBE,
                                    .ndim = 1,
                                    .dims = {2},
                                    .nodes_per_router = 1,
                                    .processors_per_node = 1};
    struct machine_spec m = netcheck_machine(&s, 2, 8, 4, 4);
    m.network.routing = ROUTING_VALIANT;
    m.network.level = LEVEL_PACKET;
    for (int trial = 100; trial < 150; trial++) lists_agree(&m, 4, trial);
}

/* Links of two rates, heads with several ways on: a lane that has sent its packet does not ask for
 * the head behind it, so that no look comes early for that alone. Seven of these lists showed the
 * difference. */
static void a_head_that_did_not_ask_has_no_second_look(void **state)
{
    (void)state;
    struct topology_spec s = square(TOPOLOGY_TORUS, 3);
    s.dims[1] = 2;
    s.dim_bandwidth[1] = 5e9;
    struct machine_spec m = netcheck_machine(&s, 4, 64, 4, 3);
    m.network.routing = ROUTING_BOOKSIM_MIN_ADAPT;
    m.network.level = LEVEL_PACKET;
    m.network.allocator_iterations = 1;
    for (int trial = 25; trial < 165; trial++) lists_agree(&m, 6, trial);
}

/* Who asked or bid and lost comes back a flit later, also where another lane has the router looked
 * at a second time in the same instant. These lists showed the difference. */
static void who_lost_does_not_try_again_in_the_same_instant(void **state)
{
    (void)state;
    static const int trial[] = {383, 518, 686};
    const struct topology_spec s = square(TOPOLOGY_TORUS, 2);
    struct machine_spec m = netcheck_machine(&s, 4, 8, 0, 3);
    m.network.routing = ROUTING_BOOKSIM_DIM_ORDER;
    m.network.level = LEVEL_PACKET;
    m.network.vc_allocator = ALLOCATOR_ISLIP;
    m.network.allocator_iterations = 3;
    for (int i = 0; i < 3; i++) lists_agree(&m, 4, trial[i]);
}

/* Nor a picosecond later, when somebody else of another clock has the router looked at. This list
 * showed the difference. */
static void who_lost_does_not_try_again_within_a_flit(void **state)
{
    (void)state;
    const struct topology_spec s = square(TOPOLOGY_TORUS, 2);
    struct machine_spec m = netcheck_machine(&s, 4, 8, 0, 3);
    m.network.hop_latency = 4e-9;
    m.network.routing = ROUTING_BOOKSIM_DIM_ORDER;
    m.network.level = LEVEL_PACKET;
    m.network.allocator_iterations = 1;
    lists_agree(&m, 4, 1388);
}

/* Credits that are back at once: who sends at the instant in which a place becomes free depends on
 * which router is looked at first. These lists, of some 26,000, showed the difference. */
static void looks_have_one_order_when_credits_are_back_at_once(void **state)
{
    (void)state;
    static const int trial[] = {62880, 65414, 164791, 322792, 359002, 371012};
    for (size_t i = 0; i < sizeof trial / sizeof *trial; i++) {
        struct random r = random_make(77, (uint64_t)trial[i], 7);
        struct arena *a = arena_create();
        const struct drawn d = draw(&r, a);
        assert_true(d.machine.network.credit_latency == 0);
        both_agree(&d.machine, &d.list, trial[i], a);
        arena_destroy(a);
    }
}

/* A list of messages of one packet each, which start on whole flits, or, if `fine`, now and then
 * between them. Returns whether machine m can play it: then in cycles as by events. */
static bool packets_agree(const struct machine_spec *m, bool fine, int trial, struct random *r,
                          struct arena *a, int *clocked)
{
    struct err e;
    err_clear(&e);
    const struct topology *t = topology_create(&m->topology, a, &e);
    struct traffic q;
    struct traffic_result x;
    assert_non_null(t);
    draw_list(r, t->nnode, a, &q);
    q.dep_first = NULL;
    const int longest = below(r, 3) ? 1 + below(r, 4) : 16,
              grid = fine && below(r, 3) == 0 ? 10 : 1000;
    for (int i = 0; i < q.nmessage; i++) {
        q.bytes[i] = 16 * (q.bytes[i] / 16 % longest);
        q.time[i] = q.time[i] / grid * grid;
    }
    if (!play(m, &q, true, a, &x, &e)) return false;
    play_in_cycles(m, &q, a, &x, trial, clocked);
    return true;
}

/* Machines and lists that can be played in cycles: links of one rate, times on the cycle, messages
 * of one packet; loads from next to nothing to far beyond saturation. Counts those that are. */
static void list_in_cycles_agrees(int trial, int *played, int *clocked)
{
    static const double cable[] = {1e-9, 9e-9, 99e-9, 300e-9};
    struct random r = random_make((uint64_t)trial, 9, 10);
    struct arena *a = arena_create();
    struct topology_spec s = draw_network(&r);
    for (int d = 0; below(&r, 3) == 0 && d < 2 && d < s.ndim; d++)
        s.dim_latency[d] = cable[below(&r, 4)];
    struct machine_spec m = draw_machine(&r, &s);
    if (m.network.credit_latency < 1e-9 && below(&r, 8)) m.network.credit_latency = 1e-9;
    if (below(&r, 8)) m.network.hop_latency = (3 + below(&r, 4)) * 1e-9;
    m.network.packet_bytes = 0;
    *played += packets_agree(&m, false, trial, &r, a, clocked);
    arena_destroy(a);
}

/* The last ones are those of some 29,000 in which it matters that a lane tries once in a cycle. */
static void lists_in_cycles_agree(void **state)
{
    (void)state;
    enum { TRIALS = 300 };
    static const int once[] = {788,   1139,  1487,  5908,  7798,  7844,  10516, 10744, 11665,
                               11859, 12314, 14468, 15173, 18580, 18654, 20159, 20168, 20792,
                               22921, 23553, 23743, 24046, 24722, 25018, 26898, 28720};
    int played = 0, clocked = 0;
    for (int trial = 0; trial < TRIALS; trial++) list_in_cycles_agrees(trial, &played, &clocked);
    for (size_t i = 0; i < sizeof once / sizeof *once; i++)
        list_in_cycles_agrees(once[i], &played, &clocked);
    print_message("%d lists played, %d in cycles\n", played, clocked);
    assert_true(clocked > played / 2);
}

/* The same where a cycle is shorter than a flit, as hops, credits, cables and starts are not whole
 * flits; routers of up to 256 lanes; heads that are alone in the three rounds of an allocation. */
static void list_on_common_cycle_agrees(int trial, int *played, int *clocked, int *wide)
{
    static const double hop[] = {150e-9, 5.5e-9, 12.34e-9, 40.02e-9, 7.77e-9, 3.3e-9, 17.1e-9},
                        credit[] = {0.5e-9, 1.1e-9, 2.5e-9, 3.02e-9},
                        cable[] = {1e-9, 99e-9, 300e-9, 2.5e-9, 0.7e-9, 0.11e-9};
    struct random r = random_make((uint64_t)trial, 11, 12);
    struct arena *a = arena_create();
    struct topology_spec s = draw_network(&r);
    if (s.nodes_per_router > 1 && below(&r, 3) == 0) s.nodes_per_router *= 1 + below(&r, 6);
    for (int d = 0; below(&r, 3) == 0 && d < 2 && d < s.ndim; d++)
        s.dim_latency[d] = cable[below(&r, 6)];
    struct machine_spec m = draw_machine(&r, &s);
    m.network.hop_latency = hop[below(&r, 7)];
    m.network.credit_latency = credit[below(&r, 4)];
    if (below(&r, 3) == 0) m.network.routing_latency = below(&r, 2) ? 1e-9 : 0.35e-9;
    if (below(&r, 4) == 0) m.software.gap = below(&r, 2) ? 2.5e-9 : 40.2e-9;
    m.network.packet_bytes = 0;
    const int before = *clocked;
    *played += packets_agree(&m, true, trial, &r, a, clocked);
    *wide += *clocked > before && s.nodes_per_router * m.network.virtual_channels > 64;
    arena_destroy(a);
}

static void lists_on_common_cycles_agree(void **state)
{
    (void)state;
    enum { TRIALS = 1500 };
    int played = 0, clocked = 0, wide = 0;
    for (int trial = 0; trial < TRIALS; trial++)
        list_on_common_cycle_agrees(trial, &played, &clocked, &wide);
    print_message("%d lists played, %d in cycles, %d with more than 64 lanes of nodes\n", played,
                  clocked, wide);
    assert_true(clocked > played / 2 && wide > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_are_found_without_a_look_by_chance),
        cmocka_unit_test(a_head_that_did_not_ask_has_no_second_look),
        cmocka_unit_test(who_lost_does_not_try_again_in_the_same_instant),
        cmocka_unit_test(who_lost_does_not_try_again_within_a_flit),
        cmocka_unit_test(gathered_and_single_events_give_the_same),
        cmocka_unit_test(looks_have_one_order_when_credits_are_back_at_once),
        cmocka_unit_test(lists_in_cycles_agree),
        cmocka_unit_test(lists_on_common_cycles_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
