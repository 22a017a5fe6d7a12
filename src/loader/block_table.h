/* block_table.h - what an image of `mimdsim cc` says of its code: basic blocks, what each does, who
 * compiled it.
 *
 * In every basic block of the program stands one instruction
 *
 *     4d 8d bf IMM32      lea IMM32(%r15), %r15
 *
 * that adds the block's cost in picoseconds to register r15, which the compiler leaves alone
 * (-ffixed-r15) and which the program's stubs hand over to the simulator. lea, because it leaves
 * the flags as they are. The immediate is 0 in the file; it is written when the image is loaded for
 * a run, from the costs of the run's machine (block_costs.h).
 *
 * Section `mimdsim_blocks` (read-only, 4-byte aligned) is an array of struct block_entry, one for
 * each block, in no order that matters. Each piece of it is in the COMDAT group of its code and
 * linked to the section of its code, so that the linker drops both or neither.
 *
 * Section `.note.mimdsim` (SHT_NOTE) has one note for each object that was compiled: name
 * "mimdsim", type BLOCK_NOTE_OBJECT, descriptor: BLOCK_TABLE_ABI as 32 bits, then a text that ends
 * in NUL: the source's name, the compiler, and the flags that act on code, as "sum.c; GCC:
 * (Debian 12.2.0-14) 12.2.0; -O2 -g". An object without it was not compiled by `mimdsim cc`. All
 * numbers are little-endian. */
#ifndef LOADER_BLOCK_TABLE_H
#define LOADER_BLOCK_TABLE_H

#include <stdint.h>

#include "machine/node_cost.h"

#define BLOCK_TABLE_SECTION "mimdsim_blocks"
#define BLOCK_NOTE_SECTION ".note.mimdsim"
#define BLOCK_NOTE_NAME "mimdsim"

enum { BLOCK_TABLE_ABI = 5, BLOCK_NOTE_OBJECT = 1 };

/* Nominal cycles of a product in a chain (machine/node_cost.h). */
enum { BLOCK_PRODUCT_CYCLES = CODE_PRODUCT_CYCLES };

/* The bytes in front of the immediate. */
#define BLOCK_ADD_OPCODE "\x4d\x8d\xbf"
enum { BLOCK_ADD_OPCODE_BYTES = 3, BLOCK_ADD_BYTES = 7 };

/* What one execution of a block does, in the classes of base/work.h and more. The filter
 * starts a new block before a count would overflow. */
struct block_counts {
    uint16_t instruction; /* instructions; a vector instruction counts once for each 8 bytes of its
                             registers */
    uint16_t flop; /* floating-point additions, subtractions, multiplications, by lanes; a fused one
                      is two */
    uint16_t div;  /* divisions, floating-point by lanes and of integers */
    uint16_t sqrt; /* square roots, by lanes */
    uint16_t trig; /* elementary functions called: sin, exp, ...; pow and sincos are two */
    uint16_t call; /* calls; their instructions are counted as such, so that node_cost.h does not
                      price them */
    uint16_t bytes; /* loaded and stored, but for the stack frame and constants [B] */
    uint16_t issue; /* instructions, each once, however wide */
    uint16_t load;  /* loads of vector registers, constants and the stack frame's, too */
    uint16_t whole; /* instructions that compute with whole numbers; a product of two words is
                       two */
    uint16_t add; /* floating-point additions, comparisons and conversions, each once, however wide;
                     a conversion of a whole number is two */
    uint16_t multiply;      /* floating-point products, likewise, also fused ones */
    uint16_t chain_flop;    /* of a loop that is one block: its longest chain (compile/chain.h), in
                               floating-point additions */
    uint16_t chain_cycle;   /* and in nominal cycles of other instructions */
    uint16_t chain_late;    /* of its additions, those that wait for something else than one */
    uint16_t chain_product; /* products, whose BLOCK_PRODUCT_CYCLES are in its cycles */
    uint16_t blocks;        /* blocks that are entered: 1, in a round of a loop more, of a rate 0 */
    uint16_t once_flop;     /* of a loop: the longest chain of a round by itself, from its beginning
                               to its last result, likewise in four numbers */
    uint16_t once_cycle;
    uint16_t once_late;
    uint16_t once_product;
};

struct block_entry {
    int32_t immediate;          /* from this member's address to IMM32 [B]; BLOCK_LOOP: how many of
                                   the entries that follow are blocks of the loop */
    uint32_t length;            /* of a block that is a loop by itself, with its counter [B], of
                                   others 0 */
    struct block_counts counts; /* of one execution */
    uint16_t kind;              /* enum block_kind */
};

enum block_kind {
    BLOCK_ADD,  /* IMM32 of the lea above */
    BLOCK_RATE, /* a 32-bit word in data or code that becomes the cost of the counts: for code that
                   multiplies it */
    BLOCK_LOOP  /* no word: what a round of the loop does whose blocks follow (compile/loops.h) */
};

_Static_assert(sizeof(struct block_entry) == 52,
               "entries are written by the assembler as two longs and twenty-two words");

#endif
