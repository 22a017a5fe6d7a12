/* start.c - an image that is executed as a program becomes `mimdsim mpirun -n 1 IMAGE ARGUMENTS`.
 *
 * Nothing of the image has been initialised, and the C library's functions are those of guest/,
 * which need a simulator; so this file makes its own system calls (psABI A.2). */
#include <stddef.h>

enum {
    CALL_WRITE = 1,
    CALL_EXECVE = 59,
    CALL_EXIT = 60,
    CALL_READLINK = 89,
    STATUS_UNAVAILABLE = 69
};
enum { PATH_SIZE = 4096, MOST_ARGUMENTS = 16384 };

_Noreturn void mimdsim_execute(char **stack, const char *program);

/* Numbers and addresses alike. */
static long system_call(long number, size_t a, size_t b, size_t c)
{
    long result;
    __asm__ volatile("syscall"
                     : "=a"(result)
                     : "0"(number), "D"(a), "S"(b), "d"(c)
                     : "rcx", "r11", "memory");
    return result;
}

static size_t length(const char *s)
{
    size_t n = 0;
    while (s[n] != '\0') n++;
    return n;
}

static void say(const char *s) { system_call(CALL_WRITE, 2, (size_t)s, length(s)); }

/* The environment's variable `name` ("PATH="), NULL: not set. */
static const char *variable(char **environment, const char *name)
{
    for (; *environment != NULL; environment++) {
        size_t n = 0;
        while (name[n] != '\0' && (*environment)[n] == name[n]) n++;
        if (name[n] == '\0') return *environment + n;
    }
    return NULL;
}

/* Try `mimdsim` in every folder of PATH. */
static void execute_from_path(char **argument, char **environment)
{
    static const char name[] = "/mimdsim";
    char path[PATH_SIZE];
    const char *s = variable(environment, "PATH=");
    while (s != NULL && *s != '\0') {
        size_t n = 0;
        while (s[n] != '\0' && s[n] != ':') n++;
        if (n > 0 && n + sizeof name <= sizeof path) {
            for (size_t i = 0; i < n; i++) path[i] = s[i];
            for (size_t i = 0; i < sizeof name; i++) path[n + i] = name[i];
            system_call(CALL_EXECVE, (size_t)path, (size_t)argument, (size_t)environment);
        }
        s += n + (s[n] == ':');
    }
}

/* stack: what the kernel left there: argc, argv, NULL, environment, NULL. */
_Noreturn void mimdsim_execute(char **stack, const char *program)
{
    static const char *const before[] = {"mimdsim", "mpirun", "-n", "1"};
    const long argc = (long)stack[0];
    char image[PATH_SIZE], **environment = stack + argc + 2;
    char *argument[MOST_ARGUMENTS + 8];
    const long n =
        system_call(CALL_READLINK, (size_t) "/proc/self/exe", (size_t)image, sizeof image - 1);
    int count = 0;
    if (n > 0 && argc < MOST_ARGUMENTS) {
        image[n] = '\0';
        for (; count < 4; count++) argument[count] = (char *)(size_t)before[count];
        argument[count++] = image;
        for (long i = 1; i < argc; i++) argument[count++] = stack[1 + i];
        argument[count] = NULL;
        system_call(CALL_EXECVE, (size_t)program, (size_t)argument, (size_t)environment);
        execute_from_path(argument, environment);
    }
    say("this program was compiled by `mimdsim cc` and runs on virtual processors: mimdsim was not "
        "found at ");
    say(program);
    say(" nor in PATH\n");
    for (;;) system_call(CALL_EXIT, STATUS_UNAVAILABLE, 0, 0);
}
