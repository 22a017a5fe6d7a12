/* comm_serial.c - one rank, nobody to talk to. */
#include "comm/comm_serial.h"

#include <string.h>

#include "base/check.h"

static void no_isend(struct comm *c, int dst, int tag, const void *data, int64_t bytes, struct comm_request *r)
{
    (void)tag, (void)data, (void)bytes, (void)r;
    CHECK(dst < c->size && dst != c->rank);
}

static void no_irecv(struct comm *c, int src, int tag, void *buffer, int64_t bytes, struct comm_request *r)
{
    (void)tag, (void)buffer, (void)bytes, (void)r;
    CHECK(src < c->size && src != c->rank);
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
};

struct comm_serial comm_serial_make(void)
{
    struct comm_serial s;
    memset(&s, 0, sizeof s);
    s.comm = (struct comm){.type = &serial_type, .rank = 0, .size = 1};
    return s;
}
