/* escape.h - texts of strangers where they are shown: one function for each kind of reader, so that
 * none is a command.
 *
 * A name in a scenario, a machine's title or a value in a database may hold anything: sequences
 * that move a terminal's cursor or write to its clipboard, tags of HTML, markup, signs that turn
 * the direction of writing. */
#ifndef BASE_ESCAPE_H
#define BASE_ESCAPE_H

#include <stdbool.h>
#include <stdio.h>

/* escape_terminal: from now on what is printed on stdout and stderr shows what a terminal would
 * obey as what it is:
 * "\u001b" for the escape character; line ends, tabs and letters of all languages stay. Once,
 * before anything is printed. What the user's own programs print goes past it (escape_raw). */
void escape_terminal(void);

/* escape_raw: `n` bytes as they are to descriptor 1 or 2, behind all that was printed before. */
void escape_raw(int descriptor, const char *s, size_t n);

/* escape_markdown: any text in Markdown, where it stays one line of words; `start`: at the
 * beginning of a line. */
void escape_markdown(FILE *md, const char *s, bool start);

#endif
