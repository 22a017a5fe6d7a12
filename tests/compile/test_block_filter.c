/* test_block_filter.c - where blocks begin and what they count, on assembly written by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "compile/block_filter.h"

static const struct block_source source = {"sum.c", "-O2", false, false};

/* The filtered text, without the note at its end. */
static void filtered(const char *in, struct text *out)
{
    struct text text = {0};
    struct err e;
    err_clear(&e);
    text_add(&text, "%s", in);
    if (!block_filter(&text, &source, out, &e)) fail_msg("%s", e.text);
    char *note = strstr(out->s, "\t.section .note.mimdsim");
    assert_non_null(note);
    *note = '\0';
    text_free(&text);
}

static void filters_to(const char *in, const char *expected)
{
    struct text out = {0};
    filtered(in, &out);
    assert_string_equal(out.s, expected);
    text_free(&out);
}

/* clang-format off: the macros below are pieces of one text */
#define ADD(n) "\t{disp32} leaq 0(%r15), %r15\n.Lmimdsim" n ":\n"
#define TABLE(first)                                                                               \
    "\t.pushsection mimdsim_blocks,\"ao?\",@progbits,.Lmimdsim" first "\n\t.balign 4\n"
/* The last ten are those of the finer prices: instructions, each once, loads, whole numbers,
 * additions, products, a chain of four, blocks. Behind them comes the chain of one round. */
#define ENTRY(n, counts) "\t.long .Lmimdsim" n "-4-.,0\n\t.value " counts ",0,0,0,0,0\n"
#define LOOP(n, counts, once)                                                                      \
    "\t.long .Lmimdsim" n "-4-.,.Lmimdsim_t" n "-.Lmimdsim" n "+7\n\t.value " counts "," once     \
    ",0\n"
#define END "\t.popsection\n"

static void blocks_begin_at_labels_and_behind_branches_and_calls(void **state)
{
    (void)state;
    filters_to(
        "\t.text\n"
        "f:\n.LFB0:\n\t.cfi_startproc\n"
        "\tmulsd\t%xmm0, %xmm0\n"
        "\tcall\tg@PLT\n"
        "\ttestl\t%eax, %eax\n"
        "\tje\t.L3\n"
        "\taddl\t$1, %eax\n"
        ".LVL7:\n"
        "\t.p2align 4,,10\n"
        ".L3:\n"
        "\tmovl\t$0, (%rdi)\n"
        "\tret\n"
        "\t.cfi_endproc\n"
        "\t.section\t.debug_info,\"\",@progbits\n"
        "\t.quad\t.LVL7\n",
        "\t.text\n"
        "f:\n.LFB0:\n\t.cfi_startproc\n" ADD(
            "1") "\tmulsd\t%xmm0, %xmm0\n"
                 "\tcall\tg@PLT\n" ADD(
                     "2") "\ttestl\t%eax, %eax\n"
                          "\tje\t.L3\n" ADD(
                              "3") "\taddl\t$1, %eax\n"
                                   ".LVL7:\n"
                                   "\t.p2align 4,,10\n"
                                   ".L3:\n" ADD("4") "\tmovl\t$0, (%rdi)\n"
                                                     "\tret\n"
                                                     "\t.cfi_endproc\n" TABLE("1")
        ENTRY("1", "2,1,0,0,0,1,0,2,0,0,0,1,0,0,0,0,1")
        ENTRY("2", "2,0,0,0,0,0,0,2,0,1,0,0,0,0,0,0,1")
        ENTRY("3", "1,0,0,0,0,0,0,1,0,1,0,0,0,0,0,0,1")
        ENTRY("4", "2,0,0,0,0,0,4,2,0,0,0,0,0,0,0,0,1")
        END
        "\t.section\t.debug_info,\"\",@progbits\n"
        "\t.quad\t.LVL7\n");
}

static void labels_of_tables_and_landing_pads_begin_blocks(void **state)
{
    (void)state;
    struct text out = {0};
    filtered("f:\n\tnop\n.L1:\n\tnop\n.L2:\n\tnop\n.L3:\n\tnop\n.L4:\n\tret\n"
             "\t.section\t.rodata\n.LT:\n\t.long\t.L1-.LT\n"
             "\t.section\t.gcc_except_table,\"a\",@progbits\n\t.uleb128 .L2-.LFB0\n"
             "\t.text\ng:\n\tleaq\t.L3(%rip), %rax\n\tjmp\t*%rax\n",
             &out);
    assert_non_null(strstr(out.s, ".L1:\n" ADD("2")));
    assert_non_null(strstr(out.s, ".L2:\n" ADD("3")));
    assert_non_null(strstr(out.s, ".L3:\n" ADD("4")));
    assert_null(strstr(out.s, ".L4:\n" ADD("5"))); /* nothing refers to it */
    text_free(&out);
}

