/* fuzz_cells.c - databases whose contents a stranger changed: the input is SQL, a statement a line,
 * executed on a copy of a small database without any of its rules; what comes out is read like any
 * database.
 *
 * Changes put values that hurt into cells by name, or exchange whole tables. */
#include "fuzz_database.h"

#include <stdio.h>
#include <sqlite3.h>
#include <unistd.h>

#include "base/random.h"

static const char *const value[] = {"NULL",
                                    "0",
                                    "-1",
                                    "1",
                                    "2",
                                    "7",
                                    "1e308",
                                    "-1e308",
                                    "0.5",
                                    "9223372036854775807",
                                    "-9223372036854775808",
                                    "4611686018427387904",
                                    "2147483648",
                                    "''",
                                    "'x'",
                                    "'ok'",
                                    "'deadlock'",
                                    "x'00ff'",
                                    "x''",
                                    "'%s%n'",
                                    "char(27, 91, 50, 74)",
                                    "'a' || char(10)",
                                    "printf('%1000c', 'x')",
                                    "'<script>'",
                                    "'../../x'",
                                    "random()",
                                    "zeroblob(9)"};
enum { NVALUE = sizeof value / sizeof *value, LINE = 400 };

/* Statements that fail change nothing, which is fine; the file is closed before it is read. */
static void change(const char *path, char *sql)
{
    sqlite3 *db;
    CHECK(sqlite3_open_v2(path, &db, SQLITE_OPEN_READWRITE, NULL) == SQLITE_OK);
    sqlite3_exec(db,
                 "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA foreign_keys = OFF;"
                 " PRAGMA ignore_check_constraints = ON; PRAGMA writable_schema = ON",
                 NULL, NULL, NULL);
    sqlite3_limit(db, SQLITE_LIMIT_LENGTH, 1 << 20);
    /* nothing but this file */
    sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
    for (char *line; (line = strsep(&sql, "\n")) != NULL;) sqlite3_exec(db, line, NULL, NULL, NULL);
    sqlite3_close(db);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t n;
    const uint8_t *image = database_image(&n);
    char *sql = fuzz_text(data, size);
    char path[256];
    snprintf(path, sizeof path, "%s", fuzz_file("input.db", image, n));
    change(path, sql);
    database_read(path, fuzz_choice(data, size));
    free(sql);
    return 0;
}

/* A statement about a column by its name. */
static void statement(char line[LINE], struct random *r)
{
    size_t n;
    const char *const *column = database_columns(&n);
    const char *chosen = column[random_below(r, n)], *name = strchr(chosen, ' ');
    int table = (int)(name++ - chosen);
    const char *v = value[random_below(r, NVALUE)];
    switch (random_below(r, 8)) {
    case 0:
        snprintf(line, LINE, "DELETE FROM %.*s WHERE rowid %% 2\n", table, chosen);
        break;
    case 1:
        snprintf(line, LINE, "ALTER TABLE %.*s DROP COLUMN %s\n", table, chosen, name);
        break;
    case 2:
        snprintf(
            line, LINE,
            "CREATE TEMP TABLE u AS SELECT * FROM %.*s; DROP TABLE %.*s; CREATE VIEW %.*s AS SELECT"
            " random() %% 5 AS %s\n",
            table, chosen, table, chosen, table, chosen, name);
        break;
    case 3:
        snprintf(line, LINE, "UPDATE %.*s SET %s = %s\n", table, chosen, name, v);
        break;
    default:
        snprintf(line, LINE, "UPDATE %.*s SET %s = %s WHERE rowid = %d\n", table, chosen, name, v,
                 1 + (int)random_below(r, 8));
    }
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    struct random r = random_make(seed, 0, 0);
    char line[LINE];
    if (random_below(&r, 4) == 0) return text_mutate(data, size, most, seed);
    if (random_below(&r, 4) == 0) size = 0;
    statement(line, &r);
    size_t n = strlen(line);
    if (size + n > most) size = 0;
    memcpy(data + size, line, n);
    return size + n;
}
