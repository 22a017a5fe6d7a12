/* loops.c - see loops.h: loops found by their jumps back, and what a round of each does. */
#include "compile/loops.h"

#include <string.h>

#include "compile/rounds.h"

/* How far today's processors look ahead [instructions]: 224 to 512 (Fog, "The microarchitecture of
 * Intel, AMD and VIA CPUs"; 448 of AMD's family 26). */
enum { AHEAD = 448 };

/* --- code ------------------------------------------------------------------------------------- */

/* Room for one more of n things of `size` bytes; those before are copied. */
static void *grown(struct arena *a, void *old, int n, int *most, size_t size)
{
    if (n < *most) return old;
    *most = n < 32 ? 64 : 2 * n;
    void *more = arena_take(a, size_product((size_t)*most, size));
    if (n > 0) memcpy(more, old, (size_t)n * size);
    return more;
}

/* Chains do not add up: a round has one of its own. */
void code_add_counts(struct block_counts *sum, const struct block_counts *c)
{
    sum->instruction += c->instruction;
    sum->flop += c->flop;
    sum->div += c->div;
    sum->sqrt += c->sqrt;
    sum->trig += c->trig;
    sum->call += c->call;
    sum->bytes += c->bytes;
    sum->issue += c->issue;
    sum->load += c->load;
    sum->whole += c->whole;
    sum->add += c->add;
    sum->multiply += c->multiply;
    sum->blocks += c->blocks;
}

/* Registers and cycles are found once, as a line may be executed in many rounds of several
 * loops. */
void code_add_line(struct code *c, struct span word, struct span operands)
{
    c->line = grown(c->arena, c->line, c->nline, &c->most_lines, sizeof *c->line);
    c->line[c->nline++] = (struct code_line){word, operands, chain_step_of(word, operands)};
}

/* Blocks lie one behind the other, so that a loop's lines are one piece of the function's. */
void code_add_block(struct code *c, struct code_block b)
{
    c->block = grown(c->arena, c->block, c->nblock, &c->most_blocks, sizeof *c->block);
    b.first = c->nblock > 0 ? c->block[c->nblock - 1].end : 0;
    b.end = c->nline;
    c->block[c->nblock++] = b;
}

/* Labels of functions are not followed: what is behind them is no part of a loop. */
struct span code_jump(const struct code *c, int b, bool *always)
{
    const struct code_block *k = &c->block[b];
    const struct code_line *l = k->end > k->first ? &c->line[k->end - 1] : NULL;
    *always = false;
    if (l == NULL || l->word.n == 0 || l->word.s[0] != 'j') return (struct span){0};
    *always = span_starts(l->word, "jmp");
    return span_starts(l->operands, ".L") ? l->operands : (struct span){0};
}

/* Whether control can go on from the end of a block to the next one. */
static bool falls_through(const struct code *c, int b)
{
    const struct code_block *k = &c->block[b];
    bool always;
    code_jump(c, b, &always);
    return !always && !(k->end > k->first && (span_starts(c->line[k->end - 1].word, "ret") ||
                                              span_is(c->line[k->end - 1].word, "ud2")));
}

bool block_has_label(const struct code_block *b, struct span name)
{
    for (int i = 0; i < b->nlabel; i++)
        if (b->label[i].n == name.n && memcmp(b->label[i].s, name.s, (size_t)name.n) == 0)
            return true;
    return false;
}

/* --- loops ------------------------------------------------------------------------------------ */

/* The loops of a function, those with the same first block as one, in the order of their first
 * blocks. */
struct loops {
    struct code_loop *loop; /* (n) */
    int n;
};

/* Whether control comes from block h to block b by going down the text. Compilers put code that is
 * seldom needed behind the function; what jumps back from there is no loop. */
static bool leads_down(const struct code *c, int h, int b)
{
    bool reached[CHAIN_MOST + 1] = {true}, always;
    for (int i = h; i < b; i++) {
        if (!reached[i - h]) continue;
        if (falls_through(c, i)) reached[i + 1 - h] = true;
        const struct span to = code_jump(c, i, &always);
        for (int k = i + 1; to.n > 0 && k <= b; k++)
            if (block_has_label(&c->block[k], to)) reached[k - h] = true;
    }
    return reached[b - h];
}

/* Where a jump at the end of block b leads back to in a loop, -1: nowhere, or farther than a loop
 * that overlaps is long. */
static int jump_back(const struct code *c, int b)
{
    bool always;
    const struct span to = code_jump(c, b, &always);
    for (int h = b; to.n > 0 && h >= 0 && h > b - CHAIN_MOST; h--)
        if (block_has_label(&c->block[h], to)) return leads_down(c, h, b) ? h : -1;
    return -1;
}

