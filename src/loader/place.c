/* place.c - which function and line of a program an address belongs to, asked of addr2line
 * (crash.h). */
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "loader/crash.h"

/* Start `addr2line -f -C -i -e FILE ADDRESS` with its output in a pipe; returns the reading end,
 * NULL: not to be had. */
static FILE *start_addr2line(const char *file, uint64_t address, pid_t *pid)
{
    char hex[32];
    int fd[2];
    snprintf(hex, sizeof hex, "0x%llx", (unsigned long long)address);
    const char *const argument[] = {"addr2line", "-f", "-C", "-i", "-e", file, hex, NULL};
    if (pipe(fd) != 0) return NULL;
    /* Its complaints about files without debug information are no news to anybody. */
    posix_spawn_file_actions_t a;
    posix_spawn_file_actions_init(&a);
    posix_spawn_file_actions_adddup2(&a, fd[1], 1);
    posix_spawn_file_actions_addclose(&a, fd[0]);
    posix_spawn_file_actions_addopen(&a, 2, "/dev/null", 1, 0);
    int failed = posix_spawnp(pid, argument[0], &a, NULL, (char *const *)argument, environ);
    posix_spawn_file_actions_destroy(&a);
    close(fd[1]);
    FILE *in = failed ? NULL : fdopen(fd[0], "r");
    if (!in) close(fd[0]);
    return in;
}

/* Lines of the system's headers are not the program's: they stand for calls that the compiler has
 * put in place. */
static bool is_own_line(const char *line)
{
    return line[0] && strncmp(line, "/usr/", 5) != 0 && !strstr(line, ":?") && !strstr(line, ":0");
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

bool place_text(const char *file, uint64_t address, char *buffer, int size)
{
    char function[4096] = "", line[4096] = "", first[256] = "";
    pid_t pid;
    bool found = false;
    FILE *in = start_addr2line(file, address, &pid);
    /* Two lines for each function that the compiler has put into another, innermost first. */
    while (in && !found && fgets(function, (int)sizeof function, in) &&
           fgets(line, (int)sizeof line, in)) {
        function[strcspn(function, "\n")] = '\0';
        line[strcspn(line, " \n")] = '\0';
        if (!first[0] && function[0] != '?') snprintf(first, sizeof first, "%.200s", function);
        found = is_own_line(line);
    }
    /* addr2line has ended by now, or ends at the closed pipe. */
    if (in) {
        fclose(in);
        waitpid(pid, NULL, 0);
    }
    /* Without a line there is still the function's name; without that the file's. */
    const unsigned long long at = address;
    if (found) snprintf(buffer, (size_t)size, "%.200s (%s)", function, name_of(line));
    else if (first[0]) snprintf(buffer, (size_t)size, "%s (%s+0x%llx)", first, name_of(file), at);
    else snprintf(buffer, (size_t)size, "%s+0x%llx", name_of(file), at);
    return found;
}
