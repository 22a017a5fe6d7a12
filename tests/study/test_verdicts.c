/* test_verdicts.c - verdicts on answers of network levels and of algorithms, on rows made by hand:
 * limits, reasons, means of groups, and what is printed of them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "study/netcheck_accuracy.h"
#include "study/netcheck_verdict.h"
#include "study/verify.h"

/* A counted step on a torus of one channel that every level has answered without error. */
static struct netcheck_row row_of(const char *name, const char *group)
{
    struct netcheck_row r = {.form = NETCHECK_STEP,
                             .family = TOPOLOGY_TORUS,
                             .channels = 1,
                             .nmessage = 4,
                             .compared = true,
                             .counted = true,
                             .low = 1000,
                             .high = 1000};
    snprintf(r.name, sizeof r.name, "%s", name);
    snprintf(r.group, sizeof r.group, "%s", group);
    for (int l = 0; l < LEVELS; l++)
        r.answer[l] = (struct netcheck_answer){.ran = true, .found = 1000};
    return r;
}

/* A row of a load, for which no message has a reference. */
static struct netcheck_row load_of(double crowding)
{
    struct netcheck_row r = row_of("load", "loads");
    r.form = NETCHECK_LOAD, r.compared = false, r.crowding = crowding;
    return r;
}

static void classes_have_stated_accuracies(void **state)
{
    (void)state;
    struct netcheck_row r = row_of("x", "g");
    assert_true(netcheck_accuracy_of(&r, LEVEL_FLIT)->high == 0);
    assert_true(netcheck_accuracy_of(&r, LEVEL_LOGGP)->low == -0.98);
    r.channels = 2;
    assert_true(netcheck_accuracy_of(&r, LEVEL_FLIT)->high == 0.35);
    r.family = TOPOLOGY_HYPERCUBE; /* one step: exact at all levels */
    for (int l = 0; l < LEVELS; l++)
        assert_true(netcheck_accuracy_of(&r, (enum network_level)l)->message == 0);
    r.form = NETCHECK_LIST;
    assert_true(netcheck_accuracy_of(&r, LEVEL_FLIT)->message == 1);
    r.family = TOPOLOGY_SLIM_FLY; /* no reference is known */
    assert_string_equal(netcheck_accuracy_of(&r, LEVEL_FLIT)->cases,
                        "lists of messages on other networks");
    /* limits of crowding are inclusive, and a row beyond one meets the next */
    static const double at[] = {1.3, 1.3000001, 2, 2.1, 3, 3.1},
                        high[] = {0.12, 0.40, 0.40, 0.75, 0.75, 0.90};
    for (int i = 0; i < 6; i++) {
        const struct netcheck_row load = load_of(at[i]);
        assert_true(netcheck_accuracy_of(&load, LEVEL_AUTO)->high == high[i]);
        assert_true(netcheck_accuracy_of(&load, LEVEL_AUTO)->message == -1);
    }
    struct netcheck_row routed = load_of(1.6);
    routed.routed = true;
    assert_true(netcheck_accuracy_of(&routed, LEVEL_FLIT)->high == 0.03);
    routed.crowding = 1.7;
    assert_true(netcheck_accuracy_of(&routed, LEVEL_FLIT)->high == 0.20);
    assert_true(netcheck_accuracy_of(&routed, LEVEL_LINK)->high == 3.00);
    /* every entry is a range around 0, and the list has an end */
    int n = 0;
    for (const struct netcheck_accuracy *s; (s = netcheck_accuracies(n)) != NULL; n++)
        assert_true(s->low <= 0 && s->high >= 0 && s->mean >= 0 &&
                    s->mean <= fmax(-s->low, s->high));
    assert_true(n > 20 && netcheck_accuracies(-1) == NULL && netcheck_accuracies(n + 1) == NULL);
}

