/* test_netcheck.c - reference files: names and patterns understood, wrong files refused, statistics
 * and JSON right. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "../support/scratch.h"
#include "base/arena.h"
#include "base/text.h"
#include "io/document.h"
#include "study/netcheck.h"
#include "study/netcheck_case.h"

#define DATA MIMDSIM_SRCDIR "/tests/data/net/"

static void names_of_topologies_are_understood(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        enum topology_family family;
        int ndim, dims[4], nodes;
    } known[] = {
        {"mesh8x8", TOPOLOGY_MESH, 2, {8, 8}, 64},
        {"mesh1x8", TOPOLOGY_MESH, 2, {1, 8}, 8},
        {"torus4x4x8", TOPOLOGY_TORUS, 3, {4, 4, 8}, 128},
        {"native_torus8x8", TOPOLOGY_TORUS, 2, {8, 8}, 64},
        {"torus8x8_vc2", TOPOLOGY_TORUS, 2, {8, 8}, 64},
        {"torus_k4n3", TOPOLOGY_TORUS, 3, {4, 4, 4}, 64},
        {"mesh_k4_n2", TOPOLOGY_MESH, 2, {4, 4}, 16},
        {"8x4 torus", TOPOLOGY_TORUS, 2, {8, 4}, 32},
        {"ring12", TOPOLOGY_TORUS, 1, {12}, 12},
        {"hcube7", TOPOLOGY_HYPERCUBE, 1, {7}, 128},
        {"hypercube5", TOPOLOGY_HYPERCUBE, 1, {5}, 32},
        {"fattree_k4_n3", TOPOLOGY_FAT_TREE, 2, {4, 3}, 64},
        {"dragonfly_p2a4h2_72", TOPOLOGY_DRAGONFLY, 4, {2, 4, 2, 0}, 72},
        {"crossbar16", TOPOLOGY_CROSSBAR, 1, {16}, 16},
        {"fullmesh8", TOPOLOGY_FULL_MESH, 1, {8}, 8},
    };
    struct topology_spec s;
    struct err e;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        struct arena *a = arena_create();
        err_clear(&e);
        assert_true(netcheck_topology(known[i].name, 0, &s, &e));
        assert_int_equal(s.family, known[i].family);
        assert_int_equal(s.ndim, known[i].ndim);
        assert_memory_equal(s.dims, known[i].dims, (size_t)known[i].ndim * sizeof(int));
        struct topology *t = topology_create(&s, a, &e);
        assert_non_null(t);
        assert_int_equal(t->nnode, known[i].nodes);
        arena_destroy(a);
    }
    static const char *const unknown[] = {"", "klein-bottle8", "mesh", "fattree4"};
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
        err_clear(&e);
        assert_false(netcheck_topology(unknown[i], 0, &s, &e));
        assert_true(e.kind == ERR_DATA || e.kind == ERR_UNAVAILABLE);
    }
}

static void load(const char *topology, const char *pattern, double offered, struct traffic *q,
                 struct arena *a)
{
    struct err e;
    struct topology_spec *s = TAKE(a, 1, struct topology_spec);
    err_clear(&e);
    assert_true(netcheck_topology(topology, 0, s, &e));
    struct topology *t = topology_create(s, a, &e);
    if (!netcheck_load(pattern, t, 4, offered, 4000, 1, a, q, &e)) fail_msg("%s", e.text);
}

static void patterns_send_where_they_say(void **state)
{
    (void)state;
    static const struct {
        const char *pattern;
        int from, to; /* on 8 x 8: from 011001 = 25, column 1, row 3 */
    } fixed[] = {{"bitcomp", 25, 38},  {"bitrev", 25, 38},       {"transpose", 25, 11},
                 {"shuffle", 25, 50},  {"tornado(8,2)", 25, 52}, {"neighbor(8,2)", 25, 34},
                 {"shift(40)", 25, 1}, {"xor(38)", 25, 63}};
    struct arena *a = arena_create();
    struct traffic q;
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++) {
        int seen = 0;
        load("mesh8x8", fixed[i].pattern, 0.2, &q, a);
        for (int m = 0; m < q.nmessage; m++) {
            if (q.src[m] != fixed[i].from) continue;
            assert_int_equal(q.dst[m], fixed[i].to);
            seen++;
        }
        assert_true(seen > 100);
    }
    load("dragonfly_p2a4h2", "bad_dragon", 0.2, &q, a);
    for (int m = 0; m < q.nmessage; m++) assert_int_equal(q.dst[m] / 8, (q.src[m] / 8 + 1) % 9);
    arena_destroy(a);
}

