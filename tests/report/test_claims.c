/* test_claims.c - claims as files of questions: how they are read, what their rows may say, which
 * verdicts come of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/refused.h"
#include "../support/scratch.h"
#include "base/text.h"
#include "report/claims.h"
#include "report/report.h"

/* A folder with plots/claims, and a database. */
struct fixture {
    char folder[200];
    struct store *s;
    struct claim_rules c;
    struct err e;
    struct text said; /* what `heard` was told */
};

static int begin(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    char path[300];
    scratch_make(f->folder, sizeof f->folder);
    f->s = store_open(scratch_path(path, sizeof path, f->folder, "t.db"), STORE_WRITE, &f->e);
    if (!report_folder(scratch_path(path, sizeof path, f->folder, "plots/claims"), &f->e)) return 1;
    *state = f;
    return f->s == NULL;
}

static int end(void **state)
{
    struct fixture *f = *state;
    if (f->c.arena != NULL) claims_free(&f->c);
    text_free(&f->said);
    store_close(f->s);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)

static void refused(struct fixture *f, enum err_kind kind, const char *part)
{
    is_refused(&f->e, kind, part);
}

static void put_file(struct fixture *f, const char *id, const char *text)
{
    char name[80], path[400];
    snprintf(name, sizeof name, "plots/claims/%s", id);
    FILE *out = fopen(scratch_path(path, sizeof path, f->folder, name), "wb");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

static const char *const header[] = {"statement", "test",   "unit", "designated",
                                     "judged",    "points", "needs"};
enum { HEADERS = sizeof header / sizeof *header };

/* A claim with all its lines but number `without`, designated variant 'a', then `rest`. */
static void put_claim(struct fixture *f, const char *id, int without, const char *rest)
{
    struct text t = {0};
    for (int i = 0; i < HEADERS; i++)
        if (i != without) text_add(&t, "-- %s: %s\n", header[i], i == 3 ? "a" : header[i]);
    text_add(&t, "%s", rest);
    put_file(f, id, t.s);
    text_free(&t);
}

static void read_all(struct fixture *f)
{
    if (f->c.arena != NULL) claims_free(&f->c);
    if (!claims_read(&f->c, f->folder, &f->e)) fail_msg("%s", f->e.text);
}

static void claims_are_in_the_order_of_their_numbers(void **state)
{
    struct fixture *f = *state;
    static const char *const id[] = {"C1", "C2", "C10", "Balance", "waste"};
    put_claim(f, "waste.sql", -1, "SELECT 1");
    put_claim(f, "C10.sql", -1, "SELECT 1");
    put_claim(f, "C2.sql", -1, "SELECT 1");
    put_claim(f, "Balance.sql", -1, "SELECT 1");
    put_claim(f, "C1.sql", -1, "SELECT 1");
    /* these are no claims */
    put_claim(f, "C3.txt", -1, "");
    put_claim(f, ".sql", -1, "");
    read_all(f);
    assert_int_equal(f->c.n, 5);
    for (int i = 0; i < 5; i++) assert_string_equal(f->c.rule[i].id, id[i]);
    assert_false(f->c.what_if);
}

static void lines_go_on_and_may_be_left_out_where_the_header_says(void **state)
{
    struct fixture *f = *state;
    put_file(
        f, "C1.sql",
        "-- statement: A is\n--   faster than\n--   B\n-- test: t\n-- unit: \n-- designated: d\n"
        "-- judged: j\n--  not a line of it\n-- points: p\n-- needs: n\n"
        "-- explore: one --set a=1\n--   b=2\n-- explore: two\n-- never: because\nSELECT 1;");
    put_claim(f, "C2.sql", -1, "SELECT 1");
    read_all(f);
    const struct claim_rule *r = f->c.rule;
    assert_string_equal(r[0].statement, "A is faster than B");
    assert_string_equal(r[0].unit, "");
    assert_string_equal(r[0].judged, "j");
    assert_string_equal(r[0].needs, "n");
    assert_string_equal(r[0].never, "because");
    assert_int_equal(r[0].nexplore, 2);
    assert_string_equal(r[0].explore[0], "one --set a=1 b=2");
    assert_string_equal(r[0].explore[1], "two");
    assert_null(r[1].never);
    assert_int_equal(r[1].nexplore, 0);
}

static void every_needed_line_is_missed(void **state)
{
    struct fixture *f = *state;
    for (int i = 0; i < HEADERS; i++) {
        put_claim(f, "C1.sql", i, "SELECT 1");
        assert_false(claims_read(&f->c, f->folder, &f->e));
        assert_non_null(strstr(f->e.file, "/plots/claims/C1.sql"));
        assert_int_equal(f->e.line, 1);
        refused(f, ERR_DATA, header[i]);
        /* nothing is left to be freed */
        assert_null(f->c.arena);
        assert_int_equal(f->c.n, 0);
    }
}

static void as_many_scenarios_as_there_is_room_for(void **state)
{
    struct fixture *f = *state;
    struct text t = {0};
    for (int i = 0; i < CLAIM_MOST_EXPLORED; i++) text_add(&t, "-- explore: s%d\n", i);
    put_claim(f, "C1.sql", -1, t.s);
    read_all(f);
    assert_int_equal(f->c.rule[0].nexplore, CLAIM_MOST_EXPLORED);
    assert_string_equal(f->c.rule[0].explore[CLAIM_MOST_EXPLORED - 1], "s7");
    text_add(&t, "-- explore: more\n");
    put_claim(f, "C1.sql", -1, t.s);
    claims_free(&f->c);
    assert_false(claims_read(&f->c, f->folder, &f->e));
    refused(f, ERR_DATA, "more than 8");
    text_free(&t);
}

static void no_claims_are_told(void **state)
{
    struct fixture *f = *state;
    assert_false(claims_read(&f->c, f->folder, &f->e));
    refused(f, ERR_NO_INPUT, f->folder);
    assert_false(claims_read(&f->c, "/nowhere/at all", &f->e));
    refused(f, ERR_NO_INPUT, "/nowhere/at all");
    assert_null(f->c.arena);
}

/* ---- judging ---- */

static void add_value(struct text *t, struct store_value v)
{
    if (v.kind == STORE_INT) text_add(t, " i%lld", (long long)v.integer);
    else if (v.kind == STORE_REAL) text_add(t, " %g", v.real);
    else text_add(t, " %s", v.kind == STORE_NULL ? "-" : "text");
}

/* Writes down what it is told, and stops at a variant called 'stop'. */
static bool heard(void *context, const struct claim_rule *rule, const struct judgement *j)
{
    struct fixture *f = context;
    text_add(&f->said, "%s%s/%s", f->said.length > 0 ? "; " : "", rule->id, j->variant);
    add_value(&f->said, j->value);
    add_value(&f->said, j->threshold);
    add_value(&f->said, j->holds);
    text_add(&f->said, " %s '%s' %g", j->missing != NULL ? j->missing : "-", j->note, j->margin);
    return strcmp(j->variant, "stop") != 0 || err_set(&f->e, ERR_IO, "enough");
}

static bool judge(struct fixture *f, const char *query, const char *admitted)
{
    put_claim(f, "C1.sql", -1, query);
    read_all(f);
    f->said.length = 0;
    if (f->said.s != NULL) f->said.s[0] = '\0';
    return claims_judge(&f->c.rule[0], f->s, admitted, heard, f, &f->e);
}

static void rows_are_judgements(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *query, *said;
    } row[] = {
        {"SELECT 'a', 1.5, 1, 1, NULL, 'n', 0.5", "C1/a 1.5 1 i1 - 'n' 0.5"},
        {"SELECT 'a', 1.5, 1, 0, NULL, 'n'", "C1/a 1.5 1 i0 - 'n' nan"},
        /* integers are numbers; a truth is any number but 0; a note may be missing */
        {"SELECT 'a', 2, NULL, 7, NULL, NULL, 3", "C1/a 2 - i1 - '' 3"},
        {"SELECT 'a', 'word', 'word', 'word', NULL, 5, 'word'", "C1/a - - - - '' nan"},
        /* without all of its runs a variant has a threshold alone */
        {"SELECT 'a', 1.5, 1, 1, 'n 8', 'x', 0.5", "C1/a - 1 - n 8 'x' nan"},
        {"SELECT * FROM (VALUES ('a', 1, 1, 1, NULL, ''), ('b', 2, 1, 0, NULL, ''))",
         "C1/a 1 1 i1 - '' nan; C1/b 2 1 i0 - '' nan"},
        {"SELECT ?1, 1, 1, 1, NULL, ''", "C1/as shipped 1 1 i1 - '' nan"},
        {"SELECT 'a', 1, 1, 1, NULL, '' WHERE 0", ""},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        if (!judge(f, row[i].query, "as shipped")) fail_msg("%s", f->e.text);
        assert_string_equal(f->said.s != NULL ? f->said.s : "", row[i].said);
    }
}

