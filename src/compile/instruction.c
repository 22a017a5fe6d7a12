/* instruction.c - mnemonics of x86-64 as work by class: arithmetic by lanes, loads and stores by
 * bytes. */
#include "compile/instruction.h"

#include <ctype.h>
#include <string.h>

#include "compile/elementary_list.h"

enum { SCALAR_LANE = 8 }; /* [B]: a vector instruction counts once for each */

/* The mnemonic is one of these words, exactly. */
static bool one_of(struct span a, const char *const *word)
{
    for (; *word != NULL; word++)
        if (span_is(a, *word)) return true;
    return false;
}

static struct span without_last(struct span a, int n) { return (struct span){a.s, a.n - n}; }
static struct span without_first(struct span a, int n) { return (struct span){a.s + n, a.n - n}; }
/* Suffixes tell the type of the operands. */
static bool span_ends(struct span a, const char *s)
{
    const int n = (int)strlen(s);
    return n <= a.n && memcmp(a.s + a.n - n, s, (size_t)n) == 0;
}

/* Widest vector register among the operands [B], 0: none. */
static int vector_bytes(struct span operands)
{
    if (span_find(operands, "%zmm") >= 0) return 64;
    if (span_find(operands, "%ymm") >= 0) return 32;
    return span_find(operands, "%xmm") >= 0 ? 16 : 0;
}

/* --- calls --- */

/* The name in *sin@GOTPCREL(%rip), sin@PLT, sin; empty for a register. */
static struct span call_target(struct span operands)
{
    if (operands.n > 0 && operands.s[0] == '*') operands = without_first(operands, 1);
    int n = 0;
    while (n < operands.n && operands.s[n] != '@' && operands.s[n] != '(') n++;
    return (struct span){operands.s, n};
}

/* Lanes in a name of the vector function ABI, _ZGVbN2v_sin, and *name becomes "sin"; 1 for others.
 */
static int vector_function_lanes(struct span *name)
{
    if (!span_starts(*name, "_ZGV") || name->n < 8) return 1;
    int lanes = 0, i = 6; /* behind the letters of the instruction set and of the mask */
    while (i < name->n && isdigit((unsigned char)name->s[i]))
        lanes = lanes * 10 + (name->s[i++] - '0');
    while (i < name->n && name->s[i] != '_') i++;
    if (lanes < 1 || lanes > 64 || i >= name->n) return 1;
    *name = without_first(*name, i + 1);
    return lanes;
}

/* Add what a function with a known name does. Its single and extended precisions end in f and l. */
static void count_function(struct span name, struct block_counts *c)
{
    static const struct {
        const char *name;
        uint16_t flop, div, sqrt, trig;
    } known[] = {
#define X(name, flop, div, sqrt, trig) {name, flop, div, sqrt, trig},
        ELEMENTARY_LIST(X)
#undef X
    };
    const int lanes = vector_function_lanes(&name);
    const bool typed = name.n > 1 && (span_ends(name, "f") || span_ends(name, "l"));
    for (unsigned i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (!span_is(name, known[i].name) &&
            !(typed && span_is(without_last(name, 1), known[i].name)))
            continue;
        c->flop = (uint16_t)(known[i].flop * lanes);
        c->div = (uint16_t)(known[i].div * lanes);
        c->sqrt = (uint16_t)(known[i].sqrt * lanes);
        c->trig = (uint16_t)(known[i].trig * lanes);
        return;
    }
}

/* Where control goes behind the instruction: it decides where blocks end. */
static enum flow flow_of(struct span m, struct span operands, struct block_counts *c)
{
    static const char *const away[] = {"jmp", "jmpq", "ret", "retq", "ud2", "hlt", "iretq", NULL};
    static const char *const loops[] = {"loop",   "loope",  "loopne", "loopz",
                                        "loopnz", "xbegin", NULL};
    const bool is_call = span_is(m, "call") || span_is(m, "callq"), is_away = one_of(m, away);
    /* A jump to a function (tail call) does the function's work as a call does. */
    if (is_call || is_away) count_function(call_target(operands), c);
    c->call = is_call ? 1 : 0;
    if (is_call) return FLOW_CALL;
    if (is_away) return FLOW_AWAY;
    return (m.n > 1 && m.s[0] == 'j') || one_of(m, loops) ? FLOW_BRANCH : FLOW_ON;
}