static void each_section_has_its_piece_of_the_table(void **state)
{
    (void)state;
    filters_to("\t.section\t.text._Z1fv,\"axG\",@progbits,_Z1fv,comdat\n"
               "f:\n\tret\n"
               "\t.section\t.rodata\n\t.string \"ret\"\n"
               "\t.text\ng:\n\tret\n"
               "\t.section\t.text._Z1fv\n"
               "\t.text\nh:\n\tret\n",
               "\t.section\t.text._Z1fv,\"axG\",@progbits,_Z1fv,comdat\n"
               "f:\n" ADD("1") "\tret\n" TABLE("1")
                   ENTRY("1", "1,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1") END
               "\t.section\t.rodata\n\t.string \"ret\"\n"
               "\t.text\ng:\n" ADD("2") "\tret\n" TABLE("2")
               ENTRY("2", "1,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1") END
               "\t.section\t.text._Z1fv\n"
               "\t.text\nh:\n" ADD("3") "\tret\n" TABLE("2")
                   ENTRY("3", "1,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1")
                   END);
}

static void sequences_of_the_linker_and_first_instructions_stay_whole(void **state)
{
    (void)state;
    filters_to(
        "f:\n\tendbr64\n\t.byte\t0x66\n\tleaq\tx@tlsgd(%rip), %rdi\n\t.value\t0x6666\n\trex64\n"
        "\tcall\t__tls_get_addr@PLT\n\trep stosq\n\tlock; incl (%rax)\n\tret\n",
        "f:\n\tendbr64\n" ADD(
            "1") "\t.byte\t0x66\n\tleaq\tx@tlsgd(%rip), %rdi\n\t.value\t0x6666\n\trex64\n"
                 "\tcall\t__tls_get_addr@PLT\n" ADD(
                     "2") "\trep stosq\n\tlock; incl (%rax)\n\tret\n" TABLE("1")
                     ENTRY("1", "3,0,0,0,0,1,0,3,0,1,0,0,0,0,0,0,1")
                     ENTRY("2", "3,0,0,0,0,0,8,3,0,2,0,0,0,0,0,0,1") END);
}

static void nothing_is_inserted_into_asm_statements(void **state)
{
    (void)state;
    filters_to(
        "f:\n#APP\n# 3 \"sum.c\" 1\n\t1: cpuid; jne 1b\n"
        "\t.pushsection .x,\"ax\"\ng:\tret\n\t.popsection\n# 0 \"\" 2\n#NO_APP\n"
        "\tincl\t%eax\n#APP\n# 4 \"sum.c\" 1\n\tnop\n# 0 \"\" 2\n#NO_APP\n\tret\n",
        "f:\n" ADD(
            "1") "#APP\n# 3 \"sum.c\" 1\n\t1: cpuid; jne 1b\n"
                 "\t.pushsection .x,\"ax\"\ng:\tret\n\t.popsection\n# 0 \"\" 2\n#NO_APP\n" ADD(
                     "2") "\tincl\t%eax\n"
                          "#APP\n# 4 \"sum.c\" 1\n\tnop\n# 0 \"\" 2\n#NO_APP\n\tret\n" TABLE("1")
                              ENTRY("1", "2,0,0,0,0,0,0,2,0,1,0,0,0,0,0,0,1")
                                  ENTRY("2", "3,0,0,0,0,0,0,3,0,1,0,0,0,0,0,0,1") END);
    /* at file scope: another section, data, functions */
    static const char outside[] =
        "\t.data\nx:\t.long 1\n#APP\n\t.text\ng:\tret\n\t.data\n#NO_APP\n\t.long 2\n";
    filters_to(outside, outside);
}

