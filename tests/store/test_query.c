/* test_query.c - queries as users write them: what is refused and why, how many columns, which
 * kinds of values, and who may stop. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "database_file.h"
#include "store/store.h"

/* What the functions below were given. */
struct seen {
    int headers, rows, columns, most; /* most: rows before it stops, 0: never */
    struct text text;
    char names[40]; /* of the first and the last column of a row of texts */
};

static bool take_header(void *context, int n, const char *const *name,
                        const struct store_value *value)
{
    struct seen *x = context;
    assert_null(value);
    assert_int_equal(x->rows, 0);
    x->headers++;
    x->columns = n;
    for (int i = 0; i < n; i++) text_add(&x->text, "%s ", name[i]);
    return x->most >= 0;
}

static bool take_values(void *context, int n, const char *const *name,
                        const struct store_value *value)
{
    struct seen *x = context;
    (void)name;
    x->columns = n;
    for (int i = 0; i < n; i++) switch (value[i].kind) {
        case STORE_NULL:
            text_add(&x->text, "null ");
            break;
        case STORE_INT:
            text_add(&x->text, "i%lld ", (long long)value[i].integer);
            break;
        case STORE_REAL:
            text_add(&x->text, "r%.17g ", value[i].real);
            break;
        case STORE_TEXT:
            text_add(&x->text, "t%s ", value[i].text);
            break;
        }
    return ++x->rows != x->most;
}

static bool take_texts(void *context, int n, const char *const *name, const char *const *value)
{
    struct seen *x = context;
    snprintf(x->names, sizeof x->names, "%s %s", name[0], name[n - 1]);
    x->columns = n;
    for (int i = 0; i < n; i++) text_add(&x->text, "%s ", value[i] != NULL ? value[i] : "null");
    return ++x->rows != x->most;
}

static struct store *opened(struct fixture *f, enum store_mode mode)
{
    struct store *s = store_open(f->path, mode, &f->e);
    if (s == NULL) fail_msg("%s", f->e.text);
    return s;
}

/* Both functions, which differ in the values alone. */
static bool ask(struct store *s, int way, const char *query, int n, const char *const *param,
                struct seen *x, struct err *e)
{
    *x = (struct seen){.most = x->most};
    return way ? store_query(s, query, n, param, take_header, take_values, x, e)
               : store_select(s, query, n, param, take_texts, x, e);
}

static void wrong_queries_are_refused_with_a_reason(void **state)
{
    static const struct {
        const char *query, *says; /* NULL: it is fine */
        int n;
        enum err_kind kind;
    } row[] = {
        {"", "empty query", 0, ERR_DATA},
        {"  \n;; ", "empty query", 0, ERR_DATA},
        {"-- only a remark", "empty query", 0, ERR_DATA},
        {"SELECT 1; SELECT 2", "'SELECT 2' would not be run", 0, ERR_DATA},
        {"SELECT 1;\n  DROP TABLE run", "'DROP TABLE run' would not be run", 0, ERR_DATA},
        {"SELECT 1; nonsense", "'nonsense' would not be run", 0, ERR_DATA},
        {"SELECT 1;", NULL, 0, ERR_NONE},
        {"SELECT 1; -- and a remark", NULL, 0, ERR_NONE},
        {"SELECT 1 /* */ ; ; \n;", NULL, 0, ERR_NONE},
        {"SELECT ?1", "has 1 parameters, 0 were given", 0, ERR_DATA},
        {"SELECT 1", "has 0 parameters, 2 were given", 2, ERR_DATA},
        {"SELECT ?1, ?2", NULL, 2, ERR_NONE},
        {"SELECT ?2, ?1, ?2", NULL, 2, ERR_NONE},
        {"SELEC 1", "SELEC", 0, ERR_DATA},
        {"SELECT * FROM nowhere", "nowhere", 0, ERR_DATA},
        {"SELECT no_such_function(1)", "no_such_function", 0, ERR_DATA},
        {"DELETE FROM run", "opened for reading only", 0, ERR_IO},
        {"CREATE TEMP TABLE x (a)", "opened for reading only", 0, ERR_IO},
        {"SELECT abs(-9223372036854775808)", "integer overflow", 0, ERR_DATA}, /* as it runs */
    };
    static const char *const param[] = {"one", "two"};
    struct fixture *f = *state;
    store_close(opened(f, STORE_WRITE));
    struct store *s = opened(f, STORE_READ);
    for (int way = 0; way < 2; way++)
        for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
            struct seen x = {0};
            const bool good = ask(s, way, row[i].query, row[i].n, param, &x, &f->e);
            if (good != (row[i].says == NULL) || f->e.kind != row[i].kind ||
                (!good && strstr(f->e.text, row[i].says) == NULL))
                fail_msg("'%s': %d %s", row[i].query, (int)f->e.kind, f->e.text);
            assert_int_equal(x.rows, good);
            err_clear(&f->e);
            text_free(&x.text);
        }
    store_close(s);
}

