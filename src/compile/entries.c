/* entries.c - which functions need an entry, and the entries' text. */
#include "compile/entries.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "compile/label_set.h"

/* Where the caller's arguments begin, as the unwind information tells at each place: `offset` bytes
 * from a register. */
struct frame {
    char reg; /* 's': %rsp, 'b': %rbp, '?': another */
    long offset;
};

struct entries {
    struct label_set *typed; /* declared functions */
    struct label_set *global, *weak;
    struct label_set *grouped; /* in a COMDAT group: all definitions of that name are the same */
    struct label_set *taken;   /* named elsewhere than in calls */
    struct label_set *framed;  /* have unwind information */
    struct label_set *stacked; /* look at arguments on the stack, or may */
    struct span function;      /* the one that is being read */
    struct frame frame, kept;  /* kept: by .cfi_remember_state */
    bool in_group;
    bool throws; /* C++: exceptions may pass */
    bool refers; /* the file has the reference to the C++ library that these need */
    int written; /* entries so far */
};

/* --- what is known of functions --- */

/* f.cold is a piece of f. */
static struct span whole_function(struct span name)
{
    const int cold = span_find(name, ".cold");
    return cold > 0 ? (struct span){name.s, cold} : name;
}

/* By DWARF's number of a register or by its name; only the stack and the frame pointer are
 * followed. */
static struct frame frame_of(struct span reg, long offset)
{
    const bool stack = span_is(reg, "7") || span_is(reg, "%rsp"),
               base = span_is(reg, "6") || span_is(reg, "%rbp");
    return (struct frame){stack ? 's' : base ? 'b' : '?', offset};
}

/* The unwind directives say at each place where the frame of the caller begins (DWARF 5, 6.4;
 * GNU as, "CFI directives"). Where they name another register nothing is known, and the function
 * counts as one with arguments on the stack. */
static void take_unwinding(struct entries *t, const struct asm_statement *s)
{
    const struct span first = asm_operand(s->operands, 0), second = asm_operand(s->operands, 1);
    if (span_is(s->word, ".cfi_startproc")) {
        t->frame = (struct frame){'s', 8};
        label_set_put(t->framed, whole_function(t->function));
    } else if (span_is(s->word, ".cfi_def_cfa_offset")) t->frame.offset = strtol(first.s, NULL, 10);
    else if (span_is(s->word, ".cfi_adjust_cfa_offset"))
        t->frame.offset += strtol(first.s, NULL, 10);
    else if (span_is(s->word, ".cfi_def_cfa_register")) t->frame = frame_of(first, t->frame.offset);
    else if (span_is(s->word, ".cfi_def_cfa"))
        t->frame = frame_of(first, strtol(second.s, NULL, 10));
    else if (span_is(s->word, ".cfi_remember_state")) t->kept = t->frame;
    else if (span_is(s->word, ".cfi_restore_state")) t->frame = t->kept;
    else if (span_is(s->word, ".cfi_escape")) t->frame.reg = '?';
    if (t->frame.reg == '?') label_set_put(t->stacked, whole_function(t->function));
}

/* Whether an operand reaches to the caller's side of the frame: 24(%rsp) where the arguments begin
 * at 16. */
static bool reaches_arguments(struct span operands, struct frame f)
{
    const char *base = f.reg == 's' ? "(%rsp" : "(%rbp";
    const int at = span_find(operands, base);
    if (at < 0) return false;
    int begin = at;
    while (begin > 0 &&
           (isdigit((unsigned char)operands.s[begin - 1]) || operands.s[begin - 1] == '-'))
        begin--;
    return begin < at && strtol(operands.s + begin, NULL, 10) >= f.offset;
}

/* Jumps, too: a tail call is a jump to a function, and its operand names it without taking its
 * address. */
static bool is_call(struct span mnemonic)
{
    return span_starts(mnemonic, "call") || (mnemonic.n > 0 && mnemonic.s[0] == 'j');
}

/* All names in a piece of a line. */
static void put_names(struct label_set *set, struct span operands)
{
    const char *s = operands.s, *end = s + operands.n;
    while (s < end) {
        const char *begin = s;
        while (s < end && (isalnum((unsigned char)*s) || strchr("_.$", *s) != NULL)) s++;
        if (s > begin && !isdigit((unsigned char)*begin))
            label_set_put(set, (struct span){begin, (int)(s - begin)});
        if (s == begin) s++;
    }
}

