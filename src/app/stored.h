/* stored.h - what stored answers were made for, so that they are found again and not made twice.
 *
 * An answer that takes many runs is kept in the database with a digest of everything that it
 * depends on, in table meta. The same digest means that the answer still holds. */
#ifndef APP_STORED_H
#define APP_STORED_H

#include "base/text.h"
#include "report/claims.h"
#include "spec/run_spec.h"
#include "store/store.h"

/* stored_add_runs, stored_add_claim: what an answer depends on onto *all: the identities of n runs;
 * a claim with its query. */
void stored_add_runs(struct text *all, const struct run_spec *spec, int n);
void stored_add_claim(struct text *all, const struct claim_rule *rule);

/* stored_digest: SHA-256 of *all, which is freed. */
void stored_digest(struct text *all, char hex[65]);

/* stored_note: the note `key` of the database, "" when there is none. False with *e set. */
bool stored_note(struct store *s, const char *key, char value[65], struct err *e);

/* stored_is: whether the note `key` is `hex`; a database that cannot be read has none. */
bool stored_is(struct store *s, const char *key, const char *hex);

/* stored_keep: the note `key` becomes `text`, in place of an older one. False as store_insert. */
bool stored_keep(struct store *s, const char *key, const char *text, struct err *e);

#endif
