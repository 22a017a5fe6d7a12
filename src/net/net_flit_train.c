/* net_flit_train.c - wormhole switching with one virtual channel per link, by trains of flits.
 *
 * Once a packet owns a resource, the times of its flits there follow from those at the resource
 * before and from the credits of the FIFO behind. These are piecewise linear: runs of flits at
 * equal distances. So a whole run is worked out at once, far into the future, and exactly, since it
 * depends on grants already made. Whenever a packet's flits are known further at one resource,
 * those at its next resource, and those of the owner of the one before (credits), may be worked out
 * further. Events are only needed to allocate a resource: one per packet and resource. */
#include "net/net_account.h"
#include "net/net_flit.h"

/* `count` flits, the first at `at`, the others `step` apart. */
struct run {
    struct run *next;
    sim_ps at, step;
    int64_t count;
};

/* Runs in the order of flits; read, and forgotten, from the front. */
struct runs {
    struct run *first, *last;
};

struct worm;

/* A worm at one resource of its way. */
struct stage {
    struct worm *worm;
    struct stage *behind; /* the next in the FIFO behind the resource */
    struct stage *rival;  /* the next among the requests for the resource */
    struct runs crossed;  /* flits that crossed, not yet worked out at the next resource */
    sim_ps flit;          /* time of a flit */
    sim_ps ask;           /* from when it could have had the resource */
    sim_ps grant;         /* when it got it, -1: not yet */
    sim_ps head, last;    /* when its first and its last known flit cross */
    int64_t base; /* place of its first flit in the sequence of all flits over the resource */
    int32_t known;        /* flits whose times are known */
    int32_t hop, resource, input; /* input: the port through which it asks for the resource */
};

/* A packet. */
struct worm {
    struct worm *next;    /* in the pool, among the ended */
    struct flight *flight;
    int32_t flits, index;
    int nhop;
    struct stage stage[]; /* (nhop + 1) */
};

/* A resource and the FIFO behind it. */
struct line {
    struct stage *owner;        /* to whom it is allocated until its tail's time is known */
    struct stage *request;      /* FIFO fronts that want it */
    struct stage *front, *back; /* worms in the FIFO behind */
    sim_ps left; /* when the tail of the one that left last has left the FIFO behind */
    int64_t position;           /* flits that were ever sent over it */
    sim_ps debt;                /* time for others' traffic after the owner */
    struct runs
        credit; /* departures from the FIFO behind, not yet used by flits a buffer's size later */
};

struct train {
    struct fabric fabric;       /* first */
    struct line *line;          /* (nresource) */
    struct run *free_run;
    struct worm **free_worm;    /* by nhop / WORM_STEP */
    struct worm *ended;         /* to be given back when nothing can name them any more */
    struct stage **task;        /* stack of stages that may be worked out further */
    int ntask, task_room;
};

enum { WORM_STEP = 4 };

static inline sim_ps later(sim_ps a, sim_ps b) { return a > b ? a : b; }

/* ---- runs ---- */

/* Append `count` flits; they join the last run where they continue its line. A run of one flit has
 * no distance yet and takes whatever comes next. */
static void run_push(struct train *g, struct runs *q, sim_ps at, sim_ps step, int64_t count)
{
    enum { CHUNK = 256 };
    struct run *r = q->last;
    if (r && r->count == 1 && (count == 1 || at - r->at == step)) r->step = at - r->at;
    if (r && r->at + r->count * r->step == at && (count == 1 || step == r->step)) {
        r->count += count;
        return;
    }
    if (!g->free_run) {
        struct run *chunk = TAKE(g->fabric.net->arena, CHUNK, struct run);
        for (int i = 0; i < CHUNK - 1; i++) chunk[i].next = &chunk[i + 1];
        g->free_run = chunk;
    }
    r = g->free_run;
    g->free_run = r->next;
    *r = (struct run){NULL, at, step, count};
    *(q->last ? &q->last->next : &q->first) = r;
    q->last = r;
}

/* Forget the first `count` flits, at most those of the first run. */
static void run_read(struct train *g, struct runs *q, int64_t count)
{
    struct run *r = q->first;
    r->at += count * r->step;
    r->count -= count;
    if (r->count > 0) return;
    q->first = r->next;
    if (!q->first) q->last = NULL;
    r->next = g->free_run;
    g->free_run = r;
}

/* A lower bound for the times of the next flits: at + j step for the j-th of `count`. */
struct bound {
    sim_ps at, step;
    int64_t count;
};

