/* many_ranks.c - many ranks without a simulator (many_ranks.h). */
#include "many_ranks.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "sim/fiber.h"

enum { STACK_BYTES = 65536, SMALL = 1024, CLOCKS = 2 /* rounds, bytes */ };

struct message {
    struct message *next;
    int src, tag;
    int64_t bytes, there[CLOCKS];
    char data[];
};

struct rank {
    struct comm comm; /* first */
    struct many_ranks *all;
    struct fiber *fiber;
    struct message *first, **end; /* arrived, not yet received, in order */
    struct comm_request *awaited; /* the receive that this rank sleeps for */
    bool in_barrier, done;
    int stage;
    int64_t clock[CLOCKS], out_free[CLOCKS], in_free[CLOCKS];
    struct rank *next_ready;
};

struct many_ranks {
    int n, entered, done;
    struct rank *rank;
    struct fiber_pool *pool;
    struct rank *ready, **ready_end;
    struct message *spare; /* of SMALL bytes */
    many_ranks_program *program;
    void *context;
    struct many_ranks_result result;
};

static void make_ready(struct many_ranks *all, struct rank *r)
{
    r->next_ready = NULL;
    *all->ready_end = r;
    all->ready_end = &r->next_ready;
}

static struct message *message_take(struct many_ranks *all, int64_t bytes)
{
    struct message *m = all->spare;
    if (bytes > SMALL) return malloc(sizeof *m + (size_t)bytes);
    if (!m) return malloc(sizeof *m + SMALL);
    all->spare = m->next;
    return m;
}

static void message_give(struct many_ranks *all, struct message *m)
{
    if (m->bytes > SMALL) {
        free(m);
        return;
    }
    m->next = all->spare;
    all->spare = m;
}

static int64_t later(int64_t a, int64_t b) { return a > b ? a : b; }

/* When the message is there if it leaves after those before it. */
static void depart(struct rank *self, int64_t bytes, int64_t there[CLOCKS])
{
    for (int k = 0; k < CLOCKS; k++)
        there[k] = self->out_free[k] =
            later(self->clock[k], self->out_free[k]) + (k == 0 ? 1 : bytes);
}

static void deliver(struct rank *to, struct comm_request *r, const void *data, int64_t bytes,
                    const int64_t there[CLOCKS])
{
    CHECK(bytes == r->bytes);
    if (bytes > 0) memcpy(r->buffer, data, (size_t)bytes);
    r->active = 0;
    for (int k = 0; k < CLOCKS; k++)
        to->clock[k] = to->in_free[k] =
            later(later(to->clock[k], there[k]), to->in_free[k] + (k == 0 ? 1 : bytes));
}

static void send_now(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                     struct comm_request *r)
{
    struct rank *self = (struct rank *)c;
    struct many_ranks *all = self->all;
    CHECK(dst >= 0 && dst < all->n && dst != c->rank && tag >= 0 && bytes >= 0);
    struct rank *to = &all->rank[dst];
    all->result.messages++;
    all->result.bytes += bytes;
    all->result.stage_messages[self->stage]++;
    all->result.stage_bytes[self->stage] += bytes;
    if (r) r->active = 0;
    int64_t there[CLOCKS];
    depart(self, bytes, there);
    if (to->awaited && to->awaited->peer == c->rank && to->awaited->tag == tag) {
        deliver(to, to->awaited, data, bytes, there);
        to->awaited = NULL;
        make_ready(all, to);
        return;
    }
    struct message *m = message_take(all, bytes);
    m->next = NULL;
    m->src = c->rank, m->tag = (int)tag, m->bytes = bytes;
    memcpy(m->there, there, sizeof there);
    if (bytes > 0) memcpy(m->data, data, (size_t)bytes);
    *to->end = m;
    to->end = &m->next;
}

static void post_receive(struct comm *c, int src, int64_t tag, void *buffer, int64_t bytes,
                         struct comm_request *r)
{
    CHECK(src >= 0 && src < c->size && src != c->rank && tag >= 0 && bytes >= 0);
    *r = (struct comm_request){
        .buffer = buffer, .bytes = bytes, .peer = src, .tag = tag, .active = 1};
}

