/* gnuplot.c - running the one optional program that draws.
 *
 * Drawing is the last step and the only one that needs another program: data and script are on
 * disk before it begins, and stay there if it fails. */
#include "report/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"

/* Another program for tests, and for gnuplot outside of PATH. */
static const char *program(void)
{
    const char *named = getenv("MIMDSIM_GNUPLOT");
    return named && *named ? named : "gnuplot";
}

/* Start it in folder `dir` with its complaints going into `complaints`. Returns 0 or an errno. */
static int start(const char *dir, const char *file, int complaints, pid_t *child)
{
    /* -d: no startup files of the user, which could change every figure. */
    char *const arguments[] = {(char *)program(), "-d", (char *)file, NULL};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    /* No terminal: gnuplot must neither ask nor write to ours. */
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, complaints, 2);
    /* In its folder, as scripts name their files without a path. */
    posix_spawn_file_actions_addchdir_np(&actions, dir);
    int code = posix_spawnp(child, program(), &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return code;
}

/* Everything that comes through `from`, up to its end; a signal does not end it. */
static void read_all(int from, struct text *t)
{
    char buffer[512];
    ssize_t n;
    while ((n = read(from, buffer, sizeof buffer)) > 0 || (n < 0 && errno == EINTR))
        if (n > 0) text_add_bytes(t, buffer, (size_t)n);
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

bool gnuplot_run(const char *dir, const char *file, struct err *e)
{
    int ends[2], status = 0;
    pid_t child;
    /* O_CLOEXEC: worker processes must not keep the pipe open. */
    if (pipe2(ends, O_CLOEXEC) != 0)
        return err_set(e, ERR_INTERNAL, "no pipe for gnuplot: %s", strerror(errno));
    int code = start(dir, file, ends[1], &child);
    /* Our copy must be closed: the pipe ends when the child's copy does. */
    close(ends[1]);
    /* No gnuplot: the user can still draw, since script and data are complete. */
    if (code != 0) {
        close(ends[0]);
        return err_set(e, ERR_UNAVAILABLE,
                       "%s: %s; the data and the script are in %s: install gnuplot (Debian: "
                       "gnuplot-nox) and run it there on %s", program(), strerror(code), dir, file);
    }
    struct text complaints = {0};
    read_all(ends[0], &complaints);
    close(ends[0]);
    /* Read first, wait afterwards: a child that fills the pipe would wait for us. */
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    /* A signal counts as a failure, too. */
    bool ok = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!ok)
        err_set(e, ERR_UNAVAILABLE, "%s could not draw %s/%s: %s", program(), dir, file,
                reason(&complaints));
    text_free(&complaints);
    return ok;
}
