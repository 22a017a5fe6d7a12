/* asm_line.c - statements of a line of assembly: no more of the syntax than a filter needs. */
#include "compile/asm_line.h"

#include <ctype.h>
#include <string.h>

/* Names are compared whole. */
bool span_is(struct span a, const char *s)
{
    return (int)strlen(s) == a.n && memcmp(a.s, s, (size_t)a.n) == 0;
}

/* Prefixes of names: the sections and registers come in families. */
bool span_starts(struct span a, const char *s)
{
    const int n = (int)strlen(s);
    return n <= a.n && memcmp(a.s, s, (size_t)n) == 0;
}

/* memmem, as a span does not end in a zero. */
int span_find(struct span a, const char *s)
{
    const char *at = a.n > 0 ? memmem(a.s, (size_t)a.n, s, strlen(s)) : NULL;
    return at != NULL ? (int)(at - a.s) : -1;
}

/* What lies between the blanks at both ends. */
static struct span trimmed(const char *s, const char *end)
{
    while (s < end && isspace((unsigned char)*s)) s++;
    while (end > s && isspace((unsigned char)end[-1])) end--;
    return (struct span){s, (int)(end - s)};
}

/* Behind the string that opens at s; its quote may be escaped inside. */
static const char *after_string(const char *s, const char *end)
{
    for (s++; s < end && *s != '"'; s++)
        if (*s == '\\' && s + 1 < end) s++;
    return s < end ? s + 1 : end;
}

/* Where the statement at s ends: at ';', at a comment or with the line. */
static const char *statement_end(const char *s, const char *end)
{
    while (s < end && *s != ';' && *s != '#' && !(*s == '/' && s + 1 < end && s[1] == '*'))
        s = *s == '"' ? after_string(s, end) : s + 1;
    return s;
}

static bool is_name_char(char c) { return isalnum((unsigned char)c) || strchr("_.$@", c) != NULL; }

/* Behind spaces, empty statements and comments; a '#' ends the line. */
static const char *skip_blank(const char *s, const char *end)
{
    while (s < end) {
        if (isspace((unsigned char)*s) || *s == ';') s++;
        else if (*s == '#') return end;
        else if (*s == '/' && s + 1 < end && s[1] == '*') {
            const char *close = memmem(s + 2, (size_t)(end - s - 2), "*/", 2);
            s = close != NULL ? close + 2 : end;
        } else break;
    }
    return s;
}

/* Prefixes of x86-64 that assemblers take as words of their own (Intel SDM 2A, 2.1.1, and GNU
 * as's names for those without a mnemonic). */
static bool is_prefix(struct span w)
{
    static const char *const prefix[] = {
        "lock",   "rep",   "repe", "repz",  "repne", "repnz", "notrack", "bnd",      "data16",
        "addr32", "rex64", "rex",  "rex.W", "rex.w", "cs",    "ds",      "xacquire", "xrelease"};
    for (unsigned i = 0; i < sizeof prefix / sizeof prefix[0]; i++)
        if (span_is(w, prefix[i])) return true;
    return false;
}

/* One statement: a label, or a word with its operands, behind blanks and comments. What follows
 * is left for the next call, as several statements may share a line. */
struct asm_statement asm_next(const char **at, const char *end)
{
    const char *s = skip_blank(*at, end);
    struct asm_statement found = {ASM_NOTHING, s, {s, 0}, {s, 0}};
    for (bool prefixed = false; s < end; prefixed = true) {
        /* {disp32} and the like choose an encoding and say nothing of what is done. */
        if (*s == '{') {
            const char *close = memchr(s, '}', (size_t)(end - s));
            s = skip_blank(close != NULL ? close + 1 : end, end);
        }
        const char *word = s;
        if (s < end && *s == '"') s = after_string(s, end);
        else
            while (s < end && is_name_char(*s)) s++;
        found.word = (struct span){word, (int)(s - word)};
        if (s < end && *s == ':' && !prefixed) {
            *at = s + 1;
            found.kind = ASM_LABEL;
            return found;
        }
        /* A prefix before its instruction on the same line is left out; alone it waits for the
         * next. */
        const char *stop = statement_end(s, end);
        *at = stop;
        found.operands = trimmed(s, stop);
        if (word < end && *word == '.') found.kind = ASM_DIRECTIVE;
        else found.kind = is_prefix(found.word) ? ASM_PREFIX : ASM_INSTRUCTION;
        if (found.kind != ASM_PREFIX || found.operands.n == 0) return found;
        s = found.operands.s;
    }
    *at = end;
    return found;
}

/* Commas inside brackets belong to an address: 8(%rax,%rcx,4) is one operand. */
struct span asm_operand(struct span operands, int i)
{
    const char *s = operands.s, *end = operands.s + operands.n, *begin = s;
    for (int depth = 0; s < end; s++) {
        if (*s == '(') depth++;
        else if (*s == ')') depth--;
        else if (*s == ',' && depth == 0) {
            if (i-- == 0) break;
            begin = s + 1;
        }
    }
    return i <= 0 ? trimmed(begin, s) : (struct span){end, 0};
}
