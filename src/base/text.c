/* text.c - strings: nearest valid name, growing buffer.
 *
 * Standing on nothing but check.c: err.c, and with it everything else, uses it. */
#include "base/text.h"

#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/check.h"
#include "base/memory.h"

enum { NEAREST_MAX = 64 }; /* longer words are no misspelt keys */

static int min3(int a, int b, int c)
{
    int m = a < b ? a : b;
    return m < c ? m : c;
}

/* Letter case is no misspelling worth a place in the distance. */
static bool same_letter(char a, char b)
{
    return tolower((unsigned char)a) == tolower((unsigned char)b);
}

/* edit_distance: insertions, deletions, replacements and swaps of neighbours (optimal string
 * alignment; Damerau 1964). O(na nb) time, three rows of memory: a swap looks two rows back. */
static int edit_distance(const char *a, size_t na, const char *b, size_t nb)
{
    /* row[i % 3] holds the distances of the first i letters of a to all beginnings of b. */
    int row[3][NEAREST_MAX + 1];
    for (size_t j = 0; j <= nb; j++) row[0][j] = (int)j;
    for (size_t i = 1; i <= na; i++) {
        int *now = row[i % 3], *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
        now[0] = (int)i;
        for (size_t j = 1; j <= nb; j++) {
            now[j] =
                min3(last[j] + 1, now[j - 1] + 1, last[j - 1] + !same_letter(a[i - 1], b[j - 1]));
            bool swap = i > 1 && j > 1 && same_letter(a[i - 1], b[j - 2]) &&
                        same_letter(a[i - 2], b[j - 1]);
            if (swap && before[j - 2] + 1 < now[j]) now[j] = before[j - 2] + 1;
        }
    }
    return row[na % 3][nb];
}

/* text_abbreviated: the shortest name that `word` (three letters or more) begins, NULL when there
 * is none. An abbreviation is far away by edits, but near for a person. */
static const char *text_abbreviated(const char *word, size_t length, const char *const *names,
                                    int n)
{
    const char *shortest = NULL;
    for (int k = 0; k < n && length >= 3; k++)
        if (strncasecmp(word, names[k], length) == 0 &&
            (!shortest || strlen(names[k]) < strlen(shortest)))
            shortest = names[k];
    return shortest;
}

const char *text_nearest(const char *word, const char *const *names, int n)
{
    size_t length = strlen(word);
    if (length > NEAREST_MAX) return NULL;
    /* A third of the letters may be wrong, and one more. */
    int best = 2 + (int)length / 3; /* one more than the largest allowed */
    const char *nearest = NULL;
    for (int k = 0; k < n; k++) {
        size_t other = strlen(names[k]);
        if (other > NEAREST_MAX) continue;
        int d = edit_distance(word, length, names[k], other);
        /* The first of several equally near names wins: the order of the list decides. */
        if (d < best) {
            best = d;
            nearest = names[k];
        }
    }
    return nearest ? nearest : text_abbreviated(word, length, names, n);
}

struct text_hint text_hint(const char *word, const char *const *names, int n, const char *otherwise)
{
    struct text_hint h;
    const char *near = text_nearest(word, names, n);
    if (near != NULL) snprintf(h.s, sizeof h.s, "; did you mean '%.160s'?", near);
    else snprintf(h.s, sizeof h.s, "%s", otherwise);
    return h;
}

/* Doubling: n characters cost O(n) copies in total. One byte more for the end. */
void text_reserve(struct text *t, size_t n)
{
    size_t need = t->length + n + 1;
    if (need <= t->capacity) return;
    size_t capacity = t->capacity ? t->capacity : 128;
    while (capacity < need) capacity *= 2;
    t->s = memory_resize(t->s, capacity, 1);
    t->capacity = capacity;
}

void text_add(struct text *t, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    /* Into the room that there is; mostly that is enough. */
    const size_t room = t->capacity > t->length ? t->capacity - t->length : 0;
    const int n = vsnprintf(room > 0 ? t->s + t->length : NULL, room, format, args);
    va_end(args);
    /* The formatting itself may want memory. */
    if (n < 0) check_memory(0);
    if ((size_t)n >= room) {
        text_reserve(t, (size_t)n);
        va_start(args, format);
        vsnprintf(t->s + t->length, (size_t)n + 1, format, args);
        va_end(args);
    }
    t->length += (size_t)n;
}

/* Without formatting, for the long texts of identities. */
void text_add_bytes(struct text *t, const char *s, size_t n)
{
    text_reserve(t, n);
    if (n > 0) memcpy(t->s + t->length, s, n);
    t->length += n;
    t->s[t->length] = '\0';
}

char *text_put_integer(char *at, int64_t v)
{
    char digit[TEXT_INTEGER];
    int n = 0;
    /* Unsigned, since the least integer has no positive counterpart; the last digit comes first. */
    uint64_t rest = v < 0 ? -(uint64_t)v : (uint64_t)v;
    do digit[n++] = (char)('0' + rest % 10);
    while (rest /= 10);
    if (v < 0) *at++ = '-';
    while (n > 0) *at++ = digit[--n];
    return at;
}

void text_add_integer(struct text *t, int64_t v)
{
    char digits[TEXT_INTEGER];
    const char *end = text_put_integer(digits, v);
    text_add_bytes(t, digits, (size_t)(end - digits));
}

/* An empty text may be used again. */
void text_free(struct text *t)
{
    free(t->s);
    *t = (struct text){0};
}

/* As strlcpy, but places may overlap. */
void text_copy(char *buffer, size_t size, const char *s)
{
    CHECK(size > 0);
    size_t n = strlen(s);
    if (n > size - 1) n = size - 1;
    memmove(buffer, s, n);
    buffer[n] = '\0';
}

/* 15 digits are enough for most, 17 for all doubles: the shortest that reads back is taken. */
void text_real(char buffer[32], double x)
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(buffer, 32, "%.*g", digits, x);
        if (strtod(buffer, NULL) == x) return;
    }
}
