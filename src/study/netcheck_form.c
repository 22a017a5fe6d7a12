/* netcheck_form.c - the keys of each form of reference case, and how a case is compared with
 * them.
 *
 * A file of answers that is read loosely proves nothing: a misspelt `makespan` would be a case
 * without an answer, which passes. So every key is known, needed, or told. */
#include "study/netcheck_form.h"

#include <math.h>
#include <string.h>

#include "base/text.h"

/* How a key is used:
 *     NEEDED     always there
 *     CONDITION  needed where the case has answers: with other values they would be others
 *     ANSWER     needed where the case has answers
 *     ALIKE      in all cases of a form or in none; compared where it is there
 *     CHECKED    compared where it is there
 *     READ       used where it is there
 *     IGNORED    compared with nothing, and noted */
enum use { NEEDED, CONDITION, ANSWER, ALIKE, CHECKED, READ, IGNORED };

struct key {
    const char *name;
    enum use use;
};

/* One message from every node at time 0; makespan and arrivals. */
static const struct key step_keys[] = {
    {"topology", NEEDED},
    {"pattern", NEEDED},
    {"distance", NEEDED},
    {"flits", NEEDED},
    {"vcs", CONDITION},
    {"buf_flits_per_vc", CONDITION},
    {"tie", CONDITION},
    {"makespan", ANSWER},
    {"completion", ANSWER},
    {"nodes", ALIKE},
    {"log2_distance", CHECKED},
    {"zero_load_makespan", ALIKE},
    {"mean_completion", ALIKE},
    {"max_hops", ALIKE},
    {"mean_hops", ALIKE},
    {"max_packet_flits", READ},
    {"makespan_by_variant", READ},
    {"pipeline", READ},
    {NULL, IGNORED},
};

/* A step whose answer is a band: the makespans of several variants of the router. */
static const struct key band_keys[] = {
    {"topology", NEEDED},
    {"pattern", NEEDED},
    {"distance", NEEDED},
    {"flits", NEEDED},
    {"vcs", CONDITION},
    {"buf_flits_per_vc", CONDITION},
    {"tie", CONDITION},
    {"max_packet_flits", CONDITION},
    {"makespan_by_variant", ANSWER},
    {"nodes", ALIKE},
    {"pipeline", READ},
    {NULL, IGNORED},
};

/* A collective: messages with times, delays and dependencies, as lists of one number per
 * message. */
static const struct key list_keys[] = {
    {"topology", NEEDED},
    {"trace", NEEDED},
    {"name", CONDITION},
    {"vcs", CONDITION},
    {"buf_flits_per_vc", CONDITION},
    {"tie", CONDITION},
    {"max_packet_flits", CONDITION},
    {"makespan", ANSWER},
    {"completion", ANSWER},
    {"nodes", ALIKE},
    {"messages", ALIKE},
    {"packets", ALIKE},
    {"flits", ALIKE},
    {"flit_hops", ALIKE},
    {"S", CHECKED},
    {"smax", CHECKED},
    {"distance", READ},
    {"pipeline", READ},
    {"o", IGNORED},
    {"booksim_cpu_s", IGNORED},
    {NULL, IGNORED},
};

/* A few messages, with times derived by hand for cut-through and wormhole routers and measured
 * with the reference. */
static const struct key hand_keys[] = {
    {"topology", NEEDED},
    {"messages", NEEDED},
    {"name", CONDITION},
    {"vcs", CONDITION},
    {"booksim", ANSWER},
    {"expected_vct", CHECKED},
    {"expected_wormhole", CHECKED},
    {"expected", CHECKED},
    {"order_free", CHECKED},
    {"agree", CHECKED},
    {"buf_flits_per_vc", READ},
    {"tie", READ},
    {"max_packet_flits", READ},
    {"nodes", CHECKED},
    {"pipeline", READ},
    {"derivation", IGNORED},
    {NULL, IGNORED},
};

/* What both kinds of random loads have: where, who sends to whom, and in which network. */
#define LOAD_KEYS                                                                                  \
    {"topology", NEEDED}, {"pattern", NEEDED}, {"packet_flits", NEEDED}, {"vcs", CONDITION},       \
        {"buf_flits_per_vc", CONDITION}, {"pipeline", READ}, {"tie", READ}

/* Mean latencies under a random load; the points have keys of their own. */
static const struct key load_keys[] = {
    LOAD_KEYS,
    {"points", NEEDED},
    {"routing_function", READ},
    {"routing", READ},
    {"overdriven_accepted", IGNORED},
    {"saturation", IGNORED},
    {NULL, IGNORED},
};

