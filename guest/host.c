/* host.c - the pointer to the simulator, and the ways to give up. */
#include <link.h>
#include <stdarg.h>
#include <stdio.h>

#include "guest.h"

/* Set by the loader in each rank's copy before any code runs. Its presence is also what shows that
 * a file was made by `mimdsim cc`. */
struct mimdsim_host *mimdsim_host;

/* Counted by functions that keep register r15 for their callers (`mimdsim cc`), not yet handed over
 * [ps]. */
int64_t mimdsim_pending;

/* The program's own file, from its program headers; found at the first use. */
static uintptr_t own_begin, own_end;

static void find_own(void)
{
    const void *headers;
    int count;
    if (!mimdsim_host->runtime->module(mimdsim_host, 0, &own_begin, &headers, &count)) return;
    const ElfW(Phdr) *p = headers;
    for (int i = 0; i < count; i++)
        if (p[i].p_type == PT_LOAD) own_end = own_begin + p[i].p_vaddr + p[i].p_memsz;
}

void guest_account(const void *place)
{
    const uintptr_t at = (uintptr_t)place;
    if (own_end == 0) find_own();
    if (at >= own_begin && at < own_end) mimdsim_account();
}

_Noreturn void guest_fail(const void *place, const char *format, ...)
{
    char text[768];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    guest_flush();
    mimdsim_host->runtime->fail(mimdsim_host, place, text);
    __builtin_unreachable();
}

_Noreturn void guest_refuse(const void *place, const char *name, const char *why)
{
    guest_fail(place, "calls %s(), which a program on the simulator cannot use: %s", name, why);
}
