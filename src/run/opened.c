/* opened.c - programs of runs, found, opened and closed, and what runs share (run.h). */
#include <stdlib.h>

#include "base/check.h"
#include "base/memory.h"
#include "guest/guest_program.h"
#include "kernel/programs.h"
#include "run/part_hosts.h"
#include "run/run_parts.h"
#include "schedule/schedule_program.h"
#include "sim/fiber.h"

struct run_cache *run_cache_create(void)
{
    /* Arenas grow with the first run and stay for the next. */
    struct run_cache *c = memory_zeroed(1, sizeof *c);
    c->own = arena_create();
    c->scratch = arena_create();
    c->world = arena_create();
    c->packs = fiber_packs();
    return c;
}

void run_cache_repeat(struct run_cache *c, bool at_once) { c->tapes = tapes_create(at_once); }

void run_cache_destroy(struct run_cache *c)
{
    /* Each by the program type that made it. */
    if (c == NULL) return;
    for (int i = 0; i < c->n; i++) c->type[i]->cache_destroy(c->cache[i]);
    arena_destroy(c->own);
    arena_destroy(c->scratch);
    arena_destroy(c->world);
    tapes_destroy(c->tapes);
    free(c);
}

/* Programs that share scenes have the same function to make their cache: they share one. */
static struct program_cache *cache_of(struct run_cache *c, const struct program_type *type)
{
    if (!type->cache_create) return NULL;
    for (int i = 0; i < c->n; i++)
        if (c->type[i]->cache_create == type->cache_create) return c->cache[i];
    CHECK(c->n < MOST_CACHES);
    c->type[c->n] = type;
    return c->cache[c->n++] = type->cache_create();
}

const struct program_type *run_program(const struct run_spec *spec)
{
    /* By kind, not by name: somebody's program may be called as a built-in one. */
    if (!spec->kernel.own) return program_find(spec->kernel.name);
    return spec->program.kind == PROGRAM_SCHEDULE ? &schedule_program
                                                  : guest_program(spec->program.kind);
}

bool run_open(const struct run_spec *spec, const struct run_order *order, struct run_cache *cache,
              struct arena *a, struct program_run *r, struct err *e)
{
    *r = (struct program_run){.type = run_program(spec), .spec = *spec, .arena = a};
    /* How a run is executed is no part of what it is: an order changes no setting. Attempts of one
     * run have numbers that no other run's have. */
    if (order) r->order = *order;
    r->order.job_run *= MOST_ATTEMPTS;
    if (!r->type && spec->kernel.own)
        return err_set(e, ERR_CONFIG,
                       "program '%s' is not at hand: only a scenario says where it is",
                       spec->kernel.name);
    if (!r->type)
        return err_set(e, ERR_CONFIG, "no kernel is called '%s'; 'mimdsim kernels' lists them",
                       spec->kernel.name);
    r->cache = cache_of(cache, r->type);
    r->packs = cache->packs;
    if (r->order.hosts && r->order.hosts->size > 1 && !r->order.whole && !spec->jobs) {
        struct run_part *part = TAKE(a, 1, struct run_part);
        *part = part_hosts(r->order.hosts, spec->nrank);
        r->part = part;
    }
    return r->type->open(r, e);
}

/* Images are mapped memory: an arena would not give it back. */
void run_close(struct program_run *r)
{
    if (r->type && r->type->close) r->type->close(r);
}
