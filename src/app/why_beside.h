/* why_beside.h - what mimdsim why says of everything beside the causes of the critical path: where
 * it passes, how much later the rest may be, and computing against communication. */
#ifndef APP_WHY_BESIDE_H
#define APP_WHY_BESIDE_H

#include <stdio.h>

#include "base/json.h"
#include "store/store.h"
#include "study/why.h"

/* why_duration: a duration [ps] with a unit in which it reads well, in buffer. */
const char *why_duration(double ps, char *buffer, size_t size);

/* why_slack_sentence: one line on how near other ranks are to the path; nothing without slack.
 * why_beside_print: the tables. why_beside_json: the same as members of the open object of `j`. */
void why_slack_sentence(const struct why *w, FILE *out);
void why_beside_print(const struct why *w, FILE *out);
void why_beside_json(const struct why *w, struct json *j);

/* why_beside_put: rows of tables slack, rank_slack, path_resource and roofline of run `run`, in
 * place of those that it had. Returns false as store_insert. */
bool why_beside_put(struct store *s, int64_t run, const struct why *w, struct err *e);

#endif
