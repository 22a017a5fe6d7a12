/* err.c - errors as values; the first cause wins. */
#include "base/err.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* Texts are cut at the first byte: the rest need not be touched. */
void err_clear(struct err *e)
{
    e->kind = ERR_NONE;
    e->line = 0;
    e->file[0] = '\0';
    e->text[0] = '\0';
}

/* Whether byte c goes on a character of UTF-8 that began before it. */
static bool goes_on(char c) { return ((unsigned char)c & 0xC0) == 0x80; }

/* Copy s into buffer[size]. What does not fit is left out of its middle: a long path says most with
 * its two ends, and the reason stands behind it. Characters stay whole. */
static void copy_ends(char *buffer, size_t size, const char *s)
{
    static const char gap[] = " ... ";
    const size_t n = strlen(s), room = size - sizeof gap;
    if (n < size) {
        text_copy(buffer, size, s);
        return;
    }
    size_t head = room / 3, tail = n - (room - head);
    while (head > 0 && goes_on(s[head])) head--;
    while (goes_on(s[tail])) tail++;
    memcpy(buffer, s, head);
    snprintf(buffer + head, size - head, "%s%s", gap, s + tail);
}

/* print_ends: printf into buffer[size], cut as by copy_ends. Only what is too long is printed once
 * more, whole; without memory for that its end is lost. */
static void print_ends(char *buffer, size_t size, const char *format, va_list args)
    __attribute__((format(printf, 3, 0)));

static void print_ends(char *buffer, size_t size, const char *format, va_list args)
{
    va_list again;
    va_copy(again, args);
    const int n = vsnprintf(buffer, size, format, args);
    char *whole = n >= (int)size ? malloc((size_t)n + 1) : NULL;
    if (whole != NULL) {
        vsnprintf(whole, (size_t)n + 1, format, again);
        copy_ends(buffer, size, whole);
        free(whole);
    }
    va_end(again);
}

/* err_fill: record one error with its place; the texts are cut, never overrun. */
static void err_fill(struct err *e, enum err_kind kind, const char *file, int line,
                     const char *format, va_list args) __attribute__((format(printf, 5, 0)));

static void err_fill(struct err *e, enum err_kind kind, const char *file, int line,
                     const char *format, va_list args)
{
    CHECK(kind != ERR_NONE);
    /* The first cause wins: what fails afterwards mostly follows from it. */
    if (e->kind != ERR_NONE) return;
    e->kind = kind;
    e->line = line;
    copy_ends(e->file, sizeof e->file, file);
    print_ends(e->text, sizeof e->text, format, args);
}

/* Always false, so that a refusal is one statement: return err_set(..). */
bool err_set(struct err *e, enum err_kind kind, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    err_fill(e, kind, "", 0, format, args);
    va_end(args);
    return false;
}

bool err_set_at(struct err *e, enum err_kind kind, const char *file, int line, const char *format,
                ...)
{
    va_list args;
    va_start(args, format);
    err_fill(e, kind, file, line, format, args);
    va_end(args);
    return false;
}

/* print_text: printf-like, as print_ends. */
static void print_text(char *buffer, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void print_text(char *buffer, size_t size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    print_ends(buffer, size, format, args);
    va_end(args);
}

/* "context: text", from inside out: each caller that knows more adds its part in front. */
bool err_in(struct err *e, const char *context)
{
    CHECK(e->kind != ERR_NONE);
    char text[sizeof e->text];
    /* A copy first: the text moves within its own buffer. */
    text_copy(text, sizeof text, e->text);
    print_text(e->text, sizeof e->text, "%s: %s", context, text);
    return false;
}

/* From the one list of kinds (ERR_KINDS), as the words below. */
int err_exit_status(enum err_kind kind)
{
    static const int status[] = {
#define X(name, status, word) [name] = status,
        ERR_KINDS(X)
#undef X
    };
    CHECK((size_t)kind < sizeof status / sizeof status[0]);
    return status[kind];
}

const char *err_word(enum err_kind kind)
{
    static const char *const words[] = {
#define X(name, status, word) [name] = word,
        ERR_KINDS(X)
#undef X
    };
    CHECK((size_t)kind < sizeof words / sizeof words[0]);
    return words[kind];
}

/* file:line: in the form that editors and compilers use. */
void err_print(const struct err *e)
{
    if (e->file[0] && e->line > 0)
        fprintf(stderr, "mimdsim: %s:%d: %s\n", e->file, e->line, e->text);
    else if (e->file[0]) fprintf(stderr, "mimdsim: %s: %s\n", e->file, e->text);
    else fprintf(stderr, "mimdsim: %s\n", e->text);
}
