/* test_document.c - files of data and of settings as trees: what is read, each limit at its last
 * good value and one beyond, each refusal with its line. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "base/text.h"
#include "document_fixture.h"

/* --- what is read --- */

/* Each scalar of a file of programs, and what it is there. */
static void scalars_of_data_have_their_kinds(void **state)
{
    static const struct {
        const char *written;
        enum node_kind kind;
        double number;
        const char *text;
    } row[] = {
        {"0", NODE_NUMBER, 0, NULL},
        {"-0.0", NODE_NUMBER, -0.0, NULL},
        {"17", NODE_NUMBER, 17, NULL},
        {"+3", NODE_NUMBER, 3, NULL},
        {"1e3", NODE_NUMBER, 1000, NULL},
        {"-2.5E-3", NODE_NUMBER, -0.0025, NULL},
        {"0.1", NODE_NUMBER, 0.1, NULL},
        {"4.9406564584124654e-324", NODE_NUMBER, 4.9406564584124654e-324, NULL},
        {"1.7976931348623157e308", NODE_NUMBER, 1.7976931348623157e308, NULL},
        {"9007199254740993", NODE_NUMBER, 9007199254740992.0, NULL},
        {"null", NODE_NULL, 0, NULL},
        {"~", NODE_NULL, 0, NULL},
        {"", NODE_NULL, 0, NULL},
        {"NULL", NODE_TEXT, 0, "NULL"},
        {"Null", NODE_TEXT, 0, "Null"},
        {"true", NODE_TEXT, 0, "true"},
        {"12a", NODE_TEXT, 0, "12a"},
        {"2024-01-01", NODE_TEXT, 0, "2024-01-01"},
        {"1.2.3", NODE_TEXT, 0, "1.2.3"},
        {"\"17\"", NODE_TEXT, 0, "17"},
        {"'17'", NODE_TEXT, 0, "17"},
        {"\"null\"", NODE_TEXT, 0, "null"},
        {"\"\"", NODE_TEXT, 0, ""},
        {"\"a\\u00e9\\n\"", NODE_TEXT, 0, "a\xc3\xa9\n"},
        {"two words", NODE_TEXT, 0, "two words"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char s[100];
        snprintf(s, sizeof s, "a:\n  - %s\n", row[i].written);
        const struct node *list = document_find(good_data(s), "a"), *x = list->child;
        if (x->kind != row[i].kind) fail_msg("%s is of kind %d", row[i].written, (int)x->kind);
        if (x->kind == NODE_NUMBER)
            assert_memory_equal(&x->number, &row[i].number, sizeof x->number);
        if (row[i].text) assert_string_equal(x->text, row[i].text);
        assert_null(x->key);
        assert_int_equal(list->count, 1);
    }
}

/* The same text as settings: all are as they were written. */
static void scalars_of_settings_stay_texts(void **state)
{
    const struct node *map =
        good_settings("a: 8\nb: 1.50 us\nc:\nd: ~\ne: \"x: y\"\nf: 'it''s'\ng: 0x10\n");
    static const char *const expected[][2] = {{"a", "8"},   {"b", "1.50 us"}, {"c", ""},
                                              {"d", "~"},   {"e", "x: y"},    {"f", "it's"},
                                              {"g", "0x10"}};
    int n = 0;
    (void)state;
    assert_int_equal(map->kind, NODE_MAP);
    assert_int_equal(map->count, 7);
    for (const struct node *x = map->child; x; x = x->next, n++) {
        assert_int_equal(x->kind, NODE_TEXT);
        assert_string_equal(x->key, expected[n][0]);
        assert_string_equal(x->text, expected[n][1]);
        assert_int_equal(x->line, n + 1);
    }
    assert_int_equal(n, 7);
}

/* 17 digits name a double: random bit patterns come back as they were. */
static void doubles_come_back_bit_by_bit(void **state)
{
    enum { N = 2000 };
    struct random r = random_make(31, 0, 0);
    struct text t = {0};
    double x[N], y[N];
    struct err e;
    (void)state;
    text_add(&t, "{\"x\": [");
    for (int i = 0; i < N; i++) {
        do {
            const uint64_t bits = random_u64(&r);
            memcpy(&x[i], &bits, sizeof bits);
        } while (!isfinite(x[i]));
        text_add(&t, "%s%.17g", i ? ", " : "", x[i]);
    }
    text_add(&t, "]}");
    err_clear(&e);
    assert_true(document_numbers(good_data(t.s), "x", path, y, N, &e));
    assert_memory_equal(x, y, sizeof x);
    text_free(&t);
}

/* A key's line is where people look, even if its value begins further down; block and flow style
 * and JSON give one tree. */
static void lines_are_those_of_the_keys(void **state)
{
    const struct node *map = good_data("# a remark\n"
                                       "first:\n"
                                       "\n"
                                       "    - 1\n"
                                       "    -\n"
                                       "      - 2\n"
                                       "second: {x: 5,\n"
                                       "  y: [6,\n"
                                       "  7]}\n");
    const struct node *first = document_find(map, "first"), *second = document_find(map, "second"),
                      *y = document_find(second, "y");
    (void)state;
    assert_int_equal(map->line, 2);
    assert_int_equal(first->line, 2);
    assert_int_equal(first->child->line, 4);
    assert_int_equal(first->child->next->line, 6);
    assert_int_equal(first->child->next->child->line, 6);
    assert_int_equal(second->line, 7);
    assert_int_equal(document_find(second, "x")->line, 7);
    assert_int_equal(y->line, 8);
    assert_int_equal(y->child->next->line, 9);
    assert_int_equal(second->count, 2);
    assert_null(second->next);
    assert_null(map->key);
    assert_string_equal(y->key, "y");
}

/* --- random trees against the text that they were written from --- */

struct maker {
    struct random r;
    struct text t;
    int left; /* nodes that may still be made */
};

/* Write a random node as JSON; its shape is written to `model` as well: kinds, keys and numbers. */
static void write_random(struct maker *m, struct text *model, int depth)
{
    const int kind = depth == 0 ? 4 : depth > 6 ? 0 : (int)random_below(&m->r, 5);
    m->left--;
    if (kind < 2 || m->left < 0) {
        const double x = (double)(int64_t)random_below(&m->r, 2000001) / 64 - 15625;
        text_add(&m->t, "%.17g", x);
        text_add(model, "n%.17g;", x);
    } else if (kind == 2) {
        const int x = (int)random_below(&m->r, 1000);
        text_add(&m->t, "\"%dx\"", x);
        text_add(model, "t%dx;", x);
    } else {
        const int n = (int)random_below(&m->r, 5) + (depth == 0);
        text_add(&m->t, kind == 3 ? "[" : "{");
        text_add(model, kind == 3 ? "l%d;" : "m%d;", n);
        for (int i = 0; i < n; i++) {
            /* line breaks wherever JSON allows them */
            text_add(&m->t, "%s%s", i ? "," : "", random_below(&m->r, 3) == 0 ? "\n " : " ");
            if (kind != 3) text_add(&m->t, "\"k%d\": ", i), text_add(model, "k%d:", i);
            write_random(m, model, depth + 1);
        }
        text_add(&m->t, kind == 3 ? " ]" : " }");
    }
}

static int describe(const struct node *n, struct text *out)
{
    int lines = n->line, count = 0;
    if (n->key) text_add(out, "%s:", n->key);
    if (n->kind == NODE_NUMBER) text_add(out, "n%.17g;", n->number);
    if (n->kind == NODE_TEXT) text_add(out, "t%s;", n->text);
    if (n->kind == NODE_LIST || n->kind == NODE_MAP) {
        text_add(out, n->kind == NODE_LIST ? "l%d;" : "m%d;", n->count);
        for (const struct node *c = n->child; c; c = c->next, count++) {
            /* lines never go back */
            assert_true(c->line >= lines);
            lines = describe(c, out);
            assert_ptr_equal(n->kind == NODE_MAP ? document_find(n, c->key) : c, c);
        }
        assert_int_equal(count, n->count);
    }
    return lines;
}

static void random_trees_are_read_as_written(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 300; seed++) {
        struct maker m = {.r = random_make(seed, 7, 0), .left = 200};
        struct text model = {0}, found = {0};
        struct arena_mark mark = arena_mark(arena);
        write_random(&m, &model, 0);
        describe(good_data(m.t.s), &found);
        assert_string_equal(found.s, model.s);
        arena_release(arena, mark);
        text_free(&m.t), text_free(&model), text_free(&found);
    }
}

