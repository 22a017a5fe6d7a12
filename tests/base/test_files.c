/* test_files.c - memory that is refused, files that are none, files that appear whole or stay as
 * they were. */
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "../support/scratch.h"
#include "config.h"

#include "base/beside.h"
#include "base/memory.h"
#include "base/text.h"

static char folder[128];

static int make_folder(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    return 0;
}

static int drop_folder(void **state)
{
    (void)state;
    scratch_remove(folder);
    return 0;
}

/* Status of a child that does `act`, silently. */
static int status_of(void (*act)(void))
{
    pid_t child = fork();
    if (child == 0) {
        int null = open("/dev/null", O_WRONLY);
        dup2(null, STDERR_FILENO);
        act();
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

static void take_too_much(void) { (void)memory_take(SIZE_MAX / 2, 1); }
static void zero_too_much(void) { (void)memory_zeroed(SIZE_MAX / 8, 16); }
static void resize_too_much(void) { free(memory_resize(memory_text("abc"), SIZE_MAX / 2, 2)); }
static void align_too_much(void) { (void)memory_aligned(64, SIZE_MAX - 3, 1); }

/* A product that wraps, too, is a refusal with the status of the system, and no abort. */
static void refused_memory_ends_with_its_own_status(void **state)
{
    (void)state;
#if defined __SANITIZE_ADDRESS__ || defined SANITIZERS
    skip(); /* the sanitizer ends the process itself */
#endif
    void (*const act[])(void) = {take_too_much, zero_too_much, resize_too_much, align_too_much};
    for (size_t i = 0; i < sizeof act / sizeof *act; i++) assert_int_equal(status_of(act[i]), 71);
}

static void nothing_is_memory_and_copies_are_whole(void **state)
{
    (void)state;
    int *zero = memory_zeroed(1000, sizeof *zero);
    for (int i = 0; i < 1000; i++) assert_int_equal(zero[i], 0);
    free(zero);
    free(memory_take(0, 8));
    free(memory_zeroed(0, 0));
    void *aligned = memory_aligned(64, 3, 5);
    assert_int_equal((uintptr_t)aligned % 64, 0);
    free(aligned);
    char *all = memory_text("abc"), *part = memory_text_part("abc", 2),
         *more = memory_text_part("abc", 9);
    assert_string_equal(all, "abc");
    assert_string_equal(part, "ab");
    assert_string_equal(more, "abc");
    free(all);
    free(part);
    free(more);
}

static void a_stream_prints_into_a_text(void **state)
{
    (void)state;
    struct text t = {0};
    FILE *s = text_stream(&t);
    assert_string_equal(t.s, "");
    for (int i = 0; i < 10000; i++) fprintf(s, "%d\n", i);
    text_stream_end(s);
    assert_int_equal(t.length, 48890);
    assert_string_equal(t.s + t.length - 5, "9999\n");
    text_free(&t);
}

static void expect(const char *name, enum err_kind kind, const char *says)
{
    char path[256];
    struct err e = {0};
    struct text t = {0};
    assert_false(text_read_file(
        &t, *name == '/' ? name : scratch_path(path, sizeof path, folder, name), &e));
    if (e.kind != kind || !strstr(e.text, says)) fail_msg("%s: %s", name, e.text);
    text_free(&t);
}

static void what_is_no_regular_file_is_named_and_not_waited_for(void **state)
{
    char path[256];
    (void)state;
    assert_int_equal(mkfifo(scratch_path(path, sizeof path, folder, "pipe"), 0600), 0);
    struct sockaddr_un a = {.sun_family = AF_UNIX};
    scratch_path(a.sun_path, sizeof a.sun_path, folder, "socket");
    int s = socket(AF_UNIX, SOCK_STREAM, 0);
    assert_int_equal(bind(s, (struct sockaddr *)&a, sizeof a), 0);
    alarm(20);
    expect("pipe", ERR_DATA, "a pipe, not a file");
    expect("socket", ERR_DATA, "a socket, not a file");
    expect(".", ERR_DATA, "a folder, not a file");
    expect("/dev/zero", ERR_DATA, "a device, not a file");
    expect("/dev/null", ERR_DATA, "a device, not a file");
    expect("nothing", ERR_NO_INPUT, "cannot open");
    alarm(0);
    close(s);
    /* more than any computer has, none of it on the disk */
    int large = open(scratch_path(path, sizeof path, folder, "large"), O_CREAT | O_WRONLY, 0600);
    if (ftruncate(large, INT64_C(1) << 43) == 0) expect("large", ERR_CONFIG, "the file would take");
    close(large);
}

static void write_or_fail(const char *path, const char *content)
{
    struct err e = {0};
    if (!beside_write(path, content, strlen(content), &e)) fail_msg("%s", e.text);
}

static void holds(const char *path, const char *content)
{
    struct text t = {0};
    struct err e = {0};
    if (!text_read_file(&t, path, &e)) fail_msg("%s", e.text);
    assert_string_equal(t.s, content);
    text_free(&t);
}

static int entries(void)
{
    struct text command = {0};
    text_add(&command, "ls -A '%s' | wc -l", folder);
    FILE *in = popen(command.s, "r");
    int n = -1;
    assert_int_equal(fscanf(in, "%d", &n), 1);
    pclose(in);
    text_free(&command);
    return n;
}

static void a_file_is_replaced_when_it_is_whole_and_not_before(void **state)
{
    char path[256], link_path[256];
    struct stat info;
    struct err e = {0};
    (void)state;
    write_or_fail(scratch_path(path, sizeof path, folder, "a"), "old");
    assert_int_equal(chmod(path, 0640), 0);
    assert_int_equal(symlink(path, scratch_path(link_path, sizeof link_path, folder, "b")), 0);
    write_or_fail(link_path, "new");
    holds(path, "new");
    assert_int_equal(lstat(link_path, &info) == 0 && S_ISLNK(info.st_mode), 1);
    assert_int_equal(stat(path, &info) == 0 ? info.st_mode & 0777 : 0, 0640);
    /* given up, and failed: the old one stays, and nothing else */
    struct beside b;
    assert_true(beside_begin(&b, path, &e));
    fputs("half", b.out);
    assert_true(beside_end(&b, false, &e));
    holds(path, "new");
    struct rlimit before, limit;
    getrlimit(RLIMIT_FSIZE, &before);
    limit = (struct rlimit){2, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_false(beside_write(path, "newest", 6, &e));
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(e.kind, ERR_IO);
    assert_non_null(strstr(e.text, strerror(EFBIG)));
    holds(path, "new");
    assert_int_equal(entries(), 2);
    /* what is no file is written as it is */
    write_or_fail("/dev/null", "x");
    assert_true(stat("/dev/null", &info) == 0 && S_ISCHR(info.st_mode));
    /* a folder that is not there */
    err_clear(&e);
    assert_false(beside_write(scratch_path(path, sizeof path, folder, "none/a"), "x", 1, &e));
    assert_int_equal(e.kind, ERR_CREATE);
}

int main(void)
{
#define TEST(f) cmocka_unit_test_setup_teardown(f, make_folder, drop_folder)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refused_memory_ends_with_its_own_status),
        cmocka_unit_test(nothing_is_memory_and_copies_are_whole),
        cmocka_unit_test(a_stream_prints_into_a_text),
        TEST(what_is_no_regular_file_is_named_and_not_waited_for),
        TEST(a_file_is_replaced_when_it_is_whole_and_not_before),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
