/* test_values.c - settings and ranges one at a time: what each key takes, what is refused and in
 * which words. */
#include "in_arena.h"

#include <math.h>

#include "base/random.h"
#include "plan/range.h"
#include "plan/setting.h"

static struct node *tree(const char *text)
{
    struct node *n = document_parse_settings(text, strlen(text), "t.yaml", a, &e);
    if (n == NULL) fail_msg("%s", e.text);
    return n;
}

/* ---- settings ---- */

static void keys_are_keys_groups_or_neither(void **state)
{
    (void)state;
    static const struct {
        const char *key;
        bool sets, group, maps;
    } row[] = {
        {"ranks", true, false, false},
        {"n_over_p", true, false, false},
        {"model.n", true, false, false},
        {"n", false, false, false}, /* a short name: setting_key says what it stands for */
        {"machine.name", true, false, false},
        {"machine.network.link.bandwidth", true, false, false},
        {"machine.network.link", false, true, false},
        {"machine.network", false, true, false},
        {"machine.net", false, false, false},
        {"machine.", false, false, false},
        {"machine", false, true, false},
        {"network", false, false, false},
        {"machine.title", false, false, false}, /* of its file alone */
        {"scenario", false, false, false},      /* filled in by the plan */
        {"label", true, false, false},
        {"machine.software.segments", true, false, true},
        {"software.segments", false, false, true}, /* as in machine files */
        {"machine.software", false, true, false},
        {"program", false, true, false},
        {"program.anything", true, false, false}, /* one that a program may declare */
        {"program.", false, false, false},
        {"program.a.b", false, false, false},
        {"programs.a", false, false, false},
        {"job.start", false, false, false}, /* what `jobs:` makes */
        {"", false, false, false},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        if (setting_is_key(row[i].key) != row[i].sets) fail_msg("%s: key", row[i].key);
        if (setting_is_group(row[i].key) != row[i].group) fail_msg("%s: group", row[i].key);
        if (setting_takes_maps(row[i].key) != row[i].maps) fail_msg("%s: maps", row[i].key);
    }
}

static void short_names_stand_for_whole_ones(void **state)
{
    (void)state;
    static const char *const pair[][2] = {{"n", "model.n"},
                                          {"level", "machine.network.level"},
                                          {"kernel", "kernel.name"},
                                          {"machine", "machine.name"},
                                          {"name", "label"},
                                          {"program", "program.file"},
                                          {"N", "N"},
                                          {"ranks", "ranks"}};
    for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
        assert_string_equal(setting_key(pair[i][0]), pair[i][1]);
        /* a whole name stands for itself */
        assert_string_equal(setting_key(pair[i][1]), pair[i][1]);
    }
}

static void each_text_is_a_setting_of_its_kind(void **state)
{
    (void)state;
    static const struct {
        const char *key, *text, *full;
        enum setting_kind kind;
    } row[] = {
        {"n", "8", "model.n", SETTING_FIELD},
        {"ranks", "8", "ranks", SETTING_FIELD},
        {"ranks", "n", "ranks", SETTING_RANKS_ARE_N},
        {"machine", "no such machine", "machine.name", SETTING_MACHINE},
        {"n_over_p", "1", "n_over_p", SETTING_N_OVER_P},
        {"n_over_p", "1048576", "n_over_p", SETTING_N_OVER_P},
        {"program.width", "anything at all", "program.width", SETTING_PARAMETER},
    };
    struct setting s;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        if (!setting_make(&s, row[i].key, row[i].text, "f", 3, a, &e)) fail_msg("%s", e.text);
        assert_int_equal(s.kind, row[i].kind);
        assert_string_equal(s.key, row[i].full);
        assert_int_equal(s.line, 3);
        assert_null(s.also);
        assert_true((s.field != NULL) == (s.kind == SETTING_FIELD));
    }
}

static void wrong_texts_are_told_with_key_and_value(void **state)
{
    (void)state;
    static const struct {
        const char *key, *text, *part;
    } row[] = {
        {"n_over_p", "0", "n_over_p: '0'"},
        {"n_over_p", "1048577", "1048577"},
        {"n_over_p", "1.5", "1.5"},
        {"n_over_p", "n", "'n'"},
        {"ranks", "N", "'N'"},
        {"ranks", "0", "'0'"},
        {"level", "linc", "link"},
        {"level", "auto-tolerance 0 s", "tolerance"},
        {"level", "auto-tolerancex", "auto-tolerance"},
        {"machine.network.link.bandwidth", "480", "480 MB/s"},
        {"machine.network.link.bandwidth", "480 ms", "480 ms"},
        {"machine.network.link.bandwidth", "", "''"},
        {"kernel.solver", "cr,pcr", "cr,pcr"},
        {"machine.title", "a", "machine.title"},
        {"scenario", "a", "scenario"},
        {"rank", "4", "did you mean 'ranks'"},
        {"program.a.b", "1", "program.a.b"},
    };
    struct setting s;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        if (setting_make(&s, row[i].key, row[i].text, "f", 7, a, &e))
            fail_msg("%s: %s was taken", row[i].key, row[i].text);
        assert_string_equal(e.file, "f");
        refused(ERR_DATA, 7, row[i].part);
    }
}

