/* cmd_links.c - mimdsim links: the most loaded links of a run, and the ports that feed them.
 *
 * Links and ports are listed apart: a port is often the busiest, as all of a node's messages
 * pass it, and would hide the links of the network. */
#include "app/arguments.h"
#include "app/verb.h"
#include "report/report.h"
#include "store/store.h"

static const char doc[] =
    "Print the most heavily loaded links of run RUN (column id of table run) in the database DB: "
    "messages, bytes, busy time and waiting time. First the ten network links with the longest "
    "waiting time, then the ten ports of nodes.\n\n"
    "Example: mimdsim links mimdsim.db\n"
    "\vThe default RUN is the stored run with the longest waiting time. Link loads are recorded by "
    "scenarios with `record: {links: true}`. A port of a node has no router at one end: an "
    "injection port leads into the network, an ejection port out of it.";

/* The run in which messages waited longest for links: the one that a user most likely asks
 * about. */
static const char choose_sql[] =
    "SELECT run_id FROM link_load GROUP BY run_id ORDER BY sum(queue_ps) DESC, sum(busy_ps) DESC, "
    "run_id LIMIT 1";

/* Whether the run that was asked for has any link loads. */
static const char any_sql[] = "SELECT 1 FROM link_load WHERE run_id = CAST(?1 AS INTEGER) LIMIT 1";

/* LIMIT in each half, so that SQLite keeps ten rows while it reads, and sorts no table. */
static const char links_sql[] =
    "WITH top AS (SELECT * FROM (SELECT * FROM link_load WHERE run_id = CAST(?1 AS INTEGER)  AND "
    "from_router IS NOT NULL AND to_router IS NOT NULL  ORDER BY queue_ps DESC, busy_ps DESC, link "
    "LIMIT 10) UNION ALL SELECT * FROM (SELECT * FROM link_load WHERE run_id = CAST(?1 AS INTEGER) "
    " AND (from_router IS NULL OR to_router IS NULL)  ORDER BY queue_ps DESC, busy_ps DESC, link "
    "LIMIT 10)), named AS (SELECT *, CASE WHEN from_router IS NULL THEN 'injection' WHEN to_router "
    "IS NULL THEN 'ejection'  ELSE 'network' END AS kind, from_router IS NULL OR to_router IS NULL "
    "AS port FROM top) SELECT l.run_id, r.machine, r.topology, r.level, r.kernel, r.P, l.kind, "
    "row_number() OVER (PARTITION BY l.port ORDER BY l.queue_ps DESC, l.busy_ps DESC, l.link) AS "
    "place, l.link, l.from_router, l.to_router, l.node, l.messages, l.sent_bytes, l.busy_ps / 1e6 "
    "AS busy_us, round(100.0 * l.busy_ps / nullif(r.makespan_ps, 0), 1) AS busy_percent, "
    "l.queue_ps / 1e6 AS queue_us FROM named l JOIN run r ON r.id = l.run_id ORDER BY l.port, "
    "place";

/* One value is enough. */
static bool take_text(void *context, int ncolumn, const char *const *name, const char *const *value)
{
    (void)ncolumn, (void)name;
    text_add(context, "%s", value[0]);
    return false;
}

/* Nothing recorded is the user's mistake, not an empty table: the message says how to record it. */
static bool print_links(const struct common *c, struct store *s, struct err *e)
{
    const char *wanted = c->narg > 1 ? c->arg[1] : NULL;
    struct text found = {0};
    bool ok = store_select(s, wanted ? any_sql : choose_sql, wanted != NULL, &wanted, take_text,
                           &found, e);
    if (ok && found.length == 0)
        ok = err_set(e, ERR_NO_INPUT,
                     "%s has no link loads%s%s; run a scenario with `record: {links: true}`",
                     c->arg[0], wanted ? " of run " : "", wanted ? wanted : "");
    /* The query of the default gives the run's number, the other one only says that there are
     * rows. */
    const char *run = wanted ? wanted : found.s;
    ok = ok && report_query(s, links_sql, 1, &run, c->json, stdout, e);
    text_free(&found);
    return ok;
}

/* Both arguments are checked before any query. */
int cmd_links(int argc, char **argv)
{
    struct common c;
    common_parse(&c, argc, argv, 0, "DB [RUN]", doc, 1, 2);
    struct err e;
    err_clear(&e);
    struct store *s = arguments_database(&c, "", &e);
    bool ok = s && (c.narg < 2 || arguments_run_number(c.arg[1], &e)) && print_links(&c, s, &e);
    store_close(s);
    return ok ? 0 : common_fail(&c, &e);
}