/* --- what is refused --- */

static void mistakes_are_told_with_their_line(void **state)
{
    static const struct {
        const char *text;
        int data; /* line as data, 0: it is good data */
        int settings;
        const char *said;
    } row[] = {
        {"", 1, 1, "the file is empty"},
        {"# a remark\n\n", 1, 1, "the file is empty"},
        {"[1, 2]\n", 0, 1, "expected 'key: value' lines"},
        {"\nword\n", 0, 2, "expected 'key: value' lines"},
        {"a: &x 1\n", 1, 1, "anchors (&name) are not allowed"},
        {"a: 1\nb: &x [1]\n", 2, 2, "anchors (&name) are not allowed"},
        {"a: &x\n  b: 1\n", 1, 1, "anchors (&name) are not allowed"},
        {"a: 1\nb: *a\n", 2, 2, "aliases (*name) are not allowed"},
        {"a: !!int 1\n", 1, 1, "tags (!name) are not allowed"},
        {"a: !!seq [1]\n", 1, 1, "tags (!name) are not allowed"},
        {"a: 2\nb: !x {c: 1}\n", 2, 2, "tags (!name) are not allowed"},
        {"a: ! \"1\"\n", 1, 1, "tags (!name) are not allowed"},
        {"a: 1\n---\nb: 2\n", 2, 2, "a second document in one file"},
        {"a: 1\nb: 2\na: 3\n", 3, 3, "duplicate key 'a'; first given in line 1"},
        {"x: {a: 1,\n \"a\": 2}\n", 2, 2, "duplicate key 'a'; first given in line 1"},
        {"{a: 1,\n a: 2", 2, 2, "duplicate key 'a'"},
        {"? [1, 2]\n: 3\n", 1, 1, "a key has to be a name"},
        {"{a: 1}: 2\n", 1, 1, "a key has to be a name"},
        {"a: 1\n? {b: 2}\n: 3\n", 2, 2, "a key has to be a name"},
        {"a: [1, 2\n", 2, 2, "not "},
        {"a: \"open\n", 2, 2, "not "},
        {"a: 1\n\tb: 2\n", 2, 2, "not "},
        {"a: \"x\\0y\"\n", 1, 1, "a zero byte in a text"},
        {"\"x\\0y\": 1\n", 1, 1, "a zero byte in a text"},
        {"a: 1\nb: \xff\xfe\n", 2, 2, "not a text file in UTF-8"},
    };
    struct err e;
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const struct node *n = read_data(row[i].text, &e);
        assert_true(!n == (row[i].data > 0));
        if (!n) {
            expect_error(&e, row[i].data, row[i].said);
            assert_string_equal(e.file, path);
        }
        if (read_settings(row[i].text, &e)) fail_msg("'%s' is read as settings", row[i].text);
        expect_error(&e, row[i].settings, row[i].said);
        assert_string_equal(e.file, "x.yaml");
    }
}