static void an_answer_fails_beyond_its_limits(void **state)
{
    (void)state;
    char why[160];
    struct netcheck_row r = row_of("a step", "g");
    struct netcheck_answer *x = &r.answer[LEVEL_FLIT];
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    x->error = 0.9e-6; /* a thousandth of a cycle of a thousand is no error */
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    x->error = 1.1e-6;
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    x->error = -0.01;
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    assert_string_equal(why, "a step: error -1 %, stated are +0 to +0 %");
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, -1, NULL));   /* nobody asks why */
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, 0.01, why)); /* by another limit */
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, 0.009, why));
    assert_string_equal(why, "a step: error -1 %, stated are -0.9 to +0.9 %");
    x->error = NAN; /* no number is within no limits */
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, 0.5, why));
    /* single messages: exact where that is stated, within a limit elsewhere */
    x->error = 0, x->differing = 1, x->message_worst = 1e-9;
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    r.compared = false;
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    r.compared = true, r.channels = 2; /* 400 % */
    x->message_worst = 4;
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    x->message_worst = 4.1;
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    assert_non_null(strstr(why, "a message's error"));
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, 0, why)); /* the whole alone */
    /* what is not judged cannot fail */
    x->ran = false;
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    x->ran = true, r.played = true;
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    r.played = false, r.counted = false;
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
}

static void deadlocks_are_part_of_the_answer(void **state)
{
    (void)state;
    char why[160];
    struct netcheck_row r = row_of("ring", "g");
    r.answer[LEVEL_FLIT].deadlock = true;
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    assert_string_equal(why, "ring: a deadlock");
    r.expect_deadlock = true;
    r.answer[LEVEL_FLIT].error = 7; /* of no meaning then */
    assert_false(netcheck_row_fails(&r, LEVEL_FLIT, -1, why));
    assert_true(netcheck_row_fails(&r, LEVEL_LINK, 100, why));
    assert_string_equal(why, "ring: no deadlock");
    /* the file's own contradiction goes before all */
    snprintf(r.flaw, sizeof r.flaw, "arrives before it is sent");
    assert_true(netcheck_row_fails(&r, LEVEL_FLIT, 100, why));
    assert_string_equal(why, "ring: arrives before it is sent");
}

/* Limits of a mean: m + (w - m) / sqrt(n), of the stated means and worst cases. */
static void means_of_groups_have_limits(void **state)
{
    (void)state;
    struct netcheck_row row[9];
    struct netcheck n = {.nrow = 9, .row = row};
    for (int i = 0; i < 9; i++) row[i] = load_of(1.2); /* mean 3 %, -10 .. 12 % */
    for (int i = 0; i < 9; i++) row[i].answer[LEVEL_AUTO].error = i % 2 ? 0.059 : -0.059;
    struct netcheck_verdict v = netcheck_verdict(&n, "loads", LEVEL_AUTO, -1);
    assert_int_equal(v.cases, 9);
    assert_int_equal(v.failed, 0);
    assert_true(v.pass && v.why[0] == '\0');
    assert_true(fabs(v.mean - 0.059) < 1e-12);
    assert_true(fabs(v.mean_limit - (0.03 + (0.12 - 0.03) / 3)) < 1e-12);
    assert_true(v.low == -0.10 && v.high == 0.12);
    for (int i = 0; i < 9; i++) row[i].answer[LEVEL_AUTO].error = 0.061; /* each is within 12 % */
    v = netcheck_verdict(&n, "loads", LEVEL_AUTO, -1);
    assert_false(v.pass);
    assert_int_equal(v.failed, 0);
    assert_string_equal(v.why, "mean |error| of 9 cases 6.1 %, stated is 6 %");
    /* by one limit for all */
    v = netcheck_verdict(&n, NULL, LEVEL_AUTO, 0.061);
    assert_true(v.pass && v.mean_limit == 0.061 && v.low == -0.061 && v.high == 0.061);
    /* a case that failed is the reason, the first of them */
    row[3].answer[LEVEL_AUTO].error = 0.5;
    row[5].answer[LEVEL_AUTO].error = -0.9;
    snprintf(row[3].name, sizeof row[3].name, "third");
    v = netcheck_verdict(&n, "loads", LEVEL_AUTO, -1);
    assert_int_equal(v.failed, 2);
    assert_memory_equal(v.why, "third: error +50 %", 18);
    /* other groups and what is not counted stay out; nobody judged: nothing fails */
    snprintf(row[3].group, sizeof row[3].group, "other");
    row[5].counted = false;
    v = netcheck_verdict(&n, "loads", LEVEL_AUTO, -1);
    assert_int_equal(v.cases, 7);
    assert_int_equal(v.failed, 0);
    v = netcheck_verdict(&n, "none", LEVEL_AUTO, -1);
    assert_true(v.pass && v.cases == 0 && v.mean == 0);
}

