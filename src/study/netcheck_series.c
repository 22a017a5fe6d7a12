/* netcheck_series.c - series of latency against load with a routing rule of the reference: played
 * by the same rule, with as many seeds.
 *
 * A packet counts that was born in the sample after the warm-up; traffic goes on until all of these
 * are there.
 * The answer at a point is the mean over the seeds; the reference is the range of its own. The
 * saturation is the load from which on the latency is three times that at a load of 0.02. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "study/netcheck_case.h"
#include "study/netcheck_reference.h"

enum { SEEDS = 3, LONGEST_DRAIN = 1 << 16 /* cycles */ };

/* What all points of a series share. */
struct series {
    struct netcheck_setting setting;
    struct netcheck_reference reference;
    struct arena *arena; /* of the topology, which may tabulate routes while it is used */
    const struct topology *topology;
    struct machine_spec machine;
    const struct node *permutation; /* NULL: by `pattern` */
    const char *name;               /* of the routing */
    char pattern[64];
    int flits, warm, sample;
    struct err why; /* ERR_NONE, or why no level can answer */
};

/* ---- reading ---- */

/* Where messages go: the pattern by its name, with the digits of the network; or the list. */
static bool pattern_read(struct netcheck_reader *r, const struct node *c, struct series *s)
{
    const char *pattern;
    if (!netcheck_word(r, c, "pattern", &pattern)) return false;
    const bool digits = strcmp(pattern, "tornado") == 0 || strcmp(pattern, "neighbor") == 0;
    snprintf(s->pattern, sizeof s->pattern, "%.24s%s", pattern, digits ? s->reference.digits : "");
    s->permutation = document_find(c, "permutation");
    if (!s->permutation) return true;
    const int nodes = s->topology ? s->topology->nnode : 0;
    if (s->permutation->kind != NODE_LIST || (nodes > 0 && s->permutation->count != nodes))
        return err_set_at(r->e, ERR_DATA, r->path, s->permutation->line,
                          "'permutation' must be a list of %d nodes", nodes);
    for (const struct node *x = s->permutation->child; x && nodes > 0; x = x->next)
        if (x->kind != NODE_NUMBER || x->number < 0 || x->number >= nodes)
            return err_set_at(r->e, ERR_DATA, r->path, x->line,
                              "'permutation' must list nodes 0 to %d", nodes - 1);
    snprintf(s->pattern, sizeof s->pattern, "uniform");
    return true;
}

/* The allocator of channels; others than these two are a router that this program does not have. */
static bool allocator_read(struct netcheck_reader *r, const struct node *c, struct series *s)
{
    const char *word;
    if (!netcheck_word(r, c, "vc_allocator", &word)) return false;
    s->machine.network.vc_allocator =
        strcmp(word, "select") == 0 ? ALLOCATOR_SELECT : ALLOCATOR_ISLIP;
    if (strcmp(word, "select") == 0 || strcmp(word, "islip") == 0) return true;
    return err_set(&s->why, ERR_UNAVAILABLE, "allocator '%.32s'; expected islip or select", word);
}

static bool series_read(struct netcheck_reader *r, const struct node *c, struct series *s)
{
    const int head = netcheck_head_cycles(r, c);
    err_clear(&s->why);
    if (head == 0 || !netcheck_setting_read(r, c, &s->setting) ||
        !netcheck_word(r, c, "routing_function", &s->name) ||
        !document_integer(c, "packet_flits", r->path, 1, NETCHECK_MOST_FLITS, &s->flits, r->e) ||
        !document_integer(c, "warmup_cycles", r->path, 0, 1 << 20, &s->warm, r->e) ||
        !document_integer(c, "sample_cycles", r->path, 1, 1 << 20, &s->sample, r->e))
        return false;
    if (!netcheck_reference(r, c, &s->reference, &s->why) && netcheck_told(r) &&
        s->why.kind == ERR_NONE)
        return false;
    if (!netcheck_told(r)) return false;
    if (s->why.kind == ERR_NONE)
        s->topology = topology_create(&s->reference.topology, s->arena, &s->why);
    if (s->topology) {
        s->machine = netcheck_machine(&s->reference.topology, s->setting.channels,
                                      s->setting.buffer, s->setting.packet_flits, head);
        s->machine.network.routing = s->reference.rule;
    }
    if (!pattern_read(r, c, s)) return false;
    if (s->topology && !allocator_read(r, c, s) && !netcheck_told(r)) return false;
    if (s->why.kind != ERR_NONE && s->why.kind != ERR_UNAVAILABLE)
        return err_set_at(r->e, ERR_DATA, r->path, c->line, "%s", s->why.text);
    return true;
}

/* ---- playing ---- */

