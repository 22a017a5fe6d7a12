/* symbols.c - what a name means: first in the program and its libraries, then in the host's libc
 * and libm.
 *
 * The order is that of the system's loader (gABI 5, "Shared Object Dependencies"), so that a
 * program may put a function of its own before a library's; but names that dlopen would make one
 * for the whole process (STB_GNU_UNIQUE: inline variables and static members of C++ templates) stay
 * private, as each rank looks among its own files only. */
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "base/check.h"
#include "base/memory.h"
#include "loader/template.h"

/* Names that mean a function of the host even where a file defines the rest of the name. */
static const char host_prefix[] = "mimdsim_libc_";

/* An entry of the hash table, open addressing; symbol NULL: free. */
struct symbol_slot {
    const struct loader_file *file;
    const Elf64_Sym *symbol;
};

/* FNV-1a, 32 bits: short names, well spread (Fowler, Noll, Vo). */
static uint32_t hash_name(const char *name)
{
    uint32_t h = 2166136261u;
    for (; *name; name++) h = (h ^ (unsigned char)*name) * 16777619u;
    return h;
}

/* The slot of the name, or the free one where it belongs; the table is at most half full. */
static struct symbol_slot *slot_of(const struct loader_template *t, const char *name)
{
    size_t i = hash_name(name) & (t->nslot - 1);
    while (t->symbol[i].symbol &&
           strcmp(elf_file_name(&t->symbol[i].file->elf, t->symbol[i].symbol->st_name), name) != 0)
        i = (i + 1) & (t->nslot - 1);
    return &t->symbol[i];
}

/* Whether other files may use it: defined, not local, not hidden, not an old version (bit 15: not
 * the default one). */
static bool is_offered(const struct elf_file *f, size_t i)
{
    const Elf64_Sym *s = &f->symbol[i];
    int binding = ELF64_ST_BIND(s->st_info), visibility = ELF64_ST_VISIBILITY(s->st_other);
    if (s->st_shndx == SHN_UNDEF || ELF64_ST_TYPE(s->st_info) > STT_TLS) {
        if (s->st_shndx == SHN_UNDEF || ELF64_ST_TYPE(s->st_info) != STT_GNU_IFUNC) return false;
    }
    if (binding != STB_GLOBAL && binding != STB_WEAK && binding != STB_GNU_UNIQUE) return false;
    if (visibility != STV_DEFAULT && visibility != STV_PROTECTED) return false;
    if (s->st_value >> 46) return false; /* damaged: no program is as large */
    return !f->version || !(f->version[i] & 0x8000);
}

/* dlopen's handle is kept to be closed with the template. */
static bool open_one(struct loader_template *t, const char *name, struct err *e)
{
    void *handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    if (!handle || t->nhost == LOADER_HOST_LIBRARIES) {
        if (handle) dlclose(handle);
        return err_set(e, ERR_INTERNAL, "the host's library %s cannot be opened: %s", name,
                       handle ? "too many of them" : dlerror());
    }
    t->host[t->nhost++] = handle;
    return true;
}

/* The process's own libraries: libc and libm always, since any program may use them without saying
 * so; the others as they are needed (libmvec: mathematics by vectors). Since glibc 2.34 some are
 * empty, which does no harm. */
static bool open_host(struct loader_template *t, struct err *e)
{
    if (!open_one(t, "libc.so.6", e) || !open_one(t, "libm.so.6", e)) return false;
    for (int i = 0; i < t->nfile; i++) {
        const struct elf_file *f = &t->file[i].elf;
        for (int k = 0; k < f->nneeded; k++) {
            if (strcmp(f->needed[k], "libmvec.so.1") != 0) continue;
            if (!open_one(t, f->needed[k], e)) return false;
        }
    }
    return true;
}

