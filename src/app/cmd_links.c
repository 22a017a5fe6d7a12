/* cmd_links.c - mimdsim links: the ten most loaded links of a run. */
#include "app/verb.h"
#include "report/report.h"
#include "store/store.h"

static const char doc[] =
    "Print the ten most loaded links of run RUN (a row of table run) in the database DB: messages, bytes, "
    "how long each was busy and how long messages waited for it.\n\n"
    "Example: mimdsim links mimdsim.db\n\v"
    "Without RUN: the stored run in which messages waited longest. Loads are there for scenarios with "
    "`record: {links: true}`. A port of a node has no router at one end.";

static const char sql[] =
    "SELECT run_id, machine, topology, level, kernel, P, place, link, from_router, to_router, node, messages, "
    "sent_bytes,"
    " busy_ps / 1e6 AS busy_us, round(100 * busy_share, 1) AS busy_percent, queue_ps / 1e6 AS queue_us"
    " FROM v_link_top WHERE run_id = CASE WHEN ?1 = '' THEN"
    " (SELECT run_id FROM link_load GROUP BY run_id ORDER BY sum(queue_ps) DESC, sum(busy_ps) DESC, run_id LIMIT 1)"
    " ELSE CAST(?1 AS INTEGER) END ORDER BY place";

static bool count_row(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name, (void)value;
    ++*(int *)context;
    return true;
}

/* Nothing recorded is the user's mistake, not an empty table. */
static bool print_links(const struct common *c, struct store *s, struct err *e)
{
    const char *run = c->narg > 1 ? c->arg[1] : "";
    int rows = 0;
    if (!store_select(s, sql, 1, &run, count_row, &rows, e)) return false;
    if (rows == 0)
        return err_set(e, ERR_NO_INPUT, "%s has no link loads%s%s; run a scenario with `record: {links: true}`",
                       c->arg[0], *run ? " of run " : "", run);
    return report_query(s, sql, 1, &run, c->json, stdout, e);
}

int cmd_links(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "DB [RUN]", doc, 1, 2);
    struct err e;
    err_clear(&e);
    struct store *s = store_open(c.arg[0], STORE_READ, &e);
    bool ok = s && print_links(&c, s, &e);
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}
