/* test_meeting.c - collectives of the network: times by hand, the same bits as software, and what
 * programs do wrong. */
#include "timed_world.h"

#include <stdint.h>

#include "base/text.h"
#include "comm/collectives.h"
#include "machine/placement.h"
#include "vp/meeting.h"

/* A line of nodes whose network has a tree over its links: 1 us, 50 ns a link, 1 B/ns. */
static struct machine_spec line(int nodes)
{
    struct machine_spec m = crossbar(nodes);
    m.topology.family = TOPOLOGY_MESH;
    text_copy(m.network.collective.kinds, sizeof m.network.collective.kinds,
              "broadcast, reduce, allreduce");
    m.network.collective.operations = OPERATIONS_REAL;
    m.network.collective.latency = 1e-6;
    m.network.collective.hop_latency = 50e-9;
    m.network.collective.bandwidth = 1e9;
    return m;
}

/* ---- how long ---- */

static int links(struct machine_spec *m, int nrank)
{
    struct arena *a = arena_create();
    struct placement p;
    struct err e;
    err_clear(&e);
    const struct topology *t = topology_create(&m->topology, a, &e);
    assert_true(t && placement_create(&p, m, t, nrank, a, &e));
    const int n = meeting_links(m, t, &p);
    arena_destroy(a);
    return n;
}

/* Up to the first rank and down again; over switches the way is that already. */
static void trees_follow_the_network_or_are_its_own(void **state)
{
    (void)state;
    struct machine_spec m = line(8);
    assert_int_equal(links(&m, 8), 14);
    assert_int_equal(links(&m, 5), 8);
    assert_int_equal(links(&m, 1), 0);
    m.topology.family = TOPOLOGY_TORUS; /* a ring of 8: the farthest is 4 away */
    assert_int_equal(links(&m, 8), 8);
    m.topology = (struct topology_spec){.family = TOPOLOGY_FAT_TREE,
                                        .ndim = 2,
                                        .dims = {4, 2},
                                        .nodes_per_router = 1,
                                        .processors_per_node = 1};
    assert_int_equal(links(&m, 16), 2); /* leaf, spine, leaf */
    assert_int_equal(links(&m, 4), 0);  /* all on one switch */
    m = crossbar(9);
    assert_int_equal(links(&m, 9), 0);
    /* 9 nodes are leaves of a tree of 4 levels of 2, 2 of 3 or 4, a chain of 8 links of 1 */
    m.network.collective.radix = 2;
    assert_int_equal(links(&m, 9), 8);
    m.network.collective.radix = 3;
    assert_int_equal(links(&m, 9), 4);
    m.network.collective.radix = 1;
    assert_int_equal(links(&m, 9), 16);
    m.topology.processors_per_node = 3; /* 9 ranks on 3 nodes */
    m.network.collective.radix = 2;
    assert_int_equal(links(&m, 9), 4);
}

/* 1 us + 6 x 50 ns + 800 B at 1 B/ns; without a rate of its own that of a link. */
static void times_by_hand(void **state)
{
    (void)state;
    struct machine_spec m = line(4);
    assert_int_equal(meeting_time(&m.network, 6, 800), US + 300000 + 800000);
    assert_int_equal(meeting_time(&m.network, 0, 0), US);
    m.network.collective.bandwidth = 0;
    m.network.link_bandwidth = 2e9;
    assert_int_equal(meeting_time(&m.network, 6, 800), US + 300000 + 400000);
    m.network.link_bandwidth = 0; /* unlimited */
    assert_int_equal(meeting_time(&m.network, 6, 800), US + 300000);
    /* a diameter of 2^24 links of a second each, and vectors that never end: no sum wraps */
    m.network.collective.hop_latency = 1;
    assert_int_equal(meeting_time(&m.network, 1 << 24, 800), PS_TOO_LONG);
    m.network.link_bandwidth = 1e-6;
    assert_int_equal(meeting_time(&m.network, 1 << 24, INT64_MAX), PS_TOO_LONG);
}

/* ---- values and clocks ---- */

enum { VECTOR = 100, MOST_RANKS = 33 };

struct job {
    enum collective_kind kind;
    int root, repeat;
    const char *algorithm;
    int64_t delay[MOST_RANKS], left[MOST_RANKS];
    double found[MOST_RANKS][VECTOR];
};

/* Neither associative nor commutative: order and side of every operand are seen. */
static void add(void *into, const void *with, bool before, int64_t n, void *context, struct work *w)
{
    double *x = into;
    const double *y = with;
    (void)context;
    for (int64_t i = 0; i < n; i++) x[i] = before ? 1.5 * y[i] + x[i] : 1.5 * x[i] + y[i];
    w->flop += (uint64_t)n;
}

/* Terms of different sizes: each order of adding them has other bits. */
static double term(int rank, int i) { return 1.0 / (3 + 7 * rank + i) + (rank % 3 ? 1e9 : 1e-9); }

