/* guard.c - see guard.h.
 *
 * Since Linux 6.13 a page table can hold marks for pages that must not be touched (madvise(2),
 * MADV_GUARD_INSTALL): a thousand of them are set by one call and split no mapping. Before that
 * each guard is a mapping of its own: mprotect took 4 us a stack, a tenth of a run on 1024
 * ranks. */
#include "sim/guard.h"

#include <stdio.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#ifndef MADV_GUARD_INSTALL
#define MADV_GUARD_INSTALL 102
#endif

/* The limit on mappings per process; 65530 is the default of Linux. */
static int mapping_limit(void)
{
    int limit = 65530;
    FILE *f = fopen("/proc/sys/vm/max_map_count", "r");
    if (!f) return limit;
    if (fscanf(f, "%d", &limit) != 1) limit = 65530;
    fclose(f);
    return limit;
}

/* How many were set: all, or none where the system cannot. A batch that ends early is finished by
 * the next. */
static int set_marks(char *base, size_t stride, size_t page, int n)
{
    enum { BATCH = 1024 }; /* IOV_MAX of Linux */
    struct iovec piece[BATCH];
    int done = 0;
#if defined SYS_process_madvise && defined SYS_pidfd_open
    const int self = (int)syscall(SYS_pidfd_open, getpid(), 0);
    if (self < 0) return 0;
    while (done < n) {
        const int count = n - done < BATCH ? n - done : BATCH;
        for (int i = 0; i < count; i++)
            piece[i] = (struct iovec){base + stride * (size_t)(done + i), page};
        const long bytes =
            syscall(SYS_process_madvise, self, piece, (long)count, MADV_GUARD_INSTALL, 0);
        if (bytes < (long)page) break;
        done += (int)((size_t)bytes / page);
    }
    close(self);
#endif
    return done;
}

/* Each guard splits the mapping in two more; half of the system's limit is left to everybody else.
 * A failed mprotect is no error: whoever has no guard is looked at afterwards. */
static int protect(char *base, size_t stride, size_t page, int n)
{
    const int most = mapping_limit() / 4;
    int done = 0;
    while (done < n && done < most &&
           mprotect(base + stride * (size_t)done, page, PROT_NONE) == 0)
        done++;
    return done;
}

int guard_pages(char *base, size_t stride, size_t page, int n)
{
    const int marked = set_marks(base, stride, page, n);
    if (marked == n) return n;
    return marked + protect(base + stride * (size_t)marked, stride, page, n - marked);
}
