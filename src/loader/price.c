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

/* Libraries that `mimdsim cc` made have tables of their own; others have none, and cost nothing. */
bool loader_price_blocks(struct loader_template *t, const struct node_cost *c, double factor,
                         struct err *e)
{
    for (int i = 0; i < t->nfile; i++) {
        const struct loader_file *f = &t->file[i];
        uint64_t address, bytes;
        if (!elf_file_section(&f->elf, BLOCK_TABLE_SECTION, &address, &bytes)) continue;
        const uint64_t place = f->place + address;
        const void *entry = at_place(t, place, bytes);
        /* Sections may lie in the file and yet outside of what is loaded. */
        if (entry == NULL)
            return err_set(e, ERR_DATA, "the table of basic blocks lies outside of the file");
        const struct block_table table = {entry, bytes / sizeof(struct block_entry), place};
        if (!block_costs_patch(&table, at_place, t, c, factor, e)) return false;
    }
    return true;
}
