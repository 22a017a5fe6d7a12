/* test_judgement.c - published figures judged: every verdict with its limits, and what a table of
 * them says together. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/validation.h"
#include "base/random.h"

static struct published figure(enum probe_quantity q, const char *evidence, enum published_use use)
{
    return (struct published){.id = "a",
                              .machine = "m",
                              .quantity = q,
                              .at_text = "",
                              .value = 100,
                              .low = 100,
                              .high = 100,
                              .unit = "",
                              .scale = 1,
                              .evidence = evidence,
                              .use = use,
                              .source = "",
                              .cause = "",
                              .missed = NAN};
}

static struct validated judged(const struct published *p, double value)
{
    struct validated o = {.measured = true, .value = value};
    validation_judge(p, &o);
    return o;
}

/* The largest error that passes, by what was measured, who said it, and what it was used for. */
static void every_kind_of_figure_has_its_tolerance(void **state)
{
    static const struct {
        enum probe_quantity q;
        const char *evidence;
        enum published_use use;
        double tolerance;
    } row[] = {
        {PROBE_LATENCY, "P", USE_CALIBRATED, 0.1},  {PROBE_LATENCY, "D", USE_CALIBRATED, 0.1},
        {PROBE_LATENCY, "PR", USE_CALIBRATED, 0.2}, {PROBE_LATENCY, "E", USE_CALIBRATED, 0.2},
        {PROBE_LATENCY, "P", USE_HELD, 0.3},        {PROBE_LATENCY, "PR", USE_HELD, 0.3},
        {PROBE_LATENCY, "P", USE_OTHER, 0.1},       {PROBE_BISECTION, "P", USE_CALIBRATED, 0.05},
        {PROBE_BISECTION, "P", USE_HELD, 0.05},     {PROBE_BISECTION, "PR", USE_HELD, 0.2},
        {PROBE_GLOBAL, "D", USE_HELD, 0.05},        {PROBE_WIRE, "P", USE_CALIBRATED, 0.05},
        {PROBE_WIRE, "E", USE_CALIBRATED, 0.2},     {PROBE_READ, "P", USE_CALIBRATED, 0.05},
        {PROBE_READ, "P", USE_HELD, 0.05},          {PROBE_READ, "PR", USE_CALIBRATED, 0.2},
        {PROBE_READ, "PR", USE_HELD, 0.3},          {PROBE_EXCHANGE, "P", USE_HELD, 0.3},
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        const struct published p = figure(row[i].q, row[i].evidence, row[i].use);
        const double t = row[i].tolerance;
        for (int sign = -1; sign <= 1; sign += 2) {
            const struct validated in = judged(&p, 100 * (1 + sign * (t - 1e-9))),
                                   out = judged(&p, 100 * (1 + sign * (t + 1e-9)));
            if (in.tolerance != t) fail_msg("row %d: %g", (int)i, in.tolerance);
            assert_true(fabs(in.error - sign * t) < 1e-8);
            const bool other = row[i].use == USE_OTHER;
            assert_string_equal(in.verdict, other ? "not-testable" : "pass");
            assert_string_equal(out.verdict, other ? "not-testable" : "fail");
        }
    }
}

static void a_published_range_passes_whole(void **state)
{
    (void)state;
    struct published p = figure(PROBE_LATENCY, "P", USE_CALIBRATED);
    p.low = 50, p.high = 400;
    assert_string_equal(judged(&p, 50).verdict, "pass");
    assert_string_equal(judged(&p, 400).verdict, "pass");
    assert_true(judged(&p, 400).error == 3); /* of the value all the same */
    assert_string_equal(judged(&p, 49.99).verdict, "fail");
    assert_string_equal(judged(&p, 400.01).verdict, "fail");
    p.low = 95, p.high = 96; /* the tolerance around the value holds, too */
    assert_string_equal(judged(&p, 109).verdict, "pass");
    p.low = 100, p.high = 100;
    assert_string_equal(judged(&p, 110.5).verdict, "fail");
}

