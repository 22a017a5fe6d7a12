/* test_draft_folder.c - files that get their places together: whole, or as they were; what a
 * process left that ended half way goes, what a living one makes stays. */
#include <dirent.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "../support/scratch.h"
#include "base/draft_folder.h"

static char folder[128], drafts[160];

static int make_folder(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    scratch_path(drafts, sizeof drafts, folder, "fig");
    return 0;
}

static int drop_folder(void **state)
{
    (void)state;
    scratch_remove(folder);
    return 0;
}

static void put(const char *dir, const char *name, const char *content)
{
    char path[400];
    FILE *out = fopen(scratch_path(path, sizeof path, dir, name), "w");
    assert_non_null(out);
    fputs(content, out);
    fclose(out);
}

/* The content of a file of the folder, "" where it is not there. */
static const char *content(const char *name)
{
    static char text[64];
    char path[400];
    FILE *in = fopen(scratch_path(path, sizeof path, folder, name), "r");
    text[in ? fread(text, 1, sizeof text - 1, in) : 0] = '\0';
    if (in) fclose(in);
    return text;
}

/* How many entries of the folder are drafts. */
static int count_drafts(void)
{
    int n = 0;
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *d; (d = readdir(dir)) != NULL;) n += strstr(d->d_name, ".part") != NULL;
    closedir(dir);
    return n;
}

static bool is_data(const char *name) { return strstr(name, ".csv") != NULL; }
static bool is_picture(const char *name) { return strstr(name, ".svg") != NULL; }

static void chosen_files_get_their_places_and_the_rest_goes(void **state)
{
    struct draft_folder d;
    struct err e = {0};
    struct stat info;
    put(folder, "fig.csv", "old");
    put(folder, "fig.svg", "old picture");
    assert_true(draft_folder_begin(&d, drafts, &e));
    assert_int_equal(strncmp(d.path, drafts, strlen(drafts)), 0);
    assert_true(stat(d.path, &info) == 0 && S_ISDIR(info.st_mode));
    put(d.path, "fig.csv", "new");
    put(d.path, "fig.a.csv", "table");
    put(d.path, "fig.svg", "half of a pic");
    /* Nothing is seen before it is published. */
    assert_string_equal(content("fig.csv"), "old");
    assert_true(draft_folder_publish(&d, is_data, &e));
    assert_string_equal(content("fig.csv"), "new");
    assert_string_equal(content("fig.a.csv"), "table");
    assert_string_equal(content("fig.svg"), "old picture");
    draft_folder_end(&d);
    assert_string_equal(content("fig.svg"), "old picture");
    assert_int_equal(count_drafts(), 0);
    draft_folder_end(&d); /* a second time: nothing */
    (void)state;
}

/* As a process that lacks memory does it: no last words. */
static pid_t leave_drafts(bool stay, int tell[2])
{
    pid_t child = fork();
    if (child != 0) return child;
    struct draft_folder d;
    struct err e = {0};
    if (!draft_folder_begin(&d, drafts, &e)) _exit(1);
    put(d.path, "fig.svg", "half");
    (void)!write(tell[1], "x", 1);
    while (stay) pause();
    _exit(0);
}

static void what_an_ended_process_left_goes_and_what_a_living_one_makes_stays(void **state)
{
    struct draft_folder d;
    struct err e = {0};
    int tell[2];
    char x;
    (void)state;
    assert_int_equal(pipe(tell), 0);
    waitpid(leave_drafts(false, tell), NULL, 0);
    assert_int_equal(read(tell[0], &x, 1), 1);
    assert_int_equal(count_drafts(), 1);
    pid_t living = leave_drafts(true, tell);
    assert_int_equal(read(tell[0], &x, 1), 1);
    assert_int_equal(count_drafts(), 1); /* its own: it has removed the other one */
    assert_true(draft_folder_begin(&d, drafts, &e));
    assert_int_equal(count_drafts(), 2);
    draft_folder_end(&d);
    assert_int_equal(count_drafts(), 1);
    kill(living, SIGKILL);
    waitpid(living, NULL, 0);
    assert_true(draft_folder_begin(&d, drafts, &e));
    draft_folder_end(&d);
    assert_int_equal(count_drafts(), 0);
    close(tell[0]);
    close(tell[1]);
}

/* Links, files and folders of people with such a name. */
static void what_only_looks_like_a_draft_stays(void **state)
{
    char path[400], target[200];
    struct draft_folder d;
    struct err e = {0};
    (void)state;
    scratch_path(target, sizeof target, folder, "precious");
    mkdir(target, 0777);
    put(target, "thesis.tex", "x");
    assert_int_equal(
        symlink(target, scratch_path(path, sizeof path, folder, "fig.new-abcdef.part")), 0);
    put(folder, "fig.new-abcde.part", "five letters");
    put(folder, "other.new-abcdef.part", "of another figure");
    put(folder, "fig.new-abcdeg.part", "a file");
    assert_true(draft_folder_begin(&d, drafts, &e));
    draft_folder_end(&d);
    assert_int_equal(count_drafts(), 4);
    assert_string_equal(content("precious/thesis.tex"), "x");
}

static void a_folder_that_is_not_there_is_told(void **state)
{
    struct draft_folder d;
    struct err e = {0};
    char path[400];
    (void)state;
    assert_false(draft_folder_begin(&d, scratch_path(path, sizeof path, folder, "none/fig"), &e));
    assert_int_equal(e.kind, ERR_CREATE);
    assert_non_null(strstr(e.text, "none"));
    assert_non_null(strstr(e.text, "No such file"));
    draft_folder_end(&d); /* nothing was begun */
}

static void a_place_that_is_a_folder_is_told(void **state)
{
    struct draft_folder d;
    struct err e = {0};
    char path[400];
    (void)state;
    mkdir(scratch_path(path, sizeof path, folder, "fig.csv"), 0777);
    put(path, "inside", "x");
    assert_true(draft_folder_begin(&d, drafts, &e));
    put(d.path, "fig.csv", "new");
    put(d.path, "fig.svg", "new");
    assert_true(draft_folder_publish(&d, is_picture, &e));
    assert_false(draft_folder_publish(&d, is_data, &e));
    assert_int_equal(e.kind, ERR_IO);
    assert_non_null(strstr(e.text, "fig.csv failed: Is a directory"));
    draft_folder_end(&d);
    assert_int_equal(count_drafts(), 0);
    assert_string_equal(content("fig.csv/inside"), "x");
    assert_string_equal(content("fig.svg"), "new");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, drop_folder)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(chosen_files_get_their_places_and_the_rest_goes),
        TEST(what_an_ended_process_left_goes_and_what_a_living_one_makes_stays),
        TEST(what_only_looks_like_a_draft_stays),
        TEST(a_folder_that_is_not_there_is_told),
        TEST(a_place_that_is_a_folder_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
