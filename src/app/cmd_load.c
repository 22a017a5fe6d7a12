/* cmd_load.c - mimdsim load: latency and accepted load of networks against offered load, and where
 * they saturate.
 *
 * Order, as in other studies: measure and store, print for people, draw, print the document. */
#include "app/arguments.h"
#include "app/keep.h"
#include "app/load_curve.h"
#include "app/verb.h"
#include "report/report.h"

static const char doc[] =
    "Offer random traffic to the network of each MACHINE and measure latency (mean, median, 99th "
    "percentile, maximum) and accepted load against offered load, and the load at which it "
    "saturates. Rows go to tables `load_series` and `load_point` of the database, one figure for "
    "each traffic to load-TRAFFIC.png and .svg. Stored points are not measured again.\n\n"
    "Example: mimdsim load t3e-300 --traffic uniform,tornado --level packet,flit --rates 0.05:0.8\n"
    "\vA load of 1 keeps one link of the machine's link rate busy for each node, headers included. "
    "Latency counts from the creation of a message to its last flit, with the wait at the source; "
    "the time of the message software is left out, unless --software is given. "
    "Traffic: uniform, bitcomp, bitrev, transpose, shuffle, tornado(k,n), neighbor(k,n), shift(d), "
    "xor(d), randperm(seed), badrandom (of dragonflies), hotspot(d,...), or "
    "DATABASE:RUN, the messages of a stored run with spans, again and again, as much faster or "
    "slower "
    "as the load asks for. Without --level and --routing they are "
    "the machine's own; --level takes several, as in packet,flit.";

/* Options of scenarios that this verb shares a group with, but that would do nothing here. */
static bool refuse_useless(const struct common *c, struct err *e)
{
    if (c->machine)
        return err_set(e, ERR_USAGE, "--machine: name the machines as arguments: mimdsim load %s",
                       c->machine);
    return c->only == NULL ||
           err_set(e, ERR_USAGE, "--only picks points of a scenario; use --rates");
}

/* Everything that can be refused is refused before the database is opened. */
static bool load_all(const struct common *c, struct load_options *o, struct arena *a, struct err *e)
{
    struct load_curve *list;
    int n;
    if (!refuse_useless(c, e) || !load_options_levels(c->level, o, a, e) ||
        !load_curves_make(c, o, &list, &n, a, e))
        return false;
    struct store *s =
        report_folder_check(c->directory, e) ? arguments_store(c, c->database, e) : NULL;
    if (!s) return false;
    /* the picture is drawn from the rows, as `mimdsim plot` would draw it */
    bool ok = load_curves_measure(c, o, list, n, s, e);
    if (ok && !c->json) load_print(list, n, stdout);
    ok = ok && keep_draw(c, s, "load", e);
    if (ok && c->json) load_json(list, n, stdout);
    store_close(s);
    return ok;
}

/* Own options first: argp must not see them. Their mistakes are told after its own. */
int cmd_load(int argc, char **argv)
{
    struct common c;
    struct load_options o;
    struct err e;
    err_clear(&e);
    struct arena *a = arena_create();
    bool ok = load_options_take(&argc, argv, &o, a, &e);
    common_parse(&c, argc, argv, TAKES_PLAN | TAKES_STORE | TAKES_DIR | TAKES_JOBS | TAKES_LEVEL,
                 "MACHINE...", doc, 1, 16);
    ok = ok && load_all(&c, &o, a, &e);
    arena_destroy(a);
    return ok ? 0 : common_fail(&c, &e);
}
