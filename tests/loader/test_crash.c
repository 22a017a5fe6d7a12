/* test_crash.c - crashes and endless loops of programs are told by rank, function and line; what
 * programs cannot do ends the run by name. */
#include "config.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "loader/crash.h"
#include "support/guests.h"
#include "support/scratch.h"

static char folder[256];

static int make(void **state)
{
    (void)state;
    scratch_make(folder, sizeof folder);
    return 0;
}

static int remove_it(void **state)
{
    (void)state;
    scratch_remove(folder);
    return 0;
}

/* Run two ranks in a process of its own, as a worker does, with a limit of processor time; its
 * status. */
static int run_apart(const char *path, char *argument, struct crash_record *record)
{
    static struct guests g;
    pid_t pid = fork();
    if (pid == 0) {
        struct err e;
        char *word[] = {"guest", argument, NULL};
        err_clear(&e);
        if (!crash_guard_begin(record, &e)) _exit(1);
        crash_limit(0.3);
        _exit(guests_run(path, 2, 2, word, &g) && g.failed_rank < 0 ? 0 : 2);
    }
    int status;
    assert_int_equal(waitpid(pid, &status, 0), pid);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void crashes_are_told_by_rank_and_line(void **state)
{
    (void)state;
    static const struct {
        char *argument;
        const char *begin, *end;
    } way[] = {
        {"null", "rank 1 in compute (crash.c:11): segmentation fault at address 0x0",
         " of simulated time"},
        {"divide", "rank 1 in divide (crash.c:12): whole-number division by zero",
         "after 5e-06 s of simulated time"},
        {"stack", "rank 1 in deep (crash.c:1", "of simulated time"},
        {"loop", "rank 1 in spin (crash.c:21): still busy after 0.3 s of processor time",
         "of simulated time"},
        {"memory", "rank 1 in in_library (crash.c:23): segmentation fault at address 0x0",
         "of simulated time"},
        {"illegal", "rank 1 in main (crash.c:35): illegal instruction", "of simulated time"},
#ifndef SANITIZERS /* they find that themselves */
        {"free", "rank 1 in main (crash.c:39): abort, by the C library", "of simulated time"},
#endif
    };
    char path[512], text[1024];
    guests_build(folder, "crash.c", "-O1 -fno-inline", path);
    struct crash_record *record = crash_record_create();
    assert_non_null(record);
    for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
        crash_record_clear(record);
        if (run_apart(path, way[i].argument, record) != CRASH_STATUS)
            fail_msg("%s: no crash", way[i].argument);
        assert_true(crash_text(record, text, (int)sizeof text));
        if (strncmp(text, way[i].begin, strlen(way[i].begin)) != 0 || !strstr(text, way[i].end))
            fail_msg("%s", text);
        if (way[i].argument[0] == 's' && !strstr(text, "stack overflow")) fail_msg("%s", text);
    }
    /* A program that does none of it leaves nothing. */
    crash_record_clear(record);
    assert_int_equal(run_apart(path, "x", record), 0);
    assert_false(crash_text(record, text, (int)sizeof text));
    crash_record_destroy(record);
}

static void what_is_refused_is_told_by_name_and_line(void **state)
{
    (void)state;
    static const struct {
        char *argument;
        const char *text;
    } way[] = {
        {"fork",
         "be_bad (refused.c:17): calls fork(), which a program on the simulator cannot use"},
        {"exec", "be_bad (refused.c:18): calls execlp()"},
        {"system", "be_bad (refused.c:19): calls system()"},
        {"popen", "be_bad (refused.c:20): calls popen()"},
        {"thread", "be_bad (refused.c:21): calls pthread_create(), which a program on the "
                   "simulator cannot use: a virtual processor has one thread"},
        {"socket", "be_bad (refused.c:22): calls socket()"},
        {"stdin", "reads standard input, which a program on the simulator does not have"},
        {"scanf", "be_bad (refused.c:24): reads standard input"},
        {"outside", "be_bad (refused.c:25): fopen(\"../../outside.txt\") would write outside of "
                    "the working directory"},
        {"passwd", "be_bad (refused.c:26): open(\"/etc/passwd\") would write outside"},
        /* clang names the function with its types */
        {"assert", "be_bad (refused.c:27): the assertion \"what[0] == 'b'\" of "},
        {"abort", "be_bad (refused.c:28): calls abort()"},
    };
    static struct guests g;
    char path[512];
    guests_build(folder, "refused.c", "-O0", path);
    for (size_t i = 0; i < sizeof way / sizeof *way; i++) {
        char *word[] = {"guest", way[i].argument, NULL};
        assert_true(guests_run(path, 1, 2, word, &g));
        assert_int_equal(g.failed_rank, 0);
        if (!strstr(g.failure, way[i].text)) fail_msg("%s", g.failure);
        assert_string_equal(g.output, "0: before 1\n");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(crashes_are_told_by_rank_and_line, make, remove_it),
        cmocka_unit_test_setup_teardown(what_is_refused_is_told_by_name_and_line, make, remove_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
