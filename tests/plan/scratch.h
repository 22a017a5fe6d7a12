/* scratch.h - a scratch folder of scenario and machine files for the tests of room plan. */
#ifndef TESTS_PLAN_SCRATCH_H
#define TESTS_PLAN_SCRATCH_H

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "plan/plan.h"

struct scratch {
    char dir[64];
    char path[128];
};

static inline void scratch_open(struct scratch *s)
{
    snprintf(s->dir, sizeof s->dir, "%s/mimdsim-test-XXXXXX", P_tmpdir);
    assert_non_null(mkdtemp(s->dir));
    setenv("MIMDSIM_DATA", MIMDSIM_SRCDIR, 1);
    setenv("XDG_DATA_HOME", s->dir, 1);
}

static inline void scratch_close(struct scratch *s)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", s->dir);
    assert_int_equal(system(command), 0);
}

/* The path of file `name` with `text` in it; valid until the next call. */
static inline const char *scratch_write(struct scratch *s, const char *name, const char *text)
{
    snprintf(s->path, sizeof s->path, "%s/%s", s->dir, name);
    FILE *out = fopen(s->path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(text, 1, strlen(text), out), strlen(text));
    fclose(out);
    return s->path;
}

/* plan_read that has to succeed, with `nset` settings. */
static inline struct plan scratch_plan(const char *name, const char *const *set, int nset)
{
    struct plan p;
    struct err e;
    struct plan_options o = {.nset = nset, .set = set};
    err_clear(&e);
    if (!plan_read(&p, name, &o, &e)) fail_msg("%s:%d: %s", e.file, e.line, e.text);
    return p;
}

/* The folder of a test program, with open_scratch and close_scratch as its setup and teardown. */
static struct scratch scratch;

static inline int open_scratch(void **state)
{
    (void)state;
    scratch_open(&scratch);
    return 0;
}

static inline int close_scratch(void **state)
{
    (void)state;
    scratch_close(&scratch);
    return 0;
}

#endif
