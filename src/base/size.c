/* size.c - how much memory there is to ask for.
 *
 * The answer is about the computer, so that no result may depend on it: only refusals do. */
#include "base/size.h"

#include <sys/resource.h>
#include <unistd.h>

size_t size_available(void)
{
    long page = sysconf(_SC_PAGESIZE), pages = sysconf(_SC_PHYS_PAGES);
    /* The computer's memory, or less where a limit is set (ulimit -v). Not what is free now, which
     * another program may take at any time. */
    size_t room = page > 0 && pages > 0 ? size_product((size_t)page, (size_t)pages) : SIZE_MAX;
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
        limit.rlim_cur < room)
        room = (size_t)limit.rlim_cur;
    return room;
}

/* Asked before work begins: a size that cannot be had is a mistake in the input. */
bool size_in_memory(size_t bytes, const char *file, int line, const char *what, struct err *e)
{
    size_t room = size_available();
    if (bytes <= room) return true;
    return err_set_at(e, ERR_CONFIG, file, line,
                      "%s would take %.3g GB of memory; this computer has %.3g GB", what,
                      (double)bytes / 1e9, (double)room / 1e9);
}