/* Of jumps back to the same block the farthest ends the loop: the others are `continue`. */
static struct loops find_loops(const struct code *c)
{
    struct loops l = {TAKE(c->arena, (size_t)c->nblock + 1, struct code_loop), 0};
    int *last = TAKE(c->arena, (size_t)c->nblock + 1, int);
    for (int b = 0; b < c->nblock; b++) last[b] = -1;
    for (int b = 0; b < c->nblock; b++) {
        const int h = jump_back(c, b);
        if (h >= 0) last[h] = b;
    }
    for (int b = 0; b < c->nblock; b++)
        if (last[b] >= 0) {
            struct code_loop *x = &l.loop[l.n++];
            *x = (struct code_loop){.first = b, .last = last[b]};
            x->rounds = rounds_of(c, x);
        }
    return l;
}

/* The outermost loop within [first, last] that begins at block b, NULL: none. The one that is all
 * of them is not within. */
static const struct code_loop *loop_at(const struct loops *l, int b, int first, int last)
{
    for (int i = 0; i < l->n; i++) {
        const struct code_loop *x = &l->loop[i];
        if (x->first == b && x->last <= last && !(x->first == first && x->last == last)) return x;
    }
    return NULL;
}

/* Whether control goes where the text does not tell: calls and tables of jumps. */
static bool leads_away(const struct code *c, int b)
{
    const struct code_block *k = &c->block[b];
    if (k->end == k->first) return false;
    const struct code_line *l = &c->line[k->end - 1];
    bool always;
    const bool jump = l->word.n > 0 && l->word.s[0] == 'j';
    return span_starts(l->word, "call") || (jump && code_jump(c, b, &always).n == 0);
}

/* --- a round ---------------------------------------------------------------------------------- */

/* What one round of a loop does in all. */
struct round {
    const struct code *code;
    const struct loops *loops;
    int first, last;  /* blocks of the loop */
    bool fits;        /* short enough, and nothing unknown in it */
    long instruction; /* so far */
    struct block_counts counts;
    struct chain chain;
};

/* Where control may go from the end of a block, for the chain: on, and to a later block. */
static void leave(struct round *r, int b)
{
    bool always;
    const struct span to = code_jump(r->code, b, &always);
    /* What leads out of the loop ends it, and what leads back is followed by add_blocks. */
    for (int h = b + 1; to.n > 0 && h <= r->last; h++)
        if (block_has_label(&r->code->block[h], to))
            chain_leave(&r->chain, h - r->first, !falls_through(r->code, b));
}

/* One block more: its counts, its instructions for the chain, and where it leads to. */
static void add_block(struct round *r, int b)
{
    const struct code_block *k = &r->code->block[b];
    const struct block_counts *c = &k->counts;
    struct block_counts *sum = &r->counts;
    r->instruction += c->issue + 1; /* and the counter */
    r->fits = r->fits && r->instruction <= CHAIN_MOST && sum->bytes + c->bytes <= UINT16_MAX &&
              b - r->first < CHAIN_PLACES && !leads_away(r->code, b);
    if (!r->fits) return;
    code_add_counts(sum, c);
    chain_join(&r->chain, b - r->first);
    for (int i = k->first; i < k->end; i++) chain_add(&r->chain, r->code->line[i].step);
    leave(r, b);
}

/* Blocks [first, last] once, loops among them as often as they are made. */
static void add_blocks(struct round *r, int first, int last)
{
    for (int b = first; r->fits && b <= last; b++) {
        const struct code_loop *inner = loop_at(r->loops, b, first, last);
        if (inner == NULL) {
            add_block(r, b);
            continue;
        }
        if (inner->rounds == 0) r->fits = false;
        for (int k = 0; r->fits && k < inner->rounds; k++) add_blocks(r, inner->first, inner->last);
        b = inner->last;
    }
}

/* Whether another loop shares some of the blocks of [first, last], and not all. */
static bool crossed(const struct loops *l, const struct code_loop *x)
{
    for (int i = 0; i < l->n; i++) {
        const struct code_loop *y = &l->loop[i];
        if (y->first < x->first && y->last >= x->first && y->last < x->last) return true;
        if (y->first > x->first && y->first <= x->last && y->last > x->last) return true;
    }
    return false;
}

/* a n / whole, to the nearest. */
static int part_of(int a, long n, long whole) { return (int)((a * n + whole / 2) / whole); }

