/* test_routing.c - every rule on every family that it is for: routes end where they should, minimal
 * ones are minimal, and the graph of dependencies between channels has no cycle. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/arena.h"
#include "machine/routing.h"

#define ONE .nodes_per_router = 1, .processors_per_node = 1

static const int ring_cables[5][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}};
static const int petersen[15][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}, {0, 5}, {1, 6}, {2, 7},
                                    {3, 8}, {4, 9}, {5, 7}, {7, 9}, {9, 6}, {6, 8}, {8, 5}};

static const struct topology_spec small[] = {
    {.family = TOPOLOGY_TORUS, .ndim = 1, .dims = {5}, ONE},
    {.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {4, 3}, ONE},
    {.family = TOPOLOGY_TORUS, .ndim = 2, .dims = {2, 4}, ONE},
    {.family = TOPOLOGY_MESH, .ndim = 2, .dims = {3, 4}, ONE},
    {.family = TOPOLOGY_MESH, .ndim = 3, .dims = {2, 3, 2}, ONE},
    {.family = TOPOLOGY_MESH,
     .ndim = 2,
     .dims = {2, 3},
     .nodes_per_router = 2,
     .processors_per_node = 1},
    {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {3}, ONE},
    {.family = TOPOLOGY_HYPERCUBE, .ndim = 1, .dims = {3}, .xpress = true, ONE},
    {.family = TOPOLOGY_HYPERX,
     .ndim = 2,
     .dims = {3, 3},
     .nodes_per_router = 2,
     .processors_per_node = 1},
    {.family = TOPOLOGY_FULL_MESH, .ndim = 1, .dims = {5}, ONE},
    {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {2, 3}, ONE},
    {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 2, 2, 0}, ONE},
    {.family = TOPOLOGY_GRAPH,
     .ndim = 1,
     .dims = {10},
     ONE,
     .nlink = 15,
     .link = (int (*)[2])petersen},
};
/* The other families, and other ways on some of the above. */
static int two[] = {2, 1}, one[] = {1};
static const struct topology_spec other[] = {
    {.family = TOPOLOGY_SLIM_FLY, .ndim = 1, .dims = {3}, ONE},
    {.family = TOPOLOGY_DRAGONFLY_PLUS, .ndim = 5, .dims = {1, 2, 2, 1, 3}, ONE},
    {.family = TOPOLOGY_FOLDED_CLOS, .ndim = 2, .dims = {2, 4}, .nup = 1, .up = two, ONE},
    {.family = TOPOLOGY_EXPRESS_MESH, .ndim = 2, .dims = {5, 3}, .express = 2, ONE},
    {.family = TOPOLOGY_EXPRESS_TORUS, .ndim = 2, .dims = {4, 4}, .express = 2, ONE},
    {.family = TOPOLOGY_TWISTED_TORUS, .ndim = 2, .dims = {4, 3}, .ntwist = 1, .twist = one, ONE},
    {.family = TOPOLOGY_RANDOM_REGULAR, .ndim = 2, .dims = {10, 3}, .seed = 3, ONE},
    {.family = TOPOLOGY_HYPERX, .ndim = 2, .dims = {3, 3}, .nbundle = 2, .bundle = two, ONE},
    {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 4, 2, 4}, ONE},
    {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 3, 1, 0}, .routing = ROUTE_VALIANT, ONE},
    {.family = TOPOLOGY_FAT_TREE, .ndim = 2, .dims = {2, 3}, .routing = ROUTE_VALIANT, ONE},
};
enum {
    SMALL = sizeof small / sizeof *small,
    OTHER = sizeof other / sizeof *other,
    CHANNELS = 8,
    MANY_CHANNELS = 20,
    CHOICES = 60
};

static struct topology *make(const struct topology_spec *s, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(s, a, &e);
    if (!t) fail_msg("%s", e.text);
    return t;
}

/* A load that depends on the link and a number, so that each choice meets another one. */
static int64_t some_load(const void *of, int link)
{
    const uint64_t z = (*(const uint64_t *)of + (uint64_t)link + 1) * 0x9e3779b97f4a7c15u;
    return (int64_t)((z ^ z >> 29) % 50);
}

/* Channels that may wait for each other: after[i n + j]. */
struct graph {
    int n;
    bool *after;
};

/* What a walk does at each router: note who would wait for whom. `held` is the channel that the
 * packet holds; with an escape, the last escape channel that it held, since it may wait for the
 * next one with others in between. `merge`: channels of a link are taken for one. */