/* --- arithmetic --- */

/* Lanes of a mnemonic of SSE or AVX by its type at the end, with *stem what is before it; 0: it has
 * none. */
static int float_lanes(struct span m, int width, struct span *stem)
{
    if (m.n < 4) return 0;
    *stem = without_last(m, 2);
    if (span_ends(m, "ss") || span_ends(m, "sd")) return 1;
    if (span_ends(m, "ps")) return width / 4;
    return span_ends(m, "pd") ? width / 8 : 0;
}

/* One operation a lane; a fused multiplication and addition is two, a dot product of n lanes 2n
 * - 1. */
static void count_float(struct span m, int width, struct block_counts *c)
{
    static const char *const plain[] = {"add",    "sub",  "mul",  "min", "max",
                                        "addsub", "hadd", "hsub", NULL};
    static const char *const fused[] = {"fmadd",    "fmsub",    "fnmadd", "fnmsub",
                                        "fmaddsub", "fmsubadd", NULL};
    struct span stem;
    if (m.n > 0 && m.s[0] == 'v') m = without_first(m, 1);
    const int lanes = float_lanes(m, width, &stem);
    if (lanes == 0) return;
    if (one_of(stem, plain)) c->flop = (uint16_t)lanes;
    else if (span_is(stem, "div")) c->div = (uint16_t)lanes;
    else if (span_is(stem, "sqrt")) c->sqrt = (uint16_t)lanes;
    else if (span_is(stem, "dp")) c->flop = (uint16_t)(2 * lanes - 1);
    else if (stem.n > 3 && one_of(without_last(stem, 3), fused))
        c->flop = (uint16_t)(2 * lanes); /* 132, 213, 231 */
}

/* The x87 and the dividers of integers; suffixes are the operand's size and p, which pops. */
static void count_x87_and_integer(struct span m, struct block_counts *c)
{
    static const char *const flop[] = {"fadd", "fsub", "fmul", "fiadd", "fisub", "fimul", NULL};
    static const char *const div[] = {"fdiv", "fidiv", NULL};
    static const char *const trig[] = {"fsin",  "fcos",  "fptan",   "fpatan",
                                       "f2xm1", "fyl2x", "fyl2xp1", NULL};
    static const char *const divide[] = {"divb",  "divw",  "divl",  "divq", "idivb",
                                         "idivw", "idivl", "idivq", NULL};
    if (m.s[0] == 'f') {
        if (one_of(m, trig)) c->trig = 1;
        else if (span_is(m, "fsincos")) c->trig = 2;
        else if (span_is(m, "fsqrt")) c->sqrt = 1;
        else if (span_is(m, "fprem") || span_is(m, "fprem1")) c->div = 1;
        for (int i = 0; flop[i] != NULL; i++)
            if (span_starts(m, flop[i])) c->flop = 1;
        for (int i = 0; div[i] != NULL; i++)
            if (span_starts(m, div[i])) c->div = 1;
    } else if (one_of(m, divide)) c->div = 1;
}

/* --- memory --- */

/* Neither a register nor a constant nor the target of a jump. */
static bool is_memory(struct span operand)
{
    return operand.n > 0 && operand.s[0] != '%' && operand.s[0] != '$' && operand.s[0] != '*';
}

/* Whether an address is the program's data: not the stack frame, a constant of the compiler, or a
 * table of the linker, which a processor of any kind has in registers or in its first cache. */
static bool is_data(struct span operand, bool frame)
{
    if (!is_memory(operand)) return false;
    if (span_find(operand, "@GOT") >= 0 || span_find(operand, "@TLS") >= 0 ||
        span_find(operand, "@tls") >= 0)
        return false;
    if (span_starts(operand, ".LC")) return false;
    return span_find(operand, "(%rsp") < 0 && !(frame && span_find(operand, "(%rbp") >= 0);
}

/* Bytes of one access of an instruction with vector registers: single lanes, halves, or the
 * registers. */
