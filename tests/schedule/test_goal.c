/* test_goal.c - Schedules in the language GOAL, as text and as LogGOPSim's binary form: read or
 * refused. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "schedule/schedule.h"

static struct schedule *read_text(const char *text, struct arena *a, struct err *e)
{
    err_clear(e);
    return goal_read_text(text, strlen(text), "x.goal", a, e);
}

static const char two_ranks[] = "/* two\n ranks */ num_ranks 2\r\n\n"
                                "rank 1 { // the second comes first\n"
                                "  recv 8b from 0 tag 3\n"
                                "l: recv 100 b from -1 tag -1 cpu 2 nic 1\n"
                                "}\n"
                                "// mimdsim time unit: 1 us\n"
                                "rank 0 {\n"
                                "a:calc 70 cpu 1\n"
                                "b2: send 8b to 1 tag 3\n"
                                "send 100b to 1 cpu 3\n"
                                "b2 requires a\n"
                                "b2 irequires a\n"
                                "}";

static void expect_two_ranks(const struct schedule *s, bool lines)
{
    assert_int_equal(s->nrank, 2);
    assert_int_equal(s->nop, 5);
    assert_int_equal(s->ncpu, 4);
    const int64_t first[] = {0, 3, 5};
    for (int r = 0; r < 3; r++) assert_int_equal(s->first[r], first[r]);
    const struct schedule_op expected[] = {
        {70, 0, 0, 10, 0, SCHEDULE_COMPUTE, 1},
        {8, 3, 1, 11, 2, SCHEDULE_SEND, 0},
        {100, 0, 1, 12, 0, SCHEDULE_SEND, 3},
        {8, 3, 0, 5, 0, SCHEDULE_RECEIVE, 0},
        {100, SCHEDULE_ANY, SCHEDULE_ANY, 6, 0, SCHEDULE_RECEIVE, 2},
    };
    for (int i = 0; i < 5; i++) {
        assert_int_equal(s->op[i].size, expected[i].size);
        assert_int_equal(s->op[i].tag, expected[i].tag);
        assert_int_equal(s->op[i].peer, expected[i].peer);
        assert_int_equal(s->op[i].needs, expected[i].needs);
        assert_int_equal(s->op[i].kind, expected[i].kind);
        assert_int_equal(s->op[i].cpu, expected[i].cpu);
        assert_int_equal(s->op[i].line, lines ? expected[i].line : 0);
    }
    assert_int_equal(s->nedge, 2);
    assert_int_equal(s->edge_first[1], 2);
    assert_int_equal(s->edge[0] >> 1, 1);
    assert_int_equal(s->edge[0] & 1, 0);
    assert_int_equal(s->edge[1], 3);
}

static void text_is_read(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    const struct schedule *s = read_text(two_ranks, a, &e);
    if (!s) fail_msg("%d: %s", e.line, e.text);
    expect_two_ranks(s, true);
    assert_int_equal(s->unit_ps, 1000000);
    arena_destroy(a);
}

