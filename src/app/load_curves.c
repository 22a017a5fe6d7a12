/* load_curves.c - the curves of a command line, before anything is simulated (load_curve.h). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/load_curve.h"
#include "base/digest.h"
#include "base/text.h"
#include "spec/spec_fields.h"

/* Raised when the numbers of a point would come out differently: stored ones are then others'. */
enum { LOAD_VERSION = 1 };

/* The setting that chooses routes: the one of the network, or that of the topology where the
 * network has none. */
static const char *routing_key(void)
{
    static const char own[] = "machine.network.routing", other[] = "machine.topology.routing";
    const struct field_table *table;
    return field_find_full(own, &table) ? own : other;
}

/* What `--machine`-like arguments ask for, one curve at a time. */
struct making {
    const struct common *c;
    const struct load_options *o;
    const char *machine, *routing, *traffic;
    int level; /* -1: the machine's own */
    struct arena *a;
    struct err *e;
};

/* The machine with the settings of the command line, and the routing wanted. */
static bool machine_of(const struct making *k, struct load_curve *x)
{
    struct plan_options po = common_plan(k->c);
    const char *set[COMMON_MOST_SETS + 1];
    /* one more setting behind those of the command line, so that it counts */
    struct text routing = {0};
    text_add(&routing, "%s=%s", routing_key(), k->routing ? k->routing : "");
    for (int i = 0; i < po.nset; i++) set[i] = po.set[i];
    if (k->routing) set[po.nset++] = arena_text(k->a, routing.s);
    text_free(&routing);
    po.set = set;
    if (!plan_machine(&x->machine, k->machine, &po, k->a, NULL, NULL, k->e)) return false;
    /* The wire alone: gaps between messages and the time of interfaces are the software's. */
    if (!k->o->software) x->machine.software = (struct software_spec){.eager_bytes = -1};
    if (k->level >= 0) x->machine.network.level = (enum network_level)k->level;
    if ((int)x->machine.network.level < LEVELS) return true;
    return err_set(k->e, ERR_CONFIG,
                   "machine %s chooses its network level by a tolerance; expected --level with "
                   "loggp, link, packet, flit or auto",
                   x->machine.name);
}

/* What the curve is called: the machine's name, and what was changed of it. */
static void name_series(const struct making *k, struct load_curve *x)
{
    struct load_series *s = &x->series;
    struct text t = {0};
    text_add(&t, "%s", k->c->name ? k->c->name : x->machine.name);
    for (int i = 0; i < k->c->nset && !k->c->name; i++) {
        const char *key = k->c->set[i];
        text_add(&t, ", %s", strncmp(key, "machine.", 8) == 0 ? key + 8 : key);
    }
    if (k->o->software && !k->c->name) text_add(&t, ", with software");
    text_copy(s->machine, sizeof s->machine, t.s);
    text_free(&t);
    const struct field_table *table;
    const struct field *f = field_find_full(routing_key(), &table);
    field_print(f, &x->machine, &t);
    text_copy(s->routing, sizeof s->routing, t.s);
    text_free(&t);
    /* as the settings call it, so that a name can be given back to --level */
    text_copy(s->level, sizeof s->level, network_level_name(x->machine.network.level));
    text_copy(s->traffic, sizeof s->traffic, k->traffic);
}

/* The settings of the network, its topology and the message software: no other part of a machine
 * is used here. */
static void add_network(const struct machine_spec *m, struct text *out)
{
    static const char *const part[] = {"machine.topology.", "machine.network.",
                                       "machine.software."};
    struct text all = {0};
    fields_print(&machine_table, m, false, &all);
    for (const char *line = all.s, *end; line && *line; line = *end ? end + 1 : end) {
        end = strchrnul(line, '\n');
        for (int i = 0; i < 3; i++)
            if (strncmp(line, part[i], strlen(part[i])) == 0)
                text_add(out, "%.*s\n", (int)(end - line), line);
    }
    text_free(&all);
}

/* Everything that a point depends on but its load. What people call the curve is a part of it, so
 * that two names are two curves. */
