/* test_netcheck_reading.c - reference cases as they stand in files: keys, values, names of routing
 * rules, networks router by router; what is wrong is told at its line. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/refused.h"
#include "../support/folder_fixture.h"
#include "base/random.h"
#include "base/text.h"
#include "machine/topology.h"
#include "study/netcheck_case.h"
#include "study/netcheck_reference.h"

struct fixture {
    struct folder_fixture in;
    struct netcheck n;
    struct netcheck_reader r;
};

static int begin(void **state)
{
    struct fixture *f = folder_of(sizeof *f, "cases.json");
    f->r = (struct netcheck_reader){
        .n = &f->n, .path = f->in.path, .rows = f->in.a, .arena = f->in.a, .e = &f->in.e};
    *state = f;
    return 0;
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, drop_folder)

static void refused(struct fixture *f, enum err_kind kind, int line, const char *part)
{
    is_refused_at(&f->in.e, kind, line, part);
}

static void put_file(struct fixture *f, const char *name, const char *text)
{
    char path[300];
    FILE *out = fopen(scratch_path(path, sizeof path, f->in.folder, name), "wb");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

/* A case as the reader gets it: read as data. */
static const struct node *a_case(struct fixture *f, const char *text)
{
    put_file(f, "cases.json", text);
    const struct node *c = document_read(f->in.path, f->in.a, &f->in.e);
    if (c == NULL) fail_msg("%s", f->in.e.text);
    return c;
}

/* ---- values ---- */

static void integers_are_within_their_bounds(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *text;
        int value; /* -1: refused */
    } row[] = {{"{\"k\": 2}", 2},    {"{\"k\": 9}", 9},     {"{\"k\": 1}", -1},
               {"{\"k\": 10}", -1},  {"{\"k\": 2.5}", -1},  {"{\"k\": \"2\"}", -1},
               {"{\"k\": null}", 7}, {"{\"other\": 5}", 7}, {"{\"k\": 1e99}", -1},
               {"{\"k\": [2]}", -1}, {"{\"k\": 3.0}", 3}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        int value = 0;
        const bool read = netcheck_integer(&f->r, a_case(f, row[i].text), "k", 2, 9, 7, &value);
        if (read != (row[i].value >= 0)) fail_msg("%s", row[i].text);
        if (read) assert_int_equal(value, row[i].value);
        else refused(f, ERR_DATA, 1, "k");
    }
}

static void truths_and_words_are_nothing_else(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *text;
        int truth;        /* -1: refused */
        const char *word; /* NULL: refused */
    } row[] = {
        {"{\"k\": true}", 1, "true"}, {"{\"k\": false}", 0, "false"},  {"{}", 0, ""},
        {"{\"k\": 1}", -1, NULL},     {"{\"k\": \"yes\"}", -1, "yes"}, {"{\"k\": {}}", -1, NULL}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const struct node *c = a_case(f, row[i].text);
        bool truth = false;
        const char *word = NULL;
        assert_int_equal(netcheck_truth(&f->r, c, "k", &truth), row[i].truth >= 0);
        if (row[i].truth < 0) refused(f, ERR_DATA, 1, "'k' must be true or false");
        else assert_int_equal(truth, row[i].truth);
        assert_int_equal(netcheck_word(&f->r, c, "k", &word), row[i].word != NULL);
        if (row[i].word == NULL) refused(f, ERR_DATA, 1, "'k' must be a text");
        else assert_string_equal(word, row[i].word);
    }
}

/* ---- forms ---- */