/* The form's name stands in the message, so that people know what the file should be. */
static void the_two_forms_call_themselves(void **state)
{
    struct err e;
    (void)state;
    assert_null(read_data("{", &e));
    assert_string_equal(e.text, "not JSON or YAML: did not find expected node content "
                                "while parsing a flow node");
    assert_null(read_settings("{", &e));
    assert_string_equal(e.text, "not YAML: did not find expected node content "
                                "while parsing a flow node");
    assert_null(read_bytes("a: x\0y", 6, &e));
    expect_error(&e, 1, "not JSON or YAML: not a text file in UTF-8");
}

/* `open` n times, x in the middle, `close` n times. */
static char *nested(const char *before, const char *open, const char *close, int n)
{
    struct text t = {0};
    text_add(&t, "%s", before);
    for (int i = 0; i < n; i++) text_add(&t, "%s", open);
    text_add(&t, "1");
    for (int i = 0; i < n; i++) text_add(&t, "%s", close);
    char *s = arena_text(arena, t.s);
    text_free(&t);
    return s;
}

static void depth_has_a_limit(void **state)
{
    struct err e;
    (void)state;
    assert_non_null(read_data(nested("", "[", "]", 64), &e));
    assert_null(read_data(nested("", "[", "]", 65), &e));
    expect_error(&e, 1, "nested deeper than 64 levels");
    assert_null(read_data(nested("", "[", "]", 20000), &e));
    assert_non_null(read_data(nested("", "{\"a\":\n", "}", 64), &e));
    assert_null(read_data(nested("", "{\"a\":\n", "}", 65), &e));
    expect_error(&e, 65, "nested deeper than 64 levels");
    /* the mapping itself is a level */
    assert_non_null(read_settings(nested("a: ", "[", "]", 16), &e));
    assert_null(read_settings(nested("a: ", "[", "]", 17), &e));
    expect_error(&e, 1, "nested deeper than 17 levels");
    /* side by side is not deep */
    assert_non_null(read_data("[[[1]], [[2]], [[3]], [[4]]]", &e));
}