static void loads_have_the_rate_asked_for(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct traffic q, again;
    load("mesh8x8", "uniform", 0.3, &q, a);
    load("mesh8x8", "uniform", 0.3, &again, a);
    double expected = 0.3 / 4 * 64 * 4000; /* 19,200 packets, standard deviation 133 */
    assert_true(q.nmessage > expected - 700 && q.nmessage < expected + 700);
    assert_int_equal(q.nmessage, again.nmessage);
    assert_memory_equal(q.dst, again.dst, (size_t)q.nmessage * sizeof(int));
    int to[64] = {0};
    for (int m = 0; m < q.nmessage; m++) {
        assert_in_range(q.time[m], 0, 4000 * NETCHECK_CYCLE_PS - 1);
        to[q.dst[m]]++;
    }
    for (int i = 0; i < 64; i++) assert_in_range(to[i], 200, 400);
    arena_destroy(a);
}

static void write_file(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void wrong_files_are_refused_and_odd_cases_told(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "",
        "{\"a\": 1}",
        "[]",
        "[{\"topology\": \"mesh8x8\"}]",
        "[{\"topology\": \"mesh8x8\", \"points\": [{}]}]",
        "[{\"topology\": \"mesh2x2\", \"pattern\": \"shift\", \"distance\": 1, \"flits\": 3, "
        "\"makespan\": 9, \"completion\": [1, 2]}]",
        "[{\"topology\": \"mesh2x2\", \"pattern\": \"spiral\", \"distance\": 1, \"flits\": 3, "
        "\"makespan\": 9, \"completion\": [1, 2, 3, 4]}]",
        "[{\"topology\": \"mesh2x2\", \"makespan\": 1, \"trace\": {\"src\": [0], \"flits\": [1]}, "
        "\"completion\": [1]}]"};
    char folder[256], path[300];
    scratch_make(folder, sizeof folder);
    scratch_path(path, sizeof path, folder, "cases.json");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct arena *a = arena_create();
        struct netcheck n;
        struct err e;
        err_clear(&e);
        write_file(path, wrong[i]);
        if (netcheck_run(&n, path, NULL, NULL, true, a, &e)) fail_msg("accepted: %s", wrong[i]);
        assert_int_equal(e.kind, ERR_DATA);
        assert_true(e.text[0]);
        arena_destroy(a);
    }
    /* a case of a network that we do not have is a row without answers, not the end of the
     * others */
    struct arena *a = arena_create();
    struct netcheck n;
    struct err e;
    err_clear(&e);
    write_file(path,
               "[{\"topology\": \"moebius8\", \"pattern\": \"shift\", \"distance\": 1, \"flits\": "
               "3}, {\"topology\": \"mesh2x2\", \"pattern\": \"shift\", \"distance\": 1, "
               "\"flits\": 3}]");
    assert_true(netcheck_run(&n, path, NULL, NULL, true, a, &e));
    assert_int_equal(n.nrow, 2);
    assert_false(n.row[0].answer[LEVEL_LINK].ran);
    assert_non_null(strstr(n.row[0].answer[LEVEL_LINK].why, "moebius8"));
    assert_true(n.row[1].played && n.row[1].answer[LEVEL_LINK].ran);
    unlink(path);
    err_clear(&e);
    assert_false(netcheck_run(&n, path, NULL, NULL, true, a, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    scratch_remove(folder);
    arena_destroy(a);
}

static void totals_count_what_the_rows_say(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck_row row[] = {
        {.group = "g", .nmessage = 10, .compared = true, .counted = true, .low = 100, .high = 100},
        {.group = "g", .nmessage = 30, .compared = true, .counted = true, .low = 100, .high = 100},
        {.group = "h", .nmessage = 5, .compared = false, .counted = true, .low = 90, .high = 110},
        {.group = "g", .nmessage = 5, .counted = false},
    };
    row[0].answer[LEVEL_LINK] =
        (struct netcheck_answer){.ran = true, .error = 0, .differing = 0, .message_error = 0};
    row[1].answer[LEVEL_LINK] =
        (struct netcheck_answer){.ran = true, .error = -0.2, .differing = 3, .message_error = 0.1};
    row[2].answer[LEVEL_LINK] = (struct netcheck_answer){.ran = false};
    row[3].answer[LEVEL_LINK] = (struct netcheck_answer){.ran = true, .error = 7};
    struct netcheck n = {.path = "made", .nrow = 4, .row = row};
    struct netcheck_total t = netcheck_total(&n, "g", LEVEL_LINK),
                          all = netcheck_total(&n, NULL, LEVEL_LINK);
    assert_int_equal(t.cases, 2);
    assert_int_equal(t.exact_cases, 1);
    assert_int_equal(t.messages, 40);
    assert_int_equal(t.exact, 37);
    assert_true(t.mean == 0.1 && t.worst == -0.2 && t.message_error == 0.05);
    assert_int_equal(all.cases, 2);
    assert_int_equal(all.skipped, 1);
    arena_destroy(a);
}

static void a_band_is_met_anywhere_inside(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    struct err e;
    bool level[LEVELS] = {[LEVEL_LINK] = true};
    err_clear(&e);
    assert_true(netcheck_run(&n, DATA "makespan_sensitivity.json", level, "mesh8x8", true, a, &e));
    assert_int_equal(n.nrow, 18);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_row *r = &n.row[i];
        const struct netcheck_answer *x = &r->answer[LEVEL_LINK];
        assert_true(r->low < r->high);
        assert_int_equal(x->error == 0, x->found >= r->low && x->found <= r->high);
        assert_false(r->answer[LEVEL_LOGGP].ran);
    }
    arena_destroy(a);
}

