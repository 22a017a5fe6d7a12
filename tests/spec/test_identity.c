/* test_identity.c - what identifies a run: every setting that is not its default, and nothing
 * else. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "../support/arena_fixture.h"
#include "base/arena.h"
#include "base/digest.h"
#include "random_value.h"
#include "spec/identity.h"
#include "spec/spec_fields.h"

/* A random value for this field; false when it is the one it has already. */
static bool change(const struct field_table *t, const struct field *f, struct run_spec *run,
                   struct random *random)
{
    char text[1024], why[256] = "";
    struct text before = {0}, after = {0};
    void *base = (char *)run + t->offset;
    field_print(f, base, &before);
    random_value(f, random, text, sizeof text);
    if (!field_set(f, base, text, arena, why, (int)sizeof why))
        fail_msg("%s: %s: %s", f->key, text, why);
    field_print(f, base, &after);
    bool changed = strcmp(before.s ? before.s : "", after.s ? after.s : "") != 0;
    text_free(&before);
    text_free(&after);
    return changed;
}

/* How many lines of `text` begin with this key. */
static int names(const char *text, const char *key)
{
    int n = 0;
    char wanted[128];
    snprintf(wanted, sizeof wanted, "%s = ", key);
    for (const char *at = text; at && (at = strstr(at, wanted)); at += strlen(wanted))
        n += at == text || at[-1] == '\n';
    return n;
}

static void a_change_of_any_setting_changes_the_identity(void **state)
{
    (void)state;
    int n, checked = 0;
    const struct field_table *const *table = field_tables(&n);
    struct random random = random_make(3, 0, 0);
    struct run_spec run, changed;
    run_spec_defaults(&run, arena);
    /* From the defaults on, every change stays: identities of runs far from the defaults are told
     * apart, too. */
    for (int round = 0; round < 8; round++)
        for (int i = 0; i < n; i++)
            for (int j = 0; j < table[i]->nfield; j++) {
                const struct field *f = &table[i]->field[j];
                run_identify(&run, arena);
                changed = run;
                bool other = change(table[i], f, &changed, &random);
                run_identify(&changed, arena);
                bool same = strcmp(run.config_hash, changed.config_hash) == 0;
                /* What cannot act is no part of it, whatever its value. */
                const bool asleep =
                    f->dormant && f->dormant((const char *)&run + table[i]->offset);
                if (same != (f->label || !other || asleep))
                    fail_msg("%s: %s", f->key, same ? "not in the identity" : "in it");
                checked += !same;
                run = changed;
            }
    assert_true(checked > 800);
}

static void repetitions_and_where_files_lie_are_no_part_of_it(void **state)
{
    (void)state;
    struct run_spec run, other;
    run_spec_defaults(&run, arena);
    text_copy(run.model.path, sizeof run.model.path, "here/robot.urdf");
    text_copy(run.model_file, sizeof run.model_file, "0123");
    run_identify(&run, arena);
    other = run;
    other.rep = 7;
    text_copy(other.model.path, sizeof other.model.path, "there/robot.urdf");
    run_identify(&other, arena);
    assert_string_equal(run.config_hash, other.config_hash);
    text_copy(other.model_file, sizeof other.model_file, "0124");
    run_identify(&other, arena);
    assert_string_not_equal(run.config_hash, other.config_hash);
}

/* Where a program's image lies is no matter; what it is, and each of its parameters, is. */
static void a_program_counts_by_its_content_and_its_parameters(void **state)
{
    (void)state;
    struct run_spec run, other, back;
    char why[128];
    run_spec_defaults(&run, arena);
    text_copy(run.program.file, sizeof run.program.file, "here/ring.c");
    text_copy(run.program.hash, sizeof run.program.hash, "0123");
    run.program.parameters = "n = 1000\nblock = 8 KiB\n";
    run_identify(&run, arena);
    other = run;
    text_copy(other.program.file, sizeof other.program.file, "there/ring.c");
    run_identify(&other, arena);
    assert_string_equal(run.config_hash, other.config_hash);
    assert_int_equal(names(run.config_text, "program.n"), 1);
    assert_int_equal(names(run.config_text, "program.file"), 1);
    /* The text tells all but the folder. */
    if (!run_from_text(&back, run.config_text, arena, why, sizeof why)) fail_msg("%s", why);
    assert_true(back.kernel.own);
    run_identify(&back, arena);
    assert_string_equal(run.config_hash, back.config_hash);
    other.program.parameters = "n = 1001\nblock = 8 KiB\n";
    run_identify(&other, arena);
    assert_string_not_equal(run.config_hash, other.config_hash);
    other = run;
    text_copy(other.program.hash, sizeof other.program.hash, "0124");
    run_identify(&other, arena);
    assert_string_not_equal(run.config_hash, other.config_hash);
}

