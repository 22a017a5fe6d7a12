/* tape.h - what the ranks of a program did, written down once and repeated on other machines.
 *
 * A program whose ranks look at no clock does the same on every machine: the same computing, the
 * same messages, the same answer. Where a campaign runs one task on many machines, the second run
 * writes it down, and later ones repeat it: messages have their sizes and no contents, computing
 * its counts. Times, accounts and digests are those of the program itself. */
#ifndef RUN_TAPE_H
#define RUN_TAPE_H

#include <stdbool.h>
#include <stddef.h>

#include "comm/comm.h"
#include "measure/run_result.h"
#include "program/program.h"

struct fiber_pool;

/* The tapes of one process, written at the second run of a task, since most are run once, or
 * `at_once`; destroy accepts NULL. */
struct tapes;
struct tape;
struct tapes *tapes_create(bool at_once);
void tapes_destroy(struct tapes *t);

/* tape_for: the tape of an opened and prepared run with its present settings, borrowed until
 * tapes_destroy: whole, or empty and to be written. NULL: such a run is the first, or does not
 * repeat itself (program_type.repeats), or shares nothing (KEEP_SCENES), or there is no room. */
struct tape *tape_for(struct tapes *t, const struct program_run *r);

/* tape_whole: whether it is repeated. tape_workspace: the memory that a rank then needs instead of
 * its program's [B]. tape_stacks: where its stacks stay for the next run, as nobody asks how deep
 * they are (world.h); NULL where it is not whole. */
bool tape_whole(const struct tape *t);
size_t tape_workspace(const struct tape *t, int rank);
struct fiber_pool **tape_stacks(const struct tape *t);

/* tape_rank: one rank's program, written down or repeated. Ranks of one run may be on several
 * threads. */
void tape_rank(struct tape *t, struct comm *c, const struct rank_program *rank, const void *job,
               void *workspace);

/* tape_none: the run is over, and had no tape: how much stack it took is kept. */
void tape_none(struct tapes *all, const struct program_run *r, const struct run_result *out);

/* tape_end: the run is over: its outputs are kept, or those of a tape that was repeated are given
 * to it. False: it did not end well and is to be made without the tape, which alone can tell
 * why. */
bool tape_end(struct tapes *all, struct tape *t, struct program_run *r, struct run_result *out);

#endif
