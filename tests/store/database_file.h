/* database_file.h - a database file of a test: its folder, and SQL on it behind the program's
 * back. */
#ifndef TESTS_STORE_DATABASE_FILE_H
#define TESTS_STORE_DATABASE_FILE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdlib.h>

#include <sqlite3.h>

#include "../support/scratch.h"
#include "base/err.h"

/* kept: room for the name of a copy that an upgrade keeps. */
struct fixture {
    char folder[200], path[256], kept[264];
    struct err e;
};

/* A folder with room for one database; setup and teardown of a test. */
static int make_folder(void **state)
{
    struct fixture *f = calloc(1, sizeof *f);
    scratch_make(f->folder, sizeof f->folder);
    scratch_path(f->path, sizeof f->path, f->folder, "t.db");
    *state = f;
    return 0;
}

static int remove_folder(void **state)
{
    struct fixture *f = *state;
    scratch_remove(f->folder);
    free(f);
    return 0;
}

/* Statements on the file as it is, without this program. */
static inline void sql(const char *path, const char *text)
{
    sqlite3 *db;
    char *why = NULL;
    assert_int_equal(sqlite3_open(path, &db), SQLITE_OK);
    if (sqlite3_exec(db, text, NULL, NULL, &why) != SQLITE_OK) fail_msg("%s: %s", text, why);
    assert_int_equal(sqlite3_close(db), SQLITE_OK);
}

#endif
