/* mpi_group.c - groups: lists of ranks of the world, kept as first and step where they are that
 * regular.
 *
 * Section 7.3 of MPI 5.0. The world of 65,536 ranks as a list would take 256 KiB in each
 * of its ranks; as first and step it takes none. Most groups that programs make are that
 * regular: rows, columns, halves. */
#include <stdlib.h>

#include "mpi/mpi_internal.h"

int mpi_group_world(const struct mpi_group *g, int rank)
{
    return g->list ? g->list[rank] : g->first + rank * g->step;
}

/* The list comes as context, because positions are sorted and not ranks. */
static int by_rank(const void *a, const void *b, void *list)
{
    const int *of = list;
    return of[*(const int *)a] - of[*(const int *)b];
}

/* Positions in the order of their ranks, for searching; made once, by those groups that are
 * searched. */
static void sort(struct mpi_rank *r, struct mpi_group *g)
{
    g->order = mpi_take(r->world, g->size * (int64_t)sizeof *g->order);
    for (int i = 0; i < g->size; i++) g->order[i] = i;
    qsort_r(g->order, (size_t)g->size, sizeof *g->order, by_rank, g->list);
}

int mpi_group_find(struct mpi_rank *r, struct mpi_group *g, int world)
{
    /* Regular: the place follows from the step. Division rounds towards zero, so the
     * result is checked by multiplication. */
    if (!g->list) {
        if (g->size == 0) return MPI_UNDEFINED;
        int i = (world - g->first) / g->step;
        return i >= 0 && i < g->size && g->first + i * g->step == world ? i : MPI_UNDEFINED;
    }
    if (!g->order) sort(r, g);
    /* Binary search for the first position whose rank is not below. */
    int low = 0, high = g->size;
    while (low < high) {
        int middle = (low + high) / 2;
        if (g->list[g->order[middle]] < world) low = middle + 1;
        else high = middle;
    }
    return low < g->size && g->list[g->order[low]] == world ? g->order[low] : MPI_UNDEFINED;
}

/* The step of a regular list, 0: it is not regular. */
static int step_of(const int *list, int n)
{
    int step = n > 1 ? list[1] - list[0] : 1;
    if (step == 0) return 0;
    for (int i = 1; i < n; i++)
        if (list[i] - list[i - 1] != step) return 0;
    return step;
}

/* The list stays the caller's. Its ranks are all different, so a step of 0 can only mean
 * that it is irregular. */
struct mpi_group *mpi_group_make(struct mpi_rank *r, const int *list, int n)
{
    struct mpi_group *g = mpi_take_zero(r->world, sizeof *g);
    mpi_handle_make(r, g, KIND_GROUP);
    g->size = n;
    g->first = n ? list[0] : 0;
    g->step = step_of(list, n);
    if (g->step == 0) {
        g->list = mpi_take(r->world, n * (int64_t)sizeof *list);
        memcpy(g->list, list, (size_t)n * sizeof *list);
    }
    g->rank = mpi_group_find(r, g, r->rank);
    return g;
}

/* A group may be the program's and several communicators' at once, under one handle: so
 * the handle ends with the last use and not when the program frees it. */
void mpi_group_drop(struct mpi_rank *r, struct mpi_group *g)
{
    if (!g || g->o.number < 0 || --g->o.uses > 0) return; /* MPI_GROUP_EMPTY has no number */
    mpi_handle_end(r, g);
    mpi_give(r->world, g->list);
    mpi_give(r->world, g->order);
    mpi_give(r->world, g);
}

/* mpi_group_handle: of one more use. */
MPI_Group mpi_group_handle(struct mpi_group *g)
{
    g->o.uses++;
    return mpi_handle(g);
}

/* Takes the list over. An empty result is MPI_GROUP_EMPTY, as section 7.3.2 asks, so that
 * programs can compare with it. */
static int made(struct mpi_rank *r, int *list, int n, MPI_Group *newgroup)
{
    *newgroup = n ? mpi_handle(mpi_group_make(r, list, n)) : MPI_GROUP_EMPTY;
    mpi_give(r->world, list);
    return MPI_SUCCESS;
}

/* --- queries --- */

int mpi_group_size(struct mpi_rank *self, MPI_Group group, int *size)
{
    struct mpi_group *g = mpi_group_of(self, group);
    if (!g) return self->code;
    *size = g->size;
    return MPI_SUCCESS;
}