/* A series with its routing rule and three seeds: the same, and all that the rule depends on. */
static const struct key series_keys[] = {
    LOAD_KEYS,
    {"points", NEEDED},
    {"routing_function", NEEDED},
    {"vc_allocator", NEEDED},
    {"warmup_cycles", NEEDED},
    {"sample_cycles", NEEDED},
    {"topology_params", NEEDED},
    {"saturation", ALIKE},
    {"permutation", READ},
    {"booksim_routing", IGNORED},
    {"overdriven_accepted", IGNORED},
    {"abort_latency", IGNORED},
    {"zero_load_latency_at", IGNORED},
    {"seeds", IGNORED},
    {NULL, IGNORED},
};

/* One point of a series: the mean over the seeds, and their range. */
static const struct key seeds_keys[] = {
    {"offered", NEEDED},        {"plat", ANSWER},      {"plat_min", ANSWER},  {"plat_max", ANSWER},
    {"unstable", NEEDED},       {"hops", ALIKE},       {"cycles", IGNORED},   {"nlat", IGNORED},
    {"nlat_min", IGNORED},      {"nlat_max", IGNORED}, {"accepted", IGNORED}, {"hops_min", IGNORED},
    {"hops_max", IGNORED},      {"seeds", IGNORED},    {"n_seeds", IGNORED},
    {"accepted_min", IGNORED},  {"accepted_max", IGNORED},
    {NULL, IGNORED},
};

/* One point of a load: what the reference measured at the load `offered`. */
static const struct key point_keys[] = {
    {"offered", NEEDED}, {"plat", ANSWER},    {"cycles", ANSWER}, {"unstable", ALIKE},
    {"nlat", ALIKE},     {"accepted", ALIKE}, {"hops", ALIKE},    {"flat", IGNORED},
    {"run_s", IGNORED},  {"cpu", IGNORED},    {NULL, IGNORED},
};

/* The load at which the mean latency is three times that of the empty network, between two
 * bounds. */
static const struct key saturation_keys[] = {
    LOAD_KEYS,
    {"saturation_low", NEEDED},
    {"saturation_high", ANSWER},
    {"zero_load_latency", ALIKE},
    {"max_channel_load_per_unit_injection", ALIKE},
    {"channel_bound", ALIKE},
    {"probes", ALIKE},
    {"criterion", IGNORED},
    {NULL, IGNORED},
};

/* Inside `trace` and `messages` an unknown key is an error: nothing else belongs there. */
static const struct key trace_keys[] = {
    {"src", NEEDED},      {"dst", NEEDED},     {"flits", NEEDED}, {"time", CONDITION},
    {"delay", CONDITION}, {"deps", CONDITION}, {NULL, IGNORED},
};

/* One message of a case by hand; `t` is its start [cycles]. */
static const struct key message_keys[] = {
    {"src", NEEDED}, {"dst", NEEDED}, {"flits", NEEDED}, {"t", CONDITION}, {NULL, IGNORED},
};

/* what any case may have beside */
static const struct key remark_keys[] = {
    {"note", IGNORED}, {"split", IGNORED}, {"comment", IGNORED}, {"source", IGNORED},
    {"id", IGNORED},   {"seed", IGNORED},  {"wall_s", IGNORED},  {NULL, IGNORED},
};

/* ---- looking at keys ---- */

/* The key that tells a form, with its kind: a case by hand and a list both have `messages`, but
 * one as a list and one as a count. The order counts: `distance` occurs in lists, too. */
static const struct {
    const char *sign;
    enum node_kind kind;
    enum netcheck_form form;
} signs[] = {
    {"trace", NODE_MAP, NETCHECK_LIST},       {"points", NODE_LIST, NETCHECK_LOAD},
    {"messages", NODE_LIST, NETCHECK_HAND},   {"saturation_low", NODE_NUMBER, NETCHECK_SATURATION},
    {"distance", NODE_NUMBER, NETCHECK_STEP},
};

bool netcheck_is_series(const struct node *c)
{
    return document_find(c, "topology_params") != NULL;
}

/* The table of a form; a step without arrivals but with makespans by variant is a band. */
static const struct key *keys_of(const struct node *c, enum netcheck_form form)
{
    static const struct key *const table[] = {[NETCHECK_STEP] = step_keys,
                                              [NETCHECK_LIST] = list_keys,
                                              [NETCHECK_HAND] = hand_keys,
                                              [NETCHECK_LOAD] = load_keys,
                                              [NETCHECK_SATURATION] = saturation_keys};
    bool band =
        form == NETCHECK_STEP && !document_find(c, "completion") && !document_find(c, "makespan");
    if (form == NETCHECK_LOAD && netcheck_is_series(c)) return series_keys;
    return band && document_find(c, "makespan_by_variant") ? band_keys : table[form];
}

