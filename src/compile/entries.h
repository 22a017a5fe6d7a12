/* entries.h - functions that code of libraries may call, with an entry that keeps register 15 as it
 * finds it.
 *
 * A library that calls a function of the program (a comparison, a virtual function, operator new)
 * may have something of its own in r15, where the program counts. So such a function has two names:
 * its own, f, is an entry that saves r15, calls mimdsim_body.f, adds what that counted to the
 * image's variable mimdsim_pending, and puts r15 back. The compiler's code is the body. Calls from
 * the same file go to the body; calls from other files and through pointers go through the entry,
 * so that a function has one address.
 *
 * Exceptions of C++ that leave f hand the count over as they pass. A function with arguments on the
 * stack cannot have an entry: nothing may come between them and its return address. */
#ifndef COMPILE_ENTRIES_H
#define COMPILE_ENTRIES_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/text.h"
#include "compile/asm_line.h"

struct entries; /* the functions of one file of assembly */

/* entries_find: read gcc's assembly; in `a`, names are borrowed from the text. */
struct entries *entries_find(const struct text *in, struct arena *a);

/* entries_guarded: whether function `name` has an entry of its own beside its body: defined here,
 * with unwind information, no arguments on the stack, and known outside of this file or taken the
 * address of. */
bool entries_guarded(const struct entries *t, struct span name);

/* entries_direct: whether a call of `name` may go to the body: guarded, and no other file's
 * function of that name can take its place. */
bool entries_direct(const struct entries *t, struct span name);

/* entries_write: append the entry of a guarded function, to stand behind its body in the same
 * section. */
void entries_write(struct entries *t, struct span name, struct text *out);

/* entries_end: append what the entries need at the end of the file. */
void entries_end(const struct entries *t, struct text *out);

#endif
