/* report_document.h - a report as NAME.md and NAME.html, on the paper or on the contents of a
 * database. */
#ifndef REPORT_DOCUMENT_H
#define REPORT_DOCUMENT_H

#include <stdbool.h>

#include "base/err.h"
#include "store/store.h"

/* One number of a machine, as text for people. */
struct document_parameter {
    const char *machine, *key, *value, *range, *evidence, *source;
};

struct document {
    struct store *store;
    const char *name, *title;
    /* every chapter, telling what is missing; otherwise those that the database has rows for */
    bool whole;
    const char *data_dir; /* holds plots/ */
    const char *figures;  /* folder of the pictures; the report is written beside it */
    int nfigure;
    const char *const *figure; /* (nfigure) names, in order */
    int nparameter;
    const struct document_parameter *parameter;
    double host_s; /* how long the command took; 0: not told */
};

/* document_write: on claims the abstract, contents, claims that fail, the table of claims; the
 * figures, error against run time, stability, the machines, accuracy, what was left out, time and
 * provenance; a glossary where there are claims. Returns false with ERR_NO_INPUT, ERR_CREATE,
 * ERR_IO or ERR_DATA. */
bool document_write(const struct document *d, struct err *e);

#endif