static const struct {
    const char *text;
    int line;
    const char *said;
} cases[] = {
    {"", 1, "the end of the file where 'num_ranks' is expected"},
    {"rank 0 {", 1, "'rank' where 'num_ranks' is expected"},
    {"num_ranks 0\n", 1, "a schedule of 0 ranks"},
    {"num_ranks 2000000\n", 1, "'2000000' where a number of ranks from 0 to 1048576 is expected"},
    {"num_ranks 1\n", 2, "no schedule of rank 0; expected 1 ranks, each once"},
    {"num_ranks 1\nrank 1 {\n}\n", 2, "'1' where a rank from 0 to 0 is expected"},
    {"num_ranks 1\nrank 0 {\n}\nrank 0 {\n}", 4, "rank 0 a second time"},
    {"num_ranks 1\nrank 0 {\n", 3,
     "the end of the file where an operation, a label or '}' is expected"},
    {"num_ranks 1\nrank 0 {\nsend 5b to 1\n}", 3, "'1' where a rank from 0 to 0 is expected"},
    {"num_ranks 1\nrank 0 {\nsend 5b from 0\n}", 3, "'from' where 'to' is expected"},
    {"num_ranks 1\nrank 0 {\nsend 5 to 0\n}", 3, "'to' where 'b' is expected"},
    {"num_ranks 1\nrank 0 {\nsend -1b to 0\n}", 3, "where a number of bytes from 0"},
    {"num_ranks 1\nrank 0 {\nsend 5b to -1\n}", 3, "'-1' where a rank from 0 to 0 is expected"},
    {"num_ranks 1\nrank 0 {\nsend 5b to 0 tag -1\n}", 3, "'-1' where a tag from 0"},
    {"num_ranks 1\nrank 0 {\nsend 5b to 0 nic 0 cpu 0\n}", 3,
     "'cpu' where the end of the line is expected"},
    {"num_ranks 1\nrank 0 {\ncalc 5 nic 0\n}", 3, "'nic' where the end of the line is expected"},
    {"num_ranks 1\nrank 0 {\ncalc 5 cpu 256\n}", 3,
     "'256' where a processor from 0 to 255 is expected"},
    {"num_ranks 1\nrank 0 {\ncalc 5 calc 6\n}", 3, "'calc' where the end of the line is expected"},
    {"num_ranks 1\nrank 0 {\ncalc\n}", 3, "the end of the line where a time from 0"},
    {"num_ranks 1\nrank 0 {\ncalc 9223372036854775808\n}", 3, "a number of more than 63 bits"},
    {"num_ranks 1\nrank 0 {\ncalc 9223372036854775807\n}", 3, "where a time from 0"},
    {"num_ranks 1\nrank 0 {\na: calc 1\na: calc 2\n}", 4, "a second operation with the label 'a'"},
    {"num_ranks 1\nrank 0 {\na: calc 1\na requires b\n}", 4,
     "no operation above has the label 'b'"},
    {"num_ranks 1\nrank 0 {\na requires a\n}", 3, "no operation above has the label 'a'"},
    {"num_ranks 2\nrank 0 {\na: calc 1\n}\nrank 1 {\na requires a\n}", 6,
     "no operation above has the label 'a'"},
    {"num_ranks 1\nrank 0 {\na: calc 1\na needs a\n}", 4,
     "'needs' where ':', 'requires' or 'irequires' is"},
    {"num_ranks 1\nrank 0 {\na: wait 1\n}", 3, "'wait' where 'send', 'recv' or 'calc' is expected"},
    {"num_ranks 1\nrank 0 {\n/* never", 3, "a remark that does not end"},
    {"num_ranks 1\nrank 0 {\n%\n}", 3, "'%' where an operation, a label or '}' is expected"},
    {"// mimdsim time unit: 1 s\nnum_ranks 1\n", 1,
     "a time unit of '1 s'; expected 1 ps, 1 ns or 1 us"},
    {"num_ranks 1\nrank 0 {\na: calc 1\na requires a\n}", 3,
     "1 operations of the schedule wait for each other"},
    {"num_ranks 1\nrank 0 {\nx: calc 0\na: calc 1\nb: calc 2\na requires b\nb irequires a\nx "
     "requires x\n}",
     3,
     "3 operations of the schedule wait for each other in circles; the first of them is number "
     "0 of rank 0"},
};

static void mistakes_are_told_with_their_line(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct arena *a = arena_create();
        struct err e;
        assert_null(read_text(cases[i].text, a, &e));
        if (e.line != cases[i].line || !strstr(e.text, cases[i].said))
            fail_msg("case %d: line %d: %s", (int)i, e.line, e.text);
        assert_string_equal(e.file, "x.goal");
        assert_int_equal(e.kind, ERR_DATA);
        arena_destroy(a);
    }
}

/* Neither depth nor number of anything is a matter of the stack. */
static void long_chains_are_read(void **state)
{
    (void)state;
    enum { N = 200000 };
    char *text = malloc(64 * (size_t)N), *s = text;
    s += sprintf(s, "num_ranks 1\nrank 0 {\n");
    for (int i = 0; i < N; i++) {
        s += sprintf(s, "l%d: calc 1\n", i);
        if (i > 0) s += sprintf(s, "l%d requires l%d\n", i, i - 1);
    }
    strcpy(s, "}\n");
    struct arena *a = arena_create();
    struct err e;
    const struct schedule *x = read_text(text, a, &e);
    assert_non_null(x);
    assert_int_equal(x->nop, N);
    assert_int_equal(x->op[N - 1].needs, 1);
    strcpy(s, "l0 requires l199999\n}\n");
    assert_null(read_text(text, a, &e));
    assert_non_null(strstr(e.text, "200000 operations"));
    free(text);
    arena_destroy(a);
}

/* ---- binary ---- */

struct bytes {
    unsigned char s[1024];
    int n;
};

static void put(struct bytes *b, uint64_t x, int n)
{
    for (int i = 0; i < n; i++) b->s[b->n++] = (unsigned char)(x >> (8 * i));
}

static void put_op(struct bytes *b, int needs, int kind, uint32_t peer, uint64_t size, uint32_t tag,
                   int cpu, int done, int done_at, int start, int start_at)
{
    put(b, (uint64_t)needs, 4), put(b, (uint64_t)kind, 1), put(b, peer, 4), put(b, size, 8),
        put(b, tag, 4);
    put(b, (uint64_t)cpu, 1), put(b, 0, 1);
    put(b, (uint64_t)done, 4), put(b, (uint64_t)done_at, 4), put(b, (uint64_t)start, 4),
        put(b, (uint64_t)start_at, 4);
}

