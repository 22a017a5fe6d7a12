/* argument_line.h - a line of arguments as words, divided as a shell divides them. */
#ifndef BASE_ARGUMENT_LINE_H
#define BASE_ARGUMENT_LINE_H

#include "base/arena.h"
#include "base/text.h"

/* argument_line_split: `first` and the words of `line` into *argv (a NULL behind them), in `a`.
 * Blanks divide;
 * '...' keeps everything, "..." all but \" and \\, and outside a backslash keeps what follows it.
 * Returns how many there are, or -1 with a clause in `why`: a quote without its end. */
int argument_line_split(const char *first, const char *line, char ***argv, struct arena *a,
                        char *why, int size);

/* argument_line_add: one more word to a line that argument_line_split divides again; quoted where
 * that is needed. */
void argument_line_add(struct text *line, const char *word);

#endif