static int vector_access(struct span m, int width)
{
    static const char *const half[] = {"movq",    "movlps",   "movhps",   "movlpd",    "movhpd",
                                       "movddup", "pmovzxbw", "cvtps2pd", "cvtsi2sdq", "cvtsi2ssq",
                                       "pextrq",  "pinsrq",   "movntq",   NULL};
    static const char *const quarter[] = {"movd",      "cvtsi2sd",    "cvtsi2ss", "cvtsi2sdl",
                                          "cvtsi2ssl", "pextrd",      "pinsrd",   "insertps",
                                          "extractps", "broadcastss", NULL};
    if (m.n > 0 && m.s[0] == 'v') m = without_first(m, 1);
    if (one_of(m, half) || span_is(m, "broadcastsd") || span_find(m, "sd2") >= 0) return 8;
    if (one_of(m, quarter) || span_find(m, "ss2") >= 0) return 4;
    if (span_starts(m, "p") || !(span_ends(m, "ss") || span_ends(m, "sd"))) return width;
    return span_ends(m, "ss") ? 4 : 8;
}

/* Sizes of the x87's loads and stores: l 8, t 10, s 4 bytes; of whole numbers s 2, none 4. */
static int x87_access(struct span m)
{
    const bool whole = span_starts(m, "fi");
    if (span_ends(m, "ll") || span_ends(m, "q")) return 8;
    if (span_ends(m, "t")) return 10;
    if (span_ends(m, "s")) return whole ? 2 : 4;
    return whole ? 4 : 8;
}

/* Bytes of one access of an integer instruction: the size suffix; of movz and movs the first of
 * two. */
static int integer_access(struct span m, struct span operands)
{
    if (m.n < 2) return 8;
    const bool extends = m.n >= 5 && (span_starts(m, "movz") || span_starts(m, "movs"));
    const char suffix = m.s[m.n - (extends ? 2 : 1)];
    if (span_starts(m, "set") || suffix == 'b') return 1;
    if (suffix == 'w') return 2;
    if (suffix == 'l' && !span_starts(m, "imul")) return 4;
    if (suffix == 'q') return 8;
    return span_find(operands, "%e") >= 0 || span_ends(m, "l") ? 4 : 8;
}

/* Whether an instruction with its last operand in memory also reads it: addl $1, (%rax). */
static bool reads_what_it_writes(struct span m)
{
    static const char *const only_reads[] = {"cmp",   "test", "bt",   "fld", "fild",
                                             "push",  "imul", "mul",  "div", "idiv",
                                             "ucomi", "comi", "call", "jmp", NULL};
    if (span_starts(m, "mov") || span_starts(m, "vmov") || span_starts(m, "set") ||
        span_starts(m, "fst") || span_starts(m, "fist") || span_starts(m, "pop") ||
        span_starts(m, "cvt") || span_starts(m, "pextr"))
        return false;
    for (int i = 0; only_reads[i] != NULL; i++)
        if (span_starts(m, only_reads[i])) return false;
    return true;
}

/* One operand lies in memory at most. Instructions that only compute or announce an address move
 * nothing. */
static void count_memory(struct span m, struct span operands, int width, bool frame,
                         struct block_counts *c)
{
    if (span_starts(m, "lea") || span_starts(m, "nop") || span_starts(m, "prefetch") ||
        span_starts(m, "clflush"))
        return;
    int last = -1, memory = -1;
    for (struct span o; last < 4 && (o = asm_operand(operands, last + 1)).n > 0; last++)
        if (is_data(o, frame)) memory = last + 1;
    if (memory < 0) return;
    int bytes = m.s[0] == 'f' && width == 0 ? x87_access(m)
                : width > 0                 ? vector_access(m, width)
                                            : integer_access(m, operands);
    if (memory == last && width == 0 && m.s[0] != 'f' && reads_what_it_writes(m)) bytes *= 2;
    c->bytes = (uint16_t)bytes;
}

/* Loads of vector registers, which few units of a processor make; those of whole numbers seldom
 * hold it up. The stack frame counts, and so do constants. An operand in memory that comes last is
 * stored. */
