/* tree_plan.h - what follows from a tree's topology alone: who owns which bodies, and in which
 * order the constraint force system is contracted (physics 6.3).
 *
 * A piece is a set of sibling subtrees, less what was cut off below, hanging at one anchor body: at
 * most P pieces of fewer than 2 ceil(n/P) + 1 bodies each, one per rank. Contraction alternates
 * raking leaves into their parents and merging a compound with its only child (Miller and Reif
 * 1985), O(log n) rounds. */
#ifndef KERNEL_TREE_PLAN_H
#define KERNEL_TREE_PLAN_H

#include "base/arena.h"
#include "model/model.h"

enum tree_kind { TREE_RAKE, TREE_MERGE };

struct tree_op {
    enum tree_kind kind;
    int round;        /* 0: within one piece */
    int into;         /* compound (top body) that remains */
    int first, count; /* compounds that vanish: plan.absorbed[first ..]; one for a merge */
    int from, to;     /* ranks that own them and `into` */
};

/* A list of lists: items of k are item[at[k]] .. item[at[k + 1] - 1]. */
struct tree_lists {
    int *at, *item;
};

struct tree_plan {
    int nbody, nrank, npiece;       /* ranks npiece .. nrank-1 own nothing */
    int *owner;                     /* (nbody) */
    int *local;                     /* (nbody) place of a body among its owner's, ascending */
    struct tree_lists bodies;       /* of each rank, ascending */
    int *anchor;                    /* (npiece) body that the piece hangs at; -1: the base */
    int *parent;                    /* (npiece) piece that owns the anchor; -1: none */
    int nlevel;                     /* ceil(log2(depth of pieces)) */
    int *ancestor;                  /* (nlevel x npiece) 2^j-th ancestor piece, -1: none */
    struct tree_lists kids;         /* pieces hanging at a piece's bodies */
    /* (nlevel) pieces c with ancestor_j(c) = k, for those k that have an anchor body */
    struct tree_lists *descendants;
    int nop, nround;
    struct tree_op *op; /* in order */
    int *absorbed;
    struct tree_lists ops; /* indices of the operations in which each rank takes part */
    int nroot, *root;      /* compounds left at the end, one per body on the base */
};

/* tree_plan_make: for nrank ranks, 1 <= nrank <= nbody. Takes O(n log n) time and memory. */
struct tree_plan *tree_plan_make(const struct model *m, int nrank, struct arena *a);

/* tree_plan_ancestor: 2^j-th ancestor of piece k; -1: none. */
static inline int tree_plan_ancestor(const struct tree_plan *p, int j, int k)
{
    return p->ancestor[j * p->npiece + k];
}

#endif
