/* chain.c - see chain.h: which registers an instruction reads and writes, and the loop executed on
 * a processor that has no limit but its chains. */
#include "compile/chain.h"

#include <string.h>

#include "loader/block_table.h"

/* Bits: 16 general registers, 32 of vectors, the flags, masks and x87 together. */
enum { VECTOR_FIRST = 16, FLAGS = 48, OTHERS = 49, REGISTERS = 50 };

/* Cycles by which the longest of several chains is chosen. They are those of many processors of the
 * last ten years (Fog, "Instruction tables"); what they take on a machine is its file's matter. */
enum { LOAD = 4, ADD = CHAIN_ADDITION, PRODUCT = BLOCK_PRODUCT_CYCLES, CONVERT = 4 };
enum { MULTIPLY = 3, DIVIDE = 13, ROOT = 18 };

/* --- registers -------------------------------------------------------------------------------- */

/* The number behind the letters of a register's name, -1: none. */
static int number_at(struct span name, int i)
{
    int x = 0, digits = 0;
    for (; i < name.n && name.s[i] >= '0' && name.s[i] <= '9'; i++, digits++)
        x = 10 * x + (name.s[i] - '0');
    return digits > 0 && x < 32 ? x : -1;
}

/* rax, eax, ax, al and ah are parts of one; so with the others. */
static int general_register(struct span name)
{
    static const char *const letters[] = {"ax", "cx", "dx", "bx", "sp", "bp", "si", "di"};
    if (name.n > 2 && (name.s[0] == 'r' || name.s[0] == 'e')) name.s++, name.n--;
    for (int i = 0; i < 8; i++)
        if (span_starts(name, letters[i]) || (i < 4 && name.n == 2 && name.s[0] == letters[i][0] &&
                                              (name.s[1] == 'l' || name.s[1] == 'h')))
            return i;
    return -1;
}

/* The bit of a register's name without its %. Unknown ones share a bit. */
static uint64_t register_bit(struct span name)
{
    int number = -1;
    if (name.n > 3 && name.s[1] == 'm' && name.s[2] == 'm') number = number_at(name, 3);
    if (number >= 0) return UINT64_C(1) << (VECTOR_FIRST + number);
    if (name.n > 1 && name.s[0] == 'r' && (number = number_at(name, 1)) >= 0)
        return UINT64_C(1) << (number & 15);
    number = general_register(name);
    /* The instruction's own address is always there. */
    if (span_is(name, "rip") || span_is(name, "eip")) return 0;
    return UINT64_C(1) << (number >= 0 ? number : OTHERS);
}

/* All registers that an operand names: one, or those of an address. */
static uint64_t registers_of(struct span operand)
{
    uint64_t bits = 0;
    for (int i = 0; i < operand.n; i++) {
        if (operand.s[i] != '%') continue;
        int end = ++i;
        while (end < operand.n && strchr(",) {", operand.s[end]) == NULL) end++;
        bits |= register_bit((struct span){operand.s + i, end - i});
        i = end - 1;
    }
    return bits;
}

/* --- instructions ----------------------------------------------------------------------------- */

static bool starts_with_one_of(struct span m, const char *const *word)
{
    for (; *word != NULL; word++)
        if (span_starts(m, *word)) return true;
    return false;
}

/* Whether the last operand is only written. Of scalars in vector registers the other lanes stay, so
 * that sqrtsd and cvtsi2sd wait for what was there. */
static bool overwrites(struct span m, struct span operands)
{
    static const char *const plain[] = {"mov",      "lea",      "set",    "pop",   "lzcnt", "tzcnt",
                                        "pshufd",   "pshufl",   "pshufh", "sqrtp", "pmov",  "cvtp",
                                        "cvttp",    "cvtdq",    "pabs",   "bsf",   "bsr",   "cvtts",
                                        "cvtsd2si", "cvtss2si", NULL};
    static const char *const reads[] = {"vfm", "vfnm", "vpternlog", "vpdp", NULL};
    if (asm_operand(operands, 2).n > 0 && (m.s[0] == 'v' || span_starts(m, "imul")))
        return !starts_with_one_of(m, reads);
    if (m.s[0] == 'v') m.s++, m.n--;
    return starts_with_one_of(m, plain);
}

/* What only sets flags, or leaves nothing that is waited for. */
static bool writes_nothing(struct span m)
{
    static const char *const none[] = {"cmp", "test", "ucomi", "comi", "vucomi",   "vcomi",
                                       "bt",  "push", "j",     "nop",  "prefetch", NULL};
    static const char *const packed[] = {"cmpp", "cmps", "cmpeq", "cmplt", "cmple",
                                         "cmpn", "btr",  "btc",   "bts",   NULL};
    return starts_with_one_of(m, none) && !starts_with_one_of(m, packed);
}