static void count_vector_load(struct span m, struct span operands, struct block_counts *c)
{
    struct span next;
    if (span_starts(m, "lea") || span_starts(m, "nop") || span_starts(m, "prefetch")) return;
    for (int i = 0; (next = asm_operand(operands, i + 1)).n > 0; i++)
        if (is_memory(asm_operand(operands, i))) c->load = 1;
}

/* Instructions that the units for whole numbers execute: neither moves, which processors do by
 * renaming or loading, nor branches, which go with their comparison. A product of two words comes
 * in two parts; a conversion reads a general register. */
static void count_whole(struct span m, struct span operands, int width, struct block_counts *c)
{
    static const char *const others[] = {"mov",  "push",     "pop",   "nop", "rep", "f",
                                         "wait", "prefetch", "endbr", "v",   NULL};
    if (width > 0) {
        c->whole = (span_starts(m, "cvtsi2") || span_starts(m, "vcvtsi2")) && operands.n > 0 &&
                   operands.s[0] == '%';
        return;
    }
    for (int i = 0; others[i] != NULL; i++)
        if (span_starts(m, others[i])) return;
    const bool product = span_starts(m, "mul") || span_starts(m, "imul");
    c->whole = product && asm_operand(operands, 1).n == 0 ? 2 : 1;
}

/* Instructions that the units for floating-point numbers execute: one kind adds, compares and
 * converts, the other one multiplies. Divisions and roots have a unit of their own. A conversion of
 * a whole number goes through two units, as it has to be brought from a general register (Fog,
 * "Instruction tables": half as many of them a cycle as additions). */
static void count_units(struct span m, struct block_counts *c)
{
    static const char *const sums[] = {"add",  "sub",   "min",  "max",  "cmp",
                                       "comi", "ucomi", "hadd", "hsub", NULL};
    static const char *const products[] = {"mul", "fm", "fnm", "dp", NULL};
    struct span stem;
    if (span_starts(m, "cvt")) c->add = span_starts(m, "cvtsi2") ? 2 : 1;
    if (float_lanes(m, SCALAR_LANE, &stem) == 0) return;
    for (int i = 0; sums[i] != NULL; i++)
        if (span_starts(m, sums[i])) c->add = 1;
    for (int i = 0; products[i] != NULL; i++)
        if (span_starts(m, products[i])) c->multiply = 1;
}

/* Work by class of one instruction. Wide vector registers count as one instruction a lane of 8
 * bytes, so that the count does not depend on how wide the vectors of this computer are. */
enum flow instruction_read(struct span m, struct span operands, bool frame,
                           struct block_counts *counts)
{
    struct block_counts c = {.instruction = 1, .issue = 1};
    const int width = vector_bytes(operands);
    const enum flow flow = flow_of(m, operands, &c);
    if (flow == FLOW_ON && m.n > 0) {
        struct span stem;
        const struct span unveiled = m.s[0] == 'v' ? without_first(m, 1) : m;
        /* What names one lane takes one; everything else in vector registers takes all of them. */
        const bool scalar =
            float_lanes(unveiled, width, &stem) == 1 || vector_access(m, width) <= SCALAR_LANE;
        if (width > SCALAR_LANE && !scalar) c.instruction = (uint16_t)(width / SCALAR_LANE);
        count_float(m, width, &c);
        count_x87_and_integer(m, &c);
        count_memory(m, operands, width, frame, &c);
        if (width > 0) {
            count_vector_load(m, operands, &c);
            count_units(unveiled, &c);
        }
        count_whole(m, operands, width, &c);
    }
    *counts = c;
    return flow;
}

/* From here on %rbp points to the stack frame, and what lies there is no data of the program. */
bool instruction_is_frame_set(struct span m, struct span operands)
{
    return (span_is(m, "movq") || span_is(m, "mov")) && span_is(asm_operand(operands, 0), "%rsp") &&
           span_is(asm_operand(operands, 1), "%rbp");
}

/* Every name of the register contains this one, r15d and r15b, too. */
bool instruction_uses_r15(struct span operands) { return span_find(operands, "%r15") >= 0; }
