/* test_publish.c - a database that gets its file at the end: nothing before, all of it then, and
 * the rows of others stay. */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "../support/made_run.h"
#include "../support/folder_fixture.h"
#include "store/image.h"
#include "store/store.h"
#include "store/temporary.h"

static struct store *opened(struct folder_fixture *f, enum store_mode mode)
{
    struct store *s = store_open(f->path, mode, &f->e);
    if (s == NULL) fail_msg("%s", f->e.text);
    return s;
}

/* One run, told from others by its repetition. */
static void put(struct folder_fixture *f, struct store *s, int rep)
{
    const struct run_spec spec = made_spec(f->a, "t3e-300", 16, 4, rep);
    const struct run_result r = made_result(f->a, &spec);
    if (!store_put(s, &spec, NULL, &r, &f->e)) fail_msg("%s", f->e.text);
}

static bool take_number(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    (void)ncolumn, (void)name;
    *(long *)context = strtol(value[0], NULL, 10);
    return false;
}

static long number(struct folder_fixture *f, struct store *s, const char *sql)
{
    long n = -1;
    if (!store_select(s, sql, 0, NULL, take_number, &n, &f->e)) fail_msg("%s: %s", sql, f->e.text);
    return n;
}

/* How many runs the file holds, as any reader sees it. */
static long runs_in_file(struct folder_fixture *f)
{
    struct store *s = opened(f, STORE_READ);
    const long n = number(f, s, "SELECT count(*) FROM run");
    assert_int_equal(number(f, s, "SELECT count(*) FROM stage"), 7 * n);
    store_close(s);
    return n;
}

static int files_in(const char *folder)
{
    int n = 0;
    DIR *d = opendir(folder);
    for (struct dirent *entry; (entry = readdir(d)) != NULL;) n += entry->d_name[0] != '.';
    closedir(d);
    return n;
}

static void the_file_is_there_when_it_is_whole(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, STORE_WHOLE);
    put(f, s, 0);
    assert_int_equal(files_in(f->folder), 0);
    assert_int_equal(number(f, s, "SELECT count(*) FROM run"), 1);
    assert_true(store_publish(s, &f->e));
    assert_int_equal(files_in(f->folder), 1);
    /* a second time there is nothing left to do, and the rows can still be asked for */
    assert_true(store_publish(s, &f->e));
    assert_int_equal(number(f, s, "SELECT count(*) FROM run"), 1);
    store_close(s);
    assert_int_equal(runs_in_file(f), 1);
}

static void it_is_a_database_like_any_other(void **state)
{
    struct folder_fixture *f = *state;
    char header[20] = "";
    struct store *s = opened(f, STORE_WHOLE);
    put(f, s, 0);
    assert_true(store_publish(s, &f->e));
    store_close(s);
    FILE *in = fopen(f->path, "rb");
    assert_int_equal(fread(header, 1, 20, in), 20);
    fclose(in);
    /* file format 1.3.3: written and read with a log */
    assert_int_equal(header[18], 2);
    assert_int_equal(header[19], 2);
    struct stat info;
    assert_int_equal(stat(f->path, &info), 0);
    const mode_t mask = umask(0);
    umask(mask);
    assert_int_equal(info.st_mode & 0777, 0666 & ~mask);
    /* and written to later */
    s = opened(f, STORE_WRITE);
    put(f, s, 1);
    store_close(s);
    assert_int_equal(runs_in_file(f), 2);
    assert_int_equal(files_in(f->folder), 1);
}

static const char objects[] = "SELECT count(*) FROM sqlite_schema",
                  whole[] = "SELECT count(*) FROM pragma_integrity_check WHERE "
                            "integrity_check = 'ok'",
                  indexed[] = "SELECT count(*) FROM run INDEXED BY run_by_point WHERE machine = "
                              "'t3e-300'";

/* Tables and views that a single run does not need are not shown at first: SQLite does not parse
 * them. The file has them, and so has whoever asks for one. */
