/* loops.h - the code of a function by blocks, and which of its loops are short enough that a
 * processor executes their blocks side by side.
 *
 * A processor looks some hundreds of instructions ahead. Within these it does not matter which
 * block an instruction is in: a division of one block goes on while a sum of the next is computed.
 * So a loop whose round is at most CHAIN_MOST instructions takes one bound as a whole
 * (loader/block_costs.c). Loops inside it count as often as they are made, where that can be seen
 * from the code (rounds.h); where it cannot, each of these stands alone, and what is around them is
 * taken block by block. So are loops that call. */
#ifndef COMPILE_LOOPS_H
#define COMPILE_LOOPS_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/text.h"
#include "compile/asm_line.h"
#include "compile/chain.h"
#include "loader/block_table.h"

enum { MOST_LABELS = 4 };

struct code_line {
    struct span word, operands;
    struct chain_step step;
};

/* A basic block. */
struct code_block {
    int number; /* of its counter */
    struct block_counts counts;
    struct span label[MOST_LABELS]; /* (nlabel) where it begins */
    int nlabel;
    bool repeats;   /* it leads back to itself, and a label .Lmimdsim_tNUMBER stands behind it */
    int first, end; /* lines [first, end) */
};

/* Blocks of one function, in the order of the text. Start from {.arena = a}; spans are borrowed. */
struct code {
    struct arena *arena;
    struct code_line *line;   /* (nline) */
    struct code_block *block; /* (nblock) */
    int nline, most_lines, nblock, most_blocks;
};

/* code_add_counts: `c` more, by class, but for chains. */
void code_add_counts(struct block_counts *sum, const struct block_counts *c);

/* code_add_line: one more instruction. code_add_block: a block of the lines since the last one; its
 * `first` and `end` are set here. */
void code_add_line(struct code *c, struct span word, struct span operands);
void code_add_block(struct code *c, struct code_block b);

/* block_has_label: whether a jump to `name` leads to the block. */
bool block_has_label(const struct code_block *b, struct span name);

/* code_jump: the label that the last instruction of block `b` jumps to, empty (n = 0): none that is
 * known. *always tells whether it does so without a condition. */
struct span code_jump(const struct code *c, int b, bool *always);

/* A loop: blocks [first, last], the last of which leads back to the first. */
struct code_loop {
    int first, last;
    int rounds; /* each time it is entered, 0: not known */
};

/* loops_write: append the entries of all blocks to a table (block_table.h), each loop that overlaps
 * with an entry of its own in front of its first block's, and empty `c`. */
void loops_write(struct code *c, struct text *table);

#endif
