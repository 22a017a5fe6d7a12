/* escape.c - texts of strangers where they are shown: one function for each kind of reader, so that
 * none is a command.
 *
 * The terminal's is a stream between the program and its output: no print of a name can forget it.
 * What it shows instead, \u and four digits, is also what JSON has for these characters, so
 * documents stay what they were. */
#include "base/escape.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "config.h"

#include "base/check.h"
#include "base/memory.h"
#include "base/whole.h"

#ifdef SANITIZERS
#include <sanitizer/lsan_interface.h>
#endif

/* One character of UTF-8 on its way, whose end is not there yet. */
struct guard {
    int descriptor;
    int n, need; /* bytes of it that have come, and that it has */
    unsigned char held[4];
};

/* Whether a reader would obey it and not show it: control characters of both sets but line end and
 * tab, and the signs that change the direction of writing (Unicode 15, 23.1 and 23.2). */
static bool is_command(uint32_t c)
{
    if (c == '\n' || c == '\t') return false;
    return c < 0x20 || (c >= 0x7f && c < 0xa0) || (c >= 0x202a && c <= 0x202e) ||
           (c >= 0x2066 && c <= 0x2069);
}

/* Length of the character that begins with this byte; 0: none does. */
static int length_of(unsigned char first)
{
    if (first < 0x80) return 1;
    if (first >= 0xc2 && first < 0xe0) return 2;
    if (first >= 0xe0 && first < 0xf0) return 3;
    return first >= 0xf0 && first < 0xf5 ? 4 : 0;
}

static uint32_t value_of(const unsigned char *s, int n)
{
    static const unsigned char mask[] = {0, 0x7f, 0x1f, 0x0f, 0x07};
    uint32_t c = s[0] & mask[n];
    for (int i = 1; i < n; i++) c = c << 6 | (s[i] & 0x3f);
    return c;
}

/* The held bytes as text: themselves, or their number; bytes that are no UTF-8 one by one. */
static size_t release(struct guard *g, char *out)
{
    size_t k = 0;
    const bool whole = g->n > 0 && g->n == g->need;
    if (whole && !is_command(value_of(g->held, g->n))) {
        memcpy(out, g->held, (size_t)g->n);
        k = (size_t)g->n;
    } else if (whole) k = (size_t)sprintf(out, "\\u%04x", (unsigned)value_of(g->held, g->n));
    else
        for (int i = 0; i < g->n; i++) k += (size_t)sprintf(out + k, "\\u%04x", g->held[i]);
    g->n = 0;
    return k;
}

/* What a byte lets out: at most two releases of four numbers each. */
static size_t take(struct guard *g, unsigned char byte, char *out)
{
    size_t k = 0;
    /* A carriage return belongs to a line end, or moves the cursor. */
    if (g->n == 1 && g->held[0] == '\r') {
        if (byte == '\n') out[k++] = '\r', g->n = 0;
        else k += release(g, out + k);
    }
    if (g->n > 0 && (byte & 0xc0) != 0x80) k += release(g, out + k);
    if (g->n == 0) g->need = length_of(byte);
    g->held[g->n++] = byte;
    if (g->n >= g->need && byte != '\r') k += release(g, out + k);
    return k;
}

static ssize_t guard_write(void *guard, const char *data, size_t size)
{
    struct guard *g = guard;
    char out[4096 + 64];
    size_t k = 0;
    for (size_t i = 0; i < size; i++) {
        k += take(g, (unsigned char)data[i], out + k);
        if (k < 4096) continue;
        if (!write_whole(g->descriptor, out, k)) return 0;
        k = 0;
    }
    return write_whole(g->descriptor, out, k) ? (ssize_t)size : 0;
}

static FILE *guarded(int descriptor, int buffering)
{
    struct guard *g = memory_zeroed(1, sizeof *g);
    g->descriptor = descriptor;
    FILE *stream = fopencookie(g, "w", (cookie_io_functions_t){.write = guard_write});
    if (stream == NULL) check_memory(BUFSIZ);
#ifdef SANITIZERS
    __lsan_ignore_object(g); /* the stream's, as long as the process lives */
#endif
    setvbuf(stream, NULL, buffering, BUFSIZ);
    return stream;
}

/* stdout and stderr are variables of the C library, made to be replaced. */
void escape_terminal(void)
{
    stdout = guarded(STDOUT_FILENO, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF);
    stderr = guarded(STDERR_FILENO, _IOLBF);
}

void escape_raw(int descriptor, const char *s, size_t n)
{
    fflush(descriptor == STDERR_FILENO ? stderr : stdout);
    (void)write_whole(descriptor, s, n);
}

/* A backslash before punctuation is the punctuation itself (CommonMark 0.31, 2.4), its own too: one
 * that stays single would take the next one's away. */
void escape_markdown(FILE *md, const char *s, bool start)
{
    /* "1." at the beginning of a line is an item of a list. */
    const size_t digits = start ? strspn(s, "0123456789") : 0;
    if (digits > 0 && (s[digits] == '.' || s[digits] == ')')) {
        fprintf(md, "%.*s\\%c", (int)digits, s, s[digits]);
        s += digits + 1;
        start = false;
    }
    for (; *s; s++, start = false) {
        const unsigned char c = (unsigned char)*s;
        if (c == '\n' || c == '\r') putc(' ', md);
        else if (is_command(c) && c < 0x80) fprintf(md, "\\\\u%04x", c);
        else {
            if (strchr("\\<>*_`[]&|~", c) || (start && strchr("#+-=", c))) putc('\\', md);
            putc(c, md);
        }
    }
}
