/* findings.h - the sections of a report on what was measured about the answers themselves: how
 * wrong the cheaper ways are, what holds on stiff and extreme scenes, what leaving out saves. Every
 * number is the answer of a query. */
#ifndef REPORT_FINDINGS_H
#define REPORT_FINDINGS_H

#include "base/err.h"
#include "report/page.h"
#include "store/store.h"

/* findings_accuracy: section "Error against run time": the cheapest rung of each ladder, counts,
 * and for each scenario its figure and what failed. findings_stability: section "Stability":
 * counts, each algorithm with its worst case, the worst cases, steps of stiff motions, the figures.
 * findings_savings: what omissions save, and the figures; for the section "Omissions", whose
 * heading the caller writes.
 *
 *   Nothing is written when the database has no rows for it. Return false with ERR_DATA or ERR_IO.
 */
bool findings_accuracy(struct page *p, struct store *s, struct err *e);
bool findings_stability(struct page *p, struct store *s, struct err *e);
bool findings_savings(struct page *p, struct store *s, struct err *e);

/* findings_any: whether `sql` (one statement) has a row; *any. */
bool findings_any(struct store *s, const char *sql, bool *any, struct err *e);

#endif