static void call(struct comm *c, void *context)
{
    struct job *j = context;
    const struct collective_op op = {.combine = add, .operation = COMM_REAL};
    const int rank = comm_rank(c);
    double send[VECTOR], recv[VECTOR], scratch[2 * VECTOR];
    for (int pass = 0; pass <= j->repeat; pass++) {
        for (int i = 0; i < VECTOR; i++) {
            send[i] = term(rank, i + pass);
            recv[i] = j->kind == COLLECTIVE_BROADCAST && rank == j->root ? send[i] : -1;
        }
        const struct collective_call k = {.kind = j->kind,
                                          .comm = c,
                                          .tag = 5,
                                          .root = j->root,
                                          .count = VECTOR,
                                          .element = 8,
                                          .send = send,
                                          .recv = recv,
                                          .op = &op,
                                          .scratch = scratch};
        const struct collective_algorithm *a = collective_algorithm_find(j->kind, j->algorithm);
        const struct collective_shape s = collective_shape(&k);
        assert_true(collective_applies(a, &s));
        assert_true(collective_scratch(a, &s, rank) <= (int64_t)sizeof scratch);
        comm_elapse(c, j->delay[rank]);
        collective_run(a, &k);
        j->left[rank] = comm_now_ps(c);
    }
    memcpy(j->found[rank], recv, sizeof recv);
}

static void play(const struct machine_spec *m, int nrank, struct job *j)
{
    struct outcome o = run_load(
        m, (struct world_load){.nrank = nrank, .program = call, .context = j, .meets = true});
    expect_ok(&o);
    if (strcmp(j->algorithm, "hardware") == 0) assert_int_equal(o.r.messages, 0);
    arena_destroy(o.arena);
}

/* The last of them comes at 20 us; all leave 1 us + 6 x 50 ns + 800 ns later. */
static void all_leave_when_the_last_has_come_and_the_network_is_done(void **state)
{
    (void)state;
    const struct machine_spec m = line(4);
    static const enum collective_kind kinds[] = {COLLECTIVE_BROADCAST, COLLECTIVE_REDUCE,
                                                 COLLECTIVE_ALLREDUCE};
    for (int k = 0; k < 3; k++) {
        static struct job j;
        j = (struct job){.kind = kinds[k],
                         .root = 2,
                         .algorithm = "hardware",
                         .delay = {0, 10 * US, 20 * US, 5 * US}};
        play(&m, 4, &j);
        for (int r = 0; r < 4; r++) assert_int_equal(j.left[r], 22 * US + 100000);
        /* and the next one 20 us and its own time after that */
        j.repeat = 1;
        play(&m, 4, &j);
        for (int r = 0; r < 4; r++) assert_int_equal(j.left[r], 2 * (22 * US + 100000));
    }
}

static void same(const struct job *a, const struct job *b, int rank)
{
    assert_memory_equal(a->found[rank], b->found[rank], sizeof a->found[rank]);
}

/* Whatever the number of ranks and the root, to the last bit. */
static void values_are_those_of_software(void **state)
{
    (void)state;
    static const int sizes[] = {1, 2, 3, 4, 5, 7, 8, 13, 16, 33};
    static struct job hard, soft, doubling;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const int P = sizes[i];
        const struct machine_spec m = line(P);
        soft = (struct job){.kind = COLLECTIVE_ALLREDUCE, .algorithm = "reduce-broadcast"};
        hard = (struct job){.kind = COLLECTIVE_ALLREDUCE, .algorithm = "hardware"};
        play(&m, P, &soft);
        play(&m, P, &hard);
        for (int r = 0; r < P; r++) same(&hard, &soft, r);
        doubling = (struct job){.kind = COLLECTIVE_ALLREDUCE, .algorithm = "recursive-doubling"};
        play(&m, P, &doubling);
        for (int r = 0; r < P && (P & (P - 1)) == 0; r++) same(&hard, &doubling, r);
        /* to any root: the bits of a tree at rank 0; the others' buffers stay as they were */
        hard = (struct job){.kind = COLLECTIVE_REDUCE, .root = P / 2, .algorithm = "hardware"};
        play(&m, P, &hard);
        same(&hard, &soft, P / 2);
        for (int r = 0; r < P; r++)
            if (r != P / 2) assert_true(hard.found[r][0] == -1);
        hard = (struct job){.kind = COLLECTIVE_BROADCAST, .root = P - 1, .algorithm = "hardware"};
        play(&m, P, &hard);
        for (int r = 0; r < P; r++) assert_true(hard.found[r][3] == term(P - 1, 3));
    }
}

/* ---- what there is ---- */

static struct collective_shape shape(const struct comm_hardware *h, enum collective_kind kind,
                                     int64_t count, enum comm_operation operation)
{
    return (struct collective_shape){.kind = kind,
                                     .size = 4,
                                     .count = count,
                                     .element = 8,
                                     .commutative = true,
                                     .operation = operation,
                                     .hardware = h};
}

static bool applies(const struct collective_shape s)
{
    return collective_applies(collective_algorithm_find(s.kind, "hardware"), &s);
}

