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
    "injection port leads into the network, an ejection port out of it. Of a run in which several "
    "jobs shared the machine, each link has a row for every job that used it, with its share of "
    "the time in which the link was busy.";

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

/* The same, link by link, of all jobs that ran together in that run: every job's part of the time
 * in which the link was busy. Those of one set in one combination, in which the names of a run and
 * of those beside it are the same; a run of one program alone has no job. */
static const char shares_sql[] =
    "WITH member AS (SELECT r.id, r.rep, r.makespan_ps, s.value AS job_set, n.value AS job, "
    "CAST(k.value AS INTEGER) AS number, b.value AS beside, "
    "iif(b.value GLOB '[0-9]* jobs', b.value, (SELECT group_concat(value) FROM (SELECT value FROM "
    "json_each('[\"' || replace(n.value || iif(b.value = '', '', ' + ' || b.value), ' + ', "
    "'\",\"') || '\"]') ORDER BY value))) AS together FROM run r JOIN v_setting s "
    "ON s.run_id = r.id AND s.key = 'job.set' JOIN v_setting n ON n.run_id = r.id AND n.key = "
    "'job.name' JOIN v_setting k ON k.run_id = r.id AND k.key = 'job.number' JOIN v_setting b ON "
    "b.run_id = r.id AND b.key = 'job.beside'), "
    "all_jobs AS (SELECT m.* FROM member m JOIN member a ON a.id = CAST(?1 AS INTEGER) AND "
    "a.job_set = m.job_set AND a.rep = m.rep AND a.together = m.together), "
    "part AS MATERIALIZED (SELECT l.link, l.from_router, l.to_router, l.node, l.messages, "
    "l.sent_bytes, l.busy_ps, l.queue_ps, l.from_router IS NULL OR l.to_router IS NULL AS port, "
    "j.id, j.job, j.number, j.makespan_ps FROM link_load l JOIN all_jobs j ON j.id = l.run_id), "
    "whole AS (SELECT link, port, sum(busy_ps) AS busy_ps, row_number() OVER (PARTITION BY port "
    "ORDER BY sum(queue_ps) DESC, sum(busy_ps) DESC, link) AS place FROM part GROUP BY link) "
    "SELECT p.id AS run_id, CASE WHEN p.from_router IS NULL THEN 'injection' WHEN p.to_router IS "
    "NULL THEN 'ejection' ELSE 'network' END AS kind, w.place, p.link, p.from_router, p.to_router, "
    "p.node, p.job, p.messages, p.sent_bytes, p.busy_ps / 1e6 AS busy_us, round(100.0 * p.busy_ps "
    "/ nullif(w.busy_ps, 0), 1) AS share_percent, round(100.0 * p.busy_ps / "
    "nullif(p.makespan_ps, 0), 1) AS busy_percent, p.queue_ps / 1e6 AS queue_us FROM part p JOIN "
    "whole w ON w.link = p.link WHERE w.place <= 10 AND p.messages > 0 ORDER BY w.port, w.place, "
    "p.number";

/* Whether others ran beside the run. */
static const char beside_sql[] =
    "SELECT 1 FROM v_setting WHERE run_id = CAST(?1 AS INTEGER) AND key = 'job.beside' AND value "
    "NOT IN ('', 'background')";

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
    struct text beside = {0};
    ok = ok && store_select(s, beside_sql, 1, &run, take_text, &beside, e);
    ok = ok && report_query(s, beside.length > 0 ? shares_sql : links_sql, 1, &run, c->json, stdout,
                            e);
    text_free(&beside);
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
