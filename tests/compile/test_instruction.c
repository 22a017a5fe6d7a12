/* test_instruction.c - statements of a line, and the work of instructions, against manuals read by
 * hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compile/instruction.h"

struct expected {
    const char *text;
    struct block_counts c; /* instruction, flop, div, sqrt, trig, call, bytes */
    enum flow flow;
    bool frame;
};

static const struct expected expected[] = {
    {"addl %eax, %edx", {.instruction = 1}, FLOW_ON, 0},
    {"movq 8(%rdi,%rax,8), %rdx", {1, .bytes = 8}, FLOW_ON, 0},
    {"movq %rdx, 8(%rdi,%rax,8)", {1, .bytes = 8}, FLOW_ON, 0},
    {"movl %eax, x(%rip)", {1, .bytes = 4}, FLOW_ON, 0},
    {"movsd .LC3(%rip), %xmm0", {.instruction = 1}, FLOW_ON, 0},
    {"movq stdout@GOTPCREL(%rip), %rax", {.instruction = 1}, FLOW_ON, 0},
    {"movl 12(%rsp), %eax", {.instruction = 1}, FLOW_ON, 0},
    {"movl -12(%rbp), %eax", {.instruction = 1}, FLOW_ON, 1},
    {"movl -12(%rbp), %eax", {1, .bytes = 4}, FLOW_ON, 0},
    {"addl $1, (%rax)", {1, .bytes = 8}, FLOW_ON, 0},
    {"addl (%rax), %edx", {1, .bytes = 4}, FLOW_ON, 0},
    {"cmpb $0, (%rax)", {1, .bytes = 1}, FLOW_ON, 0},
    {"incq (%rax)", {1, .bytes = 16}, FLOW_ON, 0},
    {"lock cmpxchgl %edx, (%rdi)", {1, .bytes = 4}, FLOW_ON, 0},
    {"lock xaddq %rax, (%rdi)", {1, .bytes = 16}, FLOW_ON, 0},
    {"movzbl (%rax), %edx", {1, .bytes = 1}, FLOW_ON, 0},
    {"movslq (%rax), %rdx", {1, .bytes = 4}, FLOW_ON, 0},
    {"movswl (%rax), %edx", {1, .bytes = 2}, FLOW_ON, 0},
    {"sete (%rax)", {1, .bytes = 1}, FLOW_ON, 0},
    {"imull (%rax), %edx", {1, .bytes = 4}, FLOW_ON, 0},
    {"leaq 8(%rdi,%rax,8), %rdx", {.instruction = 1}, FLOW_ON, 0},
    {"nopw 0(%rax,%rax)", {.instruction = 1}, FLOW_ON, 0},
    {"prefetcht0 (%rax)", {.instruction = 1}, FLOW_ON, 0},
    {"idivl %ecx", {1, .div = 1}, FLOW_ON, 0},
    {"divq 8(%rax)", {1, .div = 1, .bytes = 8}, FLOW_ON, 0},
    /* SSE and AVX, by lanes */
    {"addsd %xmm1, %xmm0", {1, .flop = 1}, FLOW_ON, 0},
    {"mulsd 8(%rdi), %xmm0", {1, .flop = 1, .bytes = 8}, FLOW_ON, 0},
    {"subss (%rdi), %xmm0", {1, .flop = 1, .bytes = 4}, FLOW_ON, 0},
    {"addpd (%rdi), %xmm0", {2, .flop = 2, .bytes = 16}, FLOW_ON, 0},
    {"mulps %xmm1, %xmm0", {2, .flop = 4}, FLOW_ON, 0},
    {"vaddpd %ymm1, %ymm0, %ymm2", {4, .flop = 4}, FLOW_ON, 0},
    {"vmulps (%rdi), %zmm0, %zmm2", {8, .flop = 16, .bytes = 64}, FLOW_ON, 0},
    {"vfmadd231sd (%rdi), %xmm0, %xmm2", {1, .flop = 2, .bytes = 8}, FLOW_ON, 0},
    {"vfnmadd132pd %ymm1, %ymm0, %ymm2", {4, .flop = 8}, FLOW_ON, 0},
    {"vfmsub213ps %xmm1, %xmm0, %xmm2", {2, .flop = 8}, FLOW_ON, 0},
    {"divsd %xmm1, %xmm0", {1, .div = 1}, FLOW_ON, 0},
    {"vdivps %ymm1, %ymm0, %ymm2", {4, .div = 8}, FLOW_ON, 0},
    {"sqrtsd %xmm0, %xmm0", {1, .sqrt = 1}, FLOW_ON, 0},
    {"sqrtpd %xmm0, %xmm0", {2, .sqrt = 2}, FLOW_ON, 0},
    {"haddpd %xmm0, %xmm0", {2, .flop = 2}, FLOW_ON, 0},
    {"maxsd %xmm1, %xmm0", {1, .flop = 1}, FLOW_ON, 0},
    {"ucomisd (%rax), %xmm0", {1, .bytes = 8}, FLOW_ON, 0},
    {"movapd %xmm0, (%rax)", {2, .bytes = 16}, FLOW_ON, 0},
    {"movups (%rax), %xmm0", {2, .bytes = 16}, FLOW_ON, 0},
    {"movhps %xmm0, (%rax)", {1, .bytes = 8}, FLOW_ON, 0},
    {"movss %xmm0, (%rax)", {1, .bytes = 4}, FLOW_ON, 0},
    {"movd (%rax), %xmm0", {1, .bytes = 4}, FLOW_ON, 0},
    {"movq %xmm0, %rax", {.instruction = 1}, FLOW_ON, 0},
    {"vmovdqu %ymm0, (%rax)", {4, .bytes = 32}, FLOW_ON, 0},
    {"paddd (%rax), %xmm0", {2, .bytes = 16}, FLOW_ON, 0},
    {"cvttsd2sil %xmm0, %eax", {.instruction = 1}, FLOW_ON, 0},
    {"cvtsi2sdl (%rax), %xmm0", {1, .bytes = 4}, FLOW_ON, 0},
    {"cvtss2sd (%rax), %xmm0", {1, .bytes = 4}, FLOW_ON, 0},
    /* x87 */
    {"fldt (%rax)", {1, .bytes = 10}, FLOW_ON, 0},
    {"fldl (%rax)", {1, .bytes = 8}, FLOW_ON, 0},
    {"fstps (%rax)", {1, .bytes = 4}, FLOW_ON, 0},
    {"fildl (%rax)", {1, .bytes = 4}, FLOW_ON, 0},
    {"fildll (%rax)", {1, .bytes = 8}, FLOW_ON, 0},
    {"faddp %st, %st(1)", {1, .flop = 1}, FLOW_ON, 0},
    {"fmull (%rax)", {1, .flop = 1, .bytes = 8}, FLOW_ON, 0},
    {"fdivrp %st, %st(1)", {1, .div = 1}, FLOW_ON, 0},
    {"fsqrt", {1, .sqrt = 1}, FLOW_ON, 0},
    {"fsincos", {1, .trig = 2}, FLOW_ON, 0},
    {"fyl2x", {1, .trig = 1}, FLOW_ON, 0},
    /* where control goes */
    {"jne .L4", {.instruction = 1}, FLOW_BRANCH, 0},
    {"jmp .L4", {.instruction = 1}, FLOW_AWAY, 0},
    {"jmp *.L4(,%rax,8)", {.instruction = 1}, FLOW_AWAY, 0},
    {"notrack jmp *%rax", {.instruction = 1}, FLOW_AWAY, 0},
    {"ret", {.instruction = 1}, FLOW_AWAY, 0},
    {"rep ret", {.instruction = 1}, FLOW_AWAY, 0},
    {"ud2", {.instruction = 1}, FLOW_AWAY, 0},
    {"call f@PLT", {1, .call = 1}, FLOW_CALL, 0},
    {"call *%rax", {1, .call = 1}, FLOW_CALL, 0},
    {"call sin@PLT", {1, .trig = 1, .call = 1}, FLOW_CALL, 0},
    {"call expf@PLT", {1, .trig = 1, .call = 1}, FLOW_CALL, 0},
    {"call *cosl@GOTPCREL(%rip)", {1, .trig = 1, .call = 1}, FLOW_CALL, 0},
    {"jmp pow@PLT", {1, .trig = 2}, FLOW_AWAY, 0},
    {"call sqrt@PLT", {1, .sqrt = 1, .call = 1}, FLOW_CALL, 0},
    {"call sinister@PLT", {1, .call = 1}, FLOW_CALL, 0},
    {"call __divdc3@PLT", {1, .flop = 6, .div = 3, .call = 1}, FLOW_CALL, 0},
    {"call _ZGVbN2v_sin@PLT", {1, .trig = 2, .call = 1}, FLOW_CALL, 0},
    {"call _ZGVdN8vv_powf@PLT", {1, .trig = 16, .call = 1}, FLOW_CALL, 0},
};

