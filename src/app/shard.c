/* shard.c - see shard.h.
 *
 * Which shard a run belongs to follows from its identity alone: hosts that read the same
 * scenario agree without talking to each other. */
#include "app/shard.h"

#include <stdio.h>
#include <stdlib.h>

/* 15 hexadecimal digits are 60 bits: even enough for any number of hosts, and never negative. */
enum { MOST_SHARDS = 1000000, HASH_DIGITS = 15 };

/* NULL is no shard: then all runs are wanted. */
bool shard_parse(const char *text, struct shard *out, struct err *e)
{
    *out = (struct shard){0};
    if (text == NULL) return true;
    int used = 0;
    /* %n tells whether the whole text was read. */
    const bool read =
        sscanf(text, "%9d/%9d%n", &out->number, &out->of, &used) == 2 && text[used] == '\0';
    if (read && out->number >= 1 && out->number <= out->of && out->of <= MOST_SHARDS) return true;
    return err_set(e, ERR_USAGE,
                   "--shard '%.40s': expected K/N with 1 <= K <= N <= %d, such as 1/8", text,
                   MOST_SHARDS);
}

int shard_of(const struct run_spec *run, int of)
{
    /* The hash is evenly spread as it is. Repetitions share it, so they are dealt out one by
     * one. */
    char digits[HASH_DIGITS + 1];
    snprintf(digits, sizeof digits, "%.*s", HASH_DIGITS, run->config_hash);
    return (int)((strtoull(digits, NULL, 16) + (unsigned)run->rep) % (unsigned)of) + 1;
}

/* Repetitions share the hash of their settings. */
void run_name(const struct run_spec *run, char out[RUN_NAME])
{
    snprintf(out, RUN_NAME, "%s-%d", run->config_hash, run->rep);
}

bool shard_has(const struct shard *s, const struct run_spec *run)
{
    return s->of == 0 || shard_of(run, s->of) == s->number;
}