/* One table of everything that the program and its libraries offer, in the order of search. */
bool symbols_make(struct loader_template *t, struct err *e)
{
    if (!open_host(t, e)) return false;
    size_t n = 0;
    for (int i = 0; i < t->nfile; i++) n += t->file[i].elf.nsymbol;
    for (t->nslot = 64; t->nslot < 2 * n;) t->nslot *= 2;
    t->symbol = memory_zeroed(t->nslot, sizeof *t->symbol);
    for (int i = 0; i < t->nfile; i++) {
        const struct loader_file *f = &t->file[i];
        for (size_t k = 1; k < f->elf.nsymbol; k++) {
            if (!is_offered(&f->elf, k)) continue;
            struct symbol_slot *s = slot_of(t, elf_file_name(&f->elf, f->elf.symbol[k].st_name));
            if (!s->symbol)
                *s = (struct symbol_slot){f, &f->elf.symbol[k]}; /* the first file wins */
        }
    }
    return true;
}

/* The handles keep the host's libraries in memory; the table borrows its names from the files. */
void symbols_give_back(struct loader_template *t)
{
    free(t->symbol);
    t->symbol = NULL;
    while (t->nhost > 0) dlclose(t->host[--t->nhost]);
}

/* Among the program and its libraries only. */
struct found symbols_defined(const struct loader_template *t, const char *name)
{
    const struct symbol_slot *s = slot_of(t, name);
    return (struct found){.file = s->symbol ? s->file : NULL, .symbol = s->symbol};
}

/* Thread-locals by the general and the local dynamic model: the "module" is the rank's own block of
 * memory, which the loader has put there in place of a number. So this function needs to know
 * nothing of ranks. */
static void *tls_get_address(const uint64_t index[2])
{
    return (char *)(uintptr_t)index[0] + index[1];
}

/* Memory comes from where the whole process has it, which need not be libc: a preloaded allocator,
 * a sanitizer. */
static bool is_allocator(const char *name)
{
    static const char *const allocator[] = {
        "malloc",         "calloc",        "realloc",  "free",   "reallocarray",
        "posix_memalign", "aligned_alloc", "memalign", "valloc", "malloc_usable_size"};
    for (size_t i = 0; i < sizeof allocator / sizeof *allocator; i++)
        if (strcmp(name, allocator[i]) == 0) return true;
    return false;
}

/* The version that the file was linked against comes first, as the system's loader does it:
 * memcpy has two on x86-64. */
static void *host_symbol(const struct loader_template *t, const char *name, const char *version)
{
    void *at = NULL;
    if (strcmp(name, "__tls_get_addr") == 0) return (void *)tls_get_address;
    if (strncmp(name, host_prefix, sizeof host_prefix - 1) == 0) {
        name += sizeof host_prefix - 1;
        version = NULL;
    }
    if (is_allocator(name)) return dlsym(RTLD_DEFAULT, name);
    for (int i = 0; i < t->nhost && !at && version; i++) at = dlvsym(t->host[i], name, version);
    for (int i = 0; i < t->nhost && !at; i++) at = dlsym(t->host[i], name);
    return at;
}

/* Local and protected symbols mean the file's own; others the first in the order of search; last
 * the host's. A weak symbol that nobody defines is address 0. */
bool symbols_find(const struct loader_template *t, const struct loader_file *f, size_t i,
                  struct found *out)
{
    const Elf64_Sym *s = &f->elf.symbol[i];
    *out = (struct found){0};
    const bool defined = s->st_shndx != SHN_UNDEF;
    if (i == 0) return true; /* no symbol: address 0 */
    if (defined && (ELF64_ST_BIND(s->st_info) == STB_LOCAL ||
                    ELF64_ST_VISIBILITY(s->st_other) != STV_DEFAULT || f->elf.symbolic)) {
        *out = (struct found){.file = f, .symbol = s};
        return true;
    }
    const char *name = elf_file_name(&f->elf, s->st_name);
    *out = symbols_defined(t, name);
    if (out->file) return true;
    if (defined) {
        *out = (struct found){.file = f, .symbol = s};
        return true;
    }
    out->address = host_symbol(t, name, elf_file_version(&f->elf, i));
    return out->address || ELF64_ST_BIND(s->st_info) == STB_WEAK;
}
