/* cmd_query.c - mimdsim query: SQL for people without sqlite3 at hand; databases of older
 * versions upgraded.
 *
 * The database is opened for reading: a query cannot change it. Views make the usual questions
 * short. */
#include "app/arguments.h"
#include "app/flag.h"
#include "app/verb.h"
#include "base/json.h"
#include "report/report.h"

static const char doc[] =
    "Run one SQL query on the database DB and print its rows.\n\n"
    "Example: mimdsim query mimdsim.db 'SELECT n, P, baseline, speedup FROM v_speedup'\n"
    "         mimdsim query --schema\n\v--schema: instead, print every table, view and column of "
    "the database with its type and meaning, as Markdown.\n"
    "\n--upgrade: make DB, which an older version of the program made, a database of this version "
    "first. The old one is kept beside it. SQL may then be left out. Verbs that only read an older "
    "database read a temporary upgraded copy; verbs that write to one upgrade it as --upgrade "
    "does.";

/* Upgrade the database and say what was done: to people on standard output, as a document when
 * no rows follow, else as a remark on standard error. */
static bool upgrade(const struct common *c, struct err *e)
{
    struct text told = {0}; /* which version it was and where the old one is */
    const bool ok = store_upgrade(c->arg[0], &told, e);
    if (ok && c->narg == 1 && c->json) {
        struct json j = json_make(stdout);
        json_object(&j);
        json_key(&j, "upgrade");
        json_text(&j, told.s);
        json_end(&j);
        json_finish(&j);
    } else if (ok && c->narg == 1) printf("%s\n", told.s);
    else if (ok && !c->quiet) fprintf(stderr, "mimdsim: %s\n", told.s);
    text_free(&told);
    return ok;
}

/* One statement, one answer: rows on standard output, and nothing else there. */
int cmd_query(int argc, char **argv)
{
    struct common c;
    const bool upgrades = take_flag(&argc, argv, "--upgrade");
    const bool schema = take_flag(&argc, argv, "--schema");
    /* How many arguments there are depends on the options, so they are taken first. */
    common_parse(&c, argc, argv, 0, upgrades ? "DB [SQL]" : "DB SQL\n--upgrade DB [SQL]\n--schema",
                 doc,
                 schema     ? 0
                 : upgrades ? 1
                            : 2,
                 schema ? 0 : 2);
    struct err e;
    err_clear(&e);
    if (schema && (c.json || upgrades)) err_set(&e, ERR_USAGE,
                                                "--schema stands alone: it writes Markdown");
    /* The manual describes a new database of this version; no file is opened. */
    if (schema) return e.kind == ERR_NONE && store_document(stdout, &e) ? 0 : common_fail(&c, &e);
    /* Upgrading opens for writing and closes: the query then reads an upgraded database. */
    bool ok = !upgrades || upgrade(&c, &e);
    struct store *s = ok && c.narg == 2 ? arguments_database(&c, "", &e) : NULL;
    if (ok && c.narg == 2) ok = s && report_query(s, c.arg[1], 0, NULL, c.json, stdout, &e);
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}
