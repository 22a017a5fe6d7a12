/* rounds.c - see rounds.h: values of registers as a constant beyond something unknown. */
#include "compile/rounds.h"

#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 8 };

/* `offset` beyond what register `reg` has behind line `line`, which wrote something unknown to it;
 * line NOWHERE: a plain number; ENTRY: what the function was called with. */
struct value {
    int line;
    uint64_t reg;
    long offset;
};
enum { ENTRY = -1, NOWHERE = -2 };

/* A register, or a constant: operands of two kinds; all others are in memory or labels. */
static bool is_register(struct span o) { return o.n > 1 && o.s[0] == '%'; }
static bool is_number(struct span o) { return o.n > 1 && o.s[0] == '$'; }

/* The letters behind which sizes come: add, addl, addq. */
static bool is_word(struct span m, const char *name, int n)
{
    return span_starts(m, name) && m.n <= n + 1;
}

/* What an instruction adds to a register that it reads and writes: addq $8, %rax; leaq 8(%rax),
 * %rax; incl %eax. False when it does something else. */
static bool adds_constant(const struct code_line *l, uint64_t *from, long *by)
{
    const struct span a = asm_operand(l->operands, 0), b = asm_operand(l->operands, 1);
    const bool up = is_word(l->word, "add", 3), down = is_word(l->word, "sub", 3);
    if ((up || down) && is_number(a) && is_register(b)) {
        *from = chain_registers(b);
        *by = strtol(a.s + 1, NULL, 0) * (up ? 1 : -1);
        return true;
    }
    if ((is_word(l->word, "inc", 3) || is_word(l->word, "dec", 3)) && is_register(a)) {
        *from = chain_registers(a);
        *by = span_starts(l->word, "inc") ? 1 : -1;
        return true;
    }
    /* One register in the parentheses, and a number or nothing before them. */
    char *end;
    if (!is_word(l->word, "lea", 3) || !is_register(b)) return false;
    *by = strtol(a.s, &end, 0);
    *from = chain_registers(a);
    return *end == '(' && (*from & (*from - 1)) == 0 && asm_operand(a, 1).n == 0 &&
           span_find(a, ",") < 0;
}

static struct value value_before(const struct code *c, int line, int depth, uint64_t reg);

/* An address with an index, D(B,I,S), whose index is a plain number there, as when an outer loop
 * begins: what is added to B, and B, 0 where there is none. */
static bool adds_index(const struct code *c, int line, int depth, uint64_t *base, long *by)
{
    const struct span a = asm_operand(c->line[line].operands, 0);
    const char *open = memchr(a.s, '(', (size_t)a.n), *comma;
    if (!is_word(c->line[line].word, "lea", 3) || open == NULL) return false;
    comma = memchr(open, ',', (size_t)(a.s + a.n - open));
    if (comma == NULL) return false;
    const struct span first = {open + 1, (int)(comma - open - 1)},
                      rest = {comma + 1, (int)(a.s + a.n - comma - 2)};
    const char *scale = memchr(rest.s, ',', (size_t)rest.n);
    const struct span index = {rest.s, scale != NULL ? (int)(scale - rest.s) : rest.n};
    /* Depth goes along, so that addresses of addresses do not take the way many times over. */
    const struct value at = value_before(c, line, depth, chain_registers(index));
    *base = first.n > 0 ? chain_registers(first) : 0;
    *by = strtol(a.s, NULL, 0) + at.offset * (scale != NULL ? strtol(scale + 1, NULL, 0) : 1);
    return at.line == NOWHERE;
}

