/* reserve.c - copies of a program for its ranks: how they share what they do not write, and making
 * one.
 *
 * Linux limits the number of mappings of a process (vm.max_map_count). Few ranks get their text
 * mapped each on its own, with the protection of an ordinary program. More get one mapping of
 * everything, and where even that is too much all bytes are copied into one mapping. Results do not
 * depend on which it is. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/check.h"
#include "base/size.h"
#include "loader/template.h"

/* Pages of copies up to this size are single ones: a large page would commit 2 MiB for the first
 * byte written. */
static const uint64_t SMALL_STRIDE = UINT64_C(8) << 20;

static int64_t most_maps(void)
{
    long limit = 65530;
    FILE *f = fopen("/proc/sys/vm/max_map_count", "r");
    if (!f) return limit;
    if (fscanf(f, "%ld", &limit) != 1) limit = 65530;
    fclose(f);
    return limit;
}

int64_t copies_wanted_maps(const struct loader_template *t, int nrank, enum loader_sharing sharing,
                           bool relro)
{
    switch (sharing) {
    case SHARE_TEXT:
        return (int64_t)nrank * t->nfile * (relro ? 3 : 2); /* text, (constants,) data */
    case SHARE_ALL:
        return nrank;
    case SHARE_NOTHING:
        break;
    }
    return 1;
}

/* The best way of sharing within a quarter of the system's limit: the stacks' guard pages take a
 * half. */
static bool choose_sharing(struct loader_template *t, int nrank, struct err *e)
{
    const int64_t most = most_maps() / 4;
    const uint64_t memory = (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    t->relro = copies_wanted_maps(t, nrank, SHARE_TEXT, true) <= most;
    t->sharing = SHARE_TEXT;
    if (copies_wanted_maps(t, nrank, SHARE_TEXT, t->relro) <= most) return true;
    t->sharing = SHARE_ALL;
    if (copies_wanted_maps(t, nrank, SHARE_ALL, false) <= most) return true;
    t->sharing = SHARE_NOTHING;
    if (t->size <= memory / 4 * 3 / (uint64_t)nrank) return true;
    return err_set_at(e, ERR_CONFIG, t->file[0].elf.path, 0,
                      "%d copies of %llu KiB do not fit into the memory of this host; with `sysctl "
                      "vm.max_map_count=%lld` "
                      "they share their text",
                      nrank, (unsigned long long)t->size >> 10, (long long)nrank * 4 + 1024);
}

bool loader_reserve(struct loader_template *t, int nrank, const struct loader_hooks *hooks,
                    struct err *e)
{
    CHECK(!t->memory_of_ranks && nrank > 0);
    if (!choose_sharing(t, nrank, e)) return false;
    const uint64_t bytes = size_product(t->stride, (size_t)nrank);
    const int protection = PROT_READ | PROT_WRITE | (t->sharing == SHARE_NOTHING ? PROT_EXEC : 0);
    char *p = mmap(NULL, bytes, protection, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (p == MAP_FAILED)
        return err_set_at(e, ERR_INTERNAL, t->file[0].elf.path, 0,
                          "no address space for %d ranks with %llu KiB of data each: %s", nrank,
                          (unsigned long long)t->stride >> 10, strerror(errno));
    if (t->stride < SMALL_STRIDE) madvise(p, bytes, MADV_NOHUGEPAGE);
    t->memory_of_ranks = p;
    t->nrank = nrank;
    t->hooks = hooks;
    runtime_fill(&t->runtime);
    t->instance = calloc((size_t)nrank, sizeof *t->instance);
    if (!t->instance) check_memory((size_t)nrank * sizeof *t->instance);
    return true;
}

/* The bytes of the template where the rank finds them; false: the system refuses a mapping. */
static bool take_bytes(const struct loader_template *t, char *base)
{
    if (t->sharing == SHARE_NOTHING) {
        memcpy(base, t->bytes, t->size);
        return true;
    }
    if (t->sharing == SHARE_ALL)
        return mmap(base, t->stride, PROT_READ | PROT_WRITE | PROT_EXEC,
                    MAP_PRIVATE | MAP_FIXED | MAP_NORESERVE, t->memory, 0) != MAP_FAILED;
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
    return i;
}

int64_t loader_bytes(const struct loader_template *t)
{
    int64_t bytes = (int64_t)t->stride;
    if (t->sharing == SHARE_TEXT)
        for (int i = 0; i < t->nfile; i++) bytes -= (int64_t)(t->file[i].data - t->file[i].begin);
    return bytes;
}