static void bytes_that_functions_move_are_counted_by_others(void **state)
{
    (void)state;
    filters_to("f:\n\tcall\tmemcpy@PLT\n\tcall\t*memset@GOTPCREL(%rip)\n"
               "\tcall\tmemcpyx\n\tjmp\tmemmove\n",
               "f:\n"
               ADD("1") "\tcall\tmimdsim_memcpy@PLT\n"
               ADD("2") "\tcall\t*mimdsim_memset@GOTPCREL(%rip)\n"
               ADD("3") "\tcall\tmemcpyx\n"
               ADD("4") "\tjmp\tmimdsim_memmove\n"
               TABLE("1")
               ENTRY("1", "1,0,0,0,0,1,0,1,0,0,0,0,0,0,0,0,1")
               ENTRY("2", "1,0,0,0,0,1,0,1,0,0,0,0,0,0,0,0,1")
               ENTRY("3", "1,0,0,0,0,1,0,1,0,0,0,0,0,0,0,0,1")
               ENTRY("4", "1,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1")
               END);
}

static void a_long_block_is_counted_in_pieces(void **state)
{
    (void)state;
    struct text in = {0}, out = {0};
    text_add(&in, "f:\n");
    for (int i = 0; i < 1000; i++) text_add(&in, "\tvaddpd\t(%%rax), %%zmm0, %%zmm0\n");
    text_add(&in, "\tret\n");
    filtered(in.s, &out);
    long sum = 0, blocks = 0;
    for (char *s = out.s; (s = strstr(s, "\t.value ")) != NULL; s++) {
        unsigned n, flop;
        assert_int_equal(sscanf(s, "\t.value %u,%u", &n, &flop), 2);
        assert_true(n <= BLOCK_MOST_INSTRUCTIONS);
        sum += flop;
        blocks++;
    }
    assert_int_equal(sum, 8000);
    assert_int_equal(blocks, 33); /* of 31 instructions of 8 lanes */
    text_free(&in);
    text_free(&out);
}

/* A function in gcc's way, with n bytes of code that decide about its entry. */
#define FUNCTION(binding, name, code) \
    binding "\t.type\t" name ", @function\n" name ":\n.LFB0:\n\t.cfi_startproc\n" code \
    "\tret\n\t.cfi_endproc\n\t.size\t" name ", .-" name "\n"

static void functions_that_others_may_call_get_an_entry(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        bool guarded;
    } cases[] = {
        {FUNCTION("\t.globl\tf\n", "f",
         "\tpushq\t%rbx\n\t.cfi_def_cfa_offset 16\n\tmovl 8(%rsp), %eax\n"), true},
        {FUNCTION("\t.weak\tf\n", "f", ""), true},
        {FUNCTION("", "f", ""), false},                                    /* static */
        {FUNCTION("", "f", "") "\tleaq\tf(%rip), %rax\n", true},          /* and given away */
        {FUNCTION("", "f", "") "\t.data\n\t.quad\tf\n", true},
        {FUNCTION("", "f", "") "\tcall\tf\n", false},
        {FUNCTION("\t.globl\tf\n", "f",
         "\tmovl 8(%rsp), %eax\n"), false}, /* arguments on the stack */
        {FUNCTION("\t.globl\tf\n", "f", "\tleaq 8(%rsp), %r10\n"), false},
        {FUNCTION("\t.globl\tf\n", "f",
         "\tpushq\t%rbp\n\t.cfi_def_cfa_offset 16\n\tmovq\t%rsp, %rbp\n"
                  "\t.cfi_def_cfa_register 6\n\tmovl\t-8(%rbp), %eax\n\tmovl\t40(%rsp), "
                  "%eax\n"), true},
        {FUNCTION("\t.globl\tf\n", "f",
         "\tpushq\t%rbp\n\t.cfi_def_cfa_offset 16\n\tmovq\t%rsp, %rbp\n"
                  "\t.cfi_def_cfa_register 6\n\tmovl\t16(%rbp), %eax\n"), false},
        {"\t.globl\tf\n\t.type\tf, @function\nf:\n\tret\n\t.size\tf, "
         ".-f\n", false}, /* no unwind table */
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct block_source guarded = {"sum.c", "", false, true};
        struct text in = {0}, out = {0};
        struct err e;
        err_clear(&e);
        text_add(&in, "%s", cases[i].text);
        assert_true(block_filter(&in, &guarded, &out, &e));
        const bool entry =
            strstr(out.s, "\nf:\n\t.cfi_startproc\n.Lmimdsim_f1:\n\tpushq %r15\n") != NULL;
        const bool body = strstr(out.s, "mimdsim_body.f:\n.LFB0:\n") != NULL;
        if (entry != cases[i].guarded || body != entry) fail_msg("case %u: %s", i, out.s);
        text_free(&in);
        text_free(&out);
    }
}

/* A block that jumps to its own beginning has the length of its chain and of its code; others have
 * none. Two blocks
 * that are a loop have an entry for both. */
