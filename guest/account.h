/* account.h - handing over the computing time that counted blocks added up in register r15.
 *
 * Every function of a program that calls the simulator begins with mimdsim_account(): the rank's
 * clock is then right. Not in functions that the C library calls back: there the register is the
 * library's. */
#ifndef GUEST_ACCOUNT_H
#define GUEST_ACCOUNT_H

#include <mimdsim/host.h>

#ifdef MIMDSIM_FIXED_R15
register int64_t mimdsim_counted __asm__("r15");

/* What functions counted that were called through their entries, by libraries or pointers
 * (guest/host.c). */
extern int64_t mimdsim_pending;

static inline void mimdsim_account(void)
{
    int64_t ps = mimdsim_counted + mimdsim_pending;
    mimdsim_counted = 0;
    mimdsim_pending = 0;
    if (ps) mimdsim_host->runtime->elapse_ps(mimdsim_host, ps);
}

/* The register is a library's that will not go on: what blocks count from now on begins at 0. */
static inline void mimdsim_count_anew(void) { mimdsim_counted = 0; }
#else
static inline void mimdsim_account(void) {}
static inline void mimdsim_count_anew(void) {}
#endif

#endif
