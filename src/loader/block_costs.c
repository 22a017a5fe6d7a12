/* block_costs.c - counts of basic blocks times the costs of a node, into the immediates of the
 * code. */
#include "loader/block_costs.h"

#include <string.h>

#include "base/picoseconds.h"

/* The counts in the classes that a node has prices for. */
static struct work work_of(const struct block_counts *counts)
{
    return (struct work){.flop = counts->flop,
                         .div = counts->div,
                         .sqrt = counts->sqrt,
                         .trig = counts->trig,
                         .bytes = counts->bytes,
                         .call = counts->call};
}

static struct code_work code_of(const struct block_counts *counts)
{
    return (struct code_work){.blocks = counts->blocks,
                              .issue = counts->issue,
                              .load = counts->load,
                              .whole = counts->whole,
                              .add = counts->add,
                              .multiply = counts->multiply,
                              .chain_flop = counts->chain_flop,
                              .chain_cycle = counts->chain_cycle,
                              .chain_late = counts->chain_late,
                              .chain_product = counts->chain_product,
                              .once_flop = counts->once_flop,
                              .once_cycle = counts->once_cycle,
                              .once_late = counts->once_late,
                              .once_product = counts->once_product,
                              .floating = (unsigned)counts->add + counts->multiply + counts->div +
                                          counts->sqrt};
}

/* Processors keep decoded instructions in entries of up to ENTRY that lie in one line of LINE bytes
 * of code, and take two entries in a cycle, of a line with more than two no others beside them. A
 * jump to such a line makes its entries come one by one (measured on AMD's family 26 with loops of
 * 8 to 33 instructions of 3 to 7 bytes, begun at 5 places of a line; sizes: "Software Optimization
 * Guide for the AMD Zen5 Microarchitecture", 58455, on its op cache). */
enum { LINE = 64, ENTRY = 6 };

/* The halves of a cycle that `bytes` of a block in one line take. Which line an instruction is in
 * is not known, but how long they are in the mean. */
static uint64_t line_halves(uint64_t bytes, uint32_t length, unsigned instructions, bool first)
{
    const uint64_t here = (2 * instructions * bytes + length) / (2 * (uint64_t)length);
    const unsigned entries = (unsigned)(here + ENTRY - 1) / ENTRY;
    if (entries <= 2) return entries;
    return first ? 2 * entries : entries + entries % 2;
}

unsigned block_fetches(uint64_t address, uint32_t length, unsigned instructions)
{
    if (length == 0) return 0;
    const uint64_t rest_of_line = LINE - address % LINE;
    const uint64_t first = rest_of_line < length ? rest_of_line : length, others = length - first;
    uint64_t halves = line_halves(first, length, instructions, true);
    /* Whole lines are all alike: a table may say that a block is as long as its code. */
    halves += others / LINE * line_halves(LINE, length, instructions, false);
    if (others % LINE) halves += line_halves(others % LINE, length, instructions, false);
    return (unsigned)((halves + 1) / 2);
}

/* Counts of the block times the costs of the node, as for every other work
 * (machine/node_cost.h); `factor` is what a calibration of the user found. */
int64_t block_cost_ps(const struct node_cost *c, const struct block_counts *counts,
                      unsigned fetches, double factor)
{
    const struct work w = work_of(counts);
    struct code_work code = code_of(counts);
    code.fetch = fetches;
    /* A machine has the finer prices, or one of an instruction. */
    if (c->issue > 0)
        return ps_rounded(node_cost_bound_ps(c, &w, &code, node_cost_bound_of(c, &w, &code)) *
                          factor);
    return ps_rounded(node_cost_code_ps(c, &w, counts->instruction) * factor);
}

/* --- loops ------------------------------------------------------------------------------------ */

/* A loop whose blocks overlap: which of their times all of them take, and where it ends. */
struct loop {
    enum code_bound bound;
    struct code_work round;
    size_t end; /* entry behind its last block */
};

/* The loop that entry i tells of. Its blocks must be there, and no other loop among them. */
static bool begin_loop(const struct block_table *t, size_t i, const struct node_cost *c,
                       struct loop *l)
{
    const struct block_entry *b = &t->entry[i];
    if (b->immediate < 1 || (size_t)b->immediate > t->n - 1 - i) return false;
    l->end = i + 1 + (size_t)b->immediate;
    for (size_t k = i + 1; k < l->end; k++)
        if (t->entry[k].kind != BLOCK_ADD) return false;
    const struct work w = work_of(&b->counts);
    l->round = code_of(&b->counts);
    l->bound = node_cost_bound_of(c, &w, &l->round);
    return true;
}

