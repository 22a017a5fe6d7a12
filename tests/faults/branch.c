/* branch.c - a child process for each call that is to fail, with a copy of what it shares with its
 * parent (branch.h). Nothing here may allocate: it runs in the place of malloc. */
#include "branch.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MOST_FILES = 256, MOST_MAPS = 1 << 20 };

static struct {
    int socket; /* 0: no branches */
    long step;
    int thin;
    const char *folder;
    int child; /* this process is one: its failure was */
} branch;

void branch_begin(void)
{
    const char *socket = getenv("FAULT_SOCKET"), *step = getenv("FAULT_STEP");
    branch.folder = getenv("FAULT_FOLDER");
    if (!socket || !branch.folder) return;
    branch.socket = atoi(socket);
    branch.step = step ? atol(step) : 1;
    branch.thin = getenv("FAULT_THIN") != NULL;
    fcntl(branch.socket, F_SETFD, FD_CLOEXEC);
}

int branch_is_on(void) { return branch.socket > 0; }

/* Says a word, and waits for leave to go on. */
static void say(struct branch_word w)
{
    char leave;
    if (send(branch.socket, &w, sizeof w, 0) != sizeof w) _exit(98);
    if (w.what != BRANCH_PASSED && recv(branch.socket, &leave, 1, 0) != 1) _exit(98);
}

/* --- the copy --------------------------------------------------------------------------------- */

/* A path of the folder that a descriptor or a mapping has; of a removed file there is none. */
static int is_inside(const char *path)
{
    return strncmp(path, branch.folder, strlen(branch.folder)) == 0;
}

/* From here on this process sees the folder through an overlay: what it changes is its own. */
static int cover(long at)
{
    char here[512], upper[256], work[256], options[1024];
    if (!getcwd(here, sizeof here)) return 0;
    snprintf(upper, sizeof upper, "%s.upper-%ld", branch.folder, at);
    snprintf(work, sizeof work, "%s.work-%ld", branch.folder, at);
    snprintf(options, sizeof options, "lowerdir=%s,upperdir=%s,workdir=%s,redirect_dir=on",
             branch.folder, upper, work);
    return mkdir(upper, 0700) == 0 && mkdir(work, 0700) == 0 && unshare(CLONE_NEWNS) == 0 &&
           mount("none", "/", NULL, MS_REC | MS_PRIVATE, NULL) == 0 &&
           mount("overlay", branch.folder, "overlay", 0, options) == 0 && chdir(here) == 0;
}

/* Open files and folders are opened again, with offsets of their own: a child that reads a file to
 * its end leaves nothing to the parent otherwise. */
static int open_again(void)
{
    for (int fd = 0; fd < MOST_FILES; fd++) {
        char link[64], path[512];
        struct stat s;
        const int flags = fcntl(fd, F_GETFL), close_on_exec = fcntl(fd, F_GETFD);
        if (flags < 0 || fstat(fd, &s) != 0 || !(S_ISREG(s.st_mode) || S_ISDIR(s.st_mode)))
            continue;
        snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
        const ssize_t n = readlink(link, path, sizeof path - 1);
        if (n < 0) return 0;
        path[n] = '\0';
        if (!is_inside(path) && (flags & O_ACCMODE) != O_RDONLY) return 0; /* no copy of it */
        const int own = open(path, flags & ~(O_CREAT | O_EXCL | O_TRUNC));
        if (own < 0) return 0;
        if (S_ISREG(s.st_mode) && lseek(own, lseek(fd, 0, SEEK_CUR), SEEK_SET) < 0) return 0;
        if (dup3(own, fd, close_on_exec & FD_CLOEXEC ? O_CLOEXEC : 0) < 0) return 0;
        close(own);
    }
    return 1;
}

/* One line of /proc/self/maps: a file's memory that others would see is taken from the copy. */
static int map_again(const char *line)
{
    unsigned long from, to, offset;
    char may[5], path[512];
    if (sscanf(line, "%lx-%lx %4s %lx %*s %*s %511s", &from, &to, may, &offset, path) != 5 ||
        may[3] != 's' || !is_inside(path))
        return 1;
    const int protection = (may[0] == 'r' ? PROT_READ : 0) | (may[1] == 'w' ? PROT_WRITE : 0);
    const int own = open(path, may[1] == 'w' ? O_RDWR : O_RDONLY);
    if (own < 0) return 0;
    void *p = mmap((void *)from, to - from, protection, MAP_SHARED | MAP_FIXED, own, (off_t)offset);
    close(own);
    return p != MAP_FAILED;
}

static int map_all_again(void)
{
    static char text[MOST_MAPS];
    size_t n = 0;
    const int in = open("/proc/self/maps", O_RDONLY);
    if (in < 0) return 0;
    for (ssize_t got; (got = read(in, text + n, sizeof text - 1 - n)) > 0;) n += (size_t)got;
    close(in);
    text[n] = '\0';
    for (char *line = text, *end; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        *end = '\0';
        if (!map_again(line)) return 0;
    }
    return 1;
}

/* --- the branches ----------------------------------------------------------------------------- */

/* Another thread would be missing in a child; a process that was started has one parent. */
static int is_alone(void)
{
    struct stat s;
    siginfo_t any;
    return stat("/proc/self/task", &s) == 0 && s.st_nlink == 3 &&
           waitid(P_ALL, 0, &any, WEXITED | WNOHANG | WNOWAIT) != 0 && errno == ECHILD;
}

/* Of a row of calls from one place (or two beside each other: malloc and realloc) only some. */
static int is_chosen(const char *caller)
{
    enum { NEAR = 4096 };
    static const char *place;
    static long n;
    if (caller - place > NEAR || place - caller > NEAR) place = caller, n = 0;
    n++;
    return (n & (n - 1)) == 0 || n % 64 == 0;
}

int branch_fails(long now, long first, const void *caller)
{
    if (branch.child || (branch.thin && !is_chosen(caller)) || now < first ||
        (now - first) % branch.step != 0)
        return 0;
    const int saved = errno;
    const pid_t child = is_alone() ? _Fork() : -1;
    if (child == 0) {
        branch.child = 1;
        if (!cover(now) || !open_again() || !map_all_again()) _exit(98);
        say((struct branch_word){BRANCH_BORN, now, getpid(), 0});
        return 1;
    }
    int status = 0;
    if (child > 0 && waitpid(child, &status, 0) == child)
        say((struct branch_word){BRANCH_ENDED, now, child, status});
    else say((struct branch_word){BRANCH_PASSED, now, 0, 0});
    errno = saved;
    return 0;
}
