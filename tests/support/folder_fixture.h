/* folder_fixture.h - a folder with room for the files of one test, memory and an error: make_folder
 * and drop_folder as setup and teardown of each test.
 *
 * To be included behind cmocka.h, by the file that has main. */
#ifndef SUPPORT_FOLDER_FIXTURE_H
#define SUPPORT_FOLDER_FIXTURE_H

#include <stdlib.h>

#include "../support/scratch.h"
#include "base/arena.h"
#include "base/err.h"

struct folder_fixture {
    char folder[200], path[256], other[256]; /* two files in it, neither there yet */
    struct arena *a;
    struct err e;
};

/* For a setup of one's own: a fixture of `size` bytes that begins with a struct folder_fixture, all
 * else zero; its `path` is that of file `name`. */
static inline void *folder_of(size_t size, const char *name)
{
    struct folder_fixture *f = calloc(1, size);
    scratch_make(f->folder, sizeof f->folder);
    scratch_path(f->path, sizeof f->path, f->folder, name);
    scratch_path(f->other, sizeof f->other, f->folder, "other.db");
    f->a = arena_create();
    return f;
}

static inline int make_folder(void **state)
{
    *state = folder_of(sizeof(struct folder_fixture), "t.db");
    return 0;
}

static inline int drop_folder(void **state)
{
    struct folder_fixture *f = *state;
    arena_destroy(f->a);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

#endif
