/* test_store_faults.c - databases that cannot be used, each through a real file: what is said, what
 * is left behind. */
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>
#include <sqlite3.h>

#include "base/arena.h"
#include "base/progress.h"
#include "base/text.h"
#include "../support/made_run.h"
#include "../support/scratch.h"
#include "database_file.h"
#include "store/store.h"

static void write_file(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

/* A database of ours with `count` runs. */
static void fill(const char *path, int count)
{
    struct err e = {0};
    struct arena *a = arena_create();
    struct store *s = store_open(path, STORE_WRITE, &e);
    assert_non_null(s);
    for (int i = 0; i < count; i++) {
        struct run_spec spec = made_spec(a, "t3e-300", 16, 16, i);
        struct run_result r = made_result(a, &spec);
        assert_true(store_put(s, &spec, NULL, &r, &e));
    }
    store_close(s);
    arena_destroy(a);
}

static bool take_count(void *context, int ncolumn, const char *const *name,
                       const char *const *value)
{
    (void)ncolumn;
    (void)name;
    *(int *)context = atoi(value[0]);
    return false;
}

static int count_runs(const char *path)
{
    struct err e = {0};
    int count = -1;
    struct store *s = store_open(path, STORE_READ, &e);
    if (s == NULL) fail_msg("%s", e.text);
    assert_true(store_select(s, "SELECT count(*) FROM run", 0, NULL, take_count, &count, &e));
    int bad = -1;
    assert_true(
        store_select(s, "SELECT count(*) FROM pragma_integrity_check WHERE integrity_check <> 'ok'",
                     0, NULL, take_count, &bad, &e));
    assert_int_equal(bad, 0);
    store_close(s);
    return count;
}

static void expect(struct fixture *f, const char *path, enum store_mode mode, enum err_kind kind,
                   const char *says)
{
    err_clear(&f->e);
    assert_null(store_open(path, mode, &f->e));
    if (f->e.kind != kind || !strstr(f->e.text, says))
        fail_msg("kind %d, expected %d: %s", f->e.kind, kind, f->e.text);
}

static void a_missing_database_is_no_input_and_is_not_made(void **state)
{
    struct fixture *f = *state;
    expect(f, f->path, STORE_READ, ERR_NO_INPUT, f->path);
    assert_int_equal(access(f->path, F_OK), -1);
}

static void a_missing_folder_cannot_be_written_to(void **state)
{
    struct fixture *f = *state;
    char path[256];
    expect(f, scratch_path(path, sizeof path, f->folder, "none/t.db"), STORE_WRITE, ERR_CREATE,
           "No such file or directory");
    write_file(f->path, "");
    expect(f, scratch_path(path, sizeof path, f->folder, "t.db/t.db"), STORE_WRITE, ERR_CREATE,
           "Not a directory");
}

static void a_folder_is_no_database(void **state)
{
    struct fixture *f = *state;
    expect(f, f->folder, STORE_WRITE, ERR_CREATE, "is a folder");
    expect(f, f->folder, STORE_READ, ERR_DATA, "is a folder");
}

static void other_files_are_refused_and_left_alone(void **state)
{
    struct fixture *f = *state;
    char text[2000];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    write_file(f->path, text);
    expect(f, f->path, STORE_READ, ERR_DATA, "is not a database of mimdsim");
    expect(f, f->path, STORE_WRITE, ERR_DATA, "is not a database of mimdsim");
    struct text now = {0};
    assert_true(text_read_file(&now, f->path, &(struct err){0}));
    assert_string_equal(now.s, text);
    text_free(&now);
}

static void databases_of_other_programs_are_refused(void **state)
{
    struct fixture *f = *state;
    sql(f->path, "CREATE TABLE theirs (x)");
    expect(f, f->path, STORE_READ, ERR_DATA, "another program");
    expect(f, f->path, STORE_WRITE, ERR_DATA, "another program");
    sql(f->path, "DROP TABLE theirs; PRAGMA application_id = 252006673");
    expect(f, f->path, STORE_WRITE, ERR_DATA, "another program");
}

static void a_newer_schema_is_refused_with_both_versions(void **state)
{
    struct fixture *f = *state;
    fill(f->path, 1);
    sql(f->path, "PRAGMA user_version = 42");
    expect(f, f->path, STORE_READ, ERR_DATA, "version 42, this program knows versions 4 to 10");
    expect(f, f->path, STORE_WRITE, ERR_DATA, "newer mimdsim");
    sql(f->path, "PRAGMA user_version = 7");
    assert_int_equal(count_runs(f->path), 1);
}

static void an_empty_file_becomes_a_database(void **state)
{
    struct fixture *f = *state;
    write_file(f->path, "");
    expect(f, f->path, STORE_READ, ERR_DATA, "empty");
    fill(f->path, 2);
    assert_int_equal(count_runs(f->path), 2);
}

static void a_locked_database_is_busy_after_two_seconds(void **state)
{
    struct fixture *f = *state;
    fill(f->path, 1);
    sqlite3 *db;
    assert_int_equal(sqlite3_open(f->path, &db), SQLITE_OK);
    assert_int_equal(sqlite3_exec(db, "BEGIN IMMEDIATE", NULL, NULL, NULL), SQLITE_OK);
    double start = host_seconds();
    expect(f, f->path, STORE_WRITE, ERR_BUSY, "is locked by another program");
    assert_true(host_seconds() - start > 1.5);
    assert_int_equal(count_runs(f->path), 1); /* readers are not disturbed */
    assert_int_equal(sqlite3_exec(db, "ROLLBACK", NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(db);
    fill(f->path, 2);
}

/* Run `body` in a child without the rights of root, which every file obeys; its exit status. */
static int without_root(void (*body)(struct fixture *), struct fixture *f)
{
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(99);
        body(f);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* In a child an assertion of cmocka is of no use: leave with a number that says where. */
#define REQUIRE(cond)                                                                              \
    do {                                                                                           \
        if (!(cond)) {                                                                             \
            fprintf(stderr, "line %d: %s: %s\n", __LINE__, #cond, f->e.text);                      \
            _exit(1);                                                                              \
        }                                                                                          \
    } while (0)

static void open_read_only(struct fixture *f)
{
    err_clear(&f->e);
    REQUIRE(store_open(f->path, STORE_WRITE, &f->e) == NULL);
    REQUIRE(f->e.kind == ERR_IO && strstr(f->e.text, "read-only"));
    int count = 0;
    err_clear(&f->e);
    struct store *s = store_open(f->path, STORE_READ, &f->e);
    REQUIRE(s != NULL);
    REQUIRE(store_select(s, "SELECT count(*) FROM run", 0, NULL, take_count, &count, &f->e) &&
            count == 1);
    store_close(s);
}

static void a_read_only_database_can_be_read_but_not_written(void **state)
{
    struct fixture *f = *state;
    fill(f->path, 1);
    assert_int_equal(chmod(f->path, 0444), 0);
    assert_int_equal(chmod(f->folder, 0555), 0);
    int status = without_root(open_read_only, f);
    assert_int_equal(chmod(f->folder, 0755), 0);
    assert_int_equal(status, 0);
}

static void create_in_closed_folder(struct fixture *f)
{
    REQUIRE(store_open(f->path, STORE_WRITE, &f->e) == NULL);
    REQUIRE(f->e.kind == ERR_CREATE && strstr(f->e.text, "Permission denied"));
}

static void a_folder_that_cannot_be_written_is_said_at_once(void **state)
{
    struct fixture *f = *state;
    assert_int_equal(chmod(f->folder, 0555), 0);
    int status = without_root(create_in_closed_folder, f);
    assert_int_equal(chmod(f->folder, 0755), 0);
    assert_int_equal(status, 0);
}

/* A disk that ends after `bytes`: writes beyond fail as they do on a full one. */
static void limit_files(rlim_t bytes)
{
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &(struct rlimit){bytes, bytes});
}

static void create_on_full_disk(struct fixture *f)
{
    limit_files(20000);
    REQUIRE(store_open(f->path, STORE_WRITE, &f->e) == NULL);
    REQUIRE(f->e.kind == ERR_IO);
    limit_files(0);
    err_clear(&f->e);
    REQUIRE(store_open(f->path, STORE_WRITE, &f->e) == NULL);
    REQUIRE(f->e.kind == ERR_IO);
}

static void no_file_is_left_of_one_that_could_not_be_made(void **state)
{
    struct fixture *f = *state;
    assert_int_equal(chmod(f->folder, 0777), 0);
    assert_int_equal(without_root(create_on_full_disk, f), 0);
    assert_int_equal(rmdir(f->folder), 0); /* empty */
    assert_int_equal(mkdir(f->folder, 0755), 0);
}

static void put_on_full_disk(struct fixture *f)
{
    struct arena *a = arena_create();
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    REQUIRE(s != NULL);
    struct run_spec spec = made_spec(a, "t3e-300", 256, 256, 99);
    struct run_result r = made_result(a, &spec);
    limit_files(30000);
    REQUIRE(!store_put(s, &spec, NULL, &r, &f->e));
    REQUIRE(f->e.kind == ERR_IO);
    REQUIRE(!store_has(s, &spec));
}

static void a_full_disk_loses_only_the_run_in_flight(void **state)
{
    struct fixture *f = *state;
    fill(f->path, 3);
    assert_int_equal(chmod(f->folder, 0777), 0);
    assert_int_equal(chmod(f->path, 0666), 0);
    assert_int_equal(without_root(put_on_full_disk, f), 0);
    assert_int_equal(count_runs(f->path), 3);
    fill(f->path, 4);
    assert_int_equal(count_runs(f->path), 4);
}

/* A campaign that reports each stored run through a pipe until it is killed. */
static void run_for_ever(struct fixture *f, int told)
{
    struct arena *a = arena_create();
    struct store *s = store_open(f->path, STORE_WRITE, &f->e);
    REQUIRE(s != NULL);
    for (int i = 0;; i++) {
        struct run_spec spec = made_spec(a, "t3e-300", 64, 64, i);
        struct run_result r = made_result(a, &spec);
        REQUIRE(store_put(s, &spec, NULL, &r, &f->e));
        REQUIRE(write(told, &i, sizeof i) == sizeof i);
    }
}

static void kill_9_loses_at_most_the_run_in_flight(void **state)
{
    struct fixture *f = *state;
    for (int round = 0; round < 10; round++) {
        /* the log of the killed campaign stays behind, as when a user removes the database */
        unlink(f->path);
        int pipes[2], last = -1, i;
        assert_int_equal(pipe(pipes), 0);
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) run_for_ever(f, pipes[1]);
        close(pipes[1]);
        while (last < round * 3 && read(pipes[0], &i, sizeof i) == sizeof i) last = i;
        usleep((useconds_t)(round * 300));
        kill(child, SIGKILL);
        while (read(pipes[0], &i, sizeof i) == sizeof i) last = i;
        close(pipes[0]);
        assert_int_equal(waitpid(child, NULL, 0), child);
        int stored = count_runs(f->path);
        assert_in_range(stored, last + 1, last + 2);
    }
}

static void a_creation_that_was_killed_is_taken_up_again(void **state)
{
    struct fixture *f = *state;
    for (int round = 0; round < 10; round++) {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            store_close(store_open(f->path, STORE_WRITE, &f->e));
            _exit(0);
        }
        usleep((useconds_t)(round * 250));
        kill(child, SIGKILL);
        assert_int_equal(waitpid(child, NULL, 0), child);
        fill(f->path, 1);
        assert_int_equal(count_runs(f->path), 1);
        unlink(f->path);
    }
}

static void two_writers_at_once_lose_nothing(void **state)
{
    struct fixture *f = *state;
    pid_t child[2];
    for (int c = 0; c < 2; c++) {
        child[c] = fork();
        assert_true(child[c] >= 0);
        if (child[c] != 0) continue;
        struct arena *a = arena_create();
        struct store *s = store_open(f->path, STORE_WRITE, &f->e);
        REQUIRE(s != NULL);
        for (int i = 0; i < 30; i++) {
            struct run_spec spec = made_spec(a, "t3e-300", 8, 8, i * 2 + c);
            struct run_result r = made_result(a, &spec);
            REQUIRE(store_put(s, &spec, NULL, &r, &f->e));
        }
        store_close(s);
        _exit(0);
    }
    for (int c = 0; c < 2; c++) {
        int status;
        assert_int_equal(waitpid(child[c], &status, 0), child[c]);
        assert_int_equal(status, 0);
    }
    assert_int_equal(count_runs(f->path), 60);
}

static void a_path_with_odd_characters_works(void **state)
{
    struct fixture *f = *state;
    scratch_path(f->path, sizeof f->path, f->folder, "a b?c#d%41'\"\xc3\xa9.db");
    fill(f->path, 1);
    assert_int_equal(chmod(f->path, 0444), 0);
    assert_int_equal(chmod(f->folder, 0555), 0);
    int status = without_root(open_read_only, f);
    assert_int_equal(chmod(f->folder, 0755), 0);
    assert_int_equal(status, 0);
}

/* Names that beside_open draws, as a crash would leave them. */
static void what_a_crash_left_beside_is_removed_and_nothing_else(void **state)
{
    struct fixture *f = *state;
    char left[256], link_like[256], notes[256], held[256], victim[256];
    write_file(scratch_path(left, sizeof left, f->folder, "t.db.new-aB3dE6.part"), "half");
    write_file(scratch_path(notes, sizeof notes, f->folder, "t.db.new-my-notes.part"), "mine");
    write_file(scratch_path(victim, sizeof victim, f->folder, "victim"), "precious");
    assert_int_equal(symlink(victim, scratch_path(link_like, sizeof link_like, f->folder,
                                                  "t.db.new-abcdef.part")),
                     0);
    write_file(scratch_path(held, sizeof held, f->folder, "t.db.new-123456.part"), "being written");
    int file = open(held, O_RDONLY);
    assert_int_equal(flock(file, LOCK_EX), 0); /* as the process that writes it does */
    fill(f->path, 1);
    assert_int_equal(access(left, F_OK), -1);
    assert_int_equal(access(notes, F_OK), 0);
    assert_int_equal(access(held, F_OK), 0);
    close(file);
    struct stat info;
    assert_int_equal(lstat(link_like, &info), 0);
    assert_int_equal(stat(victim, &info), 0);
    assert_int_equal(info.st_size, 8);
    /* The database is there now: the next opening removes what its writer left. */
    write_file(left, "half");
    fill(f->path, 1);
    assert_int_equal(access(left, F_OK), -1);
    assert_int_equal(access(held, F_OK), -1);
}

static void a_new_database_goes_through_no_link_and_has_the_usual_mode(void **state)
{
    struct fixture *f = *state;
    char victim[256], name[300];
    write_file(scratch_path(victim, sizeof victim, f->folder, "victim"), "precious");
    snprintf(name, sizeof name, "%s.new-%ld", f->path,
             (long)getpid()); /* a name that can be foreseen */
    assert_int_equal(symlink(victim, name), 0);
    mode_t mask = umask(027);
    fill(f->path, 1);
    umask(mask);
    struct stat info;
    assert_int_equal(stat(f->path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
    assert_int_equal(info.st_nlink, 1);
    assert_int_equal(stat(victim, &info), 0);
    assert_int_equal(info.st_size, 8);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_missing_database_is_no_input_and_is_not_made),
        TEST(a_missing_folder_cannot_be_written_to),
        TEST(a_folder_is_no_database),
        TEST(other_files_are_refused_and_left_alone),
        TEST(databases_of_other_programs_are_refused),
        TEST(a_newer_schema_is_refused_with_both_versions),
        TEST(an_empty_file_becomes_a_database),
        TEST(a_locked_database_is_busy_after_two_seconds),
        TEST(a_read_only_database_can_be_read_but_not_written),
        TEST(a_folder_that_cannot_be_written_is_said_at_once),
        TEST(no_file_is_left_of_one_that_could_not_be_made),
        TEST(a_full_disk_loses_only_the_run_in_flight),
        TEST(kill_9_loses_at_most_the_run_in_flight),
        TEST(a_creation_that_was_killed_is_taken_up_again),
        TEST(two_writers_at_once_lose_nothing),
        TEST(a_path_with_odd_characters_works),
        TEST(what_a_crash_left_beside_is_removed_and_nothing_else),
        TEST(a_new_database_goes_through_no_link_and_has_the_usual_mode),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
