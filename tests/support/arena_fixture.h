/* arena_fixture.h - the memory of a test program: `arena`, with make_arena and drop_arena as its
 * setup and teardown, whether for each test or for all of them.
 *
 * To be included behind cmocka.h, by the file that has main. */
#ifndef SUPPORT_ARENA_FIXTURE_H
#define SUPPORT_ARENA_FIXTURE_H

#include "base/arena.h"

static struct arena *arena;

static int make_arena(void **state)
{
    (void)state;
    arena = arena_create();
    return 0;
}

static int drop_arena(void **state)
{
    (void)state;
    arena_destroy(arena);
    return 0;
}

#endif