/* A block of a loop takes its share of what the loop is slowest in, so that a round takes the sum
 * of it, and what is left out in a round is not paid. A chain is the whole round's, and the last
 * block, which leads back to the first, takes it. */
static int64_t loop_cost_ps(const struct loop *l, size_t i, const struct block_counts *counts,
                            const struct node_cost *c, double factor)
{
    const struct work w = work_of(counts);
    struct code_work code = code_of(counts);
    const bool last = i + 1 == l->end, chain = l->bound == BOUND_CHAIN || l->bound == BOUND_WINDOW;
    if (chain) code = last ? l->round : (struct code_work){0};
    return ps_rounded(node_cost_bound_ps(c, &w, &code, l->bound) * factor);
}

/* --- the table -------------------------------------------------------------------------------- */

/* Where the immediate of entry i lies in memory, NULL: not in the image, or not behind the bytes of
 * its instruction. */
static unsigned char *immediate(const struct block_table *t, size_t i, block_at_fn *at,
                                const void *image)
{
    const struct block_entry *b = &t->entry[i];
    const uint64_t address = t->address + i * sizeof *b + (uint64_t)(int64_t)b->immediate;
    if (b->kind == BLOCK_RATE) return at(image, address, sizeof(int32_t));
    if (b->kind != BLOCK_ADD || address < BLOCK_ADD_OPCODE_BYTES) return NULL;
    unsigned char *code =
        at(image, address - BLOCK_ADD_OPCODE_BYTES, BLOCK_ADD_OPCODE_BYTES + sizeof(int32_t));
    if (code == NULL || memcmp(code, BLOCK_ADD_OPCODE, BLOCK_ADD_OPCODE_BYTES) != 0) return NULL;
    return code + BLOCK_ADD_OPCODE_BYTES;
}

/* An instruction has 15 bytes at most; the counter is one more, and so is what fills up in front of
 * a place that is jumped to. */
static bool length_fits(const struct block_table *t, size_t i)
{
    return t->entry[i].length <= 15 * (uint32_t)(t->entry[i].counts.issue + 2);
}

/* The jump of a loop is one with the comparison before it, and the counter one more: as many
 * instructions as the compiler wrote. */
static unsigned fetches_of(const struct block_table *t, size_t i)
{
    const struct block_entry *b = &t->entry[i];
    const uint64_t word = t->address + i * sizeof *b + (uint64_t)(int64_t)b->immediate;
    return b->length > 0 && b->kind == BLOCK_ADD
               ? block_fetches(word - BLOCK_ADD_OPCODE_BYTES, b->length, b->counts.issue)
               : 0;
}

/* The processor extends the immediate's sign: what fits is below 2^31. */
static bool write_cost(unsigned char *word, int64_t ps, const struct block_counts *counts,
                       struct err *e)
{
    const int32_t immediate_ps = (int32_t)ps;
    if (ps > INT32_MAX)
        return err_set(
            e, ERR_CONFIG,
            "a basic block of %u instructions would take %.4g ms on this node; at most "
            "2.147 ms can be counted: raise node.clock, node.flop_rate or node.copy.bandwidth",
            counts->instruction, (double)ps * 1e-9);
    memcpy(word, &immediate_ps, sizeof immediate_ps);
    return true;
}

/* Every entry is checked before its word is written: a table that does not fit would change
 * code. */
bool block_costs_patch(const struct block_table *table, block_at_fn *at, const void *image,
                       const struct node_cost *c, double factor, struct err *e)
{
    struct loop loop = {.end = 0};
    /* Machines without a price of loads take each block by itself. */
    const bool overlap = c->issue > 0 && c->load > 0;
    for (size_t i = 0; i < table->n; i++) {
        const struct block_counts *counts = &table->entry[i].counts;
        const bool begins = table->entry[i].kind == BLOCK_LOOP;
        unsigned char *word = begins ? NULL : immediate(table, i, at, image);
        if (begins ? !begin_loop(table, i, c, &loop) : word == NULL || !length_fits(table, i))
            return err_set(
                e, ERR_DATA,
                "the table of basic blocks does not fit the code (entry %zu of %zu): the file "
                "is damaged, or was changed after `mimdsim cc` made it",
                i, table->n);
        if (begins) continue;
        const int64_t ps = overlap && i < loop.end
                               ? loop_cost_ps(&loop, i, counts, c, factor)
                               : block_cost_ps(c, counts, fetches_of(table, i), factor);
        if (!write_cost(word, ps, counts, e)) return false;
    }
    return true;
}
