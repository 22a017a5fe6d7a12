/* files.c - reading files is free; writing, making and removing them is for the working directory
 * alone.
 *
 * This keeps programs from doing harm by mistake; it is no wall: a program runs with its user's
 * rights. */
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "guest.h"

LIBC(fopen);
LIBC(freopen);
LIBC(open);
LIBC(openat);
LIBC(unlink);
LIBC(remove);
LIBC(rename);
LIBC(mkdir);
LIBC(rmdir);
LIBC(truncate);
LIBC(link);
LIBC(symlink);
LIBC(chmod);

/* The path from the root without "." and "..", by its text alone; 0: too long. */
static int plain_path(const char *path, char *out, size_t size)
{
    char whole[4096], *rest = NULL;
    size_t used = 0;
    int relative = path[0] != '/';
    int n = snprintf(whole, sizeof whole, "%s%s%s", relative ? mimdsim_host->directory : "",
                     relative ? "/" : "", path);
    if (n < 0 || (size_t)n >= sizeof whole || (size_t)n + 2 > size) return 0;
    out[0] = '\0';
    for (char *word = strtok_r(whole, "/", &rest); word; word = strtok_r(NULL, "/", &rest)) {
        if (strcmp(word, ".") == 0) continue;
        if (strcmp(word, "..") == 0) {
            while (used && out[--used] != '/') {
            }
            out[used] = '\0';
            continue;
        }
        used += (size_t)snprintf(out + used, size - used, "/%s", word);
    }
    return 1;
}

int guest_writable(const char *path)
{
    static const char *const device[] = {"/dev/null", "/dev/full", "/dev/stdout", "/dev/stderr",
                                         "/dev/tty"};
    char plain[4096];
    const char *directory = mimdsim_host->directory;
    if (!plain_path(path, plain, sizeof plain)) return 0;
    for (size_t i = 0; i < sizeof device / sizeof *device; i++)
        if (strcmp(plain, device[i]) == 0) return 1;
    size_t n = strlen(directory);
    return n && strncmp(plain, directory, n) == 0 && (plain[n] == '/' || directory[n - 1] == '/');
}

static void check(const void *place, const char *call, const char *path)
{
    if (!path || guest_writable(path)) return;
    guest_fail(place,
               "%s(\"%s\") would write outside of the working directory %s, which a program on the "
               "simulator must not",
               call, path, mimdsim_host->directory);
}

/* --- streams --- */

static FILE *open_stream(const void *place, const char *path, const char *mode)
{
    if (mode[0] != 'r' || strchr(mode, '+')) check(place, "fopen", path);
    if (strcmp(path, "/dev/stdout") == 0 || strcmp(path, "/dev/stderr") == 0)
        return path[8] == 'o' ? stdout : stderr;
    return mimdsim_libc_fopen(path, mode);
}

WEAK FILE *fopen(const char *restrict path, const char *restrict mode)
{
    return open_stream(HERE, path, mode);
}
WEAK FILE *fopen64(const char *restrict path, const char *restrict mode)
{
    return open_stream(HERE, path, mode);
}

/* A standard stream is the simulator's until it gets a file; the others are files already. */
WEAK FILE *freopen(const char *restrict path, const char *restrict mode, FILE *restrict f)
{
    if (path && (mode[0] != 'r' || strchr(mode, '+'))) check(HERE, "freopen", path);
    FILE **stream = f == stdin ? &stdin : f == stdout ? &stdout : f == stderr ? &stderr : NULL;
    if (!stream || fileno(f) > 2) return mimdsim_libc_freopen(path, mode, f);
    FILE *opened = path ? mimdsim_libc_fopen(path, mode) : NULL;
    if (!opened) return NULL;
    fflush(f);
    return *stream = opened;
}

/* --- descriptors --- */

static int open_file(const void *place, int folder, const char *path, int flags, mode_t mode)
{
    if ((flags & O_ACCMODE) != O_RDONLY || (flags & (O_CREAT | O_TRUNC))) {
        if (folder == AT_FDCWD || path[0] == '/') check(place, "open", path);
        else
            guest_fail(
                place,
                "openat() of \"%s\" for writing relative to a folder that is open is not supported",
                path);
    }
    return mimdsim_libc_openat(folder, path, flags, mode);
}

/* mode: there only when the flags say that a file may be made. */
#define MODE(flags)                                                                                \
    mode_t mode = 0;                                                                               \
    if ((flags) & (O_CREAT | O_TMPFILE)) {                                                         \
        va_list list;                                                                              \
        va_start(list, flags);                                                                     \
        mode = va_arg(list, mode_t);                                                               \
        va_end(list);                                                                              \
    }

WEAK int open(const char *path, int flags, ...)
{
    MODE(flags)
    return open_file(HERE, AT_FDCWD, path, flags, mode);
}
WEAK int open64(const char *path, int flags, ...)
{
    MODE(flags)
    return open_file(HERE, AT_FDCWD, path, flags, mode);
}
WEAK int openat(int folder, const char *path, int flags, ...)
{
    MODE(flags)
    return open_file(HERE, folder, path, flags, mode);
}
WEAK int openat64(int folder, const char *path, int flags, ...)
{
    MODE(flags)
    return open_file(HERE, folder, path, flags, mode);
}
WEAK int creat(const char *path, mode_t mode)
{
    return open_file(HERE, AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}
WEAK int creat64(const char *path, mode_t mode)
{
    return open_file(HERE, AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}
WEAK int __open_2(const char *path, int flags);
int __open_2(const char *path, int flags) { return open_file(HERE, AT_FDCWD, path, flags, 0); }
WEAK int __open64_2(const char *path, int flags);
int __open64_2(const char *path, int flags) { return open_file(HERE, AT_FDCWD, path, flags, 0); }

/* --- names --- */

WEAK int unlink(const char *path)
{
    /* Libraries take the name off their scratch files at once. */
    if (strncmp(path, P_tmpdir "/", sizeof P_tmpdir) != 0) check(HERE, "unlink", path);
    return mimdsim_libc_unlink(path);
}
WEAK int remove(const char *path)
{
    check(HERE, "remove", path);
    return mimdsim_libc_remove(path);
}
WEAK int rename(const char *from, const char *to)
{
    check(HERE, "rename", from);
    check(HERE, "rename", to);
    return mimdsim_libc_rename(from, to);
}
WEAK int mkdir(const char *path, mode_t mode)
{
    check(HERE, "mkdir", path);
    return mimdsim_libc_mkdir(path, mode);
}
WEAK int rmdir(const char *path)
{
    check(HERE, "rmdir", path);
    return mimdsim_libc_rmdir(path);
}
WEAK int truncate(const char *path, off_t size)
{
    check(HERE, "truncate", path);
    return mimdsim_libc_truncate(path, size);
}
WEAK int link(const char *from, const char *to)
{
    check(HERE, "link", to);
    return mimdsim_libc_link(from, to);
}
WEAK int symlink(const char *from, const char *to)
{
    check(HERE, "symlink", to);
    return mimdsim_libc_symlink(from, to);
}
WEAK int chmod(const char *path, mode_t mode)
{
    check(HERE, "chmod", path);
    return mimdsim_libc_chmod(path, mode);
}