/* Cases of several classes in one group: the limits shown are the widest, those of the mean come
 * from the own ones of the classes; answers that may be far too small count by that side. */
static void a_group_of_several_classes_has_limits_of_all(void **state)
{
    (void)state;
    struct netcheck_row row[4] = {row_of("exact", "g"), load_of(1.2), load_of(1.2), load_of(1.2)};
    struct netcheck n = {.nrow = 4, .row = row};
    for (int i = 1; i < 4; i++) snprintf(row[i].group, sizeof row[i].group, "g");
    /* packet: one step, exact; 3 %, -10 to 12 %; dragonfly: 6 %, -20 to 5 %; fat tree: 5 %, -12 to
     * 6 % */
    row[2].family = TOPOLOGY_DRAGONFLY, row[2].crowding = 1.1;
    row[3].family = TOPOLOGY_FAT_TREE;
    row[1].answer[LEVEL_PACKET].error = 0.11;
    row[2].answer[LEVEL_PACKET].error = -0.18;
    row[3].answer[LEVEL_PACKET].error = -0.03;
    struct netcheck_verdict v = netcheck_verdict(&n, "g", LEVEL_PACKET, -1);
    assert_int_equal(v.cases, 4);
    assert_int_equal(v.failed, 0);
    assert_true(v.low == -0.20 && v.high == 0.12);
    assert_true(fabs(v.mean - (0.11 + 0.18 + 0.03) / 4) < 1e-12);
    const double means = (0 + 0.03 + 0.06 + 0.05) / 4, worst = (0 + 0.12 + 0.20 + 0.12) / 4;
    assert_true(fabs(v.mean_limit - (means + (worst - means) / 2)) < 1e-12);
    assert_true(v.pass == (v.mean <= v.mean_limit));
    /* an expected deadlock is a case without an error */
    row[1].expect_deadlock = row[1].answer[LEVEL_PACKET].deadlock = true;
    v = netcheck_verdict(&n, "g", LEVEL_PACKET, -1);
    assert_true(v.cases == 4 && fabs(v.mean - (0.18 + 0.03) / 4) < 1e-12);
}

static void a_file_passes_when_all_groups_do(void **state)
{
    (void)state;
    struct netcheck_row row[4] = {row_of("a", "one"), row_of("b", "two"), row_of("c", "one"),
                                  row_of("d", "three")};
    struct netcheck n = {.nrow = 4, .row = row};
    row[3].counted = false;
    assert_true(netcheck_opens_group(&n, 0) && netcheck_opens_group(&n, 1));
    assert_false(netcheck_opens_group(&n, 2)); /* not the first of its group */
    assert_false(netcheck_opens_group(&n, 3)); /* not counted */
    assert_true(netcheck_pass(&n, -1));
    row[2].answer[LEVEL_PACKET].error = 0.1;
    assert_false(netcheck_pass(&n, -1));
    assert_true(netcheck_pass(&n, 0.2));
    row[2].answer[LEVEL_PACKET].error = 0;
    snprintf(row[3].flaw, sizeof row[3].flaw, "wrong"); /* also where it is not counted */
    assert_false(netcheck_pass(&n, 0.2));
    /* a row without a counted one before it opens the group */
    row[0].counted = false;
    assert_true(netcheck_opens_group(&n, 2));
}

