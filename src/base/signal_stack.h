/* signal_stack.h - stacks of signal handlers, with what these have to know at their bottom.
 *
 * A handler finds its data without a global variable: the system tells where the stack of the
 * thread's handlers is (sigaltstack). Somebody later may put another one there; each keeps the one
 * before it, so that those behind are found as well. */
#ifndef BASE_SIGNAL_STACK_H
#define BASE_SIGNAL_STACK_H

#include <signal.h>
#include <stdint.h>

/* The registers of the widest processors take 11 KiB of it, a sentence less than 4. */
enum { SIGNAL_STACK_BYTES = 64 * 1024 };

enum signal_stack_kind { SIGNAL_STACK_CRASH, SIGNAL_STACK_FAULT };

/* First member of a handler's data. */
struct signal_stack {
    uint64_t magic;
    enum signal_stack_kind kind;
    stack_t before; /* of the thread */
};

/* signal_stack_make: fresh zeroed memory of SIGNAL_STACK_BYTES that begins with a signal_stack, as
 * the calling thread's stack for handlers from now on; NULL with errno. The stack grows down from
 * its end; data at its bottom should stay below 4 KiB. */
void *signal_stack_make(enum signal_stack_kind kind);

/* signal_stack_find: the data of the calling thread's latest stack of that kind; NULL: none, or one
 * that is not of this file lies before it. May be called in a signal handler. */
void *signal_stack_find(enum signal_stack_kind kind);

/* signal_stack_end: the thread has the stack before `s` again, which is the latest one; its memory
 * goes. */
void signal_stack_end(struct signal_stack *s);

#endif
