/* test_loops.c - loops by their code: which ones overlap, how often those inside are made, what a
 * round does. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compile/block_filter.h"
#include "compile/rounds.h"

/* What an entry of a loop says; nothing at all: blocks = 0. */
struct said {
    unsigned entries, instructions, loads, flop, cycle, blocks;
};

/* The entries of loops in the table of a function with this body; returns how many. */
static int loops_of(const char *body, struct said *said, int most)
{
    static const struct block_source source = {"loop.c", "-O2", false, false};
    struct text in = {0}, out = {0};
    struct err e;
    err_clear(&e);
    int n = 0;
    text_add(&in, "\t.text\nf:\n%s\tret\n", body);
    if (!block_filter(&in, &source, &out, &e)) fail_msg("%s", e.text);
    for (char *s = out.s; (s = strstr(s, "\t.long ")) != NULL; s++) {
        struct said x;
        unsigned kind, entries;
        if (sscanf(s,
                   " .long %u,0\n .value "
                   "%*u,%*u,%*u,%*u,%*u,%*u,%*u,%u,%u,%*u,%*u,%*u,%u,%u,%*u,%*u,%u,%*u,%*u,%*u,%*u,"
                   "%u",
                   &entries, &x.instructions, &x.loads, &x.flop, &x.cycle, &x.blocks, &kind) != 7)
            continue;
        x.entries = entries;
        assert_int_equal(kind, BLOCK_LOOP);
        if (n < most) said[n] = x;
        n++;
    }
    text_free(&in);
    text_free(&out);
    return n;
}

/* --- rounds ----------------------------------------------------------------------------------- */

/* A loop inside of another one, whose rounds are what is asked for: before both, before the inner
 * one, and its end. Each round of the inner one has one load. */
struct rounds {
    const char *before, *between, *test;
    unsigned rounds;
};

static const struct rounds counted[] = {
    {"", "\txorl %eax, %eax\n", "\taddq $8, %rax\n\tcmpq $24, %rax\n\tjne .L2\n", 3},
    {"", "\tmovl $2, %eax\n", "\taddl $1, %eax\n\tcmpl $9, %eax\n\tjl .L2\n", 7},
    {"", "\tmovl $2, %eax\n", "\taddl $1, %eax\n\tcmpl $9, %eax\n\tjle .L2\n", 8},
    {"", "\tmovl $0, %eax\n", "\taddl $4, %eax\n\tcmpl $9, %eax\n\tjl .L2\n", 3},
    {"", "\tmovl $5, %eax\n", "\tsubl $1, %eax\n\tjne .L2\n", 5},
    {"", "\tmovl $5, %eax\n", "\tdecl %eax\n\tcmpl $0, %eax\n\tjge .L2\n", 6},
    /* from one pointer to another */
    {"\tmovq (%rdi), %rsi\n\tleaq 64(%rsi), %rdx\n", "\tmovq %rsi, %rax\n",
     "\taddq $8, %rax\n\tcmpq %rax, %rdx\n\tjne .L2\n", 8},
    {"\tleaq 64(%rsp), %rbp\n\tleaq 88(%rsp), %r13\n", "\tmovq %rbp, %rax\n",
     "\taddq $8, %rax\n\tcmpq %rax, %r13\n\tjne .L2\n", 3},
    {"", "\tleaq 48(%rdi), %rdx\n\tmovq %rdi, %rax\n",
     "\tleaq 16(%rax), %rax\n\tcmpq %rdx, %rax\n\tjne .L2\n", 3},
    {"", "\tmovq %rdi, %rax\n\taddq $8, %rax\n\tleaq 40(%rdi), %rdx\n",
     "\taddq $8, %rax\n\tcmpq %rdx, %rax\n\tjne .L2\n", 4},
    /* an index that is zero when the loop around begins, and its end that goes with it */
    {"\tmovl $24, %ebp\n\txorl %ebx, %ebx\n", "\tleaq 0(,%rbx,8), %rax\n",
     "\taddq $8, %rax\n\tcmpq %rax, %rbp\n\tjne .L2\n", 3},
    {"\tmovl $2, %ebx\n", "\tleaq 8(%rdi,%rbx,4), %rax\n\tleaq 40(%rdi), %rdx\n",
     "\taddq $8, %rax\n\tcmpq %rax, %rdx\n\tjne .L2\n", 3},
    {"", "\tleaq (%rdi,%rbx), %rax\n\tleaq 40(%rdi), %rdx\n",
     "\taddq $8, %rax\n\tcmpq %rax, %rdx\n\tjne .L2\n", 0},
    /* not known: another register, a bound that moves, a step that is none, memory, too many */
    {"", "\txorl %eax, %eax\n", "\taddq $8, %rax\n\tcmpq %rsi, %rax\n\tjne .L2\n", 0},
    {"\tleaq 64(%rdi), %rdx\n", "\tmovq %rsi, %rax\n",
     "\taddq $8, %rax\n\tcmpq %rax, %rdx\n\tjne .L2\n", 0},
    {"", "\txorl %eax, %eax\n\tmovl $9, %edx\n",
     "\tsubl $1, %edx\n\taddl $1, %eax\n\tcmpl %eax, %edx\n\tjne .L2\n", 0},
    {"", "\tmovl $3, %eax\n", "\taddl %ecx, %eax\n\tcmpl $9, %eax\n\tjne .L2\n", 0},
    {"", "\txorl %eax, %eax\n", "\taddq $8, %rax\n\tcmpq (%rsi), %rax\n\tjne .L2\n", 0},
    {"", "\txorl %eax, %eax\n", "\taddq $1, %rax\n\tcmpq $20000, %rax\n\tjne .L2\n", 0},
    {"", "\txorl %eax, %eax\n", "\tsubq $1, %rax\n\tcmpq $20, %rax\n\tjne .L2\n", 0},
    {"", "\tmovl $5, %eax\n", "\taddl $1, %eax\n\taddl $1, %eax\n\tcmpl $9, %eax\n\tjne .L2\n", 0},
};

