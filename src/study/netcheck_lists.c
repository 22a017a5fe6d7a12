/* netcheck_lists.c - cases that are lists of messages: steps, collectives, cases by hand. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "study/netcheck_case.h"
#include "study/netcheck_rows.h"

/* ---- what the reference says of itself ---- */

/* What a step says of itself, recomputed: the makespan of an empty network, hops and mean
 * arrival. A case whose own numbers disagree is told as a flaw; it cannot judge a level. */
static void check_step(struct netcheck_question *k, const struct node *c, int distance)
{
    double sum = 0, hops = 0, most = 0, empty = 0;
    int n = k->q.nmessage;
    for (int m = 0; m < n; m++) {
        int links = topology_distance(k->topology, k->q.src[m], k->q.dst[m]);
        sum += k->arrival ? k->arrival[m] : 0;
        hops += links;
        most = fmax(most, links);
        empty = fmax(empty, netcheck_empty(k, m));
    }
    netcheck_flaw_of_key(k->row, c, "zero_load_makespan", empty);
    netcheck_flaw_of_key(k->row, c, "max_hops", most);
    netcheck_flaw_of_key(k->row, c, "mean_hops", hops / fmax(n, 1));
    if (k->arrival) netcheck_flaw_of_key(k->row, c, "mean_completion", sum / fmax(n, 1));
    /* log2_distance is compared for powers of two only: for another distance the file may have
     * rounded. */
    if (distance > 0 && (distance & (distance - 1)) == 0)
        netcheck_flaw_of_key(k->row, c, "log2_distance", log2(distance));
}

/* The counts of a list: messages, packets, flits, and flits times what they pass (links and both
 * ends of the route). */
static void check_list(struct netcheck_question *k, const struct node *c)
{
    double packets = 0, flits = 0, passed = 0, longest = 0;
    int64_t most = k->machine.network.packet_bytes / NETCHECK_FLIT_BYTES;
    for (int m = 0; m < k->q.nmessage; m++) {
        int64_t s = k->q.bytes[m] / NETCHECK_FLIT_BYTES;
        /* ceil(s / most) packets of one message; most = 0: a message is one packet. */
        packets += most > 0 ? (double)((s + most - 1) / most) : 1;
        flits += (double)s;
        passed += (double)s * (topology_distance(k->topology, k->q.src[m], k->q.dst[m]) + 2);
        longest = fmax(longest, (double)s);
    }
    const struct node *at_most = document_find(c, "smax");
    netcheck_flaw_of_key(k->row, c, "messages", k->q.nmessage);
    netcheck_flaw_of_key(k->row, c, "packets", packets);
    netcheck_flaw_of_key(k->row, c, "flits", flits);
    netcheck_flaw_of_key(k->row, c, "flit_hops", passed);
    netcheck_flaw_of_key(k->row, c, "S", longest);
    /* smax is an upper bound, not the largest size itself. */
    if (at_most && at_most->kind == NODE_NUMBER && at_most->number < longest)
        netcheck_flaw(k->row, "smax", at_most->number, longest);
}

/* ---- steps ---- */

/* the list of numbers `key` (lists of exactly n) */
static double *numbers(const struct netcheck_reader *r, const struct node *map, const char *key,
                       int n)
{
    double *x = TAKE(r->arena, n + 1, double);
    return document_numbers(map, key, r->path, x, n, r->e) ? x : NULL;
}

/* Arrivals and makespan of a case. Returns false with r->e set when one is missing; that they
 * disagree is a flaw of the row. */
static bool arrivals_read(struct netcheck_reader *r, const struct node *c,
                          struct netcheck_question *k)
{
    double makespan;
    if (!document_number(c, "makespan", r->path, &makespan, r->e)) return false;
    k->row->low = k->row->high = makespan;
    k->arrival = numbers(r, c, "completion", k->q.nmessage);
    if (!k->arrival) return false;
    k->row->compared = true;
    netcheck_check_arrivals(k, makespan);
    return true;
}

