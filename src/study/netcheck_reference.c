/* netcheck_reference.c - BookSim's networks as this program's.
 *
 * Concentrated networks (flattened butterflies, concentrated meshes) number their nodes on a grid
 * of which each router has a block; here nodes are numbered router by router. */
#include "study/netcheck_reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "study/netcheck_case.h"

/* ---- rules ---- */

enum { ANY = -1 };

/* The reference's names. Those of a flattened butterfly that are called minimal go by order of
 * dimensions; on a fat tree the first one draws each up port. */
static const struct {
    const char *word;
    int family;
    enum routing_rule rule;
} rules[] = {
    {"min_adapt", ANY, ROUTING_BOOKSIM_MIN_ADAPT},
    {"dim_order", ANY, ROUTING_BOOKSIM_DIM_ORDER},
    {"dor", ANY, ROUTING_BOOKSIM_DIM_ORDER},
    {"dor_no_express", TOPOLOGY_MESH, ROUTING_BOOKSIM_DIM_ORDER},
    {"ran_min", TOPOLOGY_HYPERX, ROUTING_BOOKSIM_DIM_ORDER},
    {"xy_yx", ANY, ROUTING_XY_YX},
    {"xyyx", TOPOLOGY_HYPERX, ROUTING_XY_YX},
    {"xy_yx_no_express", TOPOLOGY_MESH, ROUTING_XY_YX},
    {"adaptive_xy_yx", ANY, ROUTING_ADAPTIVE_XY_YX},
    {"adaptive_xyyx", TOPOLOGY_HYPERX, ROUTING_ADAPTIVE_XY_YX},
    {"romm", ANY, ROUTING_ROMM},
    {"valiant", ANY, ROUTING_BOOKSIM_VALIANT},
    {"ugal", ANY, ROUTING_BOOKSIM_UGAL},
    {"nca", TOPOLOGY_FAT_TREE, ROUTING_NCA},
    {"anca", TOPOLOGY_FAT_TREE, ROUTING_ANCA},
    {"min", TOPOLOGY_HYPERX, ROUTING_BOOKSIM_DIM_ORDER},
    {"min", ANY, ROUTING_BOOKSIM_MIN},
};

bool netcheck_routing(const char *function, enum topology_family family, enum routing_rule *rule,
                      struct err *e)
{
    /* The first entry that fits: names mean different rules on different networks. */
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        if (strcmp(rules[i].word, function) != 0) continue;
        if (rules[i].family != ANY && rules[i].family != (int)family) continue;
        *rule = rules[i].rule;
        return true;
    }
    return err_set(e, ERR_UNAVAILABLE,
                   "routing '%.64s' on %s is not supported; known: dim_order, min, min_adapt, "
                   "xy_yx, adaptive_xy_yx, romm, valiant, ugal, nca, anca, ran_min, dor_no_express",
                   function, topology_family_name(family));
}

/* ---- concentrated networks ---- */

/* A number of `topology_params`; `otherwise` where it does not say. */
static bool parameter(struct netcheck_reader *r, const struct node *c, const char *key,
                      int otherwise, int *value)
{
    return netcheck_integer(r, document_find(c, "topology_params"), key, 1, 4096, otherwise, value);
}

/* Node x + xr kx (y + ...) of a grid of kx routers a row: its router has a block of xr x yr. */
static int *blocks(struct arena *a, int nnode, int kx, int xr, int yr)
{
    int *node = TAKE(a, nnode, int);
    /* Place on the grid, then block, then place in the block. */
    for (int i = 0; i < nnode; i++) {
        const int x = i % (kx * xr), y = i / (kx * xr);
        node[i] = (y / yr * kx + x / xr) * xr * yr + y % yr * xr + x % xr;
    }
    return node;
}