/* The value of a register in front of a line, `depth` steps on the way. */
static struct value value_before(const struct code *c, int line, int depth, uint64_t reg)
{
    /* rbx, rsp, rbp and r12 to r15 are those that calls leave as they are (System V ABI). */
    static const uint64_t kept = 0xf038;
    long sum = 0;
    /* Line by line upwards: each that writes the register tells from what, or ends the way. */
    while (line-- > 0) {
        const struct code_line *l = &c->line[line];
        const struct span a = asm_operand(l->operands, 0);
        const bool call = span_starts(l->word, "call") && (reg & kept) == 0;
        uint64_t from;
        long by;
        if (!call && (l->step.writes & reg) == 0) continue;
        if (call || ++depth > DEEPEST) return (struct value){line, reg, sum};
        if (adds_constant(l, &from, &by) || adds_index(c, line, depth, &from, &by)) {
            reg = from;
            sum += by;
            if (reg == 0) return (struct value){NOWHERE, 0, sum};
        } else if (is_word(l->word, "mov", 3) && is_register(a)) reg = chain_registers(a);
        else if (is_word(l->word, "mov", 3) && is_number(a))
            return (struct value){NOWHERE, 0, sum + strtol(a.s + 1, NULL, 0)};
        else if (is_word(l->word, "xor", 3) && l->step.reads == 0)
            return (struct value){NOWHERE, 0, sum};
        else return (struct value){line, reg, sum};
    }
    return (struct value){ENTRY, reg, sum};
}

/* How often lines [first, end) write a register, and what the only one adds to it. */
static int writes_of(const struct code *c, int first, int end, uint64_t reg, long *by)
{
    int times = 0;
    *by = 0;
    for (int i = first; i < end; i++) {
        uint64_t from;
        long step;
        if ((c->line[i].step.writes & reg) == 0) continue;
        times++;
        if (adds_constant(&c->line[i], &from, &step) && from == reg) *by = step;
    }
    return times;
}

/* Rounds of a loop on register `moved` until `bound`, an operand, is reached; 0: not known. */
static int count(const struct code *c, int first, int end, uint64_t moved, struct span bound,
                 bool inclusive)
{
    long by, unused;
    if (writes_of(c, first, end, moved, &by) != 1 || by == 0) return 0;
    struct value to = {NOWHERE, 0, 0};
    if (is_register(bound)) {
        if (writes_of(c, first, end, chain_registers(bound), &unused) != 0) return 0;
        to = value_before(c, first, 0, chain_registers(bound));
    } else if (is_number(bound)) to.offset = strtol(bound.s + 1, NULL, 0);
    else return 0;
    const struct value from = value_before(c, first, 0, moved);
    if (from.line != to.line || from.reg != to.reg) return 0;
    /* Up or down, but towards the end; a step may lead beyond it. */
    const long way = to.offset - from.offset;
    if (way % by != 0 && (way < 0) != (by < 0)) return 0;
    const long rounds = way / by + (inclusive || way % by != 0);
    return rounds >= 1 && rounds <= CHAIN_MOST ? (int)rounds : 0;
}

/* Compilers move the number by a constant, compare it, and jump back: cmpq B, A; jne. Which side of
 * the comparison moves is tried out. */
int rounds_of(const struct code *c, const struct code_loop *l)
{
    const struct code_block *last = &c->block[l->last];
    const int first = c->block[l->first].first, end = last->end;
    /* The comparison stands in front of the jump; or the addition itself tells of zero. */
    if (end - last->first < 2) return 0;
    const struct code_line *jump = &c->line[end - 1], *test = &c->line[end - 2];
    const struct span a = asm_operand(test->operands, 0), b = asm_operand(test->operands, 1);
    const bool inclusive = span_is(jump->word, "jle") || span_is(jump->word, "jge") ||
                           span_is(jump->word, "jbe") || span_is(jump->word, "jae");
    static const char zero[] = "$0";
    uint64_t moved;
    long by;
    if (is_word(test->word, "cmp", 3) && is_register(b)) {
        const int rounds = count(c, first, end, chain_registers(b), a, inclusive);
        if (rounds > 0 || !is_register(a)) return rounds;
        return count(c, first, end, chain_registers(a), b, inclusive);
    }
    if (!span_is(jump->word, "jne") || !adds_constant(test, &moved, &by)) return 0;
    return count(c, first, end, moved, (struct span){zero, 2}, false);
}
