/* programs.h - the table of built-in programs. */
#ifndef KERNEL_PROGRAMS_H
#define KERNEL_PROGRAMS_H

#include "program/program.h"

/* program_list: all built-in programs, (*n) pointers. */
const struct program_type *const *program_list(int *n);

/* program_find: by name; NULL when there is none. */
const struct program_type *program_find(const char *name);

#endif
