/* gnuplot.c - running the one optional program that draws. */
#include "report/gnuplot.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"

static const char *program(void)
{
    const char *named = getenv("MIMDSIM_GNUPLOT");
    return named && *named ? named : "gnuplot";
}

/* Start it with its complaints going into `complaints`; 0 or an errno. */
static int start(const char *dir, const char *file, int complaints, pid_t *child)
{
    char *const arguments[] = {(char *)program(), "-d", (char *)file, NULL};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, complaints, 2);
    posix_spawn_file_actions_addchdir_np(&actions, dir);
    int code = posix_spawnp(child, program(), &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    return code;
}

/* Everything that comes through `from`, up to the end. */
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
    while (rest != NULL && (line = strsep(&rest, "\n")) != NULL)
        if (*line != '\0' && (chosen == NULL || strstr(line, "\" line ") != NULL)) chosen = line;
    return chosen ? chosen : "no reason given";
}

bool gnuplot_run(const char *dir, const char *file, struct err *e)
{
    int ends[2], status = 0;
    pid_t child;
    if (pipe2(ends, O_CLOEXEC) != 0)
        return err_set(e, ERR_INTERNAL, "no pipe for gnuplot: %s", strerror(errno));
    int code = start(dir, file, ends[1], &child);
    close(ends[1]);
    if (code != 0) {
        close(ends[0]);
        return err_set(e, ERR_UNAVAILABLE,
                       "%s: %s; the data and the script are in %s: install gnuplot (Debian: "
                       "gnuplot-nox) and run it there on %s", program(), strerror(code), dir, file);
    }
    struct text complaints = {0};
    read_all(ends[0], &complaints);
    close(ends[0]);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    bool ok = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!ok)
        err_set(e, ERR_UNAVAILABLE, "%s could not draw %s/%s: %s", program(), dir, file,
                reason(&complaints));
    text_free(&complaints);
    return ok;
}