/* What declares functions, and data that hold the addresses of some. */
static void take_directive(struct entries *t, const struct asm_statement *s)
{
    const struct span name = asm_operand(s->operands, 0);
    if (span_starts(s->word, ".cfi_")) take_unwinding(t, s);
    else if (span_is(s->word, ".type")) {
        if (span_is(asm_operand(s->operands, 1), "@function")) label_set_put(t->typed, name);
    } else if (span_is(s->word, ".globl") || span_is(s->word, ".global"))
        label_set_put(t->global, name);
    else if (span_is(s->word, ".weak")) label_set_put(t->weak, name);
    else if (span_is(s->word, ".section")) t->in_group = span_find(s->operands, "comdat") >= 0;
    else if (span_is(s->word, ".text")) t->in_group = false;
    else if (span_is(s->word, ".quad") || span_is(s->word, ".long") || span_is(s->word, ".set"))
        put_names(t->taken, s->operands);
}

/* Names in instructions that are no calls are addresses that the code takes. */
static void take_statement(struct entries *t, const struct asm_statement *s)
{
    if (s->kind == ASM_LABEL && !span_starts(s->word, ".L")) {
        t->function = s->word;
        if (t->in_group) label_set_put(t->grouped, s->word);
        if (span_starts(s->word, "_Z")) t->throws = true;
        if (span_is(s->word, "DW.ref.__gxx_personality_v0")) t->refers = true;
    } else if (s->kind == ASM_DIRECTIVE) take_directive(t, s);
    else if (s->kind == ASM_INSTRUCTION) {
        if (!is_call(s->word)) put_names(t->taken, s->operands);
        if (reaches_arguments(s->operands, t->frame))
            label_set_put(t->stacked, whole_function(t->function));
    }
}

/* A pass of its own before the filter's: a function may be named before and behind its
 * definition. */
struct entries *entries_find(const struct text *in, struct arena *a)
{
    struct entries *t = TAKE(a, 1, struct entries);
    struct label_set **const set[] = {&t->typed, &t->global, &t->weak,   &t->grouped,
                                      &t->taken, &t->framed, &t->stacked};
    for (unsigned i = 0; i < sizeof set / sizeof set[0]; i++) *set[i] = label_set_make(a);
    const char *stop = in->s + in->length;
    for (const char *at = in->s, *end; at < stop; at = end + 1) {
        end = memchr(at, '\n', (size_t)(stop - at));
        if (end == NULL) end = stop;
        for (struct asm_statement s; (s = asm_next(&at, end)).kind != ASM_NOTHING;)
            take_statement(t, &s);
    }
    return t;
}

/* Functions that somebody outside of this file may call get an entry: those with public names,
 * and those whose address is taken. It needs unwind information, and no arguments on the stack,
 * which the entry's frame would move. */
bool entries_guarded(const struct entries *t, struct span name)
{
    const bool known = label_set_has(t->global, name) || label_set_has(t->weak, name) ||
                       label_set_has(t->taken, name);
    return known && label_set_has(t->typed, name) && label_set_has(t->framed, name) &&
           !label_set_has(t->stacked, name) && !span_starts(name, "mimdsim_") &&
           span_find(name, ".cold") < 0;
}

/* Calls from this file may go to the body, unless another definition of a weak function may win. */
bool entries_direct(const struct entries *t, struct span name)
{
    return entries_guarded(t, name) &&
           (!label_set_has(t->weak, name) || label_set_has(t->grouped, name));
}

/* --- the entry --- */

/* What code does at the end of an entry: hand over the count. %r11 is free between functions. */
#define HAND_OVER "\tmovq mimdsim_pending@GOTPCREL(%rip), %r11\n\taddq %r15, (%r11)\n"

/* An exception that passes through hands the count over, too: a landing pad of the call. The table
 * is that of the Itanium C++ ABI's exception handling, section 7: offsets from the function's
 * beginning, one row for the call, one without a landing pad for the rest. */
