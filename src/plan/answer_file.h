/* answer_file.h - `answer:` of a scenario: what its runs are compared by, for a sentence and a
 * picture that answer its question.
 *
 *     answer:
 *       of: variant             # what is chosen: a key of the sweep, or its variants
 *       over: n                 # optional: a key of the sweep; there is one choice for each value
 *       least: makespan         # or greatest: a formula of settings and results, as of `optimise:`
 *       called: run time        # optional: what the goal is called in sentence and picture
 *       against: as it is       # optional: the value of `of` to compare the others with
 *       within: 10 %            # optional: how much worse than that is good enough */
#ifndef PLAN_ANSWER_FILE_H
#define PLAN_ANSWER_FILE_H

#include "plan/scenario_file.h"

/* answer_file_read: s->answer from the mapping `n`. Returns false with ERR_DATA. */
bool answer_file_read(struct scenario *s, const struct node *n, struct arena *a, struct err *e);

/* answer_file_check: what has to hold once all of the file has been read: its keys are swept. */
bool answer_file_check(const struct scenario *s, struct err *e);

#endif
