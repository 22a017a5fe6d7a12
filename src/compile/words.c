/* words.c - lists of words in an arena. */
#include "compile/words.h"

#include <ctype.h>
#include <string.h>

#include "base/text.h"

/* Files of options that name files of options. */
enum { DEEPEST = 10 };

/* The list ends in NULL as execvp wants it, so there is always a place for that. */
void words_add(struct words *w, const char *word)
{
    if (w->n + 1 >= w->capacity) {
        const int capacity = w->capacity > 0 ? 2 * w->capacity : 64;
        const char **more = TAKE(w->arena, capacity, const char *);
        if (w->n > 0) memcpy(more, w->word, (size_t)w->n * sizeof *more);
        w->word = more;
        w->capacity = capacity;
    }
    w->word[w->n++] = word;
    w->word[w->n] = NULL;
}

/* The words are borrowed, not copied. */
void words_add_all(struct words *w, int n, const char *const *word)
{
    for (int i = 0; i < n; i++) words_add(w, word[i]);
}

/* The next part of *s without its quotes, NULL at the end. */
static const char *next_part(const char **s, struct arena *a)
{
    struct text part = {0};
    char quote = '\0';
    while (isspace((unsigned char)**s)) (*s)++;
    if (**s == '\0') return NULL;
    for (; **s != '\0' && (quote != '\0' || !isspace((unsigned char)**s)); (*s)++) {
        if (**s == '\\' && (*s)[1] != '\0' && quote != '\'') text_add_bytes(&part, ++*s, 1);
        else if (quote != '\0' && **s == quote) quote = '\0';
        else if (quote == '\0' && (**s == '"' || **s == '\'')) quote = **s;
        else text_add_bytes(&part, *s, 1);
    }
    const char *kept = arena_text(a, part.s != NULL ? part.s : "");
    text_free(&part);
    return kept;
}

/* As a shell would split it: gcc's rule for files of options and for variables such as CC. */
void words_add_parts(struct words *w, const char *text)
{
    for (const char *part; (part = next_part(&text, w->arena)) != NULL;) words_add(w, part);
}

/* A word "@file" becomes the words in the file; one that cannot be read stays as it is, as gcc
 * does it. */
static bool expand(struct words *w, int n, const char *const *word, int depth, struct err *e)
{
    for (int i = 0; i < n; i++) {
        struct text file = {0};
        struct err unread;
        err_clear(&unread);
        if (word[i][0] != '@' || !text_read_file(&file, word[i] + 1, &unread)) {
            words_add(w, word[i]);
            continue;
        }
        struct words inside = {.arena = w->arena};
        words_add_parts(&inside, file.s != NULL ? file.s : "");
        text_free(&file);
        /* A file that names itself would never end. */
        if (depth == DEEPEST)
            return err_set(e, ERR_USAGE, "'%s' names itself, or more than %d files in files",
                           word[i], DEEPEST);
        if (!expand(w, inside.n, inside.word, depth + 1, e)) return false;
    }
    return true;
}

bool words_expand(struct words *w, int n, const char *const *word, struct err *e)
{
    return expand(w, n, word, 0, e);
}
