/* object_check.h - whether what is linked was compiled by `mimdsim cc`. */
#ifndef COMPILE_OBJECT_CHECK_H
#define COMPILE_OBJECT_CHECK_H

#include <stdbool.h>

#include "base/err.h"
#include "base/text.h"

/* What an ELF file of x86-64, relocatable or shared, holds. */
struct object_facts {
    bool is_object; /* it is such a file */
    bool has_code;  /* a section of instructions that is not empty */
    bool counted;   /* the note of block_table.h */
    bool kernel;    /* defines mimdsim_program: a kernel in one file */
};

/* object_facts: of n bytes. Damaged files are no objects; the linker says what is wrong with them.
 */
struct object_facts object_facts(const void *bytes, size_t n);

/* object_facts_of_file: of a file, nothing when it cannot be read. */
struct object_facts object_facts_of_file(const char *path);

/* object_check_trace: every file that the linker says it used (--trace twice: a path in a line,
 * members of archives as
 * "(ARCHIVE)MEMBER") must be counted, unless it holds no code or belongs to the system: lies in
 * /usr/lib, /lib, /usr/lib64, /lib64 or in a folder `gcc` of compilers, or is one of ours
 * (libmimdsim-*). Returns false with ERR_DATA that names the file. */
bool object_check_trace(const struct text *trace, struct err *e);

#endif