static void identify(const struct making *k, struct load_curve *x)
{
    struct text t = {0};
    /* in words, so that a digest can be taken by hand */
    text_add(&t, "load %d\nname = %s\ntraffic = %s\nbytes = %lld\nseed = %llu\nwithin = %.17g\n",
             LOAD_VERSION, x->series.machine, k->traffic, (long long)k->o->bytes,
             (unsigned long long)k->o->seed, k->o->within);
    text_add(&t, "messages = %d\n", k->o->most);
    if (load_is_recording(k->traffic)) load_recording_identify(&x->recording, &t);
    add_network(&x->machine, &t);
    digest_sha256_hex(t.s, t.length, x->series.series);
    text_free(&t);
}

/* The network, then what it is called and known by, then what needs a simulator: mistakes of the
 * command line are told before anything takes time. */
static bool curve_make(const struct making *k, struct load_curve *x)
{
    const struct load_options *o = k->o;
    /* settings of the command line act before routes and levels are chosen */
    if (!machine_of(k, x)) return false;
    x->question = (struct load_question){.machine = &x->machine,
                                         .traffic = k->traffic,
                                         .bytes = o->bytes,
                                         .seed = o->seed,
                                         .within = o->within,
                                         .most = o->most};
    const bool recorded = load_is_recording(k->traffic);
    if (recorded && !load_recording_read(k->traffic, &x->recording, k->a, k->e)) return false;
    name_series(k, x);
    identify(k, x);
    /* a point for each rate, filled in by whoever measures it */
    x->npoint = o->nrate;
    x->point = TAKE(k->a, o->nrate, struct load_point);
    return load_begin(&x->question, recorded ? &x->recording : NULL, &x->series, k->a, k->e);
}

static bool curves_of_size(const struct common *c, const struct load_options *o,
                           struct load_curve **list, int *n, struct arena *a, struct err *e)
{
    /* what is not asked for is the machine's own: one way */
    const int nrouting = o->nrouting ? o->nrouting : 1, nlevel = o->nlevel ? o->nlevel : 1;
    const int all = c->narg * nrouting * nlevel * o->ntraffic;
    *n = 0;
    *list = TAKE(a, all, struct load_curve);
    /* Curves that belong into one picture follow each other: traffic is outermost. */
    /* the numbers of machine, routing and level out of the curve's own */
    for (int i = 0; i < all; i++) {
        const int per = all / o->ntraffic, rest = i % per;
        const int machine = rest / (nrouting * nlevel), routing = rest / nlevel % nrouting;
        struct making k = {.c = c, .o = o, .a = a, .e = e};
        k.machine = c->arg[machine];
        k.routing = o->nrouting ? o->routing[routing] : NULL;
        k.level = o->nlevel ? (int)o->level[rest % nlevel] : -1;
        k.traffic = o->traffic[i / per];
        if (!curve_make(&k, &(*list)[i])) return false;
        ++*n;
    }
    return true;
}

/* Whether one of the curves has more messages under way at its highest load than a run may have. */
static bool is_crowded(const struct load_options *o, const struct load_curve *list, int n,
                       double margin)
{
    for (int i = 0; i < n; i++) {
        const struct load_curve *x = &list[i];
        double top = o->nrate > 0 ? o->rate[o->nrate - 1] : 0;
        if (x->question.recording) continue;
        if (o->saturation) top = fmax(top, load_first_probe(&x->series));
        if (margin * load_least_messages(&x->question, top) > o->most) return true;
    }
    return false;
}

/* Fast links hold thousands of small messages. Then larger ones, unless a size was asked for: the
 * smallest of which a run may be lengthened twice, as steady states need; the same for all curves
 * of a picture. */
bool load_curves_make(const struct common *c, struct load_options *o, struct load_curve **list,
                      int *n, struct arena *a, struct err *e)
{
    enum { LONGER = 4, LARGEST = 1 << 20 };
    bool ok = curves_of_size(c, o, list, n, a, e);
    if (!ok || o->sized || !is_crowded(o, *list, *n, 1)) return ok;
    while (ok && o->bytes < LARGEST && is_crowded(o, *list, *n, LONGER)) {
        o->bytes *= 2;
        ok = curves_of_size(c, o, list, n, a, e);
    }
    if (ok && !c->quiet)
        fprintf(stderr,
                "mimdsim: messages of %lld B, since a run of %d smaller ones would not get through "
                "these networks; --size chooses others\n",
                (long long)o->bytes, o->most);
    return ok;
}
