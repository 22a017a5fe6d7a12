/* elf_file.c - reading a shared object: header, segments; what the dynamic section names is in
 * elf_dynamic.c. */
#include "loader/elf_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/size.h"
#include "base/text.h"
#include "loader/elf_dynamic.h"

/* Gaps between segments are at most this much; more is a damaged address. */
static const uint64_t MOST_GAP = UINT64_C(64) << 20;

/* No program has more memory than half of an address space of 47 bits. */
static const uint64_t MOST_SPAN = UINT64_C(1) << 46;

/* The whole file in memory of our own: a mapping would fault when somebody shortens the file
 * meanwhile. */
static bool read_bytes(struct elf_file *f, struct err *e)
{
    struct stat s;
    FILE *in = text_open_file(f->path, e);
    if (!in) return false;
    bool ok =
        fstat(fileno(in), &s) == 0 && size_in_memory((size_t)s.st_size, f->path, 0, "the file", e);
    if (ok) {
        f->size = (size_t)s.st_size;
        f->bytes = memory_take(f->size + 1, 1);
        /* Shorter than told, and longer, are both changes while it is read. */
        ok = fread(f->bytes, 1, f->size + 1, in) == f->size;
        if (!ok) err_set_at(e, ERR_IO, f->path, 0, "cannot be read, or changes while it is read");
    }
    fclose(in);
    return ok;
}

/* "ELF for x86-64, not for AArch64": the machines that people compile for. */
static const char *machine_name(int machine)
{
    switch (machine) {
    case EM_386:
        return "i386";
    case EM_AARCH64:
        return "AArch64";
    case EM_ARM:
        return "ARM";
    case EM_PPC64:
        return "PowerPC";
    case EM_RISCV:
        return "RISC-V";
    case EM_S390:
        return "S/390";
    default:
        return "another processor";
    }
}

/* What is said of a file that is no program of ours names the next step: most are ordinary
 * executables or objects for another processor. */
static bool check_header(struct elf_file *f, struct err *e)
{
    const Elf64_Ehdr *h = (const Elf64_Ehdr *)f->bytes;
    if (f->size < sizeof *h || memcmp(h->e_ident, ELFMAG, SELFMAG) != 0)
        return elf_bad(f, e, "no ELF file (expected a program made by `mimdsim cc`)");
    if (h->e_ident[EI_CLASS] != ELFCLASS64 || h->e_ident[EI_DATA] != ELFDATA2LSB ||
        h->e_machine != EM_X86_64)
        return err_set_at(
            e, ERR_DATA, f->path, 0, "made for %s%s; programs must be made for x86-64",
            machine_name(h->e_machine), h->e_ident[EI_CLASS] == ELFCLASS64 ? "" : " (32 bits)");
    if (h->e_type == ET_EXEC || h->e_type == ET_REL)
        return elf_bad(f, e,
                       h->e_type == ET_REL ? "an object file; link it with `mimdsim cc`"
                                           : "an ordinary executable; link it with `mimdsim cc`");
    if (h->e_type != ET_DYN) return elf_bad(f, e, "neither program nor library");
    if (h->e_phentsize != sizeof(Elf64_Phdr) || h->e_phoff % 8 != 0 || h->e_phoff > f->size ||
        h->e_phnum > (f->size - h->e_phoff) / sizeof(Elf64_Phdr))
        return elf_bad(f, e, "its program headers lie outside the file");
    f->header = (const Elf64_Phdr *)(f->bytes + h->e_phoff);
    f->nheader = h->e_phnum;
    return true;
}

/* One loaded segment: within the file, above the one before, bytes at the place in their page that
 * they have in it. */
