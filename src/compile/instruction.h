/* instruction.h - what an x86-64 instruction does: its work by class, and where control goes. */
#ifndef COMPILE_INSTRUCTION_H
#define COMPILE_INSTRUCTION_H

#include <stdbool.h>

#include "compile/asm_line.h"
#include "loader/block_table.h"

enum flow {
    FLOW_ON,     /* to the next instruction */
    FLOW_BRANCH, /* to the next or elsewhere */
    FLOW_CALL,   /* elsewhere and perhaps back */
    FLOW_AWAY    /* elsewhere: jump, return, trap */
};

/* Which vector lanes, sizes and accesses an instruction has follows from its mnemonic and its
 * registers (Intel SDM volume 2); what is unknown counts as one plain instruction.
 *
 * instruction_read: flow and counts of one instruction.
 *
 *   frame   in      whether %rbp points to the stack frame here: what it addresses is then no
 * memory access counts  out     of this instruction alone, with what a called function of
 * elementary_list.h does */
enum flow instruction_read(struct span mnemonic, struct span operands, bool frame,
                           struct block_counts *counts);

/* instruction_is_frame_set: whether it makes %rbp the frame pointer: movq %rsp, %rbp. */
bool instruction_is_frame_set(struct span mnemonic, struct span operands);

/* instruction_uses_r15: whether an operand is register r15 or a part of it. */
bool instruction_uses_r15(struct span operands);

#endif
