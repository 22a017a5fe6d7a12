/* netcheck_loads.c - cases that are random loads: mean latencies, and the load at which a network
 * saturates. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "study/netcheck_case.h"
#include "study/netcheck_rows.h"

/* Any seed: the reference's own random numbers are not known, so only means can agree. */
enum { LOAD_SEED = 1 };

/* ---- latency against load ---- */

/* What one point of a series says. */
struct point {
    double offered, latency;
    int cycles;
    bool unstable;
};

/* One point. Of an unstable one only its load is read: it has no other values. */
static bool point_read(struct netcheck_reader *r, const struct node *point, struct point *p)
{
    *p = (struct point){.cycles = 8000};
    if (!netcheck_keys_of_point(r, point) || !netcheck_truth(r, point, "unstable", &p->unstable) ||
        !document_number(point, "offered", r->path, &p->offered, r->e))
        return false;
    if (!(p->offered > 0) || p->offered > 1)
        return err_set_at(r->e, ERR_DATA, r->path, document_find(point, "offered")->line,
                          "'offered' is %g; expected flits per node and cycle, above 0 and up to 1",
                          p->offered);
    if (p->unstable) return true;
    return document_number(point, "plat", r->path, &p->latency, r->e) &&
           document_integer(point, "cycles", r->path, 1, NETCHECK_MOST_CYCLES, &p->cycles, r->e);
}

/* What the reference says beside the latency must be possible: the latency at least that of an
 * empty network, and without the source's queue at most the whole; accepted at most what was
 * offered, and at least half of it; as many routers as there are on the routes. Means of n
 * messages scatter: six standard deviations, 6 / sqrt(n), are permitted, and some per cent for
 * the other random numbers. */
static void check_point(struct netcheck_question *k, const struct node *point,
                        const struct point *p, double empty)
{
    const struct node *nlat = netcheck_given(k->row, point, "nlat"),
                      *hops = netcheck_given(k->row, point, "hops");
    const struct node *accepted = netcheck_given(k->row, point, "accepted");
    double routers = 0, scatter = 6 / sqrt(fmax(k->q.nmessage, 1));
    /* Mean number of routers on the routes of the list: one more than links. */
    for (int m = 0; m < k->q.nmessage; m++)
        routers += (topology_distance(k->topology, k->q.src[m], k->q.dst[m]) + 1.0) / k->q.nmessage;
    /* A pattern of chance may have shorter routes than the reference's: some per cent. */
    if (p->latency < empty * (0.98 - scatter)) netcheck_flaw(k->row, "plat", p->latency, empty);
    if (nlat) {
        if (nlat->number > p->latency + 1e-3)
            netcheck_flaw(k->row, "nlat", nlat->number, p->latency);
        if (nlat->number < empty * (0.98 - scatter))
            netcheck_flaw(k->row, "nlat", nlat->number, empty);
    }
    if (hops && fabs(hops->number / routers - 1) > 0.02 + scatter)
        netcheck_flaw(k->row, "hops", hops->number, routers);
    /* throughput over load: 1 below saturation */
    double rate = accepted ? accepted->number / p->offered : 1;
    if (rate > 1.1 + scatter || rate < 0.5 - scatter)
        netcheck_flaw(k->row, "accepted", accepted->number, p->offered);
    /* Above saturation the latency depends on how long it was run: such a point is not counted. */
    else k->row->counted = rate > 0.93 - scatter;
}

/* The messages of a load. Returns false with r->e set, or without when the pattern is one that
 * this program does not have: then the row says so (netcheck_told). */
static bool messages_make(struct netcheck_reader *r, const struct node *c, const char *pattern,
                          int flits, const struct point *p, struct netcheck_question *k)
{
    struct err why;
    err_clear(&why);
    if (netcheck_load(pattern, k->topology, flits, p->offered, p->cycles, LOAD_SEED, r->arena,
                      &k->q, &why))
        return true;
    if (why.kind == ERR_UNAVAILABLE) netcheck_unanswered(k->row, why.text);
    else err_set_at(r->e, ERR_DATA, r->path, c->line, "%s", why.text);
    return false;
}

/* One point of a series is one row. Mean latencies are compared, of messages after the first
 * quarter. */
static bool ask_point(struct netcheck_reader *r, const struct node *c, const struct node *point)
{
    struct netcheck_question k = netcheck_begin(r, point, NETCHECK_LOAD);
    struct netcheck_setting s;
    struct point p;
    const char *pattern;
    int flits;
    if (!netcheck_setting_read(r, c, &s) || !netcheck_word(r, c, "pattern", &pattern) ||
        !document_integer(c, "packet_flits", r->path, 1, NETCHECK_MOST_FLITS, &flits, r->e) ||
        !point_read(r, point, &p))
        return false;
    snprintf(k.row->name, sizeof k.row->name, "%.24s %.24s S=%d vc=%d B=%d load %.4f", s.topology,
             pattern, flits, s.channels, s.buffer, p.offered);
    if (!netcheck_wanted(r, &k)) return true;
    k.row->counted = !p.unstable;
    k.row->low = k.row->high = p.latency;
    k.latency = true;
    if (!netcheck_network(r, c, &s, &k)) return netcheck_told(r);
    if (p.unstable) { /* it would measure how long it was run */
        netcheck_unanswered(k.row, "the reference was not stable at this load");
        return true;
    }
    if (!messages_make(r, c, pattern, flits, &p, &k)) return netcheck_told(r);
    if (!netcheck_keys_complete(r, c, NETCHECK_LOAD, true)) return false;
    /* The same warm-up as in saturated(). */
    k.warm = (sim_ps)(p.cycles / 4) * NETCHECK_CYCLE_PS;
    k.channel = netcheck_channel_cycles(k.topology, &k.q, k.warm, r->arena);
    double empty = netcheck_empty_latency(&k);
    /* Crowding chooses the accuracy that is stated for the point: queues are harder to predict. */
    k.row->crowding = empty > 0 ? p.latency / empty : 1;
    check_point(&k, point, &p, empty);
    if (k.row->counted) netcheck_ask(&k);
    else netcheck_unanswered(k.row, "the reference took in less than was offered");
    return true;
}