static void only_what_the_network_has_applies(void **state)
{
    (void)state;
    struct comm_hardware h = {
        .kinds = 1u << COLLECTIVE_ALLREDUCE, .largest = 800, .operations = COMM_INTEGER};
    assert_true(applies(shape(&h, COLLECTIVE_ALLREDUCE, 100, COMM_INTEGER)));
    assert_true(applies(shape(&h, COLLECTIVE_ALLREDUCE, 100, COMM_LOGICAL)));
    assert_false(applies(shape(&h, COLLECTIVE_ALLREDUCE, 101, COMM_INTEGER)));
    assert_false(applies(shape(&h, COLLECTIVE_ALLREDUCE, 1, COMM_REAL)));
    assert_false(applies(shape(&h, COLLECTIVE_ALLREDUCE, 1, COMM_OWN)));
    assert_false(applies(shape(&h, COLLECTIVE_REDUCE, 1, COMM_INTEGER)));
    assert_false(applies(shape(NULL, COLLECTIVE_ALLREDUCE, 1, COMM_INTEGER)));
    h.kinds = 1u << COLLECTIVE_BROADCAST | 1u << COLLECTIVE_BARRIER;
    assert_true(applies(shape(&h, COLLECTIVE_BROADCAST, 1, COMM_OWN)));
    assert_true(applies(shape(&h, COLLECTIVE_BARRIER, 0, COMM_OWN)));
    struct collective_shape s = shape(&h, COLLECTIVE_BROADCAST, 1, COMM_OWN);
    s.irregular = true;
    assert_false(applies(s));
    /* A rule for hardware is passed over where it does not fit. */
    const struct collective_rule rule = {
        COLLECTIVE_BROADCAST, collective_algorithm_find(COLLECTIVE_BROADCAST, "hardware"), 0, 0};
    assert_string_equal(collective_choose(&s, &rule, 1)->name, "binomial");
    s.irregular = false;
    assert_string_equal(collective_choose(&s, &rule, 1)->name, "hardware");
}

static void look(struct comm *c, void *context)
{
    unsigned *kinds = context;
    *kinds = c->hardware ? c->hardware->kinds : 0;
}

static void programs_see_what_the_machine_has(void **state)
{
    (void)state;
    struct machine_spec m = line(2);
    unsigned kinds = 0;
    struct outcome o = go(&m, 2, look, &kinds);
    assert_int_equal(kinds, 1u << COLLECTIVE_BROADCAST | 1u << COLLECTIVE_REDUCE |
                                1u << COLLECTIVE_ALLREDUCE);
    arena_destroy(o.arena);
    m = crossbar(2);
    o = go(&m, 2, look, &kinds);
    assert_int_equal(kinds, 0);
    arena_destroy(o.arena);
    m.software.barrier = BARRIER_HARDWARE;
    o = go(&m, 2, look, &kinds);
    assert_int_equal(kinds, 1u << COLLECTIVE_BARRIER);
    arena_destroy(o.arena);
}

/* ---- mistakes ---- */

static void nothing(void *const *data, int n, void *context) { (void)data, (void)n, (void)context; }

/* Rank 1 brings another size, or never comes. */
static void disagree(struct comm *c, void *context)
{
    const bool comes = *(const bool *)context;
    char data[64] = {0};
    const struct comm_meeting m = {
        .kind = COLLECTIVE_ALLREDUCE, .bytes = c->rank == 1 ? 16 : 8, .data = data, .act = nothing};
    if (c->rank == 1 && !comes) return;
    comm_meet(c, &m);
}

static void ranks_that_disagree_or_stay_away_are_told(void **state)
{
    (void)state;
    const struct machine_spec m = line(3);
    bool comes = true;
    struct outcome o = go(&m, 3, disagree, &comes);
    assert_int_equal(o.r.status, RUN_FAILED);
    assert_non_null(strstr(o.r.text, "allreduce of 16 B, root 0, by the network, in which rank 0 "
                                     "calls allreduce of 8 B"));
    arena_destroy(o.arena);
    comes = false;
    o = go(&m, 3, disagree, &comes);
    assert_int_equal(o.r.status, RUN_DEADLOCK);
    assert_non_null(strstr(o.r.text, "waits in a collective of the network, allreduce of 8 B"));
    assert_non_null(strstr(o.r.text, "that 2 of 3 ranks have entered"));
    arena_destroy(o.arena);
}

/* Vectors of all ranks are in one memory: such a run stays on one thread. */
static void threads_stay_away(void **state)
{
    (void)state;
    const struct machine_spec m = line(4);
    const struct record_spec record = {0};
    struct world_load load = {.nrank = 4};
    assert_null(world_alone(&m, &load, &record));
    load.meets = true;
    assert_non_null(world_alone(&m, &load, &record));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_follow_the_network_or_are_its_own),
        cmocka_unit_test(times_by_hand),
        cmocka_unit_test(all_leave_when_the_last_has_come_and_the_network_is_done),
        cmocka_unit_test(values_are_those_of_software),
        cmocka_unit_test(only_what_the_network_has_applies),
        cmocka_unit_test(programs_see_what_the_machine_has),
        cmocka_unit_test(ranks_that_disagree_or_stay_away_are_told),
        cmocka_unit_test(threads_stay_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
