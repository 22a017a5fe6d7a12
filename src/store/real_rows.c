/* real_rows.c - see real_rows.h.
 *
 * A row's key is a text made of what, where and when, not a number: databases of several computers
 * are merged without renumbering anything. */
#include "store/real_rows.h"

#include <stdio.h>
#include <time.h>

#include "base/digest.h"
#include "store/connection.h"

enum { KEY_LETTERS = 16 };

/* When, to the second for people, and to the nanosecond for the key. */
static void now_text(char utc[32], char exact[64])
{
    struct timespec t;
    struct tm utc_time;
    clock_gettime(CLOCK_REALTIME, &t);
    gmtime_r(&t.tv_sec, &utc_time);
    strftime(utc, 32, "%Y-%m-%dT%H:%M:%SZ", &utc_time);
    snprintf(exact, 64, "%s.%09ld", utc, t.tv_nsec);
}

static void make_key(const struct real_task *task, const struct real_result *r, const char *exact,
                     char key[65])
{
    struct text t = {0};
    text_add(&t, "%s %s %d %s", task->hash, r->host, r->nrank, exact);
    digest_sha256_hex(t.s, t.length, key);
    key[KEY_LETTERS] = '\0';
    text_free(&t);
}

static bool put_run(struct store *s, const char *key, const char *utc, const struct real_task *task,
                    const struct real_result *r, struct err *e)
{
    static const char *const name[] = {"real_id", "task_hash", "scenario", "program",
                                       "n",       "settings",  "build_id", "created_utc"};
    const struct store_value value[] = {
        store_text(key),           store_text(task->hash), store_text(task->scenario),
        store_text(task->program), store_int(task->n),     store_text(task->settings),
        store_int(s->build_id),    store_text(utc)};
    return store_insert_row(s, "real_run", sizeof name / sizeof *name, name, value,
                            &real_result_columns, r, e);
}

bool store_put_real(struct store *s, const struct real_task *task, const struct real_result *r,
                    struct err *e)
{
    static const char *const stage_key[] = {"real_id", "stage"};
    static const char *const sample_key[] = {"real_id", "sample"};
    char utc[32], exact[64], key[65];
    now_text(utc, exact);
    make_key(task, r, exact, key);
    if (!store_begin(s, e)) return false;
    bool ok = store_note_build(s, e) && put_run(s, key, utc, task, r, e);
    for (int i = 0; ok && i < r->nstage; i++) {
        const struct store_value value[] = {store_text(key), store_int(i)};
        ok = store_insert_row(s, "real_stage", 2, stage_key, value, &real_stage_columns,
                              &r->stage[i], e);
    }
    for (int i = 0; ok && i < r->nsample; i++) {
        const struct store_value value[] = {store_text(key), store_int(i)};
        ok = store_insert_row(s, "real_sample", 2, sample_key, value, &real_sample_columns,
                              &r->sample[i], e);
    }
    if (ok) return store_commit(s, e);
    store_rollback(s);
    return false;
}
