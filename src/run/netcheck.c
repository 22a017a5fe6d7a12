/* netcheck.c - reads reference cases, builds each one's network and messages, and asks every level. */
#include "run/netcheck.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "base/text.h"
#include "io/document.h"
#include "machine/topology.h"
#include "run/netcheck_case.h"

enum { MAX_NODES = 1 << 22, MAX_FLITS = 1 << 20, MAX_BUFFERS = 8, LOAD_SEED = 1 };

/* A row being answered. */
struct question {
    struct netcheck *n;
    struct netcheck_row *row;
    struct machine_spec machine;
    struct traffic q;
    const double *arrival; /* (q.nmessage) reference [cycles], NULL: none */
    bool any_order;        /* arrivals agree as sets */
    bool latency;          /* the answer is the mean latency of messages from `warm` on, not the makespan */
    sim_ps warm;
    struct arena *arena;
};

struct reader {
    struct netcheck *n;
    const char *path, *filter;
    struct arena *rows;  /* keeps the rows */
    struct arena *arena; /* scratch, released after each case */
    struct err *e;
    int capacity;
};

/* ---- asking ---- */

static int by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static double *cycles_of(const sim_ps *ps, int n, struct arena *a)
{
    double *x = TAKE(a, n + 1, double);
    for (int i = 0; i < n; i++) x[i] = (double)ps[i] / NETCHECK_CYCLE_PS;
    return x;
}

static void compare_messages(const struct question *k, const sim_ps *arrival, struct netcheck_answer *answer)
{
    int n = k->q.nmessage;
    double *found = cycles_of(arrival, n, k->arena), *reference = TAKE(k->arena, n + 1, double), sum = 0;
    memcpy(reference, k->arrival, (size_t)n * sizeof *reference);
    if (k->any_order) {
        qsort(found, (size_t)n, sizeof *found, by_value);
        qsort(reference, (size_t)n, sizeof *reference, by_value);
    }
    for (int i = 0; i < n; i++) {
        answer->differing += fabs(found[i] - reference[i]) > 1e-3;
        sum += fabs(found[i] - reference[i]) / fmax(reference[i], 1);
    }
    answer->message_error = n > 0 ? sum / n : 0;
}

static double mean_latency(const struct question *k, const sim_ps *arrival)
{
    double sum = 0;
    int64_t n = 0;
    for (int i = 0; i < k->q.nmessage; i++) {
        if (k->q.time[i] < k->warm) continue;
        sum += (double)(arrival[i] - k->q.time[i]) / NETCHECK_CYCLE_PS;
        n++;
    }
    return n > 0 ? sum / (double)n : 0;
}

static void judge(const struct question *k, const struct traffic_result *r, struct netcheck_answer *answer)
{
    const struct netcheck_row *row = k->row;
    answer->ran = true;
    answer->events = r->events;
    answer->deadlock = r->deadlock;
    if (r->deadlock || row->expect_deadlock) {
        answer->found = r->deadlock ? NAN : (double)r->makespan / NETCHECK_CYCLE_PS;
        answer->error = r->deadlock == row->expect_deadlock ? 0 : 1;
        text_copy(answer->why, sizeof answer->why, r->text);
        return;
    }
    answer->found = k->latency ? mean_latency(k, r->arrival) : (double)r->makespan / NETCHECK_CYCLE_PS;
    double nearest = fmin(fmax(answer->found, row->low), row->high);
    answer->error = nearest > 0 ? (answer->found - nearest) / nearest : 0;
    if (row->compared) compare_messages(k, r->arrival, answer);
}

/* Cut-through is for packets that fit the buffers. Without packet_bytes our levels cut a longer message into pieces of
 * a buffer's size, which the reference's routers do not do: no comparison. */