int mpi_group_rank(struct mpi_rank *self, MPI_Group group, int *rank)
{
    struct mpi_group *g = mpi_group_of(self, group);
    if (!g) return self->code;
    *rank = g->rank;
    return MPI_SUCCESS;
}

static bool bad_rank(struct mpi_rank *r, const struct mpi_group *g, int rank)
{
    if (rank >= 0 && rank < g->size) return false;
    r->code = mpi_error(r, NULL, MPI_ERR_RANK, "rank %d is not in the group of %d", rank, g->size);
    return true;
}

/* Ranks that are not in the second group become MPI_UNDEFINED; MPI_PROC_NULL stays what
 * it is (section 7.3.1). */
int mpi_group_translate_ranks(struct mpi_rank *self, MPI_Group group1, int n, const int ranks1[],
                              MPI_Group group2, int ranks2[])
{
    struct mpi_group *a = mpi_group_of(self, group1), *b = a ? mpi_group_of(self, group2) : NULL;
    if (!b) return self->code;
    for (int i = 0; i < n; i++) {
        if (ranks1[i] != MPI_PROC_NULL && bad_rank(self, a, ranks1[i])) return self->code;
        ranks2[i] = ranks1[i] == MPI_PROC_NULL
                        ? MPI_PROC_NULL
                        : mpi_group_find(self, b, mpi_group_world(a, ranks1[i]));
    }
    return MPI_SUCCESS;
}

/* Sizes are equal and ranks differ among themselves, so one group within the other means
 * the same set. */
int mpi_groups_compare(struct mpi_rank *r, struct mpi_group *a, struct mpi_group *b)
{
    int result = MPI_IDENT;
    if (a->size != b->size) return MPI_UNEQUAL;
    for (int i = 0; i < a->size; i++) {
        int found = mpi_group_find(r, b, mpi_group_world(a, i));
        if (found == MPI_UNDEFINED) return MPI_UNEQUAL;
        if (found != i) result = MPI_SIMILAR;
    }
    return result;
}

int mpi_group_compare(struct mpi_rank *self, MPI_Group group1, MPI_Group group2, int *result)
{
    struct mpi_group *a = mpi_group_of(self, group1), *b = a ? mpi_group_of(self, group2) : NULL;
    if (!b) return self->code;
    *result = mpi_groups_compare(self, a, b);
    return MPI_SUCCESS;
}

/* --- sets --- */

/* The ranks of a that are (or are not) in b, then where `rest` says so those of b that
 * are not in a. Section 7.3.2 fixes the order of the result: as in the first group, then
 * as in the second. O(n log n), since a member is searched for by bisection. */
static int combine(struct mpi_rank *r, MPI_Group first, MPI_Group second, bool take_common,
                   bool take_own, bool rest, MPI_Group *newgroup)
{
    struct mpi_group *a = mpi_group_of(r, first), *b = a ? mpi_group_of(r, second) : NULL;
    if (!b) return r->code;
    int n = 0, *list = mpi_take(r->world, (a->size + b->size + 1) * (int64_t)sizeof *list);
    for (int i = 0; i < a->size; i++) {
        int world = mpi_group_world(a, i);
        bool common = mpi_group_find(r, b, world) != MPI_UNDEFINED;
        if (common ? take_common : take_own) list[n++] = world;
    }
    for (int i = 0; rest && i < b->size; i++)
        if (mpi_group_find(r, a, mpi_group_world(b, i)) == MPI_UNDEFINED)
            list[n++] = mpi_group_world(b, i);
    return made(r, list, n, newgroup);
}

int mpi_group_union(struct mpi_rank *self, MPI_Group group1, MPI_Group group2, MPI_Group *newgroup)
{
    return combine(self, group1, group2, true, true, true, newgroup);
}

int mpi_group_intersection(struct mpi_rank *self, MPI_Group group1, MPI_Group group2,
                           MPI_Group *newgroup)
{
    return combine(self, group1, group2, true, false, false, newgroup);
}

int mpi_group_difference(struct mpi_rank *self, MPI_Group group1, MPI_Group group2,
                         MPI_Group *newgroup)
{
    return combine(self, group1, group2, false, true, false, newgroup);
}

