/* comm_serial.c - one rank, nobody to talk to. */
#include "comm/comm_serial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"

static void no_isend(struct comm *c, int dst, int64_t tag, const void *data, int64_t bytes,
                     struct comm_request *r)
{
    (void)tag, (void)data, (void)bytes, (void)r;
    CHECK(dst >= 0 && dst < c->size && dst != c->rank);
}

static void no_irecv(struct comm *c, int src, int64_t tag, void *buffer, int64_t bytes,
                     struct comm_request *r)
{
    (void)tag, (void)buffer, (void)bytes, (void)r;
    CHECK(src >= 0 && src < c->size && src != c->rank);
}

static void no_wait(struct comm *c, struct comm_request *r)
{
    (void)c;
    CHECK(!r->active);
}

static void no_barrier(struct comm *c) { (void)c; }

static void count_work(struct comm *c, const struct work *w)
{
    struct comm_serial *s = (struct comm_serial *)c;
    work_add(&s->work[s->stage], w);
}

static void set_stage(struct comm *c, int stage)
{
    CHECK(stage >= 0 && stage < COMM_SERIAL_STAGES);
    ((struct comm_serial *)c)->stage = stage;
}

/* A message from anywhere can never come. */
static void no_irecv_matching(struct comm *c, int src, int64_t tag, int64_t mask, void *buffer,
                              int64_t capacity, struct comm_request *r)
{
    (void)src, (void)tag, (void)mask, (void)buffer, (void)capacity, (void)r;
    CHECK(c->size > 1);
}

/* No request is ever active. */
static int no_completion(struct comm *c, int n, struct comm_request *const *r, int block)
{
    (void)c, (void)block;
    for (int i = 0; i < n; i++) CHECK(!r[i] || !r[i]->active);
    return -1;
}

static int no_probe(struct comm *c, int src, int64_t tag, int64_t mask, int block,
                    struct comm_envelope *out, struct comm_request *take)
{
    (void)c, (void)src, (void)tag, (void)mask, (void)out, (void)take;
    CHECK(!block);
    return 0;
}

static void no_receive_into(struct comm *c, struct comm_request *r, void *buffer, int64_t capacity)
{
    (void)buffer, (void)capacity;
    no_wait(c, r);
}

static int no_cancel(struct comm *c, struct comm_request *r)
{
    no_wait(c, r);
    return 0;
}

static struct comm_request *nothing_complete(struct comm *c, int64_t time_ps)
{
    (void)c, (void)time_ps;
    return NULL;
}

static void no_time(struct comm *c, int64_t ps)
{
    (void)c;
    CHECK(ps >= 0);
}

static void end_process(struct comm *c, const char *text)
{
    fprintf(stderr, "%s:%d: %s\n", c->file ? c->file : "?", c->line, text);
    abort();
}

static int64_t no_clock(struct comm *c)
{
    (void)c;
    return 0;
}

static const struct comm_type serial_type = {
    .name = "serial",
    .isend = no_isend,
    .irecv = no_irecv,
    .wait = no_wait,
    .barrier = no_barrier,
    .work = count_work,
    .stage = set_stage,
    .now_ps = no_clock,
    .publish = comm_publish_here,
    .elapse = no_time,
    .end_run = end_process,
    .isend_synchronous = no_isend,
    .irecv_matching = no_irecv_matching,
    .complete_any = no_completion,
    .probe = no_probe,
    .receive_into = no_receive_into,
    .cancel = no_cancel,
    .watch = no_wait,
    .next_complete = nothing_complete,
};

struct comm_serial comm_serial_make(void)
{
    struct comm_serial s;
    memset(&s, 0, sizeof s);
    s.comm = (struct comm){.type = &serial_type, .rank = 0, .size = 1};
    return s;
}