static bool fits_buffers(const struct question *k, enum network_level level, struct netcheck_answer *answer)
{
    const struct network_spec *w = &k->machine.network;
    if ((level != LEVEL_PACKET && level != LEVEL_AUTO) || w->packet_bytes > 0) return true;
    int64_t longest = 0;
    for (int m = 0; m < k->q.nmessage; m++)
        if (k->q.bytes[m] > longest) longest = k->q.bytes[m];
    if (longest <= w->buffer_flits * w->flit_bytes) return true;
    snprintf(answer->why, sizeof answer->why, "packets of %lld flits do not fit buffers of %d",
             (long long)(longest / w->flit_bytes), w->buffer_flits);
    return false;
}

static void ask_level(struct question *k, const struct topology *t, enum network_level level)
{
    struct netcheck_answer *answer = &k->row->answer[level];
    if (!fits_buffers(k, level, answer)) return;
    struct err e;
    struct arena_mark mark = arena_mark(k->arena);
    struct traffic_result r = {.arrival = TAKE(k->arena, k->q.nmessage + 1, sim_ps)};
    err_clear(&e);
    k->machine.network.level = level;
    if (traffic_run(&k->q, &k->machine, t, k->arena, false, &r, &e)) judge(k, &r, answer);
    else text_copy(answer->why, sizeof answer->why, e.text);
    arena_release(k->arena, mark);
}

/* no level can answer the row, for the same reason */
static void unanswered(struct question *k, const char *why)
{
    for (int l = 0; l < NETCHECK_LEVELS; l++) text_copy(k->row->answer[l].why, sizeof k->row->answer[l].why, why);
}

static void ask(struct question *k)
{
    struct err e;
    err_clear(&e);
    const struct topology *t = topology_create(&k->machine.topology, k->arena, &e);
    k->row->nmessage = k->q.nmessage;
    for (int l = 0; l < NETCHECK_LEVELS; l++) {
        if (!k->n->level[l]) continue;
        if (t) ask_level(k, t, (enum network_level)l);
        else text_copy(k->row->answer[l].why, sizeof k->row->answer[l].why, e.text);
    }
}

/* ---- reading ---- */

static int number_or(const struct node *map, const char *key, int otherwise)
{
    const struct node *x = document_find(map, key);
    return x && x->kind == NODE_NUMBER && fabs(x->number) < 1e9 ? (int)x->number : otherwise;
}

/* the list of numbers `key` (lists of exactly n) */
static double *numbers(const struct reader *r, const struct node *map, const char *key, int n)
{
    double *x = TAKE(r->arena, n + 1, double);
    return document_numbers(map, key, r->path, x, n, r->e) ? x : NULL;
}

static struct netcheck_row *row_add(struct reader *r)
{
    struct netcheck *n = r->n;
    if (n->nrow == r->capacity) {
        int capacity = 2 * r->capacity + 64;
        struct netcheck_row *row = TAKE(r->rows, capacity, struct netcheck_row);
        if (n->nrow > 0) memcpy(row, n->row, (size_t)n->nrow * sizeof *row);
        n->row = row;
        r->capacity = capacity;
    }
    struct netcheck_row *row = &n->row[n->nrow++];
    *row = (struct netcheck_row){.counted = true};
    return row;
}

/* the network of a case with `buffer` flits; false when its topology is not one of ours: the row then says so */
static bool network_read(const struct node *c, int buffer, struct question *k)
{
    struct err e;
    struct topology_spec s;
    int vcs = number_or(c, "vcs", 1);
    const char *topology = document_text(c, "topology");
    err_clear(&e);
    snprintf(k->row->group, sizeof k->row->group, "%.*s vc=%d B=%d", (int)strcspn(topology, "0123456789_"), topology,
             vcs, buffer);
    if (!netcheck_topology(topology, number_or(c, "tie", 0), &s, &e)) {
        unanswered(k, e.text);
        return false;
    }
    int head = strcmp(document_text(c, "pipeline"), "P5") == 0 ? 5 : 3;
    k->machine = netcheck_machine(&s, vcs, buffer, number_or(c, "max_packet_flits", 0), head);
    return true;
}

static struct question question_begin(struct reader *r)
{
    return (struct question){.n = r->n, .row = row_add(r), .arena = r->arena};
}