/* Tables are short: a linear search is enough. */
static const struct key *find_key(const struct key *table, const char *name)
{
    for (const struct key *k = table; k->name; k++)
        if (strcmp(k->name, name) == 0) return k;
    return NULL;
}

/* The same key in two cases is noted once; names live as long as the rows. */
static void note_ignored(struct netcheck_reader *r, const char *name)
{
    struct netcheck *n = r->n;
    for (int i = 0; i < n->nignored; i++)
        if (strcmp(n->ignored[i], name) == 0) return;
    if (n->nignored < NETCHECK_MOST_IGNORED) n->ignored[n->nignored++] = arena_text(r->rows, name);
}

/* An unknown key that is almost one which the case lacks is a misspelt one. */
static bool unknown_key(struct netcheck_reader *r, const struct node *map, const struct node *child,
                        const struct key *table, bool strict)
{
    /* Only keys that the case does not have: one that is there twice is not a spelling mistake. */
    const char *lacking[32];
    int n = 0;
    for (const struct key *k = table; k->name; k++)
        if (!document_find(map, k->name)) lacking[n++] = k->name;
    const char *near = text_nearest(child->key, lacking, n);
    if (near)
        return err_set_at(r->e, ERR_DATA, r->path, child->line,
                          "unknown key '%.64s'; did you mean '%s'?", child->key, near);
    /* Inside a trace nothing is ignored: a misspelt dependency would change the answer. */
    if (strict)
        return err_set_at(r->e, ERR_DATA, r->path, child->line, "unknown key '%.64s' of a message",
                          child->key);
    note_ignored(r, child->key);
    return true;
}

/* the keys that are needed, with `answers` those of a case with answers, too */
static bool complete(struct netcheck_reader *r, const struct node *map, const struct key *table,
                     bool answers)
{
    for (const struct key *k = table; k->name; k++) {
        /* A case that is played needs no conditions: it takes the defaults. */
        bool needed = k->use == NEEDED || (answers && (k->use == CONDITION || k->use == ANSWER));
        if (needed && !document_need(map, k->name, r->path, r->e)) return false;
    }
    return true;
}

/* Whether the case has the same ALIKE keys as the first case of its form: a key that was dropped
 * in one case, or added in one, is a damaged file. `first` is set by the first case with
 * answers, or the first point that has values. */
static bool alike(struct netcheck_reader *r, const struct node *map, const struct key *table)
{
    struct netcheck_alike *first = r->alike;
    /* A bit per key of the table; 32 are enough. */
    unsigned has = 0;
    /* At most one entry per table, in the order of appearance. */
    while (first->table && first->table != table) first++;
    for (int i = 0; table[i].name; i++)
        if (table[i].use == ALIKE && document_find(map, table[i].name)) has |= 1u << i;
    if (!first->table) *first = (struct netcheck_alike){table, has};
    for (int i = 0; table[i].name; i++) {
        /* A bit that differs is a key that one of the two cases does not have. */
        if (!((has ^ first->has) >> i & 1)) continue;
        return err_set_at(r->e, ERR_DATA, r->path, map->line,
                          has >> i & 1 ? "'%s' is given here, but is missing in earlier cases"
                                       : "'%s' is missing, but earlier cases have it",
                          table[i].name);
    }
    return true;
}

/* All keys of one map.
 *     answers  also the keys of a case with answers are needed
 *     strict   a key that is not in the table is an error, and remarks are not permitted */
static bool look_at(struct netcheck_reader *r, const struct node *map, const struct key *table,
                    bool answers, bool strict)
{
    if (map->kind != NODE_MAP)
        return err_set_at(r->e, ERR_DATA, r->path, map->line, "expected keys with values");
    for (const struct node *x = map->child; x; x = x->next) {
        const struct key *k = find_key(table, x->key);
        if (!k && !strict) k = find_key(remark_keys, x->key);
        if (!k && !unknown_key(r, map, x, table, strict)) return false;
        if (k && k->use == IGNORED) note_ignored(r, x->key);
    }
    return complete(r, map, table, answers);
}

/* Loads and saturations without answers make no sense; the others are played without them. Any of
 * these keys is an answer; which of them are needed, the table says. */
