/* explain_answer.h - what a search came to: confirmed by the study's own runs, in a sentence, with
 * a map around it. */
#ifndef APP_EXPLAIN_ANSWER_H
#define APP_EXPLAIN_ANSWER_H

#include "app/explain_search.h"

/* explain_answer: the row of table explain_answer for a finished search of one claim. `goal` is its
 * column; `never` the reason why the claim cannot hold, or NULL. An answer that the study's own
 * runs do not confirm is moved away from the nominal point, a little at a time, until they do;
 * s->best is then that point. */
bool explain_answer(struct explain_bench *b, struct explain_search *s, const char *goal,
                    const char *never);

/* explain_answer_together: the same for the claims of one machine together; `without` names those
 * that are left out because they hold nowhere, NULL when there are none. `s` NULL: nothing was left
 * to search. */
bool explain_answer_together(struct explain_bench *b, struct explain_search *s,
                             const char *without);

/* explain_map: make the points of the plane of the two parameters that matter most to a search's
 * answer and keep it in table explain_map. */
bool explain_map(struct explain_bench *b, const struct explain_search *s);

#endif
