/* topology_failed.c - routes around links and routers that do not work.
 *
 * A route of the family that meets nothing failed is kept, in its own classes. Any other is a
 * shortest way through what works, among those that a tree keeps free of deadlock: routers are
 * ordered by their distance from the first working one, a link leads up when it comes nearer to
 * that one (of equal ones: to the lower number), and a way goes up, then down, and at most once
 * more up and down (up*\/down* routes: Schroeder et al., "Autonet", IEEE J. Sel. Areas Commun. 9,
 * 1991). Within one ascent and descent links are in one order; the second has a class of its own,
 * and both are behind the family's. So no message waits for a class before its own, and none in a
 * circle within one. Going up and down once always leads to the target. Ways that would have to
 * turn up a second time are not taken, so that a route can be longer than the shortest way.
 *
 * Ways to a target are found by a search backwards when it is first needed, and kept. */
#include "machine/topology_failed.h"

#include <pthread.h>
#include <string.h>

#include "base/check.h"
#include "base/text.h"

/* Where a way stands: going up or down for the first time, and the same for the second. */
enum phase { UP, DOWN, UP_AGAIN, DOWN_AGAIN, PHASES };

/* What a network may have: each link takes 21 bytes here, each router 60, and a search for the ways
 * to one target passes over all of it four times (30 ms for 100,000 routers). */
enum { MOST_ROUTERS = 1 << 17, MOST_LINKS = 1 << 24 };

/* Routers up to which the longest way around is found by searching from all; above, it is bounded
 * by going up to the first router and down. */
enum { EXACT_ROUTERS = 512 };

struct failed {
    const struct topology *whole; /* as the family made it */
    struct arena *arena;
    bool *dead_link, *dead_router;
    int *from, *to, *port; /* (nlink) */
    int *first_out, *out;  /* working links that leave router r: out[first_out[r]] ... */
    int *first_in, *in;    /* and that lead to it */
    int *level;            /* (nrouter) distance from the first working router, -1: none */
    int **next; /* (nrouter) per target: (nrouter x PHASES) the link to take; NULL: not kept */
    int *kept, nkept, most_kept; /* (most_kept) targets whose ways are, a ring: the oldest .. */
    int oldest;                  /* .. gives its place to the next */
    int *distance, *queue; /* (nrouter x PHASES) of the search */
    pthread_mutex_t lock;  /* of the ways and the arena: threads of one run ask side by side */
};

static bool leads_up(const struct failed *f, int link)
{
    int a = f->from[link], b = f->to[link];
    return f->level[b] != f->level[a] ? f->level[b] < f->level[a] : b < a;
}

/* The phase after a link, -1: not allowed. */
static int phase_after(const struct failed *f, int phase, int link)
{
    if (!leads_up(f, link)) return phase == UP || phase == DOWN ? DOWN : DOWN_AGAIN;
    if (phase == UP) return UP;
    return phase == DOWN_AGAIN ? -1 : UP_AGAIN;
}

/* Backwards from all phases at the target; distance[r PHASES + phase] is the way that is left. */
static void search(struct failed *f, int target)
{
    int head = 0, tail = 0, n = f->whole->nrouter * PHASES;
    for (int i = 0; i < n; i++) f->distance[i] = -1;
    for (int phase = 0; phase < PHASES; phase++) {
        f->distance[target * PHASES + phase] = 0;
        f->queue[tail++] = target * PHASES + phase;
    }
    while (head < tail) {
        int state = f->queue[head++], r = state / PHASES;
        for (int i = f->first_in[r]; i < f->first_in[r + 1]; i++)
            for (int before = 0; before < PHASES; before++) {
                int other = f->from[f->in[i]] * PHASES + before;
                if (f->distance[other] >= 0) continue;
                if (phase_after(f, before, f->in[i]) != state % PHASES) continue;
                f->distance[other] = f->distance[state] + 1;
                f->queue[tail++] = other;
            }
    }
}