/* The list of one seed, in this program's numbers of nodes. */
static bool list_make(const struct series *s, struct netcheck_question *k, double load,
                      uint64_t seed, double drain, struct err *e)
{
    /* Born until the sample's packets have arrived, so that the last of them meet others, too. */
    const int cycles = s->warm + s->sample + (int)drain;
    if (!netcheck_load(s->pattern, s->topology, s->flits, load, cycles, seed, k->arena, &k->q, e))
        return false;
    /* A permutation replaces the destinations; numbers of nodes become ours at the end, so that
     * patterns work on the reference's numbers. */
    int *to = s->permutation ? TAKE(k->arena, s->topology->nnode, int) : NULL, n = 0;
    for (const struct node *x = to ? s->permutation->child : NULL; x; x = x->next)
        to[n++] = (int)x->number;
    for (int m = 0; m < k->q.nmessage; m++) {
        if (to) k->q.dst[m] = to[k->q.src[m]];
        if (!s->reference.node) continue;
        k->q.src[m] = s->reference.node[k->q.src[m]];
        k->q.dst[m] = s->reference.node[k->q.dst[m]];
    }
    /* Only packets that were born in the sample count. */
    k->warm = (sim_ps)s->warm * NETCHECK_CYCLE_PS;
    k->until = (sim_ps)(s->warm + s->sample) * NETCHECK_CYCLE_PS;
    return true;
}

/* Mean latency of one seed. Traffic goes on for three times the latency that is expected, and
 * longer where some of the sample is still under way then: what comes behind holds it up. Where the
 * mean is `enough` already, more traffic can only raise it. */
static bool mean_of_seed(const struct series *s, struct netcheck_question *k,
                         enum network_level level, double load, uint64_t seed, double expected,
                         double enough, double *latency)
{
    struct netcheck_answer *answer = &k->row->answer[level];
    double drain = 3 * expected + 100;
    for (;;) {
        struct arena_mark mark = arena_mark(k->arena);
        struct err e;
        err_clear(&e);
        bool ok = list_make(s, k, load, seed, drain, &e);
        if (!ok) text_copy(answer->why, sizeof answer->why, e.text);
        ok = ok && netcheck_mean(k, level, latency);
        arena_release(k->arena, mark);
        if (!ok) return false;
        const double last = (double)(k->last - k->until) / NETCHECK_CYCLE_PS;
        if (last <= drain || *latency >= enough || drain > LONGEST_DRAIN) return true;
        drain = 1.5 * last;
    }
}

/* Mean latency over the seeds; false with a reason in the answer. */
static bool mean_of_seeds(const struct series *s, struct netcheck_question *k,
                          enum network_level level, double load, double expected, double enough,
                          double *mean)
{
    *mean = 0;
    /* Any seeds: the reference's own random numbers are not known, so only means can agree. */
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        double latency = 0;
        if (!mean_of_seed(s, k, level, load, seed, expected, enough, &latency)) return false;
        *mean += latency / SEEDS;
    }
    return true;
}

/* ---- points ---- */

static struct netcheck_question question(struct netcheck_reader *r, const struct node *c,
                                         const struct series *s, enum netcheck_form form)
{
    struct netcheck_question k = netcheck_begin(r, c, form);
    k.machine = s->machine;
    k.topology = s->topology;
    k.latency = true;
    k.row->family = s->reference.topology.family;
    k.row->channels = s->setting.channels;
    k.row->routed = true;
    snprintf(k.row->group, sizeof k.row->group, "%.*s %.20s",
             (int)strcspn(s->setting.topology, "0123456789_"), s->setting.topology, s->name);
    return k;
}

static bool ask_point(struct netcheck_reader *r, const struct node *point, const struct series *s,
                      const char *pattern, double empty)
{
    struct netcheck_question k = question(r, point, s, NETCHECK_LOAD);
    double offered, plat = 0;
    bool unstable;
    if (!netcheck_keys_of_point(r, point) || !netcheck_truth(r, point, "unstable", &unstable) ||
        !document_number(point, "offered", r->path, &offered, r->e))
        return false;
    if (!(offered > 0) || offered > 1)
        return err_set_at(r->e, ERR_DATA, r->path, document_find(point, "offered")->line,
                          "'offered' is %g; expected above 0 and up to 1", offered);
    snprintf(k.row->name, sizeof k.row->name, "%.24s %.20s %.20s load %.4f", s->setting.topology,
             s->name, pattern, offered);
    if (!netcheck_wanted(r, &k)) return true;
    k.row->counted = !unstable;
    if (unstable) {
        netcheck_unanswered(k.row, "the reference was not stable at this load");
        return true;
    }
    if (!document_number(point, "plat", r->path, &plat, r->e) ||
        !document_number(point, "plat_min", r->path, &k.row->low, r->e) ||
        !document_number(point, "plat_max", r->path, &k.row->high, r->e))
        return false;
    /* A mean outside the range of what it is the mean of is a damaged file. */
    if (plat < k.row->low - 1e-3) netcheck_flaw(k.row, "plat", plat, k.row->low);
    if (plat > k.row->high + 1e-3) netcheck_flaw(k.row, "plat", plat, k.row->high);
    if (s->why.kind != ERR_NONE) {
        netcheck_unanswered(k.row, s->why.text);
        return true;
    }
    /* Crowding chooses the accuracy that is stated: queues are harder to predict. */
    k.row->crowding = empty > 0 ? plat / empty : 1;
    for (int l = 0; l < LEVELS; l++) {
        struct netcheck_answer *answer = &k.row->answer[l];
        if (!k.n->level[l] ||
            !mean_of_seeds(s, &k, (enum network_level)l, offered, plat, INFINITY, &answer->found))
            continue;
        answer->ran = true;
        answer->error = netcheck_error(k.row, answer->found);
    }
    return true;
}

