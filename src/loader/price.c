/* price.c - tables of blocks found in every file of a template. */
#include "loader/price.h"

#include <string.h>

#include "loader/block_costs.h"
#include "loader/template.h"

/* Bytes of a template by their place in it. What is written must lie in the pages of one file. */
static void *at_place(const void *template, uint64_t place, size_t size)
{
    const struct loader_template *t = template;
    for (int i = 0; i < t->nfile; i++) {
        const struct loader_file *f = &t->file[i];
        if (place >= f->begin && place < f->end && size <= f->end - place) return t->bytes + place;
    }
    return NULL;
}

/* Notes of objects that were counted by other rules have entries of another form: they are told
 * apart here, before a table is taken for what it is not. Format: gABI 5, "Note Section". */
static bool same_rules(const struct loader_file *f, struct err *e)
{
    uint64_t address, bytes;
    struct note {
        uint32_t name_bytes, bytes, type;
        char name[sizeof BLOCK_NOTE_NAME];
        uint32_t abi;
    };
    _Static_assert(sizeof(struct note) == 24, "the name takes two words");
    if (!elf_file_section(&f->elf, BLOCK_NOTE_SECTION, &address, &bytes)) return true;
    /* The linker puts the notes of all objects one behind the other, each padded to four bytes. */
    const char *at = elf_file_at(&f->elf, address, bytes, 4);
    for (struct note n; at != NULL && bytes >= sizeof n;) {
        memcpy(&n, at, sizeof n);
        if (n.name_bytes != sizeof n.name || memcmp(n.name, BLOCK_NOTE_NAME, sizeof n.name) != 0)
            return true;
        /* One object of other rules is enough: its entries lie among those of the others. */
        if (n.abi != BLOCK_TABLE_ABI)
            return err_set(e, ERR_DATA,
                           "%s was made by another version of `mimdsim cc` (rules %u, here %d): "
                           "compile it again",
                           f->elf.path, n.abi, BLOCK_TABLE_ABI);
        /* A note that would end behind the section is damage, which the table's own checks find. */
        const uint64_t whole = sizeof n - sizeof n.abi + (((uint64_t)n.bytes + 3) & ~UINT64_C(3));
        if (whole < sizeof n || whole >= bytes) return true;
        at += whole;
        bytes -= whole;
    }
    return true;
}

/* Libraries that `mimdsim cc` made have tables of their own; others have none, and cost nothing. */
bool loader_price_blocks(struct loader_template *t, const struct node_cost *c, double factor,
                         struct err *e)
{
    for (int i = 0; i < t->nfile; i++) {
        const struct loader_file *f = &t->file[i];
        uint64_t address, bytes;
        if (!same_rules(f, e)) return false;
        if (!elf_file_section(&f->elf, BLOCK_TABLE_SECTION, &address, &bytes)) continue;
        const uint64_t place = f->place + address;
        const void *entry = at_place(t, place, bytes);
        /* Sections may lie in the file and yet outside of what is loaded. */
        if (entry == NULL)
            return err_set(e, ERR_DATA, "the table of basic blocks lies outside of the file");
        if ((uintptr_t)entry % _Alignof(struct block_entry) != 0)
            return err_set(e, ERR_DATA, "the table of basic blocks is not aligned to 4 bytes");
        const struct block_table table = {entry, bytes / sizeof(struct block_entry), place};
        if (!block_costs_patch(&table, at_place, t, c, factor, e)) return false;
    }
    return true;
}