static bool wanted(const struct reader *r, struct question *k)
{
    if (!r->filter || strstr(k->row->name, r->filter)) return true;
    r->n->nrow--;
    return false;
}

static int nodes_of(const struct node *c, const struct question *k, struct arena *a)
{
    struct err e;
    err_clear(&e);
    const struct topology *t = topology_create(&k->machine.topology, a, &e);
    return number_or(c, "nodes", t ? t->nnode : 0);
}

static bool ask_step(struct reader *r, const struct node *c)
{
    struct question k = question_begin(r);
    int distance, flits, buffer = number_or(c, "buf_flits_per_vc", 16);
    const char *pattern = document_text(c, "pattern");
    double makespan;
    if (!document_integer(c, "distance", r->path, 0, MAX_NODES, &distance, r->e) ||
        !document_integer(c, "flits", r->path, 1, MAX_FLITS, &flits, r->e))
        return false;
    snprintf(k.row->name, sizeof k.row->name, "%s %s(%d) S=%d vc=%d B=%d tie=%d", document_text(c, "topology"), pattern,
             distance, flits, number_or(c, "vcs", 1), buffer, number_or(c, "tie", 0));
    if (!wanted(r, &k) || !network_read(c, buffer, &k)) return true;
    if (!netcheck_step(pattern, distance, nodes_of(c, &k, r->arena), flits, r->arena, &k.q, r->e)) return false;
    const struct node *band = document_find(c, "makespan_by_variant");
    if (band) {
        k.row->low = INFINITY;
        for (const struct node *x = band->child; x; x = x->next) {
            k.row->low = fmin(k.row->low, 0.85 * x->number);
            k.row->high = fmax(k.row->high, 1.15 * x->number);
        }
    } else {
        if (!document_number(c, "makespan", r->path, &makespan, r->e)) return false;
        k.row->low = k.row->high = makespan;
        k.arrival = numbers(r, c, "completion", k.q.nmessage);
        if (!k.arrival) return false;
        k.row->compared = true;
    }
    ask(&k);
    return true;
}

/* lists of one number per message */
static bool trace_read(struct reader *r, const struct node *trace, struct traffic *q)
{
    const struct node *flits = document_need(trace, "flits", r->path, r->e);
    const struct node *deps = document_need(trace, "deps", r->path, r->e);
    if (!flits || !deps) return false;
    int n = flits->count;
    double *column[5];
    static const char *const key[] = {"src", "dst", "flits", "time", "delay"};
    for (int i = 0; i < 5; i++)
        if (!(column[i] = numbers(r, trace, key[i], n))) return false;
    if (deps->count != n)
        return err_set_at(r->e, ERR_DATA, r->path, deps->line, "deps has %d entries, not %d", deps->count, n);
    *q = (struct traffic){n,
                          TAKE(r->arena, n + 1, int),
                          TAKE(r->arena, n + 1, int),
                          TAKE(r->arena, n + 1, int64_t),
                          TAKE(r->arena, n + 1, sim_ps),
                          TAKE(r->arena, n + 1, sim_ps),
                          TAKE(r->arena, n + 1, int),
                          NULL};
    int ndep = 0, m = 0;
    for (const struct node *d = deps->child; d; d = d->next) ndep += d->count;
    q->dep = TAKE(r->arena, ndep + 1, int);
    ndep = 0;
    for (const struct node *d = deps->child; d; d = d->next, m++) {
        q->dep_first[m] = ndep;
        for (const struct node *x = d->child; x; x = x->next) q->dep[ndep++] = (int)x->number;
        q->src[m] = (int)column[0][m];
        q->dst[m] = (int)column[1][m];
        q->bytes[m] = (int64_t)column[2][m] * NETCHECK_FLIT_BYTES;
        q->time[m] = (sim_ps)column[3][m] * NETCHECK_CYCLE_PS;
        q->delay[m] = (sim_ps)column[4][m] * NETCHECK_CYCLE_PS;
    }
    q->dep_first[n] = ndep;
    return true;
}

