/* timed_world.h - runs of programs that ask for time, on crossbar.h. */
#ifndef TESTS_VP_TIMED_WORLD_H
#define TESTS_VP_TIMED_WORLD_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "vp/world.h"

#include "crossbar.h"

static const char *const stage_name[] = {"work"};

static inline int64_t trip(int64_t bytes)
{
    return 2400000 + 1000 * bytes + 1000 * (bytes > 0 ? bytes - 1 : 0);
}
static inline int64_t receipt(int64_t bytes) { return 3000000 + 2000 * bytes; }

enum { US = 1000000 };

struct outcome {
    struct arena *arena;
    struct run_result r;
};

static inline struct outcome run_load(const struct machine_spec *m, struct world_load load)
{
    struct outcome o = {.arena = arena_create()};
    struct record_spec record = {.spans = false};
    struct err e;
    err_clear(&e);
    load.nstage = 1;
    load.stage_name = stage_name;
    load.largest_message = -1;
    if (!world_run(m, &load, &record, 1, o.arena, &o.r, &e)) fail_msg("%s", e.text);
    return o;
}

static inline struct outcome go(const struct machine_spec *m, int nrank, world_program *program,
                                void *context)
{
    return run_load(m, (struct world_load){.nrank = nrank,
                                           .program = program,
                                           .context = context,
                                           .timed = true,
                                           .foreign = true});
}

static inline void expect_ok(const struct outcome *o)
{
    if (o->r.status != RUN_OK) fail_msg("%s", o->r.text);
}

#endif
