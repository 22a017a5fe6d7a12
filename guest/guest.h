/* guest.h - what the functions share that are linked into every program (libmimdsim-guest.a).
 *
 * A program is copied for each rank, so a static variable here is private to a rank. Functions that
 * stand for one of the C library are weak: a program may bring its own. The C library's own
 * function is mimdsim_libc_NAME. */
#ifndef GUEST_GUEST_H
#define GUEST_GUEST_H

#include <stddef.h>
#include <stdint.h>

#include <mimdsim/host.h>

#include "account.h"

#define WEAK __attribute__((weak))

/* LIBC: declare the host's own function; used as mimdsim_libc_NAME. */
#define LIBC(name) extern __typeof__(name) mimdsim_libc_##name WEAK

/* HERE: the place in the program that called this function, for messages. */
#define HERE __builtin_return_address(0)

/* guest_fail: the program has failed: the run ends with rank, place and text. */
_Noreturn void guest_fail(const void *place, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* guest_refuse: fail because the program calls `name`, which the simulator does not have. */
_Noreturn void guest_refuse(const void *place, const char *name, const char *why);

/* guest_writable: whether a file may be written: below the working directory, or a device that
 * swallows or shows. */
int guest_writable(const char *path);

/* guest_account: mimdsim_account in functions that libraries call, too: only when `place`, the
 * caller, lies in the program itself. The register is a library's own while it runs (libgfortran, a
 * shared libstdc++). */
void guest_account(const void *place);

/* What a program is told that reads standard input. */
extern const char guest_no_input[];

/* guest_flush: hand over what stands in the streams' buffers. */
void guest_flush(void);

#endif
