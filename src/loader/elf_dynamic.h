/* elf_dynamic.h - the dynamic section of a shared object: tables of symbols, names, relocations,
 * checked once. */
#ifndef LOADER_ELF_DYNAMIC_H
#define LOADER_ELF_DYNAMIC_H

#include "loader/elf_file.h"

/* elf_bad: ERR_DATA at the file, with what is wrong. Returns false. */
bool elf_bad(const struct elf_file *f, struct err *e, const char *what);

/* elf_dynamic_read: fill the tables of *f from the segment `dynamic`. False with ERR_DATA. */
bool elf_dynamic_read(struct elf_file *f, const Elf64_Phdr *dynamic, struct err *e);

#endif
