/* upgrade.h - databases that an older program made become databases of this version.
 *
 * The tables are made anew and filled from the old ones, column by column of the same name, in one
 * transaction: whatever ends the program, the file holds the old database or the new one. The
 * identity of each run is computed anew from its stored configuration; a run that this program
 * cannot describe any more keeps its old one and is listed in run_older. */
#ifndef STORE_UPGRADE_H
#define STORE_UPGRADE_H

#include "base/text.h"
#include "store/connection.h"

/* upgrade_file: upgrade the open, writable database in its file, from version `version`. The old
 * one is kept beside it as PATH.vN. What was done is appended to `told`. Returns false with *e set;
 * the database is then as it was. */
bool upgrade_file(struct store *s, int version, struct text *told, struct err *e);

/* upgrade_copy: s->db becomes an upgraded copy of itself in a temporary file that SQLite removes;
 * the database stays as it is. `told` and errors as above. */
bool upgrade_copy(struct store *s, int version, struct text *told, struct err *e);

#endif
