/* trace_read.c - the timeline of a stored run, back from the database.
 *
 * So every format can be written later, without running again: only a run with `record: {spans:
 * true}` has spans. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/picoseconds.h"
#include "base/text.h"
#include "report/timeline.h"

enum { MOST_RANKS = 1 << 24 };

/* Of a message; as in schedules: no sum of them wraps. */
static const int64_t most_bytes = INT64_C(1) << 50;

/* What the rows of three queries fill, one after the other. */
struct reading {
    struct arena *a;
    struct run_result *r;
    struct err *err;
    int64_t room; /* for so many spans */
    bool found;
};

/* The run: number of ranks, length, and how many spans there will be. */
static bool read_run(void *context, int ncolumn, const char *const *name,
                     const struct store_value *value)
{
    struct reading *g = context;
    (void)ncolumn;
    (void)name;
    g->found = true;
    /* As many ranks as a machine can have: files with a part for each rank are written. */
    if (value[0].integer < 1 || value[0].integer > MOST_RANKS) {
        err_set(g->err, ERR_DATA, "table run, column P: %lld ranks; expected 1 to %d",
                (long long)value[0].integer, MOST_RANKS);
        return false;
    }
    g->r->nrank = (int)value[0].integer;
    g->r->makespan_ps = value[1].integer;
    /* room for all of them, counted by the same statement */
    g->room = value[2].integer;
    g->r->span = TAKE(g->a, g->room + 1, struct span);
    return false;
}

/* Names of stages by their numbers; numbers of a damaged database stay inside the array. */
static bool read_stage(void *context, int ncolumn, const char *const *name,
                       const struct store_value *value)
{
    struct reading *g = context;
    int64_t stage = value[0].integer;
    (void)ncolumn;
    (void)name;
    if (stage < 0 || stage >= RUN_MAX_STAGES) return true;
    text_copy(g->r->stage_name[stage], sizeof g->r->stage_name[stage],
              value[1].text ? value[1].text : "");
    if (stage >= g->r->nstage) g->r->nstage = (int)stage + 1;
    return true;
}

/* Kinds are stored as words; -1: it is none of them. */
static int kind_of(const char *word)
{
    for (int k = SPAN_COMPUTE; word != NULL && k <= SPAN_BARRIER; k++)
        if (strcmp(word, timeline_kind((enum span_kind)k)) == 0) return k;
    return -1;
}

/* One span. NULL as peer or message is -1. Formats subtract times, have a part for each rank, load
 * curves send the bytes from rank to rank again, and there is room for as many as the first query
 * counted, which a damaged index may contradict. */
static bool read_span(void *context, int ncolumn, const char *const *name,
                      const struct store_value *value)
{
    struct reading *g = context;
    const int64_t rank = value[0].integer, begin = value[3].integer, end = value[4].integer,
                  peer = value[5].kind == STORE_INT ? value[5].integer : -1,
                  bytes = value[6].integer;
    const int kind = kind_of(value[2].text);
    (void)ncolumn;
    (void)name;
    if (rank < 0 || rank >= g->r->nrank || begin < 0 || end < begin || end > PS_LAST || kind < 0 ||
        g->r->nspan == g->room || peer < -1 || peer >= g->r->nrank || bytes < 0 ||
        bytes > most_bytes)
        return err_set(g->err, ERR_DATA,
                       "table span, span %lld of the run: rank %lld, peer %lld, kind '%.20s', %lld "
                       "to %lld ps, %lld bytes; expected ranks below %d, a known kind, times that "
                       "do not fall, at most %lld bytes",
                       (long long)g->r->nspan, (long long)rank, (long long)peer,
                       value[2].text != NULL ? value[2].text : "NULL", (long long)begin,
                       (long long)end, (long long)bytes, g->r->nrank, (long long)most_bytes);
    g->r->span[g->r->nspan++] =
        (struct span){.rank = (int)rank,
                      .stage = (int)value[1].integer,
                      .kind = (enum span_kind)kind,
                      .begin_ps = begin,
                      .end_ps = end,
                      .peer = (int)peer,
                      .bytes = bytes,
                      .message = value[7].kind == STORE_INT ? value[7].integer : -1};
    return true;
}

/* Run, then stages, then spans: each query needs what the one before allocated. */
bool trace_read(struct store *s, int64_t run_id, struct arena *a, struct run_result *r,
                struct err *e)
{
    char id[24];
    const char *const param[] = {id};
    *r = (struct run_result){0};
    struct reading g = {.a = a, .r = r, .err = e};
    snprintf(id, sizeof id, "%lld", (long long)run_id);
    if (!store_query(s, "SELECT P, makespan_ps, (SELECT count(*) FROM span WHERE run_id = run.id)"
                        " FROM run "
                        "WHERE id = ?1", 1, param, NULL, read_run, &g, e))
        return false;
    if (e->kind != ERR_NONE) return false;
    /* No row: there is no such run. */
    if (!g.found) return err_set(e, ERR_NO_INPUT, "there is no run %s in %s", id, store_path(s));
    if (!store_query(s, "SELECT stage, name FROM stage WHERE run_id = ?1", 1, param, NULL,
                     read_stage, &g, e) ||
        !store_query(s,
                     "SELECT rank, stage, kind, begin_ps, end_ps, peer, bytes, message FROM span "
                     "WHERE run_id = ?1 ORDER BY span",
                     1, param, NULL, read_span, &g, e))
        return false;
    if (e->kind != ERR_NONE) return false;
    /* A run without spans was not recorded: the message says how to record it. */
    return r->nspan > 0 ||
           err_set(e, ERR_NO_INPUT,
                   "run %s has no stored timeline; record it with `record: {spans: true}`", id);
}