static void wait_for(struct comm *c, struct comm_request *r)
{
    struct rank *self = (struct rank *)c;
    if (!r->active) return;
    for (struct message **at = &self->first; *at; at = &(*at)->next) {
        struct message *m = *at;
        if (m->src != r->peer || m->tag != r->tag) continue;
        *at = m->next;
        if (!m->next) self->end = at;
        deliver(self, r, m->data, m->bytes, m->there);
        message_give(self->all, m);
        return;
    }
    self->awaited = r;
    fiber_leave(self->fiber);
}

static void barrier_now(struct comm *c)
{
    struct rank *self = (struct rank *)c;
    struct many_ranks *all = self->all;
    if (++all->entered < all->n) {
        self->in_barrier = true;
        fiber_leave(self->fiber);
        return;
    }
    all->entered = 0;
    for (int k = 0; k < all->n; k++) {
        if (!all->rank[k].in_barrier) continue;
        all->rank[k].in_barrier = false;
        make_ready(all, &all->rank[k]);
    }
}

static void count_work(struct comm *c, const struct work *w)
{
    struct rank *self = (struct rank *)c;
    work_add(&self->all->result.stage_work[self->stage], w);
    self->all->result.reports++;
}

static void set_stage(struct comm *c, int stage)
{
    CHECK(stage >= 0 && stage < MANY_RANKS_STAGES);
    ((struct rank *)c)->stage = stage;
}

static int64_t no_clock(struct comm *c)
{
    (void)c;
    return 0;
}

static const struct comm_type many_ranks_type = {
    .name = "many ranks",
    .isend = send_now,
    .irecv = post_receive,
    .wait = wait_for,
    .barrier = barrier_now,
    .work = count_work,
    .stage = set_stage,
    .now_ps = no_clock,
    .publish = comm_publish_here,
};

static void start(void *argument)
{
    struct rank *self = argument;
    self->all->program(&self->comm, self->all->context);
    self->done = true;
    self->all->done++;
}

/* give_back: everything taken; counts unread messages. */
static void give_back(struct many_ranks *all)
{
    for (int k = 0; k < all->n; k++) {
        all->result.rounds = later(all->result.rounds, all->rank[k].clock[0]);
        all->result.path = later(all->result.path, all->rank[k].clock[1]);
        for (struct message *m = all->rank[k].first, *next; m; m = next) {
            next = m->next;
            message_give(all, m);
            all->result.unread++;
        }
    }
    for (struct message *m = all->spare, *next; m; m = next) {
        next = m->next;
        free(m);
    }
    fiber_pool_destroy(all->pool);
    free(all->rank);
}

struct many_ranks_result many_ranks_run(int nrank, many_ranks_program *program, void *context)
{
    return many_ranks_publishing(nrank, program, context, NULL, 0);
}

struct many_ranks_result many_ranks_publishing(int nrank, many_ranks_program *program,
                                               void *context, const struct comm_output *output,
                                               int noutput)
{
    struct err e = {0};
    struct many_ranks all = {.n = nrank, .program = program, .context = context};
    all.rank = calloc((size_t)nrank, sizeof *all.rank);
    all.pool = fiber_pool_create(nrank, STACK_BYTES, &e);
    CHECK(all.rank && all.pool);
    all.ready_end = &all.ready;
    for (int k = 0; k < nrank; k++) {
        struct rank *r = &all.rank[k];
        r->comm = (struct comm){
            .type = &many_ranks_type, .rank = k, .size = nrank, .output = output,
            .noutput = noutput};
        r->all = &all;
        r->end = &r->first;
        r->fiber = fiber_start(all.pool, k, start, r);
        make_ready(&all, r);
    }
    while (all.ready) {
        struct rank *r = all.ready;
        all.ready = r->next_ready;
        if (!all.ready) all.ready_end = &all.ready;
        fiber_enter(r->fiber);
    }
    all.result.blocked = nrank - all.done;
    int overflowed;
    all.result.stack_bytes = fiber_pool_stack_peak(all.pool, &overflowed);
    CHECK(overflowed < 0);
    give_back(&all);
    return all.result;
}
