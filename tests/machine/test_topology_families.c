/* test_topology_families.c - the newer families against their closed forms: numbers of routers and
 * links, how many routers are at which distance, who is joined to whom, what is refused.
 *
 * That routes join their ends, are shortest and free of deadlock is tested for all families alike
 * in test_topology.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/arena.h"
#include "machine/topology.h"

enum { FARTHEST = 64, MANY = 8192 };

static struct topology *make(const struct topology_spec *s, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct topology *t = topology_create(s, a, &e);
    if (!t) fail_msg("%s", e.text);
    return t;
}

/* One node on each router unless the test says otherwise. */
static struct topology_spec spec(enum topology_family f, int ndim, const int *dims)
{
    struct topology_spec s = {
        .family = f, .ndim = ndim, .nodes_per_router = 1, .processors_per_node = 1};
    for (int d = 0; d < ndim; d++) s.dims[d] = dims[d];
    return s;
}

/* The message of a network that cannot be has to name what is wrong with it. */
static void refused(const struct topology_spec *s, const char *word)
{
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    assert_null(topology_create(s, a, &e));
    assert_int_equal(e.kind, ERR_CONFIG);
    if (!strstr(e.text, word)) fail_msg("\"%s\" does not name \"%s\"", e.text, word);
    arena_destroy(a);
}

/* How many nodes are 0, 1, 2, ... links from `node`. */
static void count_distances(const struct topology *t, int node, int count[FARTHEST])
{
    memset(count, 0, FARTHEST * sizeof *count);
    for (int i = 0; i < t->nnode; i++) {
        int d = topology_distance(t, node, i);
        assert_in_range(d, 0, FARTHEST - 1);
        count[d]++;
    }
}

/* How many routes between all pairs of nodes use each link. */
static void count_loads(const struct topology *t, int load[MANY])
{
    assert_true(t->nlink <= MANY);
    memset(load, 0, MANY * sizeof *load);
    for (int i = 0; i < t->nnode; i++)
        for (int j = 0; j < t->nnode; j++) {
            struct hop route[FARTHEST];
            int n = topology_route(t, i, j, 0, route);
            for (int k = 0; k < n; k++) load[route[k].link]++;
        }
}

/* ---- HyperX */

/* At distance h: the sum over all choices of h dimensions of the product of S - 1. */
static void hyperx_distances_are_symmetric_sums(void **state)
{
    (void)state;
    static const int dims[4] = {5, 4, 3, 2};
    struct arena *a = arena_create();
    struct topology_spec s = spec(TOPOLOGY_HYPERX, 4, dims);
    struct topology *t = make(&s, a);
    int expected[5] = {1}, count[FARTHEST];
    for (int d = 0; d < 4; d++)
        for (int h = 4; h > 0; h--) expected[h] += expected[h - 1] * (dims[d] - 1);
    assert_int_equal(t->nrouter, 120);
    assert_int_equal(t->nlink, 120 * (4 + 3 + 2 + 1));
    assert_int_equal(t->max_hops, 4);
    for (int node = 0; node < 120; node += 17) {
        count_distances(t, node, count);
        for (int h = 0; h <= 4; h++) assert_int_equal(count[h], expected[h]);
    }
    arena_destroy(a);
}

/* From all to all, each link of dimension d carries what comes from the routers that agree with it
 * above d and goes to those that agree below: N / S_d pairs, on whichever dimension. */
static void hyperx_loads_are_even(void **state)
{
    (void)state;
    static const int dims[3] = {4, 3, 5};
    struct arena *a = arena_create();
    struct topology_spec s = spec(TOPOLOGY_HYPERX, 3, dims);
    struct topology *t = make(&s, a);
    static int load[MANY];
    count_loads(t, load);
    for (int l = 0, d = 0, left = 60 * 3; l < t->nlink; l++, left--) {
        if (left == 0) d++, left = 60 * (dims[d] - 1);
        assert_int_equal(load[l], 60 / dims[d]);
    }
    arena_destroy(a);
}

/* Of three cables each gets its share: the ends of the routes of one line name all alike. */
static void hyperx_bundles_share_what_they_carry(void **state)
{
    (void)state;
    static const int dims[2] = {3, 3};
    static int bundle[2] = {3, 1}, load[MANY];
    struct arena *a = arena_create();
    struct topology_spec s = spec(TOPOLOGY_HYPERX, 2, dims);
    s.nbundle = 2;
    s.bundle = bundle;
    s.nodes_per_router = 3;
    struct topology *t = make(&s, a);
    assert_int_equal(t->nlink, 9 * (2 * 3 + 2));
    assert_int_equal(t->nport, 8);
    count_loads(t, load);
    /* 9 sources' nodes times 3 x 3 pairs of routers on each line, over three cables */
    for (int l = 0; l < 9 * 6; l++) assert_int_equal(load[l], 3 * 9 / 3);
    for (int l = 9 * 6; l < t->nlink; l++) assert_int_equal(load[l], 3 * 9);
    arena_destroy(a);
}

static void hyperx_of_one_dimension_is_the_full_mesh(void **state)
{
    (void)state;
    static const int six[1] = {6};
    struct arena *a = arena_create();
    struct topology_spec s = spec(TOPOLOGY_HYPERX, 1, six), m = spec(TOPOLOGY_FULL_MESH, 1, six);
    struct topology *t = make(&s, a), *full = make(&m, a);
    assert_int_equal(t->nlink, full->nlink);
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            struct hop p[2], q[2];
            int n = topology_route(t, i, j, 0, p);
            assert_int_equal(n, topology_route(full, i, j, 0, q));
            if (n > 0) assert_memory_equal(&p[0], &q[0], sizeof p[0]);
        }
    arena_destroy(a);
}

static void hyperx_that_cannot_be_is_refused(void **state)
{
    (void)state;
    static int bundle[3] = {1, 1, 1};
    struct topology_spec s = spec(TOPOLOGY_HYPERX, 2, (int[]){4, 1});
    refused(&s, "dimension 1; expected at least 2");
    s = spec(TOPOLOGY_HYPERX, 2, (int[]){4, 4});
    s.nbundle = 3;
    s.bundle = bundle;
    refused(&s, "topology.bundle has 3 numbers for 2 dimensions");
    s = spec(TOPOLOGY_HYPERX, 3, (int[]){4096, 4096, 4096});
    refused(&s, "numbered");
    s = spec(TOPOLOGY_HYPERX, 0, NULL);
    refused(&s, "0 dimensions");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hyperx_distances_are_symmetric_sums),
        cmocka_unit_test(hyperx_loads_are_even),
        cmocka_unit_test(hyperx_bundles_share_what_they_carry),
        cmocka_unit_test(hyperx_of_one_dimension_is_the_full_mesh),
        cmocka_unit_test(hyperx_that_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
