/* unwind.c - what the unwinder of C++ exceptions asks of the system's loader, answered for the
 * files of the rank.
 *
 * The program's copies are unknown to the system's loader. libgcc finds the tables of a function by
 * _dl_find_object (glibc 2.35 and later) or by dl_iterate_phdr; both look at the rank's files
 * first, then at the host's. */
#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <string.h>

#include "guest.h"

LIBC(dl_iterate_phdr);

int dl_iterate_phdr(int (*f)(struct dl_phdr_info *, size_t, void *), void *data);
WEAK int dl_iterate_phdr(int (*f)(struct dl_phdr_info *, size_t, void *), void *data)
{
    const void *headers;
    uintptr_t base;
    int count;
    for (int i = 0; mimdsim_host->runtime->module(mimdsim_host, i, &base, &headers, &count); i++) {
        /* The files never change: libgcc may keep what it found (dlpi_adds, dlpi_subs). */
        struct dl_phdr_info info = {.dlpi_addr = base,
                                    .dlpi_name = "",
                                    .dlpi_phdr = headers,
                                    .dlpi_phnum = (ElfW(Half))count,
                                    .dlpi_adds = 1};
        int result = f(&info, sizeof info, data);
        if (result) return result;
    }
    return mimdsim_libc_dl_iterate_phdr(f, data);
}

#ifdef DLFO_STRUCT_HAS_EH_DBASE
LIBC(_dl_find_object);

/* find_in: whether `at` lies in a file of these program headers; its bounds and unwind tables. */
static int find_in(uintptr_t base, const ElfW(Phdr) * p, int n, uintptr_t at,
                   struct dl_find_object *out)
{
    int inside = 0;
    uintptr_t end = base;
    out->dlfo_eh_frame = NULL;
    for (int i = 0; i < n; i++) {
        const uintptr_t begin = base + p[i].p_vaddr;
        if (p[i].p_type == PT_LOAD && at >= begin && at - begin < p[i].p_memsz) inside = 1;
        if (p[i].p_type == PT_LOAD) end = begin + p[i].p_memsz;
        if (p[i].p_type == PT_GNU_EH_FRAME) out->dlfo_eh_frame = (void *)begin;
    }
    out->dlfo_flags = 0;
    out->dlfo_map_start = (void *)base;
    out->dlfo_map_end = (void *)end;
    out->dlfo_link_map = NULL;
    return inside && out->dlfo_eh_frame;
}

WEAK int _dl_find_object(void *at, struct dl_find_object *out)
{
    const void *headers;
    uintptr_t base;
    int count;
    for (int i = 0; mimdsim_host->runtime->module(mimdsim_host, i, &base, &headers, &count); i++)
        if (find_in(base, headers, count, (uintptr_t)at, out)) return 0;
    return mimdsim_libc__dl_find_object(at, out);
}
#endif