/* The latest of n bounds as one run, as long as it is straight: until a bound that starts earlier
 * but rises faster overtakes. The rest is worked out in the next round. */
static struct bound bound_latest(const struct bound *b, int n)
{
    struct bound m = b[0];
    for (int i = 1; i < n; i++) {
        if (b[i].at > m.at || (b[i].at == m.at && b[i].step > m.step)) {
            m.at = b[i].at;
            m.step = later(b[i].step, b[0].step);
        }
        if (b[i].count < m.count) m.count = b[i].count;
    }
    for (int i = 0; i < n; i++) {
        if (b[i].step <= m.step) continue;
        int64_t straight = (m.at - b[i].at) / (b[i].step - m.step) + 1;
        if (straight < m.count) m.count = straight;
    }
    return m;
}

/* ---- working out the times of flits ---- */

/* A stage not granted or fully known has nothing to gain. Stages may stand on the stack twice; the
 * second look finds nothing new. */
static void task_push(struct train *g, struct stage *s)
{
    if (s->grant < 0 || s->known == s->worm->flits) return;
    if (g->ntask == g->task_room) {
        int room = g->task_room ? 2 * g->task_room : 256;
        struct stage **more = TAKE(g->fabric.net->arena, room, struct stage *);
        for (int i = 0; i < g->ntask; i++) more[i] = g->task[i];
        g->task = more;
        g->task_room = room;
    }
    g->task[g->ntask++] = s;
}

static inline bool is_last(const struct stage *s) { return s->hop == s->worm->nhop; }

/* The bounds for the next flits of s; returns how many bounds, 0: one of them is not known yet. The
 * three rules of net_flit.h: one flit time after the flit before, tau after the resource before, a
 * credit latency after the flit a buffer's size earlier has left. */
static int bounds_of(struct train *g, const struct stage *s, struct bound b[3])
{
    const struct fabric *f = &g->fabric;
    int n = 0;
    b[n++] =
        (struct bound){s->known ? s->last + s->flit : s->grant, s->flit, s->worm->flits - s->known};
    if (s->hop > 0) {
        const struct run *r = s[-1].crossed.first;
        if (!r) return 0;
        /* The head pays the router's setup, the flits behind it do not. */
        bool head = s->known == 0 && f->net->setup > 0;
        sim_ps pass = f->net->tau - (head ? 0 : f->net->setup);
        b[n++] = (struct bound){r->at + pass, r->step, head ? 1 : r->count};
    }
    if (is_last(s)) return n;
    /* Flits that need no credit yet: the first ones over a resource that was never full. */
    int64_t spare = f->buffer - s->base - s->known; /* flits that need no credit */
    if (spare > 0) {
        if (spare < b[0].count) b[0].count = spare;
        return n;
    }
    const struct run *c = g->line[s->resource].credit.first;
    if (!c) return 0;
    b[n++] = (struct bound){c->at + f->net->credit, c->step, c->count};
    return n;
}

/* Work out the times of flits at s as far as they are determined; true when there were any new
 * ones. O(runs), not O(flits): a worm that nobody disturbs is one run. */
static bool stage_advance(struct train *g, struct stage *s)
{
    struct bound b[3];
    int32_t before = s->known;
    int n;
    while (s->known < s->worm->flits && (n = bounds_of(g, s, b)) > 0) {
        struct bound m = bound_latest(b, n);
        if (s->known == 0) s->head = m.at;
        /* Flits that cross here feed the next resource and use up the credits of this FIFO. */
        if (!is_last(s)) {
            if (s->base + s->known >= g->fabric.buffer)
                run_read(g, &g->line[s->resource].credit, m.count);
            run_push(g, &s->crossed, m.at, m.step, m.count);
        }
        /* What has left the FIFO before is credit for the owner of the resource before. */
        if (s->hop > 0) {
            run_read(g, &s[-1].crossed, m.count);
            run_push(g, &g->line[s[-1].resource].credit, m.at, m.step, m.count);
        }
        s->known += (int32_t)m.count;
        s->last = m.at + (m.count - 1) * m.step;
    }
    return s->known > before;
}

/* ---- FIFOs, requests, ends ---- */

/* s, whose head's time is known, asks for the next resource if it is the first in the FIFO behind
 * its own. */
static void stage_ask(struct train *g, struct stage *s)
{
    const struct line *l = &g->line[s->resource];
    if (l->front != s || s->known == 0) return;
    struct stage *to = s + 1;
    struct line *next = &g->line[to->resource];
    to->ask = later(s->head + g->fabric.net->tau, l->left + g->fabric.net->setup);
    to->rival = next->request;
    next->request = to;
    if (!next->owner)
        packet_wake(&g->fabric, to->resource,
                    later(to->ask, g->fabric.resource[to->resource].free));
}