/* Memory for the ways to one more target, maybe that of the one that was asked for longest ago. */
static int *make_room(struct failed *f, int target)
{
    if (f->nkept < f->most_kept) {
        f->kept[f->nkept++] = target;
        return TAKE(f->arena, size_product(f->whole->nrouter, PHASES), int);
    }
    int *place = f->next[f->kept[f->oldest]];
    f->next[f->kept[f->oldest]] = NULL;
    f->kept[f->oldest] = target;
    f->oldest = (f->oldest + 1) % f->most_kept;
    return place;
}

/* Of links that are equally good the one with the lowest number. */
static const int *ways_to(struct failed *f, int target)
{
    if (f->next[target]) return f->next[target];
    const int n = f->whole->nrouter;
    int *next = make_room(f, target);
    search(f, target);
    for (int r = 0; r < n; r++)
        for (int phase = 0; phase < PHASES; phase++) {
            int state = r * PHASES + phase;
            next[state] = -1;
            for (int i = f->first_out[r]; i < f->first_out[r + 1] && next[state] < 0; i++) {
                int l = f->out[i], after = phase_after(f, phase, l);
                if (after < 0) continue;
                int left = f->distance[f->to[l] * PHASES + after];
                if (left >= 0 && left == f->distance[state] - 1) next[state] = l;
            }
        }
    f->next[target] = next;
    return next;
}

/* The link of such a way from a state: another thread may need the room of the ways next. */
static int link_to(struct failed *f, int target, int state)
{
    pthread_mutex_lock(&f->lock);
    const int link = ways_to(f, target)[state];
    pthread_mutex_unlock(&f->lock);
    return link;
}

/* Whether the family's route meets only what works. */
static bool works(const struct failed *f, struct route_cursor c)
{
    struct hop h;
    if (f->dead_router[c.router]) return false;
    while (f->whole->type->next(f->whole, &c, &h))
        if (f->dead_link[h.link]) return false;
    return true;
}

/* stage: of the family, which counts from 0; on a way around -1 - phase. A cursor has no room for
 * more: a head in flight fills a line of the cache. */
static void failed_start(const struct topology *t, uint64_t choice, struct route_cursor *c)
{
    const struct failed *f = t->state;
    struct route_cursor begin = *c;
    f->whole->type->start(f->whole, choice, c);
    if (c->router == c->target || works(f, *c)) return;
    *c = begin;
    c->stage = -1 - UP;
}

static bool failed_next(const struct topology *t, struct route_cursor *c, struct hop *h)
{
    struct failed *f = t->state;
    if (c->stage >= 0) return f->whole->type->next(f->whole, c, h);
    if (c->router == c->target) return false;
    int phase = -1 - c->stage, link = link_to(f, c->target, c->router * PHASES + phase);
    /* Placement keeps ranks off routers that cannot be reached. */
    CHECK(link >= 0);
    phase = phase_after(f, phase, link);
    *h = (struct hop){link, f->whole->nclass + phase / 2, f->port[link]};
    c->router = f->to[link];
    c->stage = -1 - phase;
    return true;
}

static void failed_ends(const struct topology *t, int link, int *from, int *to, int *port)
{
    const struct failed *f = t->state;
    *from = f->from[link];
    *to = f->to[link];
    *port = f->port[link];
}

static int failed_rate_dim(const struct topology *t, int link)
{
    const struct failed *f = t->state;
    return f->whole->type->rate_dim(f->whole, link);
}

static double failed_share(const struct topology *t, int link)
{
    const struct failed *f = t->state;
    return f->whole->type->share(f->whole, link);
}

static bool failed_link_works(const struct topology *t, int link)
{
    const struct failed *f = t->state;
    return !f->dead_link[link];
}

static bool failed_router_works(const struct topology *t, int router)
{
    const struct failed *f = t->state;
    return !f->dead_router[router];
}

/* What a router is joined to, for a message: the first few. */
static void joined_to(const struct failed *f, int router, struct text *out)
{
    enum { MOST_TOLD = 8 };
    int told = 0;
    const bool there = router >= 0 && router < f->whole->nrouter;
    const int begin = there ? f->first_out[router] : 0, end = there ? f->first_out[router + 1] : 0;
    for (int i = begin; i < end && told < MOST_TOLD; i++)
        text_add(out, "%s%d", told++ > 0 ? ", " : "", f->to[f->out[i]]);
    if (told == MOST_TOLD) text_add(out, ", ...");
    if (told == 0) text_add(out, "none");
}

