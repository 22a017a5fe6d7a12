/* streams.c - standard streams of each rank: what it prints goes to the simulator, line by line;
 * nothing can be read. */
#include <err.h>
#include <errno.h>
#include <error.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>
#include <wchar.h>

#include "guest.h"

LIBC(write);
LIBC(writev);
LIBC(read);
LIBC(fileno);
LIBC(fclose);

/* The C library's streams by the names that programs know; not the process's own. */
FILE *stdin WEAK;
FILE *stdout WEAK;
FILE *stderr WEAK;

/* Kept besides, as a program may put another stream in place of stdout. */
static FILE *standard[3];
static char buffer[3][1024];

/* The three are called by the C library. */
static ssize_t write_out(void *cookie, const char *data, size_t n)
{
    (void)cookie;
    mimdsim_host->runtime->output(mimdsim_host, 1, data, n);
    return (ssize_t)n;
}

static ssize_t write_err(void *cookie, const char *data, size_t n)
{
    (void)cookie;
    mimdsim_host->runtime->output(mimdsim_host, 2, data, n);
    return (ssize_t)n;
}

static ssize_t read_in(void *cookie, char *data, size_t n)
{
    (void)cookie, (void)data, (void)n;
    guest_flush();
    mimdsim_host->runtime->fail(mimdsim_host, NULL, guest_no_input);
    return 0;
}

/* Before every constructor, so that they may print. Lines are handed over when they end. */
void mimdsim_begin(void)
{
    standard[0] = fopencookie(NULL, "r", (cookie_io_functions_t){.read = read_in});
    standard[1] = fopencookie(NULL, "w", (cookie_io_functions_t){.write = write_out});
    standard[2] = fopencookie(NULL, "w", (cookie_io_functions_t){.write = write_err});
    for (int i = 0; i < 3; i++)
        if (standard[i]) setvbuf(standard[i], buffer[i], _IOLBF, sizeof buffer[i]);
    stdin = standard[0];
    stdout = standard[1];
    stderr = standard[2];
}

void guest_flush(void)
{
    for (int i = 1; i < 3; i++)
        if (standard[i]) fflush(standard[i]);
}

/* --- descriptors 0 to 2 mean the rank's streams --- */

WEAK ssize_t write(int fd, const void *data, size_t n)
{
    if (fd != 1 && fd != 2) return mimdsim_libc_write(fd, data, n);
    fflush(standard[fd]); /* what was printed before comes before */
    mimdsim_host->runtime->output(mimdsim_host, fd, data, n);
    return (ssize_t)n;
}

WEAK ssize_t writev(int fd, const struct iovec *v, int n)
{
    ssize_t sum = 0;
    if (fd != 1 && fd != 2) return mimdsim_libc_writev(fd, v, n);
    for (int i = 0; i < n; i++) sum += write(fd, v[i].iov_base, v[i].iov_len);
    return sum;
}

WEAK ssize_t read(int fd, void *data, size_t n)
{
    if (fd == 0) guest_fail(HERE, "%s", guest_no_input);
    return mimdsim_libc_read(fd, data, n);
}

WEAK int fileno(FILE *f)
{
    for (int i = 0; i < 3; i++)
        if (f == standard[i]) return i;
    return mimdsim_libc_fileno(f);
}

WEAK int isatty(int fd)
{
    (void)fd;
    errno = ENOTTY;
    return 0;
}

/* The stream stays, as in a program that prints in its destructors. */
WEAK int fclose(FILE *f)
{
    for (int i = 0; i < 3; i++)
        if (f == standard[i]) return fflush(f);
    return mimdsim_libc_fclose(f);
}

/* --- functions that mean stdout or stderr without naming it --- */

WEAK int vprintf(const char *format, va_list list) { return vfprintf(stdout, format, list); }

WEAK int printf(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int n = vfprintf(stdout, format, list);
    va_end(list);
    return n;
}

/* The forms that headers choose with _FORTIFY_SOURCE. */
WEAK int __vprintf_chk(int flag, const char *format, va_list list)
{
    (void)flag;
    return vfprintf(stdout, format, list);
}

WEAK int __printf_chk(int flag, const char *format, ...)
{
    va_list list;
    (void)flag;
    va_start(list, format);
    int n = vfprintf(stdout, format, list);
    va_end(list);
    return n;
}

WEAK int vdprintf(int fd, const char *format, va_list list)
{
    char *text;
    int n = vasprintf(&text, format, list);
    if (n < 0) return n;
    n = (int)write(fd, text, (size_t)n);
    free(text);
    return n;
}

WEAK int dprintf(int fd, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    int n = vdprintf(fd, format, list);
    va_end(list);
    return n;
}

WEAK int puts(const char *text) { return fputs(text, stdout) < 0 ? EOF : fputc('\n', stdout); }

WEAK int putchar(int c) { return fputc(c, stdout); }
WEAK int putchar_unlocked(int c) { return fputc(c, stdout); }
WEAK wint_t putwchar(wchar_t c) { return fputwc(c, stdout); }

WEAK int wprintf(const wchar_t *format, ...)
{
    va_list list;
    va_start(list, format);
    int n = vfwprintf(stdout, format, list);
    va_end(list);
    return n;
}

WEAK void perror(const char *text)
{
    int number = errno;
    if (text && *text) fprintf(stderr, "%s: ", text);
    fprintf(stderr, "%s\n", strerror(number));
}

/* --- <err.h> and <error.h>: they print to the process's stream and end the process --- */

static void complain(int number, const char *format, va_list list)
{
    if (format) vfprintf(stderr, format, list);
    if (number >= 0) fprintf(stderr, "%s%s", format ? ": " : "", strerror(number));
    fputc('\n', stderr);
}

WEAK void vwarn(const char *format, va_list list) { complain(errno, format, list); }
WEAK void vwarnx(const char *format, va_list list) { complain(-1, format, list); }
WEAK _Noreturn void verr(int status, const char *format, va_list list)
{
    complain(errno, format, list);
    exit(status);
}
WEAK _Noreturn void verrx(int status, const char *format, va_list list)
{
    complain(-1, format, list);
    exit(status);
}

#define WITH_LIST(call)                                                                            \
    do {                                                                                           \
        va_list list;                                                                              \
        va_start(list, format);                                                                    \
        call;                                                                                      \
        va_end(list);                                                                              \
    } while (0)

WEAK void warn(const char *format, ...) { WITH_LIST(vwarn(format, list)); }
WEAK void warnx(const char *format, ...) { WITH_LIST(vwarnx(format, list)); }
WEAK _Noreturn void err(int status, const char *format, ...)
{
    WITH_LIST(complain(errno, format, list));
    exit(status);
}
WEAK _Noreturn void errx(int status, const char *format, ...)
{
    WITH_LIST(complain(-1, format, list));
    exit(status);
}
WEAK void error(int status, int number, const char *format, ...)
{
    WITH_LIST(complain(number ? number : -1, format, list));
    if (status) exit(status);
}
