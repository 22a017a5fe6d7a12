/* fuzz_graph.c - topologies of every family with any numbers, graphs link by link: refused with a
 * reason, or every route leads from link to link to its end. */
#include "fuzz.h"

#include "machine/topology.h"
#include "plan/machine_file.h"

enum { FAMILIES = TOPOLOGY_GRAPH + 1, MOST_LINKS = 512, MOST_HOPS = 4096, PAIRS = 64,
       SEEN = 1 << 18 }; /* routers looked at for all pairs: of a graph each route looks at all */

/* Mostly small, now and then anything. */
static int a_size(struct fuzz_bytes *b)
{
    unsigned how = fuzz_below(b, 32);
    if (how < 24) return (int)how;
    if (how < 30) return 1 << fuzz_below(b, 31);
    return (int)(uint32_t)fuzz_take(b, 4);
}

static void take_links(struct topology_spec *t, struct fuzz_bytes *b, struct arena *a)
{
    t->nlink = (int)fuzz_below(b, MOST_LINKS);
    t->link = (int(*)[2])arena_take(a, size_product((size_t)t->nlink + 1, 2 * sizeof(int)));
    t->link_percent = TAKE(a, 2 * t->nlink + 1, int);
    t->nlink_percent = (int)fuzz_below(b, 3) * t->nlink;
    for (int i = 0; i < t->nlink; i++) {
        t->link[i][0] = (int)(int8_t)fuzz_take(b, 1);
        t->link[i][1] = (int)(int8_t)fuzz_take(b, 1);
    }
    for (int i = 0; i < t->nlink_percent; i++) t->link_percent[i] = 1 + (int)fuzz_below(b, 200);
}

/* Now and then some of it does not work. */
static void take_failures(struct topology_spec *t, struct fuzz_bytes *b, struct arena *a)
{
    enum { MOST_FAILED = 12 };
    if (fuzz_below(b, 4) != 0) return;
    t->failed_link = (int(*)[2])arena_take(a, (MOST_FAILED + 1) * sizeof *t->failed_link);
    t->failed_router = TAKE(a, MOST_FAILED + 1, int);
    t->nfailed_link = (int)fuzz_below(b, MOST_FAILED);
    t->nfailed_router = (int)fuzz_below(b, MOST_FAILED) / 3;
    for (int i = 0; i < t->nfailed_link; i++) {
        t->failed_link[i][0] = (int)(int8_t)fuzz_take(b, 1);
        t->failed_link[i][1] = (int)(int8_t)fuzz_take(b, 1);
    }
    for (int i = 0; i < t->nfailed_router; i++) t->failed_router[i] = (int)(int8_t)fuzz_take(b, 1);
}

/* A list of n sizes, or of shifts, which may be negative. */
static int *take_list(struct fuzz_bytes *b, int n, bool shifts, struct arena *a)
{
    int *list = TAKE(a, n + 1, int);
    for (int i = 0; i < n; i++) list[i] = shifts ? (int)(int8_t)fuzz_take(b, 1) : a_size(b);
    return list;
}

/* What the families after the dragonfly have beside their dimensions. */
static void take_further(struct topology_spec *t, struct fuzz_bytes *b, struct arena *a)
{
    t->express = a_size(b);
    t->seed = fuzz_take(b, 1);
    t->nup = (int)fuzz_below(b, MACHINE_MAX_DIMS);
    t->up = take_list(b, t->nup, false, a);
    t->ntwist = (int)fuzz_below(b, MACHINE_MAX_DIMS);
    t->twist = take_list(b, t->ntwist, true, a);
    t->nbundle = (int)fuzz_below(b, MACHINE_MAX_DIMS);
    t->bundle = take_list(b, t->nbundle, false, a);
}

static void take_topology(struct topology_spec *t, struct fuzz_bytes *b, struct arena *a)
{
    *t = (struct topology_spec){.family = (enum topology_family)fuzz_below(b, FAMILIES)};
    int wanted = topology_family_dims(t->family);
    t->ndim = wanted ? wanted : 1 + (int)fuzz_below(b, MACHINE_MAX_DIMS);
    for (int i = 0; i < t->ndim; i++) t->dims[i] = a_size(b);
    t->nodes_per_router = 1 + (int)fuzz_below(b, 4);
    t->processors_per_node = 1 + (int)fuzz_below(b, 4);
    t->tie = (enum tie_rule)fuzz_below(b, 3);
    t->routing = (enum dragonfly_routing)fuzz_below(b, 2);
    t->xpress = fuzz_below(b, 4) == 0;
    if (topology_has(t->family, TOPOLOGY_LISTED)) take_links(t, b, a);
    else if (t->family > TOPOLOGY_DRAGONFLY) take_further(t, b, a);
    take_failures(t, b, a);
}

/* Routes are walks: each link begins where the one before ended. */
static void walk(const struct topology *t, struct fuzz_bytes *b)
{
    static struct hop route[MOST_HOPS];
    const int most = t->nrouter > SEEN / PAIRS ? 1 + SEEN / t->nrouter : PAIRS;
    for (int k = 0; t->max_hops <= MOST_HOPS && k < most; k++) {
        int src = (int)(fuzz_take(b, 3) % (unsigned)t->nnode),
            dst = (int)(fuzz_take(b, 3) % (unsigned)t->nnode);
        uint64_t choice = fuzz_take(b, 2);
        /* Nobody is placed on what does not work. */
        if (!topology_router_works(t, topology_router_of(t, src)) ||
            !topology_router_works(t, topology_router_of(t, dst)))
            continue;
        int n = topology_route(t, src, dst, choice, route), at = topology_router_of(t, src);
        CHECK(n >= 0 && n <= t->max_hops);
        if (t->fixed_routes) CHECK(topology_distance(t, src, dst) == n);
        for (int i = 0; i < n; i++) {
            int from, to, port;
            CHECK(route[i].link >= 0 && route[i].link < t->nlink);
            CHECK(topology_link_works(t, route[i].link));
            CHECK(route[i].vc_class >= 0 && route[i].vc_class < t->nclass);
            topology_link_ends(t, route[i].link, &from, &to, &port);
            CHECK(from == at && port == route[i].port && port < t->nport);
            at = to;
        }
        CHECK(at == topology_router_of(t, dst));
    }
}

/* Everything but the topology, read once. */
static const struct machine_spec *ideal(void)
{
    static struct machine_spec m;
    static struct arena *kept;
    struct err e;
    if (kept != NULL) return &m;
    fuzz_data();
    err_clear(&e);
    kept = arena_create();
    CHECK(plan_machine(&m, "ideal", NULL, kept, NULL, NULL, &e));
    return &m;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_bytes b = {data, data + size};
    struct arena *a = arena_create();
    struct err e;
    err_clear(&e);
    struct machine_spec m = *ideal();
    take_topology(&m.topology, &b, a);
    const struct topology *t = NULL;
    if (machine_file_check(&m, "input.yaml", 1, &e)) t = topology_create(&m.topology, a, &e);
    /* A graph by chance is made cable by cable: the documentation states how long that takes. */
    if (t != NULL && topology_has(m.topology.family, TOPOLOGY_SEEDED))
        fuzz_allow(FUZZ_SECONDS + 0.4e-6 * t->nlink);
    if (t != NULL) walk(t, &b);
    else fuzz_refused(&e);
    arena_destroy(a);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    (void)seed;
    return LLVMFuzzerMutate(data, size, most);
}
