/* address.c - which rank, file and line an address in some rank's copy of a program belongs to. */
#include <stdio.h>

#include "loader/crash.h"
#include "loader/template.h"

/* The copies of all ranks look alike, so the text does not depend on the rank. */
bool loader_address_text(const struct loader_template *t, const void *address, char *buffer,
                         int size)
{
    const char *file;
    uint64_t at;
    if (!loader_find_address(t, address, NULL, &file, &at)) return false;
    place_text(file, at, buffer, size);
    return true;
}

/* Copies lie one stride apart: the quotient is the rank, the rest is the place in its copy.
 * Within that the file is the one whose pages hold the place; none does between two files. */
bool loader_find_address(const struct loader_template *t, const void *address, int *rank,
                         const char **file, uint64_t *at)
{
    if (!t->memory_of_ranks) return false;
    const uint64_t offset = (uint64_t)((const char *)address - t->memory_of_ranks),
                   place = offset % t->stride;
    /* Addresses below the copies have wrapped, and are larger than all of them. */
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

/* The length of FF /2 with its operand, from its second byte on (Intel SDM 2, tables 2-2 and 2-3):
 * a byte for base and index where the operand has them, then none, one or four of distance. 0: it
 * is another instruction. */
static int length_of_call(const unsigned char *p)
{
    const int mode = p[0] >> 6, base = p[0] & 7;
    if ((p[0] & 0x38) != 0x10) return 0;
    const bool index = mode != 3 && base == 4;
    const bool far = mode == 2 || (mode == 0 && (base == 5 || (index && (p[1] & 7) == 5)));
    return 2 + index + (far ? 4 : mode == 1);
}

/* A call stands before it: E8, or FF /2, which has two to seven bytes; a prefix for more registers
 * may stand before these. */
bool loader_is_return(const struct loader_instance *i, const void *address)
{
    const struct loader_template *t = i->t;
    const uint64_t pc = (uint64_t)(uintptr_t)address;
    const uint64_t place = pc - (uint64_t)(uintptr_t)i->base;
    for (int k = 0; k < t->nfile; k++) {
        const struct loader_file *f = &t->file[k];
        if (place < f->begin + 8 || place >= f->data || !image_code(&f->elf, place - f->place - 8))
            continue;
        const unsigned char *p = (const unsigned char *)(uintptr_t)pc;
        bool call = p[-5] == 0xe8;
        for (int n = 2; n <= 7 && !call; n++)
            call = p[-n] == 0xff && length_of_call(p - n + 1) == n;
        return call;
    }
    return false;
}

/* Places without a line are those of libraries: the one to blame is the next one up that has a
 * line. */
bool loader_place_text(const struct loader_instance *i, const void *place, const void *stack,
                       char *buffer, int size)
{
    enum { WORDS = 4096, TRIES = 12 };
    const char *file;
    uint64_t at;
    char other[512];
    void *const *word = stack;
    const bool there =
        place && loader_find_address(i->t, (const char *)place - 1, NULL, &file, &at);
    if (there && place_text(file, at, buffer, size)) return true;
    /* Callers stand behind the place itself. */
    for (int k = 0; there && k < WORDS && word[0] != place && (uintptr_t)word < i->stack; k++)
        word++;
    for (int k = 0, tries = 0; k < WORDS && tries < TRIES && (uintptr_t)&word[k] < i->stack; k++) {
        if (!loader_is_return(i, word[k]) ||
            !loader_find_address(i->t, (const char *)word[k] - 1, NULL, &file, &at))
            continue;
        /* A stack of calls inside a library may be deep; the search for a line has to end. */
        tries++;
        if (!place_text(file, at, other, (int)sizeof other)) continue;
        snprintf(buffer, (size_t)size, "%s", other);
        return true;
    }
    return there;
}
