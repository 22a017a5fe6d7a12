/* block_costs.h - what each basic block of an image costs on a machine, written into its code. */
#ifndef LOADER_BLOCK_COSTS_H
#define LOADER_BLOCK_COSTS_H

#include <stddef.h>
#include <stdint.h>

#include "base/err.h"
#include "loader/block_table.h"
#include "machine/node_cost.h"

/* Reads: the bytes of an image that may be written, by their address in the file; NULL: they are
 * not all there. */
typedef void *block_at_fn(const void *image, uint64_t address, size_t size);

/* A table as it lies in memory. */
struct block_table {
    const struct block_entry *entry; /* (n) */
    size_t n;
    uint64_t address; /* of entry[0] in the file */
};

/* block_fetches: in how many pieces, one after the other, a processor fetches a loop of
 * `instructions` that lie in `length` > 0 bytes from `address` on. */
unsigned block_fetches(uint64_t address, uint32_t length, unsigned instructions);

/* block_cost_ps: cost of a block that stands alone on a node [ps], times `factor`, to the nearest
 * picosecond: the slowest of the finer bounds where the node has them, else node_cost_code_ps.
 * `fetches`: of block_fetches; 0 where the block is no loop by itself. */
int64_t block_cost_ps(const struct node_cost *c, const struct block_counts *counts,
                      unsigned fetches, double factor);

/* block_costs_patch: write the cost of every block of `table` into the code of the image. Where the
 * node has a price of loads, blocks of a loop with an entry of its own (BLOCK_LOOP) overlap: each
 * takes its share of what the whole round is slowest in.
 *
 *   at, image  in      where the image's bytes are; they are written
 *   c, factor  in      the node of the run's machine, and what its times are multiplied by (1: as
 * they are)
 *
 * Returns false with ERR_DATA (the table does not fit the code: not made by `mimdsim cc`, or
 * damaged) or ERR_CONFIG (a block takes 2.1 ms or more: it does not fit in 31 bits of picoseconds);
 * the image is then not to be used. */
bool block_costs_patch(const struct block_table *table, block_at_fn *at, const void *image,
                       const struct node_cost *c, double factor, struct err *e);

#endif