/* A rate of 0 has a word where it was meant as none; files of earlier versions still say 0. */
static void a_rate_of_zero_is_a_word(void **state)
{
    (void)state;
    struct setting s;
    const char *key = "machine.node.copy.bandwidth";
    assert_false(setting_make(&s, key, "0 B/s", "--set", 0, a, &e));
    refused(ERR_DATA, 0, "unlimited");
    assert_true(setting_make(&s, key, "unlimited", "--set", 0, a, &e));
    /* the remark of a file goes to standard error */
    assert_true(setting_make(&s, key, "0 B/s", "old.yaml", 4, a, &e));
    assert_int_equal(e.kind, ERR_NONE);
}

static void a_tolerance_beside_the_level_is_a_second_setting(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double tolerance; /* 0: none is written */
    } row[] = {{"auto-tolerance 2%", 0.02},
               {"auto-tolerance   0.5 %", 0.005},
               {"auto-tolerance", 0},
               {"auto-tolerance ", -1}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct setting s;
        struct run_spec run = {0};
        const bool made = setting_make(&s, "level", row[i].text, "f", 1, a, &e);
        assert_true(made == (row[i].tolerance >= 0));
        err_clear(&e);
        if (!made) continue;
        setting_apply(&s, &run, a);
        assert_true((s.also != NULL) == (row[i].tolerance > 0));
        assert_true(fabs(run.machine.network.tolerance - row[i].tolerance) <= 1e-15);
    }
}

/* Only fields act; what is resolved later changes nothing here. */
static void only_values_of_fields_are_applied(void **state)
{
    (void)state;
    static const char *const idle[][2] = {
        {"machine", "t3e-300"}, {"ranks", "n"}, {"n_over_p", "4"}, {"program.a", "1"}};
    struct setting s;
    struct run_spec run = {0}, before = run;
    for (size_t i = 0; i < sizeof idle / sizeof *idle; i++) {
        assert_true(setting_make(&s, idle[i][0], idle[i][1], "f", 1, a, &e));
        setting_apply(&s, &run, a);
        assert_memory_equal(&run, &before, sizeof run);
    }
    assert_true(setting_make(&s, "n", "17", "f", 1, a, &e));
    setting_apply(&s, &run, a);
    assert_int_equal(run.model.nbody, 17);
    run.model.nbody = before.model.nbody;
    assert_memory_equal(&run, &before, sizeof run);
}

static void a_list_keeps_order_and_takes_a_key_once(void **state)
{
    (void)state;
    struct setting_list list = {0};
    char name[SETTING_MOST + 1][24];
    assert_true(setting_list_add(&list, "n", "4", "f", 11, a, &e));
    /* by another of its names, with another value */
    assert_false(setting_list_add(&list, "model.n", "5", "f", 12, a, &e));
    refused(ERR_DATA, 12, "duplicate key 'model.n'; first given in line 11");
    assert_false(setting_list_add(&list, "ranks", "0", "f", 13, a, &e));
    err_clear(&e);
    assert_int_equal(list.n, 1);
    for (int i = 1; i <= SETTING_MOST; i++) {
        snprintf(name[i], sizeof name[i], "program.p%d", i);
        const bool room = i < SETTING_MOST;
        assert_true(setting_list_add(&list, name[i], "1", "f", 20 + i, a, &e) == room);
    }
    refused(ERR_DATA, 20 + SETTING_MOST, "too many settings");
    assert_int_equal(list.n, SETTING_MOST);
    for (int i = 1; i < SETTING_MOST; i++) {
        assert_string_equal(list.at[i].key, name[i]);
        assert_int_equal(list.at[i].line, 20 + i);
    }
}

/* What setting_walk visits: "key@line" of each leaf. */
static bool visit(void *context, const char *key, const struct node *leaf, const char *file,
                  struct arena *unused, struct err *why)
{
    struct text *t = context;
    (void)unused;
    text_add(t, "%s@%d ", key, leaf->line);
    return strcmp(key, "seed") != 0 || err_set_at(why, ERR_IO, file, leaf->line, "stop");
}