/* --- by lists of ranks --- */

/* choose: the n named ranks in their order, or all others in the group's. A rank named
 * twice is an error. One mark for each rank finds those named twice, in O(n). */
static int choose(struct mpi_rank *r, struct mpi_group *g, int n, const int *ranks, bool named,
                  MPI_Group *newgroup)
{
    if (n < 0) return mpi_error(r, NULL, MPI_ERR_ARG, "%d ranks", n);
    char *mark = mpi_take_zero(r->world, g->size + 1);
    int m = 0, *list = mpi_take(r->world, (g->size + 1) * (int64_t)sizeof *list);
    for (int i = 0; i < n; i++) {
        bool bad = bad_rank(r, g, ranks[i]);
        if (!bad && mark[ranks[i]]) {
            r->code = mpi_error(r, NULL, MPI_ERR_RANK, "rank %d is named twice", ranks[i]);
            bad = true;
        }
        if (bad) {
            mpi_give(r->world, list);
            mpi_give(r->world, mark);
            return r->code;
        }
        mark[ranks[i]] = 1;
        if (named) list[m++] = mpi_group_world(g, ranks[i]);
    }
    /* Ranks that are left keep their order (MPI_Group_excl). */
    for (int i = 0; !named && i < g->size; i++)
        if (!mark[i]) list[m++] = mpi_group_world(g, i);
    mpi_give(r->world, mark);
    return made(r, list, m, newgroup);
}

int mpi_group_incl(struct mpi_rank *self, MPI_Group group, int n, const int ranks[],
                   MPI_Group *newgroup)
{
    struct mpi_group *g = mpi_group_of(self, group);
    return g ? choose(self, g, n, ranks, true, newgroup) : self->code;
}

int mpi_group_excl(struct mpi_rank *self, MPI_Group group, int n, const int ranks[],
                   MPI_Group *newgroup)
{
    struct mpi_group *g = mpi_group_of(self, group);
    return g ? choose(self, g, n, ranks, false, newgroup) : self->code;
}

/* Ranges are (first, last, step); all their ranks one behind the other. */
static int choose_ranges(struct mpi_rank *r, MPI_Group group, int n, int ranges[][3], bool named,
                         MPI_Group *newgroup)
{
    struct mpi_group *g = mpi_group_of(r, group);
    if (!g) return r->code;
    if (n < 0) return mpi_error(r, NULL, MPI_ERR_ARG, "%d ranges", n);
    /* A range's ranks are listed, and the list is chosen: both rules are written once. A
     * list longer than the group names a rank twice, so it need not go on. */
    int m = 0, *ranks = mpi_take(r->world, (g->size + 1) * (int64_t)sizeof *ranks);
    for (int i = 0; i < n; i++) {
        int first = ranges[i][0], last = ranges[i][1], step = ranges[i][2];
        bool bad = step == 0;
        /* wider than an int: a rank and a step may be more than one holds */
        for (int64_t k = first; !bad && (step > 0 ? k <= last : k >= last); k += step) {
            bad = m == g->size || k < 0 || k >= g->size;
            if (!bad) ranks[m++] = (int)k;
        }
        if (bad) {
            mpi_give(r->world, ranks);
            return mpi_error(r, NULL, MPI_ERR_ARG, "range %d: (%d, %d, %d) in a group of %d", i,
                             first, last, step, g->size);
        }
    }
    int code = choose(r, g, m, ranks, named, newgroup);
    mpi_give(r->world, ranks);
    return code;
}

int mpi_group_range_incl(struct mpi_rank *self, MPI_Group group, int n, int ranges[][3],
                         MPI_Group *newgroup)
{
    return choose_ranges(self, group, n, ranges, true, newgroup);
}

int mpi_group_range_excl(struct mpi_rank *self, MPI_Group group, int n, int ranges[][3],
                         MPI_Group *newgroup)
{
    return choose_ranges(self, group, n, ranges, false, newgroup);
}

/* Communicators that consist of the group keep it. */
int mpi_group_free(struct mpi_rank *self, MPI_Group *group)
{
    struct mpi_group *g = mpi_group_of(self, *group);
    if (!g) return self->code;
    mpi_group_drop(self, g);
    *group = MPI_GROUP_NULL;
    return MPI_SUCCESS;
}
