/* block_filter.h - the compiler's assembly with a counter in every basic block, and the table of
 * the blocks.
 *
 * A block begins at every label that something refers to, and after every branch and call, and ends
 * before the next. At its beginning the filter writes the lea of loader/block_table.h, so that each
 * execution of the block is counted once, before anything else of it; what a call does not return
 * from is not counted. No instruction that is added touches a flag, the stack or memory.
 *
 * One thing is changed: memcpy, memmove and memset are called as mimdsim_memcpy and so on, which
 * count their bytes (guest/memory.S). With `guarded`, functions that libraries may call get an
 * entry beside their code (entries.h). */
#ifndef COMPILE_BLOCK_FILTER_H
#define COMPILE_BLOCK_FILTER_H

#include <stdbool.h>
#include <stdint.h>

#include "base/err.h"
#include "base/text.h"

/* Most instructions of one block: longer ones are counted in pieces, so that no count of
 * block_table.h overflows and a piece stays below 2.1 ms on the slowest of machines. */
enum { BLOCK_MOST_INSTRUCTIONS = 250 };

/* What the note of an object says, and the place in messages. */
struct block_source {
    const char *name;  /* of the source */
    const char *flags; /* that act on code */
    bool written;      /* assembly written by a person: numbers of lines are those of `name` */
    bool guarded;      /* functions get entries that keep register 15 (entries.h) */
};

/* block_filter: `in`, assembly of gcc or of a person, to *out (appended).
 *
 * In asm statements nothing is inserted; they count once, as they are written. A text that went
 * through the filter before comes out as it is.
 *
 * Returns false with ERR_DATA at the source's line when code uses register r15, which holds the
 * count; or when the compiler was not gcc. */
bool block_filter(const struct text *in, const struct block_source *source, struct text *out,
                  struct err *e);

/* block_note: append the note of an object that was compiled from `source` by `compiler` (n bytes,
 * as in .ident). */
void block_note(const struct block_source *source, const char *compiler, int n, struct text *out);

#endif
