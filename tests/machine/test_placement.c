/* test_placement.c - orders of processors, and the link loads and hops they give doubling patterns,
 * by enumeration. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/arena.h"
#include "machine/placement.h"

enum { MAX_ROUTE = 64 };

static struct machine_spec machine(enum topology_family family, int ndim, const int *dims,
                                   enum placement_kind kind)
{
    struct machine_spec m = {.name = "test"};
    m.topology = (struct topology_spec){
        .family = family, .ndim = ndim, .nodes_per_router = 1, .processors_per_node = 1};
    for (int d = 0; d < ndim; d++) m.topology.dims[d] = dims[d];
    m.placement.kind = kind;
    return m;
}

static struct placement place(const struct machine_spec *m, int nrank, struct arena *a)
{
    struct err e;
    struct placement p = {0};
    err_clear(&e);
    struct topology *t = topology_create(&m->topology, a, &e);
    if (!t || !placement_create(&p, m, t, nrank, a, &e)) fail_msg("%s", e.text);
    return p;
}

/* every processor at most once, all within the machine */
static void assert_distinct(const struct placement *p, int nnode, int per_node)
{
    bool *taken = calloc((size_t)(nnode * per_node), sizeof *taken);
    for (int r = 0; r < p->nrank; r++) {
        int i = p->node[r] * per_node + p->processor[r];
        assert_in_range(p->node[r], 0, nnode - 1);
        assert_in_range(p->processor[r], 0, per_node - 1);
        assert_false(taken[i]);
        taken[i] = true;
    }
    free(taken);
}

static void every_order_uses_each_processor_once(void **state)
{
    (void)state;
    static const int grid[] = {5, 4, 3}, cube[] = {5};
    static const enum placement_kind kinds[] = {PLACEMENT_LINEAR, PLACEMENT_SNAKE, PLACEMENT_GRAY,
                                                PLACEMENT_RANDOM};
    for (size_t k = 0; k < 4; k++)
        for (int spread = 0; spread < 2; spread++)
            for (int per_node = 1; per_node <= 3; per_node++) {
                struct arena *a = arena_create();
                bool gray = kinds[k] == PLACEMENT_GRAY;
                struct machine_spec m = gray ? machine(TOPOLOGY_HYPERCUBE, 1, cube, kinds[k])
                                             : machine(TOPOLOGY_MESH, 3, grid, kinds[k]);
                m.topology.processors_per_node = per_node;
                m.topology.nodes_per_router = 2;
                m.placement.spread = spread ? SPREAD_CYCLIC : SPREAD_BLOCK;
                int nnode = 2 * (gray ? 32 : 60);
                struct placement p = place(&m, nnode * per_node, a);
                assert_distinct(&p, nnode, per_node);
                arena_destroy(a);
            }
}

static void snake_and_gray_step_to_neighbours(void **state)
{
    (void)state;
    static const int grid[] = {5, 4, 3}, cube[] = {6};
    struct arena *a = arena_create();
    struct machine_spec m[] = {machine(TOPOLOGY_MESH, 3, grid, PLACEMENT_SNAKE),
                               machine(TOPOLOGY_HYPERCUBE, 1, cube, PLACEMENT_GRAY)};
    for (int i = 0; i < 2; i++) {
        struct err e;
        err_clear(&e);
        struct topology *t = topology_create(&m[i].topology, a, &e);
        struct placement p = place(&m[i], t->nnode, a);
        for (int r = 1; r < p.nrank; r++)
            assert_int_equal(topology_distance(t, p.node[r - 1], p.node[r]), 1);
    }
    arena_destroy(a);
}

static void block_fills_nodes_and_cyclic_deals_to_them(void **state)
{
    (void)state;
    static const int line[] = {4};
    struct arena *a = arena_create();
    struct machine_spec m = machine(TOPOLOGY_MESH, 1, line, PLACEMENT_LINEAR);
    m.topology.processors_per_node = 2;
    struct placement block = place(&m, 6, a);
    m.placement.spread = SPREAD_CYCLIC;
    struct placement cyclic = place(&m, 6, a);
    static const int block_node[] = {0, 0, 1, 1, 2, 2}, cyclic_node[] = {0, 1, 2, 3, 0, 1};
    static const int block_processor[] = {0, 1, 0, 1, 0, 1},
                     cyclic_processor[] = {0, 0, 0, 0, 1, 1};
    assert_memory_equal(block.node, block_node, sizeof block_node);
    assert_memory_equal(cyclic.node, cyclic_node, sizeof cyclic_node);
    assert_memory_equal(block.processor, block_processor, sizeof block_processor);
    assert_memory_equal(cyclic.processor, cyclic_processor, sizeof cyclic_processor);
    arena_destroy(a);
}