/* c nodes on each of k^n routers; with two dimensions in blocks of the grid. */
static bool concentrated(struct netcheck_reader *r, const struct node *c,
                         struct netcheck_reference *f)
{
    struct topology_spec *s = &f->topology;
    int k, n, xr, yr, many;
    if (!parameter(r, c, "k", 2, &k) || !parameter(r, c, "n", 1, &n) ||
        !parameter(r, c, "c", 1, &many) || !parameter(r, c, "xr", 1, &xr) ||
        !parameter(r, c, "yr", 1, &yr))
        return false;
    *s = (struct topology_spec){.family = strncmp(document_find(c, "topology")->text, "flat", 4)
                                              ? TOPOLOGY_MESH
                                              : TOPOLOGY_HYPERX,
                                .nodes_per_router = many,
                                .processors_per_node = 1,
                                .ndim = n};
    /* Counted on the way, before the product can wrap. */
    int64_t nodes = many;
    for (int d = 0; d < n && d < MACHINE_MAX_DIMS && nodes <= NETCHECK_MOST_NODES; d++) {
        s->dims[d] = k;
        nodes *= k;
    }
    if (n > MACHINE_MAX_DIMS || nodes > NETCHECK_MOST_NODES || k < 2 || xr * yr > many)
        return err_set_at(r->e, ERR_DATA, r->path, document_find(c, "topology_params")->line,
                          "k = %d, n = %d, c = %d, xr = %d, yr = %d are no network: expected k "
                          "from 2, n up to %d, xr yr up to c and at most %d nodes",
                          k, n, many, xr, yr, MACHINE_MAX_DIMS, NETCHECK_MOST_NODES);
    /* Only there does the reference number by blocks; else router by router, as here. */
    if (n == 2 && xr * yr == many) f->node = blocks(r->arena, (int)nodes, k, xr, yr);
    snprintf(f->digits, sizeof f->digits, "(%d,%d)", k * xr, n);
    return true;
}

/* ---- arbitrary networks ---- */

static const char blanks[] = " \t\r";

/* "node 12" at *at, which goes behind it and never over the end of the line: the next line's first
 * word would be one of this line. */
static bool take_pair(const char **at, char word[16], int *number)
{
    const char *s = *at + strspn(*at, blanks);
    const size_t n = strspn(s, "abcdefghijklmnopqrstuvwxyz");
    char *end;
    if (n == 0 || n > 15) return false;
    snprintf(word, 16, "%.*s", (int)n, s);
    s += n;
    s += strspn(s, blanks);
    if (*s < '0' || *s > '9') return false;
    const long x = strtol(s, &end, 10);
    *number = x < NETCHECK_MOST_NODES ? (int)x : NETCHECK_MOST_NODES;
    *at = end + strspn(end, blanks);
    return true;
}

/* One line: the router, its nodes, its neighbours with larger numbers. Nodes are numbered router by
 * router, as many on each. */
static bool routers_line(const char *path, int line, const char *text, struct topology_spec *s,
                         int *nlink, int *nodes, struct err *e)
{
    int head = -1, number;
    char word[16];
    *nodes = 0;
    /* The first router is the line's own; what follows hangs on it. */
    while (*text && *text != '\n') {
        if (!take_pair(&text, word, &number))
            return err_set_at(e, ERR_DATA, path, line,
                              "expected 'router R node N ... router R ...'");
        const bool router = strcmp(word, "router") == 0;
        if (router && number == NETCHECK_MOST_NODES)
            return err_set_at(e, ERR_DATA, path, line,
                              "the number of a router is too large; expected less than %d",
                              NETCHECK_MOST_NODES);
        if (router && number >= s->dims[0]) s->dims[0] = number + 1;
        if (strcmp(word, "node") == 0) ++*nodes;
        else if (!router)
            return err_set_at(e, ERR_DATA, path, line, "'%s'; expected 'router' or 'node'", word);
        else if (head < 0) head = number;
        else if (number > head) {
            /* Each cable stands in both of its routers' lines. */
            if (s->link) {
                s->link[*nlink][0] = head;
                s->link[*nlink][1] = number;
            }
            ++*nlink;
        }
    }
    return true;
}

