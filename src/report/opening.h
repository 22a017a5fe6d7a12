/* opening.h - how the report on the paper begins and ends for a newcomer: abstract, verdicts in
 * short, glossary. */
#ifndef REPORT_OPENING_H
#define REPORT_OPENING_H

#include "base/err.h"
#include "report/page.h"
#include "store/store.h"

/* opening_abstract: section "Abstract": which paper, what was asked, how many claims hold, which
 * not and why. The text is the answer of data_dir/plots/abstract.sql and verdicts.sql.
 * opening_glossary: section "Glossary", from glossary.sql. Return false with ERR_NO_INPUT, ERR_DATA
 * or ERR_IO. */
bool opening_abstract(struct page *p, struct store *s, const char *data_dir, struct err *e);
bool opening_glossary(struct page *p, struct store *s, const char *data_dir, struct err *e);

#endif