static void note(const struct graph *g, const struct routing *r, int held,
                 const struct route_option *o, int escape, bool merge)
{
    for (int c = o->first; c < o->first + o->count; c++) {
        if (held < 0 || (escape > 0 && c >= escape)) continue;
        g->after[held * g->n + o->link * r->channels + (merge ? 0 : c)] = true;
    }
}

/* One packet at random through the network, under some load; returns its hops. */
static int walk(const struct graph *g, const struct routing *r, int src, int dst, uint64_t choice,
                int escape, bool merge)
{
    const struct routing_view view = {some_load, &choice};
    struct route_option option[ROUTING_MOST_OPTIONS];
    struct route p = routing_start(r, src, dst, choice);
    int n, held = -1, first;
    uint64_t chance = choice * 0xd1342543de82ef95u + 1;
    assert_in_range(routing_inject(r, &p, &first), 1, r->channels);
    while ((n = routing_next(r, &p, &view, option)) > 0) {
        if (n > ROUTING_MOST_OPTIONS || p.hops >= r->max_hops)
            fail_msg("%s on %s: %d links from %d to %d, at most %d", routing_rule_name(r->rule),
                     topology_family_name(r->topology->spec->family), p.hops, src, dst,
                     r->max_hops);
        for (int i = 0; i < n; i++) {
            int from, to, port;
            topology_link_ends(r->topology, option[i].link, &from, &to, &port);
            assert_int_equal(from, p.router);
            assert_true(option[i].count >= 1 && option[i].first >= 0);
            assert_true(option[i].first + option[i].count <= r->channels);
            if (g) note(g, r, held, &option[i], escape, merge);
        }
        chance = chance * 6364136223846793005u + 1442695040888963407u;
        const struct route_option *o =
            &option[chance >> 33 & 0xffff ? (chance >> 33) % (uint64_t)n : 0];
        const int channel = o->first + (int)((chance >> 20) % (uint64_t)o->count);
        routing_take(r, &p, o, channel);
        if (escape == 0 || channel < escape) held = o->link * r->channels + (merge ? 0 : channel);
    }
    assert_int_equal(p.router, topology_router_of(r->topology, dst));
    return p.hops;
}

static bool has_cycle(const struct graph *g, int at, char *mark)
{
    mark[at] = 1;
    for (int i = 0; i < g->n; i++) {
        if (!g->after[at * g->n + i]) continue;
        if (mark[i] == 1 || (mark[i] == 0 && has_cycle(g, i, mark))) return true;
    }
    mark[at] = 2;
    return false;
}

static bool may_deadlock(const struct routing *r, int escape, bool merge, struct arena *a)
{
    const struct topology *t = r->topology;
    struct graph g = {t->nlink * r->channels, NULL};
    g.after = TAKE(a, (size_t)g.n * (size_t)g.n, bool);
    char *mark = TAKE(a, g.n, char);
    for (int src = 0; src < t->nnode; src++)
        for (int dst = 0; dst < t->nnode; dst++)
            for (uint64_t choice = 0; choice < CHOICES; choice++)
                walk(&g, r, src, dst, choice * 977 + (uint64_t)(src * 64 + dst), escape, merge);
    for (int i = 0; i < g.n; i++)
        if (mark[i] == 0 && has_cycle(&g, i, mark)) return true;
    return false;
}

/* call `check` with every rule on every network of a list that it is for */
static void on_each(const struct topology_spec *list, int nlist, int channels,
                    void (*check)(const struct routing *, struct arena *), int *count)
{
    for (int i = 0; i < nlist; i++)
        for (int rule = 0; rule < ROUTING_RULES; rule++) {
            struct arena *a = arena_create();
            struct err e;
            err_clear(&e);
            const struct routing *r =
                routing_create(make(&list[i], a), (enum routing_rule)rule, channels, a, &e);
            if (r) {
                check(r, a);
                ++*count;
            } else {
                assert_int_equal(e.kind, ERR_CONFIG);
                assert_non_null(strstr(e.text, "is not for topology"));
            }
            arena_destroy(a);
        }
}

static void on_all(void (*check)(const struct routing *, struct arena *), int *count)
{
    on_each(small, SMALL, CHANNELS, check, count);
}

