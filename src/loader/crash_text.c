/* crash_text.c - the record of a crash and the sentence made of it, by the process that did not
 * crash (crash.h). */
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

#include "loader/crash.h"

/* Shared memory: the process that crashes writes, its parent reads after it has gone. */
struct crash_record *crash_record_create(void)
{
    void *p = mmap(NULL, sizeof(struct crash_record), PROT_READ | PROT_WRITE,
                   MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    return p == MAP_FAILED ? NULL : p;
}

/* The record is used again for the worker's next run. */
void crash_record_clear(struct crash_record *r) { atomic_store(&r->kind, CRASH_NONE); }

/* The caller's, after the last worker has ended. */
void crash_record_destroy(struct crash_record *r)
{
    if (r) munmap(r, sizeof *r);
}

/* What happened, in the words that people know from their shells. */
static void describe(const struct crash_record *r, char *buffer, size_t size)
{
    const unsigned long long at = (unsigned long long)r->address;
    switch (atomic_load(&r->kind)) {
    case CRASH_STACK:
        snprintf(buffer, size,
                 "stack overflow (address 0x%llx) of a stack of %lld KiB, which .stack_bytes of a "
                 "kernel makes larger,",
                 at, (long long)r->stack_bytes / 1024);
        return;
    case CRASH_HOST_TIME:
        snprintf(buffer, size,
                 "still busy after %g s of processor time of the host, which is the limit",
                 r->seconds);
        return;
    default:
        break;
    }
    switch (r->signal) {
    case SIGSEGV:
        /* Addresses that no program can have come with code SI_KERNEL and without their value
         * (Intel SDM 3, #GP). */
        if (r->code == SI_KERNEL)
            snprintf(buffer, size, "segmentation fault at an address that is no address");
        else snprintf(buffer, size, "segmentation fault at address 0x%llx", at);
        return;
    case SIGBUS:
        snprintf(buffer, size, "bus error at address 0x%llx", at);
        return;
    case SIGFPE:
        snprintf(buffer, size,
                 r->code == FPE_INTDIV ? "whole-number division by zero"
                                       : "arithmetic error (SIGFPE)");
        return;
    case SIGILL:
        snprintf(buffer, size, "illegal instruction");
        return;
    case SIGABRT:
        snprintf(buffer, size, "abort, by the C library or by the simulator itself");
        return;
    default:
        snprintf(buffer, size, "%s", strsignal(r->signal));
        return;
    }
}

/* The innermost place that has a line; those without are of libraries. None has one: the
 * innermost. */
static void place_of(const struct crash_record *r, char *buffer, size_t size)
{
    char text[480], first[480] = "";
    for (int k = 0; k < r->nframe; k++) {
        const bool line = place_text(r->frame[k].file, r->frame[k].address, text, (int)sizeof text);
        if (k == 0 || line) snprintf(first, sizeof first, "%s", text);
        if (line) break;
    }
    if (first[0]) snprintf(buffer, size, " in %s", first);
}

/* Who, where, what and when, in one sentence. Lines are looked up here and not in the handler,
 * which may call almost nothing. */
bool crash_text(const struct crash_record *r, char *buffer, int size)
{
    char what[256], where[512] = "", when[64] = "", whose[CRASH_JOB + 16] = "";
    const int kind = atomic_load(&r->kind);
    if (kind == CRASH_NONE) return false;
    if (kind == CRASH_TOLD) return snprintf(buffer, (size_t)size, "%s", r->told), true;
    describe(r, what, sizeof what);
    place_of(r, where, sizeof where);
    if (r->now_ps >= 0)
        snprintf(when, sizeof when, " after %.9g s of simulated time", 1e-12 * (double)r->now_ps);
    /* Ranks are numbered within their job. */
    if (r->job[0] != '\0') snprintf(whose, sizeof whose, "job '%s', ", r->job);
    if (r->rank >= 0)
        snprintf(buffer, (size_t)size, "%srank %d%s: %s%s", whose, r->rank, where, what, when);
    else snprintf(buffer, (size_t)size, "outside of the ranks' programs: %s", what);
    return true;
}