/* Not given back at once: a task on the stack may still name its stages. */
static void worm_end(struct train *g, struct worm *w)
{
    struct flight *v = w->flight;
    if (++v->ejected == v->npacket)
        packet_deliver_at(&g->fabric, v, flit_arrival(&g->fabric, v, w->stage[w->nhop].last));
    w->next = g->ended;
    g->ended = w;
}

/* The time of the tail at s is known, so the resource may have its next owner and the FIFO before
 * it its next front. The tail may lie in the future: the wake-up is posted for then. */
static void tail_known(struct train *g, struct stage *s)
{
    struct fabric *f = &g->fabric;
    const struct worm *w = s->worm;
    struct resource *o = &f->resource[s->resource];
    struct line *l = &g->line[s->resource];
    sim_ps free = s->last + s->flit;
    /* The gap g follows the last packet of a message; others' traffic follows the tail. */
    bool ends_message = w->index == w->flight->npacket - 1;
    o->free = s->hop == 0 && ends_message
                  ? later(free, s->last + net_port(f->net, w->flight->m->bytes)->gap)
                  : free;
    if (s->hop > 0) o->free += f->net->allocation;
    o->free += l->debt;
    l->debt = 0;
    l->owner = NULL;
    net_account_packet(f->net, s->resource, w->flight->m, w->index, free - s->grant,
                       s->grant - s->ask);
    /* Somebody waits for the resource, or the node has more to send. */
    if (l->request || (s->hop == 0 && f->source[s->resource].front))
        packet_wake(f, s->resource, o->free);
    if (s->hop > 0) {
        struct line *before = &g->line[s[-1].resource];
        before->left = free;
        before->front = before->front->behind;
        if (before->front) stage_ask(g, before->front);
    }
    if (is_last(s)) worm_end(g, s->worm);
}

static void worms_return(struct train *g)
{
    while (g->ended) {
        struct worm *w = g->ended, **pool = &g->free_worm[w->nhop / WORM_STEP];
        g->ended = w->next;
        w->next = *pool;
        *pool = w;
    }
}

/* New times at one stage may determine those of the next resource and, by credits, of the owner of
 * the one before. A depth-first walk to the end; the order does not matter, since times are bounds
 * that only depend on grants. */
static void tasks_do(struct train *g)
{
    while (g->ntask > 0) {
        struct stage *s = g->task[--g->ntask];
        bool first = s->known == 0;
        if (s->known == s->worm->flits || !stage_advance(g, s)) continue;
        if (first && s->hop == 0 && s->worm->index == 0) s->worm->flight->m->injected = s->head;
        if (first && !is_last(s)) stage_ask(g, s);
        if (!is_last(s)) task_push(g, s + 1);
        struct stage *before = s->hop > 0 ? g->line[s[-1].resource].owner : NULL;
        if (before) task_push(g, before);
        if (s->known == s->worm->flits) tail_known(g, s);
    }
    worms_return(g);
}

/* ---- allocation ---- */

/* The grant: the place in the sequence of flits is fixed, and everything that it determines is
 * worked out now. */
static void allocate(struct train *g, struct stage *s, sim_ps now)
{
    struct line *l = &g->line[s->resource];
    s->grant = now;
    l->owner = s;
    if (!is_last(s)) {
        s->base = l->position;
        l->position += s->worm->flits;
        *(l->front ? &l->back->behind : &l->front) = s;
        l->back = s;
    }
    task_push(g, s);
    tasks_do(g);
}

static bool better(const struct fabric *f, const struct resource *o, const struct stage *s,
                   const struct stage *t)
{
    if (f->first_come && s->ask != t->ask) return s->ask < t->ask;
    uint32_t turn = f->first_come ? 0 : o->turn;
    return (uint32_t)s->input - turn < (uint32_t)t->input - turn;
}

/* One grant an event; the tail of the owner will bring the next. */
static void line_serve(struct train *g, int r, sim_ps now)
{
    struct fabric *f = &g->fabric;
    struct resource *o = &f->resource[r];
    struct stage **best = NULL;
    sim_ps again = SIM_NEVER;
    for (struct stage **s = &g->line[r].request; *s; s = &(*s)->rival) {
        if ((*s)->ask > now) {
            if ((*s)->ask < again) again = (*s)->ask;
        } else if (!best || better(f, o, *s, *best)) {
            best = s;
        }
    }
    if (best) {
        struct stage *s = *best;
        *best = s->rival;
        o->turn = (uint32_t)s->input + 1;
        allocate(g, s, now);
    } else if (again != SIM_NEVER) {
        packet_wake(f, r, again);
    }
}

