/* binding.h - a statement whose parameters are bound one after the other, in the order of its
 * question marks. */
#ifndef STORE_BINDING_H
#define STORE_BINDING_H

#include <math.h>
#include <stdint.h>

#include "store/connection.h"

struct binding {
    sqlite3_stmt *statement; /* borrowed */
    int next;
};

/* bind_start: the first parameter of a prepared statement; false with *e set. */
static inline bool bind_start(struct store *s, enum statement which, struct binding *b,
                              struct err *e)
{
    *b = (struct binding){store_statement(s, which, e), 1};
    return b->statement != NULL;
}

/* bind_int, bind_count, bind_null, bind_real, bind_text, bind_int_if: the next parameter. What is
 * not finite or not known is NULL; texts are borrowed until the statement has run. */
static inline void bind_int(struct binding *b, int64_t v)
{
    store_bound(sqlite3_bind_int64(b->statement, b->next++, v));
}
static inline void bind_count(struct binding *b, uint64_t v) { bind_int(b, (int64_t)v); }
static inline void bind_null(struct binding *b)
{
    store_bound(sqlite3_bind_null(b->statement, b->next++));
}
static inline void bind_real(struct binding *b, double v)
{
    if (isfinite(v)) store_bound(sqlite3_bind_double(b->statement, b->next++, v));
    else bind_null(b);
}
static inline void bind_text(struct binding *b, const char *v)
{
    store_bound(sqlite3_bind_text(b->statement, b->next++, v, -1, SQLITE_STATIC));
}
static inline void bind_int_if(struct binding *b, bool known, int64_t v)
{
    if (known) bind_int(b, v);
    else bind_null(b);
}

#endif
