/* identity.h - what identifies a run: its settings that differ from their defaults, by name, in a
 * canonical text.
 *
 * Defaults are those of the field tables, so a machine file's values count where they differ from
 * these. A new setting with a default changes no identity. A default must never change without a
 * new STORE_VERSION (store/connection.h): the identities of stored runs are then computed anew from
 * their full configurations. tests/golden/defaults.txt guards it. */
#ifndef SPEC_IDENTITY_H
#define SPEC_IDENTITY_H

#include "base/arena.h"
#include "base/text.h"
#include "spec/field.h"

/* Makes identities of many runs; remembers the texts of structs that did not change since the run
 * before. */
struct identity;

/* identity_create: for runs with these `n` tables; `table` is borrowed. identity_of_runs: with
 * those of struct run_spec (field_tables). The caller owns it. */
struct identity *identity_create(const struct field_table *const *table, int n);
struct identity *identity_of_runs(void);

/* identity_destroy: accepts NULL. */
void identity_destroy(struct identity *x);

/* identity_or_own: `lent`, or one of runs where it is NULL, to be given to identity_back at the end
 * with the same `lent`: that destroys what was not lent. */
struct identity *identity_or_own(struct identity *lent);
void identity_back(struct identity *x, const struct identity *lent);

/* identity_forget: forget the texts of the run before. Lists are remembered by their place in
 * memory: to be called before the arena of earlier runs is released and used anew. */
void identity_forget(struct identity *x);

/* identity_texts: the two canonical texts of the structs at `base`, appended, as "key = value"
 * lines.
 *
 *   base  in   what the tables' offsets count from: a struct run_spec
 *   more  in   further "key = value" lines, which are part of both texts: what is told of files
 *   full  out  all settings, in table order: the configuration for people
 *   own   out  those that differ from their defaults, sorted by key: its SHA-256 is the identity */
void identity_texts(struct identity *x, const void *base, const char *more, struct text *full,
                    struct text *own);

/* identity_job: the settings of a member of a set (job_alone) that differ from their defaults, as
 * lines in `a`: job_set.text. */
const char *identity_job(struct identity *x, const struct run_spec *job, struct arena *a);

/* identity_set: fill config_text (in `a`) and config_hash of a run whose settings, model_file and
 * program are final. Files of models and programs count by their content, wherever they lie; the
 * parameters of a program count as settings do. */
void identity_set(struct identity *x, struct run_spec *run, struct arena *a);

/* run_identify: identity_set for one run that was made from another one by changing settings. */
void run_identify(struct run_spec *run, struct arena *a);

/* run_from_text: the settings of a stored configuration `text` (config_text); what it does not name
 * has its default.
 *
 *   run  out  settings, model_file and program, no identity yet; lists in `a`
 *   why  out  on failure, in `size` bytes: which line, and why
 *
 *   Returns false when a setting does not exist any more or does not take this value any more. */
bool run_from_text(struct run_spec *run, const char *text, struct arena *a, char *why, int size);

#endif