static void rounds_follow_from_registers(void **state)
{
    (void)state;
    for (unsigned i = 0; i < sizeof counted / sizeof counted[0]; i++) {
        const struct rounds *x = &counted[i];
        char body[512];
        struct said s = {0};
        snprintf(body, sizeof body,
                 "%s.L1:\n%s.L2:\n\tmulsd (%%r9,%%r10), %%xmm0\n%s\taddq $1, %%rcx\n"
                 "\tcmpq %%rcx, %%r8\n\tjne .L1\n",
                 x->before, x->between, x->test);
        const int n = loops_of(body, &s, 1);
        if (n != (x->rounds > 0) || s.loads != x->rounds)
            fail_msg("%s%s: %d loops that overlap, %u rounds", x->between, x->test, n, s.loads);
    }
}

/* A call between may change what it may change. */
static void calls_leave_some_registers(void **state)
{
    (void)state;
    static const char body[] = "\tmovl $3, %%e%s\n\tcall g\n.L1:\n\tmovl %%e%s, %%eax\n.L2:\n"
                               "\tmulsd (%%r9), %%xmm0\n\tsubl $1, %%eax\n\tjne .L2\n"
                               "\taddq $1, %%rcx\n\tcmpq %%rcx, %%r8\n\tjne .L1\n";
    char text[512];
    struct said s;
    snprintf(text, sizeof text, body, "bx", "bx");
    assert_int_equal(loops_of(text, &s, 1), 1);
    snprintf(text, sizeof text, body, "si", "si");
    assert_int_equal(loops_of(text, &s, 1), 0);
}

/* --- loops ------------------------------------------------------------------------------------ */

static void says(const char *body, struct said expected)
{
    struct said s = {0};
    const int n = loops_of(body, &s, 1);
    if (n != (expected.blocks > 0) || memcmp(&s, &expected, sizeof s) != 0)
        fail_msg("%s: %d loops: %u entries, %u instructions, %u loads, chain %u + %u, %u blocks",
                 body, n, s.entries, s.instructions, s.loads, s.flop, s.cycle, s.blocks);
}

static void a_round_is_all_that_is_executed_in_it(void **state)
{
    (void)state;
    /* one block stands alone */
    says(".L1:\n\taddsd (%rax), %xmm0\n\taddq $8, %rax\n\tjne .L1\n", (struct said){0});
    /* two, whose sum is carried through both */
    says(".L1:\n\taddsd (%rax), %xmm0\n\ttestq %rdx, %rdx\n\tje .L2\n\tmulsd %xmm2, %xmm1\n.L2:\n"
         "\taddsd %xmm3, %xmm0\n\taddq $8, %rax\n\tcmpq %rax, %rdx\n\tjne .L1\n",
         (struct said){3, 8, 1, 2, 0, 3});
    /* a product that only one way needs is foreseen; one that both need is not */
    says(".L1:\n\taddq $8, %rax\n\tjne .L2\n\tmulsd %xmm1, %xmm0\n\tjmp .L3\n.L2:\n"
         "\tmulsd %xmm2, %xmm1\n.L3:\n\tcmpq %rax, %rdx\n\tjne .L1\n",
         (struct said){4, 7, 0, 0, 1, 4});
    says(".L1:\n\taddq $8, %rax\n\tjne .L2\n\tmulsd %xmm1, %xmm0\n\tjmp .L3\n.L2:\n"
         "\tmulsd %xmm2, %xmm0\n.L3:\n\tcmpq %rax, %rdx\n\tjne .L1\n",
         (struct said){4, 7, 0, 0, 4, 4});
    /* three rounds inside, a sum of their own each time: what counts is the outer one's */
    says(".L1:\n\txorl %eax, %eax\n\tpxor %xmm0, %xmm0\n.L2:\n\taddsd (%rdi,%rax), %xmm0\n"
         "\taddq $8, %rax\n\tcmpq $24, %rax\n\tjne .L2\n\taddsd %xmm0, %xmm1\n\taddq $24, %rdi\n"
         "\tcmpq %rdi, %rdx\n\tjne .L1\n",
         (struct said){3, 18, 3, 1, 0, 5});
    /* the same with a sum that goes on */
    says(".L1:\n\txorl %eax, %eax\n.L2:\n\taddsd (%rdi,%rax), %xmm0\n"
         "\taddq $8, %rax\n\tcmpq $24, %rax\n\tjne .L2\n\taddq $24, %rdi\n"
         "\tcmpq %rdi, %rdx\n\tjne .L1\n",
         (struct said){3, 16, 3, 3, 0, 5});
}

