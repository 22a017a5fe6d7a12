/* explanations.h - what would make the claims hold that fail: the answers of `claims --explain`,
 * told and printed. */
#ifndef REPORT_EXPLANATIONS_H
#define REPORT_EXPLANATIONS_H

#include <stdbool.h>
#include <stdio.h>

#include "base/err.h"
#include "report/page.h"
#include "store/store.h"

/* explanations_section: section "Changes under which failed claims hold": a sentence and the map
 * for each claim, and the table of answers. Nothing is written when the database has none. Returns
 * false with ERR_DATA or ERR_IO. */
bool explanations_section(struct page *p, struct store *s, struct err *e);

/* explanations_print: the sentences for people, or (json) an array with one object an answer:
 * subject, goal, verdict, variant, operators, settings, distance, value, margin, points, confirmed,
 * sentence. */
bool explanations_print(struct store *s, bool json, FILE *out, struct err *e);

#endif
