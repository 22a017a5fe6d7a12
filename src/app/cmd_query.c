/* cmd_query.c - mimdsim query: SQL for people without sqlite3 at hand. */
#include "app/arguments.h"
#include "app/verb.h"
#include "report/report.h"

static const char doc[] = "Run one SQL query on the database DB and print its rows.\n\n"
                          "Example: mimdsim query mimdsim.db 'SELECT n, P, baseline, speedup FROM v_speedup'\n";

int cmd_query(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "DB SQL", doc, 2, 2);
    struct err e;
    err_clear(&e);
    struct store *s = arguments_database(&c, "", &e);
    bool ok = s && report_query(s, c.arg[1], 0, NULL, c.json, stdout, &e);
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}
