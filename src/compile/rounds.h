/* rounds.h - how often a loop is made each time it is entered, where its code tells. */
#ifndef COMPILE_ROUNDS_H
#define COMPILE_ROUNDS_H

#include "compile/loops.h"

/* rounds_of: the rounds of loop `l` of `c`, 0: not known, or more than CHAIN_MOST.
 *
 * Known are loops that end with a comparison of a register, which one instruction of the loop moves
 * by a constant, with a constant or with a register that the loop leaves alone; and whose beginning
 * and end differ by a constant, followed back through moves, lea, and additions of constants. The
 * way back follows the text, not the flow of control: a program that jumps into the middle may be
 * taken for another one, which makes its predicted time a little worse. */
int rounds_of(const struct code *c, const struct code_loop *l);

#endif
