/* label_set.h - the labels that some code or data of a file refers to. */
#ifndef COMPILE_LABEL_SET_H
#define COMPILE_LABEL_SET_H

#include <stdbool.h>

#include "base/arena.h"
#include "compile/asm_line.h"

struct label_set; /* an open hash table of spans */

/* label_set_make: an empty set in `a`. Names that are put in are borrowed and must outlive it. */
struct label_set *label_set_make(struct arena *a);

/* label_set_put: add a name; once is enough. */
void label_set_put(struct label_set *set, struct span name);

/* label_set_has: whether it is there. */
bool label_set_has(const struct label_set *set, struct span name);

/* label_set_put_local: add every local label (.L...) that a piece of a line names. */
void label_set_put_local(struct label_set *set, struct span operands);

#endif
