/* why_print.h - what mimdsim why answers: words and tables, or one JSON document. */
#ifndef APP_WHY_PRINT_H
#define APP_WHY_PRINT_H

#include <stdio.h>

#include "spec/run_spec.h"
#include "study/why.h"

/* why_print: for people; `sure`: a sentence on how far the time is known (report/how_sure.h).
 * why_print_json: one document. */
void why_print(const struct run_spec *spec, const struct why *w, const char *sure, FILE *out);
void why_print_json(const struct run_spec *spec, const struct why *w, const char *sure, FILE *out);

#endif
