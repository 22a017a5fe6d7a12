/* rank_times.c - see rank_times.h.
 *
 * A run on 128 processors has 1,500 entries of ten integers. Digits are written by hand: printf
 * would take as long as the rows that this text replaces. */
#include "store/rank_times.h"

#include <string.h>

#include "base/check.h"
#include "measure/run_row.h"

/* The digits of a 64-bit integer with its sign, and a comma. */
enum { INTEGER_BYTES = 24 };

static char *put_integer(char *at, int64_t value)
{
    char digit[INTEGER_BYTES];
    int n = 0;
    /* Unsigned, since the least integer has no positive counterpart. */
    uint64_t rest = value < 0 ? -(uint64_t)value : (uint64_t)value;
    do digit[n++] = (char)('0' + rest % 10);
    while (rest /= 10);
    if (value < 0) *at++ = '-';
    while (n > 0) *at++ = digit[--n];
    return at;
}

/* One entry into a text that has room for it. */
static void add_entry(int rank, int stage, const struct stage_time *time, struct text *t)
{
    const struct column_table *columns = &stage_time_columns;
    char *at = t->s + t->length;
    if (at[-1] == ']') *at++ = ',';
    *at++ = '[';
    at = put_integer(at, rank);
    *at++ = ',';
    at = put_integer(at, stage);
    for (int i = 0; i < columns->n; i++) {
        struct column_value v = {0};
        column_read(&columns->column[i], time, &v);
        /* All of them are counts and times. */
        CHECK(v.kind == VALUE_INT);
        *at++ = ',';
        at = put_integer(at, v.integer);
    }
    *at++ = ']';
    *at = 0;
    t->length = (size_t)(at - t->s);
}

void rank_times_add(const struct run_result *r, struct text *t)
{
    const size_t entry = (size_t)(RANK_ENTRY_KEYS + stage_time_columns.n) * INTEGER_BYTES;
    text_add_bytes(t, "[", 1);
    for (int k = 0; k < r->nrank; k++)
        for (int i = 0; i < r->nstage; i++) {
            const struct stage_time *time = &r->stage[(int64_t)k * r->nstage + i];
            /* A rank that did nothing in a stage has no entry: large runs would have mostly
             * zeros. */
            if (stage_time_idle(time)) continue;
            text_reserve(t, entry);
            add_entry(k, i, time, t);
        }
    text_add_bytes(t, "]", 1);
}

/* The same text out of rows, by SQLite: a column that the older table lacks is 0. */
bool rank_times_upgrade(struct store *s, const char *older, struct err *e)
{
    struct text sql = {0};
    text_add(&sql, "INSERT INTO rank_times SELECT run_id, json_group_array(json_array(rank, stage");
    for (int i = 0; i < stage_time_columns.n; i++) {
        const char *name = stage_time_columns.column[i].name;
        const bool there = sqlite3_table_column_metadata(s->db, "main", older, name, NULL, NULL,
                                                         NULL, NULL, NULL) == SQLITE_OK;
        text_add(&sql, ", %s", there ? name : "0");
    }
    text_add(&sql, ")) FROM (SELECT * FROM %s ORDER BY run_id, rank, stage) GROUP BY run_id;"
                   " DROP TABLE %s",
             older, older);
    const bool ok = store_exec(s, sql.s, e);
    text_free(&sql);
    return ok;
}