/* Nominal cycles by the mnemonic; *unit tells floating-point additions and products. */
static uint8_t cycles_of(struct span m, struct span operands, uint8_t *unit)
{
    static const char *const sums[] = {"add", "sub", "min", "max", NULL};
    static const char *const products[] = {"mul", "fm", "fnm", "hadd", "hsub", "dpp", NULL};
    static const char *const moves[] = {"mov", "vmov", "lea", NULL};
    const bool vector = span_find(operands, "mm") >= 0;
    *unit = STEP_OTHER;
    /* Moves among registers are renaming; movzbl and the like are not, but nearly. */
    if (starts_with_one_of(m, moves)) return span_starts(m, "lea");
    const struct span plain = m.s[0] == 'v' ? (struct span){m.s + 1, m.n - 1} : m;
    if (!vector) {
        if (span_starts(m, "imul") || span_starts(m, "mul")) return MULTIPLY;
        return span_starts(m, "idiv") || span_starts(m, "div") ? DIVIDE : 1;
    }
    if (span_starts(plain, "div")) return DIVIDE;
    if (span_starts(plain, "sqrt")) return ROOT;
    if (span_starts(plain, "cvt")) return CONVERT;
    if (span_starts(plain, "mul")) *unit = STEP_PRODUCT;
    if (starts_with_one_of(plain, products)) return PRODUCT;
    if (!starts_with_one_of(plain, sums)) return 1;
    *unit = STEP_ADDITION;
    return ADD;
}

/* xor, pxor and sub of a register with itself give zero without waiting for it. */
static bool clears(struct span m, struct span operands)
{
    static const char *const idiom[] = {"xor", "pxor", "sub", "vxor", "vpxor", "psub", NULL};
    const struct span a = asm_operand(operands, 0), b = asm_operand(operands, 1);
    return starts_with_one_of(m, idiom) && a.n > 1 && a.s[0] == '%' && a.n == b.n &&
           memcmp(a.s, b.s, (size_t)a.n) == 0;
}

/* Registers that an instruction uses without naming them. */
static void add_hidden(struct span m, struct span operands, struct chain_step *s)
{
    static const char *const on_flags[] = {"cmov", "set", "adc", "sbb", "j", NULL};
    const uint64_t rax = 1, rdx = 4, flags = UINT64_C(1) << FLAGS;
    const bool one = asm_operand(operands, 1).n == 0;
    if (span_starts(m, "div") || span_starts(m, "idiv") || span_starts(m, "mul") ||
        (span_starts(m, "imul") && one)) {
        /* divsd and mulpd have two operands and name both. */
        if (!one) return;
        s->reads |= rax | (span_find(m, "div") >= 0 ? rdx : 0) | s->writes;
        s->writes = rax | rdx;
    }
    if (span_is(m, "cltq") || span_is(m, "cwtl")) s->reads |= rax, s->writes |= rax;
    if (span_is(m, "cqto") || span_is(m, "cltd")) s->reads |= rax, s->writes |= rdx;
    if (starts_with_one_of(m, on_flags)) s->reads |= flags;
    /* Whole numbers set flags with every operation; only some are ever asked for them. */
    if (span_find(operands, "mm") < 0 && !span_starts(m, "mov") && !span_starts(m, "lea") &&
        !span_starts(m, "j") && !span_starts(m, "set") && !span_starts(m, "cmov"))
        s->writes |= flags;
    if (span_starts(m, "ucomi") || span_starts(m, "comi") || span_starts(m, "vucomi") ||
        span_starts(m, "vcomi"))
        s->writes |= flags;
}

uint64_t chain_registers(struct span operand) { return registers_of(operand); }

struct chain_step chain_step_of(struct span m, struct span operands)
{
    struct chain_step s = {0};
    struct span o, last = {0};
    const bool address_only = span_starts(m, "lea") || span_starts(m, "nop");
    int n = 0;
    /* Every operand is read; the last one is written as well or only, as the mnemonic tells. */
    for (; n < 5 && (o = asm_operand(operands, n)).n > 0; n++) {
        const bool memory = o.s[0] != '%' && o.s[0] != '$' && o.s[0] != '*' && m.s[0] != 'j';
        if (memory) s.address |= registers_of(o);
        else s.reads |= registers_of(o);
        last = o;
        /* A store needs its address, but nothing waits for it; a comparison with memory loads. */
        const bool stored =
            memory && asm_operand(operands, n + 1).n == 0 && n > 0 && !writes_nothing(m);
        s.loads = s.loads || (memory && !address_only && !stored);
    }
    const bool to_register = n > 0 && last.s[0] == '%' && !writes_nothing(m);
    if (to_register) s.writes = registers_of(last);
    s.cycles = cycles_of(m, operands, &s.unit);
    if (clears(m, operands)) s.reads = 0;
    else if (to_register && n > 1 && overwrites(m, operands)) {
        /* Read nevertheless if it is named twice: vaddsd %xmm1, %xmm0, %xmm0. */
        s.reads = 0;
        for (int i = 0; i < n - 1; i++) {
            o = asm_operand(operands, i);
            if (o.s[0] == '%') s.reads |= registers_of(o);
        }
    }
    add_hidden(m, operands, &s);
    return s;
}

