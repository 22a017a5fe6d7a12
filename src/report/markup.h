/* markup.h - the one way from any text into HTML and SVG. */
#ifndef REPORT_MARKUP_H
#define REPORT_MARKUP_H

#include <stddef.h>
#include <stdio.h>

/* markup_escape_bytes: `n` bytes of text for HTML or XML, also inside attributes. Characters of
 * markup become entities; control characters, which XML forbids, become blanks. */
void markup_escape_bytes(FILE *out, const char *s, size_t n);

/* markup_escape: the same of a whole text. */
void markup_escape(FILE *out, const char *s);

#endif
