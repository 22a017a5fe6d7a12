/* audit_rules.h - what the files of the audit share: adding a finding, and the parts of
 * audit_database. */
#ifndef STUDY_AUDIT_RULES_H
#define STUDY_AUDIT_RULES_H

#include "spec/run_spec.h"
#include "study/audit.h"

/* audit_find: one more contradiction, printf-like. */
void audit_find(struct audit_report *r, int64_t run, const char *rule, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* audit_rows: the rules that are queries. audit_settings: numbers and units of settings, which are
 * their texts read again. audit_configurations: identity, settings, machine and
 * serial codes of every run. audit_again: runs made again. All return false with the error of a
 * database that cannot be read. */
bool audit_rows(struct store *s, struct audit_report *r, struct err *e);
bool audit_settings(struct store *s, struct audit_report *r, struct err *e);
bool audit_configurations(struct store *s, struct audit_report *r, struct err *e);
bool audit_again(struct store *s, const struct audit_options *o, struct audit_report *r,
                 struct err *e);

/* audit_sql: audit.sql, a text of this program. */
const char *audit_sql(void);

/* audit_spec: the run that `config_text` describes, with its identity and texts in `a`.
 *
 *   Returns false with a clause in why[size] when a setting does not exist any more or is none. */
bool audit_spec(struct run_spec *spec, const char *config_text, struct arena *a, char *why,
                int size);

#endif
