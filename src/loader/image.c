/* image.c - the bytes of a program and its libraries in one piece of memory, as every rank gets
 * them. */
#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "loader/elf_dynamic.h"
#include "loader/template.h"

/* The beginning of the page, and of the next one unless x begins one. */
static uint64_t page_down(uint64_t x) { return x & ~(uint64_t)(LOADER_PAGE - 1); }
static uint64_t page_up(uint64_t x) { return page_down(x + LOADER_PAGE - 1); }

/* Where a file's pages come to lie behind `at`; returns where the next file may begin. Damaged
 * files may claim much memory, but not more bytes than they have plus the gaps that check_segment
 * allows. */
static uint64_t lay_out(struct loader_file *f, uint64_t at)
{
    const struct elf_file *elf = &f->elf;
    const Elf64_Phdr *last = &elf->segment[elf->nsegment - 1];
    f->begin = at;
    f->place = at - page_down(elf->segment[0].p_vaddr);
    f->memory_end = f->end = f->data = 0;
    for (const Elf64_Phdr *p = elf->segment; p <= last; p++) {
        uint64_t filled = f->place + p->p_vaddr + p->p_filesz;
        if ((p->p_flags & PF_W) && !f->data) f->data = page_down(f->place + p->p_vaddr);
        if (page_up(filled) > f->end) f->end = page_up(filled);
        f->memory_end = page_up(f->place + p->p_vaddr + p->p_memsz);
    }
    if (!f->data) f->data = f->end;
    return f->memory_end;
}

/* Thread-locals of all files come last, each with its alignment. */
static uint64_t lay_out_tls(struct loader_template *t, uint64_t at)
{
    for (int i = 0; i < t->nfile; i++) {
        const Elf64_Phdr *tls = &t->file[i].elf.tls;
        uint64_t align = tls->p_align > 16 ? tls->p_align : 16;
        if (tls->p_memsz == 0) continue;
        at = (at + align - 1) / align * align;
        t->file[i].tls = at;
        at += tls->p_memsz;
    }
    return at;
}

/* Memory without a name: copies map it, and it goes when the last of them goes. */
static bool take_memory(struct loader_template *t, struct err *e)
{
    t->memory = memfd_create("mimdsim-program", MFD_CLOEXEC);
    if (t->memory < 0 || ftruncate(t->memory, (off_t)t->stride) != 0)
        return err_set(e, ERR_INTERNAL, "no memory for the text of a program: %s", strerror(errno));
    t->bytes = mmap(NULL, t->size, PROT_READ | PROT_WRITE, MAP_SHARED, t->memory, 0);
    if (t->bytes == MAP_FAILED) {
        t->bytes = NULL;
        return err_set(e, ERR_INTERNAL, "no address space for a program of %llu MiB: %s",
                       (unsigned long long)t->size >> 20, strerror(errno));
    }
    return true;
}

/* The files lie one behind the other, data of one before text of the next, and thread-locals
 * behind all of them. The stride from rank to rank is whole pages. */
bool image_make(struct loader_template *t, struct err *e)
{
    uint64_t at = 0;
    /* The number of files is small and their order is that of search. */
    for (int i = 0; i < t->nfile; i++) at = lay_out(&t->file[i], at);
    /* Bytes that files fill; what only has a size (.bss) needs no place in the memory file. */
    t->size = 0;
    for (int i = 0; i < t->nfile; i++)
        if (t->file[i].end > t->size) t->size = t->file[i].end;
    t->stride = page_up(lay_out_tls(t, at));
    if (!take_memory(t, e)) return false;
    for (int i = 0; i < t->nfile; i++) {
        const struct loader_file *f = &t->file[i];
        for (int k = 0; k < f->elf.nsegment; k++) {
            const Elf64_Phdr *p = &f->elf.segment[k];
            memcpy(t->bytes + f->place + p->p_vaddr, f->elf.bytes + p->p_offset, p->p_filesz);
        }
    }
    return true;
}

/* Copies that are mapped stay; they hold the memory file by themselves. */
void image_give_back(struct loader_template *t)
{
    if (t->bytes) munmap(t->bytes, t->size);
    if (t->memory >= 0) close(t->memory);
    t->bytes = NULL;
    t->memory = -1;
}

/* Relocations may write data only; text is shared by all ranks. */
bool image_writable(const struct loader_file *f, uint64_t place, uint64_t size)
{
    return place >= f->data && place < f->end && size <= f->end - place;
}

/* Whether an address of the file is executed: callers and resolvers must be. */
bool image_code(const struct elf_file *f, uint64_t address)
{
    for (int i = 0; i < f->nsegment; i++) {
        const Elf64_Phdr *p = &f->segment[i];
        if ((p->p_flags & PF_X) && address >= p->p_vaddr && address - p->p_vaddr < p->p_filesz)
            return true;
    }
    return false;
}
