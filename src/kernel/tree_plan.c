/* tree_plan.c - pieces of a tree and the order of its contraction (tree_plan.h).
 *
 * Everything in here follows from the parents of the bodies and from P, is made once before the
 * ranks run, and is the same on all of them: the ranks need no messages to agree on what comes
 * next. Time and memory O(n log n), against O(n / P) work of a rank in every evaluation. */
#include "kernel/tree_plan.h"

#include <string.h>

/* The remaining children of each compound (named by its top body), as linked lists in ascending
 * order. */
struct forest {
    int n;
    int *first, *last, *next, *before, *count; /* children lists; -1: none */
    int *up;                                   /* parent compound; -1: the base */
    bool *alive;
};

/* Children in ascending order, as in the model: the plan must not depend on how lists are built. */
static struct forest forest_make(const struct model *m, struct arena *a)
{
    const int n = m->nbody;
    struct forest f = {.n = n};
    f.first = TAKE(a, n, int), f.last = TAKE(a, n, int), f.next = TAKE(a, n, int),
    f.before = TAKE(a, n, int);
    f.count = TAKE(a, n, int), f.up = TAKE(a, n, int), f.alive = TAKE(a, n, bool);
    for (int i = 0; i < n; i++) f.first[i] = f.last[i] = f.next[i] = f.before[i] = -1;
    for (int i = 0; i < n; i++) {
        const int u = f.up[i] = m->body[i].parent;
        f.alive[i] = true;
        if (u < 0) continue;
        f.before[i] = f.last[u];
        if (f.last[u] >= 0) f.next[f.last[u]] = i;
        else f.first[u] = i;
        f.last[u] = i;
        f.count[u]++;
    }
    return f;
}

/* detach: v, a leaf compound, leaves its parent. Lists are doubly linked for this: O(1). */
static void detach(struct forest *f, int v)
{
    const int u = f->up[v];
    if (f->before[v] >= 0) f->next[f->before[v]] = f->next[v];
    else f->first[u] = f->next[v];
    if (f->next[v] >= 0) f->before[f->next[v]] = f->before[v];
    else f->last[u] = f->before[v];
    f->count[u]--;
    f->alive[v] = false;
}

/* join: u takes over the children of its only child v. O(children); all joins together O(n), since
 * v has then vanished. */
static void join(struct forest *f, int u, int v)
{
    f->first[u] = f->first[v], f->last[u] = f->last[v], f->count[u] = f->count[v];
    for (int x = f->first[u]; x >= 0; x = f->next[x]) f->up[x] = u;
    f->alive[v] = false;
}

/* While pieces are cut: the group of each body that heads one (-1: none yet), weights not yet cut
 * off. */
struct cutting {
    int limit, ngroup;
    int *group, *weight, *anchor;
};

/* cut_children: groups of siblings hanging at `anchor` whose weights reach the limit. Returns the
 * weight left over, which joins the anchor's own piece.
 *
 * Siblings are cut in groups and not one by one, so that a star, too, falls into pieces of about
 * the same size (physics 6.3). */
static int cut_children(struct cutting *c, int anchor, const int *child, int n)
{
    int sum = 0, begin = 0;
    for (int k = 0; k < n; k++) {
        if (c->group[child[k]] >= 0) continue;
        sum += c->weight[child[k]];
        if (sum < c->limit) continue;
        for (int l = begin; l <= k; l++)
            if (c->group[child[l]] < 0) c->group[child[l]] = c->ngroup;
        c->anchor[c->ngroup++] = anchor;
        begin = k + 1;
        sum = 0;
    }
    return sum;
}

/* cut_pieces: owner of each body and anchor of each piece; pieces are numbered from the base on.
 *
 * From the leaves inwards; as soon as a group weighs ceil(n / P) it is cut off. A member weighs at
 * most that much, hence fewer than 2 ceil(n / P) bodies in a piece, and at most P pieces. */
static void cut_pieces(struct tree_plan *p, const struct model *m, struct arena *a)
{
    const int n = m->nbody;
    struct cutting c = {.limit = (n + p->nrank - 1) / p->nrank};
    c.group = TAKE(a, n, int), c.weight = TAKE(a, n, int), c.anchor = TAKE(a, p->nrank + 1, int);
    int *root = TAKE(a, n, int), nroot = 0;
    for (int i = 0; i < n; i++) {
        c.group[i] = -1;
        if (m->body[i].parent < 0) root[nroot++] = i;
    }
    /* Children have larger indices than their parents: descending order meets them first. */
    for (int i = n - 1; i >= 0; i--)
        c.weight[i] =
            1 + cut_children(&c, i, m->child + m->child_at[i], m->child_at[i + 1] - m->child_at[i]);
    /* What is left over at the base, lighter than the limit, becomes the last piece. */
    if (cut_children(&c, -1, root, nroot) > 0) {
        for (int k = 0; k < nroot; k++)
            if (c.group[root[k]] < 0) c.group[root[k]] = c.ngroup;
        c.anchor[c.ngroup++] = -1;
    }
    p->npiece = c.ngroup;
    p->anchor = TAKE(a, p->npiece, int);
    /* Cut last, numbered first: a piece comes after the piece that it hangs at. */
    for (int k = 0; k < p->npiece; k++) p->anchor[p->npiece - 1 - k] = c.anchor[k];
    for (int i = 0; i < n; i++)
        p->owner[i] = c.group[i] >= 0 ? p->npiece - 1 - c.group[i] : p->owner[m->body[i].parent];
}

