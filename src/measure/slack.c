/* slack.c - see slack.h.
 *
 * One pass from the last node to the first: a node is numbered after all that it follows from, so
 * when its turn comes, everything that follows from it has said how long it can wait. */
#include "measure/slack.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "measure/path_log.h"

/* The losers of each node as lists, since they are stored in the order in which they were found. */
static uint32_t *lists_of(const struct path_log *p, uint32_t **next)
{
    uint32_t *head = memory_zeroed((size_t)p->n, sizeof *head);
    *next = memory_zeroed((size_t)p->nloser + 1, sizeof **next);
    /* Entry i has number i + 1; 0 ends a list. */
    for (int64_t i = 0; i < p->nloser; i++) {
        (*next)[i] = head[p->loser[i].joined];
        head[p->loser[i].joined] = (uint32_t)(i + 1);
    }
    return head;
}

/* `slack` of a node becomes at most `most`. */
static void lower(int64_t *slack, int64_t most)
{
    if (most < *slack) *slack = most;
}

int64_t *slack_of(const struct path_log *p, int n, const uint32_t *end)
{
    int64_t *slack = memory_take((size_t)p->n, sizeof *slack), makespan = 0;
    uint32_t *next, *head = lists_of(p, &next);
    for (int64_t k = 0; k < p->n; k++) slack[k] = INT64_MAX;
    for (int i = 0; i < n; i++)
        if (p->node[end[i]].time > makespan) makespan = p->node[end[i]].time;
    /* A rank that ends early may end later. */
    for (int i = 0; i < n; i++) lower(&slack[end[i]], makespan - p->node[end[i]].time);
    for (int64_t k = p->n - 1; k > 0; k--) {
        if (slack[k] == INT64_MAX) continue;
        const struct path_node *x = &p->node[k];
        /* What binds moves it by as much; what came earlier only once its lead is used up. */
        lower(&slack[x->before], slack[k]);
        for (uint32_t i = head[k]; i != 0; i = next[i - 1]) {
            const struct path_loser *l = &p->loser[i - 1];
            const int64_t lead = x->time - l->lag - p->node[l->loser].time;
            lower(&slack[l->loser], slack[k] + (lead > 0 ? lead : 0));
        }
    }
    free(head);
    free(next);
    return slack;
}

/* For qsort; equal times in one order, so that the table is always the same. */
static int longer_row(const void *a, const void *b)
{
    const struct slack_row *x = a, *y = b;
    if (x->time_ps != y->time_ps) return x->time_ps < y->time_ps ? 1 : -1;
    return x->stage != y->stage ? x->stage - y->stage : (int)x->cause - (int)y->cause;
}

/* Cells of all stages and causes first, which a node finds by its number. */
struct slack_row *slack_rows(const struct path_log *p, const int64_t *slack, int64_t makespan,
                             int *n, struct arena *a)
{
    enum { STAGES = 256, CELLS = STAGES * PATH_CAUSES }; /* path_node.stage is a byte */
    struct slack_row *cell = memory_zeroed(CELLS, sizeof *cell);
    for (int64_t k = 1; k < p->n; k++) {
        const struct path_node *x = &p->node[k];
        const int64_t time = x->time - p->node[x->before].time;
        /* Where two times meet stands a node that takes none: nobody does anything there. */
        if (time == 0) continue;
        struct slack_row *c = &cell[x->stage * PATH_CAUSES + x->cause];
        if (c->steps++ == 0)
            *c = (struct slack_row){.cause = (enum path_cause)x->cause,
                                    .stage = x->stage,
                                    .steps = 1,
                                    .least_ps = INT64_MAX};
        c->time_ps += time;
        c->critical_ps += slack[k] == 0 ? time : 0;
        c->near_ps += slack[k] <= makespan / SLACK_NEAR ? time : 0;
        if (slack[k] > 0) lower(&c->least_ps, slack[k]);
    }
    /* Of very many possible rows a run has a few dozen. */
    qsort(cell, CELLS, sizeof *cell, longer_row);
    for (*n = 0; *n < CELLS && cell[*n].steps > 0;) ++*n;
    struct slack_row *row = TAKE(a, *n > 0 ? *n : 1, struct slack_row);
    memcpy(row, cell, (size_t)*n * sizeof *row);
    free(cell);
    return row;
}

/* What a rank does itself; the rest happens to its messages. Its turn at a kernel server is a node
 * that takes no time, from which the server is busy for it. */
static bool is_of_rank(const struct path_node *x, int64_t time)
{
    if (time == 0) return x->cause == PATH_SERVER;
    return x->cause == PATH_COMPUTE || x->cause == PATH_SEND || x->cause == PATH_RECV ||
           x->cause == PATH_POLL;
}

/* A rank that could be later everywhere but in one place cannot be later there. */
int64_t *slack_ranks(const struct path_log *p, const int64_t *slack, int nrank, int nstage,
                     struct arena *a)
{
    int64_t *least = TAKE(a, size_product(nrank, nstage), int64_t);
    for (int64_t i = 0; i < (int64_t)nrank * nstage; i++) least[i] = INT64_MAX;
    for (int64_t k = 1; k < p->n; k++) {
        const struct path_node *x = &p->node[k];
        if (!is_of_rank(x, x->time - p->node[x->before].time)) continue;
        CHECK(x->rank < nrank && x->stage < nstage);
        lower(&least[(int64_t)x->rank * nstage + x->stage], slack[k]);
    }
    return least;
}