/* A run as a later version of this program may have it: with one setting more. */
struct later_run {
    struct run_spec run;
    int chances;
};

/* Tables of this program; `last` gets a new setting as its row `at`. */
static void add_setting(struct field_table *last, struct field *rows, int at)
{
    const struct field_table *t = last;
    const struct field added = {.key = "chances",
                                .kind = FIELD_INT,
                                .offset = offsetof(struct later_run, chances),
                                .max = 10,
                                .fallback = "3",
                                .doc = "of later versions"};
    for (int i = 0; i < t->nfield + 1; i++)
        rows[i] = i < at ? t->field[i] : i == at ? added : t->field[i - 1];
    for (int i = 0; i < t->nfield + 1; i++)
        if (i != at) rows[i].offset += last->offset;
    *last = (struct field_table){.prefix = t->prefix,
                                 .doc = t->doc,
                                 .offset = 0,
                                 .size = sizeof(struct later_run),
                                 .nfield = t->nfield + 1,
                                 .field = rows};
    for (int i = 0; i < last->nfield; i++)
        if (i != at && rows[i].count) rows[i].count += kernel_table.offset;
}

static void identity_of(const struct field_table *const *table, int n, const void *base,
                        char hex[65], struct text *own)
{
    struct text full = {0};
    struct identity *x = identity_create(table, n);
    own->length = 0;
    identity_texts(x, base, "", &full, own);
    digest_sha256_hex(own->s, own->length, hex);
    identity_destroy(x);
    text_free(&full);
}

static void a_new_setting_with_a_default_changes_no_identity(void **state)
{
    (void)state;
    int n;
    const struct field_table *const *table = field_tables(&n), *with[8];
    struct field rows[64];
    char before[65], after[65];
    struct text own = {0};
    struct random random = random_make(5, 0, 0);
    for (int at = 0; at <= kernel_table.nfield; at++) {
        struct later_run later = {.chances = 3};
        struct field_table grown = kernel_table;
        run_spec_defaults(&later.run, arena);
        for (int j = 0; j < kernel_table.nfield; j += 2)
            change(&kernel_table, &kernel_table.field[j], &later.run, &random);
        add_setting(&grown, rows, at);
        for (int i = 0; i < n; i++) with[i] = table[i] == &kernel_table ? &grown : table[i];
        identity_of(table, n, &later, before, &own);
        identity_of(with, n, &later, after, &own);
        assert_string_equal(before, after);
        later.chances = 4;
        identity_of(with, n, &later, after, &own);
        assert_string_not_equal(before, after);
        assert_int_equal(names(own.s, "kernel.chances"), 1);
    }
    text_free(&own);
}

static void the_order_of_tables_and_rows_is_no_part_of_it(void **state)
{
    (void)state;
    int n;
    const struct field_table *const *table = field_tables(&n), *turned[8];
    struct field rows[64];
    char before[65], after[65];
    struct text own = {0};
    struct run_spec run;
    struct random random = random_make(7, 0, 0);
    struct field_table mixed = kernel_table;
    run_spec_defaults(&run, arena);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < table[i]->nfield; j += 3)
            change(table[i], &table[i]->field[j], &run, &random);
    for (int j = 0; j < mixed.nfield; j++) rows[j] = kernel_table.field[mixed.nfield - 1 - j];
    mixed.field = rows;
    for (int i = 0; i < n; i++) turned[i] = table[i == 0 ? 0 : n - i];
    for (int i = 0; i < n; i++) turned[i] = turned[i] == &kernel_table ? &mixed : turned[i];
    identity_of(table, n, &run, before, &own);
    identity_of(turned, n, &run, after, &own);
    assert_string_equal(before, after);
    text_free(&own);
}