bool netcheck_load_rows(struct netcheck_reader *r, const struct node *c)
{
    const struct node *points = document_find(c, "points");
    if (points->kind != NODE_LIST || points->count == 0)
        return err_set_at(r->e, ERR_DATA, r->path, points->line,
                          "'points' must be a list of loads; it is empty");
    /* Each point has its own messages: the arena is released after it. */
    for (const struct node *p = points->child; p; p = p->next) {
        struct arena_mark mark = arena_mark(r->arena);
        if (!ask_point(r, c, p)) return false;
        arena_release(r->arena, mark);
    }
    return true;
}

/* ---- saturation ---- */

/* Probes are [[load, latency, accepted, held], ...]: the bracket must be the highest load that
 * held and the lowest that did not. */
static bool probes_read(struct netcheck_reader *r, const struct node *c, struct netcheck_row *row)
{
    const struct node *probes = document_find(c, "probes");
    double held = 0, failed = INFINITY;
    for (const struct node *p = probes ? probes->child : NULL; p; p = p->next) {
        const struct node *load = p->child, *last = load;
        /* The last element of four, in a list that knows its first. */
        while (last && last->next) last = last->next;
        bool yes = last && last->kind == NODE_TEXT && strcmp(last->text, "true") == 0;
        if (p->kind != NODE_LIST || p->count != 4 || load->kind != NODE_NUMBER)
            return err_set_at(r->e, ERR_DATA, r->path, p->line,
                              "a probe must be [load, latency, accepted, true or false]");
        if (yes) held = fmax(held, load->number);
        else failed = fmin(failed, load->number);
    }
    if (held > 0) netcheck_flaw(row, "saturation_low", row->low, held);
    if (isfinite(failed)) netcheck_flaw(row, "saturation_high", row->high, failed);
    return true;
}

/* The bounds of a series: the mean latency of an empty network under the pattern, and the load
 * that the most loaded link can carry. */
static bool check_bounds(struct netcheck_reader *r, const struct node *c,
                         struct netcheck_question *k, const char *pattern, int flits)
{
    /* A load of 2 % meets an almost empty network; 20,000 cycles give enough messages for its
     * mean. */
    const struct point low = {.offered = 0.02, .cycles = 20000};
    const struct node *zero = netcheck_given(k->row, c, "zero_load_latency");
    const struct node *bound = netcheck_given(k->row, c, "channel_bound");
    struct err why;
    err_clear(&why);
    if (!messages_make(r, c, pattern, flits, &low, k)) return false;
    double most = netcheck_channel_load(pattern, k->topology, r->arena, &why),
           empty = netcheck_empty_latency(k);
    if (zero && fabs(zero->number / empty - 1) > 0.05)
        netcheck_flaw(k->row, "zero_load_latency", zero->number, empty);
    if (most > 0) netcheck_flaw_of_key(k->row, c, "max_channel_load_per_unit_injection", most);
    if (most > 0 && bound && fabs(bound->number * most - 1) > 1e-3)
        netcheck_flaw(k->row, "channel_bound", bound->number, 1 / most);
    return true;
}

/* The load at saturation, which is between low and high. A level's answer inside the bracket has
 * no error. */
bool netcheck_saturation_rows(struct netcheck_reader *r, const struct node *c)
{
    struct netcheck_question k = netcheck_begin(r, c, NETCHECK_SATURATION);
    struct netcheck_row *row = k.row;
    struct netcheck_setting s;
    const char *pattern;
    int flits;
    if (!netcheck_setting_read(r, c, &s) || !netcheck_word(r, c, "pattern", &pattern) ||
        !document_integer(c, "packet_flits", r->path, 1, NETCHECK_MOST_FLITS, &flits, r->e) ||
        !document_number(c, "saturation_low", r->path, &row->low, r->e) ||
        !document_number(c, "saturation_high", r->path, &row->high, r->e))
        return false;
    snprintf(row->name, sizeof row->name, "%.24s %.24s S=%d vc=%d B=%d saturation", s.topology,
             pattern, flits, s.channels, s.buffer);
    if (!netcheck_wanted(r, &k)) return true;
    /* A bracket that is none cannot be searched from. */
    if (!(row->low > 0) || row->high <= row->low || row->high > 1)
        return err_set_at(
            r->e, ERR_DATA, r->path, c->line,
            "saturation between %g and %g; expected 0 < saturation_low < saturation_high <= 1",
            row->low, row->high);
    if (!netcheck_network(r, c, &s, &k)) return netcheck_told(r);
    if (!netcheck_keys_complete(r, c, NETCHECK_SATURATION, true) || !probes_read(r, c, row))
        return false;
    /* The reference against itself first: a case with a flaw judges no level. */
    if (!check_bounds(r, c, &k, pattern, flits)) return netcheck_told(r);
    netcheck_ask_saturation(&k, pattern, flits);
    return true;
}