static void totals_of_a_level(void **state)
{
    (void)state;
    struct netcheck_row row[4] = {row_of("a", "g"), row_of("b", "g"), row_of("c", "g"),
                                  row_of("d", "h")};
    struct netcheck n = {.nrow = 4, .row = row};
    row[0].answer[LEVEL_LINK].error = -0.2, row[0].answer[LEVEL_LINK].differing = 3;
    row[0].answer[LEVEL_LINK].message_error = 0.4;
    row[1].answer[LEVEL_LINK].error = 0.1, row[1].answer[LEVEL_LINK].message_error = 0.2;
    row[2].answer[LEVEL_LINK].ran = false;
    const struct netcheck_total t = netcheck_total(&n, "g", LEVEL_LINK);
    assert_int_equal(t.cases, 2);
    assert_int_equal(t.skipped, 1);
    assert_int_equal(t.exact_cases, 0);
    assert_int_equal(t.messages, 8);
    assert_int_equal(t.exact, 5);
    assert_true(fabs(t.mean - 0.15) < 1e-15 && t.worst == -0.2);
    assert_true(fabs(t.message_error - 0.3) < 1e-15);
    assert_int_equal(netcheck_total(&n, NULL, LEVEL_FLIT).exact_cases, 4);
    assert_int_equal(netcheck_total(&n, NULL, LEVEL_LINK).cases, 3);
}

/* What `print` writes, in `out`, to be freed. */
static char *printed(void (*print)(FILE *, const struct verify_report *, int),
                     const struct verify_report *r, int n)
{
    char *out = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&out, &size);
    print(f, r, n);
    fclose(f);
    return out;
}

static void counts_of_verdicts(void **state)
{
    (void)state;
    struct verify_row row[] = {{.verdict = VERIFY_PASS},
                               {.verdict = VERIFY_PASS},
                               {.verdict = VERIFY_ROUNDING},
                               {.verdict = VERIFY_FAIL},
                               {.verdict = VERIFY_ALGORITHM_FAILS},
                               {.verdict = VERIFY_NOT_APPLICABLE}};
    const struct verify_report r[] = {{.nrow = 4, .row = row, .passed = false},
                                      {.nrow = 2, .row = row + 4, .passed = true},
                                      {.nrow = 0, .passed = true}};
    char *out = printed(verify_print_summary, r, 3);
    assert_string_equal(out, "3 cases, 1 failed; 6 rows: 2 pass, 1 rounding, 1 algorithm-fails, 1 "
                             "fail, 1 not-applicable\n");
    free(out);
    out = printed(verify_print_summary, r + 1, 1);
    assert_memory_equal(out, "1 case, 0 failed; 2 rows: 0 pass", 32);
    free(out);
    static const char *const word[] = {"pass", "rounding", "algorithm-fails", "fail",
                                       "not-applicable"};
    for (int v = 0; v < VERIFY_VERDICTS; v++)
        assert_string_equal(verify_verdict_word((enum verify_verdict)v), word[v]);
}

/* The cell of column `k` (from 0) in line `line` of a Markdown table, without blanks. */
static void cell(const char *table, int line, int k, char *out)
{
    while (line-- > 0) table = strchr(table, '\n') + 1;
    for (k++; k > 0; k--) table = strchr(table, '|') + 1;
    table += strspn(table, " ");
    const size_t n = strcspn(table, "|");
    memcpy(out, table, n);
    out[n] = '\0';
    for (size_t i = n; i > 0 && out[i - 1] == ' '; i--) out[i - 1] = '\0';
}

