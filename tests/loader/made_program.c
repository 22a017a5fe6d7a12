/* made_program.c - see made_program.h. */
#include "made_program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

struct made made[2];
struct loader_template *program;
int made_begin(void **state)
{
    (void)state;
    memset(made, 0, sizeof made);
    program = calloc(1, sizeof *program);
    program->memory = -1;
    program->nfile = 2;
    for (int i = 0; i < 2; i++) {
        struct made *x = &made[i];
        struct elf_file *f = &program->file[i].elf;
        x->used = 1;
        for (int k = 0; k < FILE_BYTES; k++) x->bytes[k] = (char)(k * 7 + i);
        memset(x->bytes + DATA, 0, DATA_BYTES);
        f->path = i == 0 ? "program" : "library.so";
        f->bytes = x->bytes;
        f->size = FILE_BYTES;
        f->segment[0] = (Elf64_Phdr){.p_type = PT_LOAD,
                                     .p_flags = PF_R | PF_X,
                                     .p_filesz = TEXT_BYTES,
                                     .p_memsz = TEXT_BYTES};
        f->segment[1] = (Elf64_Phdr){.p_type = PT_LOAD,
                                     .p_flags = PF_R | PF_W,
                                     .p_offset = DATA,
                                     .p_vaddr = DATA,
                                     .p_filesz = DATA_BYTES,
                                     .p_memsz = DATA_MEMORY};
        f->nsegment = 2;
        f->strings = x->strings;
        f->strings_size = sizeof x->strings;
        f->symbol = x->symbol;
        f->nsymbol = 1;
        f->version = x->version;
        f->rela[0].at = x->rela;
    }
    return 0;
}

int made_end(void **state)
{
    (void)state;
    image_give_back(program);
    symbols_give_back(program);
    free(program->relative);
    free(program->indirect);
    free(program);
    return 0;
}

size_t made_symbol(int file, const char *name, int binding, int type, int section, uint64_t value)
{
    struct made *x = &made[file];
    struct elf_file *f = &program->file[file].elf;
    assert_true(f->nsymbol < SYMBOLS && x->used + strlen(name) + 1 <= sizeof x->strings);
    strcpy(x->strings + x->used, name);
    x->symbol[f->nsymbol] = (Elf64_Sym){.st_name = (Elf64_Word)x->used,
                                        .st_info = (unsigned char)ELF64_ST_INFO(binding, type),
                                        .st_shndx = (Elf64_Section)section,
                                        .st_value = value};
    x->used += strlen(name) + 1;
    x->version[f->nsymbol] = 1;
    return f->nsymbol++;
}

size_t made_variable(int file, const char *name, uint64_t value)
{
    return made_symbol(file, name, STB_GLOBAL, STT_OBJECT, 1, value);
}

size_t made_unknown(int file, const char *name, int binding)
{
    return made_symbol(file, name, binding, STT_NOTYPE, SHN_UNDEF, 0);
}

void made_relocation(int file, unsigned type, uint64_t at, size_t symbol_number, int64_t addend)
{
    struct elf_table *table = &program->file[file].elf.rela[0];
    assert_true(table->n < RELOCATIONS);
    made[file].rela[table->n++] =
        (Elf64_Rela){at, ELF64_R_INFO((uint64_t)symbol_number, (uint64_t)type), addend};
}

void made_image(void)
{
    struct err e;
    err_clear(&e);
    if (!symbols_make(program, &e) || !image_make(program, &e)) fail_msg("%s", e.text);
}
