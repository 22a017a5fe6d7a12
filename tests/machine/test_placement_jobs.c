/* test_placement_jobs.c - which processors several jobs get, worked out by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/arena.h"
#include "machine/placement_jobs.h"

enum { MOST = 4 };

struct case_of_jobs {
    struct machine_spec m;
    struct placement_spec spec[MOST];
    struct placement_job job[MOST];
    struct placement p[MOST];
    int n;
    struct arena *a;
    struct err e;
};

static struct case_of_jobs on(enum topology_family family, int ndim, const int *dims, int npr,
                              int per_node)
{
    struct case_of_jobs c = {.m = {.name = "test"}, .a = arena_create()};
    c.m.topology = (struct topology_spec){.family = family, .ndim = ndim, .nodes_per_router = npr,
                                          .processors_per_node = per_node};
    for (int d = 0; d < ndim; d++) c.m.topology.dims[d] = dims[d];
    return c;
}

static void add(struct case_of_jobs *c, int nrank, enum placement_kind kind, int *list, int nlist)
{
    static const char *const name[] = {"a", "b", "c", "d"};
    const int i = c->n++;
    c->spec[i] = (struct placement_spec){.kind = kind, .seed = 7, .list = list, .nlist = nlist};
    c->job[i] = (struct placement_job){name[i], NULL, nrank};
}

static bool place(struct case_of_jobs *c)
{
    err_clear(&c->e);
    struct topology *t = topology_create(&c->m.topology, c->a, &c->e);
    assert_non_null(t);
    for (int i = 0; i < c->n; i++) c->job[i].spec = &c->spec[i];
    return placement_create_jobs(c->p, &c->m, t, c->n, c->job, c->a, &c->e);
}

/* The processors of job i, counted over the machine, one after the other. */
static void lies_on(const struct case_of_jobs *c, int i, const int *expected)
{
    const int per_node = c->m.topology.processors_per_node;
    for (int r = 0; r < c->job[i].nrank; r++)
        assert_int_equal(c->p[i].node[r] * per_node + c->p[i].processor[r], expected[r]);
}

static void jobs_take_what_is_left_in_their_order(void **state)
{
    (void)state;
    static const int dims[] = {8};
    int list[] = {1, 6, 7};
    struct case_of_jobs c = on(TOPOLOGY_MESH, 1, dims, 1, 1);
    add(&c, 3, PLACEMENT_LINEAR, NULL, 0);
    add(&c, 2, PLACEMENT_LINEAR, NULL, 0);
    add(&c, 2, PLACEMENT_LIST, list, 3); /* served first, whatever its place in the file */
    assert_true(place(&c));
    lies_on(&c, 0, (const int[]){0, 2, 3});
    lies_on(&c, 1, (const int[]){4, 5});
    lies_on(&c, 2, (const int[]){1, 6});
    arena_destroy(c.a);
}

static void each_job_has_its_own_order(void **state)
{
    (void)state;
    static const int dims[] = {3, 3};
    struct case_of_jobs c = on(TOPOLOGY_MESH, 2, dims, 1, 2);
    add(&c, 4, PLACEMENT_SNAKE, NULL, 0);
    add(&c, 4, PLACEMENT_LINEAR, NULL, 0);
    c.spec[0].spread = SPREAD_CYCLIC;
    assert_true(place(&c));
    lies_on(&c, 0, (const int[]){0, 2, 4, 10}); /* one on each node, the second line backwards */
    lies_on(&c, 1, (const int[]){1, 3, 5, 6});
    arena_destroy(c.a);
}

static void chance_draws_from_what_is_free_and_follows_the_seed(void **state)
{
    (void)state;
    static const int dims[] = {16};
    bool other = false;
    for (int seed = 1; seed < 20; seed++) {
        struct case_of_jobs c = on(TOPOLOGY_MESH, 1, dims, 1, 1), again;
        add(&c, 6, PLACEMENT_LINEAR, NULL, 0);
        add(&c, 10, PLACEMENT_RANDOM, NULL, 0);
        c.spec[1].seed = (uint64_t)seed;
        again = c;
        again.a = arena_create();
        assert_true(place(&c) && place(&again));
        int seen[16] = {0};
        for (int r = 0; r < 10; r++) {
            assert_in_range(c.p[1].node[r], 6, 15);
            assert_int_equal(seen[c.p[1].node[r]]++, 0);
            assert_int_equal(c.p[1].node[r], again.p[1].node[r]);
            other = other || c.p[1].node[r] != 6 + r;
        }
        arena_destroy(c.a);
        arena_destroy(again.a);
    }
    assert_true(other);
}

