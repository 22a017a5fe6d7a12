/* process.c - programs as children, one pipe each way. */
#include "base/process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* A program that is missing is the commonest case; who knows what it is for adds how to help. */
static bool cannot_start(const char *program, int error, struct err *e)
{
    if (error == ENOENT)
        return err_set(e, ERR_UNAVAILABLE, "'%s' is not installed, or not in PATH", program);
    return err_set(e, ERR_INTERNAL, "'%s' cannot be started: %s", program, strerror(error));
}

/* Pipes that the child has as its standard input and output, or error; -1: none. */
struct pipes {
    int to[2], from[2];
    bool error; /* `from` is its standard error, and its output goes nowhere */
};

/* The child's descriptors and signals are set by posix_spawn, so that nothing runs between fork
 * and exec. */
static int spawn(const char *const *word, const struct pipes *p, pid_t *child)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t usual;
    sigemptyset(&usual);
    sigaddset(
        &usual,
        SIGPIPE); /* ignored here, so that a program that dies early is an error and not a signal */
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    if (p->to[0] >= 0) posix_spawn_file_actions_adddup2(&actions, p->to[0], STDIN_FILENO);
    if (p->from[1] >= 0)
        posix_spawn_file_actions_adddup2(&actions, p->from[1],
                                         p->error ? STDERR_FILENO : STDOUT_FILENO);
    if (p->error)
        posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const int error =
        posix_spawnp(child, word[0], &actions, &attributes, (char *const *)word, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    /* An error number, not errno: posix_spawnp returns it. */
    return error;
}

/* Descriptors are closed once, whoever comes first. */
static void close_one(int *fd)
{
    if (*fd >= 0) close(*fd);
    *fd = -1;
}

/* Write and read as the child takes and gives, so that neither waits for the other. */
static void exchange(struct pipes *p, const struct text *in, struct text *out)
{
    size_t written = 0;
    while (p->to[1] >= 0 || p->from[0] >= 0) {
        struct pollfd ready[2] = {{.fd = p->to[1], .events = POLLOUT},
                                  {.fd = p->from[0], .events = POLLIN}};
        if (poll(ready, 2, -1) < 0 && errno != EINTR) break;
        /* There is a pipe to the child where there is something to write. */
        if (in != NULL && ready[0].revents != 0) {
            const ssize_t n = write(p->to[1], in->s + written, in->length - written);
            if (n > 0) written += (size_t)n;
            if ((n < 0 && errno != EINTR && errno != EAGAIN) || written == in->length)
                close_one(&p->to[1]);
        }
        /* The end of the child's output is also what ends this loop. */
        if (ready[1].revents != 0) {
            char piece[65536];
            const ssize_t n = read(p->from[0], piece, sizeof piece);
            if (n > 0) text_add_bytes(out, piece, (size_t)n);
            if (n == 0 || (n < 0 && errno != EINTR)) close_one(&p->from[0]);
        }
    }
}

/* The child's output is read while its input is written. Its status is the shell's: 128 and the
 * signal's number when a signal ended it. */
static bool run(const char *const *word, const struct text *in, struct text *out, bool errors,
                int *status, struct err *e)
{
    struct pipes p = {{-1, -1}, {-1, -1}, errors};
    const bool feeds = in != NULL && in->length > 0;
    if ((feeds && pipe2(p.to, O_CLOEXEC) != 0) || (out != NULL && pipe2(p.from, O_CLOEXEC) != 0))
        return err_set(e, ERR_INTERNAL, "no pipe to '%s': %s", word[0], strerror(errno));
    /* As the shell does: an interrupt is for the child, and ends this process by the child's
     * status. */
    struct sigaction ignore = {.sa_handler = SIG_IGN}, pipe_was, interrupt_was;
    sigaction(SIGPIPE, &ignore, &pipe_was);
    pid_t child = -1;
    const int error = spawn(word, &p, &child);
    sigaction(SIGINT, &ignore, &interrupt_was);
    close_one(&p.to[0]);
    close_one(&p.from[1]);
    /* The pipe to the child must not block, or both would wait once it is full. */
    if (error == 0) {
        if (feeds) fcntl(p.to[1], F_SETFL, O_NONBLOCK);
        exchange(&p, in, out);
        int ended = 0;
        while (waitpid(child, &ended, 0) < 0 && errno == EINTR) continue;
        *status = WIFSIGNALED(ended) ? 128 + WTERMSIG(ended) : WEXITSTATUS(ended);
    }
    close_one(&p.to[1]);
    close_one(&p.from[0]);
    sigaction(SIGPIPE, &pipe_was, NULL);
    sigaction(SIGINT, &interrupt_was, NULL);
    return error == 0 || cannot_start(word[0], error, e);
}

bool process_run(const char *const *word, const struct text *in, struct text *out, int *status,
                 struct err *e)
{
    return run(word, in, out, false, status, e);
}

bool process_said(const char *const *word, struct text *said, int *status, struct err *e)
{
    return run(word, NULL, said, true, status, e);
}

/* For questions: gcc answers in this process's place, with its own status. */
bool process_replace(const char *const *word, struct err *e)
{
    execvp(word[0], (char *const *)word);
    return cannot_start(word[0], errno, e);
}

/* Asked after the system knows: a parent that ends in between is seen by one of both. */
bool process_end_with(pid_t parent)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    return getppid() == parent;
}
