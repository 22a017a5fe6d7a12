/* test_pool.c - messages that nobody uses, by size (vp/pool.c). */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>

#include "base/arena.h"
#include "vp/message.h"

enum { MANY = 1000 };

/* MANY messages of `bytes` at once, written to their ends, and back again; the memory of all that
 * there ever were. */
static size_t send_many(struct message_pool *p, int64_t bytes)
{
    static struct message *m[MANY];
    for (int i = 0; i < MANY; i++) {
        m[i] = message_take(p, bytes);
        assert_int_equal(m[i]->bytes, bytes);
        memset(m[i]->data, i % 251, (size_t)bytes);
    }
    for (int i = 0; i < MANY; i++) {
        for (int64_t k = 0; k < bytes; k++) assert_int_equal((unsigned char)m[i]->data[k], i % 251);
        message_give(p, m[i]);
    }
    return arena_used(p->arena);
}

static void small_messages_use_what_somewhat_larger_ones_have_left(void **state)
{
    (void)state;
    struct message_pool p = {.arena = arena_create()};
    const size_t first = send_many(&p, 96);
    assert_int_equal(send_many(&p, 48), first);
    assert_int_equal(send_many(&p, 0), first);
    assert_int_equal(send_many(&p, 96), first);
    /* They would waste most of the memory of much larger ones. */
    const size_t large = send_many(&p, 1024);
    assert_true(large > first);
    assert_int_equal(send_many(&p, 48), large);
    assert_int_equal(send_many(&p, 1024), large);
    arena_destroy(p.arena);
}

static void a_message_takes_hardly_more_than_its_head_and_its_data(void **state)
{
    (void)state;
    struct message_pool p = {.arena = arena_create()};
    /* Chunks begin at lines of the cache. */
    const size_t each = sizeof(struct message) + 48;
    assert_true(send_many(&p, 48) <= (MANY + 63) * each + 64 * (MANY / 64 + 1));
    arena_destroy(p.arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_messages_use_what_somewhat_larger_ones_have_left),
        cmocka_unit_test(a_message_takes_hardly_more_than_its_head_and_its_data),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