static struct worm *worm_take(struct train *g, struct flight *v)
{
    struct worm **pool = &g->free_worm[v->nhop / WORM_STEP], *w = *pool;
    size_t nstage = (size_t)(v->nhop / WORM_STEP + 1) * WORM_STEP;
    if (w)
        *pool = w->next;
    else
        w = arena_take(g->fabric.net->arena, sizeof *w + nstage * sizeof(struct stage));
    *w = (struct worm){.flight = v, .index = v->injected, .nhop = v->nhop};
    w->flits = flight_packet_flits(v, w->index);
    for (int h = 0; h <= v->nhop; h++) {
        const struct pass *s = &v->pass[h];
        int input = h > 0 ? s[-1].port : 0;
        w->stage[h] = (struct stage){.worm = w,
                                     .flit = s->flit,
                                     .grant = -1,
                                     .hop = h,
                                     .resource = s->resource,
                                     .input = input};
    }
    return w;
}

/* The worm owns its injection port from its first packet on; flits follow as credits allow. */
static void source_serve(struct train *g, int node, sim_ps now)
{
    struct fabric *f = &g->fabric;
    struct source *z = &f->source[node];
    struct flight *v = z->front;
    if (!v) return;
    if (v->m->ready > now) {
        packet_wake(f, node, v->m->ready);
        return;
    }
    struct worm *w = worm_take(g, v);
    w->stage[0].ask = v->injected == 0 ? v->m->ready : f->resource[node].free;
    if (++v->injected == v->npacket && !(z->front = v->next)) z->back = NULL;
    allocate(g, &w->stage[0], now);
}

static void train_look(void *subject, uint64_t argument, sim_ps now)
{
    struct train *g = subject;
    struct fabric *f = &g->fabric;
    int r = (int)argument;
    struct resource *o = &f->resource[r];
    if (o->wake != now + 1) return;
    o->wake = 0;
    if (g->line[r].owner) return; /* its tail will wake us */
    if (o->free > now)
        packet_wake(f, r, o->free);
    else if (net_is_injection(f->net, r))
        source_serve(g, r, now);
    else
        line_serve(g, r, now);
}

/* ---- the way ---- */

/* Others' traffic waits for the tail of the owner: it cannot cut a worm in two. */
static void train_occupied(void *subject, uint64_t argument, sim_ps now)
{
    struct train *g = subject;
    struct line *l = &g->line[argument];
    if (!l->owner) {
        packet_occupied(&g->fabric, argument, now);
        return;
    }
    l->debt = ps_later(l->debt, g->fabric.debt[argument]);
    g->fabric.debt[argument] = 0;
}

static struct fabric *train_create(struct net *n, struct err *e)
{
    struct train *g = (struct train *)(void *)fabric_create(n, sizeof *g, train_look, e);
    if (!g) return NULL;
    g->fabric.occupied = train_occupied;
    n->hop_bytes += sizeof(struct stage) + sizeof(struct run);
    g->line = TAKE(n->arena, n->nresource, struct line);
    g->free_worm = TAKE(n->arena, (n->topology->max_hops + 2) / WORM_STEP + 1, struct worm *);
    return &g->fabric;
}

/* Who keeps the owner of resource r from going on: the resource that the front of the FIFO behind r
 * waits for; -1: nobody. */
static int waits_for(const struct train *g, int r)
{
    const struct stage *front = g->line[r].front;
    return front && front->known > 0 ? front[1].resource : -1;
}

static bool train_deadlock(const struct net *n, char *text, int size)
{
    const struct train *g = n->state;
    struct arena_mark mark = arena_mark(n->arena);
    int *way = TAKE(n->arena, n->nresource, int), *seen = TAKE(n->arena, n->nresource, int),
        count = 0, r = -1;
    for (int i = 0; i < n->nresource && r < 0; i++)
        if (g->line[i].owner) r = i;
    /* From any owner along the waiting worms; a deadlock comes round. */
    while (r >= 0 && !seen[r]) {
        way[count++] = r;
        seen[r] = count;
        r = waits_for(g, r);
    }
    if (r >= 0) packet_name_cycle(n, way + seen[r] - 1, count - seen[r] + 1, text, size);
    arena_release(n->arena, mark);
    return r >= 0;
}

const struct flit_way flit_train = {train_create, train_deadlock};
