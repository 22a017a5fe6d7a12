/* in_arena.h - a test with a scratch folder (scratch.h), memory in `a` and the error of its calls
 * in `e`. */
#ifndef TESTS_PLAN_IN_ARENA_H
#define TESTS_PLAN_IN_ARENA_H

#include "scratch.h"

#include "../support/refused.h"
#include "base/arena.h"

static struct arena *a;
static struct err e;

static int begin(void **state)
{
    a = arena_create();
    err_clear(&e);
    return open_scratch(state);
}

static int end(void **state)
{
    arena_destroy(a);
    return close_scratch(state);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)

static void refused(enum err_kind kind, int line, const char *part)
{
    is_refused_at(&e, kind, line, part);
}

#endif
