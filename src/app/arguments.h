/* arguments.h - arguments that several verbs take: the database, the number of a run. */
#ifndef APP_ARGUMENTS_H
#define APP_ARGUMENTS_H

#include "app/verb.h"
#include "store/store.h"

/* arguments_database: open the first argument for reading, or `otherwise` when there is none. Where
 * it is no database, but something else that is known, or the database stands behind it, *e is
 * ERR_USAGE and says so; otherwise as store_open. The caller closes it. Says on stderr, unless
 * --quiet, that an older one is read through a copy. */
struct store *arguments_database(const struct common *c, const char *otherwise, struct err *e);

/* arguments_look: as arguments_database, but says nothing on stderr: for those who open it again
 * for writing. */
struct store *arguments_look(const struct common *c, const char *otherwise, struct err *e);

/* arguments_store: store_open `path` for writing, and say on stderr, unless --quiet, that it was
 * upgraded. */
struct store *arguments_store(const struct common *c, const char *path, struct err *e);

/* arguments_store_whole: the same, but a new database is made by store_publish alone. */
struct store *arguments_store_whole(const struct common *c, const char *path, struct err *e);

/* arguments_run_number: whether `text` is the number of a run; where not, ERR_USAGE. */
bool arguments_run_number(const char *text, struct err *e);

#endif
