/* err.c - errors as values; the first cause wins. */
#include "base/err.h"

#include <stdarg.h>
#include <stdio.h>
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
    text_copy(e->file, sizeof e->file, file);
    vsnprintf(e->text, sizeof e->text, format, args);
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

/* "context: text", from inside out: each caller that knows more adds its part in front. */
bool err_in(struct err *e, const char *context)
{
    CHECK(e->kind != ERR_NONE);
    char text[sizeof e->text];
    /* A copy first: the text moves within its own buffer. */
    text_copy(text, sizeof text, e->text);
    size_t n = (size_t)snprintf(e->text, sizeof e->text, "%s: ", context);
    if (n < sizeof e->text) text_copy(e->text + n, sizeof e->text - n, text);
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
