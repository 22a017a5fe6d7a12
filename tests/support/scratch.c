/* scratch.c - a folder of its own for a test's files. */
#include "scratch.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/check.h"

void scratch_make(char *folder, size_t size)
{
    const char *tmp = getenv("TMPDIR");
    snprintf(folder, size, "%s/mimdsim-test-XXXXXX", tmp && *tmp ? tmp : P_tmpdir);
    CHECK(mkdtemp(folder) != NULL);
}

char *scratch_path(char *path, size_t size, const char *folder, const char *name)
{
    CHECK(snprintf(path, size, "%s/%s", folder, name) < (int)size);
    return path;
}

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *at)
{
    (void)info;
    (void)kind;
    (void)at;
    return remove(path);
}

void scratch_remove(const char *folder) { nftw(folder, remove_one, 8, FTW_DEPTH | FTW_PHYS); }