static void random_depends_on_the_seed_alone(void **state)
{
    (void)state;
    static const int grid[] = {16, 16};
    struct arena *a = arena_create();
    struct machine_spec m = machine(TOPOLOGY_MESH, 2, grid, PLACEMENT_RANDOM);
    struct placement p = place(&m, 200, a), q = place(&m, 200, a);
    m.placement.seed = 1;
    struct placement other = place(&m, 200, a);
    assert_distinct(&p, 256, 1);
    assert_memory_equal(p.node, q.node, 200 * sizeof(int));
    assert_memory_not_equal(p.node, other.node, 200 * sizeof(int));
    arena_destroy(a);
}

static void lists_are_obeyed_or_refused(void **state)
{
    (void)state;
    static const int line[] = {3};
    int good[] = {5, 0, 2}, out[] = {0, 6, 1}, twice[] = {4, 1, 4};
    struct arena *a = arena_create();
    struct machine_spec m = machine(TOPOLOGY_MESH, 1, line, PLACEMENT_LIST);
    m.topology.processors_per_node = 2;
    m.placement.nlist = 3;
    m.placement.list = good;
    struct placement p = place(&m, 3, a);
    assert_int_equal(p.node[0], 2);
    assert_int_equal(p.processor[0], 1);
    assert_int_equal(p.node[2], 1);
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(&m.topology, a, &e);
    int *bad[] = {out, twice, good};
    for (int i = 0; i < 3; i++) {
        err_clear(&e);
        m.placement.list = bad[i];
        /* the last list is too short */
        assert_false(placement_create(&p, &m, t, i == 2 ? 4 : 3, a, &e));
        assert_int_equal(e.kind, ERR_CONFIG);
    }
    arena_destroy(a);
}

static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    static const int grid[] = {2, 2}, cube[] = {2};
    struct arena *a = arena_create();
    struct machine_spec m[] = {machine(TOPOLOGY_MESH, 2, grid, PLACEMENT_LINEAR),
                               machine(TOPOLOGY_MESH, 2, grid, PLACEMENT_GRAY),
                               machine(TOPOLOGY_HYPERCUBE, 1, cube, PLACEMENT_SNAKE)};
    for (int i = 0; i < 3; i++) {
        struct err e;
        struct placement p;
        err_clear(&e);
        struct topology *t = topology_create(&m[i].topology, a, &e);
        assert_false(placement_create(&p, &m[i], t, i == 0 ? 5 : 4, a, &e));
        assert_int_equal(e.kind, ERR_CONFIG);
    }
    arena_destroy(a);
}

/* ---- hops and link loads of one step ---- */

/* Kogge-Stone; PCR; cyclic reduction's elimination */
enum pattern { ONE_WAY, BOTH_WAYS, REDUCTION };

struct load {
    double mean_hops;
    int worst;
};

static void add_message(const struct topology *t, const struct placement *p, int from, int to,
                        int *load, int *hops, int *messages)
{
    struct hop route[MAX_ROUTE];
    if (from < 0 || to < 0 || from >= p->nrank || to >= p->nrank) return;
    int n = topology_route(t, p->node[from], p->node[to], 0, route);
    for (int i = 0; i < n; i++) load[route[i].link]++;
    *hops += n;
    ++*messages;
}

static struct load step_load(const struct machine_spec *m, int distance, enum pattern pattern)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(&m->topology, a, &e);
    struct placement p = place(m, t->nnode, a);
    int *load = TAKE(a, t->nlink + 1, int), hops = 0, messages = 0;
    for (int i = 0; i < p.nrank; i++) {
        if (pattern == REDUCTION && (i + 1) % (2 * distance) != 0) continue;
        if (pattern == REDUCTION) add_message(t, &p, i - distance, i, load, &hops, &messages);
        if (pattern == REDUCTION) add_message(t, &p, i + distance, i, load, &hops, &messages);
        if (pattern != REDUCTION) add_message(t, &p, i, i + distance, load, &hops, &messages);
        if (pattern == BOTH_WAYS) add_message(t, &p, i, i - distance, load, &hops, &messages);
    }
    struct load out = {(double)hops / messages, 0};
    for (int l = 0; l < t->nlink; l++)
        if (load[l] > out.worst) out.worst = load[l];
    arena_destroy(a);
    return out;
}

static void expect(const struct machine_spec *m, enum pattern pattern, const double *mean_hops,
                   const int *worst)
{
    for (int j = 0; j < 7; j++) {
        struct load l = step_load(m, 1 << j, pattern);
        if (mean_hops &&
            !(l.mean_hops > mean_hops[j] - 0.051 && l.mean_hops < mean_hops[j] + 0.051))
            fail_msg("step %d: %g hops, expected %g", j, l.mean_hops, mean_hops[j]);
        if (l.worst != worst[j]) fail_msg("step %d: load %d, expected %d", j, l.worst, worst[j]);
    }
}

