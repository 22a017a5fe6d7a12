/* block_costs.c - counts of basic blocks times the costs of a node, into the immediates of the
 * code. */
#include "loader/block_costs.h"

#include <string.h>

#include "base/picoseconds.h"

/* Counts of the block times the costs of the node, as for every other work
 * (machine/node_cost.h); `factor` is what a calibration of the user found. */
int64_t block_cost_ps(const struct node_cost *c, const struct block_counts *counts, double factor)
{
    const struct work w = {.flop = counts->flop,
                           .div = counts->div,
                           .sqrt = counts->sqrt,
                           .trig = counts->trig,
                           .bytes = counts->bytes,
                           .call = counts->call};
    const struct code_work code = {counts->issue, counts->chain_flop, counts->chain_cycle};
    /* A machine has the finer prices, or one of an instruction. */
    if (c->issue > 0) return ps_rounded(node_cost_fine_ps(c, &w, &code) * factor);
    return ps_rounded(node_cost_code_ps(c, &w, counts->instruction) * factor);
}

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

/* Every entry is checked before its word is written: a table that does not fit would change
 * code. */
bool block_costs_patch(const struct block_table *table, block_at_fn *at, const void *image,
                       const struct node_cost *c, double factor, struct err *e)
{
    for (size_t i = 0; i < table->n; i++) {
        unsigned char *word = immediate(table, i, at, image);
        if (word == NULL)
            return err_set(
                e, ERR_DATA,
                "the table of basic blocks does not fit the code (entry %zu of %zu): the file "
                "is damaged, or was changed after `mimdsim cc` made it",
                i, table->n);
        /* The processor extends the immediate's sign: what fits is below 2^31. */
        const int64_t ps = block_cost_ps(c, &table->entry[i].counts, factor);
        if (ps > INT32_MAX)
            return err_set(
                e, ERR_CONFIG,
                "a basic block of %u instructions would take %.4g ms on this node; at most "
                "2.147 ms can be counted: raise node.clock, node.flop_rate or node.copy.bandwidth",
                table->entry[i].counts.instruction, (double)ps * 1e-9);
        const int32_t immediate_ps = (int32_t)ps;
        memcpy(word, &immediate_ps, sizeof immediate_ps);
    }
    return true;
}