static void forms_are_told_by_one_key_each(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *text;
        enum netcheck_form form;
        bool referred;
    } row[] = {
        {"{\"topology\": \"mesh4x4\", \"pattern\": \"shift\", \"distance\": 1, \"flits\": 4}",
         NETCHECK_STEP, false},
        {"{\"topology\": \"mesh4x4\", \"pattern\": \"shift\", \"distance\": 1, \"flits\": 4, "
         "\"makespan\": 9}",
         NETCHECK_STEP, true},
        /* a number of messages tells no case by hand */
        {"{\"topology\": \"mesh4x4\", \"pattern\": \"shift\", \"distance\": 1, \"flits\": 4, "
         "\"messages\": 4}",
         NETCHECK_STEP, false},
        {"{\"topology\": \"mesh4x4\", \"trace\": {}, \"distance\": 1}", NETCHECK_LIST, false},
        {"{\"topology\": \"mesh4x4\", \"trace\": {}, \"messages\": 4, \"completion\": []}",
         NETCHECK_LIST, true},
        {"{\"topology\": \"mesh4x4\", \"messages\": [], \"expected\": []}", NETCHECK_HAND, true},
        {"{\"topology\": \"mesh4x4\", \"pattern\": \"uniform\", \"packet_flits\": 1, \"points\": "
         "[]}",
         NETCHECK_LOAD, true},
        {"{\"topology\": \"mesh4x4\", \"pattern\": \"uniform\", \"packet_flits\": 1, "
         "\"saturation_low\": 0.4}",
         NETCHECK_SATURATION, true},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        enum netcheck_form form;
        bool referred = false;
        if (!netcheck_form_of(&f->r, a_case(f, row[i].text), &form, &referred))
            fail_msg("%s: %s", row[i].text, f->in.e.text);
        assert_int_equal(form, row[i].form);
        assert_int_equal(referred, row[i].referred);
    }
    assert_int_equal(f->n.nignored, 1);
    assert_string_equal(f->n.ignored[0], "messages");
}

static void keys_that_are_missing_or_misspelt_are_told(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *text, *part;
        int line;
    } row[] = {
        {"{\n\"topology\": \"mesh4x4\",\n\"patern\": \"shift\",\n\"distance\": 1,\n\"flits\": 4}",
         "did you mean 'pattern'", 3},
        {"{\"topology\": \"mesh4x4\", \"distance\": 1, \"flits\": 4}", "pattern", 1},
        {"{\"topology\": \"mesh4x4\"}", "no known form", 1},
        {"{\"a\": 1, \"b\": 2, \"c\": 3, \"d\": 4}", "no known form", 1},
        {"[1, 2]", "no known form", 1},
        /* what tells the form is misspelt: the form that it was meant to be tells the key */
        {"{\"topology\": \"mesh4x4\", \"pattern\": \"shift\",\n\"distence\": 1, \"flits\": 4, "
         "\"vcs\": 2}",
         "did you mean 'distance'", 2},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        enum netcheck_form form;
        bool referred;
        assert_false(netcheck_form_of(&f->r, a_case(f, row[i].text), &form, &referred));
        refused(f, ERR_DATA, row[i].line, row[i].part);
    }
}

/* Each key once, as many as there is room for; remarks are noted, too. */
static void what_is_compared_with_nothing_is_noted(void **state)
{
    struct fixture *f = *state;
    static const char head[] =
        "{\"topology\": \"mesh4x4\", \"pattern\": \"shift\", \"distance\": 1, "
        "\"flits\": 4";
    enum netcheck_form form;
    bool referred;
    struct text t = {0};
    text_add(&t, "%s, \"note\": \"n\", \"zzqq\": 1}", head);
    for (int i = 0; i < 3; i++)
        assert_true(netcheck_form_of(&f->r, a_case(f, t.s), &form, &referred));
    assert_int_equal(f->n.nignored, 2);
    assert_string_equal(f->n.ignored[0], "note");
    assert_string_equal(f->n.ignored[1], "zzqq");
    text_free(&t);
    text_add(&t, "%s", head);
    for (int i = 0; i < NETCHECK_MOST_IGNORED + 5; i++) text_add(&t, ", \"zzqq%dzz\": 1", 100 + i);
    text_add(&t, "}");
    assert_true(netcheck_form_of(&f->r, a_case(f, t.s), &form, &referred));
    assert_int_equal(f->n.nignored, NETCHECK_MOST_IGNORED);
    text_free(&t);
}