static void loads_of_doubling_steps_are_those_of_theory(void **state)
{
    (void)state;
    static const int d844[] = {8, 4, 4}, d816[] = {8, 16}, d128[] = {128}, d7[] = {7};
    struct machine_spec torus = machine(TOPOLOGY_TORUS, 3, d844, PLACEMENT_LINEAR);
    struct machine_spec snake = machine(TOPOLOGY_TORUS, 3, d844, PLACEMENT_SNAKE);
    struct machine_spec plane = machine(TOPOLOGY_TORUS, 2, d816, PLACEMENT_LINEAR);
    struct machine_spec mesh = machine(TOPOLOGY_MESH, 2, d816, PLACEMENT_LINEAR);
    struct machine_spec ring = machine(TOPOLOGY_TORUS, 1, d128, PLACEMENT_LINEAR);
    struct machine_spec cube = machine(TOPOLOGY_HYPERCUBE, 1, d7, PLACEMENT_LINEAR);
    struct machine_spec gray = machine(TOPOLOGY_HYPERCUBE, 1, d7, PLACEMENT_GRAY);
    static const double h844[] = {1.1, 2.3, 4.6, 1.2, 2.4, 1.0, 2.0};
    expect(&torus, ONE_WAY, h844, (const int[]){1, 2, 4, 1, 2, 1, 2});
    expect(&torus, BOTH_WAYS, h844, (const int[]){1, 2, 8, 1, 4, 1, 2});
    expect(&torus, REDUCTION, NULL, (const int[]){1, 1, 2, 1, 2, 1, 1});
    expect(&snake, BOTH_WAYS, (const double[]){1.0, 2.0, 3.5, 3.0, 2.0, 2.0, 2.0},
           (const int[]){1, 2, 6, 4, 3, 2, 2});
    expect(&plane, BOTH_WAYS, (const double[]){1.1, 2.2, 4.5, 1.0, 2.0, 4.0, 8.0},
           (const int[]){1, 2, 8, 1, 2, 4, 8});
    expect(&mesh, BOTH_WAYS, (const double[]){1.8, 3.2, 4.5, 1.0, 2.0, 4.0, 8.0},
           (const int[]){2, 4, 8, 1, 2, 4, 8});
    expect(&ring, BOTH_WAYS, (const double[]){1, 2, 4, 8, 16, 32, 64},
           (const int[]){1, 2, 4, 8, 16, 32, 64});
    expect(&ring, ONE_WAY, NULL, (const int[]){1, 2, 4, 8, 16, 32, 64});
    expect(&ring, REDUCTION, NULL, (const int[]){1, 1, 1, 1, 1, 1, 1});
    expect(&cube, BOTH_WAYS, (const double[]){1.9, 1.9, 1.8, 1.7, 1.6, 1.3, 1.0},
           (const int[]){2, 2, 2, 2, 2, 2, 1});
    expect(&cube, ONE_WAY, NULL, (const int[]){1, 1, 1, 1, 1, 1, 1});
    /* with one hop each, neighbours cannot share a link: load 1 in the first step */
    expect(&gray, BOTH_WAYS, (const double[]){1, 2, 2, 2, 2, 2, 2},
           (const int[]){1, 2, 2, 2, 2, 2, 1});
}

static void hops_on_a_hypercube_are_those_of_the_closed_form(void **state)
{
    (void)state;
    for (int lg = 2; lg <= 8; lg++) {
        struct machine_spec cube = machine(TOPOLOGY_HYPERCUBE, 1, &lg, PLACEMENT_LINEAR);
        for (int j = 0; j < lg; j++) {
            double rho = lg - j, half = 1.0 / (1 << (lg - j));
            double mean = (2 - (rho + 2) * half) / (1 - half);
            assert_true(step_load(&cube, 1 << j, ONE_WAY).mean_hops - mean < 1e-12);
            assert_true(step_load(&cube, 1 << j, ONE_WAY).mean_hops - mean > -1e-12);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_order_uses_each_processor_once),
        cmocka_unit_test(snake_and_gray_step_to_neighbours),
        cmocka_unit_test(block_fills_nodes_and_cyclic_deals_to_them),
        cmocka_unit_test(random_depends_on_the_seed_alone),
        cmocka_unit_test(lists_are_obeyed_or_refused),
        cmocka_unit_test(what_does_not_fit_is_refused),
        cmocka_unit_test(loads_of_doubling_steps_are_those_of_theory),
        cmocka_unit_test(hops_on_a_hypercube_are_those_of_the_closed_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
