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
                              .chain_flop = counts->chain_flop,
                              .chain_cycle = counts->chain_cycle};
}

/* Counts of the block times the costs of the node, as for every other work
 * (machine/node_cost.h); `factor` is what a calibration of the user found. */
int64_t block_cost_ps(const struct node_cost *c, const struct block_counts *counts, double factor)
{
    const struct work w = work_of(counts);
    const struct code_work code = code_of(counts);
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
    const bool last = i + 1 == l->end;
    code.chain_flop = last ? l->round.chain_flop : 0;
    code.chain_cycle = last ? l->round.chain_cycle : 0;
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
        if (begins ? !begin_loop(table, i, c, &loop) : word == NULL)
            return err_set(
                e, ERR_DATA,
                "the table of basic blocks does not fit the code (entry %zu of %zu): the file "
                "is damaged, or was changed after `mimdsim cc` made it",
                i, table->n);
        if (begins) continue;
        const int64_t ps = overlap && i < loop.end ? loop_cost_ps(&loop, i, counts, c, factor)
                                                   : block_cost_ps(c, counts, factor);
        if (!write_cost(word, ps, counts, e)) return false;
    }
    return true;
}
