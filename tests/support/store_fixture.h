/* store_fixture.h - an open database in a folder of its own, for tests that write and read one:
 * make_store and drop_store as setup and teardown of each test.
 *
 * To be included behind cmocka.h, by the file that has main. */
#ifndef SUPPORT_STORE_FIXTURE_H
#define SUPPORT_STORE_FIXTURE_H

#include <stdlib.h>

#include "../support/scratch.h"
#include "base/arena.h"
#include "base/err.h"
#include "store/store.h"

struct store_fixture {
    char folder[200], path[256]; /* path: of the database, t.db */
    struct arena *a;
    struct store *s;
    struct err e;
};

static int make_store(void **state)
{
    struct store_fixture *f = calloc(1, sizeof *f);
    scratch_make(f->folder, sizeof f->folder);
    scratch_path(f->path, sizeof f->path, f->folder, "t.db");
    f->a = arena_create();
    f->s = store_open(f->path, STORE_WRITE, &f->e);
    *state = f;
    return f->s == NULL;
}

static int drop_store(void **state)
{
    struct store_fixture *f = *state;
    store_close(f->s);
    arena_destroy(f->a);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

#endif
