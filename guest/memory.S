/* memory.S - memcpy, memmove and memset as programs call them: the bytes they move are counted, then the C library's
 * own does the work.
 *
 * `mimdsim cc` makes calls of these three calls of mimdsim_NAME. A rate is the price of 1,024 bytes: the loader writes
 * it into the first instruction (loader/block_table.h, BLOCK_RATE), 0 until then. Its counts are loads and stores: a
 * copied byte is two, a set one is one. r15 holds the count of computing time [ps]. */

    .macro counted name, label, counts
    .text
    .globl mimdsim_\name
    .type mimdsim_\name, @function
mimdsim_\name:
    .cfi_startproc
    .byte 0xb8 /* movl $..., %eax */
    .long 0
\label:
    imulq %rdx, %rax
    shrq $10, %rax
    addq %rax, %r15
    jmp \name@PLT
    .cfi_endproc
    .size mimdsim_\name, .-mimdsim_\name
    .section mimdsim_blocks,"ao",@progbits,\label
    .balign 4
    .long \label-4-., 0
    .value 0, 0, 0, 0, 0, 0, \counts, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1
    .endm

    counted memcpy, .Lcopy, 2048
    counted memmove, .Lmove, 2048
    counted memset, .Lset, 1024

    .section .note.GNU-stack,"",@progbits
