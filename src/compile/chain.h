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

enum { CHAIN_MOST = 1024, CHAIN_PLACES = 32 };
enum { CHAIN_ADDITION = 3 }; /* nominal cycles of a floating-point addition */

/* One instruction as a step from registers to registers; masks have a bit for each register. */
struct chain_step {
    uint64_t address, reads, writes; /* registers */
    uint8_t cycles;                  /* nominal, without those of its load */
    uint8_t unit;                    /* enum step_unit */
    bool loads;
    uint8_t kind;  /* enum step_kind */
    uint8_t place; /* of a jump and of what it leads to */
};

enum step_unit {
    STEP_OTHER,
    STEP_ADDITION, /* of floating-point numbers, or minimum and the like */
    STEP_PRODUCT   /* of floating-point numbers, not fused */
};

enum step_kind {
    STEP_EXECUTE,
    STEP_BRANCH, /* to a later place, or on */
    STEP_AWAY,   /* to a later place */
    STEP_JOIN    /* where these lead to */
};

/* The instructions of a round of a loop, in the order of execution. */
struct chain {
    int n, instructions;
    struct chain_step step[3 * CHAIN_MOST]; /* (n) instructions, jumps and places */
};

/* A round of the longest chain: its floating-point additions, and the nominal cycles of all its
 * other instructions (1; a load 4, a product 4 and one of integers 3, a division 13, a root 18). Of
 * the additions `late` wait for something else than an addition, and of the cycles those of
 * `product` products are a part (BLOCK_PRODUCT_CYCLES each). */
struct chain_length {
    int flop, cycles, late, product;
};

/* chain_step_of: the registers and cycles of an instruction. chain_registers: the bits of the
 * registers that an operand names. */
struct chain_step chain_step_of(struct span mnemonic, struct span operands);
uint64_t chain_registers(struct span operand);

/* chain_add: one more instruction. Those beyond CHAIN_MOST are left out.
 *
 * chain_leave: a jump to a later place of the round (< CHAIN_PLACES); `always`: it never goes on.
 * chain_join: that place. Of several ways to it the shortest counts, since a processor that
 * foresees a branch does not wait for what the other way would have computed. */
void chain_add(struct chain *c, struct chain_step s);
void chain_leave(struct chain *c, int place, bool always);
void chain_join(struct chain *c, int place);

/* chain_round: what a round of the loop adds to its longest chain when the instructions are
 * executed again and again. What goes through memory is no part of it. */
struct chain_length chain_round(const struct chain *c);

/* chain_parted: a length whose numbers were rounded one by one, with no more products than its
 * cycles hold. */
struct chain_length chain_parted(struct chain_length l);

/* chain_once: the longest chain of one round alone, from its beginning to its last result. */
struct chain_length chain_once(const struct chain *c);

#endif