static bool check_segment(const struct elf_file *f, const Elf64_Phdr *p, struct err *e)
{
    if (p->p_filesz > f->size || p->p_offset > f->size - p->p_filesz)
        return elf_bad(f, e, "a segment lies outside the file (is it cut short?)");
    if (p->p_memsz < p->p_filesz)
        return elf_bad(f, e, "a segment is larger in the file than in memory");
    if (p->p_vaddr > MOST_SPAN || p->p_memsz > MOST_SPAN)
        return elf_bad(f, e, "a segment's address is out of range");
    if (p->p_vaddr % 4096 != p->p_offset % 4096)
        return elf_bad(f, e, "a segment is not aligned to pages");
    if (p->p_align > 4096 && p->p_align % 4096 != 0)
        return elf_bad(f, e, "a segment's alignment is no whole page");
    if (f->nsegment == 0) {
        if (p->p_vaddr > MOST_GAP)
            return elf_bad(f, e, "its first segment does not begin near address 0");
        return true;
    }
    const Elf64_Phdr *last = &f->segment[f->nsegment - 1];
    uint64_t end = last->p_vaddr + last->p_memsz;
    if (p->p_vaddr / 4096 * 4096 < (last->p_vaddr + last->p_memsz + 4095) / 4096 * 4096 &&
        (last->p_flags != p->p_flags || p->p_vaddr < end))
        return elf_bad(f, e, "two segments share a page");
    if (p->p_vaddr - end > MOST_GAP) return elf_bad(f, e, "a segment's address is out of range");
    /* Text comes first: it is what ranks share. From the first page of data on all is private. */
    for (int i = 0; i < f->nsegment; i++)
        if ((f->segment[i].p_flags & PF_W) && (p->p_flags & PF_X))
            return elf_bad(f, e, "program text behind data; link with GNU ld or LLVM lld");
    return true;
}

/* What a program header asks for. Those of unknown types may be passed over (gABI 5, "Program
 * Header"). */
static bool take_header(struct elf_file *f, const Elf64_Phdr *p, const Elf64_Phdr **dynamic,
                        struct err *e)
{
    switch (p->p_type) {
    case PT_LOAD:
        if (p->p_memsz == 0) return true;
        if (f->nsegment == ELF_SEGMENTS) return elf_bad(f, e, "too many segments");
        if (!check_segment(f, p, e)) return false;
        if ((p->p_flags & PF_W) && (p->p_flags & PF_X))
            return elf_bad(f, e, "a segment is writable and executable");
        f->segment[f->nsegment++] = *p;
        return true;
    case PT_DYNAMIC:
        *dynamic = p;
        return true;
    case PT_TLS:
        f->tls = *p;
        return true;
    case PT_GNU_RELRO:
        f->relro = *p;
        return true;
    default:
        return true;
    }
}

/* Thread-locals: their first values lie in a segment, their alignment is a power of two up to a
 * page. */
static bool check_tls(const struct elf_file *f, struct err *e)
{
    const Elf64_Phdr *t = &f->tls;
    if (t->p_memsz == 0) return true;
    uint64_t align = t->p_align ? t->p_align : 1;
    if (align > 4096 || (align & (align - 1)) != 0 || t->p_memsz > MOST_GAP ||
        t->p_filesz > t->p_memsz)
        return elf_bad(f, e, "the segment of thread-locals is out of range");
    if (t->p_filesz && !elf_file_at(f, t->p_vaddr, t->p_filesz, 1))
        return elf_bad(f, e, "the first values of thread-locals lie outside the file");
    return true;
}

/* The dynamic section last, as it is found by addresses in the segments. */
static bool check_segments(struct elf_file *f, struct err *e)
{
    const Elf64_Phdr *dynamic = NULL;
    for (int i = 0; i < f->nheader; i++)
        if (!take_header(f, &f->header[i], &dynamic, e)) return false;
    if (f->nsegment == 0) return elf_bad(f, e, "nothing in it is to be loaded");
    if (!dynamic) return elf_bad(f, e, "it is linked statically; link it with `mimdsim cc`");
    return check_tls(f, e) && elf_dynamic_read(f, dynamic, e);
}

/* The whole file is in memory afterwards, and closed: it may be replaced by the next compilation
 * while the run goes on. */
bool elf_file_read(struct elf_file *f, const char *path, struct err *e)
{
    *f = (struct elf_file){.path = memory_text(path)};
    if (read_bytes(f, e) && check_header(f, e) && check_segments(f, e)) return true;
    elf_file_free(f);
    return false;
}

/* What other structs point to in the file goes with it. */
void elf_file_free(struct elf_file *f)
{
    free(f->bytes);
    free(f->path);
    *f = (struct elf_file){0};
}
