/* relocate.c - all relocations of a program and its libraries, once, in the template.
 *
 * psABI 4.4, table 4.9. S: the symbol's value, A: the addend, B: where the file lies. A rank's copy
 * at address B' has other values than the template only by B' itself, so the places that hold an
 * address of the program are listed, and a copy is made by adding B' there: about 1 ns each,
 * whatever the symbol's name was. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "loader/elf_dynamic.h"
#include "loader/template.h"

/* Symbols that nobody defines, for one message about all of them. */
struct missing {
    char text[512];
    int n;
};

/* A place that holds an address of the program: each copy adds its own base there. */
static void add_relative(struct loader_template *t, uint64_t place)
{
    if (t->nrelative == t->relative_capacity) {
        t->relative_capacity = t->relative_capacity ? 2 * t->relative_capacity : 1024;
        t->relative = memory_resize(t->relative, t->relative_capacity, sizeof *t->relative);
    }
    t->relative[t->nrelative++] = place;
}

/* A place whose value a function of the program tells (STT_GNU_IFUNC); it is called in each
 * copy. */
static void add_indirect(struct loader_template *t, uint64_t place, uint64_t resolver)
{
    if (t->nindirect == t->indirect_capacity) {
        t->indirect_capacity = t->indirect_capacity ? 2 * t->indirect_capacity : 64;
        t->indirect = memory_resize(t->indirect, t->indirect_capacity, sizeof *t->indirect);
    }
    t->indirect[t->nindirect++] = (struct indirect){place, resolver};
}

/* Places need not be aligned. */
static void put(struct loader_template *t, uint64_t place, uint64_t value)
{
    memcpy(t->bytes + place, &value, sizeof value);
}

/* Whether the list "a, b" has this name: whole, since it may be a part of another one. */
static bool is_noted(const struct missing *m, const char *name)
{
    const size_t n = strlen(name);
    for (const char *at = m->text; (at = strstr(at, name)) != NULL; at++)
        if ((at == m->text || at[-1] == ' ') && (at[n] == ',' || at[n] == '\0')) return true;
    return false;
}

/* Once each, as far as the message has room. Of a damaged file it may have no name. */
static void note_missing(struct missing *m, const char *name)
{
    size_t used = strlen(m->text);
    m->n++;
    if (name[0] == '\0') name = "(without a name)";
    if (is_noted(m, name) || used + strlen(name) + 3 > sizeof m->text) return;
    snprintf(m->text + used, sizeof m->text - used, "%s%s", used ? ", " : "", name);
}

/* S + A for a symbol: of the program (relative), of the host or absolute (as it is), or known only
 * at run time. */
static void put_address(struct loader_template *t, uint64_t place, const struct found *s,
                        uint64_t addend)
{
    if (!s->file) {
        put(t, place, (uint64_t)(uintptr_t)s->address + addend);
        return;
    }
    const uint64_t value = s->symbol->st_value;
    if (s->symbol->st_shndx == SHN_ABS) {
        put(t, place, value + addend);
        return;
    }
    if (ELF64_ST_TYPE(s->symbol->st_info) == STT_GNU_IFUNC) {
        add_indirect(t, place, s->file->place + value);
        return;
    }
    put(t, place, s->file->place + value + addend);
    add_relative(t, place);
}

/* Thread-locals: the slot that names the module gets the address of the rank's block (symbols.c,
 * tls_get_address). */
static bool put_tls(struct loader_template *t, struct loader_file *f, uint64_t place,
                    const struct found *s, const Elf64_Rela *r, struct err *e)
{
    const struct loader_file *owner = s->file ? s->file : f;
    if (owner->elf.tls.p_memsz == 0)
        return elf_bad(&f->elf, e, "a thread-local of a file that has none");
    if (ELF64_R_TYPE(r->r_info) == R_X86_64_DTPOFF64) {
        put(t, place, (s->symbol ? s->symbol->st_value : 0) + (uint64_t)r->r_addend);
        return true;
    }
    put(t, place, owner->tls);
    add_relative(t, place);
    return true;
}