/* lists_make: k -> all i with key[i] = k, ascending; keys outside 0 .. nkey-1 are left out.
 * Counting sort: sizes, running sums, fill. */
static struct tree_lists lists_make(int nkey, int n, const int *key, struct arena *a)
{
    struct tree_lists l = {.at = TAKE(a, nkey + 1, int)};
    for (int i = 0; i < n; i++)
        if (key[i] >= 0 && key[i] < nkey) l.at[key[i] + 1]++;
    for (int k = 0; k < nkey; k++) l.at[k + 1] += l.at[k];
    l.item = TAKE(a, l.at[nkey] + 1, int);
    int *fill = TAKE(a, nkey + 1, int);
    for (int i = 0; i < n; i++)
        if (key[i] >= 0 && key[i] < nkey) l.item[l.at[key[i]] + fill[key[i]]++] = i;
    return l;
}

/* jump: tables of the 2^j-th ancestor pieces: anc_{j+1} = anc_j o anc_j (physics 6.4). At most 31
 * levels, since pieces are counted in an int. */
static void jump(struct tree_plan *p, struct arena *a)
{
    const int n = p->npiece;
    p->ancestor = TAKE(a, size_product(32, n), int);
    p->descendants = TAKE(a, 32, struct tree_lists);
    int *now = TAKE(a, n, int);
    memcpy(now, p->parent, (size_t)n * sizeof *now);
    for (p->nlevel = 0;; p->nlevel++) {
        bool any = false;
        int *level = p->ancestor + (size_t)p->nlevel * (size_t)n, *key = TAKE(a, n, int);
        for (int k = 0; k < n; k++) any = any || now[k] >= 0;
        if (!any) return;
        memcpy(level, now, (size_t)n * sizeof *now);
        /* A piece at the base has nothing to hand on: the motion of the base is known to all. */
        for (int k = 0; k < n; k++) key[k] = now[k] >= 0 && p->parent[now[k]] >= 0 ? now[k] : -1;
        p->descendants[p->nlevel] = lists_make(n, n, key, a);
        for (int k = 0; k < n; k++) now[k] = level[k] >= 0 ? level[level[k]] : -1;
    }
}

static struct tree_op *append(struct tree_plan *p, enum tree_kind kind, int round, int into,
                              int from)
{
    struct tree_op *op = &p->op[p->nop++];
    const int first = p->nop > 1 ? op[-1].first + op[-1].count : 0;
    *op = (struct tree_op){.kind = kind,
                           .round = round,
                           .into = into,
                           .first = first,
                           .from = from,
                           .to = p->owner[into]};
    return op;
}

static void absorb(struct tree_plan *p, struct tree_op *op, int v)
{
    p->absorbed[op->first + op->count++] = v;
}

/* exhaust_pieces: round 0: everything that needs no message. Leaves from the tips inwards, then
 * pairs from the base outwards; both orders are part of the result, down to its bits. */
static void exhaust_pieces(struct tree_plan *p, const struct model *m, struct forest *f)
{
    for (int v = p->nbody - 1; v >= 0; v--) {
        const int u = m->body[v].parent;
        if (u < 0 || p->owner[u] != p->owner[v] || f->count[v] > 0) continue;
        absorb(p, append(p, TREE_RAKE, 0, u, p->owner[v]), v);
        detach(f, v);
    }
    for (int u = 0; u < p->nbody; u++)
        while (f->alive[u] && f->count[u] == 1 && p->owner[f->first[u]] == p->owner[u]) {
            const int v = f->first[u];
            absorb(p, append(p, TREE_MERGE, 0, u, p->owner[v]), v);
            join(f, u, v);
        }
}

/* rake_round: all leaves at the beginning of the round; those of one owner with the same parent
 * together, in one message. Leaves that arise on the way wait: their parents may lie on other
 * ranks. */
