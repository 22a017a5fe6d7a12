/* figure_text.c - what the description of a figure says of itself, and how texts become names of
 * files. */
#include "report/figure_text.h"

#include <ctype.h>
#include <string.h>

#include "base/digest.h"
#include "base/text.h"
#include "report/report.h"

const char *figure_line(const char *sql, const char *mark, char *word, size_t size)
{
    size_t n = strlen(mark);
    /* Line by line: a mark inside a line is no mark. */
    for (const char *line = sql; *line;) {
        const char *end = strchrnul(line, '\n');
        if (strncmp(line, mark, n) == 0) {
            size_t length = (size_t)(end - line) - n;
            /* What is too long is cut: buffers are larger than any description needs. */
            if (length >= size) length = size - 1;
            memcpy(word, line + n, length);
            word[length] = '\0';
            return *end ? end + 1 : end;
        }
        line = *end ? end + 1 : end;
    }
    return NULL;
}

enum { TITLE_LENGTH = 110 };

/* Where a sentence ends in [line, end): at a full stop that is followed by a blank or the end,
 * and is not one of several ("..."). NULL: it goes on. */
static const char *sentence_end(const char *line, const char *end)
{
    for (const char *c = line; c < end; c++)
        if (*c == '.' && (c + 1 == end || c[1] == ' ') && (c == line || c[-1] != '.')) return c;
    return NULL;
}

/* A title too long for a line ends before a clause: at a semicolon or colon, else at a comma,
 * and only beyond its first quarter, so that something is left of it. */
static void shorten(struct text *title)
{
    static const char *const marks[] = {";:", ","};
    if (title->length <= TITLE_LENGTH) return;
    size_t at = TITLE_LENGTH;
    for (int k = 0; k < 2 && at == TITLE_LENGTH; k++)
        for (size_t i = TITLE_LENGTH - 1; i > TITLE_LENGTH / 4 && at == TITLE_LENGTH; i--)
            if (title->s[i + 1] == ' ' && strchr(marks[k], title->s[i])) at = i;
    /* No clause: cut before a word, and say so. */
    bool clause = at < TITLE_LENGTH;
    while (!clause && at > 0 && title->s[at] != ' ') at--;
    title->s[at] = '\0';
    title->length = at;
    if (!clause) text_add(title, " ...");
}

/* The comment that `sql` begins with, up to the end of its first sentence or its first technical
 * line. */
static void first_sentence(const char *sql, struct text *out)
{
    for (const char *line = sql; strncmp(line, "-- ", 3) == 0 &&
                                 strncmp(line, "-- needs: ", 10) != 0 &&
                                 strncmp(line, "-- each: ", 9) != 0;) {
        const char *end = strchrnul(line, '\n'), *stop = sentence_end(line, end);
        text_add(out, "%s%.*s", out->length > 0 ? " " : "", (int)((stop ? stop : end) - line - 3),
                 line + 3);
        if (stop || !*end) return;
        line = end + 1;
    }
}

/* A figure without a description has an empty title: a list of figures must not fail because of
 * one. */
void report_figure_about(const char *data_dir, const char *name, struct text *title,
                         struct text *needs)
{
    struct text path = {0}, sql = {0};
    char line[200] = "";
    struct err ignored;
    err_clear(&ignored);
    text_add(&path, "%s/plots/%s.sql", data_dir, name);
    if (text_read_file(&sql, path.s, &ignored) && sql.s != NULL) {
        first_sentence(sql.s, title);
        shorten(title);
        figure_line(sql.s, "-- needs: ", line, sizeof line);
    }
    /* never NULL */
    text_add(title, "%s", "");
    text_add(needs, "%s", line);
    text_free(&path);
    text_free(&sql);
}

/* Letters of any alphabet (bytes of UTF-8 above 0x7f), digits, and signs that mean nothing in a
 * path, in gnuplot's quotes and in a shell's. */
static bool harmless(char c)
{
    return (unsigned char)c >= 0x80 || isalnum((unsigned char)c) ||
           strchr(" '%-_.,+=()", c) != NULL;
}

enum { DRAWING_NAME_LENGTH = 120 };

/* The name of a drawing's files from a text of the database, which may be anybody's. It begins
 * with the figure's name; where something had to be changed, eight digits of a hash keep two
 * texts apart. */
char *figure_file_name(const char *figure, const char *s)
{
    struct text name = {0};
    char hash[65];
    size_t n = strlen(figure);
    /* Already "accuracy-four-bar": keep it as it is. */
    bool changed = strncmp(s, figure, n) != 0 || (s[n] != '\0' && s[n] != '-');
    if (changed) text_add(&name, "%s-", figure);
    for (const char *c = s; *c && name.length < DRAWING_NAME_LENGTH; c++) {
        bool keep =
            harmless(*c) && (*c != '\'' || c[1] != '\''); /* gnuplot misreads a row of quotes */
        text_add_bytes(&name, keep ? c : "_", 1);
        changed = changed || !keep;
    }
    if (changed || strlen(s) > DRAWING_NAME_LENGTH) {
        digest_sha256_hex(s, strlen(s), hash);
        text_add(&name, "-%.8s", hash);
    }
    return name.s;
}