static void wrong_rows_are_told_with_their_claim(void **state)
{
    struct fixture *f = *state;
    static const char *const query[] = {
        "SELECT 'a', 1, 1, 1, NULL",
        "SELECT 'a', 1, 1, 1, NULL, '', 0, 0",
        "SELECT 1, 1, 1, 1, NULL, ''",
        "SELECT NULL, 1, 1, 1, NULL, ''",
        "SELECT 'a', 1, 1, 1, NULL, '' FROM no_such_table",
        "SELECT",
    };
    for (size_t i = 0; i < sizeof query / sizeof *query; i++) {
        assert_false(judge(f, query[i], "what-if"));
        refused(f, ERR_DATA, "C1");
    }
    /* who is told may stop it: the rest is not asked for */
    assert_false(judge(f,
                       "SELECT * FROM (VALUES ('stop', 1, 1, 1, NULL, ''), ('b', 1, 1, 1, NULL, "
                       "''))",
                       "what-if"));
    refused(f, ERR_IO, "enough");
    assert_null(strstr(f->said.s, "C1/b"));
}

/* ---- samples and verdicts ---- */

static bool take_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    struct text *t = context;
    (void)name;
    for (int i = 0; i < ncolumn; i++)
        text_add(t, "%s%s",
                 i > 0           ? "|"
                 : t->length > 0 ? "; "
                                 : "",
                 value[i] != NULL ? value[i] : "-");
    return true;
}