bool netcheck_routers_read(const char *path, const char *text, struct arena *a,
                           struct topology_spec *s, struct err *e)
{
    *s = (struct topology_spec){.family = TOPOLOGY_GRAPH, .ndim = 1, .processors_per_node = 1};
    /* Twice: to count the cables, and to note them. */
    for (int pass = 0; pass < 2; pass++) {
        int nlink = 0, line = 1, nodes;
        for (const char *at = text; *at; line++) {
            /* Lines of blanks alone say nothing. */
            at += strspn(at, blanks);
            if (*at == '\n') {
                at++;
                continue;
            }
            if (*at == '\0') break;
            if (!routers_line(path, line, at, s, &nlink, &nodes, e)) return false;
            if (nodes != s->nodes_per_router && s->nodes_per_router > 0)
                return err_set_at(e, ERR_DATA, path, line,
                                  "%d nodes on a router; expected %d, as on the others", nodes,
                                  s->nodes_per_router);
            s->nodes_per_router = nodes;
            at += strcspn(at, "\n");
            at += *at == '\n';
        }
        if (nlink == 0 || nlink > NETCHECK_MOST_LINKS)
            return err_set_at(e, ERR_DATA, path, 1, "%d cables; expected 1 to %d", nlink,
                              NETCHECK_MOST_LINKS);
        s->nlink = nlink;
        if (pass == 0) s->link = (int(*)[2])TAKE(a, size_product(2, (size_t)nlink), int);
    }
    return true;
}

/* The file NAME.txt beside the case's own, without what follows NAME's last underscore if there is
 * none of the whole name. */
static bool arbitrary(struct netcheck_reader *r, const char *name, struct netcheck_reference *f,
                      struct err *why)
{
    const char *slash = strrchr(r->path, '/');
    const int folder = slash ? (int)(slash + 1 - r->path) : 0;
    char path[1024];
    int length = (int)strlen(name);
    if (strchr(name, '/'))
        return err_set(why, ERR_DATA, "topology '%.64s': expected a name without '/'", name);
    /* Shorter and shorter, at underscores. */
    for (; length > 0; length--) {
        if (name[length] && name[length] != '_') continue;
        snprintf(path, sizeof path, "%.*s%.*s.txt", folder, r->path, length, name);
        struct err missing;
        struct text text = {0};
        err_clear(&missing);
        const bool there = text_read_file(&text, path, &missing);
        const bool read = there && netcheck_routers_read(path, text.s, r->arena, &f->topology, why);
        text_free(&text);
        if (there) return read;
    }
    return err_set(why, ERR_UNAVAILABLE,
                   "the routers of '%.64s' are not given: no file %.64s.txt beside it", name, name);
}

/* ---- a case ---- */

/* Cables of the reference's dragonfly take 10 cycles in a group and 100 between groups; one of them
 * is in the router's own time. Its groups number their global links by the group that they lead to.
 */
static void cables(struct topology_spec *s)
{
    if (s->family != TOPOLOGY_DRAGONFLY) return;
    s->absolute = true;
    s->dim_latency[0] = 9e-9;
    s->dim_latency[1] = 99e-9;
}

bool netcheck_reference(struct netcheck_reader *r, const struct node *c,
                        struct netcheck_reference *f, struct err *why)
{
    const char *name, *function, *kind;
    int k, n;
    *f = (struct netcheck_reference){.node = NULL};
    /* What the name does not say stands in the parameters. */
    const struct node *params = document_find(c, "topology_params");
    if (params->kind != NODE_MAP)
        return err_set_at(r->e, ERR_DATA, r->path, params->line, "expected keys with values");
    if (!netcheck_word(r, c, "topology", &name) || !netcheck_word(r, params, "topology", &kind) ||
        !netcheck_word(r, c, "routing_function", &function))
        return false;
    if (strncmp(name, "flatfly", 7) == 0 || strncmp(name, "cmesh", 5) == 0) {
        if (!concentrated(r, c, f)) return false;
    } else if (strcmp(kind, "anynet") == 0) {
        if (!arbitrary(r, name, f, why)) return false;
    } else {
        if (!netcheck_topology(name, 1, &f->topology, why)) return false;
        f->topology.routing = ROUTE_MINIMAL;
        if (!parameter(r, c, "k", 0, &k) || !parameter(r, c, "n", 0, &n)) return false;
        const bool cube = f->topology.family != TOPOLOGY_DRAGONFLY && k > 1 && n > 0;
        if (cube) snprintf(f->digits, sizeof f->digits, "(%d,%d)", k, n);
    }
    cables(&f->topology);
    return netcheck_routing(function, f->topology.family, &f->rule, why);
}
