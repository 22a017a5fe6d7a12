/* column.h - results as tables of columns: one row of a table serves the database, JSON, the
 * terminal and the manual.
 *
 * A column says where a value lies in its struct, what it is called and what it means; beside each
 * result struct stands its table. A value that is not known is absent: NULL in the database, null
 * in JSON, "-" on the terminal.
 *
 * A new column of the database is COLUMN_NULL, since rows of older databases lack it, and wants a
 * new STORE_VERSION (store/connection.h), since these databases lack it, too; `mimdsim query
 * --schema` then writes docs/database.md. */
#ifndef MEASURE_COLUMN_H
#define MEASURE_COLUMN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/json.h"
#include "base/text.h"

/* One value as it leaves a table. */
enum value_kind { VALUE_ABSENT, VALUE_INT, VALUE_REAL, VALUE_TEXT, VALUE_BOOL };
struct column_value {
    enum value_kind kind;
    int64_t integer;  /* of VALUE_BOOL 0 or 1 */
    double real;      /* finite */
    const char *text; /* borrowed from the row or from `buffer` */
    char buffer[512];
};

enum column_kind {
    COLUMN_INT,    /* int */
    COLUMN_INT64,  /* int64_t */
    COLUMN_COUNT,  /* uint64_t */
    COLUMN_BOOL,   /* bool */
    COLUMN_REAL,   /* double; absent when not finite */
    COLUMN_WORD,   /* an enum counted from 0: `word` names its values */
    COLUMN_CHARS,  /* char[] */
    COLUMN_STRING, /* const char *; absent when NULL */
    COLUMN_HEX     /* uint64_t as 16 hexadecimal digits */
};

/* When a number is absent. */
enum column_absent { ABSENT_NEVER, ABSENT_ZERO /* or below */, ABSENT_NEGATIVE };

/* What a column differs in. */
enum {
    COLUMN_NULL = 1,     /* the database lets it be absent */
    COLUMN_NO_SQL = 2,   /* not in the database */
    COLUMN_NO_JSON = 4,  /* not in JSON */
    COLUMN_OPTIONAL = 8  /* in JSON without its key where `known` says no */
};

struct column {
    const char *name; /* in the database; ends in its unit */
    enum column_kind kind;
    /* PART(row, pointer): the value lies in the struct that this member points to; 0: in the row */
    size_t part;
    size_t offset;    /* there */
    unsigned flags;   /* COLUMN_* */
    enum column_absent absent;
    const char *const *word; /* (nword) */
    int nword;
    bool (*known)(const void *row); /* false: absent; NULL: always known */
    /* Makes the value, of the SQL type of `kind`, from the row; what it leaves alone is absent.
     * NULL: see `offset`. */
    void (*value)(const struct column *c, const void *row, struct column_value *v);
    const char *more; /* for `value` */
    /* Writes a list or an object into JSON instead, where known. */
    void (*json)(const struct column *c, const void *row, struct json *j);
    const char *key;    /* in JSON; NULL: as `name` */
    double json_scale;  /* 0: as it is; else a real, this times the value */
    const char *title;  /* on the terminal; NULL: not there */
    const char *before; /* there: text in front of it, NULL: nothing */
    int width;          /* there, negative: aligned to the left, 0: as long as it is */
    /* there, 'e', 'f' or 'g': a real with `digits`, of the value times `scale`; 0: as it is */
    char style;
    int digits;
    double scale;       /* 0: 1 */
    const char *doc;    /* one line for the manual */
};

/* PART(struct row, member): see column.part. */
#define PART(row, pointer) (1 + offsetof(row, pointer))

struct column_table {
    int n;
    const struct column *column;
};

/* COLUMNS(array): the initialiser of a table. WORDS(array): the members `word` and `nword`. */
#define COLUMNS(array) {.n = (int)(sizeof(array) / sizeof *(array)), .column = (array)}
#define WORDS(array) .word = (array), .nword = (int)(sizeof(array) / sizeof *(array))

/* column_read: the value of column `c` in `row`. */
void column_read(const struct column *c, const void *row, struct column_value *v);

/* columns_define: "name TYPE NOT NULL CHECK (...), -- doc", a line a column, for CREATE TABLE;
 * appended. */
void columns_define(const struct column_table *t, struct text *sql);

/* columns_list: ", name" for each column of the database, appended; returns how many. */
int columns_list(const struct column_table *t, struct text *sql);

/* columns_json: the row as one object, its keys sorted. columns_json_list: n rows of `size` bytes
 * each as a list. */
void columns_json(const struct column_table *t, const void *row, struct json *j);
void columns_json_list(const struct column_table *t, const void *row, int n, size_t size,
                       struct json *j);

/* columns_title, columns_print: the line of titles, and a row as aligned text, each with its line
 * break. A column whose title is "" has no place in the line of titles. columns_cells: as
 * columns_print, the line goes on. */
void columns_title(const struct column_table *t, FILE *out);
void columns_print(const struct column_table *t, const void *row, FILE *out);
void columns_cells(const struct column_table *t, const void *row, FILE *out);

#endif