static void each_instruction_counts_what_it_does(void **state)
{
    (void)state;
    for (unsigned i = 0; i < sizeof expected / sizeof expected[0]; i++) {
        const struct expected *x = &expected[i];
        const char *at = x->text;
        const struct asm_statement s = asm_next(&at, x->text + strlen(x->text));
        assert_int_equal(s.kind, ASM_INSTRUCTION);
        struct block_counts c;
        const enum flow flow = instruction_read(s.word, s.operands, x->frame, &c);
        /* However wide, it is issued once. */
        assert_int_equal(c.issue, 1);
        c.issue = c.load = c.whole = c.add = c.multiply = 0;
        if (flow != x->flow || memcmp(&c, &x->c, sizeof c) != 0)
            fail_msg("%s: flow %d, counts %u %u %u %u %u %u %u", x->text, flow, c.instruction,
                     c.flop, c.div, c.sqrt, c.trig, c.call, c.bytes);
    }
}

/* Loads of vector registers and computing with whole numbers, which have prices of their own. */
static void units_of_a_processor(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int load, whole;
    } cases[] = {
        {"movsd (%rdi,%rax,8), %xmm1", 1, 0},
        {"movsd %xmm1, (%rdi,%rax,8)", 0, 0},
        {"addsd .LC0(%rip), %xmm1", 1, 0},
        {"vfmadd213pd 8(%rsp), %ymm1, %ymm0", 1, 0},
        {"comisd (%rax), %xmm1", 1, 0},
        {"cmpltsd (%rax), %xmm1", 1, 0},
        {"mulsd %xmm0, %xmm1", 0, 0},
        {"movl (%rdi), %eax", 0, 0},
        {"addl (%rdi), %eax", 0, 1},
        {"leaq 8(%rdi,%rsi), %rax", 0, 1},
        {"cmpq %rax, %rdi", 0, 1},
        {"sarq %rdx", 0, 1},
        {"imulq %rdi", 0, 2},
        {"imulq %rdi, %rax", 0, 1},
        {"mulq %rcx", 0, 2},
        {"idivq %rcx", 0, 1},
        {"movq %rax, %rdi", 0, 0},
        {"cvtsi2sdq %rdx, %xmm1", 0, 1},
        {"cvtsi2sdl (%rdx), %xmm1", 1, 0},
        {"cvttsd2siq %xmm0, %rcx", 0, 0},
        {"pushq %rbx", 0, 0},
        {"nopw (%rax)", 0, 0},
        {"fldl (%rax)", 0, 0},
        {"jne .L3", 0, 0},
        {"call f@PLT", 0, 0},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *at = cases[i].text;
        const struct asm_statement s = asm_next(&at, at + strlen(at));
        struct block_counts c;
        instruction_read(s.word, s.operands, false, &c);
        if (c.load != cases[i].load || c.whole != cases[i].whole)
            fail_msg("%s: %u loads, %u whole", cases[i].text, c.load, c.whole);
    }
}