/* ---- saturation ---- */

static const double criterion = 3, step = 1.05, finest = 0.01;

/* 1: the latency is above the criterion, or nothing moves; 0: below; -1: cannot be run. */
static int saturated(const struct series *s, struct netcheck_question *k, enum network_level level,
                     double load, double empty)
{
    double mean;
    struct netcheck_answer *answer = &k->row->answer[level];
    const double enough = criterion * empty;
    if (mean_of_seeds(s, k, level, load, enough, enough, &mean)) return mean >= enough;
    return answer->deadlock ? 1 : -1;
}

/* Bisection from the reference's bracket outwards, as for other loads (netcheck_ask.c). */
static void ask_saturation(const struct series *s, struct netcheck_question *k,
                           enum network_level level, double empty)
{
    struct netcheck_answer *answer = &k->row->answer[level];
    double below = k->row->low, above = k->row->high;
    int found;
    /* Saturated already at the lower end: down, but at most to an eighth of it. */
    while ((found = saturated(s, k, level, below, empty)) == 1 && below > k->row->low / 8) {
        above = below;
        below /= step;
    }
    if (found < 0) return;
    /* Not saturated at the upper end: up. */
    while (below >= k->row->low && above < 1 &&
           (found = saturated(s, k, level, above, empty)) == 0) {
        below = above;
        above = fmin(above * step, 1);
    }
    if (found < 0) return;
    /* Halve only a bracket that left the reference's: inside, the error is 0 whatever the value. */
    while (above - below > finest * below && (below < k->row->low || below >= k->row->high)) {
        const double middle = (below + above) / 2;
        if (saturated(s, k, level, middle, empty) == 1) above = middle;
        else below = middle;
    }
    answer->ran = true;
    answer->found = (below + above) / 2;
    answer->error = netcheck_error(k->row, answer->found);
}

/* The series' own saturation is one more row. null: it was stable at every load. */
static bool saturation_row(struct netcheck_reader *r, const struct node *c, const struct series *s,
                           const char *pattern)
{
    const struct node *given = document_find(c, "saturation");
    double empty;
    /* null: it was stable at every load that was tried, which bounds nothing. */
    if (!given || given->kind != NODE_MAP) return true;
    struct netcheck_question k = question(r, given, s, NETCHECK_SATURATION);
    snprintf(k.row->name, sizeof k.row->name, "%.24s %.20s %.20s saturation", s->setting.topology,
             s->name, pattern);
    if (!netcheck_wanted(r, &k)) return true;
    if (!document_number(given, "saturation_low", r->path, &k.row->low, r->e) ||
        !document_number(given, "saturation_high", r->path, &k.row->high, r->e) ||
        !document_number(given, "zero_load_latency", r->path, &empty, r->e))
        return false;
    if (!(k.row->low > 0) || k.row->high <= k.row->low || k.row->high > 1)
        return err_set_at(r->e, ERR_DATA, r->path, given->line,
                          "saturation between %g and %g; expected 0 < saturation_low < "
                          "saturation_high <= 1",
                          k.row->low, k.row->high);
    if (s->why.kind != ERR_NONE) {
        netcheck_unanswered(k.row, s->why.text);
        return true;
    }
    for (int l = 0; l < LEVELS; l++) {
        if (l == LEVEL_LOGGP)
            text_copy(k.row->answer[l].why, sizeof k.row->answer[l].why,
                      "without contention nothing saturates");
        else if (k.n->level[l]) ask_saturation(s, &k, (enum network_level)l, empty);
    }
    return true;
}

/* The first point is that of an almost empty network. */
static bool series_rows(struct netcheck_reader *r, const struct node *c, struct series *s)
{
    const char *pattern;
    if (!series_read(r, c, s) || !netcheck_word(r, c, "pattern", &pattern)) return false;
    const struct node *points = document_find(c, "points"),
                      *first = points->child && points->child->kind == NODE_MAP
                                   ? document_find(points->child, "plat")
                                   : NULL;
    if (points->kind != NODE_LIST || points->count == 0)
        return err_set_at(r->e, ERR_DATA, r->path, points->line,
                          "'points' must be a list of loads; it is empty");
    const double empty = first && first->kind == NODE_NUMBER ? first->number : 0;
    for (const struct node *p = points->child; p; p = p->next)
        if (!ask_point(r, p, s, pattern, empty)) return false;
    return saturation_row(r, c, s, pattern) && netcheck_keys_complete(r, c, NETCHECK_LOAD, true);
}

bool netcheck_series_rows(struct netcheck_reader *r, const struct node *c)
{
    struct series s = {.arena = arena_create()};
    const bool ok = series_rows(r, c, &s);
    arena_destroy(s.arena);
    return ok;
}