static void a_case_with_answers_says_all_of_them(void **state)
{
    struct fixture *f = *state;
    static const char *const key[] = {"topology",         "pattern", "distance", "flits",     "vcs",
                                      "buf_flits_per_vc", "tie",     "makespan", "completion"};
    enum { KEYS = sizeof key / sizeof *key };
    for (int without = -1; without < KEYS; without++) {
        struct text t = {0};
        text_add(&t, "{");
        for (int i = 0; i < KEYS; i++)
            if (i != without)
                text_add(&t, "%s\"%s\": %s", t.length > 1 ? ", " : "", key[i],
                         i < 2 ? "\"x\"" : "1");
        text_add(&t, "}");
        const struct node *c = a_case(f, t.s);
        const bool complete = netcheck_keys_complete(&f->r, c, NETCHECK_STEP, true);
        assert_int_equal(complete, without < 0);
        if (!complete) refused(f, ERR_DATA, 1, key[without]);
        /* a case that is played needs what says what is sent, and no more */
        assert_int_equal(netcheck_keys_complete(&f->r, c, NETCHECK_STEP, false),
                         without < 0 || without > 3);
        err_clear(&f->in.e);
        text_free(&t);
    }
}

/* A key that the first case of a form has is not dropped in a later one, nor added. */
static void cases_of_a_form_are_alike(void **state)
{
    struct fixture *f = *state;
    static const char head[] =
        "\"topology\": \"x\", \"pattern\": \"x\", \"distance\": 1, \"flits\": 1,"
        " \"vcs\": 1, \"buf_flits_per_vc\": 1, \"tie\": 1, \"makespan\": 1, "
        "\"completion\": []";
    static const struct {
        const char *more, *part;
    } row[] = {{", \"nodes\": 4", NULL},
               {", \"nodes\": 5", NULL},
               {"", "'nodes' is missing, but earlier cases have it"},
               {", \"nodes\": 4, \"max_hops\": 3", "'max_hops' is given here"}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct text t = {0};
        text_add(&t, "{%s%s}", head, row[i].more);
        const bool alike = netcheck_keys_complete(&f->r, a_case(f, t.s), NETCHECK_STEP, true);
        assert_int_equal(alike, row[i].part == NULL);
        if (!alike) refused(f, ERR_DATA, 1, row[i].part);
        text_free(&t);
    }
}

static void nothing_else_belongs_to_a_message(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *text, *part; /* part NULL: taken */
        bool trace, referred;
    } row[] = {
        {"{\"src\": 0, \"dst\": 1, \"flits\": 1}", NULL, false, false},
        {"{\"src\": 0, \"dst\": 1, \"flits\": 1}", "'t'", false, true},
        {"{\"src\": 0, \"dst\": 1, \"flits\": 1, \"t\": 0}", NULL, false, true},
        {"{\"src\": 0, \"dst\": 1, \"flits\": 1, \"zzqq\": 0}", "of a message", false, false},
        {"{\"src\": 0, \"dst\": 1, \"flits\": 1, \"note\": 0}", "'note'", false, false},
        {"{\"src\": 0, \"dst\": 1}", "flits", false, false},
        {"{\"src\": [], \"dst\": [], \"flits\": []}", NULL, true, false},
        {"{\"src\": [], \"dst\": [], \"flits\": [], \"time\": []}", "delay", true, true},
        {"{\"src\": [], \"dst\": [], \"flits\": [], \"dep\": []}", "did you mean 'deps'", true,
         false},
        {"[]", "expected keys with values", true, false},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const struct node *c = a_case(f, row[i].text);
        const bool taken = row[i].trace ? netcheck_keys_of_trace(&f->r, c, row[i].referred)
                                        : netcheck_keys_of_message(&f->r, c, row[i].referred);
        if (taken != (row[i].part == NULL)) fail_msg("%s", row[i].text);
        if (!taken) refused(f, ERR_DATA, 1, row[i].part);
    }
    /* a point without a stable state has no values */
    assert_true(netcheck_keys_of_point(&f->r, a_case(f, "{\"offered\": 1, \"unstable\": true}")));
    assert_false(netcheck_keys_of_point(&f->r, a_case(f, "{\"offered\": 1, \"unstable\": false}")));
    refused(f, ERR_DATA, 1, "plat");
    assert_false(netcheck_keys_of_point(&f->r, a_case(f, "{\"offered\": 1, \"unstable\": 1}")));
    refused(f, ERR_DATA, 1, "true or false");
}