static void expect(struct fixture *f, const char *sql, const char *wanted)
{
    struct text t = {0};
    if (!store_select(f->s, sql, 0, NULL, take_row, &t, &f->e)) fail_msg("%s", f->e.text);
    assert_string_equal(t.s != NULL ? t.s : "", wanted);
    text_free(&t);
}

#define VARIANTS(a, b)                                                                             \
    "SELECT * FROM (VALUES ('a', " a ", 1, " a " >= 1, NULL, 'found'), ('b', " b ", 1, " b         \
    " >= 1, NULL, 'other'))"

static void samples_are_kept_all_or_none(void **state)
{
    struct fixture *f = *state;
    static const char all[] =
        "SELECT id, variant, sample, value, holds FROM claim_sample ORDER BY sample, id, variant";
    put_claim(f, "C1.sql", -1, VARIANTS("2.5", "0.5"));
    put_claim(f, "C2.sql", -1, "SELECT 'a', 1, 1, 1, 'n 8', ''");
    read_all(f);
    assert_true(claims_sample(&f->c, f->s, f->s, 3, &f->e));
    expect(f, all, "C1|a|3|2.5|1; C1|b|3|0.5|0; C2|a|3|-|-");
    /* the second claim fails: nothing is left of the first, and the store can still be written */
    put_claim(f, "C2.sql", -1, "SELECT 1");
    read_all(f);
    assert_false(claims_sample(&f->c, f->s, f->s, 4, &f->e));
    refused(f, ERR_DATA, "C2");
    expect(f, all, "C1|a|3|2.5|1; C1|b|3|0.5|0; C2|a|3|-|-");
    assert_true(store_begin(f->s, &f->e));
    assert_true(store_commit(f->s, &f->e));
}