/* A dragonfly of 5 groups with 2 x 4 nodes: parts of 2, 8 and 40. */
static void groups_are_the_smallest_parts_that_hold_a_job(void **state)
{
    (void)state;
    static const int dims[] = {2, 4, 1, 5};
    struct case_of_jobs c = on(TOPOLOGY_DRAGONFLY, 4, dims, 1, 1);
    add(&c, 5, PLACEMENT_GROUPS, NULL, 0);
    add(&c, 6, PLACEMENT_GROUPS, NULL, 0);
    add(&c, 3, PLACEMENT_GROUPS, NULL, 0);
    add(&c, 2, PLACEMENT_GROUPS, NULL, 0);
    assert_true(place(&c));
    lies_on(&c, 0, (const int[]){0, 1, 2, 3, 4});       /* a whole group has room */
    lies_on(&c, 1, (const int[]){8, 9, 10, 11, 12, 13}); /* not in the first any more */
    lies_on(&c, 2, (const int[]){5, 6, 7});             /* the fullest group with room */
    lies_on(&c, 3, (const int[]){14, 15});              /* the first router that is free */
    arena_destroy(c.a);
}

/* What no part holds takes whole parts, the emptiest first, and its rest the fullest that does. */
static void a_large_job_takes_as_few_groups_as_it_can(void **state)
{
    (void)state;
    static const int dims[] = {2, 4, 1, 5};
    struct case_of_jobs c = on(TOPOLOGY_DRAGONFLY, 4, dims, 1, 1);
    int here[] = {1, 9, 10, 11};
    add(&c, 4, PLACEMENT_LIST, here, 4);
    add(&c, 12, PLACEMENT_GROUPS, NULL, 0);
    assert_true(place(&c));
    lies_on(&c, 1, (const int[]){16, 17, 18, 19, 20, 21, 22, 23, 8, 12, 13, 14});
    arena_destroy(c.a);
}

static void parts_follow_the_family(void **state)
{
    (void)state;
    static const struct {
        enum topology_family family;
        int ndim, dims[5], npr, n;
        int64_t size[6];
    } row[] = {{TOPOLOGY_TORUS, 2, {4, 3}, 2, 3, {2, 8, 24}},
               {TOPOLOGY_HYPERCUBE, 1, {3}, 2, 4, {2, 4, 8, 16}},
               {TOPOLOGY_FAT_TREE, 2, {4, 2}, 1, 2, {4, 16}},
               {TOPOLOGY_DRAGONFLY, 4, {2, 4, 1, 5}, 1, 3, {2, 8, 40}},
               {TOPOLOGY_HYPERX, 2, {3, 5}, 1, 3, {1, 3, 15}},
               {TOPOLOGY_CROSSBAR, 1, {6}, 1, 1, {6}}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        int64_t size[PLACEMENT_LEVELS];
        struct case_of_jobs c = on(row[k].family, row[k].ndim, row[k].dims, row[k].npr, 1);
        err_clear(&c.e);
        struct topology *t = topology_create(&c.m.topology, c.a, &c.e);
        assert_non_null(t);
        assert_int_equal(placement_groups(t, size), row[k].n);
        for (int i = 0; i < row[k].n; i++) assert_int_equal(size[i], row[k].size[i]);
        arena_destroy(c.a);
    }
}

static void what_does_not_fit_is_told_with_the_job(void **state)
{
    (void)state;
    static const int dims[] = {8};
    int low[] = {0, 1, 2}, high[] = {5, 2, 7}, beyond[] = {8, 1, 2}, twice[] = {4, 5, 4};
    static const char *const told[] = {
        "jobs 'a' and 'b' overlap: rank 2 of one and rank 1 of the other on processor 2",
        "job 'b': placement.list: processor 8 of rank 0; expected 0 to 7",
        "placement.list: ranks 0 and 2 on processor 4",
        "job 'b': placement.list names 2 processors for 3 ranks",
        "job 'b': 6 ranks, but 5 of the 8 processors of machine test are free",
        "placement.kind gray needs a hypercube, not a mesh"};
    for (int k = 0; k < 6; k++) {
        struct case_of_jobs c = on(TOPOLOGY_MESH, 1, dims, 1, 1);
        add(&c, 3, PLACEMENT_LIST, low, 3);
        int *list = k == 0 ? high : k == 1 ? beyond : twice;
        if (k < 4) add(&c, 3, PLACEMENT_LIST, list, k == 3 ? 2 : 3);
        else add(&c, k == 4 ? 6 : 2, k == 4 ? PLACEMENT_GROUPS : PLACEMENT_GRAY, NULL, 0);
        assert_false(place(&c));
        assert_int_equal(c.e.kind, ERR_CONFIG);
        assert_non_null(strstr(c.e.text, told[k]));
        arena_destroy(c.a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_take_what_is_left_in_their_order),
        cmocka_unit_test(each_job_has_its_own_order),
        cmocka_unit_test(chance_draws_from_what_is_free_and_follows_the_seed),
        cmocka_unit_test(groups_are_the_smallest_parts_that_hold_a_job),
        cmocka_unit_test(a_large_job_takes_as_few_groups_as_it_can),
        cmocka_unit_test(parts_follow_the_family),
        cmocka_unit_test(what_does_not_fit_is_told_with_the_job),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