/* Units for floating-point numbers: those that add, and those that multiply. */
static void units_for_floating_point_numbers(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int add, multiply;
    } cases[] = {
        {"addsd %xmm0, %xmm1", 1, 0},
        {"vsubps %ymm0, %ymm1, %ymm2", 1, 0},
        {"maxsd (%rax), %xmm1", 1, 0},
        {"cmpltsd %xmm0, %xmm1", 1, 0},
        {"ucomisd %xmm0, %xmm1", 1, 0},
        {"vhaddpd %xmm0, %xmm1, %xmm2", 1, 0},
        {"cvtss2sd %xmm0, %xmm1", 1, 0},
        {"cvttsd2siq %xmm0, %rcx", 1, 0},
        {"cvtsi2sdq %rdx, %xmm1", 2, 0},
        {"vcvtsi2sdl (%rdx), %xmm1, %xmm1", 2, 0},
        {"mulsd %xmm0, %xmm1", 0, 1},
        {"vmulpd %zmm0, %zmm1, %zmm2", 0, 1},
        {"vfmadd231sd %xmm0, %xmm1, %xmm2", 0, 1},
        {"vfnmadd132ps %xmm0, %xmm1, %xmm2", 0, 1},
        {"dppd $1, %xmm0, %xmm1", 0, 1},
        {"divsd %xmm0, %xmm1", 0, 0},
        {"sqrtsd %xmm0, %xmm1", 0, 0},
        {"movsd %xmm0, %xmm1", 0, 0},
        {"andpd %xmm0, %xmm1", 0, 0},
        {"paddd %xmm0, %xmm1", 0, 0},
        {"pmulld %xmm0, %xmm1", 0, 0},
        {"addq %rax, %rdx", 0, 0},
        {"mulq %rcx", 0, 0},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const char *at = cases[i].text;
        const struct asm_statement s = asm_next(&at, at + strlen(at));
        struct block_counts c;
        instruction_read(s.word, s.operands, false, &c);
        if (c.add != cases[i].add || c.multiply != cases[i].multiply)
            fail_msg("%s: %u additions, %u products", cases[i].text, c.add, c.multiply);
    }
}

