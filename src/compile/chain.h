/* chain.h - how long a loop waits for itself: the longest chain of instructions of which each needs
 * what the one before computed, through all rounds of a loop.
 *
 * A processor that issues several instructions a cycle still cannot add to a sum before the last
 * addition is done. So a loop takes the longer of two times: what its instructions take to be
 * issued, and what its chain takes a round (the "loop-carried dependency" of Laukemann, Hammer,
 * Hager, Wellein, "Automatic throughput and critical path analysis", PMBS 2019). */
#ifndef COMPILE_CHAIN_H
#define COMPILE_CHAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "compile/asm_line.h"

enum { CHAIN_MOST = 256 };

/* One instruction as a step from registers to registers; masks have a bit for each register. */
struct chain_step {
    uint64_t address, reads, writes; /* registers */
    uint8_t cycles;                  /* nominal, without those of its load */
    bool flop;                       /* floating-point addition, or minimum and the like */
    bool loads;
};

/* The instructions of one block. */
struct chain {
    int n;
    struct chain_step step[CHAIN_MOST]; /* (n) */
};

/* A round of the longest chain: its floating-point additions, and the nominal cycles of all its
 * other instructions (1; a load 4, a product 4 and one of integers 3, a division 13, a root 18). */
struct chain_length {
    int flop, cycles;
};

/* chain_add: one more instruction. Those beyond CHAIN_MOST are left out. */
void chain_add(struct chain *c, struct span mnemonic, struct span operands);

/* chain_round: what a round of the loop adds to its longest chain when the instructions are
 * executed again and again. What goes through memory is no part of it. */
struct chain_length chain_round(const struct chain *c);

#endif
