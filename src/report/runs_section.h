/* runs_section.h - the section of a report that shows every run of the database, by kernel and
 * machine. */
#ifndef REPORT_RUNS_SECTION_H
#define REPORT_RUNS_SECTION_H

#include "base/err.h"
#include "report/page.h"
#include "store/store.h"

/* runs_section: heading, and for each kernel its figure (plots/runs) and a table of its machines,
 * those of a what-if under their own names with what was changed. Nothing is written when no run is
 * stored. Returns false with ERR_DATA or ERR_IO. */
bool runs_section(struct page *p, struct store *s, struct err *e);

#endif
