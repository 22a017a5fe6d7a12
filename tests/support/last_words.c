/* last_words.c - see last_words.h. A child without a core file, its standard error a pipe. */
#include "last_words.h"

#include <setjmp.h>
#include <stdarg.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

int words_of(void (*act)(void), char *words, size_t size)
{
    int ends[2], status = 0;
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        const struct rlimit none = {0, 0};
        setrlimit(RLIMIT_CORE, &none);
        signal(SIGABRT, SIG_DFL); /* not the handler of the test framework */
        dup2(ends[1], STDERR_FILENO);
        act();
        _exit(0);
    }
    close(ends[1]);
    size_t n = 0;
    for (ssize_t k; n + 1 < size && (k = read(ends[0], words + n, size - 1 - n)) > 0;)
        n += (size_t)k;
    words[n] = '\0';
    close(ends[0]);
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

void expect_abort(void (*act)(void), char *words, size_t size)
{
    const int status = words_of(act, words, size);
    if (!WIFSIGNALED(status) || WTERMSIG(status) != SIGABRT)
        fail_msg("no abort: status %d, '%s'", status, words);
}