/* A mapping of n keys below each other. */
static char *keys(int n)
{
    struct text t = {0};
    for (int i = 0; i < n; i++) text_add(&t, "k%d: 1\n", i);
    char *s = arena_text(arena, t.s);
    text_free(&t);
    return s;
}

static void keys_of_a_mapping_have_a_limit(void **state)
{
    struct err e;
    (void)state;
    assert_int_equal(good_data(keys(4096))->count, 4096);
    assert_null(read_data(keys(4097), &e));
    expect_error(&e, 4097, "more than 4096 keys in one mapping");
    assert_int_equal(good_settings(keys(2000))->count, 2000);
    assert_null(read_settings(keys(2001), &e));
    expect_error(&e, 2001, "more than 2000 keys in one mapping");
}

/* The mapping, the list and its entries are 400000 nodes, or one more. */
static void entries_of_settings_have_a_limit(void **state)
{
    enum { N = 400000 - 2 };
    char *s = malloc(2 * N + 20), *p = s + sprintf(s, "a: [");
    struct err e;
    (void)state;
    for (int i = 0; i < N; i++) *p++ = '1', *p++ = ',';
    strcpy(p, "]\n");
    const struct node *n = good_settings(s);
    assert_int_equal(n->child->count, N);
    strcpy(p, "1]\n");
    assert_null(read_settings(s, &e));
    expect_error(&e, 1, "too many entries");
    /* data have no such limit */
    assert_int_equal(good_data(s)->child->count, N + 1);
    free(s);
}