static void all_tables_are_there_for_who_asks(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, STORE_SCRATCH);
    const long all = number(f, s, objects);
    store_close(s);
    for (int late = 0; late < 2; late++) {
        unlink(f->path);
        s = opened(f, STORE_WHOLE);
        put(f, s, 0);
        const long shown = number(f, s, objects);
        assert_true(shown > 20 && (image_has_front() ? shown < all : shown == all));
        /* before the file is made, and after */
        if (late) assert_true(store_publish(s, &f->e));
        assert_int_equal(number(f, s, objects), shown);
        /* with functions that are tables, and temporary ones, before and behind it */
        const char *listed = "SELECT count(*) FROM run r, json_each('[1, 2]') WHERE r.id = value";
        assert_int_equal(number(f, s, listed), 1);
        assert_true(store_temporary(s, "kept", "a INTEGER", &f->e));
        assert_int_equal(number(f, s, "SELECT count(*) FROM v_stage"), 7);
        assert_int_equal(number(f, s, objects), all);
        assert_int_equal(number(f, s, listed), 1);
        assert_int_equal(number(f, s, "SELECT count(*) FROM temp.kept"), 0);
        assert_int_equal(number(f, s, whole), 1);
        /* it goes on as before */
        put(f, s, 1);
        assert_int_equal(number(f, s, "SELECT count(*) FROM run"), 2);
        if (!late) assert_true(store_publish(s, &f->e));
        store_close(s);
        assert_int_equal(runs_in_file(f), late ? 1 : 2);
        s = opened(f, STORE_READ);
        assert_int_equal(number(f, s, objects), all);
        assert_int_equal(number(f, s, whole), 1);
        assert_int_equal(number(f, s, indexed), late ? 1 : 2);
        store_close(s);
    }
    /* a row of a study */
    unlink(f->path);
    s = opened(f, STORE_WHOLE);
    assert_true(store_delete(s, "ladder_choice", "scenario", store_text("none"), &f->e));
    assert_int_equal(number(f, s, objects), all);
    store_close(s);
}

static void without_publishing_nothing_is_left(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, STORE_WHOLE);
    put(f, s, 0);
    store_close(s);
    assert_int_equal(files_in(f->folder), 0);
}

static void a_database_that_is_there_is_written_at_once(void **state)
{
    struct folder_fixture *f = *state;
    store_close(opened(f, STORE_WRITE));
    struct store *s = opened(f, STORE_WHOLE);
    put(f, s, 0);
    assert_int_equal(runs_in_file(f), 1);
    assert_true(store_publish(s, &f->e));
    store_close(s);
    assert_int_equal(runs_in_file(f), 1);
}

static void rows_join_those_of_a_program_that_was_faster(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, STORE_WHOLE), *other = opened(f, STORE_WHOLE);
    put(f, s, 0);
    put(f, other, 0);
    put(f, other, 1);
    assert_true(store_publish(other, &f->e));
    store_close(other);
    put(f, s, 2);
    if (!store_publish(s, &f->e)) fail_msg("%s", f->e.text);
    store_close(s);
    /* repetition 0 is one run, whoever made it */
    assert_int_equal(runs_in_file(f), 3);
    assert_int_equal(files_in(f->folder), 1);
}

static void the_file_of_another_program_is_never_replaced(void **state)
{
    struct folder_fixture *f = *state;
    struct store *s = opened(f, STORE_WHOLE);
    put(f, s, 0);
    FILE *out = fopen(f->path, "w");
    fputs("a letter", out);
    fclose(out);
    assert_false(store_publish(s, &f->e));
    assert_int_equal(f->e.kind, ERR_DATA);
    store_close(s);
    char text[20] = "";
    FILE *in = fopen(f->path, "r");
    assert_non_null(fgets(text, sizeof text, in));
    fclose(in);
    assert_string_equal(text, "a letter");
    assert_int_equal(files_in(f->folder), 1);
}

static void a_folder_that_is_gone_is_told(void **state)
{
    struct folder_fixture *f = *state;
    char folder[256], path[300];
    scratch_path(folder, sizeof folder, f->folder, "sub");
    assert_int_equal(mkdir(folder, 0777), 0);
    scratch_path(path, sizeof path, folder, "t.db");
    struct store *s = store_open(path, STORE_WHOLE, &f->e);
    assert_non_null(s);
    put(f, s, 0);
    assert_int_equal(rmdir(folder), 0);
    assert_false(store_publish(s, &f->e));
    assert_int_equal(f->e.kind, ERR_CREATE);
    assert_non_null(strstr(f->e.text, "No such file"));
    store_close(s);
    /* without the folder it is told before anything is computed */
    err_clear(&f->e);
    assert_null(store_open(path, STORE_WHOLE, &f->e));
    assert_int_equal(f->e.kind, ERR_CREATE);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, drop_folder)
    const struct CMUnitTest tests[] = {
        TEST(the_file_is_there_when_it_is_whole),
        TEST(it_is_a_database_like_any_other),
        TEST(all_tables_are_there_for_who_asks),
        TEST(without_publishing_nothing_is_left),
        TEST(a_database_that_is_there_is_written_at_once),
        TEST(rows_join_those_of_a_program_that_was_faster),
        TEST(the_file_of_another_program_is_never_replaced),
        TEST(a_folder_that_is_gone_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