static void check_free(const struct routing *r, struct arena *a)
{
    const enum topology_family family = r->topology->spec->family;
    /* BookSim's arbitrary networks have no rule against it, and its UGAL has one channel for the
     * local links of a dragonfly before and after the first global one. */
    if (r->rule == ROUTING_BOOKSIM_MIN && family == TOPOLOGY_GRAPH) return;
    if (r->rule == ROUTING_BOOKSIM_UGAL && family == TOPOLOGY_DRAGONFLY) {
        assert_true(may_deadlock(r, 0, false, a));
        return;
    }
    /* Its rule for tori has an escape and shares FIFOs: see below. */
    if (r->rule == ROUTING_BOOKSIM_MIN_ADAPT && family == TOPOLOGY_TORUS) return;
    /* An escape is for packets at the front of a FIFO. Where several share one, those behind cannot
     * turn to it, and all channels must be free of cycles. */
    if (may_deadlock(r, r->fits ? r->escape : 0, false, a))
        fail_msg("%s on %s can deadlock", routing_rule_name(r->rule),
                 topology_family_name(r->topology->spec->family));
}

static void no_rule_can_deadlock(void **state)
{
    (void)state;
    int count = 0;
    on_all(check_free, &count);
    assert_int_equal(count, 117);
    on_each(other, OTHER, MANY_CHANNELS, check_free, &count);
    assert_int_equal(count, 117 + 64);
}

/* The same test sees rules that can: without channels to tell apart, and without an escape. */
static void rules_without_classes_can_deadlock(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct topology_spec graph = {.family = TOPOLOGY_GRAPH,
                                  .ndim = 1,
                                  .dims = {5},
                                  ONE,
                                  .nlink = 5,
                                  .link = (int(*)[2])ring_cables};
    const struct topology *ring = make(&graph, a), *torus = make(&small[1], a),
                          *mesh = make(&small[3], a), *cube = make(&small[8], a);
    assert_true(may_deadlock(routing_create(ring, ROUTING_BOOKSIM_MIN, 2, a, &e), 0, false, a));
    assert_false(may_deadlock(routing_create(ring, ROUTING_DETERMINISTIC, 2, a, &e), 0, false, a));
    const struct routing *r = routing_create(torus, ROUTING_BOOKSIM_DIM_ORDER, 2, a, &e);
    assert_true(may_deadlock(r, 0, true, a));
    assert_true(may_deadlock(routing_create(mesh, ROUTING_ADAPTIVE, 3, a, &e), 0, false, a));
    assert_true(may_deadlock(routing_create(mesh, ROUTING_XY_YX, 2, a, &e), 0, true, a));
    assert_true(may_deadlock(routing_create(mesh, ROUTING_VALIANT, 2, a, &e), 0, true, a));
    assert_true(may_deadlock(routing_create(cube, ROUTING_ADAPTIVE, 2, a, &e), 0, true, a));
    /* Channel 3 of BookSim's torus rule has no classes: the escape would do, were it unshared. */
    const struct topology_spec four = {.family = TOPOLOGY_TORUS, .ndim = 1, .dims = {4}, ONE};
    r = routing_create(make(&four, a), ROUTING_BOOKSIM_MIN_ADAPT, 4, a, &e);
    assert_false(may_deadlock(r, r->escape, false, a));
    assert_true(!r->fits && may_deadlock(r, 0, false, a));
    arena_destroy(a);
}

/* Rules that may not leave the shortest way, against those that may. */
static bool is_minimal(enum routing_rule rule)
{
    return rule != ROUTING_VALIANT && rule != ROUTING_UGAL_L && rule != ROUTING_UGAL_G &&
           rule != ROUTING_BOOKSIM_VALIANT && rule != ROUTING_BOOKSIM_UGAL;
}

static void check_lengths(const struct routing *r, struct arena *a)
{
    const struct topology *t = r->topology;
    (void)a;
    for (int src = 0; src < t->nnode; src++)
        for (int dst = 0; dst < t->nnode; dst++) {
            const int least = topology_distance(t, src, dst);
            for (uint64_t choice = 0; choice < 10; choice++) {
                const int hops = walk(NULL, r, src, dst, choice, 0, false);
                struct route p = routing_start(r, src, dst, choice);
                int link, empty = 0;
                while (routing_empty(r, &p, &link)) empty++;
                assert_int_equal(p.router, topology_router_of(t, dst));
                /* A dragonfly's own routes have one global link and are not always shortest; rules
                 * by dimensions do not use a hypercube's Xpress links. */
                const bool shorter = t->spec->family == TOPOLOGY_DRAGONFLY || t->spec->xpress;
                if (is_minimal(r->rule) && !shorter) assert_int_equal(hops, least);
                if (!shorter) assert_true(hops >= least && empty >= least);
                if (r->minimal) assert_int_equal(empty, least);
                /* Nothing is in the way: by load nobody leaves the shortest way. */
                if (r->rule == ROUTING_UGAL_L || r->rule == ROUTING_UGAL_G)
                    assert_int_equal(empty, least);
            }
        }
}

