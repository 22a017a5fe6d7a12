/* test_limits.c - every setting of a run at its limits, taken from the tables: the last value that
 * is allowed, and the next one. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../support/arena_fixture.h"
#include "spec/field.h"

/* Run `check` for each field, with the name of its full key. */
static void on_fields(void (*check)(const struct field *f, const char *name))
{
    int ntable, nfield = 0;
    const struct field_table *const *table = field_tables(&ntable);
    for (int i = 0; i < ntable; i++)
        for (int k = 0; k < table[i]->nfield; k++, nfield++) {
            char name[200];
            snprintf(name, sizeof name, "%s.%s", table[i]->prefix, table[i]->field[k].key);
            check(&table[i]->field[k], name);
        }
    assert_true(nfield > 100);
}

/* A struct of any table, in which one field is used; what fields must not touch is 0x5a. */
enum { ROOM = sizeof(struct run_spec) + 64 };
static _Alignas(64) char base[ROOM], before[ROOM];

/* Whether the field takes the text; where it does not, nothing has changed. */
static bool takes(const struct field *f, const char *name, const char *text, char why[200])
{
    memset(base, 0x5a, sizeof base);
    memcpy(before, base, sizeof base);
    const bool taken = field_set(f, base, text, arena, why, 200);
    if (!taken && memcmp(base, before, sizeof base) != 0) fail_msg("%s has changed", name);
    return taken;
}

static void expect(const struct field *f, const char *name, const char *text, bool good)
{
    char why[200] = "";
    if (takes(f, name, text, why) != good) fail_msg("%s: '%.60s' %s", name, text, why);
}

/* ---- texts ---- */

static void text_of_any_length(const struct field *f, const char *name)
{
    if (f->kind != FIELD_TEXT || f->valid != NULL) return;
    char text[5000], why[200] = "", most[40];
    assert_true(f->capacity > 1 && f->capacity < (int)sizeof text);
    memset(text, 'x', sizeof text);
    /* with its end it just fits; what lies behind is not touched, what is in it is zero */
    text[f->capacity - 1] = '\0';
    if (!takes(f, name, text, why)) fail_msg("%s: %s", name, why);
    assert_string_equal(base + f->offset, text);
    assert_int_equal(base[f->offset + (size_t)f->capacity], 0x5a);
    if (f->offset > 0) assert_int_equal(base[f->offset - 1], 0x5a);
    assert_true(field_set(f, base, "y", arena, why, sizeof why));
    for (int i = 1; i < f->capacity; i++) assert_int_equal(base[f->offset + (size_t)i], 0);
    /* one letter more */
    text[f->capacity - 1] = 'x', text[f->capacity] = '\0';
    assert_false(takes(f, name, text, why));
    snprintf(most, sizeof most, "at most %d bytes", f->capacity - 1);
    if (strstr(why, most) == NULL) fail_msg("%s: %s", name, why);
}

static void texts_have_room_for_one_byte_less_than_their_capacity(void **state)
{
    (void)state;
    on_fields(text_of_any_length);
}

/* ---- whole numbers ---- */

static void whole_number_limits(const struct field *f, const char *name)
{
    if (f->kind != FIELD_INT && f->kind != FIELD_INT64) return;
    const char *unit = f->kind == FIELD_INT64 && f->unit == UNIT_BYTES ? " B" : "";
    const long long low = (long long)f->min, high = (long long)f->max;
    char text[60], why[200] = "";
    snprintf(text, sizeof text, "%lld%s", high, unit);
    if (!takes(f, name, text, why)) fail_msg("%s: %s %s", name, text, why);
    double number;
    assert_true(field_number(f, base, &number));
    assert_true(number == (double)high);
    if (f->max < 9e18) {
        snprintf(text, sizeof text, "%lld%s", high + 1, unit);
        expect(f, name, text, false);
    }
    /* of sizes the word stands for the number below 0 */
    if (*unit != '\0' && low == -1) {
        expect(f, name, "unlimited", true);
        assert_true(field_number(f, base, &number) && number == -1);
        expect(f, name, "0 B", true);
    } else {
        snprintf(text, sizeof text, "%lld%s", low, unit);
        expect(f, name, text, true);
    }
    if (f->min > -9e18) {
        snprintf(text, sizeof text, "%lld%s", low - 1, unit);
        expect(f, name, text, false);
    }
}

