/* svg.h - a picture that gnuplot drew, as it may stand in a page: shapes and texts alone, with a
 * title, and with tooltips that need no script. */
#ifndef REPORT_SVG_H
#define REPORT_SVG_H

#include <stdbool.h>
#include <stdio.h>

#include "base/err.h"
#include "base/text.h"

/* svg_clean: write `svg` again to `out`.
 *
 *   svg     in  a document of gnuplot's terminal svg, or anybody's: what draws nothing (scripts,
 * links, styles, foreign elements, handlers of events) is left out prefix  in  goes in front of all
 * identifiers, so that several pictures can stand in one page; NULL: the picture is a file of its
 * own and begins as XML does
 *
 *   The title of the picture is its largest text. Texts that gnuplot hands to a script when the
 * pointer is over a point become titles of these points.
 *
 *   Returns false with ERR_DATA when `svg` is not well formed; then `out` holds a part of it. */
bool svg_clean(const struct text *svg, const char *prefix, FILE *out, struct err *e);

#endif