static void a_walk_visits_nested_and_dotted_keys(void **state)
{
    (void)state;
    static const struct {
        const char *prefix, *text, *seen, *why; /* why NULL: goes to the end */
        int line;
    } row[] = {
        {"", "n: 4\nranks: 2\n", "model.n@1 ranks@2 ", NULL, 0},
        {"", "kernel: {solver: cr}\n", "kernel.solver@1 ", NULL, 0},
        {"", "kernel: forward\n", "kernel.name@1 ", NULL, 0},
        {"", "machine.network:\n  level: link\n  link.bandwidth: 1 GB/s\n",
         "machine.network.level@2 machine.network.link.bandwidth@3 ", NULL, 0},
        /* a short name counts at the top alone */
        {"machine", "level: link\n", "", "unknown key 'level' in 'machine'", 1},
        {"machine.network", "level: link\n", "machine.network.level@1 ", NULL, 0},
        {"", "machine:\n  network: fast\n", "", "'machine.network' is a group", 2},
        {"", "n: 4\nmachine: {netwrok: {level: link}}\n", "model.n@1 ", "'network'", 2},
        {"", "n: 4\nseed: 3\nranks: 2\n", "model.n@1 seed@2 ", "stop", 2},
        {"", "scenario: mine\n", "", "scenario", 1},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct text seen = {0};
        const bool done =
            setting_walk(tree(row[i].text), row[i].prefix, "t.yaml", visit, &seen, a, &e);
        assert_string_equal(seen.s != NULL ? seen.s : "", row[i].seen);
        assert_true(done == (row[i].why == NULL));
        if (!done) refused(e.kind, row[i].line, row[i].why);
        text_free(&seen);
    }
    /* a key as long as no key can be */
    struct text longest = {0};
    for (int i = 0; i < 300; i++) text_add(&longest, "k");
    text_add(&longest, ": 1\n");
    assert_false(setting_walk(tree(longest.s), "machine", "t.yaml", visit, NULL, a, &e));
    refused(ERR_DATA, 1, "unknown key");
    text_free(&longest);
}

static void values_stand_plainly_in_lists_or_with_their_source(void **state)
{
    (void)state;
    static const struct {
        const char *text, *value; /* NULL: refused */
    } row[] = {
        {"k: 480 MB/s\n", "480 MB/s"},
        {"k: {value: 480 MB/s, class: P, source: \"a, b\"}\n", "480 MB/s"},
        {"k: [8, 4, 4]\n", "[8, 4, 4]"},
        {"k: {value: [8, [4, 4]]}\n", "[8, [4, 4]]"},
        {"k: {class: P}\n", NULL},
        {"k: {value: {a: 1}}\n", NULL},
        {"k: [{a: 1}]\n", NULL},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const struct node *leaf = document_find(tree(row[i].text), "k");
        const char *value = setting_value("k", leaf, "t.yaml", a, &e);
        if (row[i].value != NULL) assert_string_equal(value, row[i].value);
        else {
            assert_null(value);
            refused(ERR_DATA, 1, "k");
        }
    }
    /* a list of mappings where the key takes one */
    const struct node *leaf =
        document_find(tree("k: [{from: 0 B, send.overhead: 1 us}, {from: 9 B}]\n"), "k");
    assert_string_equal(setting_value("software.segments", leaf, "t.yaml", a, &e),
                        "[{from: 0 B, send.overhead: 1 us}, {from: 9 B}]");
    leaf = document_find(tree("k: [{from: [0, 1]}]\n"), "k");
    assert_null(setting_value("software.segments", leaf, "t.yaml", a, &e));
    refused(ERR_DATA, 1, "software.segments");
}

/* ---- ranges ---- */

static bool ranged(struct range *r, const char *key, const char *text)
{
    struct text t = {0};
    text_add(&t, "of:\n  %s: %s\n", key, text);
    const struct node *n = document_find(tree(t.s), "of")->child;
    text_free(&t);
    return range_read(r, key, n, "t.yaml", a, &e);
}

static void ranges_have_ends_and_a_scale(void **state)
{
    (void)state;
    static const char rate[] = "machine.network.link.bandwidth",
                      time[] = "machine.network.hop_latency";
    static const struct {
        const char *key, *text;
        double low, high;
        bool log;
    } row[] = {
        {rate, "{from: 100 MB/s, to: 1 GB/s}", 1e8, 1e9, true},
        {rate, "{to: 1 GB/s, from: 100 MB/s, scale: linear}", 1e8, 1e9, false},
        {rate, "{from: 100 MB/s, to: 1 GB/s, scale: log}", 1e8, 1e9, true},
        {time, "{from: 0 ns, to: 50 ns}", 0, 50e-9, false},
        {time, "{from: 0 ns, to: 50 ns, scale: linear}", 0, 50e-9, false},
        {"n", "{from: 2, to: 9}", 2, 9, true},
    };
    struct range r;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        if (!ranged(&r, row[i].key, row[i].text)) fail_msg("%s: %s", row[i].text, e.text);
        assert_true(fabs(r.low - row[i].low) <= 1e-9 * row[i].high);
        assert_true(fabs(r.high - row[i].high) <= 1e-9 * row[i].high);
        assert_int_equal(r.log, row[i].log);
        assert_string_equal(r.key, setting_key(row[i].key));
        assert_int_equal(r.line, 2);
    }
}

