/* text_mutate.c - changes of texts that keep most of their structure (fuzz.h).
 *
 * Bytes changed by chance seldom get past a parser's first lines. These changes work on words,
 * lines and parts in brackets, which all the formats have. */
#include "fuzz.h"

#include <ctype.h>

#include "base/random.h"

static const char *const number[] = {"0",
                                     "1",
                                     "-1",
                                     "2",
                                     "3",
                                     "7",
                                     "16",
                                     "63",
                                     "64",
                                     "1000",
                                     "4096",
                                     "65536",
                                     "16777216",
                                     "2147483647",
                                     "2147483648",
                                     "-2147483648",
                                     "4294967296",
                                     "9223372036854775807",
                                     "-9223372036854775808",
                                     "18446744073709551616",
                                     "1e-320",
                                     "1e300",
                                     "1e999",
                                     "0.5",
                                     "-0",
                                     "nan",
                                     "inf",
                                     ".nan",
                                     "0x10"};
static const char *const piece[] = {
    "[",    "]",       "{",        "}",      ", ", ": ", "\n",   "  ",   "- ",    "\"",
    "'",    "#",       "null",     "~",      "[]", "{}", "true", "*a",   "&a",    "|",
    "\xff", "\x1b[2J", "[[a: 1]]", "{a: 1}", "<",  ">",  "/>",   "&lt;", "!!str "};
enum { NNUMBER = sizeof number / sizeof *number, NPIECE = sizeof piece / sizeof *piece };

struct span {
    size_t from, to;
};

static bool of_word(int c) { return isalnum(c) || c == '.' || c == '_' || c == '-' || c == '+'; }

/* The word around or behind a random place; empty at the end. */
static struct span a_word(const uint8_t *s, size_t n, struct random *r)
{
    size_t at = n ? random_below(r, n) : 0;
    while (at < n && !of_word(s[at])) at++;
    struct span w = {at, at};
    while (w.from > 0 && of_word(s[w.from - 1])) w.from--;
    while (w.to < n && of_word(s[w.to])) w.to++;
    return w;
}

/* The line around a random place, with its end. */
static struct span a_line(const uint8_t *s, size_t n, struct random *r)
{
    size_t at = n ? random_below(r, n) : 0;
    struct span l = {at, at};
    while (l.from > 0 && s[l.from - 1] != '\n') l.from--;
    while (l.to < n && s[l.to] != '\n') l.to++;
    if (l.to < n) l.to++;
    return l;
}

/* From a bracket behind a random place to the one that closes it; empty when there is none. */
static struct span a_part(const uint8_t *s, size_t n, struct random *r)
{
    size_t at = n ? random_below(r, n) : 0;
    while (at < n && s[at] != '[' && s[at] != '{' && s[at] != '<') at++;
    size_t end = at;
    for (int depth = 0; end < n; end++) {
        depth += s[end] == '[' || s[end] == '{' || s[end] == '<';
        depth -= s[end] == ']' || s[end] == '}' || s[end] == '>';
        if (depth == 0) return (struct span){at, end + 1};
    }
    return (struct span){at, at};
}

/* What stands in `old` becomes the n bytes of `new`; too much stays out. */
static size_t put(uint8_t *s, size_t size, size_t most, struct span old, const void *new, size_t n)
{
    size_t rest = size - old.to;
    if (old.from + n + rest > most) return size;
    memmove(s + old.from + n, s + old.to, rest);
    memcpy(s + old.from, new, n);
    return old.from + n + rest;
}

static size_t put_text(uint8_t *s, size_t size, size_t most, struct span old, const char *text)
{
    return put(s, size, most, old, text, strlen(text));
}

/* The bytes of `from` come to stand in `to`, through a copy since both lie in the same text. */
static size_t put_part(uint8_t *s, size_t size, size_t most, struct span to, struct span from)
{
    size_t n = from.to - from.from;
    uint8_t *copy = malloc(n + 1);
    CHECK(copy != NULL);
    memcpy(copy, s + from.from, n);
    size = put(s, size, most, to, copy, n);
    free(copy);
    return size;
}

size_t text_mutate(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    struct random r = random_make(seed, 0, 0);
    uint64_t how = random_below(&r, 16);
    if (size == 0 || how >= 10) return LLVMFuzzerMutate(data, size, most);
    struct span word = a_word(data, size, &r), line = a_line(data, size, &r),
                part = a_part(data, size, &r);
    struct span here = {line.from, line.from};
    switch (how) {
    case 0:
    case 1:
        return put_text(data, size, most, word, number[random_below(&r, NNUMBER)]);
    case 2:
        return put_part(data, size, most, word, a_word(data, size, &r));
    case 3:
        return put_part(data, size, most, here, a_line(data, size, &r));
    case 4:
        return put_text(data, size, most, line, "");
    case 5:
        return put_part(data, size, most, part, a_part(data, size, &r));
    case 6:
        return put_text(data, size, most, part, "");
    case 7:
        return put_part(data, size, most, (struct span){part.from, part.from}, part);
    case 8:
        return put_text(data, size, most, (struct span){word.to, word.to},
                        piece[random_below(&r, NPIECE)]);
    default:
        return put_part(data, size, most, line, a_line(data, size, &r));
    }
}
