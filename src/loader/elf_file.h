/* elf_file.h - one ELF shared object read and checked: afterwards every table and every name lies
 * within the file.
 *
 * Addresses are those of the file (its first segment near 0). Nothing here knows of ranks. */
#ifndef LOADER_ELF_FILE_H
#define LOADER_ELF_FILE_H

#include <elf.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/err.h"

enum { ELF_SEGMENTS = 16, ELF_NEEDED = 64 };

/* A table of the file: where, and how many entries. */
struct elf_table {
    const void *at; /* within the bytes of the file */
    size_t n;
};

struct elf_file {
    char *path;  /* owned */
    char *bytes; /* (size) owned */
    size_t size;
    const Elf64_Phdr *header; /* (nheader) */
    int nheader;
    Elf64_Phdr segment[ELF_SEGMENTS]; /* (nsegment) to be loaded, by rising address */
    int nsegment;
    Elf64_Phdr tls, relro; /* p_memsz 0: none */
    const char *strings;   /* (strings_size) ends in a zero */
    size_t strings_size;
    const Elf64_Sym *symbol; /* (nsymbol) names checked */
    size_t nsymbol;
    const uint16_t *version;         /* (nsymbol) NULL: no versions */
    uint64_t verneed, nverneed;      /* address of the versions wanted of files, how many files */
    struct elf_table rela[2];        /* Elf64_Rela: DT_RELA, DT_JMPREL */
    struct elf_table relr;           /* uint64_t: DT_RELR */
    uint64_t init, fini;             /* addresses of functions, 0: none */
    uint64_t init_array, fini_array; /* addresses */
    size_t ninit, nfini;
    const char *needed[ELF_NEEDED]; /* (nneeded) */
    int nneeded;
    const char *soname, *runpath; /* NULL: none */
    bool symbolic;                /* its own symbols first */
};

/* elf_file_read: read and check the shared object `path`. False with ERR_NO_INPUT, ERR_DATA; *f is
 * then empty. */
bool elf_file_read(struct elf_file *f, const char *path, struct err *e);

/* elf_file_free: give back what elf_file_read took; an empty one is fine. */
void elf_file_free(struct elf_file *f);

/* elf_file_at: the `size` bytes from `address` on as the file has them, NULL: not all within one
 * segment's part of the file, or not aligned to `align`. */
const void *elf_file_at(const struct elf_file *f, uint64_t address, uint64_t size, size_t align);

/* elf_file_name: the text at `offset` of the string table; checked before. */
static inline const char *elf_file_name(const struct elf_file *f, size_t offset)
{
    return f->strings + offset;
}

/* elf_file_version: the version that symbol number i is to have in another file ("GLIBC_2.2.5"),
 * NULL: any. */
const char *elf_file_version(const struct elf_file *f, size_t i);

/* elf_file_section: address and size of the section `name`, as the section headers tell; false:
 * none or not loaded. */
bool elf_file_section(const struct elf_file *f, const char *name, uint64_t *address,
                      uint64_t *size);

#endif
