/* topology_random.c - random regular graphs: every router is joined to r others by chance.
 *
 * dims = {n, r}: n routers with r cables each, topology.nodes_per_router nodes on each router;
 * topology.seed draws another graph (Singla et al., "Jellyfish: networking data centers randomly",
 * NSDI 2012). If n r is odd one router has a cable less. Routes, ports and classes as in
 * topology_graph.c.
 *
 * Two free ports by chance are joined, over and over. Where they are of one router or of two that
 * are joined already, a cable drawn by chance is opened and its ends joined to the two. What is not
 * connected in the end, which is rare from r = 3 on, is drawn again. */
#include "base/check.h"
#include "base/random.h"
#include "machine/topology_graph.h"

enum { MOST_DRAWS = 64, MOST_TRIES = 10000, MOST_PORTS = 1 << 24 };

/* Ports looked at in all draws, about 1 s: routers x degree^2 for one draw, and many more where
 * nearly all routers are joined to each other, as few pairs are left that chance must find. */
static const int64_t most_looks = INT64_C(1) << 31;

/* Port r k + i is port i of router r. */
struct wiring {
    int n, k;
    int *peer; /* (n k) the port at the other end, -1: free */
    int *free; /* (nfree) ports */
    int nfree;
    int64_t looks;
};

static bool joined(struct wiring *w, int a, int b)
{
    const int *peer = w->peer + a * w->k;
    const unsigned first = (unsigned)(b * w->k), k = (unsigned)w->k;
    w->looks += w->k;
    for (int i = 0; i < w->k; i++)
        if ((unsigned)peer[i] - first < k) return true; /* a free one is the largest number */
    return false;
}

/* Whether ports p and q may be joined: of two routers that are not yet. */
static bool may_join(struct wiring *w, int p, int q)
{
    return p / w->k != q / w->k && !joined(w, p / w->k, q / w->k);
}

static void join(struct wiring *w, int p, int q)
{
    w->peer[p] = q;
    w->peer[q] = p;
}

/* A cable by chance goes, and both its ends are joined to the two free ports: no port is free or
 * taken that was not before, but the two. False when this cable does not do. */
static bool swap_in(struct wiring *w, int p, int q, struct random *r)
{
    int u = (int)random_below(r, (uint64_t)(w->n * w->k)), v = w->peer[u];
    if (v < 0 || !may_join(w, p, u) || !may_join(w, q, v)) return false;
    join(w, p, u);
    join(w, q, v);
    return true;
}

/* All ports but at most one find a peer; false when chance does not manage. */
static bool draw(struct wiring *w, struct random *r)
{
    w->nfree = w->n * w->k;
    for (int i = 0; i < w->nfree; i++) w->free[i] = i, w->peer[i] = -1;
    for (int tries = 0; w->nfree > 1 && tries < MOST_TRIES && w->looks < most_looks; tries++) {
        int i = (int)random_below(r, (uint64_t)w->nfree);
        int j = (int)random_below(r, (uint64_t)w->nfree - 1);
        j += j >= i;
        int p = w->free[i], q = w->free[j];
        bool done = may_join(w, p, q);
        if (done) join(w, p, q);
        else done = swap_in(w, p, q, r);
        if (!done) continue;
        /* The higher place first: the last entry moves into it and must not be the other one. */
        w->free[i > j ? i : j] = w->free[w->nfree - 1];
        w->free[i > j ? j : i] = w->free[w->nfree - 2];
        w->nfree -= 2;
        tries = 0;
    }
    return w->nfree <= 1;
}

/* Every cable once, by its lower port. */
static int list_cables(const struct wiring *w, struct graph_cable *cable)
{
    int n = 0;
    for (int p = 0; p < w->n * w->k; p++)
        if (w->peer[p] > p)
            cable[n++] = (struct graph_cable){p / w->k, w->peer[p] / w->k, 100, 100, 1, 1};
    return n;
}

static bool random_create(struct topology *t, struct arena *a, struct err *e)
{
    const struct topology_spec *s = t->spec;
    int n = s->dims[0], k = s->dims[1];
    if (n < 4 || k < 3 || k >= n)
        return err_set(e, ERR_CONFIG,
                       "topology random-regular: %d routers of degree %d; expected at least 4 "
                       "routers and a degree of 3 to one less than there are routers",
                       n, k);
    if (n > MOST_PORTS / k || (int64_t)n * k * k > most_looks)
        return err_set(
            e, ERR_CONFIG,
            "topology random-regular: %d routers of degree %d; expected at most %d ports "
            "(routers x degree) and routers x degree^2 up to %lld",
            n, k, MOST_PORTS, (long long)most_looks);
    /* Every port may stand in the list of free ones. */
    const int nport = n * k;
    struct wiring w = {.n = n, .k = k, .peer = TAKE(a, nport, int), .free = TAKE(a, nport, int)};
    struct graph_cable *cable = TAKE(a, nport / 2 + 1, struct graph_cable);
    struct random r = random_make(s->seed, 0x6a656c6c79, 0); /* "jelly" */
    for (int i = 0; i < MOST_DRAWS && w.looks < most_looks; i++) {
        err_clear(e);
        t->nport = 0;
        if (draw(&w, &r) && graph_build(t, n, cable, list_cables(&w, cable), a, e)) return true;
    }
    err_clear(e);
    return err_set(
        e, ERR_CONFIG,
        "topology random-regular: chance finds no connected graph of %d routers of degree "
        "%d; expected a degree further above 2 or further below the number of routers",
        n, k);
}

const struct topology_type topology_random_regular = {
    .name = "random-regular",
    .create = random_create,
    .start = graph_start,
    .next = graph_next,
    .ends = graph_ends,
    .share = graph_share,
};
