/* schedule.c - schedules are put together: operations and dependencies as they come, then in order.
 */
#include "schedule/schedule.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/size.h"

/* Doubling: each entry is copied about once in all, and memory peaks at three times the
 * list for a moment. */
/* ---- while it is read: growing lists on the heap, since nothing says how many will come ---- */

static void *grown(void *list, int64_t *capacity, size_t size)
{
    const int64_t n = *capacity > 0 ? 2 * *capacity : 1024;
    const size_t bytes = size_product((size_t)n, size);
    void *more = memory_resize(list, bytes, 1);
    *capacity = n;
    return more;
}

void schedule_begin(struct schedule_builder *b, int nrank)
{
    *b = (struct schedule_builder){.s.nrank = nrank, .s.ncpu = 1};
    b->begin = memory_zeroed((size_t)nrank, sizeof *b->begin);
    b->end = memory_zeroed((size_t)nrank, sizeof *b->end);
    /* -1 says that the rank has not come yet. */
    for (int i = 0; i < nrank; i++) b->begin[i] = b->end[i] = -1;
}

/* The limit keeps an operation's number within a rank in 31 bits, beside the bit of
 * schedule.edge. */
int64_t schedule_add_op(struct schedule_builder *b, const struct schedule_op *op)
{
    struct schedule *s = &b->s;
    if (s->nop == SCHEDULE_MOST_OPERATIONS) return -1;
    if (s->nop == b->op_capacity) s->op = grown(s->op, &b->op_capacity, sizeof *s->op);
    s->op[s->nop] = *op;
    if (op->cpu >= s->ncpu) s->ncpu = op->cpu + 1;
    return s->nop++;
}

bool schedule_add_dependency(struct schedule_builder *b, int64_t op, int64_t on, bool start)
{
    /* Twice as many as operations; beyond that readers refuse the file. */
    if (b->ndependency == 2 * (int64_t)SCHEDULE_MOST_OPERATIONS) return false;
    if (b->ndependency == b->dependency_capacity)
        b->dependency = grown(b->dependency, &b->dependency_capacity, sizeof *b->dependency);
    b->dependency[b->ndependency++] = (struct schedule_dependency){op, on, start};
    return true;
}

void schedule_discard(struct schedule_builder *b)
{
    free(b->s.op);
    free(b->begin);
    free(b->end);
    free(b->dependency);
    *b = (struct schedule_builder){0};
}

/* ---- in order ---- */

/* Ranks in their order; `moved` is where each operation went. */
static void order_ranks(const struct schedule_builder *b, struct schedule *s, int64_t *moved)
{
    /* Readers number operations as they stand in the file; from here on a rank's follow
     * each other, in the order of ranks. */
    int64_t n = 0;
    for (int r = 0; r < s->nrank; r++) {
        s->first[r] = n;
        for (int64_t i = b->begin[r]; i < b->end[r]; i++) {
            s->op[n] = b->s.op[i];
            moved[i] = n++;
        }
    }
    s->first[s->nrank] = n;
}

/* The rank of an operation, found by halves. The last rank that begins at or before it;
 * empty ranks begin where the next one does. */
static int rank_of(const struct schedule *s, int64_t op)
{
    int low = 0, high = s->nrank;
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        if (s->first[middle] <= op) low = middle;
        else high = middle;
    }
    return low;
}

/* A counting sort by what is waited for: how many wait for each, where these begin, and then each
 * to its place. */
static void order_dependencies(const struct schedule_builder *b, struct schedule *s,
                               const int64_t *moved)
{
    /* Linear, and stable: those that wait for one operation stay in the order of the
     * file, so that runs of one file are the same. */
    for (int64_t i = 0; i < b->ndependency; i++) s->edge_first[moved[b->dependency[i].on] + 1]++;
    for (int64_t i = 0; i < s->nop; i++) s->edge_first[i + 1] += s->edge_first[i];
    int64_t *at = memory_take((size_t)s->nop + 1, sizeof *at);
    memcpy(at, s->edge_first, ((size_t)s->nop + 1) * sizeof *at);
    for (int64_t i = 0; i < b->ndependency; i++) {
        const struct schedule_dependency *d = &b->dependency[i];
        const int64_t op = moved[d->op], on = moved[d->on], first = s->first[rank_of(s, on)];
        /* Numbers within the rank need 32 bits with the bit for `start`; 64 would double
         * the largest array. */
        s->edge[at[on]++] = (uint32_t)(op - first) << 1 | d->start;
        s->op[op].needs++;
    }
    free(at);
}

/* Operations are taken away that require nothing that is left, until none is (Kahn 1962); what then
 * remains waits for itself. A list instead of calls: no depth that a file could choose. */
static int64_t left_in_circles(const struct schedule *s, int64_t *some)
{
    /* A copy: the schedule stays as it was read. */
    int32_t *needs = memory_take((size_t)s->nop + 1, sizeof *needs);
    int64_t *list = memory_take((size_t)s->nop + 1, sizeof *list), n = 0, done = 0;
    for (int64_t i = 0; i < s->nop; i++) {
        needs[i] = s->op[i].needs;
        if (needs[i] == 0) list[n++] = i;
    }
    for (; done < n; done++) {
        const int64_t first = s->first[rank_of(s, list[done])];
        for (int64_t k = s->edge_first[list[done]]; k < s->edge_first[list[done] + 1]; k++) {
            const int64_t op = first + (s->edge[k] >> 1);
            if (--needs[op] == 0) list[n++] = op;
        }
    }
    /* What still has needs lies on a circle or behind one; the first of them is told. */
    for (*some = 0; *some < s->nop && needs[*some] == 0;) ++*some;
    free(needs);
    free(list);
    return s->nop - n;
}

struct schedule *schedule_finish(struct schedule_builder *b, const char *path, struct arena *a,
                                 struct err *e)
{
    struct schedule *s = TAKE(a, 1, struct schedule);
    int64_t *moved = memory_take((size_t)b->s.nop + 1, sizeof *moved), some;
    /* Arrays of the builder are on the heap and end with it: these are copies in the
     * caller's arena, of the exact length. */
    *s = b->s;
    s->nedge = b->ndependency;
    s->op = TAKE(a, s->nop + 1, struct schedule_op);
    s->first = TAKE(a, s->nrank + 1, int64_t);
    s->edge_first = TAKE(a, s->nop + 1, int64_t);
    s->edge = TAKE(a, s->nedge + 1, uint32_t);
    order_ranks(b, s, moved);
    order_dependencies(b, s, moved);
    free(moved);
    const int64_t circle = left_in_circles(s, &some);
    if (circle == 0) return s;
    err_set_at(e, ERR_DATA, path, s->op[some].line,
               "%lld operations of the schedule wait for each other in circles; the first of them "
               "is number %lld of rank %d",
               (long long)circle, (long long)(some - s->first[rank_of(s, some)]), rank_of(s, some));
    return NULL;
}