static void the_matrix_has_the_largest_error_of_each_algorithm(void **state)
{
    (void)state;
    struct verify_row row[] = {
        {.algorithm = "rnea", .quantity = "tau_id", .plain = 1e-15},
        {.algorithm = "rnea", .quantity = "bias", .plain = 5},
        {.algorithm = "aba", .quantity = "qdd_fd", .plain = 3e-13},
        {.algorithm = "crba", .quantity = "qdd_fd", .plain = 1, .verdict = VERIFY_NOT_APPLICABLE},
        {.algorithm = "cfa-paper", .quantity = "qdd_fd", .plain = 0},
        {.algorithm = "parallel forward paper cr", .quantity = "qdd_fd", .plain = 2e-9},
        {.algorithm = "parallel forward paper pcr", .quantity = "qdd_fd", .plain = 7e-9},
        {.algorithm = "parallel forward direct cr", .quantity = "qdd_fd", .plain = 1e-12},
        /* an answer that is no number is the worst of all */
        {.algorithm = "parallel forward direct pcr", .quantity = "qdd_fd", .plain = NAN},
        {.algorithm = "parallel forward direct thomas", .quantity = "qdd_fd", .plain = 1e-3},
    };
    const struct verify_report r[] = {
        {.name = "one", .nbody = 7, .nrow = 10, .row = row, .passed = true, .peer_fd = 4e-14},
        {.name = "two", .nbody = 8, .nrow = 0, .passed = false, .peer_fd = NAN}};
    char *out = printed(verify_print_matrix, r, 2), found[80];
    static const struct {
        int line, column;
        const char *text;
    } cells[] = {{0, 0, "case"},  {0, 2, "RNEA"},    {2, 0, "one"},   {2, 1, "7"},
                 {2, 2, "1e-15"}, {2, 3, "-"},       {2, 4, "3e-13"}, {2, 5, "-"},
                 {2, 6, "0e+00"}, {2, 9, "7e-09"},   {2, 10, "nan"},  {2, 13, "4e-14"},
                 {2, 14, "pass"}, {3, 0, "two"},     {3, 2, "-"},     {3, 13, "-"},
                 {3, 14, "FAIL"}, {0, 14, "verdict"}};
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++) {
        cell(out, cells[i].line, cells[i].column, found);
        if (strcmp(found, cells[i].text) != 0)
            fail_msg("line %d column %d: '%s', not '%s'", cells[i].line, cells[i].column, found,
                     cells[i].text);
    }
    free(out);
}

static void brief_reports_show_what_is_not_right(void **state)
{
    (void)state;
    struct verify_row row[] = {
        {.algorithm = "right", .quantity = "tau_id", .ranks = "", .verdict = VERIFY_PASS},
        {.algorithm = "left-out", .quantity = "q", .verdict = VERIFY_NOT_APPLICABLE, .note = "why"},
        {.algorithm = "wrong",
         .quantity = "qdd_fd",
         .verdict = VERIFY_FAIL,
         .note = "because",
         .error = INFINITY},
        {.algorithm = "poor",
         .quantity = "qdd_fd",
         .verdict = VERIFY_ALGORITHM_FAILS,
         .note = "known",
         .remedy = "aba"}};
    const struct verify_report r = {.name = "case",
                                    .nbody = 1,
                                    .nu = 6,
                                    .nrow_loop = 2,
                                    .nrow = 4,
                                    .row = row,
                                    .floor_fd = NAN,
                                    .peer_fd = NAN,
                                    .text = "reason"};
    for (int brief = 0; brief < 2; brief++) {
        char *out = NULL;
        size_t size = 0;
        FILE *f = open_memstream(&out, &size);
        verify_print(f, &r, brief);
        fclose(f);
        assert_memory_equal(out,
                            "case: 1 body, 6 degrees of freedom, 2 loop constraints: FAIL: "
                            "reason\n",
                            69);
        assert_null(strstr(out, "best library"));
        assert_true((strstr(out, "right") != NULL) == !brief);
        assert_true((strstr(out, "left-out") != NULL) == !brief);
        assert_non_null(strstr(out, "FAIL: because\n"));
        assert_non_null(strstr(out, ": known; use aba\n"));
        free(out);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(classes_have_stated_accuracies),
        cmocka_unit_test(an_answer_fails_beyond_its_limits),
        cmocka_unit_test(deadlocks_are_part_of_the_answer),
        cmocka_unit_test(means_of_groups_have_limits),
        cmocka_unit_test(a_group_of_several_classes_has_limits_of_all),
        cmocka_unit_test(a_file_passes_when_all_groups_do),
        cmocka_unit_test(totals_of_a_level),
        cmocka_unit_test(counts_of_verdicts),
        cmocka_unit_test(the_matrix_has_the_largest_error_of_each_algorithm),
        cmocka_unit_test(brief_reports_show_what_is_not_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
