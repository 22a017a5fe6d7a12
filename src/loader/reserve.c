/* reserve.c - copies of a program for its ranks: how they share what they do not write, and making
 * one.
 *
 * Linux limits the number of mappings of a process (vm.max_map_count). Few ranks get their text
 * mapped each on its own, with the protection of an ordinary program. More get one mapping of
 * everything, private: pages that a rank writes become its own, the others stay shared. Still more
 * share a mapping: the memory file then holds as many copies of the program as ranks are mapped
 * together, and every group of ranks maps that same file. Results do not depend on it. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/check.h"
#include "base/memory.h"
#include "base/size.h"
#include "loader/template.h"

/* Pages of copies up to this size are single ones: a large page would commit 2 MiB for the first
 * byte written. */
static const uint64_t SMALL_STRIDE = UINT64_C(8) << 20;

/* 65530 is the kernel's default (Documentation/admin-guide/sysctl/vm.rst). */
static int64_t most_maps(void)
{
    long limit = 65530;
    FILE *f = fopen("/proc/sys/vm/max_map_count", "r");
    if (!f) return limit;
    if (fscanf(f, "%ld", &limit) != 1) limit = 65530;
    fclose(f);
    return limit;
}

/* The best way of sharing within a quarter of the system's limit: the stacks' guard pages take a
 * half. Each file of the program takes a mapping for text, one for data, and one between them for
 * constants that are write-protected. */
static void choose_sharing(struct loader_template *t, int nrank)
{
    const int64_t most = most_maps() / 4, apart = (int64_t)nrank * t->nfile;
    t->relro = 3 * apart <= most;
    t->group = 0;
    if (2 * apart > most) t->group = (int)(nrank / most) + 1;
}

/* The memory file gets `group` copies of the program, a rank's length apart. */
static bool repeat_bytes(const struct loader_template *t, struct err *e)
{
    if (t->group < 2) return true;
    bool ok = ftruncate(t->memory, (off_t)(t->stride * (uint64_t)t->group)) == 0;
    for (int k = 1; ok && k < t->group; k++)
        ok = pwrite(t->memory, t->bytes, t->size, (off_t)(t->stride * (uint64_t)k)) ==
             (ssize_t)t->size;
    if (!ok)
        return err_set(e, ERR_INTERNAL, "no memory for the text of a program: %s", strerror(errno));
    return true;
}

/* All groups of ranks, each the same file; the last one may have fewer. */
static bool map_groups(const struct loader_template *t, struct err *e)
{
    for (int rank = 0; t->group && rank < t->nrank; rank += t->group) {
        const int n = t->nrank - rank < t->group ? t->nrank - rank : t->group;
        if (mmap(t->memory_of_ranks + t->stride * (uint64_t)rank, t->stride * (uint64_t)n,
                 PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_FIXED | MAP_NORESERVE,
                 t->memory, 0) == MAP_FAILED)
            return err_set_at(e, ERR_INTERNAL, t->file[0].elf.path, 0,
                              "no mapping for rank %d of %d: %s", rank, t->nrank, strerror(errno));
    }
    return true;
}

/* Address space for all ranks at once, so that an address tells its rank by a division. Nothing
 * is committed before it is written. */
bool loader_reserve(struct loader_template *t, int nrank, const struct loader_hooks *hooks,
                    struct err *e)
{
    CHECK(!t->memory_of_ranks && nrank > 0);
    choose_sharing(t, nrank);
    if (!repeat_bytes(t, e)) return false;
    const uint64_t bytes = size_product(t->stride, (size_t)nrank);
    char *p = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE,
                   -1, 0);
    if (p == MAP_FAILED)
        return err_set_at(e, ERR_INTERNAL, t->file[0].elf.path, 0,
                          "no address space for %d ranks with %llu KiB of data each: %s", nrank,
                          (unsigned long long)t->stride >> 10, strerror(errno));
    if (t->stride < SMALL_STRIDE) madvise(p, bytes, MADV_NOHUGEPAGE);
    t->memory_of_ranks = p;
    t->nrank = nrank;
    t->hooks = hooks;
    runtime_fill(&t->runtime);
    t->instance = memory_aligned(64, (size_t)nrank, sizeof *t->instance);
    memset(t->instance, 0, (size_t)nrank * sizeof *t->instance);
    return map_groups(t, e);
}

/* The bytes of the template where the rank finds them, when it has mappings of its own; false: the
 * system refuses a mapping. */
static bool take_bytes(const struct loader_template *t, char *base)
{
    if (t->group) return true; /* mapped with its neighbours */
    for (int i = 0; i < t->nfile; i++) {
        const struct loader_file *f = &t->file[i];
        if (f->data > f->begin &&
            mmap(base + f->begin, f->data - f->begin, PROT_READ | PROT_EXEC,
                 MAP_PRIVATE | MAP_FIXED, t->memory, (off_t)f->begin) == MAP_FAILED)
            return false;
        memcpy(base + f->data, t->bytes + f->data, f->end - f->data);
    }
    return true;
}

/* A rank's copy: bytes, addresses, thread-locals, and the pointer by which it finds its host. */
struct loader_instance *loader_instantiate(struct loader_template *t, int rank, void *context,
                                           struct err *e)
{
    CHECK(t->memory_of_ranks && rank >= 0 && rank < t->nrank && !t->instance[rank].base);
    char *base = t->memory_of_ranks + t->stride * (uint64_t)rank;
    struct loader_instance *i = &t->instance[rank];
    if (!take_bytes(t, base)) {
        err_set_at(e, ERR_INTERNAL, t->file[0].elf.path, 0, "no mapping for rank %d of %d: %s",
                   rank, t->nrank, strerror(errno));
        return NULL;
    }
    /* The template is relocated for address 0; what holds an address of the program moves by the
     * copy's own. */
    for (size_t n = 0; n < t->nrelative; n++) {
        uint64_t value;
        memcpy(&value, base + t->relative[n], sizeof value);
        value += (uint64_t)(uintptr_t)base;
        memcpy(base + t->relative[n], &value, sizeof value);
    }
    /* First values of thread-locals, from data that are relocated by now. */
    for (int n = 0; n < t->nfile; n++) {
        const struct loader_file *f = &t->file[n];
        if (f->elf.tls.p_memsz)
            memcpy(base + f->tls, base + f->place + f->elf.tls.p_vaddr, f->elf.tls.p_filesz);
    }
    *i = (struct loader_instance){.t = t, .base = base, .context = context};
    i->host = (struct mimdsim_host){.magic = MIMDSIM_HOST_MAGIC,
                                    .version = MIMDSIM_HOST_VERSION,
                                    .size = sizeof i->host,
                                    .rank = rank,
                                    .nrank = t->nrank,
                                    .runtime = &t->runtime,
                                    .instance = i,
                                    .context = context,
                                    .directory = t->directory};
    struct mimdsim_host **pointer = loader_symbol(i, "mimdsim_host");
    *pointer = &i->host;
    i->pending = loader_symbol(i, "mimdsim_pending");
    i->data = (const char *)pointer;
    return i;
}

/* Text is shared by all ranks, the rest is each rank's own. */
int64_t loader_bytes(const struct loader_template *t)
{
    int64_t bytes = (int64_t)t->stride;
    for (int i = 0; i < t->nfile; i++) bytes -= (int64_t)(t->file[i].data - t->file[i].begin);
    return bytes;
}