static bool has_answer(const struct node *c, enum netcheck_form form)
{
    if (form == NETCHECK_LOAD || form == NETCHECK_SATURATION) return true;
    static const char *const answer[] = {"makespan",         "completion", "makespan_by_variant",
                                         "booksim",          "expected",   "expected_vct",
                                         "expected_wormhole"};
    for (size_t i = 0; i < sizeof answer / sizeof *answer; i++)
        if (document_find(c, answer[i])) return true;
    return false;
}

/* Keys of c that the form has, less those that it does not have: for a case whose sign is
 * missing or misspelt, to name the form it was meant to be. */
static int likeness(const struct node *c, enum netcheck_form form)
{
    int n = 0;
    /* what stands in a list has no key */
    if (c->kind != NODE_MAP) return 0;
    for (const struct node *x = c->child; x; x = x->next)
        n += find_key(keys_of(c, form), x->key) ? 1 : -1;
    return n;
}

static bool guess_form(struct netcheck_reader *r, const struct node *c, enum netcheck_form *form)
{
    /* At least three keys in its favour, fewer would be guesswork: the likeness to be exceeded. */
    int best = 2;
    bool found = false;
    for (int f = 0; f < NETCHECK_FORMS; f++) {
        int like = likeness(c, (enum netcheck_form)f);
        if (like <= best) continue;
        best = like;
        *form = (enum netcheck_form)f;
        found = true;
    }
    return found ||
           err_set_at(r->e, ERR_DATA, r->path, c->line,
                      "a case of no known form; known are: step (distance), list (trace), hand "
                      "(messages), load (points), saturation (saturation_low)");
}

bool netcheck_form_of(struct netcheck_reader *r, const struct node *c, enum netcheck_form *form,
                      bool *referred)
{
    bool told = false;
    /* A case that is no map has no keys: it gets the message of no known form. */
    if (c->kind != NODE_MAP) return guess_form(r, c, form);
    for (size_t i = 0; !told && i < sizeof signs / sizeof *signs; i++) {
        const struct node *sign = document_find(c, signs[i].sign);
        told = sign && sign->kind == signs[i].kind;
        *form = signs[i].form;
    }
    if (!told && !guess_form(r, c, form)) return false;
    *referred = has_answer(c, *form);
    return look_at(r, c, keys_of(c, *form), false, false);
}

bool netcheck_keys_complete(struct netcheck_reader *r, const struct node *c,
                            enum netcheck_form form, bool referred)
{
    /* Asked when the values have been checked: a wrong value is the worse mistake and is told
     * first. */
    const struct key *table = keys_of(c, form);
    return complete(r, c, table, referred) && (!referred || alike(r, c, table));
}

/* A point at which the reference was not stable has no values. */
bool netcheck_keys_of_point(struct netcheck_reader *r, const struct node *point)
{
    bool unstable = false;
    /* Only points of a series have a range. */
    const bool series = document_find(point, "n_seeds") != NULL;
    const struct key *keys = series ? seeds_keys : point_keys;
    return netcheck_truth(r, point, "unstable", &unstable) &&
           look_at(r, point, keys, !unstable, false) && (unstable || alike(r, point, keys));
}

bool netcheck_keys_of_trace(struct netcheck_reader *r, const struct node *trace, bool referred)
{
    return look_at(r, trace, trace_keys, referred, true);
}

bool netcheck_keys_of_message(struct netcheck_reader *r, const struct node *message, bool referred)
{
    return look_at(r, message, message_keys, referred, true);
}

/* ---- values ---- */

bool netcheck_integer(struct netcheck_reader *r, const struct node *c, const char *key, int lo,
                      int hi, int otherwise, int *i)
{
    /* JSON null is a value that is not there, as in the reference's files. */
    const struct node *x = document_find(c, key);
    /* set even where the value is refused */
    *i = otherwise;
    if (!x || x->kind == NODE_NULL) return true;
    return document_integer(c, key, r->path, lo, hi, i, r->e);
}

bool netcheck_truth(struct netcheck_reader *r, const struct node *c, const char *key, bool *truth)
{
    const struct node *x = document_find(c, key);
    *truth = x && x->kind == NODE_TEXT && strcmp(x->text, "true") == 0;
    if (!x || *truth || (x->kind == NODE_TEXT && strcmp(x->text, "false") == 0)) return true;
    return err_set_at(r->e, ERR_DATA, r->path, x->line, "'%s' must be true or false", key);
}

bool netcheck_word(struct netcheck_reader *r, const struct node *c, const char *key,
                   const char **word)
{
    const struct node *x = document_find(c, key);
    *word = x && x->kind == NODE_TEXT ? x->text : "";
    if (!x || x->kind == NODE_TEXT) return true;
    return err_set_at(r->e, ERR_DATA, r->path, x->line, "'%s' must be a text", key);
}