static bool ask_collective(struct reader *r, const struct node *c)
{
    struct question k = question_begin(r);
    int buffer = number_or(c, "buf_flits_per_vc", 16);
    double makespan;
    snprintf(k.row->name, sizeof k.row->name, "%s %s S=%d d=%d P=%d vc=%d B=%d", document_text(c, "topology"),
             document_text(c, "name"), number_or(c, "S", number_or(c, "smax", 0)), number_or(c, "distance", 0),
             number_or(c, "max_packet_flits", 0), number_or(c, "vcs", 1), buffer);
    if (!wanted(r, &k) || !network_read(c, buffer, &k)) return true;
    if (!trace_read(r, document_find(c, "trace"), &k.q)) return false;
    if (!document_number(c, "makespan", r->path, &makespan, r->e)) return false;
    k.row->low = k.row->high = makespan;
    k.arrival = numbers(r, c, "completion", k.q.nmessage);
    k.row->compared = true;
    if (k.arrival) ask(&k);
    return k.arrival != NULL;
}

static bool ask_point(struct reader *r, const struct node *c, const struct node *point)
{
    struct question k = question_begin(r);
    struct err e;
    const struct topology *t;
    double offered, latency = 0;
    int flits = number_or(c, "packet_flits", 1), cycles = number_or(point, "cycles", 8000);
    int buffer = number_or(c, "buf_flits_per_vc", 16);
    const struct node *unstable = document_find(point, "unstable"), *plat = document_find(point, "plat");
    if (!document_number(point, "offered", r->path, &offered, r->e)) return false;
    snprintf(k.row->name, sizeof k.row->name, "%s %s S=%d vc=%d B=%d load %.4f", document_text(c, "topology"),
             document_text(c, "pattern"), flits, number_or(c, "vcs", 1), buffer, offered);
    if (!wanted(r, &k) || !network_read(c, buffer, &k)) return true;
    err_clear(&e);
    t = topology_create(&k.machine.topology, r->arena, &e);
    if (!t || !netcheck_load(document_text(c, "pattern"), t, flits, offered, cycles, LOAD_SEED, r->arena, &k.q, &e)) {
        unanswered(&k, e.text);
        return true;
    }
    if (plat && plat->kind == NODE_NUMBER) latency = plat->number;
    k.row->low = k.row->high = latency;
    k.row->counted = latency > 0 && !(unstable && unstable->text && strcmp(unstable->text, "true") == 0);
    k.latency = true;
    if (k.machine.topology.family == TOPOLOGY_DRAGONFLY) {
        k.row->counted = false;
        unanswered(&k, "the reference's channels take 10 and 100 cycles inside and between groups");
        return true;
    }
    if (!k.row->counted) { /* it would measure how long it was run */
        unanswered(&k, "the reference was not stable at this load");
        return true;
    }
    k.warm = (sim_ps)(cycles / 4) * NETCHECK_CYCLE_PS;
    ask(&k);
    return true;
}

static bool hand_messages(struct reader *r, const struct node *list, struct traffic *q)
{
    int n = list->count, m = 0;
    *q = (struct traffic){.nmessage = n,
                          .src = TAKE(r->arena, n + 1, int),
                          .dst = TAKE(r->arena, n + 1, int),
                          .bytes = TAKE(r->arena, n + 1, int64_t),
                          .time = TAKE(r->arena, n + 1, sim_ps)};
    for (const struct node *x = list->child; x; x = x->next, m++) {
        int flits, t;
        if (!document_integer(x, "src", r->path, 0, MAX_NODES, &q->src[m], r->e) ||
            !document_integer(x, "dst", r->path, 0, MAX_NODES, &q->dst[m], r->e) ||
            !document_integer(x, "flits", r->path, 1, MAX_FLITS, &flits, r->e) ||
            !document_integer(x, "t", r->path, 0, INT32_MAX, &t, r->e))
            return false;
        q->bytes[m] = (int64_t)flits * NETCHECK_FLIT_BYTES;
        q->time[m] = (sim_ps)t * NETCHECK_CYCLE_PS;
    }
    return true;
}

