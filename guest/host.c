/* host.c - the pointer to the simulator, and the ways to give up. */
#include <stdarg.h>
#include <stdio.h>

#include "guest.h"

/* Set by the loader in each rank's copy before any code runs. Its presence is also what shows that
 * a file was made by `mimdsim cc`. */
struct mimdsim_host *mimdsim_host;

_Noreturn void guest_fail(const void *place, const char *format, ...)
{
    char text[768];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    mimdsim_account();
    guest_flush();
    mimdsim_host->runtime->fail(mimdsim_host, place, text);
    __builtin_unreachable();
}

_Noreturn void guest_refuse(const void *place, const char *name, const char *why)
{
    guest_fail(place, "calls %s(), which a program on the simulator cannot use: %s", name, why);
}
