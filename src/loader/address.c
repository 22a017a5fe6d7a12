/* address.c - which rank, file and line an address in some rank's copy of a program belongs to. */
#include "loader/crash.h"
#include "loader/template.h"

bool loader_address_text(const struct loader_template *t, const void *address, char *buffer,
                         int size)
{
    const char *file;
    uint64_t at;
    if (!loader_find_address(t, address, NULL, &file, &at)) return false;
    place_text(file, at, buffer, size);
    return true;
}

bool loader_find_address(const struct loader_template *t, const void *address, int *rank,
                         const char **file, uint64_t *at)
{
    if (!t->memory_of_ranks) return false;
    const uint64_t offset = (uint64_t)((const char *)address - t->memory_of_ranks),
                   place = offset % t->stride;
    if (offset >= t->stride * (uint64_t)t->nrank) return false;
    for (int i = 0; i < t->nfile; i++) {
        const struct loader_file *f = &t->file[i];
        if (place < f->begin || place >= f->memory_end) continue;
        if (rank) *rank = (int)(offset / t->stride);
        *file = f->elf.path;
        *at = place - f->place;
        return true;
    }
    return false;
}
