/* result_parts.c - see result_parts.h. */
#include "run/result_parts.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "measure/rank_sums.h"

/* Whoever adds an array to the result adds it here: nothing else knows how results travel. */
struct result_parts result_parts(struct run_result *r)
{
    const size_t rows = r->stage ? (size_t)r->nrank * (size_t)r->nstage : 0;
    return (struct result_parts){
        {(void **)&r->stage, (void **)&r->finish_ps, (void **)&r->span, (void **)&r->link,
         (void **)&r->said, (void **)&r->path, (void **)&r->slack, (void **)&r->rank_slack,
         (void **)&r->sums},
        {rows * sizeof *r->stage, (r->finish_ps ? (size_t)r->nrank : 0) * sizeof *r->finish_ps,
         (size_t)r->nspan * sizeof *r->span, (size_t)r->nlink * sizeof *r->link, (size_t)r->nsaid,
         (size_t)r->npath * sizeof *r->path, (size_t)r->nslack * sizeof *r->slack,
         (r->rank_slack ? rows : 0) * sizeof *r->rank_slack,
         (r->sums ? 1 : 0) * sizeof *r->sums},
    };
}

/* What stands in front of the arrays. */
struct head {
    int number;
    struct run_result result;
};

void *result_pack(int number, const struct run_result *r, size_t *bytes)
{
    struct head h = {.number = number, .result = *r};
    const struct result_parts p = result_parts(&h.result);
    *bytes = sizeof h;
    for (int i = 0; i < RESULT_PARTS; i++) *bytes += p.bytes[i];
    /* One block is one message. */
    char *block = malloc(*bytes), *at = block;
    CHECK(block != NULL);
    memcpy(at, &h, sizeof h);
    at += sizeof h;
    for (int i = 0; i < RESULT_PARTS; i++) {
        if (p.bytes[i] > 0) memcpy(at, *p.array[i], p.bytes[i]);
        at += p.bytes[i];
    }
    return block;
}

bool result_unpack(const void *block, size_t bytes, int *number, struct run_result *r,
                   struct arena *a)
{
    struct head h;
    if (bytes < sizeof h) return false;
    memcpy(&h, block, sizeof h);
    *number = h.number;
    *r = h.result;
    const struct result_parts p = result_parts(r);
    /* A message that was cut, or of another program, must not be read beyond its end. */
    const char *at = (const char *)block + sizeof h;
    size_t left = bytes - sizeof h;
    for (int i = 0; i < RESULT_PARTS; i++) {
        if (p.bytes[i] > left) return false;
        *p.array[i] = p.bytes[i] > 0 ? arena_take(a, p.bytes[i]) : NULL;
        if (p.bytes[i] > 0) memcpy(*p.array[i], at, p.bytes[i]);
        at += p.bytes[i];
        left -= p.bytes[i];
    }
    return left == 0;
}