static void routes_have_the_length_of_their_rule(void **state)
{
    (void)state;
    int count = 0;
    on_all(check_lengths, &count);
    assert_true(count > 0);
}

/* Valiant goes over random routers: its mean way is longer than the shortest, and not for all. */
static void valiant_is_longer_and_ugal_avoids_a_queue(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    const struct topology *t = make(&small[8], a);
    const struct routing *valiant = routing_create(t, ROUTING_VALIANT, 4, a, &e);
    int longer = 0, hops = 0;
    for (uint64_t choice = 0; choice < 500; choice++) {
        const int n = walk(NULL, valiant, 0, 17, choice, 0, false);
        longer += n > 2;
        hops += n;
    }
    assert_true(longer > 100 && longer < 500 && hops > 1000);
    arena_destroy(a);
}

static int64_t full_link(const void *of, int link) { return link == *(const int *)of ? 1000 : 0; }

static void ugal_leaves_a_link_that_is_full(void **state)
{
    (void)state;
    static const enum routing_rule rule[] = {ROUTING_UGAL_L, ROUTING_UGAL_G, ROUTING_BOOKSIM_UGAL,
                                             ROUTING_ADAPTIVE_XY_YX, ROUTING_ADAPTIVE};
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    const struct topology *t = make(&small[8], a);
    for (size_t i = 0; i < sizeof rule / sizeof *rule; i++) {
        const struct routing *r = routing_create(t, rule[i], 4, a, &e);
        int away = 0;
        for (uint64_t choice = 0; choice < 200; choice++) {
            /* From router 0 to router 4 = (1, 1), which is two links away. */
            struct route p = routing_start(r, 0, 8, choice), q = p;
            struct route_option empty[ROUTING_MOST_OPTIONS], loaded[ROUTING_MOST_OPTIONS];
            const struct routing_view none = {0}, full = {full_link, &empty[0].link};
            assert_true(routing_next(r, &p, &none, empty) > 0);
            const int n = routing_next(r, &q, &full, loaded);
            const struct route_option *best = loaded;
            for (int k = 1; k < n; k++)
                if (loaded[k].priority > best->priority) best = &loaded[k];
            away += best->link != empty[0].link;
        }
        /* Not always: the intermediate router may lie behind the same link. */
        assert_true(away > 50);
    }
    arena_destroy(a);
}

/* BookSim's dragonflies leave the network over the channel of the packet's stage: the last one that
 * it took, or where it took none, the first of the rule. All others over any channel. */
static void packets_leave_over_the_channels_of_their_rule(void **state)
{
    (void)state;
    static const enum routing_rule rule[] = {ROUTING_BOOKSIM_MIN, ROUTING_BOOKSIM_UGAL,
                                             ROUTING_VALIANT};
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    const struct topology *t = make(&small[11], a);
    int stage[3][CHANNELS] = {{0}};
    for (size_t i = 0; i < sizeof rule / sizeof *rule; i++) {
        const struct routing *r = routing_create(t, rule[i], CHANNELS, a, &e);
        for (int dst = 0; dst < t->nnode; dst++) {
            struct route p = routing_start(r, 0, dst, 7);
            int link, first;
            while (routing_empty(r, &p, &link)) continue;
            const int count = routing_eject(r, &p, &first);
            assert_int_equal(count, rule[i] == ROUTING_VALIANT ? CHANNELS : 1);
            if (count == 1 && p.hops > 0) assert_int_equal(first, p.channel);
            stage[i][first]++;
        }
    }
    /* Inside the group over 0, from others over 1; UGAL: all over 2. */
    assert_int_equal(stage[0][0], 2);
    assert_int_equal(stage[0][1], t->nnode - 2);
    assert_int_equal(stage[1][2], t->nnode);
    assert_int_equal(stage[2][0], t->nnode);
    arena_destroy(a);
}

static void numbers_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    const struct topology *torus = make(&small[0], a);
    assert_null(routing_create(torus, ROUTING_BOOKSIM_MIN_ADAPT, 3, a, &e));
    assert_string_equal(e.text, "network.virtual_channels is 3; network.routing "
                                "'booksim-min-adapt' on topology 'torus' needs at least 4: its "
                                "channel 3 adapts");
    err_clear(&e);
    assert_null(routing_create(torus, ROUTING_ANCA, 3, a, &e));
    assert_string_equal(e.text, "network.routing 'anca' is not for topology 'torus'");
    err_clear(&e);
    struct topology_spec bus = {.family = TOPOLOGY_BUS, .ndim = 1, .dims = {4}, ONE};
    assert_null(routing_create(make(&bus, a), ROUTING_VALIANT, 3, a, &e));
    err_clear(&e);
    struct topology_spec large = {.family = TOPOLOGY_FULL_MESH, .ndim = 1, .dims = {4097}, ONE};
    assert_null(routing_create(make(&large, a), ROUTING_ADAPTIVE, 3, a, &e));
    assert_non_null(strstr(e.text, "at most 4096"));
    /* Levels without channels are given as many as a rule needs. */
    const struct routing *r = routing_create(torus, ROUTING_VALIANT, 0, a, &e);
    assert_int_equal(r->channels, 4);
    arena_destroy(a);
}

