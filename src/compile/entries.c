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
};

/* --- what is known of functions --- */

/* f.cold is a piece of f. */
static struct span whole_function(struct span name)
{
    const int cold = span_find(name, ".cold");
    return cold > 0 ? (struct span){name.s, cold} : name;
}

static struct frame frame_of(struct span reg, long offset)
{
    const bool stack = span_is(reg, "7") || span_is(reg, "%rsp"),
               base = span_is(reg, "6") || span_is(reg, "%rbp");
    return (struct frame){stack ? 's' : base ? 'b' : '?', offset};
}

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

static void take_statement(struct entries *t, const struct asm_statement *s)
{
    if (s->kind == ASM_LABEL && !span_starts(s->word, ".L")) {
        t->function = s->word;
        if (t->in_group) label_set_put(t->grouped, s->word);
    } else if (s->kind == ASM_DIRECTIVE) take_directive(t, s);
    else if (s->kind == ASM_INSTRUCTION) {
        if (!is_call(s->word)) put_names(t->taken, s->operands);
        if (reaches_arguments(s->operands, t->frame))
            label_set_put(t->stacked, whole_function(t->function));
    }
}

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

bool entries_guarded(const struct entries *t, struct span name)
{
    const bool known = label_set_has(t->global, name) || label_set_has(t->weak, name) ||
                       label_set_has(t->taken, name);
    return known && label_set_has(t->typed, name) && label_set_has(t->framed, name) &&
           !label_set_has(t->stacked, name) && !span_starts(name, "mimdsim_") &&
           span_find(name, ".cold") < 0;
}

bool entries_direct(const struct entries *t, struct span name)
{
    return entries_guarded(t, name) &&
           (!label_set_has(t->weak, name) || label_set_has(t->grouped, name));
}

/* --- the entry --- */

void entries_write(const struct entries *t, struct span name, struct text *out)
{
    const int n = name.n;
    const char *s = name.s;
    const bool weak = label_set_has(t->weak, name), known = weak || label_set_has(t->global, name);
    text_add(
        out,
        "\t.type mimdsim_body.%.*s, @function\n\t.size mimdsim_body.%.*s, .-mimdsim_body.%.*s\n", n,
        s, n, s, n, s);
    /* The body of a function that several files define is the same in all of them, as the function
     * is. */
    if (known)
        text_add(out, "\t.%s mimdsim_body.%.*s\n\t.hidden mimdsim_body.%.*s\n",
                 weak ? "weak" : "globl", n, s, n, s);
    /* The push also aligns the stack for the call. %r11 is free between functions. */
    text_add(out,
             "%.*s:\n\t.cfi_startproc\n"
             "\tpushq %%r15\n\t.cfi_def_cfa_offset 16\n\t.cfi_offset 15, -16\n"
             "\txorl %%r15d, %%r15d\n"
             "\tcall mimdsim_body.%.*s\n"
             "\tmovq mimdsim_pending@GOTPCREL(%%rip), %%r11\n"
             "\taddq %%r15, (%%r11)\n"
             "\tpopq %%r15\n\t.cfi_restore 15\n\t.cfi_def_cfa_offset 8\n"
             "\tret\n\t.cfi_endproc\n"
             "\t.size %.*s, .-%.*s\n",
             n, s, n, s, n, s, n, s);
}