/* A long loop inside holds the processor up, as it does not look over it: 48 rounds of 4 waiting
 * additions are half hidden behind those of the next row. */
static void what_is_ahead_is_limited(void **state)
{
    (void)state;
    struct said s;
    const char *row = ".L1:\n\txorl %eax, %eax\n\tpxor %xmm0, %xmm0\n.L2:\n\taddsd (%rdi), %xmm0\n"
                      "\taddsd (%rsi), %xmm0\n\taddsd (%rdi), %xmm0\n\taddsd (%rsi), %xmm0\n"
                      "\taddq $16, %rax\n\tcmpq $768, %rax\n\tjne .L2\n\taddq $8, %rcx\n"
                      "\tcmpq %rcx, %rdx\n\tjne .L1\n";
    assert_int_equal(loops_of(row, &s, 1), 1);
    /* 341 = 2 + 48 x 7 + 3 instructions, 50 counters, 192 additions: 192 x 391 / (391 + 448) */
    assert_int_equal(s.instructions, 341);
    assert_int_equal(s.flop, 89);
    /* sixteen times as long is too long */
    char body[512];
    snprintf(body, sizeof body, "%s", row);
    memcpy(strstr(body, "$16,"), "$1, ", 4);
    assert_int_equal(loops_of(body, &s, 1), 0);
}

static void some_loops_do_not_overlap(void **state)
{
    (void)state;
    struct said s[4];
    /* a call, a table of jumps, a loop of unknown rounds inside */
    assert_int_equal(loops_of(".L1:\n\tcall g\n\taddq $1, %rbx\n\tjne .L1\n", s, 4), 0);
    assert_int_equal(
        loops_of(".L1:\n\taddq $1, %rbx\n\tjmp *%rax\n.L2:\n\taddq $1, %rbx\n\tjne .L1\n", s, 4),
        0);
    assert_int_equal(loops_of(".L1:\n\tnop\n.L2:\n\taddq $1, %rbx\n\tjne .L2\n\taddq $1, %rcx\n"
                              "\tjne .L1\n",
                              s, 4),
                     0);
    /* two that cross */
    assert_int_equal(loops_of(".L1:\n\taddq $1, %rbx\n.L2:\n\taddq $1, %rcx\n\tjne .L1\n"
                              "\taddq $1, %rdx\n\tjne .L2\n",
                              s, 4),
                     0);
    /* what is seldom executed lies behind the function and leads back into the loop: no loop */
    assert_int_equal(loops_of(".L1:\n\tsqrtsd %xmm1, %xmm0\n\tja .L9\n.L2:\n\taddq $1, %rcx\n"
                              "\tjne .L1\n\tret\n.L9:\n\tmovq %rax, %rbx\n\tjmp .L2\n",
                              s, 4),
                     1);
    assert_int_equal(s[0].entries, 2);
    /* one after the other, each with an entry of its own */
    assert_int_equal(loops_of(".L1:\n\tje .L2\n\tnop\n.L2:\n\taddq $1, %rbx\n\tjne .L1\n"
                              ".L3:\n\tje .L4\n\tnop\n.L4:\n\taddq $1, %rbx\n\tjne .L3\n",
                              s, 4),
                     2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounds_follow_from_registers),
        cmocka_unit_test(calls_leave_some_registers),
        cmocka_unit_test(a_round_is_all_that_is_executed_in_it),
        cmocka_unit_test(what_is_ahead_is_limited),
        cmocka_unit_test(some_loops_do_not_overlap),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