static void a_loop_has_its_chain(void **state)
{
    (void)state;
    filters_to(
        "f:\n\txorl\t%eax, %eax\n.L3:\n.L4:\n\tmovsd\t(%rdi,%rax,8), %xmm1\n\tmulsd\t%xmm2, %xmm1\n"
        "\taddsd\t%xmm1, %xmm0\n\taddq\t$1, %rax\n\tcmpq\t%rdx, %rax\n\tjne\t.L3\n"
        "\tjne\t.L4\n\tret\n",
        "f:\n" ADD("1") "\txorl\t%eax, %eax\n.L3:\n.L4:\n" ADD(
            "2") "\tmovsd\t(%rdi,%rax,8), %xmm1\n\tmulsd\t%xmm2, %xmm1\n"
                 "\taddsd\t%xmm1, %xmm0\n\taddq\t$1, %rax\n\tcmpq\t%rdx, %rax\n"
                 "\tjne\t.L3\n.Lmimdsim_t2:\n" ADD("3") "\tjne\t.L4\n" ADD("4") "\tret\n" TABLE("1")
                     ENTRY("1", "1,0,0,0,0,0,0,1,0,1,0,0,0,0,0,0,1")
                     "\t.long 2,0\n\t.value 7,2,0,0,0,0,8,7,1,2,1,1,1,0,0,0,2,1,8,1,1,2\n"
                     LOOP("2", "6,2,0,0,0,0,8,6,1,2,1,1,1,0,0,0,1", "1,8,1,1")
                     ENTRY("3", "1,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1")
                     ENTRY("4", "1,0,0,0,0,0,0,1,0,0,0,0,0,0,0,0,1")
                             END);
}

static void filtering_twice_changes_nothing(void **state)
{
    (void)state;
    struct text in = {0}, once = {0}, twice = {0};
    struct err e;
    err_clear(&e);
    text_add(&in, "f:\n\tret\n\t.ident \"GCC: (GNU) 12\"\n");
    assert_true(block_filter(&in, &source, &once, &e));
    assert_true(block_filter(&once, &source, &twice, &e));
    assert_string_equal(once.s, twice.s);
    assert_non_null(strstr(once.s, "\t.asciz \"sum.c; GCC: (GNU) 12; -O2\"\n"));
    text_free(&in);
    text_free(&once);
    text_free(&twice);
}

/* Refused, with the place and a part of the reason. */
static void refuses(const char *in, bool written, const char *file, int line, const char *reason)
{
    struct text text = {0}, out = {0};
    const struct block_source from = {"sum.c", "", written, false};
    struct err e;
    err_clear(&e);
    text_add(&text, "%s", in);
    assert_false(block_filter(&text, &from, &out, &e));
    assert_int_equal(e.kind, ERR_DATA);
    assert_string_equal(e.file, file);
    assert_int_equal(e.line, line);
    assert_non_null(strstr(e.text, reason));
    text_free(&text);
    text_free(&out);
}

static void what_uses_the_counter_is_refused(void **state)
{
    (void)state;
    refuses("f:\n\tmovq\t%r15, %rax\n\tret\n", false, "sum.c", 0, "in f: register r15");
    refuses("f:\n#APP\n# 7 \"sum.h\" 1\n\tnop\n\tmovl $1, %r15d\n# 0 \"\" 2\n#NO_APP\n", false,
            "sum.h", 8, "r15");
    refuses("f:\n\tnop\n\txorq %r15, %r15\n", true, "sum.c", 3, "r15");
    refuses("# 1 \"fast.S\"\nf:\n\txorq %r15, %r15\n", true, "fast.S", 2, "r15");
    refuses("f:\n\tret\n\t.ident \"clang version 14\"\n", false, "sum.c", 0, "clang");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_begin_at_labels_and_behind_branches_and_calls),
        cmocka_unit_test(labels_of_tables_and_landing_pads_begin_blocks),
        cmocka_unit_test(each_section_has_its_piece_of_the_table),
        cmocka_unit_test(sequences_of_the_linker_and_first_instructions_stay_whole),
        cmocka_unit_test(nothing_is_inserted_into_asm_statements),
        cmocka_unit_test(bytes_that_functions_move_are_counted_by_others),
        cmocka_unit_test(a_long_block_is_counted_in_pieces),
        cmocka_unit_test(functions_that_others_may_call_get_an_entry),
        cmocka_unit_test(a_loop_has_its_chain),
        cmocka_unit_test(filtering_twice_changes_nothing),
        cmocka_unit_test(what_uses_the_counter_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
