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

/* Start `addr2line -f -C -s -e FILE ADDRESS` with its output in a pipe; returns the reading end,
 * NULL: not to be had. */
static FILE *start_addr2line(const char *file, uint64_t address, pid_t *pid)
{
    char hex[32];
    int fd[2];
    snprintf(hex, sizeof hex, "0x%llx", (unsigned long long)address);
    const char *const argument[] = {"addr2line", "-f", "-C", "-s", "-e", file, hex, NULL};
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

/* One line without its end; what is behind a blank in the second line is of the compiler
 * ("(discriminator 2)"). */
static bool take_line(FILE *in, char *line, int size, bool first_word)
{
    if (!fgets(line, size, in)) return false;
    line[strcspn(line, first_word ? " \n" : "\n")] = '\0';
    return line[0] && line[0] != '?';
}

void place_text(const char *file, uint64_t address, char *buffer, int size)
{
    char function[256] = "", line[256] = "";
    pid_t pid;
    FILE *in = start_addr2line(file, address, &pid);
    bool have_function = in && take_line(in, function, (int)sizeof function, false);
    bool have_line = in && take_line(in, line, (int)sizeof line, true) && !strstr(line, ":?") &&
                     !strstr(line, ":0");
    if (in) {
        fclose(in);
        waitpid(pid, NULL, 0);
    }
    const char *slash = strrchr(file, '/');
    const char *name = slash ? slash + 1 : file;
    if (have_function && have_line) snprintf(buffer, (size_t)size, "%s (%s)", function, line);
    else if (have_function)
        snprintf(buffer, (size_t)size, "%s (%s+0x%llx)", function, name,
                 (unsigned long long)address);
    else snprintf(buffer, (size_t)size, "%s+0x%llx", name, (unsigned long long)address);
}
