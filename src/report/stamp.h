/* stamp.h - the line below a figure: how far its times are known, who made its numbers, and who
 * drew it. */
#ifndef REPORT_STAMP_H
#define REPORT_STAMP_H

#include "base/text.h"
#include "store/store.h"

/* stamp_make: the line onto *out, "" for a database that nobody wrote in:
 *
 *     error of level <= 1.2 %, machine -23..+11 %, arithmetic <= 8e-10; mimdsim 0.1.0
 * (d8b9a238f866), 14 runs, configurations da522a9663b1; drawn by 3f2a91c07b11
 *
 * Errors are the largest of the runs that are shown (view v_known_error); what is known of some of
 * them only is said to be. The commit of this program stands there where it is another one than
 * that of the numbers.
 *
 *   run_ids  the runs that are shown, as a JSON array; NULL: rows that belong to no run */
bool stamp_make(struct store *s, const char *run_ids, struct text *out, struct err *e);

#endif
