/* test_published_mutants.c - the table of published figures checked: changed figures and words are
 * found or refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../plan/scratch.h"
#include "app/validation.h"
#include "base/random.h"
#include "base/text.h"

enum { PICKS = 4, CELLS = 14, VALUE = 4 };

/* The table as it is, with every figure measured once. */
struct table {
    struct arena *arena;
    struct scratch folder;
    struct text text;
    struct published *row;
    struct validated *outcome;
    int n;
};

static int set_up(void **state)
{
    struct table *t = calloc(1, sizeof *t);
    struct err e;
    err_clear(&e);
    scratch_open(&t->folder);
    t->arena = arena_create();
    assert_true(text_read_file(&t->text, MIMDSIM_SRCDIR "/machines/published.csv", &e));
    assert_true(
        published_read(MIMDSIM_SRCDIR "/machines/published.csv", t->arena, &t->row, &t->n, &e));
    t->outcome = TAKE(t->arena, t->n, struct validated);
    for (int i = 0; i < t->n; i++)
        if (!validation_measure(&t->row[i], &t->outcome[i], t->arena, &e)) fail_msg("%s", e.text);
    *state = t;
    return 0;
}

static int tear_down(void **state)
{
    struct table *t = *state;
    scratch_close(&t->folder);
    text_free(&t->text);
    arena_destroy(t->arena);
    free(t);
    return 0;
}

/* Where cell c of line `line` (1: the first row) begins and ends; quoted cells with their quotes.
 */
static void cell(const char *text, int line, int c, size_t *begin, size_t *end)
{
    const char *s = text;
    for (int i = 0; i < line; i++) s = strchr(s, '\n') + 1;
    for (int i = 0;; i++) {
        const char *from = s;
        bool quoted = *s == '"';
        s = quoted ? strchr(s + 1, '"') + 1 : s + strcspn(s, ",\n");
        *begin = (size_t)(from - text), *end = (size_t)(s - text);
        if (i == c || *s == '\n' || *s == '\0') return;
        s++;
    }
}

static char *with_cell(const char *text, int line, int c, const char *value)
{
    size_t begin, end;
    struct text t = {0};
    cell(text, line, c, &begin, &end);
    text_add_bytes(&t, text, begin);
    text_add(&t, "%s", value);
    text_add(&t, "%s", text + end);
    return t.s;
}

static char *take_cell(const char *text, int line, int c)
{
    size_t begin, end;
    cell(text, line, c, &begin, &end);
    return strndup(text + begin, end - begin);
}

struct tally {
    int made, refused, found, small;
};

/* What validate says of row i of a changed table; `must`: it may not be accepted. Takes `text`. */
static void judge(struct table *t, int i, char *text, bool must, const char *what,
                  struct tally *sum)
{
    struct arena *a = arena_create();
    struct published *row;
    struct err e;
    int n;
    err_clear(&e);
    const char *path = scratch_write(&t->folder, "published.csv", text);
    const bool read = published_read(path, a, &row, &n, &e);
    if (!read) {
        assert_int_equal(e.kind, ERR_DATA);
        assert_true(e.line > 0);
        sum->made++, sum->refused++;
    } else {
        struct validated o = t->outcome[i];
        const struct published *was = &t->row[i];
        validation_judge(&row[i], &o);
        /* Inside of a published range every figure is right: the range is the tolerance. */
        const double range = was->low < was->high
                                 ? fmax(was->high - was->value, was->value - was->low) / was->value
                                 : 0;
        const double least = 10 * fmax(o.tolerance, range);
        const bool large = fabs(row[i].value / was->value - 1) > least;
        const bool fails = strcmp(o.verdict, "fail") == 0;
        if (!o.measured || !(large || must)) sum->small++;
        else sum->made++, sum->found += fails;
        if (o.measured && (large || must) && !fails)
            fprintf(stderr, "accepted: %s of %s: %s\n", what, was->id, o.verdict);
    }
    free(text);
    arena_destroy(a);
}

static void print(const char *what, const struct tally *s)
{
    print_message("%-18s %5d mutants: %5.1f %% found (%d fail, %d refused); %d change too little, "
                  "or what nobody measures\n",
                  what, s->made, s->made ? 100.0 * (s->found + s->refused) / s->made : 100,
                  s->found, s->refused, s->small);
    assert_int_equal(s->found + s->refused, s->made);
}

/* One digit of the value becomes another, or the number ten or a hundred times as much. */
static void changed_figures_are_found(void **state)
{
    struct table *t = *state;
    struct random r = random_make(1414, 0, 0);
    struct tally digit = {0}, sign = {0}, exchange = {0};
    for (int i = 0; i < t->n; i++) {
        char *value = take_cell(t->text.s, i + 1, VALUE), other[64];
        for (int k = 0; k < PICKS; k++) {
            char *place = &value[random_below(&r, strlen(value))];
            const char was = *place;
            if (was >= '0' && was <= '9')
                *place = (char)('0' + (was - '0' + 1 + (int)random_below(&r, 9)) % 10);
            else *place = '0'; /* the point: 2.5 becomes 205 */
            judge(t, i, with_cell(t->text.s, i + 1, VALUE, value), false, "digit", &digit);
            *place = was;
        }
        snprintf(other, sizeof other, "%s00", value); /* 2.5 stays what it is: too little */
        judge(t, i, with_cell(t->text.s, i + 1, VALUE, other), false, "digit", &digit);
        snprintf(other, sizeof other, "-%s", value);
        judge(t, i, with_cell(t->text.s, i + 1, VALUE, other), true, "sign", &sign);
        for (int k = 0; k < PICKS; k++) {
            char *theirs = take_cell(t->text.s, 1 + (int)random_below(&r, (uint64_t)t->n), VALUE);
            judge(t, i, with_cell(t->text.s, i + 1, VALUE, theirs), false, "exchange", &exchange);
            free(theirs);
        }
        free(value);
    }
    print("digit", &digit);
    print("sign", &sign);
    print("exchange", &exchange);
    assert_true(digit.made > 150 && exchange.made > 200);
}

/* A letter more in each word, an identity twice, a column left out of the header or of a row. */
static void changed_words_are_refused(void **state)
{
    struct table *t = *state;
    static const int word[] = {2, 7, 8, 9};
    struct tally words = {0}, ids = {0}, columns = {0};
    for (int i = 0; i < t->n; i++) {
        for (int k = 0; k < 4; k++) {
            char *was = take_cell(t->text.s, i + 1, word[k]), wrong[64];
            snprintf(wrong, sizeof wrong, "%sx", was);
            judge(t, i, with_cell(t->text.s, i + 1, word[k], wrong), true, "word", &words);
            free(was);
        }
        char *id = take_cell(t->text.s, 1 + (i + 1) % t->n, 0);
        judge(t, i, with_cell(t->text.s, i + 1, 0, id), true, "identity", &ids);
        free(id);
    }
    for (int c = 0; c < CELLS; c++)
        judge(t, 0, with_cell(t->text.s, 0, c, "?"), true, "column", &columns);
    for (int i = 0; i < t->n; i++)
        judge(t, i, with_cell(t->text.s, i + 1, 12, ""), true, "source", &columns);
    print("words", &words);
    print("identities", &ids);
    print("columns, sources", &columns);
    assert_int_equal(words.refused, 4 * t->n);
    assert_int_equal(ids.refused, t->n);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(changed_figures_are_found),
        cmocka_unit_test(changed_words_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
