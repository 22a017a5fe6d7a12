/* run_entries.c - see run_entries.h.
 *
 * A run on 128 processors has 1,500 entries of ranks, and 1,700 of links. As rows of their own they
 * took longer to store than the run to simulate: each is a search in a tree and some fifty steps of
 * SQLite's machine. Digits are written by hand: printf would take as long as those rows. */
#include "store/run_entries.h"

#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "measure/run_row.h"
#include "store/connection.h"

static const char *const rank_key[] = {"rank", "stage"}, *const link_key[] = {"link"};
const struct entry_view entry_view[ENTRY_VIEWS] = {
    {"rank_stage", "rank_times", rank_key, 2, &stage_time_columns},
    {"link_load", "link_loads", link_key, 1, &link_load_columns},
};

/* ---- entries ---- */

/* A number and what divides it from the next; "null" is shorter. */
enum { INTEGER_BYTES = TEXT_INTEGER + 4 };

/* The value of a column, or the word for one that is not known. */
static char *put_column(char *at, const struct column *c, const void *row)
{
    struct column_value v;
    column_read(c, row, &v);
    if (v.kind == VALUE_ABSENT) return memcpy(at, "null", 4), at + 4;
    CHECK(v.kind == VALUE_INT);
    return text_put_integer(at, v.integer);
}

static void add_entry(const struct entry_view *e, const int64_t *key, const void *row,
                      struct text *t)
{
    text_reserve(t, (size_t)(e->nkey + e->columns->n) * INTEGER_BYTES);
    char *at = t->s + t->length;
    if (at[-1] == ']') *at++ = ',';
    for (int i = 0; i < e->nkey; i++) {
        *at++ = i == 0 ? '[' : ',';
        at = text_put_integer(at, key[i]);
    }
    for (int i = 0; i < e->columns->n; i++) {
        *at++ = ',';
        at = put_column(at, &e->columns->column[i], row);
    }
    *at++ = ']';
    *at = 0;
    t->length = (size_t)(at - t->s);
}

void rank_entries(const struct run_result *r, struct text *t)
{
    text_add_bytes(t, "[", 1);
    for (int k = 0; k < r->nrank; k++)
        for (int i = 0; i < r->nstage; i++) {
            const struct stage_time *time = &r->stage[(int64_t)k * r->nstage + i];
            /* A rank that did nothing in a stage has no entry: large runs would have mostly
             * zeros. */
            if (!stage_time_idle(time))
                add_entry(&entry_view[ENTRY_RANK_STAGE], (const int64_t[]){k, i}, time, t);
        }
    text_add_bytes(t, "]", 1);
}

bool run_entries_ranks(int nrank) { return nrank <= STORE_RANK_ROWS; }

/* For qsort: busiest first, by longest queues, then longest use, then place, so that the choice
 * is the same every time. */
static int compare_load(const void *a, const void *b)
{
    const struct link_load *x = *(const struct link_load *const *)a,
                           *y = *(const struct link_load *const *)b;
    if (x->queue_ps != y->queue_ps) return x->queue_ps > y->queue_ps ? -1 : 1;
    if (x->busy_ps != y->busy_ps) return x->busy_ps > y->busy_ps ? -1 : 1;
    return x < y ? -1 : x > y;
}

/* For qsort: by number. */
static int compare_place(const void *a, const void *b)
{
    const struct link_load *x = *(const struct link_load *const *)a,
                           *y = *(const struct link_load *const *)b;
    return x < y ? -1 : x > y;
}

/* All links where there are few; the busiest of many, as those limit the run. */
void link_entries(const struct run_result *r, struct text *t)
{
    const bool many = r->nlink > STORE_LINK_ROWS;
    const int n = many ? STORE_LINK_ROWS : r->nlink;
    const struct link_load **chosen = memory_take((size_t)r->nlink, sizeof *chosen);
    for (int i = 0; i < r->nlink; i++) chosen[i] = &r->link[i];
    if (many) {
        qsort(chosen, (size_t)r->nlink, sizeof *chosen, compare_load);
        qsort(chosen, (size_t)n, sizeof *chosen, compare_place);
    }
    text_add_bytes(t, "[", 1);
    for (int i = 0; i < n; i++)
        add_entry(&entry_view[ENTRY_LINK_LOAD], (const int64_t[]){chosen[i] - r->link}, chosen[i],
                  t);
    text_add_bytes(t, "]", 1);
    free(chosen);
}