/* What is added to the chain of a round because the processor does not look ahead without limit. A
 * round of I instructions takes L from its beginning to its last result. Its first instruction is
 * taken in when the one AHEAD before it is done; so 1 + AHEAD / I rounds are on their way at a
 * time, and each takes L / (1 + AHEAD / I). */
static struct chain_length longest_chain(const struct round *r)
{
    const struct chain_length carried = chain_round(&r->chain), all = chain_once(&r->chain);
    const long n = r->instruction, whole = n + AHEAD;
    const struct chain_length held =
        chain_parted((struct chain_length){.flop = part_of(all.flop, n, whole),
                                           .cycles = part_of(all.cycles, n, whole),
                                           .late = part_of(all.late, n, whole),
                                           .product = part_of(all.product, n, whole)});
    const int by_carried = CHAIN_ADDITION * carried.flop + carried.cycles,
              by_held = CHAIN_ADDITION * held.flop + held.cycles;
    return by_held > by_carried ? held : carried;
}

/* The round of a loop, without its chain; false where its blocks do not overlap. */
static bool take_round(struct round *r, const struct code *c, const struct loops *l,
                       const struct code_loop *x)
{
    *r = (struct round){
        .code = c, .loops = l, .first = x->first, .last = x->last, .fits = !crossed(l, x)};
    if (r->fits) add_blocks(r, x->first, x->last);
    return r->fits;
}

/* Lengths are below some ten thousand, so that they fit. */
static void set_chains(struct block_counts *c, struct chain_length length, struct chain_length once)
{
    c->chain_flop = (uint16_t)length.flop;
    c->chain_cycle = (uint16_t)length.cycles;
    c->chain_late = (uint16_t)length.late;
    c->chain_product = (uint16_t)length.product;
    c->once_flop = (uint16_t)once.flop;
    c->once_cycle = (uint16_t)once.cycles;
    c->once_late = (uint16_t)once.late;
    c->once_product = (uint16_t)once.product;
}

/* --- the table -------------------------------------------------------------------------------- */

/* The words of an entry behind the first. */
static void write_counts(struct text *table, const struct block_counts *c, enum block_kind kind)
{
    text_add(table, "\t.value %u,%u,%u,%u,%u,%u,%u,%u,%u,%u,%u,%u,", c->instruction, c->flop,
             c->div, c->sqrt, c->trig, c->call, c->bytes, c->issue, c->load, c->whole, c->add,
             c->multiply);
    text_add(table, "%u,%u,%u,%u,%u,%u,%u,%u,%u,%u\n", c->chain_flop, c->chain_cycle,
             c->chain_late, c->chain_product, c->blocks, c->once_flop, c->once_cycle, c->once_late,
             c->once_product, kind);
}

static void write_block(const struct code *c, int b, struct text *table)
{
    const int number = c->block[b].number;
    text_add(table, "\t.long .Lmimdsim%d-4-.,", number);
    if (c->block[b].repeats)
        text_add(table, ".Lmimdsim_t%d-.Lmimdsim%d+%d\n", number, number, BLOCK_ADD_BYTES);
    else text_add(table, "0\n");
    write_counts(table, &c->block[b].counts, BLOCK_ADD);
}

/* A block that leads back to itself has the chain of its own round, whatever is around it. */
static void take_own_chains(struct code *c, const struct loops *l, struct round *r)
{
    for (int b = 0; b < c->nblock; b++) {
        const struct code_loop alone = {.first = b, .last = b};
        if (jump_back(c, b) != b || !take_round(r, c, l, &alone)) continue;
        set_chains(&c->block[b].counts, chain_round(&r->chain), chain_once(&r->chain));
    }
}

/* The outermost loops that overlap have entries. */
void loops_write(struct code *c, struct text *table)
{
    /* One round is room for all, as its chain is large. */
    const struct loops l = find_loops(c);
    struct round *r = TAKE(c->arena, 1, struct round);
    take_own_chains(c, &l, r);
    for (int b = 0; b < c->nblock; b++) {
        int last = b;
        const struct code_loop *x = loop_at(&l, b, -1, c->nblock);
        /* One block alone has all that the loop has. */
        if (x != NULL && x->last > b && take_round(r, c, &l, x)) {
            last = x->last;
            set_chains(&r->counts, longest_chain(r), chain_once(&r->chain));
            text_add(table, "\t.long %d,0\n", last - b + 1);
            write_counts(table, &r->counts, BLOCK_LOOP);
        }
        for (; b < last; b++) write_block(c, b, table);
        write_block(c, b, table);
    }
    c->nline = c->nblock = 0;
}