static void size_of_settings_has_a_limit(void **state)
{
    char *s = malloc(DOCUMENT_MAX_SETTINGS + 2);
    struct err e;
    (void)state;
    memset(s, ' ', DOCUMENT_MAX_SETTINGS + 1);
    memcpy(s, "a: 1\n#", 6);
    s[DOCUMENT_MAX_SETTINGS] = '\0';
    assert_int_equal(good_settings(s)->count, 1);
    s[DOCUMENT_MAX_SETTINGS] = ' ';
    err_clear(&e);
    assert_null(document_parse_settings(s, DOCUMENT_MAX_SETTINGS + 1, "x.yaml", arena, &e));
    expect_error(&e, 0, "not a text file of at most 4 MiB");
    /* as a file, too; and as data it is small */
    FILE *f = fopen(path, "wb");
    fwrite(s, 1, DOCUMENT_MAX_SETTINGS + 1, f);
    fclose(f);
    err_clear(&e);
    assert_null(document_read_settings(path, arena, &e));
    expect_error(&e, 0, "not a text file of at most 4 MiB");
    err_clear(&e);
    assert_non_null(document_read(path, arena, &e));
    /* a file with nothing in it but length: it is refused before it is read */
    assert_int_equal(truncate(path, ((off_t)512 << 20) + 1), 0);
    err_clear(&e);
    assert_null(document_read(path, arena, &e));
    expect_error(&e, 0, "not a text file of at most 512 MiB");
    free(s);
}

static void files_that_are_not_there_are_told(void **state)
{
    struct err e;
    (void)state;
    err_clear(&e);
    assert_null(document_read("/nowhere/x.json", arena, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    err_clear(&e);
    assert_null(document_read_settings("/nowhere/x.yaml", arena, &e));
    assert_int_equal(e.kind, ERR_NO_INPUT);
    err_clear(&e);
    assert_null(document_read(folder, arena, &e));
    assert_int_not_equal(e.kind, ERR_NONE);
    /* settings from a file have the file's name, those from memory the one given */
    assert_null(read_data("a: 1\na: 2\n", &e));
    err_clear(&e);
    assert_null(document_read_settings(path, arena, &e));
    expect_error(&e, 2, "duplicate key 'a'");
    assert_string_equal(e.file, path);
}

/* Any bytes are a tree or an error with a line of the file; read with sanitizers, within memory. */
static void damaged_files_are_refused_or_read(void **state)
{
    static const char whole[] = "a: [1, 2.5e3, {b: \"x\\n\", c: ~}]\n'd': &e |\n  text\n  more\n"
                                "? f\n: - 1\n  - *e\n";
    static const char some[] = "0:-[]{},&*!|>'\"%@`?#~ \n\t\\ab\xc3\xa9\xff";
    struct random r = random_make(12, 0, 0);
    (void)state;
    for (int k = 0; k < 6000; k++) {
        char s[2 * sizeof whole], *p = s;
        struct arena_mark mark = arena_mark(arena);
        struct err e;
        for (const char *w = whole; *w; w++) {
            const uint64_t what = random_below(&r, 40);
            if (what == 0) continue;
            *p++ = what == 1 ? some[random_below(&r, sizeof some - 1)] : *w;
            if (what == 2) *p++ = some[random_below(&r, sizeof some - 1)];
        }
        *p = '\0';
        const struct node *n = read_settings(s, &e);
        if (n) assert_int_equal(n->kind, NODE_MAP);
        else assert_true(e.kind == ERR_DATA && e.line >= 1 && e.line <= 100 && e.text[0] != '\0');
        arena_release(arena, mark);
    }
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, begin, end)
int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(scalars_of_data_have_their_kinds),  TEST(scalars_of_settings_stay_texts),
        TEST(doubles_come_back_bit_by_bit),      TEST(lines_are_those_of_the_keys),
        TEST(random_trees_are_read_as_written),  TEST(mistakes_are_told_with_their_line),
        TEST(the_two_forms_call_themselves),     TEST(depth_has_a_limit),
        TEST(keys_of_a_mapping_have_a_limit),    TEST(entries_of_settings_have_a_limit),
        TEST(size_of_settings_has_a_limit),      TEST(files_that_are_not_there_are_told),
        TEST(damaged_files_are_refused_or_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
