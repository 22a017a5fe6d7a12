/* jump.c - longjmp keeps what blocks counted: it would put back register r15 as it was at setjmp.
 *
 * glibc's jmp_buf holds rbx, rbp, r12, r13, r14, r15, rsp, pc in this order; rbp, rsp and pc are
 * encrypted, the others plain. setjmp itself is the C library's. */
#include <setjmp.h>

#include "guest.h"

enum { SLOT_R15 = 5 };

LIBC(longjmp);

static _Noreturn void jump(struct __jmp_buf_tag *place, int value)
{
#ifdef MIMDSIM_FIXED_R15
    place->__jmpbuf[SLOT_R15] = mimdsim_counted;
#endif
    mimdsim_libc_longjmp(place, value);
    __builtin_unreachable();
}

WEAK _Noreturn void longjmp(struct __jmp_buf_tag place[1], int value) { jump(place, value); }
WEAK _Noreturn void _longjmp(struct __jmp_buf_tag place[1], int value) { jump(place, value); }
WEAK _Noreturn void siglongjmp(struct __jmp_buf_tag place[1], int value) { jump(place, value); }
_Noreturn void __longjmp_chk(struct __jmp_buf_tag place[1], int value);
WEAK _Noreturn void __longjmp_chk(struct __jmp_buf_tag place[1], int value) { jump(place, value); }