/* The next working link from a to b; parallel ones fail one after the other. */
static int working_link(const struct failed *f, int a, int b)
{
    const int n = f->whole->nrouter;
    if (a < 0 || a >= n) return -1;
    for (int i = f->first_out[a]; i < f->first_out[a + 1]; i++)
        if (!f->dead_link[f->out[i]] && f->to[f->out[i]] == b) return f->out[i];
    return -1;
}

/* A cable is a link there and one back. */
static bool fail_links(struct failed *f, const struct topology_spec *s, struct err *e)
{
    for (int i = 0; i < s->nfailed_link; i++) {
        int a = s->failed_link[i][0], b = s->failed_link[i][1];
        int there = working_link(f, a, b), back = working_link(f, b, a);
        if (there >= 0 && back >= 0) {
            f->dead_link[there] = f->dead_link[back] = true;
            continue;
        }
        struct text near = {0};
        joined_to(f, a, &near);
        err_set(e, ERR_CONFIG,
                "network.failed.links: entry %d, no further cable joins routers %d and %d; %d is "
                "joined to %s",
                i, a, b, a, near.s);
        text_free(&near);
        return false;
    }
    return true;
}

/* With a router all its links. */
static bool fail_routers(struct failed *f, const struct topology_spec *s, struct err *e)
{
    const int n = f->whole->nrouter;
    for (int i = 0; i < s->nfailed_router; i++) {
        int r = s->failed_router[i];
        if (r < 0 || r >= n)
            return err_set(e, ERR_CONFIG,
                           "network.failed.routers: there is no router %d; expected 0 to %d", r,
                           n - 1);
        f->dead_router[r] = true;
    }
    for (int l = 0; l < f->whole->nlink; l++)
        if (f->dead_router[f->from[l]] || f->dead_router[f->to[l]]) f->dead_link[l] = true;
    return true;
}

/* Working links by the router that they leave or lead to, in the order of their numbers. */
static void index_links(const struct failed *f, const int *end, int *first, int *list)
{
    int n = f->whole->nrouter;
    memset(first, 0, (size_t)(n + 1) * sizeof *first);
    for (int l = 0; l < f->whole->nlink; l++) first[end[l] + 1] += !f->dead_link[l];
    for (int r = 0; r < n; r++) first[r + 1] += first[r];
    /* Filled from the front; afterwards first[r] is where r + 1 begins, and is moved back. */
    for (int l = 0; l < f->whole->nlink; l++)
        if (!f->dead_link[l]) list[first[end[l]]++] = l;
    memmove(first + 1, first, (size_t)n * sizeof *first);
    first[0] = 0;
}

/* Distances from the first working router with nodes. Those of others are told where they have
 * nodes; a switch without, which nobody can use any more, is as good as failed. */
static bool level_routers(struct failed *f, struct err *e)
{
    const struct topology *t = f->whole;
    int root = 0, with_nodes = t->nnode / t->nodes_per_router, head = 0, tail = 0;
    while (root < with_nodes && f->dead_router[root]) root++;
    if (root == with_nodes)
        return err_set(e, ERR_CONFIG, "network.failed.routers: no router with nodes is left");
    memset(f->level, -1, (size_t)t->nrouter * sizeof *f->level);
    f->level[root] = 0;
    f->queue[tail++] = root;
    while (head < tail) {
        int r = f->queue[head++];
        for (int i = f->first_out[r]; i < f->first_out[r + 1]; i++) {
            int to = f->to[f->out[i]];
            if (f->level[to] >= 0) continue;
            f->level[to] = f->level[r] + 1;
            f->queue[tail++] = to;
        }
    }
    int cut = 0, example = -1;
    for (int r = 0; r < t->nrouter; r++) {
        if (f->level[r] >= 0 || f->dead_router[r]) continue;
        f->dead_router[r] = true;
        if (r >= with_nodes) continue;
        if (cut++ == 0) example = r;
    }
    return cut == 0 ||
           err_set(e, ERR_CONFIG,
                   "network.failed cuts the network: router %d cannot be reached from router %d "
                   "(%d of %d routers with nodes are cut off)",
                   example, root, cut, with_nodes);
}