static void rake_round(struct tree_plan *p, struct forest *f, const int *alive, int nalive,
                       bool *leaf)
{
    for (int k = 0; k < nalive; k++)
        leaf[alive[k]] = f->alive[alive[k]] && f->count[alive[k]] == 0 && f->up[alive[k]] >= 0;
    for (int k = 0; k < nalive; k++) {
        const int v = alive[k], u = f->up[v];
        if (!leaf[v]) continue;
        struct tree_op *op = append(p, TREE_RAKE, p->nround, u, p->owner[v]);
        for (int x = f->first[u]; x >= 0; x = f->next[x]) {
            if (!leaf[x] || p->owner[x] != p->owner[v]) continue;
            absorb(p, op, x);
            leaf[x] = false;
        }
        for (int l = 0; l < op->count; l++) detach(f, p->absorbed[op->first + l]);
    }
}

/* merge_round: compounds with their only child, from the base on, each in one pair at most: pairs
 * of a round are independent and run at the same time. Greedy from the top, a chain of k compounds
 * gives about k / 2 pairs. */
static void merge_round(struct tree_plan *p, struct forest *f, const int *alive, int nalive,
                        int *used)
{
    for (int k = 0; k < nalive; k++) {
        const int u = alive[k];
        if (!f->alive[u] || used[u] == p->nround || f->count[u] != 1) continue;
        const int v = f->first[u];
        if (used[v] == p->nround) continue;
        used[u] = used[v] = p->nround;
        absorb(p, append(p, TREE_MERGE, p->nround, u, p->owner[v]), v);
        join(f, u, v);
    }
}

/* contract: rounds until only the compounds on the base are left. Every round shrinks leaves and
 * chains by a fixed share, hence O(log n) rounds (Miller and Reif 1985). */
static void contract(struct tree_plan *p, const struct model *m, struct arena *a)
{
    struct forest f = forest_make(m, a);
    int *alive = TAKE(a, p->nbody, int), *used = TAKE(a, p->nbody, int), nalive = 0;
    bool *leaf = TAKE(a, p->nbody, bool);
    p->op = TAKE(a, p->nbody, struct tree_op);
    p->absorbed = TAKE(a, p->nbody, int);
    exhaust_pieces(p, m, &f);
    for (int i = 0; i < p->nbody; i++) alive[nalive++] = i;
    /* The list of living compounds is compacted, so that all rounds together cost O(n). */
    for (;;) {
        int n = 0;
        bool inner = false;
        for (int k = 0; k < nalive; k++)
            if (f.alive[alive[k]]) alive[n++] = alive[k];
        nalive = n;
        /* Done when every living compound hangs on the base. */
        for (int k = 0; k < nalive; k++) inner = inner || f.up[alive[k]] >= 0;
        if (!inner) break;
        p->nround++;
        rake_round(p, &f, alive, nalive, leaf);
        merge_round(p, &f, alive, nalive, used);
    }
    p->nroot = nalive;
    p->root = alive;
}

/* assign: the operations of each rank, in the order of all: an operation between two ranks stands
 * in both lists. Counting sort in two passes, as in lists_make. */
static void assign(struct tree_plan *p, struct arena *a)
{
    struct tree_lists *l = &p->ops;
    l->at = TAKE(a, p->nrank + 1, int);
    l->item = TAKE(a, size_sum(size_product(2, p->nop), 1), int);
    int *fill = TAKE(a, p->nrank + 1, int);
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < p->nop; i++) {
            const struct tree_op *op = &p->op[i];
            const int ranks[2] = {op->from, op->to};
            for (int s = 0; s < (op->from == op->to ? 1 : 2); s++) {
                if (pass == 0) l->at[ranks[s] + 1]++;
                else l->item[l->at[ranks[s]] + fill[ranks[s]]++] = i;
            }
        }
        for (int k = 0; k < p->nrank && pass == 0; k++) l->at[k + 1] += l->at[k];
    }
}

struct tree_plan *tree_plan_make(const struct model *m, int nrank, struct arena *a)
{
    struct tree_plan *p = TAKE(a, 1, struct tree_plan);
    p->nbody = m->nbody;
    p->nrank = nrank;
    p->owner = TAKE(a, m->nbody, int);
    p->local = TAKE(a, m->nbody, int);
    cut_pieces(p, m, a);
    p->bodies = lists_make(nrank, m->nbody, p->owner, a);
    for (int k = 0; k < nrank; k++)
        for (int l = p->bodies.at[k]; l < p->bodies.at[k + 1]; l++)
            p->local[p->bodies.item[l]] = l - p->bodies.at[k];
    p->parent = TAKE(a, p->npiece, int);
    for (int k = 0; k < p->npiece; k++)
        p->parent[k] = p->anchor[k] >= 0 ? p->owner[p->anchor[k]] : -1;
    p->kids = lists_make(p->npiece, p->npiece, p->parent, a);
    jump(p, a);
    contract(p, m, a);
    assign(p, a);
    return p;
}