/* The schedule two_ranks, byte by byte. */
static struct bytes two_ranks_binary(void)
{
    struct bytes b = {.n = 0};
    put(&b, 4223, 8), put(&b, 2, 4), put(&b, 3, 1), put(&b, 1, 1);
    const int first = 6 + 2 * 16, second = first + 8 + 2 * 4 + 3 * 39 + 2 * 4,
              end = second + 8 + 2 * 4 + 2 * 39;
    put(&b, (uint64_t)first, 8), put(&b, (uint64_t)second, 8), put(&b, (uint64_t)second, 8),
        put(&b, (uint64_t)end, 8);
    put(&b, 3, 4), put(&b, 2, 4), put(&b, 0, 4), put(&b, 2, 4);
    put_op(&b, 0, 3, 0, 70, 0, 1, 1, 0, 1, 1);
    put_op(&b, 2, 1, 1, 8, 3, 0, 0, 2, 0, 2);
    put_op(&b, 0, 1, 1, 100, 0, 3, 0, 2, 0, 2);
    put(&b, 1, 4), put(&b, 1, 4);
    put(&b, 2, 4), put(&b, 2, 4), put(&b, 0, 4), put(&b, 1, 4);
    put_op(&b, 0, 2, 0, 8, 3, 0, 0, 0, 0, 0);
    put_op(&b, 0, 2, UINT32_MAX, 100, UINT32_MAX, 2, 0, 0, 0, 0);
    assert_int_equal(b.n, 8 + end);
    return b;
}

static struct schedule *read_binary(const struct bytes *b, int n, struct arena *a, struct err *e)
{
    /* of its own length on the heap, so that a read beyond the end is seen */
    char *copy = malloc((size_t)n);
    memcpy(copy, b->s, (size_t)n);
    err_clear(e);
    struct schedule *s =
        goal_is_binary(copy, (size_t)n) ? goal_read_binary(copy, (size_t)n, "x.goal", a, e) : NULL;
    free(copy);
    return s;
}

static void binary_is_read(void **state)
{
    (void)state;
    struct arena *a = arena_create();
    struct err e;
    struct bytes b = two_ranks_binary();
    const struct schedule *s = read_binary(&b, b.n, a, &e);
    if (!s) fail_msg("%s", e.text);
    expect_two_ranks(s, false);
    b.s[0] = 2342 & 255, b.s[1] = 2342 >> 8;
    assert_null(read_binary(&b, b.n, a, &e));
    assert_non_null(strstr(e.text, "used up"));
    arena_destroy(a);
}

/* Cut off anywhere it is refused; with any byte changed it is refused or is a schedule, within its
 * memory. */
static void broken_binary_is_refused(void **state)
{
    (void)state;
    const struct bytes whole = two_ranks_binary();
    struct random r = random_make(5, 0, 0);
    struct err e;
    /* an operation of the list that is one beyond the last */
    struct bytes beyond = whole;
    struct arena *memory = arena_create();
    beyond.s[8 + 38 + 8 + 8 + 3 * 39] = 3;
    assert_null(read_binary(&beyond, beyond.n, memory, &e));
    assert_non_null(strstr(e.text, "rank 0: a dependency of operation 3"));
    arena_destroy(memory);
    for (int n = 1; n < whole.n; n++) {
        struct arena *a = arena_create();
        assert_null(read_binary(&whole, n, a, &e));
        arena_destroy(a);
    }
    for (int k = 0; k < 20000; k++) {
        struct arena *a = arena_create();
        struct bytes b = whole;
        for (int changes = 1 + k % 3; changes > 0; changes--)
            b.s[8 + random_below(&r, b.n - 8)] = (unsigned char)random_below(&r, k & 1 ? 256 : 4);
        const struct schedule *s = read_binary(&b, b.n, a, &e);
        if (!s) assert_int_equal(e.kind, ERR_DATA);
        for (int64_t i = 0; s && i < s->nop; i++)
            assert_true(s->op[i].peer >= -1 && s->op[i].peer < s->nrank);
        arena_destroy(a);
    }
}

/* The text, too, with bytes changed, dropped and doubled. */
static void broken_text_is_refused(void **state)
{
    (void)state;
    struct random r = random_make(6, 0, 0);
    static const char some[] = "0123456789-{}:/*\n ablrcs\"%\377";
    for (int k = 0; k < 20000; k++) {
        char text[2 * sizeof two_ranks], *s = text;
        struct arena *a = arena_create();
        struct err e;
        for (const char *p = two_ranks; *p; p++) {
            const int64_t what = random_below(&r, 200);
            if (what == 0) continue;
            *s++ = what == 1 ? some[random_below(&r, sizeof some - 1)] : *p;
            if (what == 2) *s++ = *p;
        }
        *s = '\0';
        if (!read_text(text, a, &e)) assert_true(e.kind == ERR_DATA && e.line >= 1 && e.line < 20);
        arena_destroy(a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_read),
        cmocka_unit_test(mistakes_are_told_with_their_line),
        cmocka_unit_test(long_chains_are_read),
        cmocka_unit_test(binary_is_read),
        cmocka_unit_test(broken_binary_is_refused),
        cmocka_unit_test(broken_text_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