void chain_add(struct chain *c, struct chain_step s)
{
    if (c->instructions == CHAIN_MOST) return;
    c->instructions++;
    c->step[c->n++] = s;
}

/* Two marks an instruction at most: it jumps, and it is jumped to. */
static void add_mark(struct chain *c, enum step_kind kind, int place)
{
    if (c->n < 3 * CHAIN_MOST && place < CHAIN_PLACES)
        c->step[c->n++] = (struct chain_step){.kind = (uint8_t)kind, .place = (uint8_t)place};
}

void chain_leave(struct chain *c, int place, bool always)
{
    add_mark(c, always ? STEP_AWAY : STEP_BRANCH, place);
}

void chain_join(struct chain *c, int place) { add_mark(c, STEP_JOIN, place); }

/* --- the loop --------------------------------------------------------------------------------- */

/* When a register is there, what the chain that led to it is made of, and whether an addition ends
 * it. */
struct moment {
    int time;
    struct chain_length made;
    bool added;
};

/* All registers on the way through a round, and as they are on the ways to places farther on. */
struct state {
    struct moment at[REGISTERS];
    bool here; /* control comes here from above */
    bool there[CHAIN_PLACES];
    struct moment place[CHAIN_PLACES][REGISTERS];
};

static void wait_for(struct moment *now, const struct moment *at, uint64_t registers)
{
    for (int r = 0; registers != 0; r++, registers >>= 1)
        if ((registers & 1) != 0 && at[r].time > now->time) *now = at[r];
}

/* One instruction, as soon as what it needs is there. */
static void execute_step(const struct chain_step *s, struct moment at[REGISTERS])
{
    struct moment now = {0};
    wait_for(&now, at, s->address);
    if (s->loads) now.time += LOAD, now.made.cycles += LOAD, now.added = false;
    wait_for(&now, at, s->reads);
    now.time += s->cycles;
    if (s->unit == STEP_ADDITION) {
        now.made.flop++;
        now.made.late += !now.added;
    } else {
        now.made.cycles += s->cycles;
        now.made.product += s->unit == STEP_PRODUCT;
    }
    /* A move among registers hands on what it got. */
    if (s->cycles > 0) now.added = s->unit == STEP_ADDITION;
    for (int r = 0; r < REGISTERS; r++)
        if (s->writes >> r & 1) at[r] = now;
}

/* What both ways have: the earlier one of two. */
static void take_earlier(struct moment to[REGISTERS], const struct moment from[REGISTERS])
{
    for (int r = 0; r < REGISTERS; r++)
        if (from[r].time < to[r].time) to[r] = from[r];
}

/* Several jumps may lead to one place; a jump without a condition ends the way down. */
static void branch(struct state *x, const struct chain_step *s)
{
    if (x->there[s->place]) take_earlier(x->place[s->place], x->at);
    else memcpy(x->place[s->place], x->at, sizeof x->at);
    x->there[s->place] = true;
    if (s->kind == STEP_AWAY) x->here = false;
}

/* A place that nothing is known to lead to is reached somehow. */
static void join(struct state *x, int place)
{
    if (x->there[place] && x->here) take_earlier(x->at, x->place[place]);
    else if (x->there[place]) memcpy(x->at, x->place[place], sizeof x->at);
    x->there[place] = false;
    x->here = true;
}

/* All instructions once more. */
static void execute(const struct chain *c, struct state *x)
{
    for (int i = 0; i < c->n; i++) {
        const struct chain_step *s = &c->step[i];
        if (s->kind == STEP_EXECUTE) execute_step(s, x->at);
        else if (s->kind == STEP_JOIN) join(x, s->place);
        else branch(x, s);
    }
}

/* The last one that is there. */
static struct moment latest(const struct moment at[REGISTERS])
{
    struct moment most = {0};
    wait_for(&most, at, (UINT64_C(1) << REGISTERS) - 1);
    return most;
}

/* Rounds that are made before the longest chain is measured, and while it is. */
enum { WARM = 16, ROUNDS = 16 };

/* Of ROUNDS, to the nearest. */
static int each(int sum) { return (sum + ROUNDS / 2) / ROUNDS; }

struct chain_length chain_parted(struct chain_length l)
{
    if (l.product * PRODUCT > l.cycles) l.product = l.cycles / PRODUCT;
    return l;
}

struct chain_length chain_round(const struct chain *c)
{
    struct state x = {.here = true};
    /* After some rounds the longest chain has outgrown the others, and each round adds the same. */
    for (int i = 0; i < WARM; i++) execute(c, &x);
    const struct chain_length begin = latest(x.at).made;
    for (int i = 0; i < ROUNDS; i++) execute(c, &x);
    const struct chain_length end = latest(x.at).made;
    return chain_parted((struct chain_length){.flop = each(end.flop - begin.flop),
                                              .cycles = each(end.cycles - begin.cycles),
                                              .late = each(end.late - begin.late),
                                              .product = each(end.product - begin.product)});
}

struct chain_length chain_once(const struct chain *c)
{
    struct state x = {.here = true};
    execute(c, &x);
    return latest(x.at).made;
}
