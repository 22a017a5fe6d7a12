/* figure_rows.c - which machines a figure shows; see figure_rows.h.
 *
 * A figure chooses: one machine of several, the shipped one before changed ones. Whoever reads it
 * must see that a choice was made, and that a changed machine is one. */
#include "report/figure_rows.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_NAMES = 2 }; /* that the foot of a figure has room for */

/* One list of machines in the making. */
struct machines {
    struct text *out;
    const char *before; /* what the list begins with */
    bool counts;        /* tell how many runs each has */
    int n, more, more_runs;
};

/* name, runs: the machines with most runs first. */
static bool add_machine(void *context, int ncolumn, const char *const *name,
                        const char *const *value)
{
    struct machines *m = context;
    (void)ncolumn, (void)name;
    if (m->n++ >= MOST_NAMES) {
        m->more++;
        m->more_runs += (int)strtol(value[1], NULL, 10);
        return true;
    }
    /* Names have commas of their own. */
    text_add(m->out, "%s", m->n == 1 ? m->before : m->counts ? "; " : ", ");
    const char *runs = m->n > 1 ? "" : strcmp(value[1], "1") == 0 ? " run" : " runs";
    if (m->counts) text_add(m->out, "%s%s on ", value[1], runs);
    text_add(m->out, "%s", value[0]);
    return true;
}

/* What is not named is counted. */
static void end_list(const struct machines *m)
{
    if (m->more == 0) return;
    text_add(m->out, " and %d more", m->more);
    if (m->counts) text_add(m->out, " (%d)", m->more_runs);
}

bool figure_rows(struct store *s, const char *run_ids, struct text *out, struct err *e)
{
    /* Shown machines are named where one of them is not as shipped, or others are left out. */
    static const char left[] =
        "SELECT l.name, count(*) FROM run r JOIN v_label l ON l.run_id = r.id WHERE r.status = "
        "'ok' AND r.kernel IN (SELECT kernel FROM run WHERE id IN (SELECT value FROM "
        "json_each(?1))) AND r.machine_key NOT IN (SELECT machine_key FROM run WHERE id IN (SELECT "
        "value FROM json_each(?1))) GROUP BY l.name ORDER BY count(*) DESC, l.name",
                      shown[] =
        "SELECT l.name, count(*) FROM v_label l WHERE l.run_id IN (SELECT value FROM json_each(?1))"
        " GROUP BY l.name ORDER BY count(*) DESC, l.name",
                      changed[] =
        "SELECT l.name, count(*) FROM v_label l JOIN v_machine_state m ON m.run_id = l.run_id"
        " WHERE m.state <> 'as shipped' AND l.run_id IN (SELECT value FROM json_each(?1))"
        " GROUP BY l.name";
    const char *const ids[] = {run_ids};
    struct text lost = {0}, other = {0}, names = {0};
    struct machines a = {.out = &lost, .before = "; left out: ", .counts = true},
                    b = {.out = &names, .before = ""}, c = {.out = &other, .before = ""};
    bool ok = store_select(s, left, 1, ids, add_machine, &a, e) &&
              store_select(s, changed, 1, ids, add_machine, &c, e) &&
              store_select(s, shown, 1, ids, add_machine, &b, e);
    if (ok && (a.n > 0 || c.n > 0) && b.n > 0) {
        end_list(&a);
        end_list(&b);
        text_add(out, "%s%s", names.s, lost.s != NULL ? lost.s : "");
    }
    text_free(&lost);
    text_free(&other);
    text_free(&names);
    return ok;
}
