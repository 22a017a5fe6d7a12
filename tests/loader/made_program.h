/* made_program.h - a program and a library made table by table, without files: what the inner tests
 * of room loader work on. */
#ifndef TESTS_LOADER_MADE_PROGRAM_H
#define TESTS_LOADER_MADE_PROGRAM_H

#include "loader/template.h"

/* Each file: two pages of text, a page that is not loaded, two pages of data of which the file
 * fills one and a bit, and zeroed memory behind them. */
enum {
    TEXT_BYTES = 0x1800,
    DATA = 0x3000,
    DATA_BYTES = 0x1100,
    DATA_MEMORY = 0x4000,
    FILE_BYTES = DATA + DATA_BYTES,
    SYMBOLS = 24,
    RELOCATIONS = 24
};

struct made {
    char bytes[FILE_BYTES];
    char strings[600];
    Elf64_Sym symbol[SYMBOLS];
    uint16_t version[SYMBOLS];
    Elf64_Rela rela[RELOCATIONS];
    uint64_t relr[16];
    size_t used; /* of strings */
};

/* made_begin, made_end: setup and teardown of a test: file 0 is the program, file 1 a library. */
extern struct made made[2];
extern struct loader_template *program;
int made_begin(void **state);
int made_end(void **state);

/* made_symbol: a symbol more in a file; its number. made_variable: global data. made_unknown: one
 * that the file does not define. */
size_t made_symbol(int file, const char *name, int binding, int type, int section, uint64_t value);
size_t made_variable(int file, const char *name, uint64_t value);
size_t made_unknown(int file, const char *name, int binding);

/* made_relocation: one more. made_image: symbols and bytes, or the test fails. */
void made_relocation(int file, unsigned type, uint64_t at, size_t symbol, int64_t addend);
void made_image(void);

#endif