/* ---- networks of the reference ---- */

static void rules_have_names_on_their_networks(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *name;
        enum topology_family family;
        int rule; /* -1: refused */
    } row[] = {
        {"dor", TOPOLOGY_MESH, ROUTING_BOOKSIM_DIM_ORDER},
        {"dim_order", TOPOLOGY_TORUS, ROUTING_BOOKSIM_DIM_ORDER},
        {"min", TOPOLOGY_HYPERX, ROUTING_BOOKSIM_DIM_ORDER},
        {"min", TOPOLOGY_DRAGONFLY, ROUTING_BOOKSIM_MIN},
        {"nca", TOPOLOGY_FAT_TREE, ROUTING_NCA},
        {"nca", TOPOLOGY_MESH, -1},
        {"ran_min", TOPOLOGY_HYPERX, ROUTING_BOOKSIM_DIM_ORDER},
        {"ran_min", TOPOLOGY_MESH, -1},
        {"xyyx", TOPOLOGY_HYPERX, ROUTING_XY_YX},
        {"xyyx", TOPOLOGY_MESH, -1},
        {"xy_yx", TOPOLOGY_MESH, ROUTING_XY_YX},
        {"", TOPOLOGY_MESH, -1},
        {"DOR", TOPOLOGY_MESH, -1},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        enum routing_rule rule;
        const bool known = netcheck_routing(row[i].name, row[i].family, &rule, &f->in.e);
        assert_int_equal(known, row[i].rule >= 0);
        if (known) assert_int_equal(rule, row[i].rule);
        else refused(f, ERR_UNAVAILABLE, 0, "is not supported; known:");
    }
}

static void routers_are_read_line_by_line(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *text;
        int routers, links, nodes;
    } row[] = {
        {"router 0 node 0 router 1\nrouter 1 node 1 router 0\n", 2, 1, 1},
        {"router 0 node 0 router 1\nrouter 1 node 1 router 0", 2, 1, 1},
        {"router 0 node 0 node 1 router 1 router 2\nrouter 1 node 2 node 3 router 0\n"
         "router 2 node 4 node 5 router 0\n",
         3, 2, 2},
        /* the same with other blanks and line ends, which end a line all the same */
        {"router 0 node 0 router 1 \r\nrouter 1 node 1 router 2\t\r\nrouter 2 node 2\r\n", 3, 2, 1},
        {"\nrouter  0\tnode 0 router 1\n\nrouter 1 node 1\n\n", 2, 1, 1},
        /* a router is not its own neighbour */
        {"router 0 node 0 router 0 router 1\nrouter 1 node 1\n", 2, 1, 1},
        {"router 1 node 0\nrouter 0 node 1 router 1\n", 2, 1, 1},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct topology_spec s;
        if (!netcheck_routers_read("net.txt", row[i].text, f->in.a, &s, &f->in.e))
            fail_msg("%d: %s", (int)i, f->in.e.text);
        assert_int_equal(s.family, TOPOLOGY_GRAPH);
        assert_int_equal(s.dims[0], row[i].routers);
        assert_int_equal(s.nlink, row[i].links);
        assert_int_equal(s.nodes_per_router, row[i].nodes);
        for (int k = 0; k < s.nlink; k++)
            assert_true(s.link[k][0] < s.link[k][1] && s.link[k][1] < s.dims[0]);
    }
}