static void latencies_follow_the_reference(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct netcheck n;
    struct err e;
    bool level[LEVELS] = {[LEVEL_LINK] = true};
    err_clear(&e);
    assert_true(netcheck_run(&n, DATA "latency_load.json", level, "0.0100", true, a, &e));
    assert_true(n.nrow > 40);
    for (int i = 0; i < n.nrow; i++) {
        const struct netcheck_answer *x = &n.row[i].answer[LEVEL_LINK];
        assert_int_equal(x->ran, n.row[i].counted);
        if (x->ran && !(x->error > -0.06 && x->error < 0.06))
            fail_msg("%s: %g", n.row[i].name, x->error);
    }
    assert_true(netcheck_total(&n, NULL, LEVEL_LINK).mean < 0.02);
    arena_destroy(a);
}

static void json_reads_back(void **state)
{
    (void)state;
    char folder[256], path[300];
    struct arena *a = arena_create();
    struct err e;
    bool level[LEVELS] = {[LEVEL_LINK] = true};
    struct netcheck n;
    scratch_make(folder, sizeof folder);
    FILE *out = fopen(scratch_path(path, sizeof path, folder, "answers.json"), "w");
    err_clear(&e);
    assert_non_null(out);
    assert_true(netcheck_run(&n, DATA "hand_cases.json", level, NULL, true, a, &e));
    struct json j = json_make(out);
    netcheck_json_object(&n, -1, &j);
    json_finish(&j);
    fclose(out);
    const struct node *root = document_read(path, a, &e);
    assert_non_null(root);
    const struct node *cases = document_find(root, "cases"),
                      *totals = document_find(root, "totals");
    assert_true(cases && cases->count == 53 && totals && totals->count == 3);
    const struct node *answer = document_find(document_find(cases->child, "levels"), "link");
    double found;
    assert_true(document_number(answer, "found", path, &found, &e));
    assert_true(found == 8);
    scratch_remove(folder);
    arena_destroy(a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_of_topologies_are_understood),
        cmocka_unit_test(patterns_send_where_they_say),
        cmocka_unit_test(loads_have_the_rate_asked_for),
        cmocka_unit_test(wrong_files_are_refused_and_odd_cases_told),
        cmocka_unit_test(totals_count_what_the_rows_say),
        cmocka_unit_test(a_band_is_met_anywhere_inside),
        cmocka_unit_test(latencies_follow_the_reference),
        cmocka_unit_test(json_reads_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