/* Numbers, texts and nothing keep their kinds, or become texts; parameters are texts whatever they
 * look like. */
static void values_keep_their_kinds(void **state)
{
    static const char query[] = "SELECT 1 AS a, -2.5 AS b, NULL, '', 'x', ?1, typeof(?1), "
                                "9223372036854775807, 1e300 * 1e300, x'414200'";
    static const char
        *const param[] = {"3"},
               *const wanted[] = {
                   "1 -2.5 null  x 3 text 9223372036854775807 Inf AB ",
                   "a b NULL '' 'x' ?1 typeof(?1) 9223372036854775807 1e300 * 1e300 x'414200' "
                   "i1 r-2.5 null t tx t3 ttext i9223372036854775807 rinf tAB "};
    struct fixture *f = *state;
    struct store *s = opened(f, STORE_WRITE);
    for (int way = 0; way < 2; way++) {
        struct seen x = {0};
        assert_true(ask(s, way, query, 1, param, &x, &f->e));
        assert_string_equal(x.text.s, wanted[way]);
        assert_int_equal(x.columns, 10);
        assert_string_equal(x.names, way == 0 ? "a x'414200'" : "");
        text_free(&x.text);
    }
    store_close(s);
}

/* As many columns as there is room for, and one more. */
static void a_query_has_a_most_of_columns(void **state)
{
    enum { MOST = 128 };
    struct fixture *f = *state;
    struct store *s = opened(f, STORE_WRITE);
    for (int way = 0; way < 2; way++)
        for (int n = MOST; n <= MOST + 1; n++) {
            struct text query = {0};
            struct seen x = {0};
            for (int i = 0; i < n; i++) text_add(&query, "%s %d", i > 0 ? "," : "SELECT", i);
            assert_int_equal(ask(s, way, query.s, 0, NULL, &x, &f->e), n == MOST);
            assert_int_equal(x.columns, n == MOST ? n : 0);
            if (n == MOST) assert_non_null(strstr(x.text.s, "127 "));
            else assert_non_null(strstr(f->e.text, "more than 128 columns"));
            err_clear(&f->e);
            text_free(&query);
            text_free(&x.text);
        }
    store_close(s);
}

/* The reader stops when it has enough, which is no error; names come before rows, once, and also
 * where there are none. */
static void a_reader_may_stop(void **state)
{
    static const char many[] =
        "WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i FROM n";
    struct fixture *f = *state;
    struct store *s = opened(f, STORE_WRITE);
    for (int way = 0; way < 2; way++)
        for (int most = 1; most <= 5; most += 2) {
            struct seen x = {.most = most};
            assert_true(ask(s, way, many, 0, NULL, &x, &f->e)); /* of rows without an end */
            assert_int_equal(x.rows, most);
            assert_int_equal(x.headers, way);
            text_free(&x.text);
        }
    struct seen x = {.most = -1};
    assert_true(ask(s, 1, many, 0, NULL, &x, &f->e)); /* by the names already */
    assert_true(x.headers == 1 && x.rows == 0);
    text_free(&x.text);
    x = (struct seen){0};
    assert_true(ask(s, 1, "SELECT 1 AS none WHERE 0", 0, NULL, &x, &f->e));
    assert_true(x.headers == 1 && x.rows == 0);
    assert_string_equal(x.text.s, "none ");
    text_free(&x.text);
    /* the rows that came before an error have come */
    x = (struct seen){0};
    assert_false(ask(s, 0, "SELECT abs(column1) FROM (VALUES (1), (2), (-9223372036854775808))", 0,
                     NULL, &x, &f->e));
    assert_int_equal(x.rows, 2);
    text_free(&x.text);
    store_close(s);
}

