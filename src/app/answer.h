/* answer.h - `answer:` of a scenario: a sentence that answers its question, out of the rows of its
 * runs, and the picture of these rows. */
#ifndef APP_ANSWER_H
#define APP_ANSWER_H

#include "plan/plan.h"
#include "store/store.h"

/* answer_check: before anything is run: names and units of the goal. True where there is no
 * `answer:`; false with ERR_DATA at its line. */
bool answer_check(const struct plan *p, struct err *e);

/* answer_read: the stored runs of `p` as a table in `a`; p is borrowed. Returns NULL with ERR_DATA
 * (`against` names no value of `of`), or as store_select. */
struct answer *answer_read(const struct plan *p, struct store *s, struct arena *a, struct err *e);

/* answer_sentence: what it says, appended to *out without a line end. */
void answer_sentence(const struct answer *t, struct text *out);

/* answer_draw: the same rows as the picture NAME.svg and .png of the scenario NAME in folder `dir`,
 * as plot_draw does it. */
bool answer_draw(const struct answer *t, struct store *s, const char *dir, struct err *e);

#endif
