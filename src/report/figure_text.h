/* figure_text.h - what the description of a figure says of itself, and how texts become names of
 * files. */
#ifndef REPORT_FIGURE_TEXT_H
#define REPORT_FIGURE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

#include "base/err.h"
#include "base/text.h"

/* figure_line: copy the rest of the line in `sql` that begins with `mark` into `word`, cut to
 * `size` bytes. Returns what follows the line; NULL, with `word` as it was, when there is none. */
const char *figure_line(const char *sql, const char *mark, char *word, size_t size);

/* figure_file_name: the name for the files of the drawing of `figure` that a database calls `s`, to
 * be freed by the caller. It begins with the figure's name and holds nothing that has a meaning in
 * a path, to a shell or to gnuplot. Names that differ stay different: one that had to change ends
 * in a fingerprint of what it was. */
char *figure_file_name(const char *figure, const char *s);

/* figure_description: append the text of data_dir/plots/NAME.sql to *sql, and where that has a line
 * "-- like: OTHER" the text of OTHER.sql. Returns false when there
 * is no such figure. */
bool figure_description(const char *data_dir, const char *name, struct text *sql, struct err *e);

/* figure_unknown: sets ERR_NO_INPUT with the nearest name of a figure, or all of them. Returns
 * false. */
bool figure_unknown(const char *data_dir, const char *wanted, struct err *e);

#endif