/* A rule that chose a link that failed would be worse than none. */
static void only_deterministic_routes_go_around_failures(void **state)
{
    (void)state;
    static int cable[1][2] = {{0, 1}};
    struct arena *a = arena_create();
    struct err e;
    struct topology_spec s = small[1];
    s.nfailed_link = 1, s.failed_link = cable;
    const struct topology *t = make(&s, a);
    err_clear(&e);
    assert_null(routing_create(t, ROUTING_ADAPTIVE, CHANNELS, a, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    assert_non_null(strstr(e.text, "does not go around what network.failed names"));
    err_clear(&e);
    assert_non_null(routing_create(t, ROUTING_DETERMINISTIC, CHANNELS, a, &e));
    assert_non_null(routing_create(make(&small[1], a), ROUTING_ADAPTIVE, CHANNELS, a, &e));
    arena_destroy(a);
}

/* One packet by a rule as it is, and by the same that keeps what it asks for often. */
static void walk_both(const struct routing *plain, const struct routing *kept, int src, int dst,
                      uint64_t choice)
{
    const struct routing_view view = {some_load, &choice};
    struct route_option x[ROUTING_MOST_OPTIONS], y[ROUTING_MOST_OPTIONS];
    struct route p = routing_start(plain, src, dst, choice), q = p;
    int first, n;
    assert_int_equal(routing_inject(plain, &p, &first), routing_inject(kept, &q, &first));
    while ((n = routing_next(plain, &p, &view, x)) > 0) {
        assert_int_equal(routing_next(kept, &q, &view, y), n);
        for (int i = 0; i < n; i++) {
            assert_int_equal(x[i].link, y[i].link);
            assert_int_equal(x[i].first, y[i].first);
            assert_int_equal(x[i].count, y[i].count);
            assert_int_equal(x[i].priority, y[i].priority);
        }
        const int i = (int)(choice % (uint64_t)n);
        routing_take(plain, &p, &x[i], x[i].first);
        routing_take(kept, &q, &y[i], y[i].first);
    }
    assert_int_equal(routing_next(kept, &q, &view, y), 0);
}

static void check_kept(const struct routing *r, struct arena *a)
{
    const struct topology *t = r->topology;
    struct err e;
    err_clear(&e);
    struct routing *kept = routing_create(t, r->rule, r->channels, a, &e);
    assert_non_null(kept);
    routing_keep(kept, a);
    for (int src = 0; src < t->nnode; src++)
        for (int dst = 0; dst < t->nnode; dst++)
            for (uint64_t choice = 0; choice < CHOICES / 4; choice++)
                walk_both(r, kept, src, dst, choice);
}

/* Also where the next link depends on more than a pair of routers: of parallel links. */
static void what_is_kept_changes_no_answer(void **state)
{
    static int cables[] = {1, 2};
    static const struct topology_spec parallel[] = {
        {.family = TOPOLOGY_HYPERX, .ndim = 2, .dims = {3, 2}, .nbundle = 2, .bundle = cables, ONE},
        {.family = TOPOLOGY_DRAGONFLY, .ndim = 4, .dims = {1, 4, 2, 4}, ONE},
    };
    int count = 0;
    (void)state;
    on_all(check_kept, &count);
    on_each(parallel, sizeof parallel / sizeof *parallel, CHANNELS, check_kept, &count);
    assert_true(count > 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_rule_can_deadlock),
        cmocka_unit_test(rules_without_classes_can_deadlock),
        cmocka_unit_test(routes_have_the_length_of_their_rule),
        cmocka_unit_test(valiant_is_longer_and_ugal_avoids_a_queue),
        cmocka_unit_test(ugal_leaves_a_link_that_is_full),
        cmocka_unit_test(packets_leave_over_the_channels_of_their_rule),
        cmocka_unit_test(numbers_that_do_not_fit_are_refused),
        cmocka_unit_test(what_is_kept_changes_no_answer),
        cmocka_unit_test(only_deterministic_routes_go_around_failures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