static void decide(struct fixture *f)
{
    read_all(f);
    if (!claims_decide(&f->c, f->s, &f->e)) fail_msg("%s", f->e.text);
}

static void the_designated_variant_gives_the_verdict(void **state)
{
    struct fixture *f = *state;
    static const struct {
        const char *query, *verdict, *counts, *note;
    } row[] = {
        {VARIANTS("2", "0.5"), "pass", "2|1",
         "judged for a: found; holds in 1 of 2 variants; "
         "fails for: b"},
        {VARIANTS("0.5", "2"), "fail", "2|1",
         "judged for a: found; holds in 1 of 2 variants; "
         "holds for: b"},
        {VARIANTS("2", "3"), "pass", "2|2", "judged for a: found; holds in 2 of 2 variants"},
        {"SELECT 'a', 2, 1, NULL, NULL, 'nobody can tell'", "not-testable", "0|0",
         "judged for a: nobody can tell"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        put_claim(f, "C1.sql", -1, row[i].query);
        decide(f);
        expect(f, "SELECT verdict FROM claim WHERE variant = ''", row[i].verdict);
        expect(f, "SELECT testable, holding FROM claim WHERE variant = ''", row[i].counts);
        expect(f, "SELECT note FROM claim WHERE variant = ''", row[i].note);
    }
    /* what the claim says stands with it, its rule of judging with the verdict alone */
    expect(f, "SELECT id, variant, statement, test, unit, judged FROM claim ORDER BY variant",
           "C1||statement|test|unit|judged; C1|a|statement|test|unit|");
}

static void runs_that_are_missing_are_named_with_their_command(void **state)
{
    struct fixture *f = *state;
    put_claim(f, "C1.sql", -1, "SELECT 'a', 2, 1, 1, 'n 8', ''");
    put_claim(f, "C2.sql", -1, "SELECT 'b', 2, 1, 1, NULL, 'only b'");
    decide(f);
    expect(f,
           "SELECT id, verdict, value, testable, holding FROM claim WHERE variant = '' ORDER BY id",
           "C1|not-testable|-|0|0; C2|not-testable|-|1|1");
    struct text note = {0};
    /* C2 has no row of its designated variant: all of its points are missing */
    text_add(
        &note,
        "not testable, runs are missing: n 8; `needs -o %s` makes them; not testable, runs are "
        "missing: points; `needs -o %s` makes them",
        store_path(f->s), store_path(f->s));
    expect(f, "SELECT note FROM claim WHERE variant = '' ORDER BY id", note.s);
    text_free(&note);
}

static void ranges_and_shares_come_from_the_samples(void **state)
{
    struct fixture *f = *state;
    static const char *const query[] = {VARIANTS("2", "0.5"), VARIANTS("0.5", "0.25"),
                                        VARIANTS("4", "1"), VARIANTS("3", "2")};
    for (int i = 0; i < 4; i++) {
        put_claim(f, "C1.sql", -1, query[i]);
        read_all(f);
        assert_true(claims_sample(&f->c, f->s, f->s, i, &f->e));
    }
    decide(f);
    expect(f,
           "SELECT variant, value, value_low, value_high, samples, share FROM claim ORDER BY "
           "variant",
           "|3.0|0.5|4.0|4|0.75; a|3.0|0.5|4.0|4|0.75; b|2.0|0.25|2.0|4|0.5");
}

/* The table is of one study: a claim that cannot be judged leaves the old verdicts as they were. */
static void all_verdicts_or_none(void **state)
{
    struct fixture *f = *state;
    put_claim(f, "C1.sql", -1, VARIANTS("2", "3"));
    put_claim(f, "C2.sql", -1, VARIANTS("2", "3"));
    decide(f);
    put_claim(f, "C1.sql", -1, VARIANTS("0", "0"));
    put_claim(f, "C2.sql", -1, "SELECT 1");
    read_all(f);
    assert_false(claims_decide(&f->c, f->s, &f->e));
    refused(f, ERR_DATA, "C2");
    expect(f, "SELECT id, verdict FROM claim WHERE variant = '' ORDER BY id", "C1|pass; C2|pass");
    /* a variant that is gone goes from the table as well */
    put_claim(f, "C2.sql", -1, "SELECT 'a', 0, 1, 0, NULL, ''");
    decide(f);
    expect(f, "SELECT id, variant, verdict FROM claim ORDER BY id, variant",
           "C1||fail; C1|a|fail; C1|b|fail; C2||fail; C2|a|fail");
}

static char *printed(struct fixture *f, bool json)
{
    char *s = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&s, &size);
    if (!claims_print(f->s, json, out, &f->e)) fail_msg("%s", f->e.text);
    fclose(out);
    return s;
}

