/* reference.h - files of tests/data/net, simulated by the levels that a test asks for. */
#ifndef TESTS_NET_REFERENCE_H
#define TESTS_NET_REFERENCE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "study/netcheck.h"

#define DATA MIMDSIM_SRCDIR "/tests/data/net/"

/* The rows of `file` whose name holds `filter`, by each level of `level` (LEVELS): at least one. */
static inline void ask(struct netcheck *n, const bool *level, const char *file, const char *filter,
                       struct arena *a)
{
    struct err e;
    err_clear(&e);
    if (!netcheck_run(n, file, level, filter, true, a, &e)) fail_msg("%s", e.text);
    assert_true(n->nrow > 0);
}

#endif