/* Relocations that only ordinary executables or special options make, with the way out. */
static bool refuse(const struct loader_file *f, unsigned type, struct err *e)
{
    switch (type) {
    case R_X86_64_TPOFF64:
        return elf_bad(
            &f->elf, e,
            "thread-locals by the initial-exec model; compile all of it with `mimdsim cc`, without "
            "-ftls-model");
    case R_X86_64_TLSDESC:
        return elf_bad(&f->elf, e,
                       "thread-locals by descriptors; compile without -mtls-dialect=gnu2");
    case R_X86_64_COPY:
        return elf_bad(&f->elf, e, "a copy relocation; link it with `mimdsim cc`");
    default:
        return err_set_at(e, ERR_DATA, f->elf.path, 0,
                          "not a usable program: relocation of type %u, which shared objects "
                          "for x86-64 do not have",
                          type);
    }
}

/* A damaged file must not write outside its data, so place and symbol are checked first. */
static bool relocate(struct loader_template *t, struct loader_file *f, const Elf64_Rela *r,
                     struct missing *m, struct err *e)
{
    /* The formulas of psABI 4.4 stand at the cases. */
    const unsigned type = ELF64_R_TYPE(r->r_info);
    const size_t symbol = ELF64_R_SYM(r->r_info);
    const uint64_t place = f->place + r->r_offset, addend = (uint64_t)r->r_addend;
    struct found s;
    if (type == R_X86_64_NONE) return true;
    if (symbol >= f->elf.nsymbol)
        return elf_bad(&f->elf, e, "a relocation names a symbol that is not there");
    if (!image_writable(f, place, 8))
        return elf_bad(&f->elf, e, "a relocation lies outside the data");
    if (!symbols_find(t, f, symbol, &s)) {
        note_missing(m, elf_file_name(&f->elf, f->elf.symbol[symbol].st_name));
        return true;
    }
    switch (type) {
    case R_X86_64_RELATIVE: /* B + A */
        put(t, place, f->place + addend);
        add_relative(t, place);
        return true;
    case R_X86_64_64: /* S + A */
        put_address(t, place, &s, addend);
        return true;
    case R_X86_64_GLOB_DAT: /* S */
    case R_X86_64_JUMP_SLOT:
        put_address(t, place, &s, 0);
        return true;
    case R_X86_64_DTPMOD64:
    case R_X86_64_DTPOFF64:
        return put_tls(t, f, place, &s, r, e);
    case R_X86_64_IRELATIVE: /* the function at B + A tells */
        if (!image_code(&f->elf, addend))
            return elf_bad(&f->elf, e, "a resolver lies outside the program text");
        add_indirect(t, place, f->place + addend);
        return true;
    default:
        return refuse(f, type, e);
    }
}

/* Packed relative relocations: an even word is an address; an odd one has a bit for each of the 63
 * words that follow the last address. The addend stands in the place itself. */
static bool relocate_packed(struct loader_template *t, struct loader_file *f, struct err *e)
{
    const uint64_t *word = f->elf.relr.at;
    uint64_t next = 0;
    for (size_t n = 0; n < f->elf.relr.n; n++) {
        const bool address = !(word[n] & 1);
        uint64_t bits = address ? 1 : word[n] >> 1;
        if (address) next = word[n];
        for (uint64_t at = f->place + next; bits; bits >>= 1, at += 8) {
            uint64_t value;
            if (!(bits & 1)) continue;
            if (!image_writable(f, at, 8))
                return elf_bad(&f->elf, e, "a relocation lies outside the data");
            memcpy(&value, t->bytes + at, sizeof value);
            put(t, at, f->place + value);
            add_relative(t, at);
        }
        next += address ? 8 : 8 * 63;
    }
    return true;
}

/* Ascending addresses. */
static int by_place(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* All files are gone through before a missing symbol stops: one message names them all. */
bool relocate_all(struct loader_template *t, struct err *e)
{
    for (int i = 0; i < t->nfile; i++) {
        struct loader_file *f = &t->file[i];
        struct missing m = {.n = 0};
        if (!relocate_packed(t, f, e)) return false;
        for (int k = 0; k < 2; k++) {
            const Elf64_Rela *r = f->elf.rela[k].at;
            for (size_t n = 0; n < f->elf.rela[k].n; n++)
                if (!relocate(t, f, &r[n], &m, e)) return false;
        }
        if (m.n)
            return err_set_at(e, ERR_DATA, f->elf.path, 0,
                              "uses what neither it, its libraries nor libc and libm define: %s",
                              m.text);
    }
    /* Copies go through memory in one direction. */
    if (t->nrelative) qsort(t->relative, t->nrelative, sizeof *t->relative, by_place);
    return true;
}