static void wrong_ranges_are_refused(void **state)
{
    (void)state;
    static const char rate[] = "machine.network.link.bandwidth",
                      time[] = "machine.network.hop_latency";
    static const struct {
        const char *key, *text, *part;
    } row[] = {
        {rate, "1 GB/s", "expected a list of values, or a range"},
        {rate, "{from: 1 GB/s}", "expected a list of values, or a range"},
        {rate, "{to: 1 GB/s}", "expected a list of values, or a range"},
        {rate, "{from: 1 GB/s, to: 1 GB/s}", "'from' has to be below 'to'"},
        {rate, "{from: 2 GB/s, to: 1 GB/s}", "'from' has to be below 'to'"},
        {rate, "{from: 1, to: 2 GB/s}", "'1'"},
        {rate, "{from: 1 GB/s, to: 2 s}", "'2 s'"},
        {rate, "{from: 1 GB/s, to: 2 GB/s, scal: log}", "'scale'"},
        {rate, "{from: 1 GB/s, to: 2 GB/s, scale: cubic}", "expected linear or log"},
        {rate, "{from: 1 GB/s, to: 2 GB/s, scale: [log]}", "a list or mapping"},
        {time, "{from: 0 s, to: 2 ns, scale: log}", "as the range begins at 0"},
        {"kernel.solver", "{from: cr, to: pcr}", "no number"},
        {"machine", "{from: t3e-300, to: paragon}", "no number"},
        {"n", "{from: 2.5, to: 3}", "2.5"},
    };
    struct range r;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        if (ranged(&r, row[i].key, row[i].text)) fail_msg("%s was taken", row[i].text);
        refused(ERR_DATA, 2, row[i].part);
    }
}

/* The number that a text of range_text sets. */
static double number_of(const struct range *r, const char *text)
{
    struct setting s;
    struct run_spec run = {0};
    double x = NAN;
    if (!setting_make(&s, r->key, text, "f", 1, a, &e)) fail_msg("%s", e.text);
    setting_apply(&s, &run, a);
    assert_true(field_number(s.field, (char *)&run + s.table->offset, &x));
    return x;
}

/* Random ranges: texts are settings, four digits are right, nothing leaves the range, and larger
 * places have larger values. */
static void points_of_a_range_are_settings_in_it(void **state)
{
    (void)state;
    struct random random = random_make(11, 0, 0);
    for (int round = 0; round < 300; round++) {
        char text[160];
        struct range r;
        const double low = exp(20 * random_uniform(&random, 0, 1)),
                     wide = 1 + 9 * random_uniform(&random, 0, 1);
        const bool log = round % 2, whole = round % 3 == 0;
        const int from = 1 + (int)random_below(&random, 40),
                  to = from + 1 + (int)random_below(&random, 500);
        if (whole)
            snprintf(text, sizeof text, "{from: %d, to: %d, scale: %s}", from, to,
                     log ? "log" : "linear");
        else
            snprintf(text, sizeof text, "{from: %.9g B/s, to: %.9g B/s, scale: %s}", low,
                     low * wide + 1, log ? "log" : "linear");
        if (!ranged(&r, whole ? "n" : "machine.network.link.bandwidth", text))
            fail_msg("%s: %s", text, e.text);
        double before = 0;
        for (int k = 0; k <= 8; k++) {
            const double u = k / 8.0, x = number_of(&r, range_text(&r, u, a)),
                         exact = log ? pow(r.low, 1 - u) * pow(r.high, u)
                                     : (1 - u) * r.low + u * r.high;
            assert_true(x >= r.low && x <= r.high && x >= before);
            assert_true(fabs(x - exact) <= (whole ? 0.5000001 : 0.00050001 * exact));
            before = x;
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(keys_are_keys_groups_or_neither),
        TEST(short_names_stand_for_whole_ones),
        TEST(each_text_is_a_setting_of_its_kind),
        TEST(wrong_texts_are_told_with_key_and_value),
        TEST(a_rate_of_zero_is_a_word),
        TEST(a_tolerance_beside_the_level_is_a_second_setting),
        TEST(only_values_of_fields_are_applied),
        TEST(a_list_keeps_order_and_takes_a_key_once),
        TEST(a_walk_visits_nested_and_dotted_keys),
        TEST(values_stand_plainly_in_lists_or_with_their_source),
        TEST(ranges_have_ends_and_a_scale),
        TEST(wrong_ranges_are_refused),
        TEST(points_of_a_range_are_settings_in_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