static void wrong_routers_are_told_with_their_line(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *text, *part;
        int line;
    } row[] = {
        {"router 0 node 0 router 1\nrouter 1 router 0\n", "0 nodes on a router; expected 1", 2},
        {"router 0 node 0 router 1\nrouter 1 node 1 node 2\n", "2 nodes on a router", 2},
        {"router 0 node 0\nswitch 1 node 1\n", "'switch'; expected 'router' or 'node'", 2},
        {"router 0 node 0 router\n1 node 1\n", "expected 'router R node N", 1},
        {"router 0 node\n0 router 1\n", "expected 'router R node N", 1},
        {"router -1 node 0\n", "expected 'router R node N", 1},
        {"router x\n", "expected 'router R node N", 1},
        {"router 0 node 0\nrouter 1 node 1\n", "0 cables", 1},
        {"", "0 cables", 1},
        {"router 0 node 0 router 1048576\n", "expected less than 1048576", 1},
        {"router 0 node 0\nrouter 99999999999999999999 node 1 router 0\n", "router", 2},
        {"router 0 node 0 router 2147483647\n", "router", 1},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct topology_spec s;
        if (netcheck_routers_read("net.txt", row[i].text, f->in.a, &s, &f->in.e))
            fail_msg("%s was taken", row[i].text);
        assert_string_equal(f->in.e.file, "net.txt");
        refused(f, ERR_DATA, row[i].line, row[i].part);
    }
}

/* Random graphs, written in any order of lines and neighbours. */
static void cables_are_those_of_both_lines(void **state)
{
    struct fixture *f = *state;
    enum { MOST = 12 };
    struct random x = random_make(31, 0, 0);
    for (int round = 0; round < 100; round++) {
        const int n = 2 + (int)random_below(&x, MOST - 1), each = (int)random_below(&x, 3) + 1;
        bool joined[MOST + 1][MOST + 1] = {{false}};
        int order[MOST + 1], links = 0;
        struct text t = {0};
        struct topology_spec s;
        for (int i = 0; i < n; i++) order[i] = i;
        for (int i = n - 1; i > 0; i--) {
            const int k = (int)random_below(&x, (uint64_t)i + 1), kept = order[i];
            order[i] = order[k];
            order[k] = kept;
            joined[i - 1][i] = joined[i][i - 1] = true;
        }
        for (int k = 0; k < n; k++) {
            const int i = (int)random_below(&x, (uint64_t)n),
                      j = (int)random_below(&x, (uint64_t)n);
            if (i != j) joined[i][j] = joined[j][i] = true;
        }
        for (int k = 0; k < n; k++) {
            text_add(&t, "router %d", order[k]);
            for (int i = 0; i < each; i++) text_add(&t, " node %d", order[k] * each + i);
            for (int i = n - 1; i >= 0; i--)
                if (joined[order[k]][i]) text_add(&t, " router %d", i);
            text_add(&t, "\n");
        }
        if (!netcheck_routers_read("net.txt", t.s, f->in.a, &s, &f->in.e))
            fail_msg("%s", f->in.e.text);
        assert_int_equal(s.dims[0], n);
        for (int k = 0; k < s.nlink; k++) {
            assert_true(joined[s.link[k][0]][s.link[k][1]]);
            joined[s.link[k][0]][s.link[k][1]] = false; /* once each */
        }
        for (int i = 0; i < n; i++)
            for (int j = i + 1; j < n; j++) links += joined[i][j];
        assert_int_equal(links, 0);
        text_free(&t);
    }
}

static bool reference(struct fixture *f, const char *topology, const char *kind, const char *params,
                      struct netcheck_reference *out)
{
    struct text t = {0};
    text_add(&t,
             "{\"topology\": \"%s\", \"routing_function\": \"min\", \"topology_params\": "
             "{\"topology\": \"%s\"%s%s}}",
             topology, kind, params[0] != '\0' ? ", " : "", params);
    const bool ok = netcheck_reference(&f->r, a_case(f, t.s), out, &f->in.e);
    text_free(&t);
    return ok;
}