/* The most links of a way around, or a bound of it. */
static int longest_way(struct failed *f)
{
    int longest = 0, n = f->whole->nrouter;
    if (n > EXACT_ROUTERS) {
        for (int r = 0; r < n; r++)
            if (f->level[r] > longest) longest = f->level[r];
        return 2 * longest;
    }
    for (int target = 0; target < n; target++) {
        if (f->dead_router[target]) continue;
        search(f, target);
        for (int r = 0; r < n; r++)
            if (f->distance[r * PHASES + UP] > longest) longest = f->distance[r * PHASES + UP];
    }
    return longest;
}

static struct failed *failed_make(const struct topology *whole, int64_t kept_bytes,
                                  struct arena *a)
{
    const int n = whole->nrouter, nlink = whole->nlink, states = n * PHASES;
    struct failed *f = TAKE(a, 1, struct failed);
    *f = (struct failed){.whole = whole, .arena = a, .lock = PTHREAD_MUTEX_INITIALIZER};
    f->dead_link = TAKE(a, nlink + 1, bool);
    f->dead_router = TAKE(a, n, bool);
    f->from = TAKE(a, nlink + 1, int);
    f->to = TAKE(a, nlink + 1, int);
    f->port = TAKE(a, nlink + 1, int);
    f->first_out = TAKE(a, n + 1, int);
    f->out = TAKE(a, nlink + 1, int);
    f->first_in = TAKE(a, n + 1, int);
    f->in = TAKE(a, nlink + 1, int);
    f->level = TAKE(a, n, int);
    f->next = TAKE(a, n, int *);
    /* At least one, in which the next way is looked up that is needed. */
    const int64_t kept = kept_bytes / ((int64_t)states * (int64_t)sizeof(int));
    f->most_kept = kept < 1 ? 1 : kept < n ? (int)kept : n;
    f->kept = TAKE(a, f->most_kept, int);
    f->distance = TAKE(a, states, int);
    f->queue = TAKE(a, states, int);
    for (int l = 0; l < nlink; l++)
        whole->type->ends(whole, l, &f->from[l], &f->to[l], &f->port[l]);
    return f;
}

bool topology_fail(struct topology *t, int64_t kept_bytes, struct arena *a, struct err *e)
{
    if (t->nrouter > MOST_ROUTERS || t->nrouter < 2 || t->nlink > MOST_LINKS)
        return err_set(e, ERR_CONFIG,
                       "network.failed: topology %s has %d routers and %d links; expected 2 to %d "
                       "routers and at most %d links",
                       t->type->name, t->nrouter, t->nlink, MOST_ROUTERS, MOST_LINKS);
    struct topology *whole = TAKE(a, 1, struct topology);
    *whole = *t;
    struct failed *f = failed_make(whole, kept_bytes, a);
    /* Once while everything works, to find the links that do not; then without them. */
    index_links(f, f->from, f->first_out, f->out);
    if (!fail_links(f, t->spec, e) || !fail_routers(f, t->spec, e)) return false;
    index_links(f, f->from, f->first_out, f->out);
    index_links(f, f->to, f->first_in, f->in);
    if (!level_routers(f, e)) return false;
    /* The functions of the family that it has, each asked of the whole network. */
    struct topology_type *type = TAKE(a, 1, struct topology_type);
    *type = (struct topology_type){.name = whole->type->name,
                                   .start = failed_start,
                                   .next = failed_next,
                                   .ends = failed_ends,
                                   .rate_dim = whole->type->rate_dim ? failed_rate_dim : NULL,
                                   .share = whole->type->share ? failed_share : NULL,
                                   .parts = whole->type->parts,
                                   .link_works = failed_link_works,
                                   .router_works = failed_router_works};
    int around = longest_way(f);
    t->type = type;
    t->state = f;
    t->nclass = whole->nclass + 2;
    if (around > t->max_hops) t->max_hops = around;
    return true;
}
