/* test_chain.c - the longest chain of loops, counted by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compile/chain.h"

struct loop {
    const char *text; /* the instructions of a round */
    int flop, cycles;
};

static const struct loop loops[] = {
    /* the counter of the loop alone */
    {"addq $1, %rax; cmpq %rax, %rdx; jne .L3", 0, 1},
    /* a sum waits for its addition, not for the product, which waits for nothing */
    {"movsd (%rdi,%rax,8), %xmm1; mulsd (%rsi,%rax,8), %xmm1; addsd %xmm1, %xmm0; addq $1, %rax", 1,
     0},
    /* a product and a sum of the same number */
    {"mulsd %xmm2, %xmm0; addsd %xmm3, %xmm0; addq $1, %rax", 1, 4},
    {"vfmadd213sd %xmm3, %xmm2, %xmm0", 0, 4},
    /* what is overwritten begins anew */
    {"movsd (%rdi), %xmm0; addsd %xmm2, %xmm0; addsd %xmm3, %xmm0; movsd %xmm0, (%rdi)", 0, 0},
    {"vaddsd %xmm1, %xmm2, %xmm0; incl %ecx", 0, 1},
    {"vaddsd %xmm1, %xmm0, %xmm0", 1, 0},
    {"vmovsd (%rdi), %xmm0; vmulsd %xmm0, %xmm0, %xmm1", 0, 0},
    {"pxor %xmm0, %xmm0; cvtsi2sdl %eax, %xmm0; addsd %xmm0, %xmm0; addl $2, %eax", 0, 1},
    {"xorl %eax, %eax; imulq %rax, %rax; addq $1, %rdx", 0, 1},
    /* not of itself: the sum stays in the chain */
    {"subq %rdx, %rax; imulq %rdx, %rax", 0, 4},
    /* whole numbers: product and sum; each address from the last load */
    {"imulq %rdx, %rax; addq %rcx, %rax; subq $1, %rsi", 0, 4},
    {"movslq (%rdi,%rax,4), %rax; subq $1, %rdx", 0, 4},
    {"movl (%rdi,%rax,4), %eax; cltq; incl %edx", 0, 5},
    /* through two registers, and through parts of one */
    {"leaq 1(%rax), %rdx; leaq 1(%rdx), %rax", 0, 2},
    {"movapd %xmm0, %xmm5; addsd %xmm1, %xmm5; movapd %xmm5, %xmm0", 1, 0},
    {"addb $1, %al; movzbl %al, %ecx; addl %ecx, %eax", 0, 2},
    {"addl %r8d, %r9d; addq %r9, %r8", 0, 2},
    /* every second round */
    {"movapd %xmm0, %xmm1; mulsd %xmm4, %xmm2; movapd %xmm2, %xmm0; movapd %xmm1, %xmm2", 0, 2},
    /* divisions and roots wait long; those of integers through rax and rdx */
    {"divsd %xmm1, %xmm0", 0, 13},
    {"sqrtsd %xmm0, %xmm0", 0, 18},
    {"sqrtpd %xmm1, %xmm0", 0, 0},
    {"cqto; idivq %rcx", 0, 14},
    {"mulq %rcx", 0, 3},
    /* stores are waited for by nobody, comparisons by who asks for flags */
    {"movsd %xmm0, (%rdi); addq $8, %rdi", 0, 1},
    {"comisd %xmm0, %xmm1; addq $1, %rax", 0, 1},
    {"cmpq %rax, %rdx; cmovl %rdx, %rax", 0, 2},
    {"cmpl $3, (%rdi,%rax,4); setl %cl; movzbl %cl, %ecx; addq %rcx, %rax", 0, 7},
    {"cmpq $3, %rax; setl %al; movzbl %al, %eax", 0, 2},
    {"paddd %xmm1, %xmm0", 0, 1},
    {"maxsd %xmm1, %xmm0; jmp .L1", 1, 0},
    {"nop; ", 0, 0},
};

static struct chain_length round_of(const char *text)
{
    struct chain c = {0};
    const char *end = text + strlen(text);
    for (struct asm_statement s; (s = asm_next(&text, end)).kind == ASM_INSTRUCTION;)
        chain_add(&c, chain_step_of(s.word, s.operands));
    return chain_round(&c);
}

static void chains_of_loops(void **state)
{
    (void)state;
    for (unsigned i = 0; i < sizeof loops / sizeof loops[0]; i++) {
        const struct chain_length round = round_of(loops[i].text);
        if (round.flop != loops[i].flop || round.cycles != loops[i].cycles)
            fail_msg("%s: %d operations and %d cycles", loops[i].text, round.flop, round.cycles);
    }
}

/* Which additions wait for something else than an addition, and how many products there are. */
static void additions_and_products_of_a_chain(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        struct chain_length round;
    } cases[] = {
        {"addsd %xmm1, %xmm0; mulsd %xmm2, %xmm3", {.flop = 0, .cycles = 4, .product = 1}},
        {"mulsd %xmm2, %xmm0; addsd %xmm3, %xmm0", {1, 4, 1, 1}},
        {"addsd %xmm2, %xmm0; addsd %xmm3, %xmm0", {2, 0, 0, 0}},
        {"mulsd %xmm2, %xmm0; vmulpd %ymm3, %ymm0, %ymm0", {0, 8, 0, 2}},
        {"vfmadd213sd %xmm3, %xmm2, %xmm0", {0, 4, 0, 0}},
        {"addsd %xmm1, %xmm0; movq %xmm0, %rax; addsd (%rdi,%rax,8), %xmm0", {2, 4, 1, 0}},
        /* through moves among registers */
        {"addsd %xmm2, %xmm0; mulsd %xmm3, %xmm0; subsd %xmm4, %xmm0; movapd %xmm0, %xmm6; "
         "maxsd %xmm5, %xmm6; movapd %xmm6, %xmm0",
         {3, 4, 1, 1}},
        {"imulq %rdx, %rax; cvtsi2sdq %rax, %xmm0; addsd %xmm0, %xmm0; cvttsd2siq %xmm0, %rax",
         {1, 11, 1, 0}},
        /* every second round: no more products than the cycles are of */
        {"movapd %xmm0, %xmm1; mulsd %xmm4, %xmm2; movapd %xmm2, %xmm0; movapd %xmm1, %xmm2",
         {0, 2, 0, 0}},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct chain_length *x = &cases[i].round, l = round_of(cases[i].text);
        if (memcmp(x, &l, sizeof l) != 0)
            fail_msg("%s: %d additions, %d late, %d cycles, %d products", cases[i].text, l.flop,
                     l.late, l.cycles, l.product);
    }
}

static void too_many_instructions_are_left_out(void **state)
{
    (void)state;
    struct chain c = {0};
    const struct span m = {"addsd", 5}, o = {"%xmm1, %xmm0", 12};
    assert_int_equal(chain_round(&c).flop, 0);
    for (int i = 0; i < 2 * CHAIN_MOST; i++) chain_add(&c, chain_step_of(m, o));
    assert_int_equal(c.n, CHAIN_MOST);
    assert_int_equal(chain_round(&c).flop, CHAIN_MOST);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chains_of_loops),
        cmocka_unit_test(additions_and_products_of_a_chain),
        cmocka_unit_test(too_many_instructions_are_left_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