static void concentrated_networks_are_numbered_in_blocks(void **state)
{
    struct fixture *f = *state;
    struct netcheck_reference n;
    if (!reference(f, "cmesh", "cmesh", "\"k\": 3, \"n\": 2, \"c\": 4, \"xr\": 2, \"yr\": 2", &n))
        fail_msg("%s", f->in.e.text);
    assert_int_equal(n.topology.family, TOPOLOGY_MESH);
    assert_int_equal(n.topology.nodes_per_router, 4);
    assert_int_equal(n.topology.ndim, 2);
    assert_string_equal(n.digits, "(6,2)");
    /* a grid of 6 x 6 nodes of which each router has a block of 2 x 2 */
    bool seen[36] = {false};
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 6; x++) {
            const int node = n.node[6 * y + x];
            assert_in_range(node, 0, 35);
            assert_int_equal(node / 4, y / 2 * 3 + x / 2);
            assert_false(seen[node]);
            seen[node] = true;
        }
    if (!reference(f, "flatfly", "flatfly", "\"k\": 4, \"n\": 3, \"c\": 2", &n))
        fail_msg("%s", f->in.e.text);
    assert_int_equal(n.topology.family, TOPOLOGY_HYPERX);
    assert_null(n.node);
    static const char *const wrong[] = {
        "\"k\": 1, \"n\": 2, \"c\": 4, \"xr\": 2, \"yr\": 2",
        "\"k\": 4, \"n\": 2, \"c\": 4, \"xr\": 4, \"yr\": 2",
        "\"k\": 4096, \"n\": 2, \"c\": 1",
        "\"k\": 2, \"n\": 4096, \"c\": 1",
        "\"k\": 2, \"n\": 0, \"c\": 1",
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        if (reference(f, "cmesh", "cmesh", wrong[i], &n)) fail_msg("%s was taken", wrong[i]);
        refused(f, ERR_DATA, 1, "");
    }
}

/* A network of its own stands beside the cases, under its name or a beginning of it. */
static void arbitrary_networks_are_files_beside_the_case(void **state)
{
    struct fixture *f = *state;
    struct netcheck_reference n;
    put_file(f, "ours_small.txt", "router 0 node 0 router 1\nrouter 1 node 1\n");
    put_file(f, "bad.txt", "router 0 node 0\nbroken\n");
    assert_true(reference(f, "ours_small", "anynet", "", &n));
    assert_int_equal(n.topology.family, TOPOLOGY_GRAPH);
    assert_true(reference(f, "ours_small_k2", "anynet", "", &n));
    assert_int_equal(n.topology.dims[0], 2);
    assert_false(reference(f, "ours", "anynet", "", &n));
    refused(f, ERR_UNAVAILABLE, 0, "no file ours.txt beside it");
    assert_false(reference(f, "ours_smaller", "anynet", "", &n));
    refused(f, ERR_UNAVAILABLE, 0, "no file ours_smaller.txt beside it");
    assert_false(reference(f, "../ours_small", "anynet", "", &n));
    refused(f, ERR_DATA, 0, "without '/'");
    assert_false(reference(f, "bad", "anynet", "", &n));
    refused(f, ERR_DATA, 2, "expected 'router R");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(integers_are_within_their_bounds),
        TEST(truths_and_words_are_nothing_else),
        TEST(forms_are_told_by_one_key_each),
        TEST(keys_that_are_missing_or_misspelt_are_told),
        TEST(what_is_compared_with_nothing_is_noted),
        TEST(a_case_with_answers_says_all_of_them),
        TEST(cases_of_a_form_are_alike),
        TEST(nothing_else_belongs_to_a_message),
        TEST(rules_have_names_on_their_networks),
        TEST(routers_are_read_line_by_line),
        TEST(wrong_routers_are_told_with_their_line),
        TEST(cables_are_those_of_both_lines),
        TEST(concentrated_networks_are_numbered_in_blocks),
        TEST(arbitrary_networks_are_files_beside_the_case),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
