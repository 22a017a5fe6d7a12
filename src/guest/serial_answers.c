/* serial_answers.c - see serial_answers.h.
 *
 * A sweep over numbers of ranks would run the same serial code once for each of them.
 * Answers are kept in memory of this process only, so nothing stale can be met in
 * another. */
#include "guest/serial_answers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/digest.h"
#include "base/memory.h"
#include "base/text.h"

enum { MOST_ANSWERS = 16 }; /* more than one run needs, so what a run was given stays */

struct program_cache {
    int n, next;
    struct serial_answer answer[MOST_ANSWERS];
};

struct program_cache *serial_answers_create(void)
{
    struct program_cache *c = memory_zeroed(1, sizeof *c);
    return c;
}

void serial_answers_destroy(struct program_cache *c)
{
    for (int i = 0; c != NULL && i < c->n; i++) guest_results_clear(&c->answer[i].results);
    free(c);
}

/* What decides the answer, but for the number of ranks. Prices of blocks depend on the
 * node, choices of algorithms on the rules of collectives. The struct is hashed as bytes:
 * padding that differs costs a second run, never a wrong answer. */
static void make_key(const struct run_spec *s, int part, enum program_cost cost, char key[65])
{
    char node[65];
    struct text t = {0};
    digest_sha256_hex(&s->machine.node, sizeof s->machine.node, node);
    text_add(&t, "%s %d %d %.17g %s %s\n%s", s->program.hash, part, (int)cost, s->program.factor,
             node, s->machine.software.collectives,
             s->program.parameters != NULL ? s->program.parameters : "");
    digest_sha256_hex(t.s, t.length, key);
    text_free(&t);
}

/* nrank 0: the code never asked how many ranks there are. */
static struct serial_answer *find(struct program_cache *c, const char *key, int nrank)
{
    for (int i = 0; i < c->n; i++) {
        struct serial_answer *a = &c->answer[i];
        if (strcmp(a->key, key) == 0 && (a->nrank == 0 || a->nrank == nrank)) return a;
    }
    return NULL;
}

/* A place for a new one: the oldest goes. A ring: pointers that a run was given stay
 * good, because one run asks for fewer than MOST_ANSWERS. */
static struct serial_answer *place(struct program_cache *c)
{
    struct serial_answer *a = &c->answer[c->next];
    c->next = (c->next + 1) % MOST_ANSWERS;
    if (c->n < MOST_ANSWERS) c->n++;
    guest_results_clear(&a->results);
    memset(a, 0, sizeof *a);
    return a;
}

/* Time and counted work of the one rank. The one rank's makespan and its operations over
 * all stages. */
static void take_times(struct serial_answer *a, const struct run_result *r)
{
    a->time_ps = r->makespan_ps;
    for (int i = 0; i < r->nstage; i++) work_add(&a->work, &r->stage[i].work);
}

const struct serial_answer *serial_answer(const struct program_run *r, int part,
                                          enum program_cost cost, int64_t stack_bytes, char *why,
                                          int size)
{
    const struct run_spec *spec = &r->spec;
    char key[65];
    make_key(spec, part, cost, key);
    struct serial_answer *a = find(r->cache, key, spec->nrank);
    if (a != NULL) return a;
    struct arena *memory = arena_create();
    struct run_result *out = TAKE(memory, 1, struct run_result);
    struct guest_results results = {0};
    struct guest_world w = {.spec = spec,
                            .cost = cost,
                            .calls = &guest_calls,
                            .memory = memory,
                            .results = &results,
                            .host_limit = r->order.host_limit};
    struct err e;
    err_clear(&e);
    /* Only answers of runs that ended well are kept; a failure is told each time. */
    const bool made = guest_alone(&w, part, stack_bytes, memory, out, &e);
    if (made && out->status == RUN_OK) {
        a = place(r->cache);
        text_copy(a->key, sizeof a->key, key);
        a->nrank = w.asked_size ? spec->nrank : 0;
        /* The results change hands: the cache frees them. */
        a->results = results;
        take_times(a, out);
    } else {
        snprintf(why, (size_t)size, "%s", made ? out->text : e.text);
        guest_results_clear(&results);
    }
    arena_destroy(memory);
    return a;
}
