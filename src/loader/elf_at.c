/* elf_at.c - finding bytes of a shared object by address and by section, and complaining about it
 * (elf_file.h). */
#include <string.h>

#include "loader/elf_dynamic.h"

/* All complaints about the content of a file begin alike and name it. */
bool elf_bad(const struct elf_file *f, struct err *e, const char *what)
{
    return err_set_at(e, ERR_DATA, f->path, 0, "not a usable program: %s", what);
}

/* The bytes in the file that are loaded at an address; NULL unless one segment has them all,
 * aligned as the caller reads them. */
const void *elf_file_at(const struct elf_file *f, uint64_t address, uint64_t size, size_t align)
{
    for (int i = 0; i < f->nsegment; i++) {
        const Elf64_Phdr *p = &f->segment[i];
        if (address < p->p_vaddr || size > p->p_filesz || address - p->p_vaddr > p->p_filesz - size)
            continue;
        const char *at = f->bytes + p->p_offset + (address - p->p_vaddr);
        return (uintptr_t)at % align == 0 ? at : NULL;
    }
    return NULL;
}

/* Section headers are for linkers and debuggers; a program without them runs as well, so damage
 * only hides them. */
bool elf_file_section(const struct elf_file *f, const char *name, uint64_t *address, uint64_t *size)
{
    const Elf64_Ehdr *h = (const Elf64_Ehdr *)f->bytes;
    if (h->e_shentsize != sizeof(Elf64_Shdr) || h->e_shoff % 8 != 0 || h->e_shoff > f->size ||
        h->e_shnum > (f->size - h->e_shoff) / sizeof(Elf64_Shdr) || h->e_shstrndx >= h->e_shnum)
        return false;
    const Elf64_Shdr *s = (const Elf64_Shdr *)(f->bytes + h->e_shoff), *names = &s[h->e_shstrndx];
    if (names->sh_offset > f->size || names->sh_size > f->size - names->sh_offset) return false;

    const size_t length = strlen(name) + 1;
    for (int i = 0; i < h->e_shnum; i++) {
        if (s[i].sh_name > names->sh_size || names->sh_size - s[i].sh_name < length) continue;
        if (memcmp(f->bytes + names->sh_offset + s[i].sh_name, name, length) != 0) continue;
        if (!(s[i].sh_flags & SHF_ALLOC) || !elf_file_at(f, s[i].sh_addr, s[i].sh_size, 1))
            return false;
        *address = s[i].sh_addr;
        *size = s[i].sh_size;
        return true;
    }
    return false;
}