static void a_line_falls_into_its_statements(void **state)
{
    (void)state;
    static const char line[] =
        "f:1:\trep movsb; lock /* , ; */ addl $1, (%rax,%rcx) ; .string \"a;#\\\"b\" ; rep # c; d";
    static const struct {
        enum asm_kind kind;
        const char *word, *operands;
    } piece[] = {{ASM_LABEL, "f", ""},
                 {ASM_LABEL, "1", ""},
                 {ASM_INSTRUCTION, "movsb", ""},
                 {ASM_PREFIX, "lock", ""},
                 {ASM_INSTRUCTION, "addl", "$1, (%rax,%rcx)"},
                 {ASM_DIRECTIVE, ".string", "\"a;#\\\"b\""},
                 {ASM_PREFIX, "rep", ""},
                 {ASM_NOTHING, "", ""}};
    const char *at = line;
    for (unsigned i = 0; i < sizeof piece / sizeof piece[0]; i++) {
        const struct asm_statement s = asm_next(&at, line + sizeof line - 1);
        assert_int_equal(s.kind, piece[i].kind);
        assert_true(span_is(s.word, piece[i].word));
        assert_true(span_is(s.operands, piece[i].operands));
        if (i == 2) assert_ptr_equal(s.begin, strstr(line, "rep movsb"));
    }
    const char *operands = "$1, (%rax,%rcx) ,%ymm1";
    const struct span all = {operands, (int)strlen(operands)};
    assert_true(span_is(asm_operand(all, 0), "$1"));
    assert_true(span_is(asm_operand(all, 1), "(%rax,%rcx)"));
    assert_true(span_is(asm_operand(all, 2), "%ymm1"));
    assert_int_equal(asm_operand(all, 3).n, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(units_of_a_processor),
        cmocka_unit_test(units_for_floating_point_numbers),
        cmocka_unit_test(a_line_falls_into_its_statements),
        cmocka_unit_test(each_instruction_counts_what_it_does),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
