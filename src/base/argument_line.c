/* argument_line.c - see argument_line.h. */
#include "base/argument_line.h"

#include <stdio.h>
#include <string.h>

/* The next word at *s into `to`, which has room for all of the line. Returns false at a quote
 * without end. */
static bool take_word(const char **s, char *to)
{
    char quote = '\0';
    /* A blank ends a word unless a quote is open. */
    for (; **s != '\0' && (quote != '\0' || strchr(" \t", **s) == NULL); (*s)++) {
        const char c = **s, next = (*s)[1];
        /* As a shell does: within " only " and \ can be escaped, within ' nothing. */
        const bool escaped = c == '\\' && next != '\0' &&
                             (quote == '\0' || (quote == '"' && strchr("\"\\", next) != NULL));
        if (escaped) *to++ = *++*s;
        else if (quote == '\0' && (c == '\'' || c == '"')) quote = c;
        else if (quote != '\0' && c == quote) quote = '\0';
        else *to++ = c;
    }
    *to = '\0';
    return quote == '\0';
}

int argument_line_split(const char *first, const char *line, char ***argv, struct arena *a,
                        char *why, int size)
{
    const size_t n = strlen(line);
    int argc = 0;
    *argv = TAKE(a, n + 3, char *); /* each word takes a byte of the line at least */
    (*argv)[argc++] = arena_text(a, first);
    /* What went before a quote without end is dropped: half a command must not run. */
    for (const char *s = line; *(s += strspn(s, " \t")) != '\0';) {
        (*argv)[argc] = TAKE(a, n + 1, char);
        if (take_word(&s, (*argv)[argc++])) continue;
        snprintf(why, (size_t)size, "a quote has no end: %.100s", line);
        return -1;
    }
    return argc;
}

void argument_line_add(struct text *line, const char *word)
{
    /* Most words need no quotes, and without them the line stays readable. */
    const bool plain = word[0] != '\0' && strpbrk(word, " \t\n'\"\\[]") == NULL;
    if (line->length > 0) text_add(line, " ");
    if (plain) {
        text_add(line, "%s", word);
        return;
    }
    /* Within single quotes all is kept but the quote itself. */
    text_add(line, "'");
    for (const char *s = word; *s != '\0'; s++) text_add(line, *s == '\'' ? "'\\''" : "%c", *s);
    text_add(line, "'");
}
