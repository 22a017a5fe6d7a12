/* test_whole.c - arrays of any size through a pipe, in pieces and with signals between; ends that
 * are gone. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/whole.h"

enum { MOST = 1 << 20 };
static unsigned char sent[MOST], got[MOST];

struct writing {
    int fd;
    size_t n;
    bool well;
};

static void *write_all_of_it(void *context)
{
    struct writing *w = context;
    w->well = write_whole(w->fd, sent, w->n);
    close(w->fd); /* a reader that wants more is not left waiting */
    return NULL;
}

static void nothing(int number) { (void)number; }

/* A pipe takes some 64 KiB at a time, and a signal interrupts both sides. */
static void arrays_go_through_a_pipe(void **state)
{
    (void)state;
    static const size_t size[] = {0, 1, 4096, 65536, 65537, MOST};
    /* no SA_RESTART: calls end with EINTR */
    const struct sigaction interrupt = {.sa_handler = nothing};
    sigaction(SIGUSR1, &interrupt, NULL);
    for (size_t i = 0; i < MOST; i++) sent[i] = (unsigned char)(i * 2654435761u >> 24);
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        int end[2];
        pthread_t thread;
        assert_int_equal(pipe(end), 0);
        struct writing w = {end[1], size[i], false};
        memset(got, 0, sizeof got);
        assert_int_equal(pthread_create(&thread, NULL, write_all_of_it, &w), 0);
        for (int k = 0; k < 20 && size[i] == MOST; k++) {
            pthread_kill(thread, SIGUSR1);
            usleep(200);
        }
        assert_true(read_whole(end[0], got, size[i]));
        pthread_join(thread, NULL);
        assert_true(w.well);
        assert_memory_equal(got, sent, size[i]);
        close(end[0]);
    }
}

static void ends_that_are_gone_are_told(void **state)
{
    (void)state;
    int end[2];
    signal(SIGPIPE, SIG_IGN);
    assert_int_equal(pipe(end), 0);
    assert_true(write_whole(end[1], "abc", 3));
    close(end[1]);
    /* less than was asked for, and no reason of the system */
    errno = EIO;
    assert_false(read_whole(end[0], got, 4));
    assert_int_equal(errno, 0);
    assert_memory_equal(got, "abc", 3);
    close(end[0]);
    assert_false(read_whole(end[0], got, 1));
    assert_int_equal(errno, EBADF);
    assert_int_equal(pipe(end), 0);
    close(end[0]);
    assert_false(write_whole(end[1], "abc", 3));
    assert_int_equal(errno, EPIPE);
    close(end[1]);
    const int full = open("/dev/full", O_WRONLY);
    if (full < 0) return;
    assert_false(write_whole(full, "abc", 3));
    assert_int_equal(errno, ENOSPC);
    close(full);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(arrays_go_through_a_pipe),
        cmocka_unit_test(ends_that_are_gone_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