/* For qsort. */
static int by_number(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Variants of a router were measured between 0.45 and 1.35 of their median, and those that wait for
 * the credits of whole packets up to 3.0: one that is further off is no variant. */
static void check_variants(struct netcheck_row *row, const struct node *band, const double *x,
                           int n, struct arena *a)
{
    double *sorted = TAKE(a, n, double);
    memcpy(sorted, x, (size_t)n * sizeof *sorted);
    qsort(sorted, (size_t)n, sizeof *sorted, by_number);
    double median = sorted[n / 2];
    int i = 0;
    for (const struct node *v = band->child; v; v = v->next, i++) {
        double most = (strcmp(v->key, "tailcredit") == 0 ? 3.6 : 1.6) * median;
        if (x[i] > most) netcheck_flaw(row, v->key, x[i], most);
        if (x[i] < 0.4 * median) netcheck_flaw(row, v->key, x[i], 0.4 * median);
    }
}

/* A band: the shortest and the longest makespan of the variants, widened by 15 %. A level's
 * answer is right anywhere in it. */
static bool band_read(struct netcheck_reader *r, const struct node *band,
                      struct netcheck_question *k)
{
    double *x = TAKE(r->arena, band->count + 1, double);
    int n = 0;
    if (band->kind != NODE_MAP || band->count == 0)
        return err_set_at(r->e, ERR_DATA, r->path, band->line,
                          "'makespan_by_variant' must hold numbers by name");
    for (const struct node *v = band->child; v; v = v->next)
        if (!document_flat(v, v->key, r->path, &x[n++], 1, r->e)) return false;
    k->row->low = INFINITY;
    for (int i = 0; i < n; i++) {
        k->row->low = fmin(k->row->low, 0.85 * x[i]);
        k->row->high = fmax(k->row->high, 1.15 * x[i]);
    }
    check_variants(k->row, band, x, n, r->arena);
    /* No router is faster than an empty network. */
    double empty = 0;
    for (int m = 0; m < k->q.nmessage; m++) empty = fmax(empty, netcheck_empty(k, m));
    if (k->row->low < 0.85 * empty - 1e-3)
        netcheck_flaw(k->row, "the shortest makespan", k->row->low / 0.85, empty);
    return true;
}

/* One row. Reading the values comes before asking for missing keys: a wrong value is the worse
 * mistake and is told first. */
bool netcheck_step_rows(struct netcheck_reader *r, const struct node *c, bool referred)
{
    struct netcheck_question k = netcheck_begin(r, c, NETCHECK_STEP);
    struct netcheck_setting s;
    struct err why;
    int distance, flits;
    const char *pattern;
    const struct node *band = document_find(c, "makespan_by_variant");
    if (!netcheck_setting_read(r, c, &s) || !netcheck_word(r, c, "pattern", &pattern) ||
        !document_integer(c, "distance", r->path, 0, NETCHECK_MOST_NODES, &distance, r->e) ||
        !document_integer(c, "flits", r->path, 1, NETCHECK_MOST_FLITS, &flits, r->e))
        return false;
    snprintf(k.row->name, sizeof k.row->name, "%.24s %.16s(%d) S=%d vc=%d B=%d tie=%d", s.topology,
             pattern, distance, flits, s.channels, s.buffer, s.tie < 0 ? 0 : s.tie);
    /* A file without answers is played. */
    k.row->played = !referred;
    if (!netcheck_wanted(r, &k)) return true;
    if (!netcheck_network(r, c, &s, &k)) return netcheck_told(r);
    err_clear(&why);
    /* The pattern's error has no place in the file yet. */
    if (!netcheck_step(pattern, distance, k.topology->nnode, flits, r->arena, &k.q, &why))
        return err_set_at(r->e, ERR_DATA, r->path, c->line, "%s", why.text);
    if (!netcheck_keys_complete(r, c, NETCHECK_STEP, referred)) return false;
    if (referred && !(band ? band_read(r, band, &k) : arrivals_read(r, c, &k))) return false;
    check_step(&k, c, distance);
    netcheck_ask(&k);
    return true;
}

/* ---- lists ---- */

/* What is played keeps its messages beside the row, for the table of times: they must outlive
 * the case's arena. */
static void keep_messages(struct netcheck_reader *r, struct netcheck_question *k)
{
    int n = k->q.nmessage;
    if (!k->row->played) return;
    k->row->src = TAKE(r->rows, n + 1, int);
    k->row->dst = TAKE(r->rows, n + 1, int);
    k->row->flits = TAKE(r->rows, n + 1, int);
    for (int m = 0; m < n; m++) {
        k->row->src[m] = k->q.src[m];
        k->row->dst[m] = k->q.dst[m];
        k->row->flits[m] = (int)(k->q.bytes[m] / NETCHECK_FLIT_BYTES);
    }
}

/* Whether all nodes exist, and whether the sum of all times stays far from the end of simulated
 * time (2^63 ps = 9.2e18 ps). The sum bounds every arrival, as if all messages waited for each
 * other; 16 cycles a flit are more than any route of these networks takes. */
static bool list_is_sound(struct netcheck_reader *r, const struct node *at,
                          const struct netcheck_question *k)
{
    const struct traffic *q = &k->q;
    double sum = 0;
    for (int m = 0; m < q->nmessage; m++) {
        int nnode = k->topology->nnode;
        if (q->src[m] >= nnode || q->dst[m] >= nnode)
            return err_set_at(
                r->e, ERR_DATA, r->path, at->line,
                "message %d goes from node %d to node %d; the network has nodes 0 to %d", m,
                q->src[m], q->dst[m], nnode - 1);
        sum += (double)q->time[m] + (q->delay ? (double)q->delay[m] : 0) +
               (double)q->bytes[m] / NETCHECK_FLIT_BYTES * NETCHECK_CYCLE_PS * 16;
    }
    return sum < 9e17 || err_set_at(r->e, ERR_DATA, r->path, at->line,
                                    "times, delays and lengths add up to %.3g cycles; expected "
                                    "less than 9e14",
                                    sum / NETCHECK_CYCLE_PS);
}

/* The list of n whole numbers `key` in 0 .. most into *x; all 0 where it is missing. Numbers in
 * JSON are real: whole ones are checked, not assumed. */
static bool column_read(struct netcheck_reader *r, const struct node *trace, const char *key, int n,
                        double most, double **x)
{
    const struct node *list = document_find(trace, key);
    *x = TAKE(r->arena, n + 1, double);
    if (!list) return true;
    if (!document_numbers(trace, key, r->path, *x, n, r->e)) return false;
    for (int m = 0; m < n; m++)
        if ((*x)[m] < 0 || (*x)[m] > most || (*x)[m] != floor((*x)[m]))
            return err_set_at(r->e, ERR_DATA, r->path, list->line,
                              "'%s' of message %d is %g; expected a whole number from 0 to %.10g",
                              key, m, (*x)[m], most);
    return true;
}

/* one dependency of message m */
static bool dependency_read(struct netcheck_reader *r, const struct node *x, int m, int n, int *to)
{
    if (x->kind == NODE_NUMBER && x->number >= 0 && x->number < n &&
        x->number == floor(x->number) && x->number != m) {
        *to = (int)x->number;
        return true;
    }
    return err_set_at(r->e, ERR_DATA, r->path, x->line,
                      "message %d depends on '%g'; expected another message from 0 to %d", m,
                      x->kind == NODE_NUMBER ? x->number : NAN, n - 1);
}

/* Dependencies as in compressed rows: those of message m are dep[dep_first[m] .. dep_first[m +
 * 1] - 1]. Two passes: count, then fill. */
static bool deps_read(struct netcheck_reader *r, const struct node *deps, struct traffic *q)
{
    /* Without the key all rows are empty. */
    int ndep = 0, m = 0;
    q->dep_first = TAKE(r->arena, q->nmessage + 1, int);
    if (!deps) return true;
    if (deps->kind != NODE_LIST || deps->count != q->nmessage)
        return err_set_at(r->e, ERR_DATA, r->path, deps->line,
                          "'deps' must have %d entries; it has %d", q->nmessage, deps->count);
    for (const struct node *d = deps->child; d; d = d->next) ndep += d->count;
    q->dep = TAKE(r->arena, ndep + 1, int);
    ndep = 0;
    for (const struct node *d = deps->child; d; d = d->next, m++) {
        if (d->kind != NODE_LIST)
            return err_set_at(r->e, ERR_DATA, r->path, d->line,
                              "'deps' of message %d must be a list", m);
        q->dep_first[m] = ndep;
        for (const struct node *x = d->child; x; x = x->next)
            if (!dependency_read(r, x, m, q->nmessage, &q->dep[ndep++])) return false;
    }
    q->dep_first[q->nmessage] = ndep;
    return true;
}

static struct traffic traffic_take(int n, struct arena *a)
{
    return (struct traffic){.nmessage = n,
                            .src = TAKE(a, n + 1, int),
                            .dst = TAKE(a, n + 1, int),
                            .bytes = TAKE(a, n + 1, int64_t),
                            .time = TAKE(a, n + 1, sim_ps),
                            .delay = TAKE(a, n + 1, sim_ps)};
}

/* A list as columns, one number per message and key. `src` is needed (trace_keys) and sets the
 * number of messages. */
static bool trace_read(struct netcheck_reader *r, const struct node *trace, struct traffic *q)
{
    static const char *const key[] = {"src", "dst", "flits", "time", "delay"};
    static const double most[] = {NETCHECK_MOST_NODES, NETCHECK_MOST_NODES, NETCHECK_MOST_FLITS,
                                  NETCHECK_MOST_CYCLES, NETCHECK_MOST_CYCLES};
    double *column[5];
    const struct node *src = document_find(trace, "src");
    int n = src->count;
    if (src->kind != NODE_LIST || n == 0)
        return err_set_at(r->e, ERR_DATA, r->path, src->line,
                          "'src' must be a list of at least one node");
    for (int i = 0; i < 5; i++)
        if (!column_read(r, trace, key[i], n, most[i], &column[i])) return false;
    *q = traffic_take(n, r->arena);
    for (int m = 0; m < n; m++) {
        q->src[m] = (int)column[0][m];
        q->dst[m] = (int)column[1][m];
        q->bytes[m] = (int64_t)column[2][m] * NETCHECK_FLIT_BYTES;
        q->time[m] = (sim_ps)column[3][m] * NETCHECK_CYCLE_PS;
        q->delay[m] = (sim_ps)column[4][m] * NETCHECK_CYCLE_PS;
        /* The lower bound of column_read is 0; of flits it is 1. */
        if (column[2][m] < 1)
            return err_set_at(r->e, ERR_DATA, r->path, trace->line,
                              "message %d has 0 flits; expected at least 1", m);
    }
    return deps_read(r, document_find(trace, "deps"), q);
}

/* One row of a list with dependencies. "S" is the size of a collective's message, "smax" the
 * largest one of a list with several sizes. */
bool netcheck_list_rows(struct netcheck_reader *r, const struct node *c, bool referred)
{
    struct netcheck_question k = netcheck_begin(r, c, NETCHECK_LIST);
    struct netcheck_setting s;
    const char *name;
    int size, distance;
    const struct node *trace = document_find(c, "trace");
    if (!netcheck_setting_read(r, c, &s) || !netcheck_word(r, c, "name", &name) ||
        !netcheck_integer(r, c, document_find(c, "S") ? "S" : "smax", 0, NETCHECK_MOST_FLITS, 0,
                          &size) ||
        !netcheck_integer(r, c, "distance", 0, NETCHECK_MOST_NODES, 0, &distance) ||
        !netcheck_keys_of_trace(r, trace, referred))
        return false;
    snprintf(k.row->name, sizeof k.row->name, "%.24s %.32s S=%d d=%d P=%d vc=%d B=%d", s.topology,
             name, size, distance, s.packet_flits, s.channels, s.buffer);
    k.row->played = !referred;
    if (!netcheck_wanted(r, &k)) return true;
    if (!netcheck_network(r, c, &s, &k)) return netcheck_told(r);
    if (!trace_read(r, trace, &k.q) || !list_is_sound(r, trace, &k)) return false;
    if (!netcheck_keys_complete(r, c, NETCHECK_LIST, referred) ||
        (referred && !arrivals_read(r, c, &k)))
        return false;
    check_list(&k, c);
    keep_messages(r, &k);
    netcheck_ask(&k);
    return true;
}

/* ---- by hand ---- */

/* The messages of a case by hand: each is an object, as a person writes them. */
static bool hand_messages(struct netcheck_reader *r, const struct node *list, bool referred,
                          struct traffic *q)
{
    int m = 0;
    *q = traffic_take(list->count, r->arena);
    if (list->count == 0)
        return err_set_at(r->e, ERR_DATA, r->path, list->line, "'messages' is empty");
    for (const struct node *x = list->child; x; x = x->next, m++) {
        int flits, t;
        if (!netcheck_keys_of_message(r, x, referred) ||
            !document_integer(x, "src", r->path, 0, NETCHECK_MOST_NODES, &q->src[m], r->e) ||
            !document_integer(x, "dst", r->path, 0, NETCHECK_MOST_NODES, &q->dst[m], r->e) ||
            !document_integer(x, "flits", r->path, 1, NETCHECK_MOST_FLITS, &flits, r->e) ||
            !netcheck_integer(r, x, "t", 0, NETCHECK_MOST_CYCLES, 0, &t))
            return false;
        q->bytes[m] = (int64_t)flits * NETCHECK_FLIT_BYTES;
        q->time[m] = (sim_ps)t * NETCHECK_CYCLE_PS;
    }
    return true;
}

/* What one variant of a hand case expects. */
struct variant {
    const char *kind; /* cut-through, wormhole, played */
    int buffer;
    const struct node *list; /* arrivals; NULL: a deadlock, or nothing when played */
};

/* One row: the same messages with one size of buffers. */
static bool hand_variant(struct netcheck_reader *r, const struct node *c, const struct variant *v)
{
    struct netcheck_question k = netcheck_begin(r, c, NETCHECK_HAND);
    struct netcheck_setting s;
    const char *name;
    const struct node *messages = document_find(c, "messages");
    if (!netcheck_setting_read(r, c, &s) || !netcheck_word(r, c, "name", &name) ||
        !netcheck_truth(r, c, "order_free", &k.any_order))
        return false;
    s.buffer = v->buffer;
    snprintf(k.row->name, sizeof k.row->name, "%.64s %s B=%d", *name ? name : s.topology, v->kind,
             v->buffer);
    /* Played cases compare with nothing; others without a list expect a deadlock. */
    k.row->played = strcmp(v->kind, "played") == 0;
    if (!netcheck_wanted(r, &k)) return true;
    if (!netcheck_network(r, c, &s, &k)) return netcheck_told(r);
    snprintf(k.row->group, sizeof k.row->group, "%s", v->kind);
    if (!hand_messages(r, messages, !k.row->played, &k.q) || !list_is_sound(r, messages, &k))
        return false;
    if (!netcheck_keys_complete(r, c, NETCHECK_HAND, !k.row->played)) return false;
    k.row->expect_deadlock = !v->list && !k.row->played;
    if (v->list) {
        double *x = TAKE(r->arena, k.q.nmessage + 1, double);
        if (!document_flat(v->list, v->kind, r->path, x, k.q.nmessage, r->e)) return false;
        /* The makespan of a list of arrivals is its largest. */
        for (int m = 0; m < k.q.nmessage; m++) k.row->low = k.row->high = fmax(k.row->high, x[m]);
        k.arrival = x;
        k.row->compared = true;
        netcheck_check_arrivals(&k, k.row->high);
    }
    keep_messages(r, &k);
    netcheck_ask(&k);
    return true;
}

/* The buffer size [flits] that a key of `booksim`, `expected_wormhole` or `agree` stands for. */
static bool buffer_of(struct netcheck_reader *r, const struct node *x, int *buffer)
{
    char *end;
    long b = strtol(x->key, &end, 10);
    *buffer = (int)b;
    return (end != x->key && !*end && b >= 1 && b <= 1 << 20) ||
           err_set_at(r->e, ERR_DATA, r->path, x->line,
                      "'%.64s' is not a buffer size; expected flits, 1 to %d",
                      x->key, 1 << 20);
}

/* `agree` says for which buffers the times by hand equal those of the reference: recomputed
 * here, as what a person wrote may be wrong. A contradiction is a flaw of `row`. */
static bool check_agreement(struct netcheck_reader *r, const struct node *c,
                            struct netcheck_row *row)
{
    const struct node *agree = document_find(c, "agree"), *booksim = document_find(c, "booksim");
    int n = document_find(c, "messages")->count;
    bool any_order;
    if (!netcheck_truth(r, c, "order_free", &any_order)) return false;
    if (agree && agree->kind != NODE_MAP)
        return err_set_at(r->e, ERR_DATA, r->path, agree->line,
                          "'agree' must hold true or false by buffer");
    for (const struct node *x = agree ? agree->child : NULL; x; x = x->next) {
        const struct node *hand = document_find(document_find(c, "expected_wormhole"), x->key);
        const struct node *reference = document_find(booksim, x->key);
        double *p = TAKE(r->arena, n + 1, double), *q = TAKE(r->arena, n + 1, double);
        bool said;
        /* Without a derivation for wormhole routers the times for cut-through are meant. */
        if (!hand || hand->count == 0) hand = document_find(c, "expected_vct");
        if (!netcheck_truth(r, agree, x->key, &said)) return false;
        if (!hand || !reference || hand->count != n || reference->count != n) continue;
        if (!document_flat(hand, "expected", r->path, p, n, r->e) ||
            !document_flat(reference, x->key, r->path, q, n, r->e))
            return false;
        /* Equal as sets where the order is free. */
        if (any_order) qsort(p, (size_t)n, sizeof *p, by_number);
        if (any_order) qsort(q, (size_t)n, sizeof *q, by_number);
        if (said != (memcmp(p, q, (size_t)n * sizeof *p) == 0) && !row->flaw[0])
            snprintf(row->flaw, sizeof row->flaw,
                     "agree.%.16s is %s; the times by hand and the reference's say otherwise",
                     x->key, said ? "true" : "false");
    }
    return true;
}

/* The reference's answer for each buffer size; where a time was derived by hand for wormhole
 * routers, that one, since it is the better founded. */
static bool wormhole_variants(struct netcheck_reader *r, const struct node *c,
                              const struct node *booksim)
{
    const struct node *wormhole = document_find(c, "expected_wormhole");
    for (const struct node *b = booksim->child; b; b = b->next) {
        const struct node *by_hand = document_find(wormhole, b->key),
                          *list = by_hand && by_hand->count ? by_hand : b;
        struct variant v = {"wormhole", 0, list};
        if (!buffer_of(r, b, &v.buffer)) return false;
        if (list->kind != NODE_LIST || list->count == 0)
            return err_set_at(r->e, ERR_DATA, r->path, b->line,
                              "'%.64s' must be a list of arrivals", b->key);
        if (!hand_variant(r, c, &v)) return false;
    }
    return true;
}

/* A case by hand becomes several rows: cut-through with buffers that hold any packet, and one
 * per buffer size of the reference. `expected: deadlock` and a case without answers make one
 * row. */
bool netcheck_hand_rows(struct netcheck_reader *r, const struct node *c, bool referred)
{
    const struct node *cut_through = document_find(c, "expected_vct"),
                      *booksim = document_find(c, "booksim");
    int first = r->n->nrow, buffer;
    const char *expected;
    if (!netcheck_integer(r, c, "buf_flits_per_vc", 1, 1 << 20, referred ? 5 : 16, &buffer) ||
        !netcheck_word(r, c, "expected", &expected))
        return false;
    if (!referred) return hand_variant(r, c, &(struct variant){"played", buffer, NULL});
    bool stuck = strncmp(expected, "deadlock", 8) == 0;
    if (*expected && !stuck)
        return err_set_at(r->e, ERR_DATA, r->path, document_find(c, "expected")->line,
                          "'expected' is '%.64s'; expected a text that begins with deadlock",
                          expected);
    if (stuck) return hand_variant(r, c, &(struct variant){"wormhole", buffer, NULL});
    if (!cut_through) return document_need(c, "expected_vct", r->path, r->e) != NULL;
    /* 64 flits: more than the messages of any case by hand have. */
    if (!hand_variant(r, c, &(struct variant){"cut-through", 64, cut_through})) return false;
    if (!booksim) return document_need(c, "booksim", r->path, r->e) != NULL;
    if (booksim->kind != NODE_MAP)
        return err_set_at(r->e, ERR_DATA, r->path, booksim->line,
                          "'booksim' must hold lists of arrivals by buffer");
    return wormhole_variants(r, c, booksim) &&
           (first == r->n->nrow || check_agreement(r, c, &r->n->row[first]));
}