/* one variant of a hand case: the arrivals in `list` (NULL: a deadlock is expected) with `buffer` flits */
static bool ask_hand_variant(struct reader *r, const struct node *c, const char *kind, int buffer,
                             const struct node *list)
{
    struct question k = question_begin(r);
    const struct node *free_order = document_find(c, "order_free");
    snprintf(k.row->name, sizeof k.row->name, "%s %s B=%d", document_text(c, "name"), kind, buffer);
    if (!wanted(r, &k) || !network_read(c, buffer, &k)) return true;
    snprintf(k.row->group, sizeof k.row->group, "%s", kind);
    if (!hand_messages(r, document_find(c, "messages"), &k.q)) return false;
    k.row->expect_deadlock = list == NULL;
    if (list) {
        double *x = TAKE(r->arena, k.q.nmessage + 1, double);
        if (!document_flat(list, kind, r->path, x, k.q.nmessage, r->e)) return false;
        for (int m = 0; m < k.q.nmessage; m++) k.row->low = k.row->high = fmax(k.row->high, x[m]);
        k.arrival = x;
        k.row->compared = true;
    }
    k.any_order = free_order && free_order->text && strcmp(free_order->text, "true") == 0;
    ask(&k);
    return true;
}

static bool ask_hand(struct reader *r, const struct node *c)
{
    const struct node *cut_through = document_find(c, "expected_vct");
    const struct node *wormhole = document_find(c, "expected_wormhole"), *booksim = document_find(c, "booksim");
    const struct node *expected = document_find(c, "expected");
    if (cut_through && !ask_hand_variant(r, c, "cut-through", 64, cut_through)) return false;
    if (expected && expected->text && strstr(expected->text, "deadlock"))
        return ask_hand_variant(r, c, "wormhole", number_or(c, "buf_flits_per_vc", 5), NULL);
    if (!booksim || booksim->kind != NODE_MAP) return true;
    for (const struct node *b = booksim->child; b; b = b->next) {
        const struct node *by_hand = document_find(wormhole, b->key), *list = by_hand && by_hand->count ? by_hand : b;
        if (list->count > 0 && !ask_hand_variant(r, c, "wormhole", atoi(b->key), list)) return false;
    }
    return true;
}

static bool ask_case(struct reader *r, const struct node *c)
{
    if (document_find(c, "trace")) return ask_collective(r, c);
    if (document_find(c, "messages")) return ask_hand(r, c);
    if (document_find(c, "completion") || document_find(c, "makespan_by_variant")) return ask_step(r, c);
    const struct node *points = document_find(c, "points");
    if (!points) return err_set_at(r->e, ERR_DATA, r->path, c->line, "a case of no known form");
    for (const struct node *p = points->child; p; p = p->next) {
        struct arena_mark mark = arena_mark(r->arena);
        if (!ask_point(r, c, p)) return false;
        arena_release(r->arena, mark);
    }
    return true;
}

bool netcheck_run(struct netcheck *n, const char *path, const bool *level, const char *filter, bool quiet,
                  struct arena *a, struct err *e)
{
    const struct node *root = document_read(path, a, e);
    if (!root) return false;
    if (root->kind != NODE_LIST || root->count == 0)
        return err_set_at(e, ERR_DATA, path, root->line, "expected a list of reference cases");
    *n = (struct netcheck){.path = path};
    for (int l = 0; l < NETCHECK_LEVELS; l++) n->level[l] = !level || level[l];
    struct reader r = {.n = n, .path = path, .filter = filter, .rows = a, .arena = arena_create(), .e = e};
    struct progress p = progress_make("reference cases", root->count, quiet);
    bool ok = true;
    int done = 0;
    for (const struct node *c = root->child; ok && c; c = c->next) {
        struct arena_mark mark = arena_mark(r.arena);
        ok = ask_case(&r, c);
        arena_release(r.arena, mark);
        progress_show(&p, ++done);
    }
    progress_end(&p);
    arena_destroy(r.arena);
    return ok;
}
