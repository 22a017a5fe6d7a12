/* test_network_view.c - what a network costs, how long its cables are, and what is drawn of it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "study/network_view.h"

static struct machine_spec machine(enum topology_family f, int ndim, const int *dims)
{
    struct machine_spec m = {
        .name = "m",
        .topology = {.family = f, .ndim = ndim, .nodes_per_router = 1, .processors_per_node = 1},
        .network = {.link_bandwidth = 1e9}};
    for (int d = 0; d < ndim; d++) m.topology.dims[d] = dims[d];
    return m;
}

static struct network_view view(const struct machine_spec *m, struct arena *a)
{
    struct network_view v;
    struct err e;
    err_clear(&e);
    if (!network_view_make(&v, m, a, &e)) fail_msg("%s", e.text);
    return v;
}

static bool is(double x, double y) { return x >= y - 1e-9 && x <= y + 1e-9; }

/* A ring of 8 routers in racks of two, four racks in a square of 2 x 2, 3 m apart: four cables in
 * racks, three between neighbours (0-1, 1-3 would be two apart; the square's rows run alike). */
static void cables_follow_the_floor_plan(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct machine_spec m = machine(TOPOLOGY_TORUS, 1, (int[]){8});
    m.price = (struct price_spec){.rack_routers = 2, .rack_pitch = 3};
    struct network_view v = view(&m, a);
    assert_int_equal(v.nrack, 4);
    assert_true(is(network_view_length(&v, 0, 1), 1));
    assert_true(is(network_view_length(&v, 1, 2), 3 + 2));
    assert_true(is(network_view_length(&v, 3, 4), 6 + 2)); /* the second rack to the third */
    assert_true(is(network_view_length(&v, 0, 7), 6 + 2));
    /* four in racks, two of 5 m, two of 8 m, and a metre for each of eight nodes */
    assert_true(is(v.metres, 4 + 2 * 5 + 2 * 8 + 8));
    assert_true(is(v.price, 0));
    arena_destroy(a);
}

static void prices_are_those_of_routers_ports_and_cables(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct machine_spec m = machine(TOPOLOGY_FULL_MESH, 1, (int[]){4});
    m.topology.nodes_per_router = 2;
    m.price = (struct price_spec){
        .router = 1000, .port = 10, .cable = 1, .metre = 0.1, .router_power = 5, .port_power = 0.5};
    struct network_view v = view(&m, a);
    /* 6 cables between routers, 8 to nodes; a port at each end of the former */
    assert_int_equal(v.nport, 12 + 8);
    assert_true(is(v.price, 4000 + 200 + 14));
    assert_true(is(v.power, 20 + 10));
    assert_int_equal(v.nrack, 0);
    m.price.rack_routers = 4;
    v = view(&m, a);
    assert_true(is(v.metres, 14));
    assert_true(is(v.price, 4214 + 1.4));
    arena_destroy(a);
}

/* 16 cables of 1 GB/s; where dimensions have rates of their own, those of the cables that are
 * cut. */
static void the_cut_has_the_rate_of_its_cables(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct machine_spec m = machine(TOPOLOGY_TORUS, 2, (int[]){8, 4});
    assert_true(is(view(&m, a).bisection_bandwidth, 8e9));
    m.topology.dim_bandwidth[0] = 3e9;
    assert_true(is(view(&m, a).bisection_bandwidth, 24e9));
    m = machine(TOPOLOGY_CROSSBAR, 1, (int[]){4});
    assert_true(view(&m, a).bisection_bandwidth < 0);
    assert_null(view(&m, a).bisection_by);
    arena_destroy(a);
}

static bool take_first(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    (void)ncolumn, (void)name;
    text_add(context, "%s", value[0]);
    return false;
}

/* The one number that a query answers. */
static int64_t count(struct store *s, const char *sql)
{
    struct err e;
    struct text found = {0};
    err_clear(&e);
    assert_true(store_select(s, sql, 0, NULL, take_first, &found, &e));
    int64_t n = strtoll(found.s, NULL, 10);
    text_free(&found);
    return n;
}

/* A point for each router within the frame, a straight line or eight pieces for each pair. */
static void pictures_hold_every_router_and_cable(void **state)
{
    (void)state;
    static const struct {
        enum topology_family family;
        int ndim, dims[5], pieces;
    } drawn[] = {
        {TOPOLOGY_MESH, 2, {3, 3}, 12},
        {TOPOLOGY_TORUS, 2, {3, 3}, 12 + 6 * 8},
        {TOPOLOGY_TORUS, 1, {5}, 5},
        {TOPOLOGY_TORUS, 2, {2, 2}, 4}, /* two cables a pair are one line */
        {TOPOLOGY_HYPERCUBE, 1, {3}, 12 - 4 + 4 * 8},
        {TOPOLOGY_HYPERX, 2, {3, 2}, 7 + 2 * 8},
        {TOPOLOGY_FAT_TREE, 2, {2, 3}, 16},
        {TOPOLOGY_DRAGONFLY_PLUS, 5, {1, 2, 2, 1, 3}, 12 + 3},
        {TOPOLOGY_CROSSBAR, 1, {4}, 0},
    };
    for (size_t i = 0; i < sizeof drawn / sizeof *drawn; i++) {
        struct arena *a = arena_create();
        struct err e;
        err_clear(&e);
        struct machine_spec m = machine(drawn[i].family, drawn[i].ndim, drawn[i].dims);
        struct network_view v = view(&m, a);
        struct store *s = store_open("picture", STORE_MEMORY, &e);
        assert_true(network_view_tables(&v, s, a, &e));
        assert_int_equal(count(s, "SELECT count(*) FROM temp.topology_router"
                                  " WHERE abs(x) < 1.001 AND abs(y) < 1.001"),
                         v.measure.nrouter);
        assert_int_equal(count(s, "SELECT count(DISTINCT format('%.6f %.6f', x, y))"
                                  " FROM temp.topology_router"),
                         v.measure.nrouter);
        assert_int_equal(count(s, "SELECT count(*) FROM temp.topology_line"), drawn[i].pieces);
        store_close(s);
        arena_destroy(a);
    }
}

/* 64 routers all joined are 2,016 lines; 128 are 8,128, of which those of every fourth are drawn.
 */
static void crowded_pictures_are_thinned_and_huge_ones_refused(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct machine_spec m = machine(TOPOLOGY_FULL_MESH, 1, (int[]){128});
    struct network_view v = view(&m, a);
    struct store *s = store_open("picture", STORE_MEMORY, &e);
    assert_true(network_view_tables(&v, s, a, &e));
    assert_int_equal(count(s, "SELECT every FROM temp.topology_about"), 4);
    assert_int_equal(count(s, "SELECT pairs FROM temp.topology_about"), 8128);
    assert_int_equal(count(s, "SELECT count(*) FROM temp.topology_line"), 127 * 32 - 4 * 31 * 16);
    m = machine(TOPOLOGY_TORUS, 2, (int[]){100, 100});
    v = view(&m, a);
    assert_false(network_view_tables(&v, s, a, &e));
    assert_non_null(strstr(e.text, "10000 routers are too many for a picture"));
    store_close(s);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cables_follow_the_floor_plan),
        cmocka_unit_test(prices_are_those_of_routers_ports_and_cables),
        cmocka_unit_test(the_cut_has_the_rate_of_its_cables),
        cmocka_unit_test(pictures_hold_every_router_and_cable),
        cmocka_unit_test(crowded_pictures_are_thinned_and_huge_ones_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
