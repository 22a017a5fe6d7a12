/* machine_topology.c - see machine_topology.h. */
#include "app/machine_topology.h"

#include <string.h>

#include "report/report.h"
#include "store/store.h"
#include "study/network_view.h"

/* The picture comes from a database in memory, as every figure comes from one. What cannot be drawn
 * is told on stderr, since the numbers are there. */
static bool draw(const struct common *c, const struct network_view *v, struct arena *a,
                 struct err *e)
{
    char as[128];
    struct err own;
    err_clear(&own);
    /* Several machines are drawn side by side: each has files of its own. */
    snprintf(as, sizeof as, "topology-%s", v->spec->name);
    struct store *s = store_open("topology", STORE_MEMORY, &own);
    bool ok = s && store_note_build(s, &own) && network_view_tables(v, s, a, &own) &&
              report_figure_run(s, plan_data_dir(), "_topology", 0, as, c->directory, &own);
    store_close(s);
    if (ok && !c->quiet) fprintf(stderr, "mimdsim: %s/%s.png and .svg\n", c->directory, as);
    if (ok) return true;
    /* A full disk and the like are errors, a missing picture is none. */
    if (own.kind != ERR_UNAVAILABLE && own.kind != ERR_DATA) return *e = own, false;
    err_print(&own);
    return true;
}

/* The machine with --set applied, and its network. */
static bool look(const struct common *c, int i, struct network_view *v, struct arena *a,
                 struct err *e)
{
    struct machine_spec *m = TAKE(a, 1, struct machine_spec);
    struct plan_options o = common_plan(c);
    struct origin *origin;
    int n;
    return plan_machine(m, c->arg[i], &o, a, &origin, &n, e) && network_view_make(v, m, a, e);
}

/* Of several machines JSON has a list, text a blank line between. */
static void print(const struct common *c, const struct network_view *v)
{
    if (c->json) {
        struct json j = json_make(stdout);
        if (c->narg == 1) columns_json(&network_view_columns, v, &j);
        else columns_json_list(&network_view_columns, v, c->narg, sizeof *v, &j);
        json_finish(&j);
        return;
    }
    for (int i = 0; i < c->narg; i++) {
        printf("%s%s: %s\n", i > 0 ? "\n" : "", v[i].spec->name, v[i].spec->title);
        network_view_print(&v[i], stdout);
    }
}

/* Nothing is printed before all machines are known to be right: a document is whole or an error. */
int machine_topology(const struct common *c, struct arena *a)
{
    struct err e;
    err_clear(&e);
    struct network_view *v = TAKE(a, c->narg + 1, struct network_view);
    /* The list of all machines is no list of networks: some are too large to be measured aside. */
    bool ok = c->narg > 0 || err_set(&e, ERR_USAGE, "--topology needs the name of a machine");
    for (int i = 0; i < c->narg && ok; i++) ok = look(c, i, &v[i], a, &e);
    if (!ok) return common_fail(c, &e);
    /* Text and document first: drawing takes a second a machine. */
    print(c, v);
    for (int i = 0; i < c->narg && ok; i++) ok = draw(c, &v[i], a, &e);
    if (!ok) err_print(&e);
    return ok ? 0 : err_exit_status(e.kind);
}