static void verdicts_are_printed_for_people_and_programs(void **state)
{
    struct fixture *f = *state;
    char *s = printed(f, true);
    assert_string_equal(s, "[]\n");
    free(s);
    put_claim(f, "C10.sql", -1, "SELECT 'a', 0.5, 1, 0, NULL, 'ten'");
    put_claim(f, "C2.sql", -1, "SELECT 'a', 2, 1, 1, NULL, 'two'");
    decide(f);
    s = printed(f, false);
    const char *two =
                   strstr(s, "\nC2 pass\n  test:   test\n  judged: judged\n  found:  judged for a: "
                             "two"),
               *ten = strstr(s, "\nC10 fail\n");
    assert_non_null(two);
    assert_non_null(ten);
    assert_true(two < ten);
    free(s);
    s = printed(f, true);
    /* one object a claim: its keys in their order, its variants in it, its verdict last */
    static const char *const part[] = {
        "\"holding\"", "\"C2\"",        "\"judged\"",     "\"note\"",      "\"samples\"",
        "\"share\"",   "\"statement\"", "\"test\"",       "\"testable\"",  "\"threshold\"",
        "\"unit\"",    "\"value\"",     "\"value_high\"", "\"value_low\"", "\"variants\"",
        "\"two\"",     "\"variant\"",   "\"verdict\"",    "\"verdict\"",   "\"C10\"",
        "\"verdict\""};
    const char *at = s;
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        const char *next = strstr(at, part[i]);
        if (next == NULL) fail_msg("%s is not behind the others in %s", part[i], s);
        at = next + 1;
    }
    /* the claim itself is no variant of it */
    int variants = 0;
    for (at = s; (at = strstr(at, "\"variant\"")) != NULL; at++) variants++;
    assert_int_equal(variants, 2);
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(claims_are_in_the_order_of_their_numbers),
        TEST(lines_go_on_and_may_be_left_out_where_the_header_says),
        TEST(every_needed_line_is_missed),
        TEST(as_many_scenarios_as_there_is_room_for),
        TEST(no_claims_are_told),
        TEST(rows_are_judgements),
        TEST(wrong_rows_are_told_with_their_claim),
        TEST(samples_are_kept_all_or_none),
        TEST(the_designated_variant_gives_the_verdict),
        TEST(runs_that_are_missing_are_named_with_their_command),
        TEST(ranges_and_shares_come_from_the_samples),
        TEST(all_verdicts_or_none),
        TEST(verdicts_are_printed_for_people_and_programs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