/* A cause explains the error that it begins with, within the tolerance, and no other. */
static void a_cause_explains_its_own_error_alone(void **state)
{
    static const struct {
        enum published_use use;
        double missed, value;
        const char *verdict, *why;
    } row[] = {
        {USE_CALIBRATED, 0.4, 140, "explained", ""},
        {USE_CALIBRATED, 0.4, 153.9, "explained", ""},
        {USE_CALIBRATED, 0.4, 154.1, "fail", "the cause explains +40 %, not +54.1 %"},
        {USE_CALIBRATED, 0.4, 126.1, "explained", ""},
        {USE_CALIBRATED, 0.4, 125.9, "fail", "the cause explains +40 %, not +25.9 %"},
        {USE_CALIBRATED, -0.5, 50, "explained", ""},
        {USE_CALIBRATED, -0.5, 56, "fail", "the cause explains -50 %, not -44 %"},
        {USE_CALIBRATED, 0.4, 100, "fail", "the cause explains +40 %, not +0 %"},
        {USE_CALIBRATED, 0.05, 105, "pass", ""}, /* it would have passed without */
        {USE_CALIBRATED, NAN, 140, "fail", "the cause explains no error, not +40 %"},
        {USE_HELD, 0.4, 181, "explained", ""},
        {USE_HELD, 0.4, 183, "fail", "the cause explains +40 %, not +83 %"},
        {USE_OTHER, 0.4, 140, "not-testable", ""},
        {USE_OTHER, 0.4, 200, "fail", "the cause explains +40 %, not +100 %"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct published p = figure(PROBE_LATENCY, "P", row[i].use);
        p.cause = "+40 %: a reason", p.missed = row[i].missed;
        const struct validated o = judged(&p, row[i].value);
        if (strcmp(o.verdict, row[i].verdict) != 0 || strcmp(o.why, row[i].why) != 0)
            fail_msg("row %d: %s, '%s'", (int)i, o.verdict, o.why);
    }
    /* what was not measured was not measured, whatever its cause */
    struct published p = figure(PROBE_LATENCY, "P", USE_CALIBRATED);
    struct validated o = {.value = NAN, .why = "the machine has no caches"};
    p.cause = "+40 %: a reason", p.missed = 0.4;
    validation_judge(&p, &o);
    assert_string_equal(o.verdict, "not-testable");
    assert_string_equal(o.why, "the machine has no caches");
    assert_true(isnan(o.error));
}

static int ascending(const void *x, const void *y)
{
    const double a = *(const double *)x, b = *(const double *)y;
    return (a > b) - (a < b);
}

enum { MOST = 24 };

/* One group found again, from the words of the header. */
static void check_group(const struct published *const *p, const struct validated *o, int n,
                        enum published_use use, const struct validation_group *g)
{
    double size[MOST], sum = 0, worst = 0;
    const char *id = "";
    int m = 0, above = 0, unnamed = 0;
    for (int i = 0; i < n; i++) {
        if (!o[i].measured || p[i]->use != use || strcmp(p[i]->evidence, "E") == 0) continue;
        if (m == 0 || fabs(o[i].error) > fabs(worst)) worst = o[i].error, id = p[i]->id;
        size[m++] = fabs(o[i].error);
        sum += fabs(o[i].error);
        if (fabs(o[i].error) > VALIDATION_UNEXPLAINED) above++;
        if (fabs(o[i].error) > VALIDATION_UNEXPLAINED && p[i]->cause[0] == '\0') unnamed++;
    }
    qsort(size, (size_t)m, sizeof *size, ascending);
    assert_int_equal(g->n, m);
    assert_int_equal(g->above, above);
    assert_int_equal(g->unnamed, unnamed);
    assert_string_equal(g->worst_id, id);
    if (m == 0) return;
    assert_true(g->worst == worst);
    assert_true(fabs(g->mean - sum / m) < 1e-12);
    const double median = m % 2 ? size[m / 2] : 0.5 * (size[m / 2 - 1] + size[m / 2]);
    assert_true(fabs(g->median - median) < 1e-12);
}

static void summaries_count_every_row_once(void **state)
{
    static const char *const evidence[] = {"P", "PR", "D", "E"};
    static char id[MOST][4];
    struct random r = random_make(2, 7, 1);
    (void)state;
    for (int round = 0; round < 300; round++) {
        struct published row[MOST];
        const struct published *p[MOST];
        struct validated o[MOST];
        const int n = (int)random_below(&r, MOST + 1);
        int failed = 0, explained = 0, untested = 0, estimated = 0;
        for (int i = 0; i < n; i++) {
            row[i] = figure(PROBE_LATENCY, evidence[random_below(&r, 4)],
                            (enum published_use)random_below(&r, 3));
            snprintf(id[i], sizeof id[i], "r%d", i);
            row[i].id = id[i];
            o[i] = (struct validated){.measured = random_below(&r, 6) > 0};
            o[i].value = o[i].measured ? random_uniform(&r, 50, 200) : NAN;
            if (random_below(&r, 3) == 0) {
                row[i].cause = "+40 %: a reason";
                row[i].missed = random_below(&r, 2) && o[i].measured ? o[i].value / 100 - 1 : 0.4;
            }
            validation_judge(&row[i], &o[i]);
            p[i] = &row[i];
            failed += strcmp(o[i].verdict, "fail") == 0;
            explained += strcmp(o[i].verdict, "explained") == 0;
            untested += strcmp(o[i].verdict, "not-testable") == 0;
            estimated += strcmp(o[i].verdict, "not-testable") != 0 && *row[i].evidence == 'E';
        }
        const struct validation_summary s = validation_summarize(p, o, n);
        assert_int_equal(s.shown, n);
        assert_int_equal(s.failed, failed);
        assert_int_equal(s.explained, explained);
        assert_int_equal(s.untested, untested);
        assert_int_equal(s.estimated, estimated);
        check_group(p, o, n, USE_CALIBRATED, &s.calibrated);
        check_group(p, o, n, USE_HELD, &s.held);
    }
}

/* Keys in the order of the alphabet, whatever the order of the levels; what is not finite is
 * null. */
static void levels_are_an_object_of_numbers(void **state)
{
    double level[LEVELS];
    char buffer[512] = "";
    (void)state;
    for (int i = 0; i < LEVELS; i++) level[i] = 1e6 * (i + 1);
    level[LEVEL_FLIT] = NAN;
    FILE *out = fmemopen(buffer, sizeof buffer, "w");
    assert_non_null(out);
    struct json j = json_make(out);
    validation_levels_json(level, 1e6, &j);
    json_finish(&j);
    fclose(out);
    const char *last = "", *at = buffer;
    for (int i = 0; i < LEVELS; i++) {
        static char name[2][32];
        const char *open = strchr(at, '"');
        assert_non_null(open);
        char *to = name[i % 2];
        snprintf(to, 32, "%.*s", (int)strcspn(open + 1, "\""), open + 1);
        assert_true(strcmp(last, to) < 0);
        last = to;
        int which = 0;
        while (which < LEVELS && strcmp(validation_level_name(which), to) != 0) which++;
        assert_true(which < LEVELS);
        at = strchr(open, ':') + 1;
        char *end;
        const double value = strtod(at, &end);
        if (which == LEVEL_FLIT) assert_int_equal(strncmp(at + strspn(at, " "), "null", 4), 0);
        else assert_true(end > at && value == which + 1);
        at = strchr(at, i == LEVELS - 1 ? '}' : ',');
        assert_non_null(at);
        at++;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_figure_has_its_tolerance),
        cmocka_unit_test(a_published_range_passes_whole),
        cmocka_unit_test(a_cause_explains_its_own_error_alone),
        cmocka_unit_test(summaries_count_every_row_once),
        cmocka_unit_test(levels_are_an_object_of_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
