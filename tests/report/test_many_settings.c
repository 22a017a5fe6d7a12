/* test_many_settings.c - databases in which more settings vary than a sheet has columns for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/made_run.h"
#include "../support/store_fixture.h"
#include "base/text.h"
#include "report/compare.h"
#include "report/plot_sheet.h"
#include "spec/field.h"

/* Runs of which each differs from the first in one setting of its own, of programs or models: up to
 * `most` of them. Returns how many. */
static int put_varied(struct store_fixture *f, int most)
{
    int ntable, n = 0;
    const struct field_table *const *table = field_tables(&ntable);
    for (int t = 0; t < ntable; t++)
        for (int i = 0; i < table[t]->nfield && n < most; i++) {
            const struct field *row = &table[t]->field[i];
            const bool mine = strcmp(table[t]->prefix, "model") == 0 ||
                              strcmp(table[t]->prefix, "kernel") == 0;
            if (!mine || row->kind > FIELD_BOOL) continue;
            struct run_spec spec = made_spec(f->a, "t3e-300", 8, 4, 0);
            void *at = (char *)&spec + table[t]->offset + row->offset;
            if (n == 0) /* the first is as it is */;
            else if (row->kind == FIELD_REAL) *(double *)at += 1;
            else if (row->kind == FIELD_INT) *(int *)at += 1;
            else if (row->kind == FIELD_BOOL) *(bool *)at = !*(bool *)at;
            else *(int64_t *)at += 1;
            made_identity(&spec, f->a);
            struct run_result r = made_result(f->a, &spec);
            if (!store_put(f->s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
            n++;
        }
    return n;
}

/* No two of them are one point, however many settings vary. */
static void any_number_of_settings_tells_points_apart(void **state)
{
    struct store_fixture *f = *state;
    struct compare c;
    struct text ids = {0};
    const int n = put_varied(f, 70);
    assert_true(n >= 20);
    for (int i = 1; i <= n; i++) text_add(&ids, "%s%d", i > 1 ? "," : "[", i);
    text_add(&ids, "]");
    const struct compare_side side = {.name = "both", .store = f->s, .run_ids = ids.s};
    const struct compare_side sides[] = {side, side};
    if (!compare_make(&c, 2, sides, &f->e)) fail_msg("%s", f->e.text);
    assert_int_equal(c.npoint, n);
    compare_free(&c);
    text_free(&ids);
}

/* A sheet has room for some; how many are left out, and one of them, is told. */
static void settings_without_room_in_a_sheet_are_counted(void **state)
{
    struct store_fixture *f = *state;
    struct plot_sheet t;
    static const char *const key[] = {"makespan",   "speedup",       "efficiency",
                                      "sent_bytes", "compute_share", "wait_share"};
    const int few = put_varied(f, 10);
    if (!plot_sheet_runs(&t, f->s, 6, key, &f->e)) fail_msg("%s", f->e.text);
    assert_true(t.nleft == 0 && t.left == NULL);
    const int before = t.ncolumn;
    plot_sheet_free(&t);
    const int n = put_varied(f, 70);
    if (!plot_sheet_runs(&t, f->s, 6, key, &f->e)) fail_msg("%s", f->e.text);
    assert_int_equal(t.ncolumn, 40);
    /* each run more has a setting more, and each of these a column or none */
    assert_int_equal(t.nleft, n - few - (40 - before));
    assert_non_null(t.left);
    for (int i = 0; i < t.ncolumn; i++) assert_string_not_equal(t.column[i].key, t.left);
    plot_sheet_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(any_number_of_settings_tells_points_apart, make_store,
                                        drop_store),
        cmocka_unit_test_setup_teardown(settings_without_room_in_a_sheet_are_counted, make_store,
                                        drop_store),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
