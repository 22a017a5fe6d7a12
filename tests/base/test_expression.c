/* test_expression.c - formulas and conditions: values, units, mistakes, limits. */
#include "base/expression.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* n = 16, P = 4, time = 2 ms, solver = "cr", lost = NaN */
static bool lookup(void *context, const char *name, struct expression_value *v, char *why, int size)
{
    (void)context;
    *v = (struct expression_value){0};
    if (strcmp(name, "n") == 0) return v->number = 16, true;
    if (strcmp(name, "P") == 0) return v->number = 4, true;
    if (strcmp(name, "lost") == 0) return v->number = NAN, true;
    if (strcmp(name, "time") == 0) return v->number = 2e-3, v->unit = UNIT_TIME, true;
    if (strcmp(name, "kernel.solver") == 0) return v->text = "pcr-symmetric", true;
    snprintf(why, (size_t)size, "no '%s'", name);
    return false;
}

/* The value, or the clause that says what is wrong. */
static bool evaluate(const char *text, struct expression_value *v, char why[200])
{
    struct arena *a = arena_create();
    struct expression *x = expression_read(text, a, why, 200);
    bool ok = x != NULL;
    if (ok) assert_string_equal(expression_text(x), text);
    ok = ok && expression_value(x, lookup, NULL, v, why, 200);
    arena_destroy(a);
    return ok;
}

static void is(const char *text, double expected)
{
    struct expression_value v;
    char why[200];
    if (!evaluate(text, &v, why)) fail_msg("%s: %s", text, why);
    assert_null(v.text);
    if (isnan(expected)) assert_true(isnan(v.number));
    else if (v.number != expected) fail_msg("%s is %g, not %g", text, v.number, expected);
}

static void is_wrong(const char *text, const char *expected)
{
    struct expression_value v;
    char why[200] = "";
    if (evaluate(text, &v, why)) fail_msg("%s is %g, but was to be refused", text, v.number);
    if (strstr(why, expected) == NULL) fail_msg("%s: '%s' does not say '%s'", text, why, expected);
}

static void arithmetic(void **state)
{
    (void)state;
    is("1 + 2 * 3", 7);
    is("(1 + 2) * 3", 9);
    is("10 - 4 - 3", 3);
    is("16 / 4 / 2", 2);
    is("-n + 1", -15);
    is("n % 5", 1);
    is("log2(n) + sqrt(P) + min(n, P) + max(1, 2)", 4 + 2 + 4 + 2);
    is("n / 0", NAN);
    is("log2(-1)", NAN);
    is("1e3", 1000);
}

static void units(void **state)
{
    (void)state;
    is("2 ms", 2e-3);
    is("1 GB/s", 1e9);
    is("1 KiB", 1024);
    is("5%", 0.05);
    is("20 % 7", 6);
    is("time / 1 ms", 2);
    is("time * 2 <= 4 ms", 1);
    is("time * 5% <= 100 us", 1);
    is("1 MB / 1 MB/s", 1);
    is_wrong("time <= 2", "a time on the left of '<='");
    is_wrong("time + n", "a time on the left of '+'");
    is_wrong("2 parsecs", "expected an operator before 'parsecs'");
    is_wrong("2x", "an unknown unit before 'x'");
    is_wrong("1e999", "too large");
}

static void conditions(void **state)
{
    (void)state;
    is("n >= P and n % P == 0", 1);
    is("n < P or P == 4", 1);
    is("not n < P", 1);
    is("not (n > P and P > 1)", 0);
    is("lost < 1", 0);
    is("lost >= 1", 0);
    is("kernel.solver == pcr-symmetric", 1);
    is("kernel.solver != cr", 1);
    is("cr == kernel.solver", 0);
    is("kernel.solver == 'pcr-symmetric' and n==16", 1);
    is_wrong("kernel.solver < cr", "only == and !=");
    is_wrong("kernel.solver == 3", "compares a text with a number");
    is_wrong("n == cr", "no 'cr'");
    is_wrong("kernel.solver + 1", "takes numbers, not the text");
}

/* By how much a condition is missed tells which of two wrong points is the better. */
static void excess(void **state)
{
    (void)state;
    struct expression_value near, far, both;
    char why[200];
    assert_true(evaluate("n <= 15", &near, why));
    assert_true(evaluate("n <= 8", &far, why));
    assert_true(evaluate("n <= 15 and n <= 8", &both, why));
    assert_true(near.excess > 0 && near.excess < far.excess);
    assert_true(fabs(both.excess - near.excess - far.excess) < 1e-15);
    assert_true(evaluate("n <= 15 or n <= 8", &both, why));
    assert_true(both.excess == near.excess);
    assert_true(evaluate("n < 16", &near, why));
    assert_true(near.excess > 0);
    assert_true(evaluate("n <= 16", &near, why));
    assert_true(near.excess == 0);
}

static void mistakes(void **state)
{
    (void)state;
    is_wrong("", "expected a number or a name at its end");
    is_wrong("n >", "expected a number or a name at its end");
    is_wrong("n = 4", "a single '=' where '==' was meant");
    is_wrong("(n", "')' is missing");
    is_wrong("n P", "expected an operator before 'P'");
    is_wrong("1 < n < 3", "a second comparison");
    is_wrong("system(n)", "none of log2, sqrt, min, max");
    is_wrong("min(n)", "a comma is missing");
    is_wrong("'open", "the quote that ends a text");
    is_wrong("speed", "no 'speed'");
    is_wrong("n; n", "expected an operator before '; n'");
    is_wrong("$(n)", "expected a number or a name");
}

/* What a stranger writes cannot use up the stack. */
static void limits(void **state)
{
    (void)state;
    char text[EXPRESSION_MAX_LENGTH + 2];
    memset(text, '(', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    is_wrong(text, "longer than");
    text[EXPRESSION_MAX_LENGTH] = '\0';
    is_wrong(text, "too many brackets");
    memset(text, '-', EXPRESSION_MAX_LENGTH);
    is_wrong(text, "too many brackets");
    for (int i = 0; i + 4 <= EXPRESSION_MAX_LENGTH; i += 4) memcpy(text + i, "not ", 4);
    is_wrong(text, "too many brackets");
    /* a long chain is no depth */
    for (int i = 0; i < EXPRESSION_MAX_LENGTH; i++) text[i] = i % 2 ? '+' : '1';
    text[EXPRESSION_MAX_LENGTH - 1] = '\0';
    is(text, EXPRESSION_MAX_LENGTH / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arithmetic), cmocka_unit_test(units),    cmocka_unit_test(conditions),
        cmocka_unit_test(excess),     cmocka_unit_test(mistakes), cmocka_unit_test(limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
