/* loader.c - programs from file to template, and what can be asked of a template or of a rank's
 * copy. */
#include "loader/loader.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/check.h"
#include "base/memory.h"
#include "loader/elf_dynamic.h"
#include "loader/template.h"

/* A program made by `mimdsim cc` has a writable pointer by this name (guest/host.c); others cannot
 * be run. */
static bool check_made_by_us(struct loader_template *t, struct err *e)
{
    const struct found s = symbols_defined(t, "mimdsim_host");
    if (s.file != &t->file[0] || s.symbol->st_value % 8 != 0 ||
        s.file->place + s.symbol->st_value + 8 > s.file->memory_end ||
        s.file->place + s.symbol->st_value < s.file->data)
        return elf_bad(&t->file[0].elf, e, "it was not made by `mimdsim cc` (or c++, f90)");
    return true;
}

/* The working directory is kept, as programs may write below it only. Each step checks what the
 * next one relies on. */
struct loader_template *loader_open(const char *path, struct err *e)
{
#ifndef __x86_64__
    err_set_at(e, ERR_UNAVAILABLE, path, 0,
               "programs of users run on x86-64 hosts only; built-in programs run on this one");
    return NULL;
#endif
    struct loader_template *t = memory_zeroed(1, sizeof *t);
    t->memory = -1;
    if (!getcwd(t->directory, sizeof t->directory)) t->directory[0] = '\0';
    if (files_read(t, path, e) && symbols_make(t, e) && image_make(t, e) &&
        check_made_by_us(t, e) && relocate_all(t, e))
        return t;
    loader_close(t);
    return NULL;
}

/* In the reverse order; each part may be missing, after an error. */
void loader_close(struct loader_template *t)
{
    if (!t) return;
    if (t->memory_of_ranks) munmap(t->memory_of_ranks, t->stride * (uint64_t)t->nrank);
    image_give_back(t);
    symbols_give_back(t);
    for (int i = 0; i < t->nfile; i++) elf_file_free(&t->file[i].elf);
    free(t->relative);
    free(t->indirect);
    free(t->instance);
    free(t);
}

/* Bytes in the template from an address of file f on, if all of them are there. */
static void *bytes_at(const struct loader_template *t, const struct loader_file *f,
                      uint64_t address, uint64_t size)
{
    if (!elf_file_at(&f->elf, address, size, 1)) return NULL;
    return t->bytes + f->place + address;
}

/* An address as it stands in the program's own file, the first one. */
void *loader_template_at(const struct loader_template *t, uint64_t address, size_t size)
{
    return bytes_at(t, &t->file[0], address, size);
}

/* The reverse of loader_template_at. */
uint64_t loader_template_address(const struct loader_template *t, const void *at)
{
    return (uint64_t)((const char *)at - t->bytes) - t->file[0].place;
}

/* Of the program alone: a library may have a symbol of the same name. */
void *loader_template_symbol(const struct loader_template *t, const char *name, size_t *size)
{
    const struct found s = symbols_defined(t, name);
    if (s.file != &t->file[0]) return NULL;
    if (size) *size = s.symbol->st_size;
    return bytes_at(t, s.file, s.symbol->st_value, s.symbol->st_size);
}

/* Of the program alone, as loader_template_symbol. */
void *loader_template_section(const struct loader_template *t, const char *name, size_t *size)
{
    uint64_t address, bytes;
    if (!elf_file_section(&t->file[0].elf, name, &address, &bytes)) return NULL;
    *size = bytes;
    return bytes_at(t, &t->file[0], address, bytes);
}

struct mimdsim_host *loader_host(struct loader_instance *i) { return &i->host; }

/* In a rank's copy, so libraries count, too: the order is that of the system's loader. */
void *loader_symbol(const struct loader_instance *i, const char *name)
{
    const struct found s = symbols_defined(i->t, name);
    return s.file ? i->base + s.file->place + s.symbol->st_value : NULL;
}

/* The lines that a rank touches first when it is switched in: its text, its data, the host's
 * table. */
void loader_prefetch(const struct loader_instance *i)
{
    __builtin_prefetch(i->text);
    __builtin_prefetch(i->data);
    __builtin_prefetch(&i->host);
}
