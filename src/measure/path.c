/* path.c - the graph as one growing array, 32 bytes a node; see path.h. */
#include "measure/path.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/size.h"
#include "measure/path_log.h"

/* From the one list of causes. */
const char *path_cause_word(enum path_cause cause)
{
    static const char *const word[] = {
#define X(constant, word, doc) word,
        PATH_CAUSES_LIST(X)
#undef X
    };
    return word[cause];
}

/* Doubled, so that adding a node costs a constant on average. */
static void *grown(void *old, int64_t *capacity, size_t each)
{
    *capacity = *capacity > 0 ? 2 * *capacity : 1024;
    void *p = memory_resize(old, size_product(*capacity, each), 1);
    return p;
}

/* The first node is the start of the run, which has no node before it. */
struct path_log *path_log_create(void)
{
    struct path_log *p = memory_zeroed(1, sizeof *p);
    p->node = grown(NULL, &p->capacity, sizeof *p->node);
    p->node[p->n++] = (struct path_node){.cause = PATH_START, .resource = -1};
    return p;
}

void path_log_destroy(struct path_log *p)
{
    if (p == NULL) return;
    free(p->node);
    free(p->work);
    free(p->loser);
    free(p);
}

uint32_t path_add(struct path_log *p, uint32_t before, int64_t time, enum path_cause cause,
                  int rank, int stage, int resource, int64_t count)
{
    /* Causes come before effects, or the path would not end. */
    CHECK(before < p->n && p->node[before].time <= time);
    /* What takes no time binds nobody. */
    if (p->node[before].time == time) return before;
    if (p->n == p->capacity) p->node = grown(p->node, &p->capacity, sizeof *p->node);
    /* numbers of nodes have 32 bits */
    CHECK(p->n < UINT32_MAX);
    /* Only now: growing may have moved the array. */
    const struct path_node *b = &p->node[before];
    /* A rank or stage that is not given is that of the node before. */
    const struct path_node made = {.time = time,
                                   .count = count,
                                   .before = before,
                                   .rank = rank >= 0 ? rank : b->rank,
                                   .resource = resource,
                                   .cause = (uint8_t)cause,
                                   .stage = stage >= 0 ? (uint8_t)stage : b->stage};
    p->node[p->n] = made;
    return (uint32_t)p->n++;
}

uint32_t path_add_work(struct path_log *p, uint32_t before, int64_t time, int rank, int stage,
                       const struct work *w)
{
    const int64_t n = p->n;
    const uint32_t made = path_add(p, before, time, PATH_COMPUTE, rank, stage, -1, p->nwork);
    if (p->n == n) return made; /* it took no time */
    /* Work lies apart: of the nodes only those of computing have any. */
    if (p->nwork == p->work_capacity) p->work = grown(p->work, &p->work_capacity, sizeof *p->work);
    p->work[p->nwork++] = *w;
    return made;
}

/* Asked for before the first node is made. */
void path_keep_losers(struct path_log *p) { p->keeps_losers = true; }

bool path_keeps_losers(const struct path_log *p) { return p->keeps_losers; }

/* A loser has a lower number than what waits for it: slack.c goes through them once. */
void path_lose(struct path_log *p, uint32_t loser, uint32_t joined, int64_t lag)
{
    if (!p->keeps_losers) return;
    CHECK(loser < joined && joined < p->n);
    if (p->nloser == p->loser_capacity)
        p->loser = grown(p->loser, &p->loser_capacity, sizeof *p->loser);
    /* lists of them are chained by numbers of 32 bits (slack.c) */
    CHECK(p->nloser < UINT32_MAX);
    p->loser[p->nloser++] = (struct path_loser){.loser = loser, .joined = joined, .lag = lag};
}

/* A node of its own, although it takes no time: what follows from `winner` elsewhere need not wait
 * for the loser. */
uint32_t path_join(struct path_log *p, uint32_t winner, uint32_t loser, int64_t lag,
                   enum path_cause cause, int rank, int stage)
{
    if (!p->keeps_losers) return winner;
    if (p->n == p->capacity) p->node = grown(p->node, &p->capacity, sizeof *p->node);
    CHECK(p->n < UINT32_MAX && winner < p->n);
    const struct path_node *b = &p->node[winner];
    const struct path_node made = {.time = b->time,
                                   .before = winner,
                                   .rank = rank >= 0 ? rank : b->rank,
                                   .resource = -1,
                                   .cause = (uint8_t)cause,
                                   .stage = stage >= 0 ? (uint8_t)stage : b->stage};
    p->node[p->n] = made;
    const uint32_t joined = (uint32_t)p->n++;
    path_lose(p, loser, joined, lag);
    return joined;
}

void path_owner(const struct path_log *p, uint32_t node, int *rank, int *stage)
{
    *rank = p->node[node].rank;
    *stage = p->node[node].stage;
}

int64_t path_time(const struct path_log *p, uint32_t node) { return p->node[node].time; }

int64_t path_nodes(const struct path_log *p) { return p->n; }

/* What is reserved, not what is used: it is what the process pays for. */
int64_t path_bytes(const struct path_log *p)
{
    return p->capacity * (int64_t)sizeof *p->node + p->work_capacity * (int64_t)sizeof *p->work +
           p->loser_capacity * (int64_t)sizeof *p->loser;
}

/* Back along what binds, which may lead through other ranks. */
uint32_t path_at(const struct path_log *p, uint32_t node, int64_t time)
{
    while (p->node[node].time > time) node = p->node[node].before;
    return node;
}

/* A node at which times meet takes none, and is no step. */
static bool is_step(const struct path_log *p, uint32_t k)
{
    return p->node[k].time > p->node[p->node[k].before].time;
}

struct path_step *path_trace(const struct path_log *p, uint32_t node, int64_t *n, struct arena *a)
{
    /* The chain is known from its end: count it, then fill the steps from the last to the first. */
    int64_t count = 0;
    for (uint32_t k = node; k != 0; k = p->node[k].before) count += is_step(p, k);
    struct path_step *step = TAKE(a, count > 0 ? count : 1, struct path_step);
    *n = count;
    for (uint32_t k = node; k != 0; k = p->node[k].before) {
        if (!is_step(p, k)) continue;
        const struct path_node *x = &p->node[k];
        struct path_step *s = &step[--count];
        /* of computing, `count` is where its work lies; of the rest how often it was paid */
        const bool counted = x->cause == PATH_COMPUTE && x->count >= 0;
        *s = (struct path_step){.begin_ps = p->node[x->before].time,
                                .end_ps = x->time,
                                .cause = (enum path_cause)x->cause,
                                .rank = x->rank,
                                .stage = x->stage,
                                .resource = x->resource,
                                .count = counted ? 0 : x->count};
        if (counted) s->work = p->work[x->count];
    }
    return step;
}