/* A row may have as many values as there is room for; what is deleted is what IS the value. */
static void rows_are_inserted_and_deleted_by_any_kind(void **state)
{
    enum { MOST = 64 };
    struct fixture *f = *state;
    struct store *s = opened(f, STORE_WRITE);
    struct text t = {0};
    char name[MOST][8];
    const char *names[MOST];
    struct store_value v[MOST];
    for (int i = 0; i < MOST; i++) {
        snprintf(name[i], sizeof name[i], "c%d", i);
        names[i] = name[i];
        text_add(&t, "%s%s", i > 0 ? ", " : "CREATE TABLE wide (", name[i]);
        v[i] = store_int(i);
    }
    text_add(&t, ")");
    sql(f->path, t.s);
    text_free(&t);
    const struct store_value key[] = {store_int(7), store_real(2.5), store_text("it's"),
                                      store_null(), store_real(NAN)};
    for (int k = 0; k < 5; k++) {
        v[0] = key[k];
        if (!store_insert(s, "wide", MOST, names, v, &f->e)) fail_msg("%s", f->e.text);
    }
    /* the last two are alike: NULL */
    static const int left[] = {4, 3, 2, 0, 0};
    for (int k = 0; k < 5; k++) {
        struct seen x = {0};
        char wanted[16];
        assert_true(store_delete(s, "wide", "c0", key[k], &f->e));
        assert_true(ask(s, 0, "SELECT count(*), max(c63) FROM wide", 0, NULL, &x, &f->e));
        snprintf(wanted, sizeof wanted, left[k] > 0 ? "%d 63 " : "%d null ", left[k]);
        assert_string_equal(x.text.s, wanted);
        text_free(&x.text);
    }
    assert_false(store_delete(s, "wide", "no_column", store_int(1), &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    store_close(s);
}

/* What asks within its own rows. */
struct asking {
    struct store *s;
    const char *sql;
    int depth;
    struct text seen;
    struct err *e;
};

static bool ask_again(void *context, int n, const char *const *name, const char *const *value)
{
    struct asking *a = context;
    assert_int_equal(n, 1);
    assert_non_null(name[0]);
    text_add(&a->seen, "%s ", value[0]);
    return a->depth-- <= 0 || store_select(a->s, a->sql, 0, NULL, ask_again, a, a->e);
}

/* A passing database keeps the statements of its queries; no answer shows it. */
static void the_same_is_asked_again_of_a_passing_database(void **state)
{
    struct fixture *f = *state;
    struct store *s = store_open("passing", STORE_MEMORY, &f->e);
    const char *one[] = {"one"}, *key[] = {"key", "value"};
    const char *const sql = "SELECT ?1 UNION ALL SELECT 'two'";
    assert_non_null(s);
    /* neither a parameter nor the place of a reader who stopped stays */
    for (int k = 0; k < 3; k++) {
        struct seen x = {.most = k};
        assert_true(store_query(s, sql, 1, one, take_header, take_values, &x, &f->e));
        assert_non_null(strstr(x.text.s, k == 1 ? "tone " : "tone ttwo "));
        text_free(&x.text);
    }
    /* one that is in use is given to nobody else */
    struct asking a = {.s = s, .sql = "VALUES (1), (2), (3)", .depth = 1, .e = &f->e};
    assert_true(store_select(s, a.sql, 0, NULL, ask_again, &a, &f->e));
    assert_string_equal(a.seen.s, "1 1 2 3 2 3 ");
    text_free(&a.seen);
    /* a row that is refused is not in the way of the next; a value that is left out is not the
     * last one's */
    const struct store_value row[2][2] = {{store_text("a"), store_text("x")},
                                          {store_text("b"), store_null()}},
                             refused[2] = {store_null(), store_text("y")};
    assert_true(store_insert(s, "meta", 2, key, row[0], &f->e));
    assert_false(store_insert(s, "meta", 2, key, refused, &f->e));
    err_clear(&f->e);
    assert_true(store_insert(s, "meta", 2, key, row[1], &f->e));
    struct seen x = {0};
    assert_true(ask(s, 0, "SELECT value FROM meta WHERE key IN ('a', 'b') ORDER BY key", 0, NULL,
                    &x, &f->e));
    assert_string_equal(x.text.s, "x null ");
    text_free(&x.text);
    /* more texts than are kept, twice */
    for (int k = 0; k < 200; k++) {
        char text[32], wanted[16];
        struct seen number = {0};
        snprintf(text, sizeof text, "SELECT %d", k % 100);
        snprintf(wanted, sizeof wanted, "%d ", k % 100);
        assert_true(ask(s, 0, text, 0, NULL, &number, &f->e));
        assert_string_equal(number.text.s, wanted);
        text_free(&number.text);
    }
    store_close(s);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(wrong_queries_are_refused_with_a_reason),
        TEST(values_keep_their_kinds),
        TEST(a_query_has_a_most_of_columns),
        TEST(a_reader_may_stop),
        TEST(rows_are_inserted_and_deleted_by_any_kind),
        TEST(the_same_is_asked_again_of_a_passing_database),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