static void whole_numbers_reach_their_limits(void **state)
{
    (void)state;
    on_fields(whole_number_limits);
}

/* ---- real numbers ---- */

/* The text that the program itself writes for a value. */
static void write_value(const struct field *f, double x, char text[200])
{
    struct text t = {0};
    memset(base, 0, sizeof base);
    memcpy(base + f->offset, &x, sizeof x);
    field_print(f, base, &t);
    snprintf(text, 200, "%s", t.s);
    text_free(&t);
}

static void real_limits(const struct field *f, const char *name)
{
    if (f->kind != FIELD_REAL) return;
    char text[200], why[200] = "";
    const double limit[2] = {f->min, f->max};
    for (int side = 0; side < 2; side++) {
        if (!isfinite(limit[side]) || fabs(limit[side]) > 1e300) continue;
        write_value(f, limit[side], text);
        if (!takes(f, name, text, why)) fail_msg("%s: %s %s", name, text, why);
        double x;
        memcpy(&x, base + f->offset, sizeof x);
        assert_true(x == limit[side]);
        /* the next number outside */
        const double out = nextafter(limit[side], side == 0 ? -INFINITY : INFINITY);
        write_value(f, out, text);
        expect(f, name, text, false);
    }
}

static void real_numbers_reach_their_limits(void **state)
{
    (void)state;
    on_fields(real_limits);
}

/* ---- words and lists ---- */

static void every_word(const struct field *f, const char *name)
{
    if (f->kind == FIELD_BOOL) {
        static const char *const none[] = {"maybe", "1", "", "truee", "tru"};
        expect(f, name, "true", true);
        assert_true(*(bool *)(void *)(base + f->offset));
        expect(f, name, "false", true);
        assert_false(*(bool *)(void *)(base + f->offset));
        for (int i = 0; i < 5; i++) expect(f, name, none[i], false);
    }
    if (f->kind != FIELD_CHOICE) return;
    int n = 0;
    for (; f->choice[n] != NULL; n++) {
        char longer[100];
        double number;
        expect(f, name, f->choice[n], true);
        int is;
        memcpy(&is, base + f->offset, sizeof is);
        assert_int_equal(is, n);
        (void)number;
        snprintf(longer, sizeof longer, "%sx", f->choice[n]);
        expect(f, name, longer, false);
        for (int k = 0; k < n; k++) assert_string_not_equal(f->choice[k], f->choice[n]);
    }
    assert_true(n > 1);
}

static void each_word_is_its_own_number(void **state)
{
    (void)state;
    on_fields(every_word);
}

/* As many entries as there is room for, and one more. */
static void full_lists(const struct field *f, const char *name)
{
    if (f->kind != FIELD_INTS) return;
    struct text t = {0};
    for (int i = 0; i < f->capacity; i++) text_add(&t, "%s%d", i > 0 ? ", " : "", (int)f->max);
    expect(f, name, t.s, true);
    int entry, count;
    memcpy(&entry, base + f->offset + sizeof entry * (size_t)(f->capacity - 1), sizeof entry);
    assert_int_equal(entry, (int)f->max);
    if (f->count > 0) {
        memcpy(&count, base + f->count, sizeof count);
        assert_int_equal(count, f->capacity);
    }
    text_add(&t, ", %d", (int)f->max);
    expect(f, name, t.s, false);
    text_free(&t);
    text_add(&t, "%d, %lld", (int)f->max, (long long)f->max + 1);
    expect(f, name, t.s, false);
    text_free(&t);
}

static void lists_take_as_many_as_there_is_room_for(void **state)
{
    (void)state;
    on_fields(full_lists);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texts_have_room_for_one_byte_less_than_their_capacity),
        cmocka_unit_test(whole_numbers_reach_their_limits),
        cmocka_unit_test(real_numbers_reach_their_limits),
        cmocka_unit_test(each_word_is_its_own_number),
        cmocka_unit_test(lists_take_as_many_as_there_is_room_for),
    };
    return cmocka_run_group_tests(tests, make_arena, drop_arena);
}