static void remembered_texts_are_those_of_the_run_at_hand(void **state)
{
    (void)state;
    int n;
    const struct field_table *const *table = field_tables(&n);
    struct identity *x = identity_create(table, n);
    struct random random = random_make(9, 0, 0);
    struct run_spec run, alone;
    run_spec_defaults(&run, arena);
    for (int round = 0; round < 200; round++) {
        const struct field_table *t = table[random_below(&random, (uint64_t)n)];
        change(t, &t->field[random_below(&random, (uint64_t)t->nfield)], &run, &random);
        alone = run;
        identity_set(x, &run, arena);
        run_identify(&alone, arena);
        assert_string_equal(run.config_hash, alone.config_hash);
        assert_string_equal(run.config_text, alone.config_text);
    }
    identity_destroy(x);
}

static void a_configuration_reads_back_to_the_same_identity(void **state)
{
    (void)state;
    int n;
    const struct field_table *const *table = field_tables(&n);
    struct random random = random_make(13, 0, 0);
    struct run_spec run, again;
    char why[256] = "";
    run_spec_defaults(&run, arena);
    for (int round = 0; round < 20; round++) {
        run_identify(&run, arena);
        if (!run_from_text(&again, run.config_text, arena, why, sizeof why)) fail_msg("%s", why);
        run_identify(&again, arena);
        assert_string_equal(again.config_hash, run.config_hash);
        for (int i = 0; i < n; i++)
            for (int j = 0; j < table[i]->nfield; j++)
                change(table[i], &table[i]->field[j], &run, &random);
    }
    /* What an older program did not know has its default; what this one does not know is told. */
    run_spec_defaults(&run, arena);
    run_identify(&run, arena);
    assert_true(run_from_text(&again, "ranks = 1\n", arena, why, sizeof why));
    run_identify(&again, arena);
    assert_string_equal(again.config_hash, run.config_hash);
    assert_false(run_from_text(&again, "kernel.colour = red\n", arena, why, sizeof why));
    assert_string_equal(why, "there is no setting 'kernel.colour' any more");
    assert_false(run_from_text(&again, "ranks = many", arena, why, sizeof why));
    assert_non_null(strstr(why, "ranks = many: not a whole number"));
}

/* "key = default" of every setting that is part of an identity. */
static void list_defaults(struct text *out)
{
    int n;
    const struct field_table *const *table = field_tables(&n);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < table[i]->nfield; j++) {
            const struct field *f = &table[i]->field[j];
            if (f->label) continue;
            text_add(out, "%s%s%s = %s\n", table[i]->prefix, table[i]->prefix[0] ? "." : "", f->key,
                     f->fallback ? f->fallback : "(has to be given)");
        }
}

/* A default that changes would give runs of then the identity of other runs of now. New settings
 * are no harm: the file is then written anew from what this test leaves in the folder where it
 * runs. */
static void defaults_are_those_that_stored_identities_rest_on(void **state)
{
    (void)state;
    struct text now = {0}, then = {0}, path = {0};
    struct err e;
    err_clear(&e);
    list_defaults(&now);
    text_add(&path, "%s/tests/golden/defaults.txt", getenv("srcdir") ? getenv("srcdir") : ".");
    if (!text_read_file(&then, path.s, &e)) fail_msg("%s", e.text);
    if (strcmp(now.s, then.s) != 0) {
        FILE *out = fopen("defaults.txt.new", "w");
        assert_non_null(out);
        fputs(now.s, out);
        fclose(out);
        fail_msg(
            "tests/golden/defaults.txt is not defaults.txt.new. Where a default changed: raise "
            "STORE_VERSION, so that the identities of stored runs are computed anew. Then copy "
            "it.");
    }
    text_free(&now);
    text_free(&then);
    text_free(&path);
}

int main(void)
{
    const struct CMUnitTest test[] = {
        cmocka_unit_test(a_change_of_any_setting_changes_the_identity),
        cmocka_unit_test(repetitions_and_where_files_lie_are_no_part_of_it),
        cmocka_unit_test(a_program_counts_by_its_content_and_its_parameters),
        cmocka_unit_test(a_new_setting_with_a_default_changes_no_identity),
        cmocka_unit_test(the_order_of_tables_and_rows_is_no_part_of_it),
        cmocka_unit_test(remembered_texts_are_those_of_the_run_at_hand),
        cmocka_unit_test(a_configuration_reads_back_to_the_same_identity),
        cmocka_unit_test(defaults_are_those_that_stored_identities_rest_on),
    };
    return cmocka_run_group_tests(test, make_arena, drop_arena);
}
