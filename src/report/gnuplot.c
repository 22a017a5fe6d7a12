/* gnuplot.c - running the one optional program that draws.
 *
 * Drawing is the last step and the only one that needs another program: data and script are on
 * disk before it begins, and stay there if it fails. */
#include "report/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/process.h"
#include "base/progress.h"
#include "base/text.h"

/* Complaints kept [B]; how long a silent child, and one that has closed the pipe, is left alone. */
enum { MOST_COMPLAINTS = 1 << 16, PATIENCE_MS = 20, SHORT_MS = 5 };

/* Another program for tests, and for gnuplot outside of PATH. */
static const char *program(void)
{
    const char *named = getenv("MIMDSIM_GNUPLOT");
    return named && *named ? named : "gnuplot";
}

/* What the child does before it becomes gnuplot. Returns where it cannot: an errno of exec, or
 * -errno of what comes before. */
static int become(const char *work, const char *file, int complaints, pid_t parent)
{
    if (!process_end_with(parent)) return -ESRCH;
    /* No terminal: gnuplot must neither ask nor write to ours. In its folder, as scripts name their
     * files without a path. */
    const int nothing = open("/dev/null", O_RDWR);
    if (nothing < 0 || dup2(nothing, 0) < 0 || dup2(nothing, 1) < 0 || dup2(complaints, 2) < 0 ||
        chdir(work) != 0)
        return -errno;
    /* -d: no startup files of the user, which could change every figure. */
    execvp(program(), (char *const[]){(char *)program(), "-d", (char *)file, NULL});
    return errno;
}

/* Start it in folder `work` with its complaints going into `complaints`. Returns 0, or as become(),
 * whose number comes through a pipe that exec closes. */
static int start(const char *work, const char *file, int complaints, pid_t *child)
{
    int ends[2], code = 0;
    if (pipe2(ends, O_CLOEXEC) != 0) return -errno;
    const pid_t parent = getpid();
    *child = fork();
    if (*child == 0) {
        code = become(work, file, complaints, parent);
        /* Where the parent is gone, nobody reads it. */
        (void)!write(ends[1], &code, sizeof code);
        _exit(127);
    }
    if (*child < 0) code = -errno;
    close(ends[1]);
    if (code == 0)
        while (read(ends[0], &code, sizeof code) < 0 && errno == EINTR) {}
    close(ends[0]);
    /* A child that did not become gnuplot has ended. */
    if (*child > 0 && code != 0)
        while (waitpid(*child, NULL, 0) < 0 && errno == EINTR) {}
    return code;
}

/* The seconds that a drawing may take: 120, or what $MIMDSIM_GNUPLOT_SECONDS says. */
static double seconds_allowed(void)
{
    const char *named = getenv("MIMDSIM_GNUPLOT_SECONDS");
    const double seconds = named ? strtod(named, NULL) : 0;
    return seconds > 0 ? seconds : 120;
}

/* What has come through `from`: the first of it is kept, the rest is read and forgotten, so that a
 * child that floods us neither waits nor fills our memory. False: its end. */
static bool take_complaints(int from, struct text *t)
{
    char buffer[4096];
    const ssize_t n = read(from, buffer, sizeof buffer);
    if (n > 0 && t->length < MOST_COMPLAINTS) text_add_bytes(t, buffer, (size_t)n);
    return n > 0 || (n < 0 && (errno == EINTR || errno == EAGAIN));
}

/* Until the child has ended: false when it had to be killed for its time. The pipe may stay open
 * behind it, in a process that it has started. */
static bool wait_for(pid_t child, int from, struct text *complaints, int *status)
{
    const double end = host_seconds() + seconds_allowed();
    bool open = true;
    fcntl(from, F_SETFL, O_NONBLOCK);
    while (host_seconds() < end) {
        struct pollfd p = {.fd = open ? from : -1, .events = POLLIN};
        const bool ready = poll(&p, 1, open ? PATIENCE_MS : SHORT_MS) > 0;
        if (ready) open = take_complaints(from, complaints);
        /* It is asked for only when nothing is left to be read, or nothing comes any more. */
        const pid_t ended = ready && open ? 0 : waitpid(child, status, WNOHANG);
        if (ended == child || (ended < 0 && errno != EINTR)) return true;
    }
    kill(child, SIGKILL);
    while (waitpid(child, status, 0) < 0 && errno == EINTR) {}
    return false;
}

/* The line that names the place and the reason: gnuplot puts it after an echo of the command. */
static const char *reason(struct text *complaints)
{
    char *rest = complaints->s, *line, *chosen = NULL;
    /* Without such a line, the first one that says anything. */
    while (rest != NULL && (line = strsep(&rest, "\n")) != NULL)
        if (*line != '\0' && (chosen == NULL || strstr(line, "\" line ") != NULL)) chosen = line;
    return chosen ? chosen : "no reason given";
}

bool gnuplot_run(const char *work, const char *dir, const char *file, struct err *e)
{
    int ends[2], status = 0;
    pid_t child = -1;
    /* O_CLOEXEC: worker processes must not keep the pipe open. */
    if (pipe2(ends, O_CLOEXEC) != 0)
        return err_set(e, ERR_INTERNAL, "no pipe for gnuplot: %s", strerror(errno));
    int code = start(work, file, ends[1], &child);
    /* Our copy must be closed: the pipe ends when the child's copy does. */
    close(ends[1]);
    /* No gnuplot: the user can still draw, since script and data are complete. */
    if (code != 0) {
        close(ends[0]);
        if (code == ENOMEM || code < 0)
            return err_set(e, ERR_INTERNAL, "%s cannot be started: %s", program(),
                           strerror(abs(code)));
        return err_set(e, ERR_UNAVAILABLE,
                       "%s: %s; the data and the script are in %s: install gnuplot (Debian: "
                       "gnuplot-nox) and run it there on %s", program(), strerror(code), dir, file);
    }
    struct text complaints = {0};
    const bool ended = wait_for(child, ends[0], &complaints, &status);
    close(ends[0]);
    /* A signal counts as a failure, too. */
    bool ok = ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!ended)
        err_set(e, ERR_UNAVAILABLE, "%s had not drawn %s/%s after %g s and was ended", program(),
                dir, file, seconds_allowed());
    else if (WIFSIGNALED(status))
        err_set(e, ERR_UNAVAILABLE, "%s was ended by signal %d (%s) before it had drawn %s/%s",
                program(), WTERMSIG(status), strsignal(WTERMSIG(status)), dir, file);
    else if (!ok)
        err_set(e, ERR_UNAVAILABLE, "%s could not draw %s/%s: %s", program(), dir, file,
                reason(&complaints));
    text_free(&complaints);
    return ok;
}