static void write_landing_pad(int n, struct text *out)
{
    text_add(out, ".Lmimdsim_p%d:\n", n);
    text_add_bytes(out, HAND_OVER, sizeof HAND_OVER - 1);
    text_add(out, "\tmovq %%rax, %%rdi\n\tcall _Unwind_Resume@PLT\n.Lmimdsim_q%d:\n", n);
    text_add(out,
             "\t.pushsection .gcc_except_table,\"a?\",@progbits\n"
             ".Lmimdsim_l%d:\n\t.byte 0xff, 0xff, 1\n\t.uleb128 .Lmimdsim_z%d-.Lmimdsim_y%d\n"
             ".Lmimdsim_y%d:\n",
             n, n, n, n);
    text_add(out,
             "\t.uleb128 .Lmimdsim_b%d-.Lmimdsim_f%d\n\t.uleb128 .Lmimdsim_e%d-.Lmimdsim_b%d\n"
             "\t.uleb128 .Lmimdsim_p%d-.Lmimdsim_f%d\n\t.uleb128 0\n",
             n, n, n, n, n, n);
    text_add(out,
             "\t.uleb128 .Lmimdsim_e%d-.Lmimdsim_f%d\n\t.uleb128 .Lmimdsim_q%d-.Lmimdsim_e%d\n"
             "\t.uleb128 0\n\t.uleb128 0\n.Lmimdsim_z%d:\n\t.popsection\n",
             n, n, n, n, n);
}

/* The entry: saves the caller's register 15, calls the body with a count of 0, adds what was
 * counted to the image's sum, and gives the register back. */
static void write_code(const struct entries *t, struct span name, int n, struct text *out)
{
    text_add(out, "%.*s:\n\t.cfi_startproc\n", name.n, name.s);
    if (t->throws)
        text_add(out,
                 "\t.cfi_personality 0x9b,DW.ref.__gxx_personality_v0\n"
                 "\t.cfi_lsda 0x1b,.Lmimdsim_l%d\n",
                 n);
    /* The push also aligns the stack for the call. */
    text_add(out,
             ".Lmimdsim_f%d:\n\tpushq %%r15\n\t.cfi_def_cfa_offset 16\n\t.cfi_offset 15, -16\n"
             "\txorl %%r15d, %%r15d\n"
             ".Lmimdsim_b%d:\n\tcall mimdsim_body.%.*s\n.Lmimdsim_e%d:\n",
             n, n, name.n, name.s, n);
    text_add_bytes(out, HAND_OVER, sizeof HAND_OVER - 1);
    text_add(out, "\t.cfi_remember_state\n\tpopq %%r15\n\t.cfi_restore 15\n"
                  "\t.cfi_def_cfa_offset 8\n\tret\n\t.cfi_restore_state\n");
    if (t->throws) write_landing_pad(n, out);
    text_add(out, "\t.cfi_endproc\n\t.size %.*s, .-%.*s\n", name.n, name.s, name.n, name.s);
}

/* The body takes over the function's old text under a name of its own, hidden from other images. */
void entries_write(struct entries *t, struct span name, struct text *out)
{
    const int n = name.n;
    const char *s = name.s;
    const bool weak = label_set_has(t->weak, name), known = weak || label_set_has(t->global, name);
    text_add(out,
             "\t.type mimdsim_body.%.*s, @function\n"
             "\t.size mimdsim_body.%.*s, .-mimdsim_body.%.*s\n",
             n, s, n, s, n, s);
    /* The body of a function that several files define is the same in all of them, as the function
     * is. */
    if (known)
        text_add(out, "\t.%s mimdsim_body.%.*s\n\t.hidden mimdsim_body.%.*s\n",
                 weak ? "weak" : "globl", n, s, n, s);
    write_code(t, name, ++t->written, out);
}

/* Entries of C++ refer to its personality routine; a file that never catches has no reference to
 * it. */
void entries_end(const struct entries *t, struct text *out)
{
    static const char reference[] = "DW.ref.__gxx_personality_v0";
    if (t->written == 0 || !t->throws || t->refers) return;
    /* As the compiler writes it in files that catch; weak, as a program may be without them. */
    text_add(out,
             "\t.hidden %s\n\t.weak %s\n"
             "\t.section .data.rel.local.%s,\"awG\",@progbits,%s,comdat\n\t.align 8\n"
             "\t.type %s, @object\n\t.size %s, 8\n%s:\n\t.quad __gxx_personality_v0\n"
             "\t.weak __gxx_personality_v0\n",
             reference, reference, reference, reference, reference, reference, reference);
}
